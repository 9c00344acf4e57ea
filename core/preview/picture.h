#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/color/display.h"
#include "core/image/plane.h"

/// Pictures as a display shows them, for reports. Like loader.h's functions, these load the module on first use and
/// throw Error(internal) when it is missing.
namespace aftershade::preview {

/// 8 bits, red, green, blue, row by row, no padding. 0 x 0: none.
struct Picture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
  bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const Picture&) const = default;
};

struct PictureSize {
  int max_width_px = 0;    ///< a wider picture is scaled down with Mitchell's filter, none is enlarged; 0: as it is
  float pixel_aspect = 1;  ///< width / height of a pixel; used only with max_width_px: then pixels become square
};

/// The name of the view for reports ("sRGB"). Throws as DisplayTransform: call it before the first frame.
std::string view_name(const color::DisplayOptions& options);

/// Three planes of one size: scene-linear red, green, blue, through the view. One plane: grey that is shown as it is,
/// 0 black and 1 white, NaN black. No or empty planes: an empty picture. May be called from several threads.
Picture display_picture(std::span<const ConstPlaneView> planes, const color::DisplayOptions& options = {},
                        PictureSize size = {});

/// The picture scaled with Mitchell's filter.
Picture resized(const Picture& picture, int width, int height);

/// A PNG file, lossless: one channel where red, green and blue are the same everywhere, else three.
std::vector<unsigned char> png(const Picture& picture);

}  // namespace aftershade::preview
