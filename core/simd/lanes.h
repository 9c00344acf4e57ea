// The lane layer that kernels are written in: Float, Int and Mask hold kLanes values each. A kernel walks a row in
// steps of kLanes and may load and store up to kLanes - 1 values past the last pixel: planes are padded for it
// (core/image/plane.h).
//
// Kernels are compiled once a SIMD target, each time in a namespace of the target's name (HWY_NAMESPACE), and the best
// that the machine has is chosen at run time: see Highway's documentation of foreach_target.h for the frame around such
// a file, and core/ao/scalable_ao.cpp for a short example. One target has a single lane (N_SCALAR): the twin that
// defines what all others must give, bit for bit. Therefore: IEEE single precision, no fused multiply-add, no
// approximate reciprocals.
#if defined(AFTERSHADE_CORE_SIMD_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_SIMD_LANES_H
#undef AFTERSHADE_CORE_SIMD_LANES_H
#else
#define AFTERSHADE_CORE_SIMD_LANES_H
#endif
#include <hwy/highway.h>
#if HWY_TARGET == HWY_SCALAR
#include "core/simd/one_lane.h"
#else
#include "core/simd/many_lanes.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace aftershade::lanes::HWY_NAMESPACE {

inline Float& operator+=(Float& a, Float b) { return a = a + b; }
inline Float& operator-=(Float& a, Float b) { return a = a - b; }
inline Float& operator*=(Float& a, Float b) { return a = a * b; }
inline Float clamp(Float x, Float low, Float high) { return min(max(x, low), high); }
inline Int clamp(Int x, Int low, Int high) { return min(max(x, low), high); }
/// Clamp to [0, 1], the shaders' saturate.
inline Float sat(Float x) { return clamp(x, 0.0F, 1.0F); }
/// Is it neither infinite nor NaN?
inline Mask is_finite(Float x) { return abs(x) <= 3.402823466e38F; }

}  // namespace aftershade::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
