// What a caller sees of a run does not depend on how reading, computing and writing overlap: a run that does one after
// the other is what all others are held against. Times of reading and writing are random, seeded.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <random>
#include <thread>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/parallel/rows.h"
#include "tests/pipeline/ao_quality.h"

namespace aftershade::pipeline {
namespace {

using tests::MemorySink;
using tests::same_pixels;

constexpr int kFrames = 6;
const Offer kAmbientToo{{Role::depth, Role::ambient, Role::velocity_prev, Role::velocity_next}, true, true};
const Offer kNextOnly{{Role::depth, Role::ambient, Role::velocity_next}, true, true};

enum class Step { none, read, compute, write };

/// What goes wrong, and where.
struct Plot {
  Step step = Step::none;
  int frame = 0;
  bool keep_going = false;
  int stop_before = 0;     ///< the ordinal of should_stop's call that says yes
  std::set<int> gone{};    ///< frames that are not on disk
  int window = 0;          ///< frames on each side that the temporal filter looks at; 0: history
  bool next_only = false;  ///< vectors to the next frame alone, so that stages read the frame before
};

struct Pace {
  int threads = 1;
  size_t frames_in_flight = 1;
  unsigned seed = 0;
};

/// Waits up to a millisecond.
void dawdle(unsigned seed, int number) {
  std::mt19937 random(seed * 1000 + static_cast<unsigned>(number));
  if (seed != 0) std::this_thread::sleep_for(std::chrono::microseconds(random() % 1000));
}

/// Counts how many live.
class Alive final : public FileData {
 public:
  explicit Alive(std::atomic<int>& count, std::atomic<int>& most) : count_(count) {
    const int now = ++count_;
    for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
    }
  }
  ~Alive() override { --count_; }

 private:
  std::atomic<int>& count_;
};

class SlowSource final : public FrameSource {
 public:
  SlowSource(const Plot& plot, const Pace& pace) : plot_(plot), pace_(pace) {}
  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool with_layers) override {
    loads.push_back(number);
    dawdle(pace_.seed, number);
    for_rows(4, [&](int y) { dawdle(pace_.seed, 100 * number + y); });
    if (plot_.step == Step::read && number == plot_.frame) throw Error(ErrorCode::data, cat("cannot read ", number));
    Frame frame = tests::blade_frame(number);
    frame.view = view;
    frame.file = std::make_shared<Alive>(alive, most_alive);
    if (plot_.step != Step::compute || number != plot_.frame)
      for (int c = 0; c < 3; ++c) frame.planes(Role::ambient).emplace_back(48, 36, 0.5F);
    if (plot_.next_only) frame.planes(Role::velocity_prev).clear();
    for (const RoleInfo& role : kRoles)
      if (!roles.contains(role.role)) frame.planes(role.role).clear();
    if (!with_layers) frame.layers.clear();
    return frame;
  }
  std::vector<int> loads;
  std::atomic<int> alive = 0, most_alive = 0;

 private:
  const Plot& plot_;
  const Pace& pace_;
};

class SlowSink final : public FrameSink {
 public:
  SlowSink(const Plot& plot, const Pace& pace) : plot_(plot), pace_(pace) {}
  void write(int number, const std::vector<Frame>& views) override {
    dawdle(pace_.seed, -number);
    for_rows(4, [&](int y) { dawdle(pace_.seed, -100 * number - y); });
    if (plot_.step == Step::write && number == plot_.frame) throw Error(ErrorCode::io, cat("cannot write ", number));
    kept.write(number, views);
  }
  MemorySink kept;

 private:
  const Plot& plot_;
  const Pace& pace_;
};

/// AO with its temporal filter, and a stage behind it that fails without ambient light.
preset::Preset preset_of(const Plot& plot) {
  std::vector<std::string> sets{"ao.reference_height_px=36"};
  if (plot.window > 0)
    sets.insert(sets.end(), {"temporal.method=temporal-window", cat("temporal.frames=", plot.window)});
  preset::Preset preset = tests::ao_part("high-dx11", sets);
  preset.stages.push_back({"apply", ao::ApplyAoParams{.target = ao::ApplyTarget::ambient}});
  return preset;
}

/// All that a run shows.
struct Story {
  std::vector<std::string> told;  ///< to the caller, in order
  std::string thrown;
  size_t result = 0;
  MemorySink sink;
  std::vector<int> loads;
  int most_alive = 0, left_alive = 0;

  std::vector<int> written() const {
    std::vector<int> frames;
    for (const auto& [frame, planes] : sink.planes) frames.push_back(frame);
    return frames;
  }
};

Story story_of(const Plot& plot, const Pace& pace, const std::vector<std::string>& names = {""}) {
  set_thread_count(pace.threads);
  std::vector<ViewPipeline> views;
  for (const std::string& name : names)
    views.emplace_back(preset_of(plot), name, plot.next_only ? kNextOnly : kAmbientToo, Outputs{"AO", true, {}});
  SlowSource source(plot, pace);
  SlowSink sink(plot, pace);
  Story story;
  RunOptions options;
  for (int frame = 1; frame <= kFrames; ++frame)
    if (!plot.gone.contains(frame)) options.written.push_back(frame);
  options.on_disk = options.written;
  options.keep_going = plot.keep_going;
  options.frames_in_flight = pace.frames_in_flight;
  options.on_loaded = [&](int frame) { story.told.push_back(cat("loaded ", frame)); };
  options.on_progress = [&](const Progress& p) {
    std::string text = cat("frame ", p.number, " ", p.done, "/", p.total);
    for (const FrameReport& report : p.reports)
      for (const std::string& note : report.notes) text += ", " + note;
    story.told.push_back(text);
  };
  options.on_error = [&](const Error& error) { story.told.push_back(cat("error: ", error.what())); };
  int asked = 0;
  options.should_stop = [&] { return ++asked == plot.stop_before; };
  try {
    story.result = run(views, source, sink, options);
  } catch (const Error& error) {
    story.thrown = error.what();
  }
  views.clear();
  story.sink = std::move(sink.kept);
  story.loads = source.loads;
  story.most_alive = source.most_alive;
  story.left_alive = source.alive;
  set_thread_count(0);
  return story;
}

void expect_same(const Story& story, const Story& plain, const std::string& what) {
  EXPECT_EQ(story.told, plain.told) << what;
  EXPECT_EQ(story.thrown, plain.thrown) << what;
  EXPECT_EQ(story.result, plain.result) << what;
  ASSERT_EQ(story.written(), plain.written()) << what;
  for (const auto& [frame, planes] : plain.sink.planes)
    for (const auto& [name, plane] : planes)
      EXPECT_TRUE(same_pixels(story.sink.planes.at(frame).at(name), plane)) << what << ": " << frame << " " << name;
}

/// Returns the story without overlap after holding all others against it.
Story story_at_every_pace(const Plot& plot, const std::vector<std::string>& names = {""}) {
  Story plain = story_of(plot, {}, names);
  unsigned seed = 0;
  for (const int threads : {1, 2, 3, 4})
    for (const size_t in_flight : {1, 2, 3}) {
      const Pace pace{threads, in_flight, ++seed};
      const Story story = story_of(plot, pace, names);
      expect_same(story, plain, cat(threads, " threads, ", in_flight, " frames"));
      EXPECT_LE(story.most_alive, static_cast<int>((in_flight + 2 * static_cast<size_t>(plot.window)) * names.size()));
      EXPECT_EQ(story.left_alive, 0);
    }
  return plain;
}

std::vector<int> numbers(int first, int last, int without = 0) {
  std::vector<int> frames;
  for (int i = first; i <= last; ++i)
    if (i != without) frames.push_back(i);
  return frames;
}

TEST(RunOverlap, TellsOfEachFrameThatItIsReadThenThatItIsWritten) {
  const Story story = story_at_every_pace({});
  EXPECT_EQ(story.written(), numbers(1, kFrames));
  ASSERT_EQ(story.told.size(), 2U * kFrames);
  for (size_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(story.told[2 * i], cat("loaded ", i + 1));
    EXPECT_TRUE(story.told[2 * i + 1].starts_with(cat("frame ", i + 1, " ", i + 1, "/6"))) << story.told[2 * i + 1];
  }
}

TEST(RunOverlap, TwoViewsOfAFrameStayTogether) {
  const Story story = story_at_every_pace({}, {"left", "right"});
  EXPECT_EQ(story.written(), numbers(1, kFrames));
}

TEST(RunOverlap, AFailureEndsTheRunAfterTheFramesBeforeIt) {
  for (const Step step : {Step::read, Step::compute, Step::write})
    for (int frame = 1; frame <= kFrames; ++frame) {
      const Story story = story_at_every_pace({.step = step, .frame = frame});
      EXPECT_EQ(story.written(), numbers(1, frame - 1));
      EXPECT_NE(story.thrown.find(cat(frame)), std::string::npos) << story.thrown;
    }
}

TEST(RunOverlap, WithKeepGoingAFailureCostsItsFrameAlone) {
  for (const Step step : {Step::read, Step::compute, Step::write})
    for (int frame = 1; frame <= kFrames; ++frame) {
      const Story story = story_at_every_pace({.step = step, .frame = frame, .keep_going = true});
      EXPECT_EQ(story.written(), numbers(1, kFrames, frame));
      EXPECT_EQ(story.result, kFrames - 1U);
      EXPECT_EQ(std::ranges::count_if(story.told, [](const auto& text) { return text.starts_with("error"); }), 1);
    }
}

TEST(RunOverlap, StoppingLeavesTheFramesBeforeItComplete) {
  for (int stop = 1; stop <= kFrames; ++stop) {
    const Story story = story_at_every_pace({.stop_before = stop});
    EXPECT_EQ(story.written(), numbers(1, stop - 1));
    EXPECT_EQ(story.result, static_cast<size_t>(stop - 1));
    EXPECT_LE(story.loads.size(), static_cast<size_t>(stop)) << "nothing is read ahead any more";
  }
}

TEST(RunOverlap, AWindowHoldsFramesBack) {
  for (const Step step : {Step::none, Step::read, Step::compute, Step::write})
    for (const bool keep_going : {false, true})
      story_at_every_pace({.step = step, .frame = 4, .keep_going = keep_going, .window = 1});
}

TEST(RunOverlap, FramesThatWaitBeforeAGapAreWrittenBeforeTheFrameBehindItFails) {
  const Story story = story_at_every_pace({.step = Step::read, .frame = 5, .gone = {4}, .window = 2});
  EXPECT_EQ(story.written(), numbers(1, 3));
  const Story depends = story_at_every_pace({.step = Step::read, .frame = 5, .window = 2});
  EXPECT_EQ(depends.written(), numbers(1, 2)) << "3 and 4 look at 5";
}

TEST(RunOverlap, TheFrameBeforeIsNotReadAgainForItsVectors) {
  const Story story = story_at_every_pace({.next_only = true});
  EXPECT_EQ(story.loads, numbers(1, kFrames));
  EXPECT_NE(story.told.back().find("carried forward"), std::string::npos) << story.told.back();
  EXPECT_EQ(story.told[1].find("carried forward"), std::string::npos) << "nothing is before the first";
  story_at_every_pace({.step = Step::read, .frame = 3, .keep_going = true, .next_only = true});
  story_at_every_pace({.gone = {3}, .next_only = true});
}

/// The second frame's reading and the first one's writing wait for each other.
class Meeting final : public FrameSource, public FrameSink {
 public:
  std::optional<Frame> load(int number, const std::string&, RoleSet, bool) override {
    if (number == 2) arrive();
    return tests::blade_frame(number);
  }
  void write(int number, const std::vector<Frame>&) override {
    if (number == 1) arrive();
  }
  bool met() const { return arrived_ == 2; }

 private:
  void arrive() {
    std::unique_lock lock(mutex_);
    ++arrived_;
    changed_.notify_all();
    changed_.wait_for(lock, std::chrono::seconds(20), [&] { return met(); });
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  int arrived_ = 0;
};

TEST(RunOverlap, AFrameIsReadWhileAnotherIsWritten) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one processor";
  set_thread_count(2);
  std::vector<ViewPipeline> views;
  views.emplace_back(preset::Preset{}, "", Offer{}, Outputs{});
  Meeting meeting;
  RunOptions options;
  options.written = options.on_disk = {1, 2, 3, 4};
  EXPECT_EQ(run(views, meeting, meeting, options), 4U);
  EXPECT_TRUE(meeting.met());
  set_thread_count(0);
}

}  // namespace
}  // namespace aftershade::pipeline
