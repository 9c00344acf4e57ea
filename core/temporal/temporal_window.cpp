#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/temporal/temporal_window.cpp"  // this file, compiled once a SIMD target
#include "core/temporal/temporal_window.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "core/temporal/moving_surfaces.h"
#include "core/temporal/temporal_window_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

/// The mean of a neighbour's differences around each pixel of the centre; `step`: from tap to tap.
Plane mean_around(const Plane& centre_depth, const Plane& still_pixels, const Plane& difference,
                  const Plane& difference_weight, int step) {
  const int width = centre_depth.width(), height = centre_depth.height();
  Plane value(width, height), along(width, height), along_weight(width, height), weight(width, height);
  for_rows(height, [&](int y) { product_row(difference.row(y), difference_weight.row(y), width, value.row(y)); });
  const Samples depth(centre_depth), still(still_pixels);
  for_rows(height, [&](int y) {
    neighbourhood_row(
        {depth, still, Samples(value), Samples(difference_weight), step, 0, along.row(y), along_weight.row(y)}, y);
  });
  for_rows(height, [&](int y) {
    neighbourhood_row({depth, still, Samples(along), Samples(along_weight), 0, step, value.row(y), weight.row(y)}, y);
    quotient_row(weight.row(y), width, value.row(y));
  });
  return value;
}

void filter_row(const WindowRow& row) { window_row(row); }

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::temporal {

namespace {

HWY_EXPORT(mean_around);
HWY_EXPORT(filter_row);

/// A frame of the window, seen from the centre.
struct Neighbour {
  Plane difference, weight;
  Plane change, tested;  ///< empty where nothing is tested
};

using Frames = std::span<const WindowFrame* const>;

void require_planes(const WindowFrame& frame) {
  const auto check = [&](const Plane& plane, bool needed, const char* name) {
    if (!needed && plane.empty()) return;
    if (plane.width() == frame.window.width() && plane.height() == frame.window.height()) return;
    throw Error(ErrorCode::internal, std::string("temporal window: ") + name + " does not cover the frame's window");
  };
  check(frame.ao, true, "ao");
  check(frame.depth, true, "depth");
  for (const Plane* plane : {&frame.nx, &frame.ny, &frame.nz}) check(*plane, !frame.nx.empty(), "normal");
  for (const VelocityPlanes* mv : {&frame.mv_prev, &frame.mv_next})
    for (const Plane* plane : {&mv->x, &mv->y}) check(*plane, !mv->x.empty(), "velocity");
}

/// Share of what was still seen in the frame before that one step loses at a cut (algorithms 13).
constexpr double kCut = 0.6;

/// Pixels with a finite value above 0: surfaces of a depth, matches of a weight.
int64_t pixels_seen(const Plane& plane) {
  int64_t seen = 0;
  for (int y = 0; y < plane.height(); ++y)
    seen +=
        std::count_if(plane.row(y), plane.row(y) + plane.width(), [](float v) { return std::isfinite(v) && v > 0; });
  return seen;
}

/// The centre and what follows it on one side, without gaps.
std::vector<const WindowFrame*> chain_of(Frames frames, size_t centre, int reach, Side side) {
  std::vector<const WindowFrame*> chain{frames[centre]};
  const int step = side == Side::before ? -1 : 1;
  for (int d = 1; d <= reach; ++d) {
    const auto at = static_cast<std::ptrdiff_t>(centre) + step * d;
    if (at < 0 || at >= std::ssize(frames)) break;
    const WindowFrame* next = frames[static_cast<size_t>(at)];
    if (next->number != chain.front()->number + step * d) break;
    chain.push_back(next);
  }
  return chain;
}

/// How far the test of changes decides in `match`'s frame: more the further one goes, because what came near in any
/// frame between may have stayed. Returns the largest value.
float test_near(const NearMoving* near, const Match& match, const Plane& before, Plane& tested) {
  std::vector<float> most(static_cast<size_t>(tested.height()));
  for_rows(tested.height(), [&](int y) {
    for (int x = 0; x < tested.width(); ++x) {
      const float here = near == nullptr ? 1 : near->at(match.x(x, y), match.y(x, y));
      tested(x, y) = std::max(before(x, y), here);
      most[static_cast<size_t>(y)] = std::max(most[static_cast<size_t>(y)], tested(x, y));
    }
  });
  return *std::max_element(most.begin(), most.end());
}

class Windowing {
 public:
  Windowing(const TemporalWindowParams& params, Frames frames, size_t centre);
  WindowedAo result();

 private:
  void gather(const std::vector<const WindowFrame*>& chain, Side side, std::vector<Neighbour>& out);
  const NearMoving* near(int number) const;
  void average_changes();
  Plane neighbourhood_mean(const Neighbour& neighbour) const;

  const TemporalWindowParams& params_;
  const WindowFrame& centre_;
  std::vector<Neighbour> before_, after_;
  Plane still_;  ///< of the centre's surfaces, in the step to the frame before it or else after it
  std::vector<NearMoving> near_;
  int first_number_ = 0;
  bool testing_ = false;
};

Windowing::Windowing(const TemporalWindowParams& params, Frames frames, size_t centre)
    : params_(params), centre_(*frames[centre]) {
  const auto before = chain_of(frames, centre, params.frames, Side::before);
  const auto after = chain_of(frames, centre, params.frames, Side::after);
  std::vector<const WindowFrame*> all(before.rbegin(), before.rend());
  all.insert(all.end(), after.begin() + 1, after.end());
  for (const WindowFrame* frame : all) require_planes(*frame);
  first_number_ = all.front()->number;
  if (params.change_test == ChangeTest::near_moving)
    near_ = near_moving_surfaces(all, params.occluder_radius_m, params.agreement_px);
  gather(before, Side::before, before_);
  gather(after, Side::after, after_);
  if (testing_) average_changes();
}

const NearMoving* Windowing::near(int number) const {
  return near_.empty() ? nullptr : &near_[static_cast<size_t>(number - first_number_)];
}

void Windowing::gather(const std::vector<const WindowFrame*>& chain, Side side, std::vector<Neighbour>& out) {
  const MatchTolerance tolerance{params_.distance_m, params_.distance_footprints, params_.moving_depth,
                                 static_cast<float>(std::cos(params_.normal_deg * std::numbers::pi / 180)),
                                 params_.agreement_px};
  const int width = centre_.window.width(), height = centre_.window.height();
  Trajectories trajectories(tolerance, chain, side);
  const bool tests = params_.change_test != ChangeTest::never;
  Plane tested(width, height);
  if (tests && !near_.empty()) {
    const NearMoving* own = near(centre_.number);
    for_rows(height, [&](int y) {
      for (int x = 0; x < width; ++x)
        tested(x, y) =
            own->at(static_cast<float>(centre_.window.min_x + x), static_cast<float>(centre_.window.min_y + y));
    });
  }
  int64_t seen = pixels_seen(centre_.depth);
  for (size_t d = 1; d < chain.size(); ++d) {
    Match match = trajectories.next();
    const int64_t now = pixels_seen(match.weight);
    if (static_cast<double>(now) < (1 - kCut) * static_cast<double>(seen)) break;
    seen = now;
    if (still_.empty()) still_ = std::move(match.still);
    Neighbour neighbour{std::move(match.difference), std::move(match.weight), {}, {}};
    if (tests) {
      Plane here(width, height);
      testing_ = test_near(near(chain[d]->number), match, tested, here) > 0 || testing_;
      neighbour.tested = copy_of(here);
      tested = std::move(here);
    }
    out.push_back(std::move(neighbour));
  }
}

Plane Windowing::neighbourhood_mean(const Neighbour& neighbour) const {
  const int step = std::max(1, static_cast<int>(std::lround(params_.neighbourhood_px / kNeighbourhoodReach)));
  return HWY_DYNAMIC_DISPATCH(mean_around)(centre_.depth, still_, neighbour.difference, neighbour.weight, step);
}

void Windowing::average_changes() {
  for (std::vector<Neighbour>* side : {&before_, &after_})
    for (Neighbour& neighbour : *side) neighbour.change = neighbourhood_mean(neighbour);
}

WindowedAo Windowing::result() {
  const int width = centre_.window.width(), height = centre_.window.height(), k = params_.frames;
  const auto weight_of = [&](size_t d) {
    const float far = static_cast<float>(d) / static_cast<float>(k + 1);
    return 1 - far * far;
  };
  float total = 1;
  for (int d = 1; d <= k; ++d) total += 2 * weight_of(static_cast<size_t>(d));
  WindowedAo out{Plane(width, height), Plane(width, height)};
  for_rows(height, [&](int y) {
    WindowRow row{centre_.ao.row(y), {}, {}, total, params_.change, params_.significance, width, out.ao.row(y),
                  out.weight.row(y)};
    const auto add = [&](const std::vector<Neighbour>& side, std::vector<WindowTap>& taps) {
      for (size_t d = 0; d < side.size(); ++d)
        taps.push_back({side[d].difference.row(y), side[d].weight.row(y), testing_ ? side[d].change.row(y) : nullptr,
                        testing_ ? side[d].tested.row(y) : nullptr, weight_of(d + 1)});
    };
    add(before_, row.before);
    add(after_, row.after);
    HWY_DYNAMIC_DISPATCH(filter_row)(row);
  });
  return out;
}

}  // namespace

const params::Table& TemporalWindowParams::table() {
  using W = TemporalWindowParams;
  static const params::Table table =
      params::TableBuilder<W>()
          .add("frames", &W::frames, {0, 64},
               "Frames before and after each frame that its AO is averaged with; memory holds twice as many and one.")
          .add("distance_m", &W::distance_m, {0, 1e6},
               "Largest distance from the expected tangent plane at which a pixel of another frame shows the same "
               "surface.")
          .add("distance_footprints", &W::distance_footprints, {0, 1000},
               "Raises distance_m to this many pixel widths at the pixel's depth.")
          .add("moving_depth", &W::moving_depth, {0, 1},
               "Share of the depth by which a moving surface may be off besides, because vectors have no depth.")
          .add("normal_deg", &W::normal_deg, {0, 180},
               "Largest angle between the normals at which a pixel of another frame shows the same surface.")
          .add("agreement_px", &W::agreement_px, {0, 1000},
               "Largest difference between vector and camera motion at which a pixel counts as static.")
          .add("change_test", &W::change_test, {"near-moving", "everywhere", "never"},
               "Where frames in which the occluders were elsewhere are rejected: near surfaces that the vectors call "
               "moving (everywhere when there are no vectors or no camera positions), everywhere, or nowhere.")
          .add("occluder_radius_m", &W::occluder_radius_m, {0, 1e6},
               "How far from a moving surface changes are tested: the radius of the AO.")
          .add("neighbourhood_px", &W::neighbourhood_px, {0, 256},
               "Half the side of the square in which the change of the AO is averaged before it is tested.")
          .add("change", &W::change, {1e-6, 1}, "Change of the neighbourhood's AO that is real even without noise.")
          .add("significance", &W::significance, {0, 1e6},
               "Standard deviations of the neighbourhood's own flicker that a change must exceed to be real.")
          .build();
  return table;
}

WindowedAo temporal_window(const TemporalWindowParams& params, std::span<const WindowFrame* const> frames,
                           size_t centre) {
  return Windowing(params, frames, centre).result();
}

}  // namespace aftershade::temporal
#endif
