// With keep_going a failure costs its own frame, and others only what they would have seen of it.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "tests/pipeline/ao_quality.h"

namespace aftershade::pipeline {
namespace {

using tests::MemorySink;
using tests::MemorySource;
using tests::same_pixels;

constexpr int kDamaged = 6;
const Offer kAmbientToo{{Role::depth, Role::ambient, Role::velocity_prev, Role::velocity_next}, true, true};

Frame with_ambient(int number) {
  Frame frame = tests::blade_frame(number);
  for (int c = 0; c < 3; ++c) frame.planes(Role::ambient).emplace_back(48, 36, 0.5F);
  return frame;
}

Frame without_ambient_in_one(int number) {
  return number == kDamaged ? tests::blade_frame(number) : with_ambient(number);
}

/// AO, a window of 2 frames on each side, and where `apply_at` says the stage that fails without ambient light: 1 is
/// before the window, 2 behind it.
preset::Preset preset_of(std::ptrdiff_t apply_at) {
  preset::Preset preset = tests::ao_part(
      "high-dx11", {"temporal.method=temporal-window", "temporal.frames=2", "ao.reference_height_px=36"});
  const auto is = [](std::string_view method) {
    return [method](const auto& stage) { return preset::method_of(stage.params) == method; };
  };
  const auto window = std::find_if(preset.stages.begin(), preset.stages.end(), is("temporal-window"));
  preset.stages.insert(window + (apply_at - 1), {"apply", ao::ApplyAoParams{.target = ao::ApplyTarget::ambient}});
  return preset;
}

struct Outcome {
  MemorySink sink;
  std::vector<std::string> errors;
};

Outcome run_views(const preset::Preset& preset, FrameSource& source, FrameSink* to, const std::vector<int>& on_disk,
                  const std::vector<std::string>& names) {
  std::vector<ViewPipeline> views;
  for (const std::string& name : names) views.emplace_back(preset, name, kAmbientToo, Outputs{"AO", true, {}});
  Outcome outcome;
  RunOptions options;
  options.written = options.on_disk = on_disk;
  options.keep_going = true;
  options.on_error = [&](const Error& error) { outcome.errors.emplace_back(error.what()); };
  run(views, source, to != nullptr ? *to : outcome.sink, options);
  return outcome;
}

const std::vector<int> kFrames{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

void expect_same_but_the_damaged(const MemorySink& a, const MemorySink& b) {
  EXPECT_FALSE(a.planes.contains(kDamaged));
  for (const int frame : kFrames) {
    if (frame == kDamaged) continue;
    ASSERT_TRUE(a.planes.contains(frame)) << frame;
    EXPECT_TRUE(same_pixels(a.planes.at(frame).at("AO"), b.planes.at(frame).at("AO"))) << frame;
    EXPECT_TRUE(same_pixels(a.planes.at(frame).at("R"), b.planes.at(frame).at("R"))) << frame;
  }
}

TEST(KeepGoing, AStageThatFailsBehindAWindowCostsItsFrameAlone) {
  MemorySource damaged({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, without_ambient_in_one);
  MemorySource whole({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, with_ambient);
  const Outcome out = run_views(preset_of(2), damaged, nullptr, kFrames, {""});
  ASSERT_EQ(out.errors.size(), 1U);
  EXPECT_NE(out.errors[0].find("frame 6"), std::string::npos) << out.errors[0];
  expect_same_but_the_damaged(out.sink, run_views(preset_of(2), whole, nullptr, kFrames, {""}).sink);
}

TEST(KeepGoing, AStageThatFailsBeforeAWindowIsAGapInIt) {
  MemorySource damaged({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, without_ambient_in_one);
  MemorySource holed({1, 2, 3, 4, 5, 7, 8, 9, 10}, with_ambient);
  const Outcome out = run_views(preset_of(1), damaged, nullptr, kFrames, {""});
  EXPECT_EQ(out.errors.size(), 1U);
  expect_same_but_the_damaged(out.sink, run_views(preset_of(1), holed, nullptr, holed.numbers(), {""}).sink);
}

/// One of two views cannot be read, or fails, in one frame.
class OneViewFails final : public FrameSource {
 public:
  OneViewFails(std::string view, bool unreadable) : view_(std::move(view)), unreadable_(unreadable) {}
  std::optional<Frame> load(int number, const std::string& view, RoleSet, bool) override {
    Frame frame = view == view_ && !unreadable_ ? without_ambient_in_one(number) : with_ambient(number);
    if (unreadable_ && view == view_ && number == kDamaged) throw Error(ErrorCode::data, "frame 6 is damaged");
    frame.view = view;
    return frame;
  }

 private:
  std::string view_;
  bool unreadable_;
};

/// Counts the views that each frame is written with.
class CountingSink final : public FrameSink {
 public:
  void write(int number, const std::vector<Frame>& views) override { written[number] = views.size(); }
  std::map<int, size_t> written;
};

TEST(KeepGoing, AFrameThatFailsInOneViewIsLostInBothAndNoOther) {
  for (const char* view : {"left", "right"})
    for (const bool unreadable : {false, true}) {
      OneViewFails source(view, unreadable);
      CountingSink sink;
      const Outcome out = run_views(preset_of(2), source, &sink, kFrames, {"left", "right"});
      EXPECT_EQ(out.errors.size(), 1U) << view;
      EXPECT_EQ(sink.written.size(), kFrames.size() - 1) << view << " " << unreadable;
      EXPECT_FALSE(sink.written.contains(kDamaged));
      for (const auto& [frame, views] : sink.written) EXPECT_EQ(views, 2U) << frame;
    }
}

/// Has no room for one frame.
class FullOnce final : public FrameSink {
 public:
  void write(int number, const std::vector<Frame>& views) override {
    if (number == kDamaged) throw Error(ErrorCode::io, "frame 6: no space left");
    kept.write(number, views);
  }
  MemorySink kept;
};

TEST(KeepGoing, AFrameThatCannotBeWrittenIsStillSeenByItsNeighbours) {
  MemorySource whole({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, with_ambient);
  FullOnce sink;
  const Outcome out = run_views(preset_of(2), whole, &sink, kFrames, {""});
  EXPECT_EQ(out.errors, std::vector<std::string>{"frame 6: no space left"});
  expect_same_but_the_damaged(sink.kept, run_views(preset_of(2), whole, nullptr, kFrames, {""}).sink);
}

TEST(KeepGoing, WithoutItTheRunEndsAtTheFrameThatFails) {
  MemorySource damaged({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, without_ambient_in_one);
  std::vector<ViewPipeline> views;
  views.emplace_back(preset_of(2), "", kAmbientToo, Outputs{"AO", true, {}});
  MemorySink sink;
  RunOptions options;
  options.written = options.on_disk = kFrames;
  EXPECT_THROW(run(views, damaged, sink, options), Error);
  EXPECT_EQ(sink.planes.size(), 5U);
}

}  // namespace
}  // namespace aftershade::pipeline
