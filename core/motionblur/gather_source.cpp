#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/gather_source.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/gather_source.h"

#include <hwy/foreach_target.h>

#include "core/motionblur/gather_source_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

void fill(const HalfVelocity& velocity, ConstPlaneView depth, std::span<Plane* const> channels,
          const MovingTiles& tiles, GatherSource& source) {
  for_rows(source.height, [&](int y) {
    const Columns columns = tiles.read(y);
    if (columns.empty()) return;
    std::vector<const float*> rows;
    for (const Plane* channel : channels) rows.push_back(channel->row(y));
    const GatherSourceRow row{velocity.x.row(y),
                              velocity.y.row(y),
                              depth.data != nullptr ? depth.row(y) : nullptr,
                              rows,
                              source.record_floats == GatherRecord::kFloatsWithDirection,
                              source.record_floats};
    for (size_t group = 0; group < source.records.size(); ++group)
      gather_source_row(row, group * GatherRecord::kChannels, columns, source.records[group].row(y));
  });
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::motionblur {

namespace {
HWY_EXPORT(fill);
}

GatherSource gather_source(const HalfVelocity& velocity, ConstPlaneView depth, std::span<Plane* const> channels,
                           const MovingTiles& tiles, bool with_direction) {
  const int width = velocity.x.width(), height = velocity.x.height();
  GatherSource source{width, height, with_direction ? GatherRecord::kFloatsWithDirection : GatherRecord::kFloats, {}};
  for (size_t first = 0; first < channels.size(); first += GatherRecord::kChannels)
    source.records.push_back(Plane::for_overwrite((width + Plane::kPadding) * source.record_floats, height));
  HWY_DYNAMIC_DISPATCH(fill)(velocity, depth, channels, tiles, source);
  return source;
}

}  // namespace aftershade::motionblur
#endif
