// What holds for every AO method and for the AO part of every shipped preset, by loops over the lists: a method or
// preset that is added is tested here without a line of code.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "core/parallel/rows.h"
#include "tests/pipeline/ao_quality.h"
#include "tests/support/render.h"
#include "tests/support/scenes.h"

namespace aftershade::pipeline {
namespace {

constexpr int kWidth = 192, kHeight = 144;
constexpr int kFrames = 4, kFrame = 3;  ///< frames 1 to 4; the third has neighbours on both sides
constexpr int kMargin = 52;             ///< pixels within which an image border may be felt

struct Case {
  std::string name;
  preset::Preset preset;
};

/// The method alone, with its defaults; upsampled where it works at half resolution.
void add_method(std::vector<Case>& cases, const preset::StageParams& params) {
  const Needs needs = make_stage(params)->needs(tests::kFullOffer);
  if (!needs.makes_ao || needs.ao) return;
  const std::string name = "method " + std::string(preset::method_of(params));
  preset::Preset preset{name, "", {{"ao", params}}};
  if (!needs.makes_ao_at_pixels) preset.stages.push_back({"upsample", filter::BilateralUpsampleParams{}});
  cases.push_back({name, std::move(preset)});
}

/// Visits every parameter of a preset as (stage, record, values).
template <class Visit>
void for_parameters(preset::Preset& preset, Visit&& visit) {
  for (preset::StageDescription& stage : preset.stages)
    std::visit(
        [&](auto& params) {
          for (const params::Record& record : params.table()) visit(record, static_cast<void*>(&params));
        },
        stage.params);
}

/// No property is a matter of how many rays are spent.
void make_affordable(preset::Preset& preset) {
  for_parameters(preset, [](const params::Record& record, void* values) {
    if (record.key == "rays") record.put(values, 8);
  });
}

const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases = [] {
    std::vector<Case> list;
    preset::for_each_method(
        [&](auto identity) { add_method(list, preset::StageParams(typename decltype(identity)::type{})); });
    for (const std::string& name : preset::shipped_presets())
      if (tests::makes_ao(name)) list.push_back({"preset " + name, tests::ao_part(name)});
    for (Case& c : list) make_affordable(c.preset);
    return list;
  }();
  return cases;
}

bool ends_with_unit(const std::string& key, std::string_view unit) { return key.ends_with("_" + std::string(unit)); }

/// Every length of the preset times `factor`; with `only`, of the keys that contain it.
preset::Preset scaled(preset::Preset preset, double factor, std::string_view only = "") {
  for_parameters(preset, [&](const params::Record& record, void* values) {
    if (record.kind != params::Kind::number || !ends_with_unit(record.key, "m")) return;
    if (record.key.find(only) == std::string::npos) return;
    const float value = record.get(values).template get<float>(), by = static_cast<float>(factor);
    record.put(values, ends_with_unit(record.key, "per_m") ? value / by : value * by);
  });
  return preset;
}

bool any_parameter(preset::Preset preset, std::string_view part, auto&& holds) {
  bool any = false;
  for_parameters(preset, [&](const params::Record& record, void* values) {
    any = any || (record.key.find(part) != std::string::npos && holds(record.get(values)));
  });
  return any;
}
bool has_bias(const preset::Preset& preset) {
  return any_parameter(preset, "bias", [](const params::Json& v) { return v.is_number() && v.get<double>() > 0; });
}
bool has_mips(const preset::Preset& preset) {
  return any_parameter(preset, "mips", [](const params::Json& v) { return v.is_boolean() && v.get<bool>(); });
}

bool has_memory(const preset::Preset& preset) {
  return std::any_of(preset.stages.begin(), preset.stages.end(), [](const auto& stage) {
    const Needs needs = make_stage(stage.params)->needs(tests::kFullOffer);
    return needs.recursive || needs.has_window();
  });
}

/// Frames of a scene, rendered once.
const Frame& rendered(const tests::Scene& scene, int number) {
  static std::map<std::pair<std::string, int>, Frame> frames;
  const auto key = std::pair(scene.name, number);
  if (!frames.contains(key))
    frames[key] = tests::render(scene, number, {kWidth, kHeight, 1}, tests::kSceneRoles, false);
  return frames[key];
}

/// What is done to a scene before it is read: all lengths times `factor`, and only `window` of it.
struct Change {
  float factor = 1;
  Window window{0, 0, kWidth - 1, kHeight - 1};
};

Frame changed(const Frame& source, const Change& change) {
  Frame frame;
  frame.number = source.number;
  frame.display = source.display;
  frame.window = change.window;
  frame.camera = source.camera;
  Mat4 world_to_camera = *source.camera->world_to_camera;
  for (int i = 0; i < 3; ++i) world_to_camera[3][i] *= static_cast<double>(change.factor);
  frame.camera->world_to_camera = world_to_camera;
  for (const RoleInfo& role : kRoles)
    for (const Plane& plane : source.planes(role.role)) {
      Plane& part = frame.planes(role.role).emplace_back(change.window.width(), change.window.height());
      copy_at(plane, part, -change.window.min_x, -change.window.min_y);
      if (role.role != Role::depth) continue;
      for (int y = 0; y < part.height(); ++y)
        for (int x = 0; x < part.width(); ++x) part(x, y) *= change.factor;
    }
  return frame;
}

/// The neighbours are only run where they matter.
Plane ao_of(const preset::Preset& preset, const tests::Scene& scene, const Change& change = {}) {
  const std::vector<int> frames = has_memory(preset) ? tests::frames_from_to(1, kFrames) : std::vector<int>{kFrame};
  tests::MemorySource source({frames.begin(), frames.end()},
                             [&](int number) { return changed(rendered(scene, number), change); });
  auto sink = tests::run_over(preset, source, frames, {"AO", false, {}});
  return std::move(sink.planes.at(kFrame).at("AO"));
}

tests::Motion at(const Vec3& origin, const Vec3& velocity) {
  tests::Motion motion;
  motion.origin = origin;
  motion.velocity = velocity;
  return motion;
}

/// Nothing but an infinite floor, seen from 6 m above at 45 degrees by a camera that moves.
const tests::Scene& floor_scene() {
  static const tests::Scene scene = [] {
    tests::Scene s{"floor alone", "", {{tests::Ground{}, {}}}, {}, {}};
    s.camera = {at({0, 6, 6}, {0.02, 0, -0.01}), at({0, 0, 0}, {0.02, 0, 0}), 40};
    return s;
  }();
  return scene;
}
const tests::Scene& columns() { return tests::find_scene("columns"); }

class AoProperties : public testing::TestWithParam<size_t> {
 protected:
  const Case& tested() const { return all_cases()[GetParam()]; }
};
INSTANTIATE_TEST_SUITE_P(All, AoProperties, testing::Range<size_t>(0, all_cases().size()), [](const auto& param) {
  std::string name = all_cases()[param.param].name;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
});

TEST_P(AoProperties, APlaneIsOpenAwayFromBorders) {
  const Plane ao = ao_of(tested().preset, floor_scene());
  const float allowed = has_mips(tested().preset) ? 1e-3F : has_bias(tested().preset) ? 0.0F : 1e-5F;
  float darkest = 1;
  for (int y = kMargin; y < kHeight - kMargin; ++y)
    for (int x = kMargin; x < kWidth - kMargin; ++x) darkest = std::min(darkest, ao(x, y));
  std::printf("%s: 1 - %.2g, allowed 1 - %.2g\n", tested().name.c_str(), static_cast<double>(1 - darkest),
              static_cast<double>(allowed));
  EXPECT_GE(darkest, 1 - allowed);
}

TEST_P(AoProperties, StaysBetweenNothingAndOpenAndLeavesTheSkyOpen) {
  const Plane ao = ao_of(tested().preset, columns());
  const Plane& depth = rendered(columns(), kFrame).planes(Role::depth)[0];
  int sky = 0;
  float darkest = 1;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_TRUE(ao(x, y) >= 0 && ao(x, y) <= 1) << x << ' ' << y << ": " << ao(x, y);
      darkest = std::min(darkest, ao(x, y));
      if (std::isfinite(depth(x, y))) continue;
      ++sky;
      ASSERT_EQ(ao(x, y), 1) << x << ' ' << y;
    }
  EXPECT_GT(sky, 1000);
  EXPECT_LT(darkest, 0.9F);
}

TEST_P(AoProperties, AnotherUnitOfLengthChangesNoBit) {
  const Plane metres = ao_of(tested().preset, columns());
  for (const float factor : {64.0F, 1 / 1024.0F}) {
    const Plane other = ao_of(scaled(tested().preset, static_cast<double>(factor)), columns(), {.factor = factor});
    EXPECT_TRUE(tests::same_pixels(metres, other)) << factor;
  }
}

/// A filter with memory compares with thresholds what rounding has moved: there, rare pixels may differ by more.
TEST_P(AoProperties, AnyOtherScaleChangesHardlyAnything) {
  const Plane metres = ao_of(tested().preset, columns());
  const Plane other = ao_of(scaled(tested().preset, 1.7), columns(), {.factor = 1.7F});
  int off = 0;
  float largest = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const float change = std::abs(metres(x, y) - other(x, y));
      off += !(change <= 1e-5F);
      largest = std::max(largest, change);
    }
  const double mean = metrics::mae(metres, other), share = static_cast<double>(off) / (kWidth * kHeight);
  std::printf("%s: mean change %.2g, largest %.2g, %.3f %% of the pixels by more than 1e-5\n", tested().name.c_str(),
              mean, static_cast<double>(largest), 100 * share);
  EXPECT_LE(mean, 1e-5);
  EXPECT_LE(share, has_memory(tested().preset) ? 0.01 : 0);
}

TEST_P(AoProperties, ThreadsChangeNothing) {
  set_thread_count(1);
  const Plane one = ao_of(tested().preset, columns());
  for (const int threads : {2, 3}) {
    set_thread_count(threads);
    EXPECT_TRUE(tests::same_pixels(one, ao_of(tested().preset, columns()))) << threads;
  }
  set_thread_count(0);
}

TEST_P(AoProperties, APartOfThePictureHasTheSamePixels) {
  const preset::Preset preset = scaled(tested().preset, 0.2, "radius");  // so that borders are not felt far inside
  const Window part{11, 7, kWidth - 1, kHeight - 1};                     // moved by odd offsets
  const Plane whole = ao_of(preset, columns()), cut = ao_of(preset, columns(), {.window = part});
  int differing = 0, dark = 0;
  for (int y = kMargin; y < part.height() - 4; ++y)
    for (int x = kMargin; x < part.width() - 4; ++x) {
      differing += cut(x, y) != whole(x + part.min_x, y + part.min_y);
      dark += cut(x, y) < 0.95F;
    }
  EXPECT_EQ(differing, 0);
  EXPECT_GT(dark, 20);
}

}  // namespace
}  // namespace aftershade::pipeline
