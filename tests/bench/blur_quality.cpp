// Every motion blur against accumulated truth (shutter 0.5, centred): the public sequence and synthetic scenes. Prints
// a table, with --json also every frame's figures. See README.md.
//   bench_blur_quality [--json FILE] [--frames 3,6,9] [--methods A,B] [--scenes yard,crossing] [--files PATTERN]
//     [--seam-runs N]
#include "tests/pipeline/blur_quality.h"

#include <cstdio>
#include <fstream>
#include <limits>
#include <set>

#include "core/base/text.h"

namespace {

using namespace aftershade;
using tests::BlurScore;

/// One frame of a scene does not average its content as twelve do.
constexpr int kSceneSeamRuns = 8;

struct Options {
  std::vector<int> frames = tests::frames_from_to(1, tests::kYardFrames);  ///< of the public sequence
  std::set<std::string> methods;                                           ///< empty: all
  std::vector<std::string> scenes{"yard", "crossing", "columns", "trail"};
  int seam_runs = 0;             ///< 0: 1 on the public sequence, 8 on scenes
  std::string json_file, files;  ///< of another program that blurred the public sequence: out/yard_vb.####.exr
};

std::vector<std::string> items(const std::string& list) {
  std::vector<std::string> out;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t end = std::min(list.find(',', begin), list.size());
    out.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string key = argv[i], value = argv[i + 1];
    if (key == "--json") {
      options.json_file = value;
    } else if (key == "--frames") {
      options.frames.clear();
      for (const std::string& frame : items(value)) options.frames.push_back(std::atoi(frame.c_str()));
    } else if (key == "--methods") {
      for (const std::string& method : items(value)) options.methods.insert(method);
    } else if (key == "--seam-runs") {
      options.seam_runs = std::atoi(value.c_str());
    } else if (key == "--files") {
      options.files = value;
    } else if (key == "--scenes") {
      options.scenes = items(value);
    } else {
      return false;
    }
  }
  return argc % 2 == 1;
}

/// The figures as they are printed and written.
struct Column {
  const char *key, *title, *format;
  double BlurScore::*value;
};
constexpr Column kColumns[] = {{"psnr_db", "PSNR", " %7.2f", &BlurScore::psnr},
                               {"ssim", "SSIM", " %7.4f", &BlurScore::ssim},
                               {"hdr_flip", "FLIP", " %7.4f", &BlurScore::hdr_flip},
                               {"radiance_ratio", "light", " %8.5f", &BlurScore::radiance},
                               {"psnr_uncovered_db", "uncov.", " %7.2f", &BlurScore::psnr_uncovered},
                               {"seam_ratio", "seams", " %7.3f", &BlurScore::seams},
                               {"seam_ratio_elsewhere", "(else)", " %7.3f", &BlurScore::seams_elsewhere}};

struct Summary {
  double mean = 0, least = std::numeric_limits<double>::infinity(), greatest = -least;
};
Summary summary(const std::map<int, BlurScore>& scores, double BlurScore::*value) {
  Summary s;
  for (const auto& [number, score] : scores) {
    s.mean += score.*value / static_cast<double>(scores.size());
    s.least = std::min(s.least, score.*value);
    s.greatest = std::max(s.greatest, score.*value);
  }
  return s;
}

params::Json number_or_null(double value) { return std::isfinite(value) ? params::Json(value) : params::Json(); }

params::Json print(const std::string& input, const std::string& method, const std::map<int, BlurScore>& scores) {
  params::Json row{{"input", input}, {"method", method}, {"frames", params::Json::object()}};
  std::printf("%-9s %-24s", input.c_str(), method.c_str());
  for (const Column& column : kColumns) {
    const Summary s = summary(scores, column.value);
    std::printf(column.format, s.mean);
    row[column.key] = {
        {"mean", number_or_null(s.mean)}, {"min", number_or_null(s.least)}, {"max", number_or_null(s.greatest)}};
  }
  std::printf("   %7.2f %7.2f\n", summary(scores, &BlurScore::psnr).least,
              summary(scores, &BlurScore::psnr_uncovered).least);
  std::fflush(stdout);
  for (const auto& [number, score] : scores)
    for (const Column& column : kColumns)
      row["frames"][std::to_string(number)][column.key] = number_or_null(score.*column.value);
  return row;
}

/// Of files with a beauty R, G, B.
std::map<int, BlurScore> file_scores(const tests::BlurCase& blur, const std::string& pattern) {
  io::SourceOptions options;
  options.sequence = io::find_sequence(pattern, io::HashDigits::one).sequence;
  options.profile = io::load_profile("generic");
  io::FileSource source(std::move(options));
  std::map<int, BlurScore> scores;
  for (const auto& [number, frame] : blur.frames)
    if (std::optional<Frame> image = source.load(number, "", {}, true)) {
      const auto planes = tests::first_three(image->layers.at(0).planes);
      scores[number] = tests::blur_score(tests::rgb_of(planes), tests::rgb_of(frame.truth), frame.uncovered, 0);
    }
  return scores;
}

params::Json measure(const tests::BlurCase& blur, const std::set<std::string>& methods) {
  double uncovered = 0, longest_px = 0;
  for (const auto& [number, frame] : blur.frames) {
    uncovered += tests::share_of(frame.uncovered) / static_cast<double>(blur.frames.size());
    longest_px = std::max(longest_px, frame.longest_px);
  }
  std::printf("%s: longest half exposure %.1f px, %.2f %% of the pixels uncovered\n", blur.name.c_str(), longest_px,
              100 * uncovered);
  params::Json rows = params::Json::array();
  for (const tests::BlurMethod& method : tests::kBlurMethods) {
    if (!methods.empty() && !methods.contains(method.name)) continue;
    rows.push_back(print(blur.name, method.name, tests::blur_scores(blur, method, true)));
    if (method.has_clamp)
      rows.push_back(print(blur.name, cat(method.name, ", lifted"), tests::blur_scores(blur, method, false)));
  }
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!parse(argc, argv, options)) {
    std::fprintf(
        stderr,
        "usage: bench_blur_quality [--json FILE] [--frames N,N] [--methods A,B] [--scenes A,B] [--files PATTERN] "
        "[--seam-runs N]\n");
    return 64;
  }
  std::printf("%-9s %-24s %7s %7s %7s %8s %7s %7s %7s   %7s %7s\n", "input", "method", "PSNR", "SSIM", "FLIP", "light",
              "uncov.", "seams", "(else)", "least", "uncov.");
  params::Json rows = params::Json::array();
  for (const std::string& scene : options.scenes) {
    if (scene == "yard" && tests::yard_folder().empty()) {
      std::printf("NOT MEASURED: the public sequence is not there (set AFTERSHADE_DATA)\n");
      continue;
    }
    tests::BlurCase blur = scene == "yard" ? tests::yard_blur_case(options.frames) : tests::scene_blur_case(scene);
    blur.seam_runs = options.seam_runs > 0 ? options.seam_runs : scene == "yard" ? 1 : kSceneSeamRuns;
    for (params::Json& row : measure(blur, options.methods)) rows.push_back(std::move(row));
    if (scene == "yard" && !options.files.empty())
      rows.push_back(print(scene, std::filesystem::path(options.files).filename(), file_scores(blur, options.files)));
  }
  if (!options.json_file.empty()) std::ofstream(options.json_file) << rows.dump(2) << "\n";
}
