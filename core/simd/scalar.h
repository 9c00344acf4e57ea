#pragma once
#include "core/simd/math.h"

/// Functions of core/simd/math.h of one value, for tables that pixel code reads: libm's differ between machines.
namespace aftershade::lanes {

inline float first_lane(Float x) {
  float values[kLanes];
  store(values, x);
  return values[0];
}

/// 2^x, as exp2.
inline float exp2_of(float x) { return first_lane(exp2(x)); }

/// (cos, sin) of 2 pi t, as sincos_turns.
struct UnitVector {
  float x, y;
};
inline UnitVector unit_vector(float turns) {
  const SinCos angle = sincos_turns(turns);
  return {first_lane(angle.cos), first_lane(angle.sin)};
}

}  // namespace aftershade::lanes
