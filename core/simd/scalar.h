#pragma once

/// Functions of core/simd/math.h of one value, for tables that pixel code reads: libm's differ between machines.
namespace aftershade::lanes {

/// 2^x, as exp2.
float exp2_of(float x);

/// log2(x), as log2.
float log2_of(float x);

/// (cos, sin) of 2 pi t, as sincos_turns.
struct UnitVector {
  float x, y;
};
UnitVector unit_vector(float turns);

}  // namespace aftershade::lanes
