#pragma once
#include "core/params/table.h"
#include "tests/bench/throughput/frames.h"

/// The cost of single stages on one of the frames, in memory.
namespace aftershade::tests::throughput {

inline constexpr const char* kBlurDx11 = "motion blur of high-dx11";
inline constexpr const char* kBlurGatherPlus = "motion blur gather-plus";
inline constexpr const char* kSliceAo = "slice AO, 18 taps, 3x3 denoise";  ///< of preset slices

/// A preset of the method gather-plus alone.
params::Json gather_plus_preset();

/// Every stage above in turn, `repetitions` times, on the frame in the middle of the set, on the machine's best SIMD
/// target and on AVX2 where that is another. A list of {stage, target, wall_ms, cpu_ms}: medians.
params::Json measure_stages(const FrameSet& set, int repetitions);

}  // namespace aftershade::tests::throughput
