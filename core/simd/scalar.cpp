#include "core/simd/scalar.h"

#include "core/simd/math.h"

namespace aftershade::lanes {

float exp2_of(float x) { return HWY_NAMESPACE::exp2(x).v; }

float log2_of(float x) { return HWY_NAMESPACE::log2(x).v; }

UnitVector unit_vector(float turns) {
  const auto angle = HWY_NAMESPACE::sincos_turns(turns);
  return {angle.cos.v, angle.sin.v};
}

}  // namespace aftershade::lanes
