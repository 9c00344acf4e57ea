#include "core/simd/targets.h"

#include <hwy/highway.h>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::lanes {

namespace {

std::string name_of(int64_t target) {
  if (target == HWY_AVX3) return "avx512";
  return to_lower(hwy::TargetName(target));
}

/// Highway's bits, the best target first.
const std::vector<int64_t>& target_bits() {
  static const std::vector<int64_t> bits = [] {
    std::vector<int64_t> found;
    for (const int64_t target : hwy::SupportedAndGeneratedTargets())
      if (target != HWY_SCALAR) found.push_back(target);
    found.push_back(HWY_SCALAR);
    return found;
  }();
  return bits;
}

}  // namespace

const std::vector<std::string>& targets() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const int64_t target : target_bits()) all.push_back(name_of(target));
    return all;
  }();
  return names;
}

void force_target(const std::string& name) {
  for (size_t i = 0; i < targets().size(); ++i) {
    if (targets()[i] != name) continue;
    hwy::SetSupportedTargetsForTest(target_bits()[i]);
    hwy::GetChosenTarget().DeInit();
    return;
  }
  throw Error(ErrorCode::usage, cat("this machine has no SIMD target \"", name, "\""),
              "one of " + join(targets(), ", "));
}

}  // namespace aftershade::lanes
