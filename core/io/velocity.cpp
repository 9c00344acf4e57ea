#include <cmath>
#include <limits>

#include "core/io/conversions.h"
#include "core/parallel/rows.h"

namespace aftershade::io {

namespace {
constexpr double kNoVector_px = 10000;  // longer vectors are "none" in every producer (conventions 3.2, 8.3)
}

void convert_velocity(std::vector<Plane>& velocity, const Encoding& encoding, Window display) {
  const bool screen = encoding.velocity_unit == VelocityUnit::screen;
  const double scale_x = encoding.scale[0] * (screen ? display.width() : 1),
               scale_y = encoding.scale[1] * (screen ? display.height() : 1);
  const double sentinel =
      encoding.sentinel_above > 0 ? encoding.sentinel_above : std::numeric_limits<double>::infinity();
  for_rows(velocity[0].height(), [&](int y) {
    for (int x = 0; x < velocity[0].width(); ++x) {
      float &u = velocity[0](x, y), &v = velocity[1](x, y);
      const double vx = (u - encoding.neutral) * scale_x, vy = (v - encoding.neutral) * scale_y;
      const bool known = std::abs(u) < sentinel && std::abs(v) < sentinel && std::abs(vx) < kNoVector_px &&
                         std::abs(vy) < kNoVector_px;
      u = known ? static_cast<float>(vx) : std::numeric_limits<float>::quiet_NaN();
      v = known ? static_cast<float>(vy) : std::numeric_limits<float>::quiet_NaN();
    }
  });
}

void convert_values(std::vector<Plane>& planes, const Encoding& encoding, float missing) {
  const size_t count = encoding.multiply ? planes.size() / 2 : planes.size();
  for (size_t i = 0; i < count; ++i)
    for_rows(planes[i].height(), [&](int y) {
      for (int x = 0; x < planes[i].width(); ++x) {
        double value = planes[i](x, y);
        if (encoding.multiply) value *= planes[count + i](x, y);
        value = (value - encoding.neutral) * encoding.scale[i];
        planes[i](x, y) = std::isfinite(value) ? static_cast<float>(value) : missing;
      }
    });
  planes.resize(count);
}

}  // namespace aftershade::io
