// Slices with exact intervals of visibility, lane by lane: each lane has its own slices and samples.
#if defined(AFTERSHADE_CORE_AO_SLICE_AO_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_SLICE_AO_KERNEL_H
#undef AFTERSHADE_CORE_AO_SLICE_AO_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_SLICE_AO_KERNEL_H
#endif
#include <array>
#include <span>

#include "core/ao/border_planes.h"
#include "core/ao/depth_levels.h"
#include "core/ao/interval_union.h"
#include "core/ao/slice_ao.h"
#include "core/ao/slice_turns.h"
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator*(Point a, Float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Point operator-(Point a) { return {-a.x, -a.y, -a.z}; }
inline Point cross(Point a, Point b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Point unit(Point a) { return a * (1.0F / sqrt(dot(a, a))); }

/// theta - sin(theta) cos(theta), theta in [0, pi], of cos(theta): twice the area of the unit disc's part beyond.
/// Absolute error below 5e-7. With w = 1 - |cos| it is w^(3/2) p(w) up to a right angle, p a minimax fit.
inline Float segment_area(Float cos) {
  constexpr float kPi = 3.14159265F;
  const Float w = max(1.0F - abs(cos), 0.0F);
  Float p = -1.63692131e-3F;
  p = p * w + 1.15174882e-3F;
  p = p * w - 6.91660587e-3F;
  p = p * w - 2.44298354e-2F;
  p = p * w - 2.83000827e-1F;
  p = p * w + 1.88562882F;
  const Float area = w * sqrt(w) * p;
  return select(cos < 0.0F, kPi - area, area);
}

/// Elevations are kept as t = -cos(theta), theta the angle from the view vector. One side of a slice in which the
/// projected normal has length |N'| and angle gamma: |N'| Int cos(theta - gamma) sin(theta) dtheta over an interval
/// (algorithms 9.1) is half of |N'| cos(gamma) sin^2(theta) + |N'| sin(gamma) (theta - sin(theta) cos(theta)).
struct Arc {
  Float along_view, across;  ///< |N'| cos(gamma), |N'| sin(gamma)
  Float hidden(const Intervals& list) const {
    Float squares = 0.0F, areas = 0.0F;
    for (int i = 0; i < list.size(); ++i) {
      const Interval interval = list[i];
      squares += interval.from * interval.from - interval.to * interval.to;
      areas += segment_area(-interval.to) - segment_area(-interval.from);
    }
    return 0.5F * (along_view * squares + across * areas);
  }
};

/// Index into border_planes of a pixel on the border.
HWY_INLINE Int border_place(int width, int height, Int x, Int y) {
  const Int column = select(x == Int(0), y + 2 * width, y + (2 * width + height));
  return select(y == Int(0), x, select(y == Int(height - 1), x + width, column));
}

struct SliceAoRow {
  GridSamples grid;
  Samples nx, ny, nz;
  Lens lens;
  float fx, fy;
  const DepthLevels& depth;
  Samples thickness;                    ///< of planar depth; not read where it is constant
  std::span<const BorderPlane> border;  ///< empty where it is open
  Samples depth2, thickness2;           ///< the second layer; its depth has width 0 where there is none
  const SliceAoParams& params;
  const SliceTurns& turns;
  int texel_x, texel_y;             ///< absolute texel coordinates of the grid's (0, 0)
  std::array<Intervals, 2>& lists;  ///< scratch
  float* out;
};

/// What is evaluated.
struct Receiver {
  Float x, y;  ///< pixel
  Point point, view, normal;
};

/// Unit normal of a pixel's surface seen along unit vector `along`. One that faces away is turned to the camera as
/// little as needed; without one the surface is taken to face the camera.
inline Point usable_normal(Point n, Point along) {
  const Float away = dot(n, along);
  n = select(away > 0.0F, n - along * away, n);
  const Float squared = dot(n, n);
  return select((squared > 0.01F) & (squared < 100.0F), unit(n), -along);
}

inline Receiver receiver(const SliceAoRow& row, int x0, int y, Float depth) {
  const bool every = row.grid.every_pixel;
  const Int column = row.grid.depth.clamp_x(iota(x0)), iy = y;
  const Float x = every ? to_float(iota(x0)) : row.grid.pixel_x(column, iy),
              fy = every ? to_float(iy) : row.grid.pixel_y(column, iy);
  const auto normal = [&](const Samples& s) { return every ? load(s.row(y) + x0) : s(to_int(x), to_int(fy)); };
  const Point point = unproject(row.lens, x, fy, depth);
  const Point along = row.lens.orthographic ? Point{0.0F, 0.0F, 1.0F} : unit(unproject(row.lens, x, fy, 1.0F));
  return {x, fy, point, -along, usable_normal({normal(row.nx), normal(row.ny), normal(row.nz)}, along)};
}

/// A direction from the receiver in which samples are measured: a point of planar depth z that the image shows (x, y)
/// pixels from the receiver lies at z (x per_x + y per_y) + (z - Z) per_depth, Z the receiver's depth; without
/// perspective at x per_x + y per_y + (z - Z) per_depth.
struct Axis {
  Axis(const Lens& lens, Point direction, Float along_ray)
      : per_x(direction.x * lens.inv_fx), per_y(-(direction.y * lens.inv_fy)), per_depth(along_ray) {}
  Float per_x, per_y, per_depth;
  Float beside(Float x, Float y) const { return x * per_x + y * per_y; }
};

/// A side of one slice: `across` the view vector and `toward` the camera, such that a sample beside the slice is slid
/// into it along the receiver's tangent plane, by the shortest way (ours): a surface parallel to the receiver's keeps
/// its height, so a plane never occludes itself.
struct Side {
  const Axis &across, &toward, &normal;
  float sign;     ///< of `across`: 1 or -1
  Float horizon;  ///< t of gamma + pi/2
};

/// What a sample shows in one layer, (x, y) pixels from the receiver: a surface, solid for `length` of planar depth;
/// nothing where z is 0.
struct Solid {
  Float x, y, z, length;
};

/// What the solid hides of the arc: from its front to its back, inside the sphere, where `hides`. Nothing is hidden by
/// a solid whose centre line is all below the receiver's tangent plane; the facets around it that the line stands for
/// must not hide either, or convex surfaces would hide themselves.
struct Hidden {
  Mask hides;
  Float a0, b0, a1, b1;  ///< across and towards the camera: front and back
};
HWY_INLINE Hidden hidden_by(const SliceAoRow& row, const Side& side, Float receiver_z, const Solid& solid) {
  const bool flat = row.lens.orthographic;
  const Float scale = flat ? Float(1.0F) : solid.z, behind = solid.z - receiver_z;
  const Float beside_a = side.across.beside(solid.x, solid.y) * side.sign,
              beside_b = side.toward.beside(solid.x, solid.y), beside_n = side.normal.beside(solid.x, solid.y);
  const Float a = scale * beside_a, b = scale * beside_b + behind * side.toward.per_depth,
              height = scale * beside_n + behind * side.normal.per_depth;
  // Per metre of planar depth along the sample's ray.
  const Float ra = flat ? Float(0.0F) : beside_a, rb = (flat ? 0.0F : beside_b) + side.toward.per_depth,
              rise = (flat ? 0.0F : beside_n) + side.normal.per_depth;
  // (a, b) + l (ra, rb) is inside the sphere where rr l^2 + 2 half l + outside < 0.
  const Float rr = ra * ra + rb * rb, half = a * ra + b * rb;
  const Float outside = a * a + b * b - row.params.radius_m * row.params.radius_m;
  const Float discriminant = half * half - rr * outside, root = sqrt(discriminant);
  const Float per_length = 1.0F / sqrt(rr), inv_rr = per_length * per_length;
  const Float length = row.params.thickness == ThicknessModel::constant
                           ? min(row.params.max_thickness_m * per_length, solid.length)
                           : solid.length;
  const Float first = max((-half - root) * inv_rr, 0.0F), last = min((root - half) * inv_rr, length);
  const Float a0 = a + first * ra, a1 = a + last * ra;
  const Mask above = max(height, height + length * rise) > 0.0F;
  const Mask hides = (solid.z > 0.0F) & above & (discriminant > 0.0F) & (first < last) & (min(a0, a1) > 0.0F);
  return {hides, a0, b + first * rb, a1, b + last * rb};
}

inline Interval elevations(const Hidden& hidden, Float horizon) {
  const Float from = -hidden.b0 / sqrt(hidden.a0 * hidden.a0 + hidden.b0 * hidden.b0),
              to = min(-hidden.b1 / sqrt(hidden.a1 * hidden.a1 + hidden.b1 * hidden.b1), horizon);
  return select(hidden.hides & (from < to), {from, to}, no_interval());
}

/// The way of a side through the image: pixels from sample to sample along the longer axis, and how many.
struct Way {
  Float dx, dy, longest_px;
};
/// The tangent to the sphere leaves the eye at asin(R / |P|) from the receiver's ray, also off axis; a sphere around
/// the camera, or one that reaches beside it, has no end in the image.
struct Reach {
  Float slope_x, slope_y;  ///< of the receiver's ray
  Float sine;
  Point back;  ///< the view vector times the cosine
};
inline Reach reach(const SliceAoRow& row, const Receiver& at) {
  const Point ray = unproject(row.lens, at.x, at.y, 1.0F);
  const Float sine = row.params.radius_m / sqrt(dot(at.point, at.point));
  return {ray.x, ray.y, sine, at.view * sqrt(1.0F - sine * sine)};
}
inline Way way(const SliceAoRow& row, const Reach& reach, Point across) {
  if (row.lens.orthographic) {
    const Float x = across.x * row.params.radius_m * row.fx, y = -across.y * row.params.radius_m * row.fy;
    const Float longest = max(abs(x), abs(y));
    return {x / longest, y / longest, longest};
  }
  const Point edge = across * reach.sine - reach.back;
  const Float inv_z = 1.0F / edge.z;
  Float x = (edge.x * inv_z - reach.slope_x) * row.fx, y = (reach.slope_y - edge.y * inv_z) * row.fy;
  const Mask ends = (reach.sine < 1.0F) & (edge.z > 0.0F);
  x = select(ends, x, (across.x - reach.slope_x * across.z) * row.fx);
  y = select(ends, y, (reach.slope_y * across.z - across.y) * row.fy);
  constexpr float kBeyond = 1e6F;
  const Float longest = max(abs(x), abs(y)), inv_longest = 1.0F / longest;
  return {x * inv_longest, y * inv_longest, select(ends, longest, kBeyond)};
}

/// A pixel that is read, its depth, and whether it is inside the image.
struct Sample {
  Float x, y, z;
  Int ix, iy;
  Mask inside;
};

/// What pixel (x, y), r pixels from the receiver, shows. mip = clamp(floor(log2(r)) - 3, 0, 5): algorithms 4.2.
HWY_INLINE Sample sample(const SliceAoRow& row, Float x, Float y, Float r) {
  const Samples& image = row.depth.image;
  const Float cx = clamp(x, 0.0F, static_cast<float>(image.width - 1)),
              cy = clamp(y, 0.0F, static_cast<float>(image.height - 1));
  const Int ix = to_int(cx), iy = to_int(cy);
  const Mask inside = (cx == x) & (cy == y);
  if (row.depth.count == 1) return {x, y, image(ix, iy), ix, iy, inside};
  const Int level = clamp(floor_log2(r) - Int(kLogMaxOffset), 0, row.depth.count - 1);
  const DepthSample s = depth_sample(row.depth, ix, iy, level);
  return {to_float(s.x), to_float(s.y), s.z, s.x, s.y, inside};
}

/// Outside the image, the surface of the border goes on as a plane (ours).
inline Sample beyond_border(const SliceAoRow& row, const Sample& s, Float x, Float y) {
  const Samples& image = row.depth.image;
  const Int ix = image.clamp_x(to_int(x)), iy = image.clamp_y(to_int(y));
  const float* plane = row.border.front().data();
  const Int place = border_place(image.width, image.height, ix, iy) * 3;
  const Point slope = unproject(row.lens, x, y, 1.0F);
  const Float sum = gather(plane, place) * slope.x + gather(plane + 1, place) * slope.y + gather(plane + 2, place);
  const Float z = row.lens.orthographic ? sum : 1.0F / sum;
  return {select(s.inside, s.x, x),   select(s.inside, s.y, y),   select(s.inside, s.z, z),
          select(s.inside, s.ix, ix), select(s.inside, s.iy, iy), s.inside};
}

/// Both sides of a slice, and what was found on them so far.
struct Slice {
  std::array<Side, 2> sides;
  std::array<Way, 2> ways;
  std::array<Intervals, 2>& lists;
};

/// Samples from the receiver outwards, i + (r - steps) ((i - offset) / steps)^2 pixels away: every pixel near, wider
/// apart far away (XeGTAO distributes by the square too, algorithms 9.2).
struct Spacing {
  Float count, growth;
  Spacing(const SliceAoRow& row, const Way& way) {
    const auto longest = static_cast<float>(std::max(row.depth.image.width, row.depth.image.height));
    const Float last = floor(min(way.longest_px, longest) + 0.5F);
    count = row.params.steps > 0 ? min(last, static_cast<float>(row.params.steps)) : last;
    growth = (last - count) / (count * count);
  }
  Float at(float step, Float offset) const {
    const Float k = step - offset;
    return step + floor(growth * k * k);
  }
};

/// What the layers show at the sample of a step: `found` has room for both.
HWY_INLINE void look(const SliceAoRow& row, const Receiver& at, const Way& way, const Spacing& spacing, float step,
                     Float offset, Solid* found) {
  const Float r = spacing.at(step, offset), x = at.x + round(way.dx * r), y = at.y + round(way.dy * r);
  Mask wanted = step <= spacing.count;
  Sample s = sample(row, x, y, r);
  if (!all(s.inside | !wanted)) {
    if (row.border.empty())
      wanted = wanted & s.inside;
    else
      s = beyond_border(row, s, x, y);
  }
  const bool constant = row.params.thickness == ThicknessModel::constant;
  Float length = constant ? Float(HUGE_VALF) : row.thickness(s.ix, s.iy);
  const Mask there = wanted & is_surface(s.z);
  if (row.depth2.width > 0) {
    const Float z2 = row.depth2(s.ix, s.iy);
    const Mask covers = there & s.inside & is_surface(z2) & (z2 > s.z);
    found[1] = {s.x - at.x, s.y - at.y, select(covers, z2, 0.0F), constant ? length : row.thickness2(s.ix, s.iy)};
    length = select(covers, min(length, z2 - s.z), length);
  }
  found[0] = {s.x - at.x, s.y - at.y, select(there, s.z, 0.0F), length};
}

/// Samples are looked up, then measured, then united: within one such loop no turn waits for another.
HWY_INLINE void search(const SliceAoRow& row, const Receiver& at, Float offset, Slice& slice) {
  constexpr int kBatch = 4;  // steps
  const std::array<Spacing, 2> spacing{Spacing(row, slice.ways[0]), Spacing(row, slice.ways[1])};
  const int layers = row.depth2.width > 0 ? 2 : 1;
  Solid found[kBatch * 2][2];
  Interval hidden[kBatch * 2][2];
  for (Intervals& list : slice.lists) list.clear();
  for (int first = 1;; first += kBatch) {
    int turns = 0;
    for (; turns < 2 * kBatch; ++turns) {
      const auto side = static_cast<size_t>(turns & 1);
      const auto step = static_cast<float>(first + turns / 2);
      if (side == 0 && !any(step <= max(spacing[0].count, spacing[1].count))) break;
      look(row, at, slice.ways[side], spacing[side], step, offset, found[turns]);
    }
    for (int layer = 0; layer < layers; ++layer)
      for (int i = 0; i < turns; ++i) {
        const Side& side = slice.sides[static_cast<size_t>(i & 1)];
        hidden[i][layer] = elevations(hidden_by(row, side, at.point.z, found[i][layer]), side.horizon);
      }
    for (int i = 0; i < turns; ++i)
      for (int layer = 0; layer < layers; ++layer) slice.lists[static_cast<size_t>(i & 1)].unite(hidden[i][layer]);
    if (turns < 2 * kBatch) break;
  }
}

/// 1 - sum |N'| hidden / sum |N'| whole over the slices (algorithms 9.1 and 9.3; GTAO has the mean of |N'| whole, which
/// is 1 only for many slices).
inline Float visibility(const SliceAoRow& row, const Receiver& at, int turn_x, int turn_y) {
  const Point reference = select(abs(at.view.x) < 0.7F, Point{1.0F, 0.0F, 0.0F}, Point{0.0F, 1.0F, 0.0F});
  const Point s = unit(cross(at.view, reference)), t = cross(at.view, s);
  const Reach sphere = reach(row, at);
  const Point ray{sphere.slope_x, sphere.slope_y, 1.0F};
  const Axis normal(row.lens, at.normal, row.lens.orthographic ? at.normal.z : dot(at.normal, ray));
  const Float from_camera = dot(at.view, row.lens.orthographic ? Point{0.0F, 0.0F, 1.0F} : ray);
  const Float offset = load(row.turns.offsets(turn_y) + turn_x);
  Float hidden = 0.0F, whole = 0.0F;
  for (int k = 0; k < row.params.slices; ++k) {
    const Point across = s * load(row.turns.cos(turn_y, k) + turn_x) + t * load(row.turns.sin(turn_y, k) + turn_x);
    const Point beside = cross(across, at.view);
    const Float nd = dot(at.normal, across), nv = dot(at.normal, at.view), ne = dot(at.normal, beside);
    const Float squared = nd * nd + nv * nv, length = sqrt(squared), slide = ne / squared;
    const Mask stands = length > 1e-4F;  // else the slice's plane is the tangent plane
    const Axis a(row.lens, across + beside * (slide * nd), 0.0F),
        b(row.lens, at.view + beside * (slide * nv), from_camera);
    const Float horizon = nd / length;
    Slice slice{{Side{a, b, normal, 1.0F, horizon}, Side{a, b, normal, -1.0F, -horizon}},
                {way(row, sphere, across), way(row, sphere, -across)},
                row.lists};
    search(row, at, offset, slice);
    hidden += select(stands, Arc{nv, nd}.hidden(row.lists[0]) + Arc{nv, -nd}.hidden(row.lists[1]), 0.0F);
    // Both sides up to gamma +- pi/2, where sin^2(theta) = cos^2(gamma).
    const Float open = nv * (1.0F - horizon * horizon) + nd * (segment_area(-horizon) - 1.57079633F);
    whole += select(stands, open, 0.0F);
  }
  return select(whole > 0.0F, clamp(1.0F - hidden / whole, 0.0F, 1.0F), 1.0F);
}

inline void slice_ao_row(const SliceAoRow& row, int y) {
  const int turn_y = row.turns.cell(y + row.texel_y), width = row.grid.depth.width;
  for (int x0 = 0; x0 < width; x0 += kLanes) {
    const Float depth = load(row.grid.depth.row(y) + x0);
    const Mask here = is_surface(depth) & (iota(x0) < Int(width));
    Float out = 1.0F;
    if (any(here)) {
      const Receiver at = receiver(row, x0, y, select(here, depth, 1.0F));
      out = select(here, visibility(row, at, row.turns.cell(x0 + row.texel_x), turn_y), 1.0F);
    }
    store(row.out + x0, out);
  }
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
