// Writes the pages that check.mjs opens: make_report FOLDER. All are made up (tests/report/sample.h).
#include <filesystem>
#include <fstream>
#include <iostream>

#include "core/base/text.h"
#include "core/params/table.h"
#include "tests/report/sample.h"

namespace {

using namespace aftershade;
using tests::sample_comparison;
using tests::SampleOptions;
namespace fs = std::filesystem;

constexpr size_t kPageBytes = size_t{24} << 20;

void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

void write_page(const fs::path& path, const report::Comparison& comparison, size_t budget = kPageBytes) {
  std::vector<std::string> notes;
  write(path, page_text(comparison, budget, notes));
  for (const std::string& note : notes) std::cout << path.filename().string() << ": " << note << "\n";
}

/// Pixels of the worst regions as they must appear, by frame: of picture 0, 1 and the reference at the region's (5, 7).
params::Json expected_pixels(const report::Comparison& comparison) {
  params::Json out = params::Json::object();
  for (const report::ShownFrame& shown : comparison.shown) {
    params::Json pixels = params::Json::array();
    for (size_t index = 0; index < shown.detail.size(); ++index)
      pixels.push_back(tests::sample_pixel(shown.number, index, shown.region.min_x - comparison.display.min_x + 5,
                                           shown.region.min_y - comparison.display.min_y + 7));
    out[cat(shown.number)] = std::move(pixels);
  }
  return out;
}

report::Comparison hostile() {
  SampleOptions options;
  options.presets = preset::shipped_presets();
  while (options.presets.size() < 20) options.presets.push_back("high-dx11");
  report::Comparison out = sample_comparison(options);
  out.input = "/shots/<b>\"quoted\" & 'odd'</b></script><script>window.hacked = 1</script>/\xE5\x83\x8F.####.exr";
  out.candidates[0].preset.name = "</script><img src=x onerror=\"window.hacked = 1\">";
  out.candidates[1].preset.name =
      "a preset whose name is very long because somebody wrote a sentence into it, with commas";
  out.candidates[2].preset.description = "Broken \xFF text, <i>markup</i> and <!-- comments. And more.";
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_report FOLDER\n";
    return 64;
  }
  const fs::path folder = argv[1];
  fs::create_directories(folder);
  const report::Comparison full = sample_comparison();
  write_page(folder / "full.html", full);
  write(folder / "full.pixels.json", expected_pixels(full).dump());

  SampleOptions bare;
  bare.presets = {"offline"};
  bare.frames = 1;
  bare.shown = 0;
  bare.reference = bare.cost = false;
  write_page(folder / "bare.html", sample_comparison(bare));

  SampleOptions plain;  // no reference, no cost, frames that fit into a region
  plain.presets = {"soma", "high-dx11"};
  plain.reference = plain.cost = plain.detail = false;
  plain.display = {0, 0, 95, 53};
  write_page(folder / "plain.html", sample_comparison(plain));

  write_page(folder / "many.html", hostile(), size_t{2} << 20);
  return 0;
}
