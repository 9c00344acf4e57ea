// Where pieces of surface are while the shutter is open. Plain floats: every point takes its own way.
#include "core/motionblur/surface_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel/rows.h"

namespace aftershade::motionblur {

namespace {

/// Depths that differ by a smaller share may be of one surface ...
constexpr float kOneSurface = 0.05F;
/// ... if the shutter does not tear them further apart, in pixels.
constexpr float kTorn_px = 1;
/// A surface nearer by this share hides what is behind it.
constexpr float kHides = 0.03F;
/// What a farther neighbour saw counts for so much less where a nearer one saw it too ...
constexpr float kTrustPerFrame = 0.125F;
/// ... and so does, here, what lies beside a nearer surface, whose colour the pixel's filter has mixed into it.
constexpr float kTrustAtEdge = 1e-3F;
/// A vector this close to the camera's is of a surface that stands still.
constexpr float kStanding_px = 0.25F;
/// A vector that leads back this close to where it came from is of the same surface.
constexpr float kReturns_px = 2;
/// Depth of a point of which nobody knows where it is: it is like no other.
constexpr float kNowhere = -1;
/// Share of a neighbour that is found again below which it is of another shot (algorithms 13).
constexpr double kSameShot = 0.4;

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

struct Rate {
  float x, y;
};
Rate rate_of(const SurfacePoint& p) { return {0.5F * (p.next_x - p.prev_x), 0.5F * (p.next_y - p.prev_y)}; }

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

/// Does one of the eight pixels around show something nearer?
bool is_beside_nearer(const SequenceFrame& frame, int x, int y) {
  const float nearer = finite_depth(frame.depth, x, y) * (1 - kHides);
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, frame.window.height() - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, frame.window.width() - 1); ++i)
      if (finite_depth(frame.depth, i, j) < nearer) return true;
  return false;
}

/// The light on a neighbour's surfaces, there and in f.
class LightChange {
 public:
  LightChange(const SequenceFrame& f, const SequenceFrame& from, const std::vector<SurfacePoint>& grid)
      : f_(f), from_(from), grid_(grid), here_(grid.size()), there_(grid.size()) {}

  /// Point `i` of the grid is seen in f as well. Its colour there is that of the nearest pixel.
  void add_seen(size_t i) {
    const SurfacePoint& p = grid_[i];
    const int width = from_.window.width(), x = p.pixel % width, y = p.pixel / width;
    const int fx = static_cast<int>(std::floor(p.x + 0.5F)), fy = static_cast<int>(std::floor(p.y + 0.5F));
    if (is_beside_nearer(from_, x, y) || is_beside_nearer(f_, fx, fy) || !is_usable(from_, x, y) ||
        !is_usable(f_, fx, fy))
      return;
    here_[i] = light_of(f_, fx, fy);
    there_[i] = light_of(from_, x, y);
  }

  /// The factor for point `i`, from the nearest seen pixels of like depth and motion, by the inverse square of the
  /// distance; 1 where there are none. It makes nothing brighter than the brightest of them in f, or darker than the
  /// darkest.
  float at(size_t i) const {
    const int width = from_.window.width(), height = from_.window.height();
    const int x = grid_[i].pixel % width, y = grid_[i].pixel / width;
    float here = 0, there = 0, darkest = kMostLight, brightest = 0;
    int last = kSearch_px;
    for (int ring = 1; ring <= last; ++ring)
      for (int v = std::max(y - ring, 0); v <= std::min(y + ring, height - 1); ++v)
        for (int u = x - ring; u <= x + ring; u += std::abs(v - y) == ring ? 1 : 2 * ring) {
          if (u < 0 || u >= width) continue;
          const auto j = static_cast<size_t>(v * width + u);
          if (there_[j] <= 0 || !is_like(grid_[i], grid_[j])) continue;
          const float weight = 1 / static_cast<float>((u - x) * (u - x) + (v - y) * (v - y));
          here += weight * here_[j];
          there += weight * there_[j];
          darkest = std::min(darkest, here_[j]);
          brightest = std::max(brightest, here_[j]);
          last = std::min(last, 2 * ring + 4);
        }
    const float own = light_of(from_, x, y);
    if (there <= 0 || own <= 0) return 1;
    const float factor = here / there;
    return factor > 1 ? std::min(factor, std::max(brightest / own, 1.0F))
                      : std::max(factor, std::min(darkest / own, 1.0F));
  }

 private:
  static constexpr int kSearch_px = 32;
  static constexpr float kMostLight = 1e30F;

  static bool is_like(const SurfacePoint& a, const SurfacePoint& b) {
    const Rate ra = rate_of(a), rb = rate_of(b);
    return std::abs(a.depth - b.depth) < 2 * kOneSurface * a.depth &&
           std::abs(ra.x - rb.x) + std::abs(ra.y - rb.y) < kTorn_px;
  }
  static float light_of(const SequenceFrame& frame, int x, int y) {
    float sum = 0;
    for (size_t c = 0; c < frame.channels.size(); ++c)
      if (static_cast<int>(c) != frame.alpha) sum += std::max(frame.channels[c](x, y), 0.0F);
    return sum;
  }

  const SequenceFrame &f_, &from_;
  const std::vector<SurfacePoint>& grid_;
  std::vector<float> here_, there_;
};

}  // namespace

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
  LightChange light(f, from, grid);
  for (size_t i = 0; i < grid.size(); ++i)
    if (sights[i] == Sight::seen) light.add_seen(i);
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

namespace {

Rate way_of(const SurfacePoint& p, int step) { return step < 0 ? Rate{p.prev_x, p.prev_y} : Rate{p.next_x, p.next_y}; }

/// The mean of the neighbour's pixels around the place of `p` in it that show the same surface, into `colour`. False
/// when they are fewer than half of the place.
bool sample_same_surface(const SequenceFrame& frame, const SequenceFrame& neighbour, int step, const SurfacePoint& p,
                         std::vector<float>& colour) {
  const Window w = neighbour.window;
  const Rate way = way_of(p, step);
  if (!(std::abs(way.x) + std::abs(way.y) < 1e6F)) return false;
  const float from_x = p.x + static_cast<float>(frame.window.min_x - w.min_x), x = from_x + way.x;
  const float from_y = p.y + static_cast<float>(frame.window.min_y - w.min_y), y = from_y + way.y;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  float weight = 0;
  std::fill(colour.begin(), colour.end(), 0.0F);
  for (int j = std::max(y0, 0); j <= std::min(y0 + 1, w.height() - 1); ++j)
    for (int i = std::max(x0, 0); i <= std::min(x0 + 1, w.width() - 1); ++i) {
      const SurfacePoint q = point_of(neighbour, i, j);
      const Rate back = way_of(q, -step);
      const float off_x = q.x + back.x - from_x, off_y = q.y + back.y - from_y;
      const bool same = std::abs(q.depth - p.depth) <= kOneSurface * p.depth &&
                        off_x * off_x + off_y * off_y < kReturns_px * kReturns_px;
      if (!same || !is_usable(neighbour, i, j)) continue;
      const float share = (1 - std::abs(x - q.x)) * (1 - std::abs(y - q.y));
      weight += share;
      for (size_t c = 0; c < colour.size(); ++c) colour[c] += share * neighbour.channels[c](i, j);
    }
  for (float& value : colour) value /= std::max(weight, 1e-30F);
  return weight >= 0.5F;
}

}  // namespace

std::vector<Plane> channels_in(const SequenceFrame& frame, const SequenceFrame& neighbour, int step) {
  std::vector<Plane> out;
  for (const ConstPlaneView& plane : frame.channels) out.push_back(copy_of(plane));
  for_rows(frame.window.height(), [&](int y) {
    std::vector<float> colour(out.size());
    for (int x = 0; x < frame.window.width(); ++x)
      if (sample_same_surface(frame, neighbour, step, point_of(frame, x, y), colour))
        for (size_t c = 0; c < out.size(); ++c) out[c](x, y) = colour[c];
  });
  return out;
}

}  // namespace aftershade::motionblur
