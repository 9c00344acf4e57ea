// How light changes on surfaces from frame to frame. Plain floats: searches go as far as the data asks.
#include "core/motionblur/light_change.h"

#include <algorithm>
#include <cmath>

#include "core/parallel/rows.h"

namespace aftershade::motionblur {

namespace {

constexpr int kSearch_px = 32;
/// Motions that differ by less, in pixels per frame, may be of one surface.
constexpr float kLikeMotion_px = 1;
/// A vector that leads back this close to where it came from is of the same surface.
constexpr float kReturns_px = 2;

bool is_like(const SurfacePoint& a, const SurfacePoint& b) {
  const Rate ra = rate_of(a), rb = rate_of(b);
  return std::abs(a.depth - b.depth) < 2 * kOneSurface * a.depth &&
         std::abs(ra.x - rb.x) + std::abs(ra.y - rb.y) < kLikeMotion_px;
}

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

bool is_beside_nearer(const SequenceFrame& frame, int x, int y) {
  const float nearer = finite_depth(frame.depth, x, y) * (1 - kHides);
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, frame.window.height() - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, frame.window.width() - 1); ++i)
      if (finite_depth(frame.depth, i, j) < nearer) return true;
  return false;
}

float light_of(const SequenceFrame& frame, int x, int y) {
  float sum = 0;
  for (size_t c = 0; c < frame.channels.size(); ++c)
    if (static_cast<int>(c) != frame.alpha) sum += std::max(frame.channels[c](x, y), 0.0F);
  return sum;
}

LightChange::LightChange(const SequenceFrame& frame, const std::vector<SurfacePoint>& grid)
    : frame_(frame), grid_(grid), own_(grid.size()), other_(grid.size()) {}

void LightChange::set(size_t i, float other_light) {
  const int width = frame_.window.width(), x = grid_[i].pixel % width, y = grid_[i].pixel / width;
  if (!is_usable(frame_, x, y) || is_beside_nearer(frame_, x, y)) return;
  own_[i] = light_of(frame_, x, y);
  other_[i] = other_light;
}

float LightChange::at(size_t i) const {
  const int width = frame_.window.width(), height = frame_.window.height();
  const int x = grid_[i].pixel % width, y = grid_[i].pixel / width;
  float own = 0, other = 0, darkest = 1e30F, brightest = 0;
  int last = kSearch_px;
  for (int ring = 1; ring <= last; ++ring)
    for (int v = std::max(y - ring, 0); v <= std::min(y + ring, height - 1); ++v)
      for (int u = x - ring; u <= x + ring; u += std::abs(v - y) == ring ? 1 : 2 * ring) {
        if (u < 0 || u >= width) continue;
        const auto j = static_cast<size_t>(v * width + u);
        if (own_[j] <= 0 || !is_like(grid_[i], grid_[j])) continue;
        const float weight = 1 / static_cast<float>((u - x) * (u - x) + (v - y) * (v - y));
        own += weight * own_[j];
        other += weight * other_[j];
        darkest = std::min(darkest, other_[j]);
        brightest = std::max(brightest, other_[j]);
        last = std::min(last, 2 * ring + 4);
      }
  const float light = light_of(frame_, x, y);
  if (own <= 0 || !(light > 0)) return 1;
  const float factor = other / own;
  return factor > 1 ? std::min(factor, std::max(brightest / light, 1.0F))
                    : std::max(factor, std::min(darkest / light, 1.0F));
}

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
