// Compositing of boxes, slice by slice. Plain floats: how many surfaces meet in a pixel depends on the data.
#include "core/motionblur/slice_tile.h"

#include <algorithm>
#include <cmath>

namespace aftershade::motionblur {

namespace {

/// Fragments of one pixel and slice whose depths differ by a smaller share are of one surface.
constexpr float kOneDepth = 0.03F;
/// Coverage above which a slice of a pixel is full: the rest are cracks and rounding.
constexpr float kFull = 0.5F;
/// Surfaces covered by less say nothing about what is behind.
constexpr float kSpeck = 0.02F;
constexpr float kStill_px = 0.01F;

float overlap(float low, float high, int pixel) {
  return std::min(high, static_cast<float>(pixel) + 0.5F) - std::max(low, static_cast<float>(pixel) - 0.5F);
}

float edge_at(SurfacePoint::Edge edge, float t) { return edge.at_frame + t * edge.per_frame; }

}  // namespace

bool moves(const SurfacePoint& p, Path path, Shutter shutter) {
  for (const float t : {shutter.opens, 0.5F * (shutter.opens + shutter.closes), shutter.closes})
    if (std::abs(displacement(path, p.prev_x, p.next_x, t)) > kStill_px ||
        std::abs(displacement(path, p.prev_y, p.next_y, t)) > kStill_px)
      return true;
  return false;
}

SliceTile::SliceTile(const SliceScene& scene, int x0, int y0, int width, int height)
    : scene_(scene),
      x0_(x0),
      y0_(y0),
      width_(width),
      height_(height),
      channels_(scene.sequence->front().channels.size()),
      pixels_(static_cast<size_t>(width * height)),
      colours_(pixels_.size() * channels_),
      behind_(pixels_.size() * channels_),
      centre_(pixels_.size() * channels_),
      surface_(channels_),
      slice_(channels_) {
  const std::vector<ConstPlaneView>& planes = scene.sequence->front().channels;
  for (size_t pixel = 0; pixel < pixels_.size(); ++pixel)
    for (size_t c = 0; c < channels_; ++c)
      centre_[pixel * channels_ + c] =
          planes[c](x0 + static_cast<int>(pixel) % width, y0 + static_cast<int>(pixel) / width);
}

void SliceTile::add_slice(const std::vector<int>& members, float t) {
  placed_.clear();
  for (const int member : members) splat(member, t);
  sort_by_pixel();
  for (size_t pixel = 0; pixel < pixels_.size(); ++pixel)
    composite(pixel, sorted_.data() + starts_[pixel], sorted_.data() + starts_[pixel + 1], t);
}

/// The share of each pixel that the point's box covers.
void SliceTile::splat(int member, float t) {
  const SurfacePoint& p = scene_.points[static_cast<size_t>(member)];
  const float x = (p.x - static_cast<float>(x0_)) + displacement(scene_.path, p.prev_x, p.next_x, t);
  const float y = (p.y - static_cast<float>(y0_)) + displacement(scene_.path, p.prev_y, p.next_y, t);
  const float left = x - edge_at(p.left, t), right = x + edge_at(p.right, t);
  const float top = y - edge_at(p.top, t), bottom = y + edge_at(p.bottom, t);
  const int first_x = std::max(static_cast<int>(std::floor(left + 0.5F)), 0);
  const int first_y = std::max(static_cast<int>(std::floor(top + 0.5F)), 0);
  const int last_x = std::min(static_cast<int>(std::floor(right + 0.5F)), width_ - 1);
  const int last_y = std::min(static_cast<int>(std::floor(bottom + 0.5F)), height_ - 1);
  for (int j = first_y; j <= last_y; ++j)
    for (int i = first_x; i <= last_x; ++i) {
      const float w = overlap(left, right, i), h = overlap(top, bottom, j);
      if (w > 0 && h > 0) placed_.push_back({j * width_ + i, {p.depth, w * h, member}});
    }
}

/// Members come in the order of their numbers, and a stable sort keeps it among equals.
void SliceTile::sort_by_pixel() {
  starts_.assign(pixels_.size() + 2, 0);
  for (const Placed& placed : placed_) ++starts_[static_cast<size_t>(placed.pixel) + 2];
  for (size_t i = 2; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  sorted_.resize(placed_.size());
  for (const Placed& placed : placed_) sorted_[starts_[static_cast<size_t>(placed.pixel) + 1]++] = placed.fragment;
}

void SliceTile::composite(size_t pixel, Fragment* first, Fragment* last, float t) {
  for (Fragment* next = first; next < last; ++next) {  // few, and nearly in order
    const Fragment moved = *next;
    Fragment* to = next;
    for (; to > first && to[-1].depth > moved.depth; --to) *to = to[-1];
    *to = moved;
  }
  float open = 1;
  std::fill(slice_.begin(), slice_.end(), 0.0F);
  for (Fragment* begin = first; begin < last && open > 1e-4F;) {
    Fragment* end = begin;
    float coverage = 0;
    for (; end < last && end->depth <= begin->depth * (1 + kOneDepth); ++end) coverage += end->coverage;
    const float alpha = open * std::min(coverage, 1.0F);
    add_surface(pixel, begin, end, alpha, t);
    open -= alpha;
    begin = end;
  }
  const float seen = 1 - open;
  if (seen <= 0) return;
  const float scale = seen >= kFull ? 1 / seen : 1.0F;
  pixels_[pixel].seen += seen * scale;
  for (size_t c = 0; c < channels_; ++c) colours_[pixel * channels_ + c] += scale * slice_[c];
}

/// Adds fragments of one surface, of which the pixel shows `alpha`.
void SliceTile::add_surface(size_t pixel, const Fragment* first, const Fragment* last, float alpha, float t) {
  Pixel& target = pixels_[pixel];
  const float* centre = &centre_[pixel * channels_];
  std::fill(surface_.begin(), surface_.end(), 0.0F);
  const std::vector<SequenceFrame>& sequence = *scene_.sequence;
  const std::vector<Plane>* light = t < 0 ? scene_.before : scene_.after;
  const float change = std::min(std::abs(t), 1.0F);
  float sum = 0;
  for (const Fragment* fragment = first; fragment < last; ++fragment) {
    const SurfacePoint& p = scene_.points[static_cast<size_t>(fragment->point)];
    const SequenceFrame& frame = sequence[static_cast<size_t>(p.frame)];
    const int width = frame.window.width(), x = p.pixel % width, y = p.pixel / width;
    const float weight = fragment->coverage * p.trust;
    sum += weight;
    for (size_t c = 0; c < channels_; ++c) {
      float value = frame.channels[c](x, y);
      if (static_cast<int>(c) != frame.alpha) value *= p.light;
      if (p.frame == 0 && light != nullptr) value += change * ((*light)[c](x, y) - value);
      surface_[c] += weight * (value - centre[c]);
    }
    target.crossed = target.crossed || p.frame > 0 || moves(p, scene_.path, scene_.shutter);
  }
  const float share = sum > 0 ? alpha / sum : 0.0F, depth = first->depth;
  for (size_t c = 0; c < channels_; ++c) slice_[c] += share * surface_[c];
  if (alpha < kSpeck) return;
  target.nearest = std::min(target.nearest, depth);
  if (depth > target.farthest * (1 + kOneDepth)) {
    target.farthest = depth;
    target.behind = 0;
    std::fill_n(&behind_[pixel * channels_], channels_, 0.0F);
  }
  if (depth < target.farthest * (1 - kOneDepth)) return;
  target.behind += alpha;
  for (size_t c = 0; c < channels_; ++c) behind_[pixel * channels_ + c] += share * surface_[c];
}

}  // namespace aftershade::motionblur
