#pragma once
#include <array>

#include "core/filter/surface.h"
#include "core/image/plane.h"

namespace aftershade::filter {

/// The pixels at which an effect is evaluated: all (step 1), or one of every 2x2 block (step 2). Blocks are aligned to
/// even absolute coordinates, so a data window that moves by one pixel does not change which pixels are taken.
/// A texel stands for the real pixel it was picked from, never for the block's centre (algorithms: picked depth lives
/// at its pixel). Size: ceil over the blocks that the window touches.
struct SampleGrid {
  int step = 1;
  int origin_x = 0, origin_y = 0;  ///< window index of block (0,0)'s first pixel: 0, or -1 when it lies outside
  Plane depth;                     ///< metres, of the picked pixel
  Plane pixel_x, pixel_y;          ///< window index of the picked pixel, as float; empty when step is 1
  std::array<Plane, 3> normal{};   ///< of the picked pixel, (0,0,0) where there is none; may be empty
  int width() const { return depth.width(); }
  int height() const { return depth.height(); }
};

/// Every pixel.
SampleGrid full_grid(const Surface& surface);

/// One pixel a block: alternately the nearest and the farthest of the block in a checkerboard of blocks, so that both
/// layers of a silhouette are represented. Pixels outside the window are never picked.
SampleGrid half_grid(const Surface& surface);

/// The grid's values at every pixel of the surface: each pixel has its block's.
Plane values_at_pixels(ConstPlaneView values, const SampleGrid& grid, const Surface& surface);

}  // namespace aftershade::filter
