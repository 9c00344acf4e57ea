#if defined(AFTERSHADE_CORE_AO_SAMPLE_VALIDATION_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_SAMPLE_VALIDATION_KERNEL_H
#undef AFTERSHADE_CORE_AO_SAMPLE_VALIDATION_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_SAMPLE_VALIDATION_KERNEL_H
#endif
#include <limits>

#include "core/ao/sample_validation.h"
#include "core/ao/sphere_tap.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

struct PastSamples {
  explicit PastSamples(const PastSurface& past)
      : depth(past.depth),
        x(past.x),
        y(past.y),
        expected(past.expected),
        lens(past.projection),
        min_x(static_cast<float>(past.min_x)),
        min_y(static_cast<float>(past.min_y)) {}
  Samples depth, x, y, expected;
  Lens lens;
  float min_x, min_y;
};

struct SampleConfidenceRow {
  const SphereTaps& taps;
  const PastSamples& past;
  RangeRow range;
  EdgeTolerance rounding;
  float sharpness;  ///< S / R
  float limit_m;    ///< of the binary test; +inf: smooth
  float same_depth;
  float* out;
};

struct PastPoint {
  Point point;
  Mask in_frame, seen;
};

/// What was seen at absolute position (x, y): the depth of the nearest pixel, interpolated over those of the four
/// around it that belong to the same surface; 1/z is linear on a plane.
inline PastPoint point_before(const PastSamples& past, Float x, Float y, float same_depth) {
  const auto columns = static_cast<float>(past.depth.width), rows = static_cast<float>(past.depth.height);
  const Float u = x - 0.5F, v = y - 0.5F, u0 = floor(u), v0 = floor(v), du = u - u0, dv = v - v0;
  const Float left = clamp(u0 - past.min_x, -2.0F, columns), top = clamp(v0 - past.min_y, -2.0F, rows);  // NaN: -2
  const auto inside = [&](Float a, Float b) { return (a >= 0.0F) & (a < columns) & (b >= 0.0F) & (b < rows); };
  const auto depth = [&](Float a, Float b) {
    return past.depth(to_int(clamp(a, 0.0F, columns - 1.0F)), to_int(clamp(b, 0.0F, rows - 1.0F)));
  };
  const Float near_x = left + select(du >= 0.5F, Float(1.0F), 0.0F),
              near_y = top + select(dv >= 0.5F, Float(1.0F), 0.0F);
  const Float nearest = depth(near_x, near_y);
  Float sum = 0.0F, weights = 0.0F;
  for (int tap = 0; tap < 4; ++tap) {
    const auto right = static_cast<float>(tap & 1), below = static_cast<float>(tap >> 1);
    const Float z = depth(left + right, top + below);
    const Mask same = inside(left + right, top + below) & (abs(1.0F - z / nearest) < same_depth);
    const Float w = select(same, (1.0F - abs(du - right)) * (1.0F - abs(dv - below)), 0.0F);
    sum += select(same, w * (past.lens.orthographic ? z - nearest : 1.0F / z - 1.0F / nearest), 0.0F);
    weights += w;
  }
  const Float mean = sum / weights;
  const Float z = past.lens.orthographic ? nearest + mean : 1.0F / (1.0F / nearest + mean);
  const Float scale = past.lens.orthographic ? Float(1.0F) : z;
  const Point point{((left + 0.5F - past.lens.cx) + du) * past.lens.inv_fx * scale,
                    -(((top + 0.5F - past.lens.cy) + dv) * past.lens.inv_fy * scale), z};
  return {point, inside(near_x, near_y), is_surface(nearest) & is_finite(dot(point, point))};
}

/// min(|q - p|, reach); `reach` where q is nothing.
inline Float distance(Point q, Point p, Mask seen, float reach) {
  const Point v = q - p;
  return select(seen, min(sqrt(dot(v, v)), reach), reach);
}

/// How much the distance of one sample's surface has changed, beyond rounding; 0 where it does not matter, infinite
/// where it was outside the image. Sky has no past of its own: it is looked up beside the texel's.
inline Float sample_change(const SampleConfidenceRow& row, const BallCentre& centre, Float past_x, Float past_y,
                           const PastPoint& centre_before, const SphereTap& tap) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const float reach = 2 * row.taps.radius_m;
  const Mask seen = is_surface(tap.surface.z);
  const Float x = select(seen, row.past.x(tap.x, tap.y), past_x + to_float(tap.x - centre.x));
  const Float y = select(seen, row.past.y(tap.x, tap.y), past_y + to_float(tap.y - centre.y));
  const PastPoint before = point_before(row.past, x, y, row.same_depth);
  const Float expected = select(seen, row.past.expected(tap.x, tap.y), kInfinite);
  const Mask occludes = seen & (dot(tap.surface - centre.point, centre.normal) > row.taps.bias_m);
  const Mask occluded = before.in_frame & before.seen & (before.point.z < expected);
  const Float change = abs(distance(tap.surface, centre.point, seen, reach) -
                           distance(before.point, centre_before.point, before.seen, reach));
  const Float beyond = max(change - row.rounding.at(centre.point.z), 0.0F);
  return select(tap.in_frame & (occludes | occluded), select(before.in_frame, beyond, kInfinite), 0.0F);
}

template <bool kInside>
void sample_confidence_vector(const SampleConfidenceRow& row, int x0, int y) {
  const SphereTaps& taps = row.taps;
  const Columns<kInside> x(x0, taps.grid.depth.width);
  const BallCentre centre = ball_centre(taps, x, y);
  const Float past_x = row.past.x(centre.x, centre.y), past_y = row.past.y(centre.x, centre.y);
  const PastPoint before = point_before(row.past, past_x, past_y, row.same_depth);
  const Mask here = is_surface(centre.point.z) & before.in_frame & before.seen & x.inside;
  const Int first = row.range.first_of(x0), count = row.range.count_of(x0);
  const int shared = row.range.shared_first(x0);
  Float worst = 0.0F;
  for (int i = 0; any(here & (Int(i) < count)); ++i) {
    const SphereTap tap = sphere_tap(taps, centre, ball_point(taps, first, shared, i));
    const Float change = sample_change(row, centre, past_x, past_y, before, tap);
    worst = max(worst, select(Int(i) < count, change, 0.0F));
  }
  const Float smooth = 1.0F / (1.0F + row.sharpness * worst);
  const Float binary = select(worst > row.limit_m, Float(0.0F), Float(1.0F));
  store(row.out + x0, select(here, row.limit_m < std::numeric_limits<float>::infinity() ? binary : smooth, 0.0F));
}

inline void sample_confidence_row(const SampleConfidenceRow& row, int y) {
  for_each_vector(row.taps.grid.depth.width, 0, 0,
                  [&](int x0, auto inside) { sample_confidence_vector<decltype(inside)::value>(row, x0, y); });
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
