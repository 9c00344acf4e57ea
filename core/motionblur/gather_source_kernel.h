#if defined(AFTERSHADE_CORE_MOTIONBLUR_GATHER_SOURCE_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_GATHER_SOURCE_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_GATHER_SOURCE_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_GATHER_SOURCE_KERNEL_H
#endif
#include <span>

#include "core/motionblur/gather_source.h"
#include "core/simd/records.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// Values from here on, of metres or of light, stand for "infinite"; sums of weighted differences of smaller ones fit a
/// float.
inline constexpr float kInfinite = 1e30F;

struct GatherSourceRow {
  const float *velocity_x, *velocity_y;
  const float* depth;                      ///< null: background everywhere
  std::span<const float* const> channels;  ///< all of them
  bool with_direction;
  int record_floats;
};

inline Float finite_depth(Float z) { return select((z > 0.0F) & (z < kInfinite), z, Float(kInfinite)); }

/// Writes the records of pixels `columns` (and up to kLanes - 1 behind them) for channels first, first + 1, ... to
/// `records`, which is that of pixel 0.
inline void gather_source_row(const GatherSourceRow& row, size_t first, Columns columns, float* records) {
  const auto channel = [&](size_t c, int x) {
    return first + c < row.channels.size() ? load(row.channels[first + c] + x) : Float(0.0F);
  };
  for (int x = columns.first; x < columns.last; x += kLanes) {
    const Float vx = load(row.velocity_x + x), vy = load(row.velocity_y + x), length = sqrt(vx * vx + vy * vy);
    Float speed = max(length, kLeastRadius_px);
    for (const float* values : row.channels) speed = select(abs(load(values + x)) < kInfinite, speed, 0.0F);
    const Float depth = row.depth != nullptr ? finite_depth(load(row.depth + x)) : Float(kInfinite);
    const Float scale = row.with_direction ? 1.0F / (length + kNoDivisionByZero) : Float(0.0F);
    float* to = records + static_cast<std::ptrdiff_t>(x) * row.record_floats;
    // What the second four have too many is the next record's, which is written afterwards.
    store_records(to + GatherRecord::kSpeed, row.record_floats, {speed, depth, vx * scale, vy * scale});
    store_records(to, row.record_floats, {channel(0, x), channel(1, x), channel(2, x), channel(3, x)});
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
