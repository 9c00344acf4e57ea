#if defined(AFTERSHADE_CORE_AO_APPLY_AO_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_APPLY_AO_KERNEL_H
#undef AFTERSHADE_CORE_AO_APPLY_AO_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_APPLY_AO_KERNEL_H
#endif
#include "core/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

struct ApplyAoRow {
  const float* ao;
  const float* baked;    ///< AO of the file; null: none
  bool multiply;         ///< the two are multiplied, else the least counts
  const float* ambient;  ///< null: everything is darkened
  float strength, minimum;
  int width;
  float* colour;  ///< in and out
};

inline Float openness(Float ao) { return select(is_finite(ao), sat(ao), 1.0F); }

/// a = max(minimum, 1 - strength (1 - AO)); colour a, or colour - (1 - a) ambient. AO (either) and ambient that are not
/// finite count as open and as none; a colour that is not finite, or already negative, is not darkened by subtraction
/// or made NaN.
inline void apply_ao_row(const ApplyAoRow& row) {
  for (int x = 0; x < row.width; x += kLanes) {
    const Float ao = load(row.ao + x), colour = load(row.colour + x);
    Float open = openness(ao);
    if (row.baked) {
      const Float baked = openness(load(row.baked + x));
      open = row.multiply ? open * baked : min(open, baked);
    }
    const Float a = max(1.0F - row.strength * (1.0F - open), row.minimum);
    Float darker = colour * a;
    if (row.ambient) {
      const Float ambient = load(row.ambient + x);
      const Float light = select(is_finite(ambient), max(ambient, 0.0F), 0.0F);
      darker = select(colour > 0.0F, max(colour - (1.0F - a) * light, 0.0F), colour);
    }
    store(row.colour + x, select(is_finite(colour), darker, colour));
  }
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
