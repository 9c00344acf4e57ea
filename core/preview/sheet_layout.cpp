#include "core/preview/sheet_layout.h"

#include <algorithm>
#include <cmath>

namespace aftershade::preview {

namespace {

int rounded(double length) { return std::max(1, static_cast<int>(std::lround(length))); }

std::vector<int> column_widths(const std::vector<std::vector<CellSize>>& rows) {
  std::vector<int> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max({widths[i], row[i].picture.width, row[i].label_width_px});
  }
  return widths;
}

std::vector<PlacedCell> place_row(const std::vector<CellSize>& row, const std::vector<int>& widths, int top, int height,
                                  const Spacing& spacing) {
  std::vector<PlacedCell> placed;
  int x = spacing.gap_px;
  for (size_t i = 0; i < row.size(); ++i) {
    const PixelSize size = row[i].picture;
    placed.push_back({{x, top + height - size.height, size.width, size.height},
                      {x, top + height, widths[i], spacing.label_height_px}});
    x += widths[i] + spacing.gap_px;
  }
  return placed;
}

}  // namespace

PixelSize fitted(PixelSize size, float pixel_aspect, PixelSize limit) {
  if (size.width <= 0 || size.height <= 0) return {};
  const double aspect = static_cast<double>(pixel_aspect);
  const double width = size.width * std::max(aspect, 1.0);
  const double height = size.height / std::min(aspect, 1.0);
  const double scale = std::min({1.0, limit.width / width, limit.height / height});
  return {rounded(width * scale), rounded(height * scale)};
}

SheetLayout lay_out(const std::vector<std::vector<CellSize>>& rows, const Spacing& spacing) {
  const std::vector<int> widths = column_widths(rows);
  SheetLayout out;
  out.sheet.width = spacing.gap_px;
  for (const int width : widths) out.sheet.width += width + spacing.gap_px;
  int y = spacing.gap_px;
  if (spacing.title_height_px > 0) {
    out.title = {spacing.gap_px, y, std::max(0, out.sheet.width - 2 * spacing.gap_px), spacing.title_height_px};
    y += spacing.title_height_px + spacing.gap_px;
  }
  for (const auto& row : rows) {
    int height = 0;
    for (const auto& cell : row) height = std::max(height, cell.picture.height);
    out.rows.push_back(place_row(row, widths, y, height, spacing));
    y += height + spacing.label_height_px + spacing.gap_px;
  }
  out.sheet.height = y;
  return out;
}

}  // namespace aftershade::preview
