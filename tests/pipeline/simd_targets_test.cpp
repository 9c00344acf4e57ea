// Every shipped preset, with all it can write, on every SIMD target of this machine: the bits of the one-lane twin.
#include <gtest/gtest.h>

#include <bit>
#include <cstdio>

#include "core/base/text.h"
#include "core/parallel/rows.h"
#include "core/simd/targets.h"
#include "tests/pipeline/ao_quality.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"

namespace aftershade::tests {
namespace {

/// Where and how two sequences differ first, bit by bit, NaN being like any NaN; "" when they do not.
std::string first_difference(const MemorySink& a, const MemorySink& b) {
  for (const auto& [number, channels] : a.planes)
    for (const auto& [name, plane] : channels)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x) {
          const float one = plane(x, y), other = b.planes.at(number).at(name)(x, y);
          const bool same = std::bit_cast<uint32_t>(one) == std::bit_cast<uint32_t>(other);
          if (!same && !(std::isnan(one) && std::isnan(other)))
            return cat("frame ", number, " channel ", name, " (", x, ", ", y, "): ", one, " and ", other);
        }
  return a.planes.size() == b.planes.size() ? "" : "numbers of frames differ";
}

class Targets : public testing::TestWithParam<std::string> {
 protected:
  ~Targets() override { lanes::force_target(lanes::targets().front()); }

  /// A width that no number of lanes divides.
  static MemorySink run_on(const std::string& target, const std::string& preset) {
    lanes::force_target(target);
    SceneSource source(find_scene("crossing"), {61, 35, 1}, 3, 6);
    pipeline::Outputs outputs;
    if (makes_ao(preset)) outputs.ao_channel = "AO";
    outputs.work.aovs = pipeline::AovSet::all();
    return run_over(preset::load_preset(preset).preset, source, frames_from_to(3, 6), outputs);
  }
};

TEST_P(Targets, GiveTheBitsOfTheOneLaneTwin) {
  const MemorySink twin = run_on("scalar", GetParam());
  ASSERT_EQ(twin.planes.size(), 4U);
  for (const std::string& target : lanes::targets()) {
    if (target == "scalar") continue;
    EXPECT_EQ(first_difference(twin, run_on(target, GetParam())), "") << target;
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Targets, testing::ValuesIn(preset::shipped_presets()), [](const auto& preset) {
  std::string name = preset.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(TargetsOfThisMachine, AreSaidLoudly) {
  const std::vector<std::string>& targets = lanes::targets();
  EXPECT_EQ(targets.back(), "scalar");
  for (const char* wanted : {"avx512", "avx2", "sse4"})
    if (std::find(targets.begin(), targets.end(), wanted) == targets.end())
      std::printf("THIS MACHINE HAS NO %s: that target is not tested\n", wanted);
}

}  // namespace
}  // namespace aftershade::tests
