#include "app/compare_sheet.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/sequence.h"
#include "core/preview/loader.h"

namespace aftershade::app {

namespace {

constexpr int kCellWidth_px = 480;
constexpr size_t kMostFrames = 16, kColumnsOfOneFrame = 3;

/// "X,Y,WIDTHxHEIGHT" inside the display window.
Window parse_region(const std::string& text, Window display) {
  const auto fail = [&](const std::string& why) -> Error {
    return {ErrorCode::usage, cat("--sheet-region ", text, " ", why),
            cat("X,Y,WIDTHxHEIGHT inside the display window ", display.width(), "x", display.height(), " at ",
                display.min_x, ",", display.min_y)};
  };
  const auto parts = split(text, ',');
  const auto size = split(parts.back(), 'x');
  if (parts.size() != 3 || size.size() != 2) throw fail("is no region");
  const auto x = parse_integer(parts[0]), y = parse_integer(parts[1]), width = parse_integer(size[0]),
             height = parse_integer(size[1]);
  if (!x || !y || !width || !height) throw fail("is no region");
  const bool fits = *width >= 1 && *height >= 1 && *width <= display.width() && *height <= display.height() &&
                    display.contains(*x, *y) && *x <= display.max_x - *width + 1 && *y <= display.max_y - *height + 1;
  if (!fits) throw fail("is not inside the picture");
  return {*x, *y, *x + *width - 1, *y + *height - 1};
}

/// Those asked for, which must be compared; else first, middle and last.
std::vector<int> frames_of_sheet(const std::string& asked, const std::vector<int>& compared) {
  if (asked.empty()) {
    std::vector<int> frames{compared.front(), compared[compared.size() / 2], compared.back()};
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
  }
  const std::vector<int> frames = io::parse_frames(asked);
  for (const int frame : frames)
    if (!std::binary_search(compared.begin(), compared.end(), frame))
      throw Error(ErrorCode::usage, cat("--sheet-frames ", asked, ": frame ", frame, " is not compared"),
                  "compared are " + io::format_frames(compared));
  if (frames.size() > kMostFrames)
    throw Error(ErrorCode::usage, cat("--sheet-frames ", asked, ": ", frames.size(), " frames"),
                cat("a sheet shows at most ", kMostFrames));
  return frames;
}

/// The region's pixels, each as factor x factor of the sheet's.
Plane enlarged(ConstPlaneView source, Window region, Window display, int factor) {
  const int left = region.min_x - display.min_x, top = region.min_y - display.min_y;
  Plane out(region.width() * factor, region.height() * factor);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) out(x, y) = source(left + x / factor, top + y / factor);
  return out;
}

}  // namespace

std::optional<SheetPlan> sheet_plan(const CompareArgs& args, const std::vector<int>& compared, Window display,
                                    float pixel_aspect) {
  if (args.sheet.empty()) {
    if (!args.sheet_frames.empty() || !args.sheet_region.empty())
      throw Error(ErrorCode::usage, "--sheet-frames and --sheet-region say what the sheet shows, and there is none",
                  "--sheet ao or --sheet color makes one");
    return std::nullopt;
  }
  return SheetPlan{args.sheet == "color", frames_of_sheet(args.sheet_frames, compared),
                   args.sheet_region.empty() ? display : parse_region(args.sheet_region, display), pixel_aspect};
}

ComparisonSheet::ComparisonSheet(SheetPlan plan, Window display, std::vector<std::string> names)
    : plan_(std::move(plan)), display_(display), names_(std::move(names)) {}

bool ComparisonSheet::wants(int number) const {
  return std::binary_search(plan_.frames.begin(), plan_.frames.end(), number);
}

void ComparisonSheet::add(int number, const std::vector<report::Pixels>& pictures) {
  const int factor = std::max(1, kCellWidth_px / plan_.region.width());
  std::vector<preview::Cell>& cells = cells_[number];
  for (size_t i = 0; i < names_.size(); ++i) {
    preview::Cell cell;
    for (const ConstPlaneView& plane : pictures[i]) {
      if (plane.width != display_.width() || plane.height != display_.height())
        throw Error(ErrorCode::data, cat(names_[i], " is ", plane.width, "x", plane.height, ", the sheet shows ",
                                         display_.width(), "x", display_.height()));
      cell.planes.push_back(enlarged(plane, plan_.region, display_, factor));
    }
    cell.label = cat(names_[i], ", frame ", number);
    cell.pixel_aspect = plan_.pixel_aspect;
    cells.push_back(std::move(cell));
  }
}

std::string ComparisonSheet::write(const std::string& png_path) {
  if (cells_.empty()) return "";
  const size_t columns = cells_.size() > 1 ? cells_.size() : kColumnsOfOneFrame;
  preview::Sheet sheet;
  for (size_t i = 0; i < names_.size(); ++i)
    for (auto& [number, cells] : cells_) {
      if (sheet.rows.empty() || sheet.rows.back().size() == columns) sheet.rows.emplace_back();
      sheet.rows.back().push_back(std::move(cells[i]));
    }
  return preview::write_sheet(std::move(sheet), png_path);
}

}  // namespace aftershade::app
