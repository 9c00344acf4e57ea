#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/temporal/trajectory.cpp"  // this file, compiled once a SIMD target
#include "core/temporal/trajectory.h"

#include <hwy/foreach_target.h>

#include <cmath>
#include <limits>
#include <optional>

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "core/temporal/trajectory_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

const float* row_or_null(const Plane& plane, int y) { return plane.empty() ? nullptr : plane.row(y); }

void match_rows(const MatchInput& in, const MatchOutput& out) {
  const MatchTolerance& tolerance = in.tolerance;
  const EdgeTolerance distance(tolerance.distance_m, tolerance.footprints, 1, in.projection);
  for_rows(in.still.height(), [&](int y) {
    match_row({in.frame,
               Lens(in.projection),
               distance,
               tolerance.moving_depth,
               tolerance.normal_cos,
               in.consistency_px,
               in.consistency_share,
               in.turn,
               in.centre.ao.row(y),
               row_or_null(in.centre.nx, y),
               row_or_null(in.centre.ny, y),
               row_or_null(in.centre.nz, y),
               out.to.x.row(y),
               out.to.y.row(y),
               out.to.depth.row(y),
               in.still.row(y),
               in.step_x.row(y),
               in.step_y.row(y),
               in.still.width(),
               out.to.difference.row(y),
               out.to.weight.row(y),
               out.depth.row(y),
               out.vector_x.row(y),
               out.vector_y.row(y)});
  });
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::temporal {

namespace {

HWY_EXPORT(match_rows);

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kConsistency_px = 0.5F, kConsistencyShare = 0.05F;  // algorithms 7.2

bool is_surface(double depth) { return std::isfinite(depth) && depth > 0; }

const float* data_or_null(ConstPlaneView plane) { return plane.empty() ? nullptr : plane.data; }

/// Directions only: rotation of the centre's camera space into the other's.
void set_turn(MatchInput& in, const Camera& centre, const Camera& other) {
  const auto way = CameraReprojection::create(centre, other);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) in.turn[i][j] = way ? static_cast<float>(way->delta()[i][j]) : (i == j ? 1.0F : 0.0F);
}

struct Place {
  Vec3 position;
  bool still;
};
constexpr Vec3 kLost{kNaN, kNaN, kNaN};

/// One step on: `direct` is where the camera's motion puts the surface, as NaN where there is no camera.
Place step(const Vec3& here, bool still, const Vec3& direct, double mv_x, double mv_y, double agreement_px) {
  const bool known = std::isfinite(mv_x) && std::isfinite(mv_y), camera = direct.z > 0;
  if (!known) return {still && camera ? direct : kLost, still};
  const double off_x = direct.x - here.x - mv_x, off_y = direct.y - here.y - mv_y;
  if (off_x * off_x + off_y * off_y <= agreement_px * agreement_px) return {direct, still};
  return {{here.x + mv_x, here.y + mv_y, camera ? direct.z : here.z}, false};
}

}  // namespace

Trajectories::Trajectories(const MatchTolerance& tolerance, std::span<const WindowFrame* const> chain, Side side)
    : tolerance_(tolerance), chain_(chain), side_(side) {
  const WindowFrame& centre = *chain.front();
  const int width = centre.window.width(), height = centre.window.height();
  for (Plane* plane : {&x_, &y_, &depth_, &vector_x_, &vector_y_}) *plane = Plane(width, height, kNaN);
  still_ = Plane(width, height, 1.0F);
  if (left() == 0) return;
  const Vectors vectors = outward(0);
  for_rows(height, [&](int j) {
    for (int i = 0; i < width; ++i) {
      if (!is_surface(centre.depth(i, j))) continue;
      x_(i, j) = static_cast<float>(centre.window.min_x + i + 0.5);
      y_(i, j) = static_cast<float>(centre.window.min_y + j + 0.5);
      depth_(i, j) = centre.depth(i, j);
      if (vectors.x.empty()) continue;
      vector_x_(i, j) = vectors.x(i, j);
      vector_y_(i, j) = vectors.y(i, j);
    }
  });
}

Trajectories::Vectors Trajectories::outward(size_t frame) {
  const WindowFrame& here = *chain_[frame];
  const VelocityPlanes& own = side_ == Side::before ? here.mv_prev : here.mv_next;
  if (!own.x.empty()) return {own.x, own.y};
  if (frame + 1 == chain_.size()) return {};
  const WindowFrame& there = *chain_[frame + 1];
  const VelocityPlanes& towards = side_ == Side::before ? there.mv_next : there.mv_prev;
  if (towards.x.empty()) return {};
  carried_ = scatter_velocity(towards.x, towards.y, there.depth, there.window, here.window);
  return {carried_.x, carried_.y};
}

void Trajectories::advance(Match& to, Plane& step_x, Plane& step_y) {
  const WindowFrame &centre = *chain_[0], &here = *chain_[reached_], &there = *chain_[reached_ + 1];
  const auto from_centre = CameraReprojection::create(centre.camera, there.camera);
  const auto from_here = CameraReprojection::create(here.camera, there.camera);
  for_rows(x_.height(), [&](int j) {
    for (int i = 0; i < x_.width(); ++i) {
      const Vec3 at(x_(i, j), y_(i, j), depth_(i, j));
      const bool still = still_(i, j) > 0.5F;
      Vec3 direct = kLost;
      if (still && from_centre)
        direct = (*from_centre)(centre.window.min_x + i + 0.5, centre.window.min_y + j + 0.5, centre.depth(i, j));
      if (!still && from_here) direct = (*from_here)(at.x, at.y, at.z);
      const bool lost = !is_surface(centre.depth(i, j)) || !std::isfinite(at.x) || !is_surface(at.z);
      const Place place = lost ? Place{kLost, still}
                               : step(at, still, direct, vector_x_(i, j), vector_y_(i, j), tolerance_.agreement_px);
      still_(i, j) = place.still ? 1.0F : 0.0F;
      step_x(i, j) = static_cast<float>(at.x - place.position.x);
      step_y(i, j) = static_cast<float>(at.y - place.position.y);
      to.x(i, j) = static_cast<float>(place.position.x);
      to.y(i, j) = static_cast<float>(place.position.y);
      to.depth(i, j) = static_cast<float>(place.position.z);
    }
  });
}

void Trajectories::match(Match& to, const Plane& step_x, const Plane& step_y) {
  const WindowFrame &centre = *chain_[0], &there = *chain_[reached_];
  const VelocityPlanes& inward = side_ == Side::before ? there.mv_next : there.mv_prev;
  const Vectors onward = outward(reached_);
  const bool normals = !centre.nx.empty() && !there.nx.empty();
  const Projection projection = local_projection(there.camera, 0, 0);
  const FrameSamples samples{there.ao.row(0),
                             there.depth.row(0),
                             normals ? there.nx.row(0) : nullptr,
                             normals ? there.ny.row(0) : nullptr,
                             normals ? there.nz.row(0) : nullptr,
                             data_or_null(inward.x),
                             data_or_null(inward.y),
                             data_or_null(onward.x),
                             data_or_null(onward.y),
                             there.window.width(),
                             there.window.height(),
                             static_cast<int>(there.depth.view().stride),
                             there.window.min_x,
                             there.window.min_y};
  MatchInput in{samples, projection, tolerance_, kConsistency_px, kConsistencyShare,
                {},      centre,     still_,     step_x,          step_y};
  set_turn(in, centre.camera, there.camera);
  HWY_DYNAMIC_DISPATCH(match_rows)(in, {to, depth_, vector_x_, vector_y_});
}

Match Trajectories::next() {
  if (left() == 0) throw Error(ErrorCode::internal, "trajectories: there is no further frame");
  const int width = x_.width(), height = x_.height();
  const auto blank = [&] { return Plane(width, height); };
  Match to{blank(), blank(), blank(), blank(), blank(), blank()};
  Plane step_x(width, height), step_y(width, height);
  advance(to, step_x, step_y);
  ++reached_;
  match(to, step_x, step_y);
  copy_at(still_, to.still, 0, 0);
  copy_at(to.x, x_, 0, 0);
  copy_at(to.y, y_, 0, 0);
  return to;
}

}  // namespace aftershade::temporal
#endif
