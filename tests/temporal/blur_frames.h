#pragma once
#include <gtest/gtest.h>

#include "core/math/sampling.h"
#include "core/temporal/temporal_blur.h"
#include "tests/filter/analytic_surface.h"

/// Frames for the tests of the temporal blur: a surface, the grid on it, and where it was.
namespace aftershade::tests {

/// Uniform in [0, 1): noise that depends on the counters alone.
inline float random_at(int x, int y, int frame, int index = 0) {
  return unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(frame),
                                  static_cast<uint32_t>(index)));
}

struct BlurFrame {
  Picture picture;
  filter::Surface surface;
  filter::SampleGrid grid;
  temporal::Reprojected where;  ///< at every pixel
  Plane value;                  ///< on the grid

  BlurFrame(Picture source, int step)
      : picture(std::move(source)),
        surface(picture.surface()),
        grid(step == 1 ? filter::full_grid(surface) : filter::half_grid(surface)),
        value(grid.width(), grid.height(), 0.5F) {
    for (Plane* plane : {&where.x, &where.y, &where.depth}) *plane = Plane(width(), height(), kNan);
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width(); ++x) {
        if (!(std::isfinite(picture.depth(x, y)) && picture.depth(x, y) > 0)) continue;
        where.x(x, y) = static_cast<float>(picture.origin_x + x) + 0.5F;
        where.y(x, y) = static_cast<float>(picture.origin_y + y) + 0.5F;
        where.depth(x, y) = picture.depth(x, y);
      }
  }
  int width() const { return picture.depth.width(); }
  int height() const { return picture.depth.height(); }
  /// Absolute coordinates of the pixel that a texel stands for.
  int pixel_x(int x, int y) const {
    return picture.origin_x + (grid.step == 1 ? x : static_cast<int>(grid.pixel_x(x, y)));
  }
  int pixel_y(int x, int y) const {
    return picture.origin_y + (grid.step == 1 ? y : static_cast<int>(grid.pixel_y(x, y)));
  }
  void set_value(const std::function<float(int x, int y)>& at_pixel) {
    for (int y = 0; y < value.height(); ++y)
      for (int x = 0; x < value.width(); ++x) value(x, y) = at_pixel(pixel_x(x, y), pixel_y(x, y));
  }
  Plane run(const temporal::TemporalBlurParams& params, temporal::TemporalBlurHistory& history) const {
    return temporal::temporal_blur(params, value, grid, surface, where, history);
  }
};

}  // namespace aftershade::tests
