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

/// A slope, thin things in front of it and a hole of background.
inline View slope_with_bars(const Lens& lens) {
  return [=](double x, double y) {
    if (x > 40 && y > 30 && x < 50) return Hit{};
    Hit hit = meet_plane(lens, x, y, {0.3, 0.5, -0.8}, -3);
    if (std::fmod(x + 2 * y + 400, 23) < 5) hit.z -= 0.4;
    return hit;
  };
}

/// Moves every pixel's past by up to `px` and its expected depth by up to `depth_m`.
inline void disturb(BlurFrame& frame, float px, float depth_m) {
  for (int y = 0; y < frame.height(); ++y)
    for (int x = 0; x < frame.width(); ++x) {
      frame.where.x(x, y) += px * (2 * random_at(x, y, 1) - 1);
      frame.where.y(x, y) += px * (2 * random_at(x, y, 2) - 1);
      frame.where.depth(x, y) += depth_m * (2 * random_at(x, y, 3) - 1);
      if (random_at(x, y, 4) < 0.03F) frame.where.x(x, y) = kNan;
    }
}

inline float noise(int x, int y) { return random_at(x, y, 9); }

}  // namespace aftershade::tests
