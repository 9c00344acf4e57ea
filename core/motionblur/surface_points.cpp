// Where pieces of surface are while the shutter is open. Plain floats: every point takes its own way.
#include "core/motionblur/surface_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/motionblur/light_change.h"
#include "core/parallel/rows.h"

namespace aftershade::motionblur {

namespace {

/// Pieces of one surface are not torn further apart by the shutter, in pixels.
constexpr float kTorn_px = 1;
/// What a farther neighbour saw counts for so much less where a nearer one saw it too ...
constexpr float kTrustPerFrame = 0.125F;
/// ... and so does, here, what lies beside a nearer surface, whose colour the pixel's filter has mixed into it.
constexpr float kTrustAtEdge = 1e-3F;
/// A vector this close to the camera's is of a surface that stands still.
constexpr float kStanding_px = 0.25F;
/// Depth of a point of which nobody knows where it is: it is like no other.
constexpr float kNowhere = -1;
/// Share of a neighbour that is found again below which it is of another shot (algorithms 13).
constexpr double kSameShot = 0.4;

bool is_one_surface(const SurfacePoint& a, const SurfacePoint& b, Shutter shutter) {
  const Rate ra = rate_of(a), rb = rate_of(b);
  const float longest = std::max(std::abs(shutter.opens), std::abs(shutter.closes));
  return std::abs(a.depth - b.depth) < kOneSurface * std::min(a.depth, b.depth) &&
         (std::abs(ra.x - rb.x) + std::abs(ra.y - rb.y)) * longest < kTorn_px;
}

/// Sets the edges of a grid of points, one a pixel.
void set_edges(std::vector<SurfacePoint>& grid, int width, int height, Shutter shutter) {
  constexpr SurfacePoint::Edge kFree{0.5F, 0};
  for (SurfacePoint& p : grid) p.left = p.right = p.top = p.bottom = kFree;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      SurfacePoint& p = grid[static_cast<size_t>(y * width + x)];
      if (x + 1 < width) {
        SurfacePoint& q = grid[static_cast<size_t>(y * width + x + 1)];
        if (is_one_surface(p, q, shutter))
          p.right = q.left = {0.5F * (q.x - p.x), 0.5F * (rate_of(q).x - rate_of(p).x)};
      }
      if (y + 1 < height) {
        SurfacePoint& q = grid[static_cast<size_t>((y + 1) * width + x)];
        if (is_one_surface(p, q, shutter))
          p.bottom = q.top = {0.5F * (q.y - p.y), 0.5F * (rate_of(q).y - rate_of(p).y)};
      }
    }
}

/// The reprojections from a neighbour's camera to those that place a standing surface.
struct Cameras {
  std::optional<CameraReprojection> towards, here, before, after;
};
Cameras cameras_of(const std::vector<SequenceFrame>& sequence, size_t index) {
  const SequenceFrame& from = sequence[index];
  const int f = sequence.front().number;
  const auto to = [&](int number) -> std::optional<CameraReprojection> {
    for (const SequenceFrame& frame : sequence)
      if (frame.number == number && frame.camera && from.camera)
        return CameraReprojection::create(*from.camera, *frame.camera);
    return std::nullopt;
  };
  return {to(from.number < f ? from.number + 1 : from.number - 1), to(f), to(f - 1), to(f + 1)};
}

/// Positions in f-1, f, f+1.
struct Places {
  std::array<double, 3> x, y;
  double depth;
};

/// By the cameras, if the pixel's vector says that its surface stands still.
std::optional<Places> standing_places(const Cameras& cameras, const SequenceFrame& frame, const SurfacePoint& p,
                                      bool forwards) {
  if (!cameras.towards || !cameras.here || (!cameras.before && !cameras.after)) return std::nullopt;
  const double px = double{p.x} + frame.window.min_x + 0.5, py = double{p.y} + frame.window.min_y + 0.5;
  const double z = p.depth;
  const Vec3 next = (*cameras.towards)(px, py, z);
  const double off_x = next.x - px - (forwards ? p.next_x : p.prev_x);
  const double off_y = next.y - py - (forwards ? p.next_y : p.prev_y);
  if (!(off_x * off_x + off_y * off_y < kStanding_px * kStanding_px)) return std::nullopt;
  const Vec3 here = (*cameras.here)(px, py, z);
  const Vec3 before = cameras.before ? (*cameras.before)(px, py, z) : here * 2.0 - (*cameras.after)(px, py, z);
  const Vec3 after = cameras.after ? (*cameras.after)(px, py, z) : here * 2.0 - before;
  return Places{{before.x - 0.5, here.x - 0.5, after.x - 0.5}, {before.y - 0.5, here.y - 0.5, after.y - 0.5}, here.z};
}

/// By the pixel's own vectors, on a parabola; only a step away.
Places moving_places(const SequenceFrame& frame, const SurfacePoint& p, bool forwards) {
  const double x = double{p.x} + frame.window.min_x, y = double{p.y} + frame.window.min_y;
  const double near_x = forwards ? p.next_x : p.prev_x, near_y = forwards ? p.next_y : p.prev_y;
  const double bend_x = p.next_x + p.prev_x, bend_y = p.next_y + p.prev_y;
  Places places{{x, x + near_x, x + 2 * near_x + bend_x}, {y, y + near_y, y + 2 * near_y + bend_y}, p.depth};
  if (!forwards) {
    std::swap(places.x[0], places.x[2]);
    std::swap(places.y[0], places.y[2]);
  }
  return places;
}

/// Moves a point of a neighbour to where it is in f. False when nobody knows.
bool place_in(const SequenceFrame& f, const Cameras& cameras, const SequenceFrame& from, SurfacePoint& p) {
  const bool forwards = from.number < f.number;
  std::optional<Places> places = standing_places(cameras, from, p, forwards);
  if (!places && std::abs(from.number - f.number) == 1) places = moving_places(from, p, forwards);
  if (!places) return false;
  p.x = static_cast<float>(places->x[1] - f.window.min_x);
  p.y = static_cast<float>(places->y[1] - f.window.min_y);
  p.prev_x = static_cast<float>(places->x[0] - places->x[1]);
  p.prev_y = static_cast<float>(places->y[0] - places->y[1]);
  p.next_x = static_cast<float>(places->x[2] - places->x[1]);
  p.next_y = static_cast<float>(places->y[2] - places->y[1]);
  if (p.depth < 1e30F) p.depth = static_cast<float>(places->depth);
  return std::abs(p.x) + std::abs(p.y) < 1e6F && std::abs(p.prev_x) + std::abs(p.prev_y) < 1e6F &&
         std::abs(p.next_x) + std::abs(p.next_y) < 1e6F;
}

enum class Sight { seen, hidden, contradicted, unknown };

/// What f shows at the place: `hidden` when its pixel there is nearer, or there is none.
Sight sight_of(const SequenceFrame& f, const SurfacePoint& p) {
  const int x = static_cast<int>(std::floor(p.x + 0.5F)), y = static_cast<int>(std::floor(p.y + 0.5F));
  if (x < 0 || y < 0 || x >= f.window.width() || y >= f.window.height()) return Sight::hidden;
  const float z = finite_depth(f.depth, x, y);
  if (z < p.depth * (1 - kHides)) return Sight::hidden;
  return z - p.depth <= kOneSurface * p.depth ? Sight::seen : Sight::contradicted;
}

/// Of what f would have to show, it shows too little.
bool is_another_shot(const std::vector<Sight>& sights) {
  const auto seen = std::count(sights.begin(), sights.end(), Sight::seen);
  const auto contradicted = std::count(sights.begin(), sights.end(), Sight::contradicted);
  return static_cast<double>(seen) < kSameShot * static_cast<double>(seen + contradicted);
}

}  // namespace

bool is_usable(const SequenceFrame& frame, int x, int y) {
  return std::all_of(frame.channels.begin(), frame.channels.end(),
                     [&](ConstPlaneView plane) { return std::abs(plane(x, y)) < 1e30F; });
}

SurfacePoint point_of(const SequenceFrame& frame, int x, int y) {
  const Motion& motion = *frame.motion;
  SurfacePoint point{};
  point.x = static_cast<float>(x);
  point.y = static_cast<float>(y);
  point.prev_x = motion.prev_x(x, y), point.prev_y = motion.prev_y(x, y);
  point.next_x = motion.next_x(x, y), point.next_y = motion.next_y(x, y);
  point.depth = finite_depth(frame.depth, x, y);
  point.pixel = y * frame.window.width() + x;
  return point;
}

void add_points(const SequenceFrame& frame, Shutter shutter, std::vector<SurfacePoint>& points) {
  const int width = frame.window.width(), height = frame.window.height();
  std::vector<SurfacePoint> grid;
  grid.reserve(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) grid.push_back(point_of(frame, x, y));
  set_edges(grid, width, height, shutter);
  for (const SurfacePoint& p : grid)
    if (is_usable(frame, p.pixel % width, p.pixel / width)) points.push_back(p);
}

void add_hidden_points(const std::vector<SequenceFrame>& sequence, size_t index, Shutter shutter,
                       std::vector<SurfacePoint>& points) {
  const SequenceFrame &f = sequence.front(), &from = sequence[index];
  const int width = from.window.width(), height = from.window.height();
  const Cameras cameras = cameras_of(sequence, index);
  std::vector<SurfacePoint> grid(static_cast<size_t>(width) * static_cast<size_t>(height));
  std::vector<Sight> sights(grid.size());
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<size_t>(y * width + x);
      grid[i] = point_of(from, x, y);
      const bool placed = place_in(f, cameras, from, grid[i]);
      sights[i] = placed ? sight_of(f, grid[i]) : Sight::unknown;
      if (!placed) grid[i].depth = kNowhere;
    }
  });
  if (is_another_shot(sights)) return;
  set_edges(grid, width, height, shutter);
  LightChange light(from, grid);
  for (size_t i = 0; i < grid.size(); ++i) {
    const SurfacePoint& p = grid[i];
    const int x = static_cast<int>(std::floor(p.x + 0.5F)), y = static_cast<int>(std::floor(p.y + 0.5F));
    if (sights[i] == Sight::seen && is_usable(f, x, y) && !is_beside_nearer(f, x, y)) light.set(i, light_of(f, x, y));
  }
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<size_t>(y * width + x);
      if (sights[i] == Sight::hidden) grid[i].light = light.at(i);
    }
  });
  for (size_t i = 0; i < grid.size(); ++i) {
    const int x = grid[i].pixel % width, y = grid[i].pixel / width;
    if (sights[i] != Sight::hidden || !is_usable(from, x, y)) continue;
    SurfacePoint p = grid[i];
    p.frame = static_cast<int>(index);
    for (int away = std::abs(from.number - f.number); away > 0; --away) p.trust *= kTrustPerFrame;
    if (is_beside_nearer(from, x, y)) p.trust *= kTrustAtEdge;
    points.push_back(p);
  }
}

}  // namespace aftershade::motionblur
