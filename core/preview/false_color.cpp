#include "core/preview/false_color.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel/rows.h"

namespace aftershade::preview {

namespace {

/// Three planes of color_at(x, y).
template <class ColorAt>
std::vector<Plane> painted(int width, int height, const ColorAt& color_at) {
  std::vector<Plane> out;
  for (int i = 0; i < 3; ++i) out.emplace_back(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const Rgb color = color_at(x, y);
      out[0](x, y) = color.r, out[1](x, y) = color.g, out[2](x, y) = color.b;
    }
  });
  return out;
}

/// One channel of a saturated hue in sixths of a turn: 1 within a sixth of its own, 0 beyond two sixths.
float channel_of_hue(float hue, float own) {
  const float away = std::abs(hue - own), nearer = std::min(away, 6 - away);
  return std::clamp(2 - nearer, 0.0F, 1.0F);
}

}  // namespace

Range range_of(ConstPlaneView plane) {
  Range range;
  bool any = false;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const float value = plane(x, y);
      if (!std::isfinite(value)) continue;
      range = any ? Range{std::min(range.least, value), std::max(range.largest, value)} : Range{value, value};
      any = true;
    }
  return range;
}

Plane scaled(ConstPlaneView plane, float black, float white) {
  Plane out(plane.width, plane.height);
  const float scale = white == black ? 0 : 1 / (white - black);
  for_rows(plane.height, [&](int y) {
    for (int x = 0; x < plane.width; ++x) {
      const float value = (plane(x, y) - black) * scale;
      out(x, y) = value > 0 ? std::min(value, 1.0F) : 0.0F;  // also NaN
    }
  });
  return out;
}

std::vector<Plane> coded(ConstPlaneView codes, std::span<const Rgb> palette) {
  return painted(codes.width, codes.height, [&](int x, int y) {
    const float code = std::round(codes(x, y));
    const bool known = code >= 0 && code < static_cast<float>(palette.size());
    return known ? palette[static_cast<size_t>(code)] : Rgb{};
  });
}

float longest_of(ConstPlaneView x, ConstPlaneView y) {
  float longest = 0;
  for (int j = 0; j < x.height; ++j)
    for (int i = 0; i < x.width; ++i) {
      const float length = std::hypot(x(i, j), y(i, j));
      if (std::isfinite(length)) longest = std::max(longest, length);
    }
  return longest;
}

Rgb wheel_color(float x, float y, float longest) {
  const float length = std::hypot(x, y);
  if (!(longest > 0) || !std::isfinite(length)) return {};
  const float turn = std::atan2(y, x) * (0.5F * std::numbers::inv_pi_v<float>), hue = 6 * (turn < 0 ? turn + 1 : turn);
  const float brightness = std::min(length / longest, 1.0F);
  return {brightness * channel_of_hue(hue, 0), brightness * channel_of_hue(hue, 2),
          brightness * channel_of_hue(hue, 4)};
}

std::vector<Plane> wheel(ConstPlaneView x, ConstPlaneView y, float longest) {
  return painted(x.width, x.height, [&](int i, int j) { return wheel_color(x(i, j), y(i, j), longest); });
}

std::vector<Plane> wheel_key(int size_px) {
  const float radius = 0.5F * static_cast<float>(size_px);
  return painted(size_px, size_px, [&](int x, int y) {
    const float dx = static_cast<float>(x) + 0.5F - radius, dy = static_cast<float>(y) + 0.5F - radius;
    return std::hypot(dx, dy) <= radius ? wheel_color(dx, dy, radius) : Rgb{};
  });
}

}  // namespace aftershade::preview
