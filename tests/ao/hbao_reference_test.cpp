#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "core/ao/hbao.h"
#include "tests/filter/analytic_surface.h"

/// HBAO against a twin written from the SDK's description, and against its own continuous integral.
namespace aftershade::tests {
namespace {

using ao::HbaoBorder;
using ao::HbaoParams;
using ao::Resolution;
using ao::Tangents;

double sine(double tangent) { return tangent / std::sqrt(1 + tangent * tangent); }
double turns(double t) { return 2 * std::numbers::pi * t; }

/// One pixel at a time, in double, with points in space: algorithms 1.2.
struct Twin {
  const HbaoParams& params;
  const Picture& p;
  Lens lens;
  int pitch;  ///< pixels from texel to texel

  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < p.depth.width() && y < p.depth.height(); }
  bool is_surface(int x, int y) const { return inside(x, y) && std::isfinite(p.depth(x, y)) && p.depth(x, y) > 0; }
  Vec3 point(int x, int y) const { return lens.point(p.origin_x + x + 0.5, p.origin_y + y + 0.5, p.depth(x, y)); }
  Vec3 ray(int x, int y) const {
    return lens.orthographic ? Vec3(0, 0, 1) : lens.ray(p.origin_x + x + 0.5, p.origin_y + y + 0.5);
  }

  Vec3 edge_to_nearer(int x, int y, int dx, int dy) const {
    const bool minus = is_surface(x - dx, y - dy), plus = is_surface(x + dx, y + dy);
    const Vec3 here = point(x, y);
    const Vec3 to_minus = minus ? here - point(x - dx, y - dy) : Vec3(0, 0, 0);
    const Vec3 to_plus = plus ? here - point(x + dx, y + dy) : Vec3(0, 0, 0);
    return minus && (!plus || to_minus.length() < to_plus.length()) ? to_minus : to_plus;
  }

  Vec3 normal(int x, int y) const {
    if (params.tangents == Tangents::normals) return {p.normals[0](x, y), p.normals[1](x, y), p.normals[2](x, y)};
    return edge_to_nearer(x, y, pitch, 0).cross(edge_to_nearer(x, y, 0, pitch));
  }

  /// In the tangent plane, above the image's line from the pixel toward the offset.
  double lifted_tangent(const Vec3& n, int x, int y, int ox, int oy) const {
    const Vec3 across(ox / static_cast<double>(lens.fx), -oy / static_cast<double>(lens.fy), 0), r = ray(x, y);
    const Vec3 t = across - r * (n.dot(across) / n.dot(r));
    const double lift = std::tan(static_cast<double>(params.bias_deg) * std::numbers::pi / 180);
    return -t.z / std::hypot(t.x, t.y) + lift;
  }

  double visibility(int x, int y, int texel_x, int texel_y) const {
    if (!is_surface(x, y)) return 1;
    const double R = params.radius_m, scale = lens.orthographic ? 1 : 1 / static_cast<double>(p.depth(x, y));
    const double r_px = R * lens.fy * scale / pitch;
    if (r_px < 1) return 1;
    const size_t cell = static_cast<size_t>((texel_y & 3) * 4 + (texel_x & 3));
    const double rotation = ao::hbao_pattern().rotation[cell], shift = ao::hbao_pattern().shift[cell];
    double n = std::min<double>(params.steps, r_px), step = r_px / (n + 1);
    const double limit = static_cast<double>(params.max_footprint) * p.display_height / (params.literal ? 2.0 : pitch);
    if (params.max_footprint > 0 && limit / step < n) {
      n = std::max(std::floor(limit / step + shift), 1.0);
      step = limit / n;
    }
    const Vec3 here = point(x, y), plane = normal(x, y);
    double sum = 0, all_weights = 0;
    for (int i = 0; i < params.directions; ++i) {
      const double angle = turns((i + rotation) / params.directions);
      const double ux = std::cos(angle) * lens.fx / lens.fy, uy = std::sin(angle);
      const auto snap = [](double v) { return static_cast<int>(std::lround(v)); };
      double tan_horizon = 0, own_lift = 0, found = 0, weights = 0, weights_inside = 0;
      const auto take = [&](int ox, int oy, double lifted, bool first) {
        if (first || !params.literal) {  // the horizon keeps its height above the tangent of the tap
          tan_horizon += lifted - own_lift;
          own_lift = lifted;
        }
        if (first) tan_horizon = lifted;
        const int tx = x + ox * pitch, ty = y + oy * pitch;
        const double q = std::hypot(ox * static_cast<double>(lens.fy) / lens.fx, oy) / r_px;
        weights += std::max(0.0, 1 - q * q);
        if (inside(tx, ty)) weights_inside += std::max(0.0, 1 - q * q);
        const int seen_x = std::clamp(tx, 0, p.depth.width() - 1), seen_y = std::clamp(ty, 0, p.depth.height() - 1);
        if (!is_surface(seen_x, seen_y) || (params.border != HbaoBorder::clamp && !inside(tx, ty))) return;
        const Vec3 v = lens.point(p.origin_x + tx + 0.5, p.origin_y + ty + 0.5, p.depth(seen_x, seen_y)) - here;
        const double tangent = -v.z / std::hypot(v.x, v.y);
        if (!(v.length() < R && tangent > tan_horizon)) return;
        found += (1 - v.dot(v) / (R * R)) * (sine(tangent) - sine(tan_horizon));
        tan_horizon = tangent;
      };
      const int nx = snap(ux * (shift * step + 1)), ny = snap(uy * (shift * step + 1));
      take(nx, ny, lifted_tangent(plane, x, y, nx, ny), true);
      const int sx = snap(ux * step), sy = snap(uy * step);
      const double line = lifted_tangent(plane, x, y, sx, sy);
      if (params.literal) tan_horizon = std::max(line, tan_horizon > own_lift ? tan_horizon : line);
      for (int j = 1; j <= n - 1; ++j) {
        if (params.literal) {
          take(snap(ux * shift * step) + j * sx, snap(uy * shift * step) + j * sy, line, false);
        } else {
          const int ox = snap(ux * (shift + j) * step), oy = snap(uy * (shift + j) * step);
          take(ox, oy, lifted_tangent(plane, x, y, ox, oy), false);
        }
      }
      // A direction counts by what is seen of it.
      const double weight = params.border == HbaoBorder::renormalise ? weights_inside / weights : 1;
      sum += found * weight;
      all_weights += weight;
    }
    if (all_weights == 0) return 1;
    return std::clamp(1 - static_cast<double>(params.strength) * sum / all_weights, 0.0, 1.0);
  }
};

/// Bumps of several sizes in front of a hole of background.
View bumps(const Lens& lens) {
  return [=](double x, double y) {
    if (x > 60 && x < 80 && y > 30 && y < 45) return Hit{};
    const double u = x / 17, v = y / 11;
    const double z = 3 + 0.4 * std::sin(u) * std::cos(v) + (x + 2 * y > 150 ? 0.7 : 0.0);
    return Hit{z, (lens.ray(x, y) * -1 + Vec3(0.3 * std::cos(u), 0.2 * std::sin(v), 0)).normalized()};
  };
}

/// Pixels of the grid where the two differ by more than rounding; a tap may round to the other texel.
int texels_off(const HbaoParams& params, const Picture& p, const Lens& lens, double& dark) {
  const bool half = params.resolution == Resolution::half;
  const filter::SampleGrid grid = half ? filter::half_grid(p.surface()) : filter::full_grid(p.surface());
  const Plane fast = ao::hbao(params, p.surface(), grid, 0);
  const Twin twin{params, p, lens, grid.step};
  int off = 0;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const int px = half ? static_cast<int>(grid.pixel_x(x, y)) : x,
                py = half ? static_cast<int>(grid.pixel_y(x, y)) : y;
      const int first_x = half ? (p.origin_x - (p.origin_x & 1)) / 2 : p.origin_x,
                first_y = half ? (p.origin_y - (p.origin_y & 1)) / 2 : p.origin_y;
      const double exact = twin.visibility(px, py, first_x + x, first_y + y);
      off += !(std::abs(fast(x, y) - exact) < 1e-4);
      dark += 1 - exact;
    }
  return off;
}

TEST(HbaoReference, AgreesWithTheTwin) {
  for (const bool orthographic : {false, true})
    for (const bool literal : {false, true})
      for (const Tangents tangents : {Tangents::shorter_difference, Tangents::normals})
        for (const Resolution resolution : {Resolution::full, Resolution::half}) {
          const Lens lens{120, 100, 71, 43, orthographic};
          const Picture p = picture(141, 97, lens, bumps(lens), -5, 3);
          HbaoParams params;
          params.literal = literal;
          params.tangents = tangents;
          params.resolution = resolution;
          params.border = orthographic ? HbaoBorder::renormalise : literal ? HbaoBorder::clamp : HbaoBorder::open;
          double dark = 0;
          const int off = texels_off(params, p, lens, dark);
          const int texels = resolution == Resolution::full ? 141 * 97 : 71 * 49;
          EXPECT_LE(off, texels / 1000) << orthographic << literal << static_cast<int>(tangents)
                                        << static_cast<int>(resolution);
          EXPECT_GT(dark, texels / 100);
        }
}

/// A floor and a perpendicular wall seen from 45 degrees: z = z0 - |Y|, distance from the edge sqrt(2) |Y|.
constexpr float kCornerFocal = 520;
constexpr int kCornerRows = 1280;
const Picture& corner() {
  static const Picture made = [] {
    const Lens lens{kCornerFocal, kCornerFocal, 0, 0, true};
    constexpr int kColumns = 1060;
    return picture(
        kColumns, kCornerRows, lens,
        [](double, double y) {
          const double h = -y / static_cast<double>(kCornerFocal);
          return Hit{10 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
        },
        -kColumns / 2, -kCornerRows / 2);
  }();
  return made;
}
int corner_row(double distance) {
  return kCornerRows / 2 + static_cast<int>(distance / std::numbers::sqrt2 * static_cast<double>(kCornerFocal));
}
double corner_distance(int row) {
  return (row + 0.5 - kCornerRows / 2) / static_cast<double>(kCornerFocal) * std::numbers::sqrt2;
}

/// The occlusion with infinitely many directions and steps, R = 1: per azimuth, the integral of (1 - r^2) over the sine
/// of the rising horizon.
double corner_integral(double distance, double bias_deg) {
  const double h = -distance / std::numbers::sqrt2, lift = std::tan(bias_deg * std::numbers::pi / 180);
  constexpr int kAngles = 720, kRadii = 4000;
  double sum = 0;
  for (int k = 0; k < kAngles; ++k) {
    const double rise = std::sin(turns((k + 0.5) / kAngles));
    double tan_horizon = -rise + lift;  // of the floor: z grows with the height in the image
    for (int i = 0; i < kRadii; ++i) {
      const double r = (i + 0.5) / kRadii, nearer = std::abs(h + r * rise) - std::abs(h), d2 = r * r + nearer * nearer;
      if (d2 >= 1 || nearer / r <= tan_horizon) continue;
      sum += (1 - d2) * (sine(nearer / r) - sine(tan_horizon));
      tan_horizon = nearer / r;
    }
  }
  return sum / kAngles;
}

/// Occlusion at four pixels of a row: its mean and spread over the pattern's 16 phases and `frames` of noise.
struct Spread {
  double mean = 0, deviation = 0;
};
Spread corner_occlusion(HbaoParams params, int row, int frames) {
  const Picture& p = corner();
  params.max_footprint = 0;
  params.per_frame_noise = true;
  filter::SampleGrid grid;
  grid.step = 2;  // AO only where it is looked at: 4 picked pixels
  grid.depth = Plane(4, 1, p.depth(0, row));
  grid.pixel_x = Plane(4, 1, static_cast<float>(p.depth.width() / 2));
  grid.pixel_y = Plane(4, 1, static_cast<float>(row));
  double sum = 0, squares = 0;
  for (int frame = 0; frame < frames; ++frame)
    for (grid.origin_y = 0; grid.origin_y < 8; grid.origin_y += 2) {  // the pattern's rows
      const Plane out = ao::hbao(params, p.surface(), grid, frame);
      for (int x = 0; x < 4; ++x) {
        sum += 1 - out(x, 0);
        squares += std::pow(1 - out(x, 0), 2);
      }
    }
  const double n = 16 * frames, mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

struct CornerEntry {
  double distance, no_bias, bias_10;
};
/// algorithms 12.1, columns "HBAO b=0" and "HBAO b=10deg".
constexpr CornerEntry kCorner[] = {{.05, .451, .399}, {.10, .405, .357}, {.20, .320, .279},
                                   {.35, .211, .181}, {.50, .125, .105}, {.70, .045, .035}};

TEST(HbaoReference, CornerMatchesItsContinuousIntegralAndTheTable) {
  HbaoParams params;
  params.directions = 128;
  params.steps = 256;
  for (const CornerEntry& entry : kCorner)
    for (const float bias_deg : {0.0F, 10.0F}) {
      const double published = bias_deg == 0 ? entry.no_bias : entry.bias_10;
      EXPECT_NEAR(corner_integral(entry.distance, bias_deg), published, 0.003);
      const int row = corner_row(entry.distance);
      const double exact = corner_integral(corner_distance(row), bias_deg);
      params.bias_deg = bias_deg;
      for (const Tangents tangents : {Tangents::shorter_difference, Tangents::normals}) {
        params.tangents = tangents;
        const Spread measured = corner_occlusion(params, row, 1);
        std::printf("d = %.4f (table %.2f), bias %2.0f: integral %.4f, measured %.4f, published %.3f\n",
                    corner_distance(row), entry.distance, static_cast<double>(bias_deg), exact, measured.mean,
                    published);
        EXPECT_NEAR(measured.mean, exact, 0.01);
      }
    }
}

TEST(HbaoReference, EightBySixScattersAroundTheIntegral) {
  for (const bool literal : {false, true})
    for (const CornerEntry& entry : kCorner) {
      HbaoParams params;
      params.literal = literal;
      const int row = corner_row(entry.distance);
      const double exact = corner_integral(corner_distance(row), 10);
      const Spread few = corner_occlusion(params, row, 1);
      std::printf("8x6%s at d = %.2f R: mean %.4f, deviation %.4f, integral %.4f\n", literal ? " literal" : "",
                  entry.distance, few.mean, few.deviation, exact);
      EXPECT_NEAR(few.mean, exact, 0.03);
      EXPECT_LT(few.deviation, 0.01);
    }
}

}  // namespace
}  // namespace aftershade::tests
