#include "core/image/plane.h"

#include <algorithm>
#include <new>

namespace aftershade {

namespace {
constexpr std::align_val_t kAlignment{64};
constexpr size_t kFloatsPerLine = 16;
}  // namespace

void Plane::Free::operator()(float* p) const { ::operator delete(p, kAlignment); }

Plane::Plane(int width, int height, float fill) {
  if (width <= 0 || height <= 0) return;
  const size_t stride = (static_cast<size_t>(width) + kPadding + kFloatsPerLine - 1) / kFloatsPerLine * kFloatsPerLine;
  const size_t count = stride * static_cast<size_t>(height);
  storage_.reset(static_cast<float*>(::operator new(count * sizeof(float), kAlignment)));
  std::fill_n(storage_.get(), count, fill);
  view_ = {storage_.get(), width, height, static_cast<std::ptrdiff_t>(stride)};
}

Plane copy_of(ConstPlaneView source) {
  Plane out(source.width, source.height);
  copy_at(source, out, 0, 0);
  return out;
}

void copy_at(ConstPlaneView source, PlaneView target, int x, int y) {
  const int x0 = std::max(0, -x), x1 = std::min(source.width, target.width - x);
  const int y0 = std::max(0, -y), y1 = std::min(source.height, target.height - y);
  if (x1 <= x0) return;
  for (int row = y0; row < y1; ++row) std::copy(source.row(row) + x0, source.row(row) + x1, target.row(row + y) + x + x0);
}

}  // namespace aftershade
