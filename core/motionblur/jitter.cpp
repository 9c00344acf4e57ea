#include "core/motionblur/jitter.h"

#include "core/math/sampling.h"
#include "core/parallel/rows.h"

namespace aftershade::motionblur {

namespace {

/// `value(x, y)` of the absolute coordinates, at every pixel.
template <class Value>
Plane filled(Window window, const Value& value) {
  Plane out(window.width(), window.height());
  for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x)
      out(x, y) = value(static_cast<uint32_t>(window.min_x + x), static_cast<uint32_t>(window.min_y + y));
  });
  return out;
}

}  // namespace

Plane random_jitter(Window window) {
  return filled(window, [](uint32_t x, uint32_t y) { return unit_float(hash_counters(x, y)) - 0.5F; });
}

Plane even_jitter(Window window) {
  constexpr uint32_t kX = 3242174889U, kY = 2447445414U;  // 2^32 / p and 2^32 / p^2, p = 1.3247179572
  return filled(window, [](uint32_t x, uint32_t y) { return 2 * unit_float(kX * x + kY * y) - 1; });
}

}  // namespace aftershade::motionblur
