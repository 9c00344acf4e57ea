// Several presets in one run: each gets what it would get alone, frames are read once, and what presets share is made
// once and charged to all.
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/pipeline/ao_quality.h"

namespace aftershade::pipeline {
namespace {

using tests::MemorySink;
using tests::MemorySource;

/// As a preset that looks at its own frame, one with history, one with a window, one that blurs alone and one that does
/// not want the file's normals, for 36 lines.
std::vector<preset::Preset> presets() {
  const auto load = [](const std::string& name, const std::vector<std::string>& sets = {}) {
    return preset::load_preset(name, sets).preset;
  };
  return {load("low-dx11"),
          load("high-dx11"),
          load("high-dx11", {"temporal.method=temporal-window", "temporal.frames=2"}),
          load("guertin2014"),
          load("battlefield3-high", {"ao.normals=depth"}),
          load("soma")};
}

Frame frame_with_normals(int number) {
  Frame frame = tests::blade_frame(number);
  for (int c = 0; c < 3; ++c) frame.planes(Role::normal).emplace_back(48, 36, c == 2 ? -1.0F : 0.0F);
  return frame;
}

struct Plot {
  std::set<int> frames{1, 2, 3, 4, 5, 6, 7, 8};
  std::vector<int> written{3, 4, 5, 6};
  int preroll = 2;
  bool measure = false;
  size_t frames_in_flight = 3;
};

struct Outcome {
  std::vector<MemorySink> sinks;
  std::vector<MemorySource::Load> loads;
  std::vector<Progress> told;
};

Outcome run_together(const std::vector<preset::Preset>& presets, const Plot& plot) {
  std::vector<std::vector<ViewPipeline>> views;
  for (const preset::Preset& preset : presets) {
    ViewPipeline stages(preset, "", tests::kFullOffer, {});
    Outputs outputs;
    if (stages.makes_ao()) outputs.ao_channel = "AO";
    views.emplace_back();
    views.back().emplace_back(preset, "", tests::kFullOffer, outputs);
  }
  Outcome out;
  out.sinks.resize(presets.size());
  std::vector<Program> programs;
  for (size_t i = 0; i < presets.size(); ++i) programs.push_back({views[i], out.sinks[i]});
  MemorySource source(plot.frames, frame_with_normals);
  RunOptions options;
  options.written = plot.written;
  options.on_disk = source.numbers();
  options.preroll = plot.preroll;
  options.measure = plot.measure;
  options.frames_in_flight = plot.frames_in_flight;
  options.on_progress = [&](const Progress& progress) { out.told.push_back(progress); };
  run(programs, source, options);
  out.loads = source.loads;
  return out;
}

void expect_same(const MemorySink& a, const MemorySink& b, const std::string& what) {
  ASSERT_EQ(a.planes.size(), b.planes.size()) << what;
  for (const auto& [number, planes] : a.planes)
    for (const auto& [name, plane] : planes)
      EXPECT_TRUE(tests::same_pixels(plane, b.planes.at(number).at(name)))
          << what << ", frame " << number << ", " << name;
}

void expect_what_each_gets_alone(const Plot& plot) {
  const Outcome together = run_together(presets(), plot);
  for (size_t i = 0; i < presets().size(); ++i)
    expect_same(together.sinks[i], run_together({presets()[i]}, plot).sinks[0], presets()[i].name);
}

TEST(Programs, EachGetsWhatItWouldGetAlone) { expect_what_each_gets_alone({}); }

TEST(Programs, AlsoWhereFramesAreMissing) { expect_what_each_gets_alone({{1, 2, 3, 5, 6, 7}, {3, 5, 6}}); }

TEST(Programs, AlsoOneAfterTheOtherAndWithAllOfThePast) {
  Plot plot{.preroll = kPrerollAll, .measure = true};
  expect_what_each_gets_alone(plot);
}

TEST(Programs, EveryFrameIsReadOnce) {
  const Outcome out = run_together(presets(), {});
  std::vector<int> numbers;
  for (const auto& load : out.loads) numbers.push_back(load.number);
  EXPECT_EQ(numbers, tests::frames_from_to(1, 8));  // the window and the history reach to both sides
}

TEST(Programs, EveryFrameOfEveryPresetIsToldWithItsCount) {
  const Outcome out = run_together(presets(), {});
  std::map<size_t, std::vector<int>> frames;
  size_t done = 0;
  for (const Progress& progress : out.told)
    if (progress.written) {
      frames[progress.program].push_back(progress.number);
      EXPECT_EQ(progress.done, ++done);
      EXPECT_EQ(progress.total, 4 * presets().size());
    }
  for (size_t i = 0; i < presets().size(); ++i) EXPECT_EQ(frames[i], tests::frames_from_to(3, 6)) << presets()[i].name;
}

TEST(Programs, TakeTurnsInGoingFirst) {
  const std::vector<preset::Preset> two{preset::load_preset("mcguire2012").preset,
                                        preset::load_preset("guertin2014").preset};
  std::vector<size_t> first;
  for (const Progress& progress : run_together(two, {.written = {1, 2, 3, 4}, .measure = true}).told)
    if (first.size() < static_cast<size_t>(progress.number)) first.push_back(progress.program);
  EXPECT_EQ(first, (std::vector<size_t>{0, 1, 0, 1}));
}

/// The cost of normals from depth that another preset has made is in the AO stage's time of both.
TEST(Programs, WhatIsSharedIsChargedToEach) {
  const std::vector<std::string> depth{"ao.normals=depth"};
  const auto ao = [&](const std::string& name) {
    preset::Preset preset = tests::ao_part(name, depth);
    preset.stages.resize(1);
    return preset;
  };
  const std::vector<preset::Preset> two{ao("battlefield3-high"), ao("battlefield3-ultra")};
  std::vector<std::vector<ViewPipeline>> views(2);
  MemorySink sinks[2];
  for (size_t i = 0; i < 2; ++i) views[i].emplace_back(two[i], "", tests::kFullOffer, Outputs{{}, true, {}});
  const std::vector<Program> programs{{views[0], sinks[0]}, {views[1], sinks[1]}};
  MemorySource source({1, 2}, frame_with_normals);
  RunOptions options;
  options.written = options.on_disk = {1, 2};
  options.measure = true;
  std::map<std::pair<int, size_t>, size_t> bytes;
  options.on_progress = [&](const Progress& p) { bytes[{p.number, p.program}] = p.reports.at(0).shared_bytes; };
  run(programs, source, options);
  ASSERT_EQ(bytes.size(), 4U);
  EXPECT_GE(bytes.at({1, 0}), 3 * sizeof(float) * 48 * 36);  // normals
  for (const auto& [key, value] : bytes) EXPECT_EQ(value, bytes.at({1, 0}));
}

TEST(Programs, AFrameThatCannotBeReadIsLostToAll) {
  std::vector<std::vector<ViewPipeline>> views;
  MemorySink sinks[2];
  std::vector<Program> programs;
  views.reserve(2);
  for (const char* name : {"mcguire2012", "guertin2014"}) {
    views.emplace_back();
    views.back().emplace_back(preset::load_preset(name).preset, "", tests::kFullOffer, Outputs{});
    programs.push_back({views.back(), sinks[programs.size()]});
  }
  MemorySource source({1, 2, 3}, [](int number) {
    if (number == 2) throw Error(ErrorCode::data, "frame 2 is damaged");
    return frame_with_normals(number);
  });
  RunOptions options;
  options.written = options.on_disk = {1, 2, 3};
  options.keep_going = true;
  int errors = 0;
  options.on_error = [&](const Error&) { ++errors; };
  EXPECT_EQ(run(programs, source, options), 4U);
  EXPECT_EQ(errors, 1);
  for (const MemorySink& sink : sinks) {
    EXPECT_EQ(sink.planes.size(), 2U);
    EXPECT_FALSE(sink.planes.contains(2));
  }
}

TEST(Programs, MemoryIsMeasuredAsOfEachAlone) {
  const Plot plot{.measure = true};
  const auto bytes_of = [](const Outcome& out) {
    std::map<size_t, size_t> bytes;
    for (const Progress& progress : out.told) bytes[progress.program] = progress.memory_bytes;
    return bytes;
  };
  auto together = bytes_of(run_together(presets(), plot));
  for (size_t i = 0; i < presets().size(); ++i) {
    EXPECT_GT(together[i], 5 * sizeof(float) * 48 * 36);
    EXPECT_EQ(together[i], bytes_of(run_together({presets()[i]}, plot))[0]) << presets()[i].name;
  }
}

}  // namespace
}  // namespace aftershade::pipeline
