#pragma once
#include <string>
#include <vector>

/// Where things lie on a contact sheet. Pure: no pixel, no font, no library.
namespace aftershade::preview {

struct PixelSize {
  int width = 0, height = 0;
  bool operator==(const PixelSize&) const = default;
};

/// A rectangle of the sheet; (x, y) is its upper left pixel, y down.
struct Box {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Box&) const = default;
};

/// The size at which a picture of `size` pixels of aspect `pixel_aspect` (width / height, > 0) is shown with square
/// pixels: widened or heightened, never losing pixels to it, then scaled down to at most `limit` with its proportions.
/// Never larger than needed, never below 1 x 1; an empty size stays empty.
PixelSize fitted(PixelSize size, float pixel_aspect, PixelSize limit);

struct CellSize {
  PixelSize picture;       ///< as shown
  int label_width_px = 0;  ///< what the label needs; a column is at least that wide
};

struct Spacing {
  int gap_px = 0;           ///< between cells, and around all of them
  int title_height_px = 0;  ///< 0: no title
  int label_height_px = 0;  ///< 0: no labels
};

struct PlacedCell {
  Box picture;  ///< the picture, or 0 x 0 for an empty place
  Box label;    ///< as wide as the column, directly below the row's highest picture
};

struct SheetLayout {
  PixelSize sheet;
  Box title;
  std::vector<std::vector<PlacedCell>> rows;  ///< as many as given, each as long as given
};

/// A grid: a column is as wide as its widest cell, a row as high as its highest picture; pictures stand at the left of
/// their column and on the bottom of their row, so that labels of a row share a line. Rows may differ in length.
SheetLayout lay_out(const std::vector<std::vector<CellSize>>& rows, const Spacing& spacing);

}  // namespace aftershade::preview
