#include "core/image/plane.h"

#include <algorithm>

#include "core/image/plane_memory.h"

namespace aftershade {

namespace {
constexpr size_t kFloatsPerLine = 16;
}  // namespace

void Plane::Free::operator()(float* p) const { return_plane_memory(p, bytes); }

Plane Plane::for_overwrite(int width, int height) {
  Plane plane;
  if (width <= 0 || height <= 0) return plane;
  const size_t stride = (static_cast<size_t>(width) + kPadding + kFloatsPerLine - 1) / kFloatsPerLine * kFloatsPerLine;
  const size_t bytes = stride * static_cast<size_t>(height) * sizeof(float);
  plane.storage_ = std::unique_ptr<float, Free>(take_plane_memory(bytes), Free{bytes});
  plane.view_ = {plane.storage_.get(), width, height, static_cast<std::ptrdiff_t>(stride)};
  for (int y = 0; y < height; ++y) std::fill(plane.row(y) + width, plane.row(y) + stride, 0.0F);
  return plane;
}

Plane::Plane(int width, int height, float fill) : Plane(for_overwrite(width, height)) {
  std::fill_n(storage_.get(), view_.stride * view_.height, fill);
}

Plane copy_of(ConstPlaneView source) {
  Plane out = Plane::for_overwrite(source.width, source.height);
  copy_at(source, out, 0, 0);
  return out;
}

void copy_at(ConstPlaneView source, PlaneView target, int x, int y) {
  const int x0 = std::max(0, -x), x1 = std::min(source.width, target.width - x);
  const int y0 = std::max(0, -y), y1 = std::min(source.height, target.height - y);
  if (x1 <= x0) return;
  for (int row = y0; row < y1; ++row)
    std::copy(source.row(row) + x0, source.row(row) + x1, target.row(row + y) + x + x0);
}

}  // namespace aftershade
