#include "core/preview/text.h"

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace aftershade::preview {

namespace {

/// Display values of text: light grey, softer than white.
constexpr std::array kTextColor{0.86F, 0.86F, 0.86F};

constexpr std::array kFontFiles{
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",    // Debian, Ubuntu: fonts-dejavu-core
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",  // Fedora
    "/usr/share/fonts/TTF/DejaVuSans.ttf",                // Arch
    "/usr/share/fonts/dejavu/DejaVuSans.ttf",             // older Fedora
};

bool can_draw(const std::string& font) {
  const bool ok = OIIO::ImageBufAlgo::text_size("x", 16, font).defined();
  if (!ok) OIIO::geterror();  // an error that nobody fetches is printed at exit
  return ok;
}

/// One line: OpenImageIO would break it at a line feed.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

void drop_last_character(std::string& text) {
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };  // UTF-8
  while (!text.empty() && continues(text.back())) text.pop_back();
  if (!text.empty()) text.pop_back();
}

std::string shortened(const std::string& text, int width, int size_px, const std::string& font) {
  if (text_width(text, size_px, font) <= width) return text;
  std::string start = text;
  while (!start.empty() && text_width(start + "...", size_px, font) > width) drop_last_character(start);
  return start.empty() ? "" : start + "...";
}

}  // namespace

std::optional<std::string> usable_font(const std::string& wanted) {
  std::error_code ignored;
  if (!wanted.empty()) {
    if (std::filesystem::is_regular_file(wanted, ignored) && can_draw(wanted)) return wanted;
    return std::nullopt;
  }
  for (const std::string file : kFontFiles)
    if (std::filesystem::is_regular_file(file, ignored) && can_draw(file)) return file;
  if (const std::string name = "DejaVuSans"; can_draw(name)) return name;
  return std::nullopt;
}

int text_width(const std::string& text, int size_px, const std::string& font) {
  const OIIO::ROI box = OIIO::ImageBufAlgo::text_size(one_line(text), size_px, font);
  return box.defined() ? box.xend : 0;
}

void draw_text(OIIO::ImageBuf& canvas, const Box& box, const std::string& text, int size_px, const std::string& font) {
  const std::string line = shortened(one_line(text), box.width, size_px, font);
  if (line.empty()) return;
  const int base = box.y + (box.height + size_px * 7 / 10) / 2;  // a capital letter's height is 0.73 of the font size
  OIIO::ImageBufAlgo::render_text(canvas, box.x, base, line, size_px, font, kTextColor);
}

}  // namespace aftershade::preview
