#include "core/temporal/moving_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/parallel/rows.h"

namespace aftershade::temporal {

namespace {

constexpr int kTile_px = NearMoving::kTile_px;

bool is_surface(float depth) { return std::isfinite(depth) && depth > 0; }
int tile_of(int pixel) { return pixel >= 0 ? pixel / kTile_px : -((kTile_px - 1 - pixel) / kTile_px); }

struct DepthRange {
  float least = std::numeric_limits<float>::infinity(), most = 0;
  bool empty() const { return most < least; }
  void include(float z) {
    least = std::min(least, z);
    most = std::max(most, z);
  }
  float gap(const DepthRange& other) const { return std::max({least - other.most, other.least - most, 0.0F}); }
};

/// What the tiles of one frame hold.
struct Tiles {
  explicit Tiles(const Window& window)
      : first_x(tile_of(window.min_x)),
        first_y(tile_of(window.min_y)),
        width(tile_of(window.max_x) - first_x + 1),
        height(tile_of(window.max_y) - first_y + 1),
        all(static_cast<size_t>(width) * static_cast<size_t>(height)),
        moving(all.size()) {}
  size_t index(int tile_x, int tile_y) const {
    return static_cast<size_t>(tile_y - first_y) * static_cast<size_t>(width) + static_cast<size_t>(tile_x - first_x);
  }
  void mark(double x, double y, float z) {
    const double tx = std::floor(x / kTile_px), ty = std::floor(y / kTile_px);
    if (!(tx >= first_x && tx < first_x + width && ty >= first_y && ty < first_y + height)) return;
    moving[index(static_cast<int>(tx), static_cast<int>(ty))].include(z);
  }
  int first_x, first_y, width, height;
  std::vector<DepthRange> all, moving;
};

/// A way from one frame to a neighbour of it.
struct Link {
  const VelocityPlanes* vectors;
  CameraReprojection camera;
  Tiles* there;
};

std::optional<Link> link(const WindowFrame& from, const WindowFrame& to, const VelocityPlanes& vectors, Tiles& there) {
  if (vectors.x.empty()) return std::nullopt;
  const auto camera = CameraReprojection::create(from.camera, to.camera);
  if (!camera) return std::nullopt;
  return Link{&vectors, *camera, &there};
}

enum class Moves { no, yes };

/// Marks where the vectors of one pixel lead; yes when one of them is no camera motion, or none is known.
Moves follow_vectors(const WindowFrame& frame, int i, int j, std::span<const Link> links, float agreement_px) {
  const double x = frame.window.min_x + i + 0.5, y = frame.window.min_y + j + 0.5;
  bool known = false, moves = false;
  for (const Link& l : links) {
    const double mv_x = l.vectors->x(i, j), mv_y = l.vectors->y(i, j);
    if (!std::isfinite(mv_x) || !std::isfinite(mv_y)) continue;
    known = true;
    const Vec3 still = l.camera(x, y, frame.depth(i, j));
    if (std::hypot(still.x - x - mv_x, still.y - y - mv_y) <= agreement_px) continue;
    moves = true;
    l.there->mark(x + mv_x, y + mv_y, frame.depth(i, j));
  }
  return moves || !known ? Moves::yes : Moves::no;
}

/// Looks at one pixel in four, at even absolute coordinates. A frame at an end whose vectors lead out of the window has
/// no links: its neighbour tells.
void mark_frame(const WindowFrame& frame, std::span<const Link> links, float agreement_px, Tiles& own) {
  const Window& w = frame.window;
  for (int j = w.min_y & 1; j < w.height(); j += 2)
    for (int i = w.min_x & 1; i < w.width(); i += 2) {
      const float z = frame.depth(i, j);
      if (!is_surface(z)) continue;
      const int x = w.min_x + i, y = w.min_y + j;
      own.all[own.index(tile_of(x), tile_of(y))].include(z);
      if (!links.empty() && follow_vectors(frame, i, j, links, agreement_px) == Moves::yes) own.mark(x, y, z);
    }
}

/// How near the moving tiles come to tile (tx, ty): the gaps between their rectangles in the image and between their
/// depths are both parts of the distance.
float nearness(const Tiles& tiles, std::span<const size_t> moving, int tx, int ty, float radius_m,
               const Camera& camera) {
  const DepthRange& here = tiles.all[tiles.index(tx + tiles.first_x, ty + tiles.first_y)];
  if (here.empty()) return 0;
  const double focal = std::max(camera.fx, camera.fy);
  const double radius_px = radius_m * (camera.orthographic ? focal : focal / static_cast<double>(here.least));
  double least = 1;
  for (const size_t m : moving) {
    const int mx = static_cast<int>(m) % tiles.width, my = static_cast<int>(m) / tiles.width;
    const double gap_x = kTile_px * std::max(std::abs(mx - tx) - 1, 0),
                 gap_y = kTile_px * std::max(std::abs(my - ty) - 1, 0);
    const double across = std::hypot(gap_x, gap_y) / radius_px;
    const double along = static_cast<double>(here.gap(tiles.moving[m])) / static_cast<double>(radius_m);
    least = std::min(least, std::max(across, along));
  }
  return static_cast<float>(std::clamp(4 * (1 - least), 0.0, 1.0));
}

NearMoving near(const WindowFrame& frame, const Tiles& tiles, float radius_m) {
  std::vector<size_t> moving;
  for (size_t i = 0; i < tiles.moving.size(); ++i)
    if (!tiles.moving[i].empty()) moving.push_back(i);
  NearMoving out{tiles.first_x, tiles.first_y, Plane(tiles.width, tiles.height)};
  if (moving.empty()) return out;
  for_rows(tiles.height, [&](int ty) {
    for (int tx = 0; tx < tiles.width; ++tx)
      out.tiles(tx, ty) = nearness(tiles, moving, tx, ty, radius_m, frame.camera);
  });
  return out;
}

}  // namespace

float NearMoving::at(float x, float y) const {
  const float tx = std::floor(x / kTile_px) - static_cast<float>(first_x);
  const float ty = std::floor(y / kTile_px) - static_cast<float>(first_y);
  if (!(tx >= 0 && tx < static_cast<float>(tiles.width()) && ty >= 0 && ty < static_cast<float>(tiles.height())))
    return 0;
  return tiles(static_cast<int>(tx), static_cast<int>(ty));
}

std::vector<NearMoving> near_moving_surfaces(std::span<const WindowFrame* const> frames, float radius_m,
                                             float agreement_px) {
  std::vector<Tiles> tiles;
  for (const WindowFrame* frame : frames) tiles.emplace_back(frame->window);
  std::vector<std::vector<Link>> links(frames.size());
  for (size_t f = 0; f + 1 < frames.size(); ++f) {
    const auto forth = link(*frames[f], *frames[f + 1], frames[f]->mv_next, tiles[f + 1]);
    const auto back = link(*frames[f + 1], *frames[f], frames[f + 1]->mv_prev, tiles[f]);
    if (!forth && !back) return {};
    if (forth) links[f].push_back(*forth);
    if (back) links[f + 1].push_back(*back);
  }
  std::vector<NearMoving> out;
  for (size_t f = 0; f < frames.size(); ++f) mark_frame(*frames[f], links[f], agreement_px, tiles[f]);
  for (size_t f = 0; f < frames.size(); ++f) out.push_back(near(*frames[f], tiles[f], radius_m));
  return out;
}

}  // namespace aftershade::temporal
