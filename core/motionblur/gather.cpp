#include "core/motionblur/gather.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/filter/surface.h"
#include "core/parallel/rows.h"

namespace aftershade::motionblur {

int radius_at(float radius_px, float reference_height_px, int display_height) {
  return std::max(1, static_cast<int>(std::ceil(filter::scaled_px(radius_px, reference_height_px, display_height))));
}

bool any_moves(const HalfVelocity& velocity) {
  for (int y = 0; y < velocity.x.height(); ++y)
    for (int x = 0; x < velocity.x.width(); ++x)
      if (std::hypot(velocity.x(x, y), velocity.y(x, y)) > kLeastRadius_px) return true;
  return false;
}

void gather_rows(const GatherSource& source, std::span<Plane* const> channels, const GatherRow& row) {
  GatherPlanes planes{};
  planes.width = source.speed.width();
  planes.height = source.speed.height();
  planes.stride = static_cast<int>(source.speed.view().stride);
  planes.speed = source.speed.row(0);
  planes.depth = source.depth.row(0);
  constexpr auto group = static_cast<size_t>(GatherPlanes::kChannels);
  for (size_t first = 0; first < channels.size(); first += group) {
    const size_t count = std::min(group, channels.size() - first);
    planes.channels = static_cast<int>(count);
    for (size_t c = 0; c < count; ++c) planes.source[c] = source.colour[first + c].row(0);
    for_rows(planes.height, [&](int y) {
      std::array<float*, group> target{};
      for (size_t c = 0; c < count; ++c) target[c] = channels[first + c]->row(y);
      row(planes, target.data(), y);
    });
  }
}

}  // namespace aftershade::motionblur
