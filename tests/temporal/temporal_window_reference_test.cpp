#include <map>
#include <numbers>
#include <optional>

#include "tests/temporal/window_helpers.h"

/// The two-sided window written once more, from its description: one pixel at a time, in double, recursive.
namespace aftershade::tests {
namespace {

using temporal::ChangeTest;

bool is_surface(double z) { return std::isfinite(z) && z > 0; }
bool is_known(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y); }

struct Fetched {
  double weight = 0, difference = 0, depth = 0;
  Vec3 vector{kNaN, kNaN, 0};
};
struct Place {
  Vec3 at;  ///< z: depth
  bool still;
  Vec3 vector;  ///< onward from there, NaN: unknown
};

class Twin {
 public:
  Twin(const TemporalWindowParams& params, const std::vector<WindowFrame>& frames, int centre)
      : params_(params), frames_(frames), centre_(centre) {
    for (int d = -params.frames; d <= params.frames; ++d)
      if (d != 0) differences_[d] = gathered(d);
  }

  double ao(int i, int j) const {
    const double own = std::isfinite(frame(0).ao(i, j)) ? frame(0).ao(i, j) : 1;
    double sum = 0, weights = 1;
    for (const auto& [d, pixels] : differences_) {
      const Fetched& f = pixels[index(i, j)];
      if (!(f.weight > 0)) continue;
      double w = window_weight(std::abs(d), params_.frames) * f.weight;
      if (params_.change_test == ChangeTest::everywhere) w *= trust_of_pair(i, j, d);
      sum += w * f.difference;
      weights += w;
    }
    return own + sum / weights;
  }

 private:
  using Pixels = std::vector<Fetched>;
  const WindowFrame& frame(int d) const { return frames_[static_cast<size_t>(centre_ + d)]; }
  size_t index(int i, int j) const { return static_cast<size_t>(j * frame(0).window.width() + i); }

  Vec3 vector_at(int d, int i, int j, bool towards_past) const {
    const auto& mv = towards_past ? frame(d).mv_prev : frame(d).mv_next;
    return {mv.x(i, j), mv.y(i, j), 0};
  }

  Place start(int i, int j, bool past) const {
    const Window& w = frame(0).window;
    return {{w.min_x + i + 0.5, w.min_y + j + 0.5, frame(0).depth(i, j)}, true, vector_at(0, i, j, past)};
  }

  /// Pixels on trajectories: from place `p` in frame d to frame d + step.
  std::optional<Place> moved(const Place& origin, const Place& p, int d, int step) const {
    const auto direct = CameraReprojection::create(frame(p.still ? 0 : d).camera, frame(d + step).camera);
    const Vec3 from = p.still ? origin.at : p.at, camera = (*direct)(from.x, from.y, from.z);
    if (!is_known(p.vector)) return p.still ? std::optional<Place>({camera, true, {}}) : std::nullopt;
    const Vec3 target = p.at + Vec3(p.vector.x, p.vector.y, 0);
    if (std::hypot(camera.x - target.x, camera.y - target.y) <= params_.agreement_px) return Place{camera, p.still, {}};
    return Place{{target.x, target.y, camera.z}, false, {}};
  }

  Fetched fetch(int i, int j, const Place& p, int d, Vec3 back) const {
    const WindowFrame& there = frame(d);
    const Mat4 turn = CameraReprojection::create(frame(0).camera, there.camera)->delta();
    const auto normal_of = [](const WindowFrame& f, int x, int y) { return Vec3(f.nx(x, y), f.ny(x, y), f.nz(x, y)); };
    Vec3 normal = transform_direction(normal_of(frame(0), i, j), turn);
    const double own = std::isfinite(frame(0).ao(i, j)) ? frame(0).ao(i, j) : 1;
    const Vec3 expected = there.camera.unproject(p.at.x, p.at.y, p.at.z);
    const double footprint = p.at.z / std::min(there.camera.fx, there.camera.fy);
    const double tolerance = std::max<double>(params_.distance_m, params_.distance_footprints * footprint) +
                             (p.still ? 0 : params_.moving_depth * p.at.z);
    Fetched out;
    double known = 0;
    Vec3 vector(0);
    for (int tap = 0; tap < 4; ++tap) {
      const int x = static_cast<int>(std::floor(p.at.x - 0.5)) + tap % 2,
                y = static_cast<int>(std::floor(p.at.y - 0.5)) + tap / 2;
      if (!there.window.contains(x, y)) continue;
      const int a = x - there.window.min_x, b = y - there.window.min_y;
      const double z = there.depth(a, b), ao = there.ao(a, b);
      if (!is_surface(z) || !std::isfinite(ao)) continue;
      const Vec3 v = there.camera.unproject(x + 0.5, y + 0.5, z) - expected;
      if (std::abs(normal.length() > 0 ? v.dot(normal) : v.z) > tolerance) continue;
      const Vec3 other = normal_of(there, a, b);
      if (other.length() > 0 && normal.length() > 0 &&
          other.dot(normal) < std::cos(params_.normal_deg * std::numbers::pi / 180))
        continue;
      const Vec3 inward = vector_at(d, a, b, d > 0);
      if (is_known(inward) && (inward - back).length() >= 0.5 + 0.05 * back.length()) continue;
      const double w = (1 - std::abs(p.at.x - x - 0.5)) * (1 - std::abs(p.at.y - y - 0.5));
      out.weight += w;
      out.difference += w * (ao - own);
      out.depth += w * z;
      const Vec3 outward = vector_at(d, a, b, d < 0);
      if (!is_known(outward)) continue;
      known += w;
      vector += outward * w;
    }
    if (out.weight < 0.25) return {};
    return {out.weight, out.difference / out.weight, out.depth / out.weight, vector / known};
  }

  /// Follows pixel (i, j) to frame d.
  Fetched follow(int i, int j, int d) const {
    const int step = d < 0 ? -1 : 1;
    const Place origin = start(i, j, step < 0);
    if (!is_surface(origin.at.z)) return {};
    Place here = origin;
    Fetched found;
    for (int at = 0; at != d; at += step) {
      const auto next = moved(origin, here, at, step);
      if (!next || !(next->at.z > 0)) return {};
      found = fetch(i, j, *next, at + step, Vec3(here.at.x - next->at.x, here.at.y - next->at.y, 0));
      if (!next->still && !(found.weight > 0)) return {};
      here = *next;
      if (!here.still) here.at.z = found.depth;
      here.vector = found.weight > 0 ? found.vector : Vec3(kNaN, kNaN, 0);
    }
    return found;
  }

  Pixels gathered(int d) const {
    const Window& w = frame(0).window;
    Pixels out;
    for (int j = 0; j < w.height(); ++j)
      for (int i = 0; i < w.width(); ++i) out.push_back(follow(i, j, d));
    return out;
  }

  /// Does the camera explain the step to the frame before?
  bool stands_still(int i, int j) const {
    const Place origin = start(i, j, true);
    return moved(origin, origin, 0, -1)->still;
  }

  /// S of frame d: along x at every row, then along y, each weighed by the relative depth of its own centre.
  double mean_change(int i, int j, int d) const {
    if (d == 0) return 0;
    const int step = std::max(1, static_cast<int>(std::lround(params_.neighbourhood_px / 4)));
    const auto share = [&](int x, int y, int to_x, int to_y, int t) {
      const Window& w = frame(0).window;
      if (to_x < 0 || to_x >= w.width() || to_y < 0 || to_y >= w.height()) return 0.0;
      const double z = frame(0).depth(x, y), other = frame(0).depth(to_x, to_y);
      if (!is_surface(z) || !is_surface(other) || stands_still(x, y) != stands_still(to_x, to_y)) return 0.0;
      return std::exp2(-(t * t / (2 * 2.5 * 2.5) + std::pow((other / z - 1) / 0.1, 2)));
    };
    double sum = 0, weights = 0;
    for (int v = -4; v <= 4; ++v) {
      const int y = j + v * step;
      const double down = share(i, j, i, y, v);
      for (int u = -4; down > 0 && u <= 4; ++u) {
        const int x = i + u * step;
        const double across = share(i, y, x, y, u);
        if (!(across > 0)) continue;
        const Fetched& f = differences_.at(d)[index(x, y)];
        sum += down * across * f.weight * f.difference;
        weights += down * across * f.weight;
      }
    }
    return weights > 0 ? sum / weights : 0;
  }

  bool seen(int i, int j, int d) const {
    return std::abs(d) <= params_.frames && (d == 0 || differences_.at(d)[index(i, j)].weight > 0);
  }
  double noise(int i, int j) const {
    std::vector<double> thirds;
    for (int d = 1 - params_.frames; d + 1 < params_.frames; ++d)
      if (seen(i, j, d - 1) && seen(i, j, d) && seen(i, j, d + 1) && seen(i, j, d + 2))
        thirds.push_back(std::abs(mean_change(i, j, d + 2) - 3 * mean_change(i, j, d + 1) + 3 * mean_change(i, j, d) -
                                  mean_change(i, j, d - 1)));
    if (thirds.empty()) return 0;
    std::sort(thirds.begin(), thirds.end());
    return 1.4826 * thirds[thirds.size() / 2] / std::sqrt(20.0);
  }
  double trusted(int i, int j, double change, double share) const {
    double reference = 0, weights = 1;
    for (int d : {-1, 1}) {
      if (!seen(i, j, -1) || !seen(i, j, 1)) break;
      reference += differences_.at(d)[index(i, j)].weight * mean_change(i, j, d);
      weights += differences_.at(d)[index(i, j)].weight;
    }
    const double sigma = params_.significance * noise(i, j), off = change - reference / weights;
    const double t = off * off / (share * sigma * sigma + std::pow(params_.change, 2));
    return 1 / (1 + t * t);
  }
  double trust(int i, int j, int d) const { return trusted(i, j, mean_change(i, j, d), 1); }
  double trust_of_pair(int i, int j, int d) const {
    if (!seen(i, j, -d)) return trusted(i, j, mean_change(i, j, d), 0);
    return std::max(std::min(trust(i, j, d), trust(i, j, -d)),
                    trusted(i, j, (mean_change(i, j, d) + mean_change(i, j, -d)) / 2, 0.5));
  }

  TemporalWindowParams params_;
  const std::vector<WindowFrame>& frames_;
  int centre_;
  std::map<int, Pixels> differences_;
};

/// A threshold may fall between float and double: at most one pixel in five hundred may differ.
void expect_equal(const TemporalWindowParams& params, const std::vector<WindowFrame>& frames, int centre) {
  const Twin twin(params, frames, centre);
  const WindowedAo got = windowed(params, frames, static_cast<size_t>(centre));
  const WindowFrame& frame = frames[static_cast<size_t>(centre)];
  int differing = 0, changed = 0;
  for (int y = 0; y < got.ao.height(); ++y)
    for (int x = 0; x < got.ao.width(); ++x) {
      if (std::abs(got.ao(x, y) - twin.ao(x, y)) > 2e-4) ++differing;
      if (got.ao(x, y) != frame.ao(x, y)) ++changed;
    }
  EXPECT_LE(differing, got.ao.width() * got.ao.height() / 500);
  EXPECT_GT(changed, got.ao.width() * got.ao.height() / 2);
}

TEST(TemporalWindowReference, GatheringEqualsTheTwin) {
  TemporalWindowParams params;
  params.frames = 4;
  params.change_test = ChangeTest::never;
  expect_equal(params, busy_frames(9), 4);
}

TEST(TemporalWindowReference, TheTestOfChangesEqualsTheTwin) {
  // AO that is wide in space: part of it changes from frame to frame, part of it is noise.
  std::vector<WindowFrame> frames = busy_frames(7);
  for (WindowFrame& frame : frames)
    for (int y = 0; y < frame.ao.height(); ++y)
      for (int x = 0; x < frame.ao.width(); ++x) {
        const double moving = 20 + 3.0 * frame.number - x - frame.window.min_x;
        frame.ao(x, y) = static_cast<float>(1 - 0.5 / (1 + 0.02 * moving * moving) + 0.05 * frame.ao(x, y));
      }
  TemporalWindowParams params;
  params.frames = 3;
  params.change = 0.01F;
  params.change_test = ChangeTest::everywhere;
  expect_equal(params, frames, 3);
}

}  // namespace
}  // namespace aftershade::tests
