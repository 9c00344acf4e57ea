#include "core/pipeline/pipeline.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/pipeline/memory_sequence.h"

namespace aftershade::pipeline {
namespace {

using tests::MemorySink;
using tests::MemorySource;

const Offer kEverything{{Role::depth, Role::velocity_prev, Role::velocity_next}, true, true};

std::set<int> frames_1_to(int last) {
  std::set<int> frames;
  for (int i = 1; i <= last; ++i) frames.insert(i);
  return frames;
}

preset::Preset preset_of(const std::string& name, const std::vector<std::string>& sets = {}) {
  return preset::load_preset(name, sets).preset;
}

/// Runs a preset over the blades and returns what was written.
MemorySink run_blades(const preset::Preset& preset, std::vector<int> written, int preroll = kPrerollAll,
                      Outputs outputs = {"AO", true, {}}, MemorySource source = {frames_1_to(8), tests::blade_frame}) {
  std::vector<ViewPipeline> views;
  views.emplace_back(preset, "", kEverything, outputs);
  MemorySink sink;
  RunOptions options;
  options.written = std::move(written);
  options.on_disk = source.numbers();
  options.preroll = preroll;
  EXPECT_EQ(run(views, source, sink, options), options.written.size());
  return sink;
}

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ViewPipeline, NamesTheStageAndTheRoleThatIsMissing) {
  const std::string text = message_of([] {
    ViewPipeline(preset_of("high-dx11"), "", {{Role::velocity_prev}, true, true}, {});
  });
  EXPECT_NE(text.find("stage ao (scalable-ao) needs depth"), std::string::npos) << text;
  EXPECT_NE(text.find("--channel"), std::string::npos) << text;
}

TEST(ViewPipeline, MotionBlurNeedsEitherVelocityOrTheCameraWithDepth) {
  preset::Preset blur = preset_of("high-dx11");
  std::erase_if(blur.stages, [](const auto& stage) { return stage.id != "motion_blur"; });
  for (const Offer& offer : {Offer{{Role::depth}, true, false}, Offer{{}, true, true}}) {
    const std::string text = message_of([&] { ViewPipeline(blur, "", offer, {}); });
    EXPECT_NE(text.find("velocity_prev or velocity_next, or depth and camera matrices"), std::string::npos) << text;
  }
  for (const Offer& offer : {Offer{{Role::velocity_prev}, false, false}, Offer{{Role::velocity_next}, false, false},
                             Offer{{Role::depth}, true, true}})
    EXPECT_NO_THROW(ViewPipeline(blur, "", offer, {}));
}

TEST(ViewPipeline, AsksForAFieldOfView) {
  const std::string text = message_of([] {
    ViewPipeline(preset_of("high-dx11"), "", {kEverything.roles, false, false}, {});
  });
  EXPECT_NE(text.find("--fov"), std::string::npos) << text;
}

TEST(ViewPipeline, RefusesAnOrderThatCannotWork) {
  preset::Preset preset = preset_of("high-dx11");
  std::erase_if(preset.stages, [](const auto& stage) { return stage.id == "upsample"; });
  EXPECT_NE(message_of([&] { ViewPipeline(preset, "", kEverything, {}); }).find("bilateral-upsample"),
            std::string::npos);
  std::erase_if(preset.stages, [](const auto& stage) { return stage.id == "ao"; });
  EXPECT_NE(message_of([&] { ViewPipeline(preset, "", kEverything, {}); }).find("no stage before it makes any"),
            std::string::npos);
}

TEST(ViewPipeline, AoChannelNeedsAStageThatMakesIt) {
  preset::Preset preset = preset_of("high-dx11");
  std::erase_if(preset.stages, [](const auto& stage) { return stage.id != "motion_blur"; });
  EXPECT_NE(message_of([&] {
              ViewPipeline(preset, "", kEverything, {"AO", true, {}});
            }).find("--ao"),
            std::string::npos);
}

/// A radius clamp of AO that is meant at 720 lines would leave one pixel here.
preset::Preset meant_at_36_lines(const std::string& name) {
  std::vector<std::string> sets;
  for (const auto& stage : preset_of(name).stages)
    for (const params::Record& record : preset::table_of(stage.params))
      if (stage.id == "ao" && record.key == "reference_height_px") sets.push_back("ao.reference_height_px=36");
  return preset_of(name, sets);
}

TEST(Run, EveryShippedPresetRunsAndStaysInRange) {
  for (const std::string& name : preset::shipped_presets()) {
    const preset::Preset preset = meant_at_36_lines(name);
    const bool makes_ao = std::ranges::any_of(preset.stages, [](const auto& stage) { return stage.id == "ao"; });
    const Outputs outputs = makes_ao ? Outputs{"AO", true, {}} : Outputs{};
    const MemorySink sink = run_blades(preset, {3, 4}, kPrerollAll, outputs);
    for (const auto& [frame, planes] : sink.planes) {
      const Plane& red = planes.at("R");
      for (int y = 0; y < red.height(); ++y)
        for (int x = 0; x < red.width(); ++x)
          ASSERT_TRUE(red(x, y) >= 0 && red(x, y) <= 0.5001F) << name << " " << x << "," << y;
      if (!makes_ao) continue;
      const Plane& ao = planes.at("AO");
      double darkest = 1;
      for (int y = 0; y < ao.height(); ++y)
        for (int x = 0; x < ao.width(); ++x) {
          ASSERT_TRUE(ao(x, y) >= 0 && ao(x, y) <= 1) << name << " " << x << "," << y;
          darkest = std::min<double>(darkest, ao(x, y));
        }
      EXPECT_LT(darkest, 0.9) << name << ": the blades occlude the wall";
    }
  }
}

TEST(Run, ChunksAreIdenticalToOneRunWhenThePrerollIsExact) {
  const MemorySink whole = run_blades(preset_of("high-dx11"), {1, 2, 3, 4, 5, 6, 7, 8});
  const MemorySink chunk = run_blades(preset_of("high-dx11"), {6, 7, 8});
  for (const int frame : {6, 7, 8})
    for (const char* channel : {"R", "A", "AO"})
      EXPECT_TRUE(tests::same_pixels(whole.planes.at(frame).at(channel), chunk.planes.at(frame).at(channel)))
          << frame << " " << channel;
}

TEST(Run, HistoryMattersAndAGapForgetsIt) {
  const MemorySink with = run_blades(preset_of("high-dx11"), {6});
  const MemorySink without = run_blades(preset_of("high-dx11"), {6}, 0);
  EXPECT_FALSE(tests::same_pixels(with.planes.at(6).at("AO"), without.planes.at(6).at("AO")));
  const MemorySink after_gap =
      run_blades(preset_of("high-dx11"), {6}, kPrerollAll, {"AO", true, {}}, {{1, 2, 3, 4, 6}, tests::blade_frame});
  EXPECT_TRUE(tests::same_pixels(after_gap.planes.at(6).at("AO"), without.planes.at(6).at("AO")));
}

TEST(Run, PrerollFramesAreLoadedWithoutLayers) {
  MemorySource source(frames_1_to(8), tests::blade_frame);
  std::vector<ViewPipeline> views;
  views.emplace_back(preset_of("high-dx11"), "", kEverything, Outputs{});
  MemorySink sink;
  RunOptions options;
  options.written = {3};
  options.on_disk = source.numbers();
  options.preroll = 2;
  run(views, source, sink, options);
  EXPECT_EQ(source.loads, (std::vector<MemorySource::Load>{{1, false}, {2, false}, {3, true}}));
  EXPECT_EQ(sink.planes.size(), 1U);
}

TEST(Run, CarriedForwardVectorsReplaceMissingBackwardOnes) {
  const Offer offer{{Role::depth, Role::velocity_next}, true, true};
  MemorySource source(frames_1_to(4), [](int number) {
    Frame frame = tests::blade_frame(number);
    frame.planes(Role::velocity_prev).clear();
    return frame;
  });
  std::vector<ViewPipeline> views;
  views.emplace_back(preset_of("high-dx11"), "", offer, Outputs{});
  EXPECT_TRUE(views.front().previous_roles().contains(Role::velocity_next));
  MemorySink sink;
  RunOptions options;
  options.written = {2};
  options.on_disk = source.numbers();
  std::vector<std::string> notes;
  options.on_progress = [&](const Progress& progress) {
    for (const auto& report : progress.reports) notes.insert(notes.end(), report.notes.begin(), report.notes.end());
  };
  run(views, source, sink, options);
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(),
                          [](const std::string& n) { return n.find("carried forward") != std::string::npos; }));
}

TEST(Run, DiagnosticsAreChannelsOfTheFramesSize) {
  Outputs outputs{"AO", true, {pipeline::AovSet::all(), false}};
  const MemorySink sink = run_blades(preset_of("high-dx11"), {2}, kPrerollAll, outputs);
  for (const char* name : {"aftershade.ao_raw", "aftershade.mask", "aftershade.history_age",
                           "aftershade.neighbour_velocity.x", "aftershade.neighbour_velocity.y"}) {
    ASSERT_TRUE(sink.planes.at(2).contains(name)) << name;
    EXPECT_EQ(sink.planes.at(2).at(name).width(), 48) << name;
  }
}

TEST(Run, AoOnlyDoesNotEvenLoadLayers) {
  const MemorySink sink = run_blades(preset_of("high-dx11"), {2}, kPrerollAll, {"AO", false, {}});
  EXPECT_FALSE(sink.planes.at(2).contains("R"));
  EXPECT_TRUE(sink.planes.at(2).contains("AO"));
}

TEST(ViewPipeline, RefusesToWorkOnAoBehindTheMotionBlur) {
  preset::Preset preset = preset_of("high-dx11");
  std::rotate(preset.stages.begin() + 1, preset.stages.end() - 1, preset.stages.end());  // ao, motion_blur, blur, ...
  EXPECT_NE(message_of([&] { ViewPipeline(preset, "", kEverything, {}); }).find("stands behind a stage that blurs"),
            std::string::npos);
}

TEST(ViewPipeline, CameraReprojectionNeedsAPosition) {
  const preset::Preset preset = preset_of("high-dx11", {"temporal.reprojection=camera"});
  EXPECT_NE(message_of([&] {
              ViewPipeline(preset, "", {kEverything.roles, true, false}, {});
            }).find("where the camera"),
            std::string::npos);
}

TEST(Run, ACutStartsTheHistoryAnew) {
  const auto cut = [](int number) {
    Frame frame = tests::blade_frame(number);
    if (number < 4) return frame;
    for (int y = 0; y < 36; ++y)
      for (int x = 0; x < 48; ++x) frame.planes(Role::depth)[0](x, y) *= 0.5F;  // another place
    return frame;
  };
  const auto ao_of = [&](int preroll) {
    return run_blades(preset_of("high-dx11"), {5}, preroll, {"AO", true, {}}, {frames_1_to(5), cut});
  };
  EXPECT_TRUE(tests::same_pixels(ao_of(kPrerollAll).planes.at(5).at("AO"), ao_of(1).planes.at(5).at("AO")));
  EXPECT_FALSE(tests::same_pixels(ao_of(1).planes.at(5).at("AO"), ao_of(0).planes.at(5).at("AO")));
}

TEST(Run, AStrictDepthTestIsNoCut) {
  ViewPipeline view(preset_of("high-dx11", {"temporal.epsilon=0.00001"}), "", kEverything, {});
  for (int number = 1; number <= 4; ++number) {
    Frame frame = tests::blade_frame(number);
    for (int y = 0; y < 36; ++y)  // a slope: the nearest pixel of the frame before is never at quite the same depth
      for (int x = 0; x < 48; ++x) frame.planes(Role::depth)[0](x, y) += 0.01F * static_cast<float>(x);
    view.push(std::move(frame), std::nullopt, {number, view.stages(), true, number == 1});
    const std::vector<FinishedFrame> finished = view.take_finished();
    for (const std::string& note : finished.at(0).report.notes) EXPECT_EQ(note.find("cut"), std::string::npos) << note;
  }
}

TEST(Run, StagesMarkTheLayersTheyChange) {
  for (const auto& [id, changes] : {std::pair{"ao", false}, {"motion_blur", true}}) {
    preset::Preset preset = preset_of("high-current-gen");
    std::erase_if(preset.stages, [&](const auto& stage) { return stage.id != id; });
    ViewPipeline view(preset, "", kEverything, {});
    view.push(tests::blade_frame(1), std::nullopt, {1, view.stages(), true, true});
    EXPECT_EQ(view.take_finished().at(0).frame.layers.front().changed, changes) << id;
  }
}

TEST(Run, OutOfMemoryIsAFailureOfItsFrame) {
  MemorySource source(frames_1_to(2), [](int number) -> Frame {
    if (number == 1) throw std::bad_alloc();
    return tests::blade_frame(number);
  });
  std::vector<ViewPipeline> views;
  views.emplace_back(preset_of("high-dx11"), "", kEverything, Outputs{});
  MemorySink sink;
  RunOptions options;
  options.written = options.on_disk = {1, 2};
  options.keep_going = true;
  std::vector<ErrorCode> codes;
  options.on_error = [&](const Error& error) { codes.push_back(error.code()); };
  EXPECT_EQ(run(views, source, sink, options), 1U);
  EXPECT_EQ(codes, std::vector<ErrorCode>{ErrorCode::memory});
}

TEST(Run, KeepGoingReportsTheFrameAndRestartsTheHistory) {
  MemorySource source(frames_1_to(5), [](int number) {
    if (number == 3) throw Error(ErrorCode::data, "frame 3 is damaged");
    return tests::blade_frame(number);
  });
  std::vector<ViewPipeline> views;
  views.emplace_back(preset_of("high-dx11"), "", kEverything, Outputs{"AO", true, {}});
  MemorySink sink;
  RunOptions options;
  options.written = {1, 2, 3, 4, 5};
  options.on_disk = source.numbers();
  EXPECT_THROW(run(views, source, sink, options), Error);
  std::vector<std::string> errors;
  options.keep_going = true;
  options.on_error = [&](const Error& error) { errors.emplace_back(error.what()); };
  EXPECT_EQ(run(views, source, sink, options), 4U);
  EXPECT_EQ(errors, std::vector<std::string>{"frame 3 is damaged"});
  const MemorySink alone = run_blades(preset_of("high-dx11"), {4}, 0);
  EXPECT_TRUE(tests::same_pixels(sink.planes.at(4).at("AO"), alone.planes.at(4).at("AO")));
}

TEST(Run, StopsBetweenFrames) {
  MemorySource source(frames_1_to(5), tests::blade_frame);
  std::vector<ViewPipeline> views;
  views.emplace_back(preset_of("low-dx11"), "", kEverything, Outputs{});
  MemorySink sink;
  RunOptions options;
  options.written = options.on_disk = source.numbers();
  int asked = 0;
  options.should_stop = [&] { return ++asked == 3; };
  EXPECT_EQ(run(views, source, sink, options), 2U);
  EXPECT_EQ(sink.planes.size(), 2U);
}

/// A bright square that fills its own small data window and moves right.
Frame cropped_frame(int number) {
  Frame frame = tests::blade_frame(number);
  frame.window = {20, 10, 27, 17};
  for (const Role role : {Role::velocity_prev, Role::velocity_next}) {
    frame.planes(role).clear();
    frame.planes(role).emplace_back(8, 8, role == Role::velocity_next ? 8.0F : -8.0F);
    frame.planes(role).emplace_back(8, 8, 0.0F);
  }
  frame.planes(Role::depth).clear();
  frame.layers.front().data_window = frame.window;
  for (Plane& plane : frame.layers.front().planes) plane = Plane(8, 8, 1.0F);
  return frame;
}

TEST(Run, DataWindowKeepsAndSaysWhatIsCutOffOrGrows) {
  preset::Preset preset = preset_of("high-dx11", {"motion_blur.reference_height_px=100"});
  std::erase_if(preset.stages, [](const auto& stage) { return stage.id != "motion_blur"; });
  for (const bool grow : {false, true}) {
    MemorySource source({1}, cropped_frame);
    std::vector<ViewPipeline> views;
    views.emplace_back(preset, "", Offer{{Role::velocity_prev, Role::velocity_next}, false, false},
                       Outputs{{}, true, {{}, grow}});
    MemorySink sink;
    RunOptions options;
    options.written = options.on_disk = {1};
    std::vector<std::string> warnings;
    options.on_progress = [&](const Progress& progress) { warnings = progress.reports.front().warnings; };
    run(views, source, sink, options);
    EXPECT_EQ(warnings.size(), grow ? 0U : 1U);
    EXPECT_EQ(sink.windows.at(1).width() > 8, grow);
    double sum = 0;
    const Plane& red = sink.planes.at(1).at("R");
    for (int y = 0; y < red.height(); ++y)
      for (int x = 0; x < red.width(); ++x) sum += red(x, y);
    if (grow)
      EXPECT_GT(sum, 0.9 * 64) << "the light is still there, spread";
    else
      EXPECT_NE(warnings.front().find("% of the blurred light"), std::string::npos);
  }
}

}  // namespace
}  // namespace aftershade::pipeline
