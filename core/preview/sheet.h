#pragma once
#include <string>
#include <vector>

#include "core/image/plane.h"

namespace aftershade::preview {

/// A colour of the display, 0..1.
struct Rgb {
  float r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};

/// What a colour of a picture means.
struct LegendLine {
  Rgb color;
  std::string text;  ///< UTF-8, one line
};

/// One picture of a contact sheet.
struct Cell {
  /// Three planes of one size: scene-linear Rec.709 red, green and blue, shown through color::to_display.
  /// One plane: grey that is shown as it is, 0 black and 1 white (an AO channel). None: the place stays empty.
  std::vector<Plane> planes;
  std::string label;        ///< below the picture, UTF-8, one line
  float pixel_aspect = 1;   ///< width / height of a pixel; the picture is widened or heightened to square pixels
  bool is_display = false;  ///< the three planes are display values, shown as they are (false_color.h)
  std::vector<LegendLine> legend = {};  ///< of a place without a picture: lines of text, each beside its colour
};

/// How a sheet looks. All lengths in pixels of the sheet.
struct SheetStyle {
  int max_cell_width_px = 640;   ///< wider pictures are scaled down; none is enlarged
  int max_cell_height_px = 640;  ///< higher pictures are scaled down
  int gap_px = 16;               ///< between pictures, and around them
  int title_size_px = 22;        ///< font size
  int label_size_px = 16;        ///< font size
  std::string font{};            ///< a TrueType file; empty: DejaVu Sans from where distributions install it
};

struct Sheet {
  std::string title;  ///< above the pictures; may be empty
  std::vector<std::vector<Cell>> rows;
  SheetStyle style;
};

}  // namespace aftershade::preview
