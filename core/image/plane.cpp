#include "core/image/plane.h"

#include <algorithm>
#include <atomic>

#include "core/image/plane_memory.h"

namespace aftershade {

namespace {
constexpr size_t kFloatsPerLine = 16;

std::shared_ptr<float> storage_of(size_t bytes) {
  const std::shared_ptr<MemoryAccount> account = current_account();
  const auto give_back = [bytes, account](float* p) {
    return_plane_memory(p, bytes);
    if (account) account->used -= bytes;
  };
  float* memory = take_plane_memory(bytes);
  if (account) account->add(bytes);
  return {memory, give_back};
}
}  // namespace

Plane Plane::for_overwrite(int width, int height) {
  Plane plane;
  if (width <= 0 || height <= 0) return plane;
  const size_t stride = (static_cast<size_t>(width) + kPadding + kFloatsPerLine - 1) / kFloatsPerLine * kFloatsPerLine;
  const size_t bytes = stride * static_cast<size_t>(height) * sizeof(float);
  plane.storage_ = storage_of(bytes);
  plane.view_ = {plane.storage_.get(), width, height, static_cast<std::ptrdiff_t>(stride)};
  for (int y = 0; y < height; ++y) std::fill(plane.row(y) + width, plane.row(y) + stride, 0.0F);
  return plane;
}

Plane::Plane(int width, int height, float fill) : Plane(for_overwrite(width, height)) {
  std::fill_n(storage_.get(), view_.stride * view_.height, fill);
}

void Plane::make_own() {
  if (storage_.use_count() > 1) *this = copy_of(view_);
  std::atomic_thread_fence(std::memory_order_acquire);  // after what others read before they let go
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
