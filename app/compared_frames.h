#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "app/compare_job.h"
#include "core/report/comparison.h"
#include "core/report/worst_frames.h"

namespace aftershade::app {

/// Listens to a run of several presets: takes what it reads and what every preset makes of it, scores a frame once all
/// have finished it, and keeps pictures of the worst. Planes are shared, and let go when their frame is scored.
class ComparedFrames {
 public:
  ComparedFrames(const CompareJob& job, const report::ShowOptions& show);
  ~ComparedFrames();

  /// The job's frames as its source loads them, seen on their way.
  FrameSource& source();
  /// Where the frames of a contender go; they are passed on to `files` if there is one.
  std::unique_ptr<FrameSink> sink(size_t contender, FrameSink* files);

  /// A frame that is finished costs this much.
  void add_cost(const pipeline::Progress& progress);

  /// The sheet that the job asks for, else null.
  ComparisonSheet* sheet() { return sheet_ ? &*sheet_ : nullptr; }

  /// The frames that all have finished. Leaves nothing.
  report::Comparison take();

 private:
  class Tap;
  class Sink;
  struct Waiting {
    std::optional<Frame> input;
    GeometryPlanes geometry;
    std::vector<std::optional<SidePlanes>> results;
  };
  std::string ao_channel() const { return job_.ao_channel.value_or(""); }
  void add_input(const Frame& frame);
  void add_result(size_t contender, int number, const Frame& frame);
  std::unique_ptr<Waiting> with_result(size_t contender, int number, const Frame& frame);
  bool is_compared(int number) const;
  void finish(int number, Waiting& waiting);
  SidePlanes reference_of(int number, const Waiting& waiting) const;
  void show(int number, const Waiting& waiting, const SidePlanes& reference);
  void add_to_sheet(int number, const Waiting& waiting, const SidePlanes& reference);

  const CompareJob& job_;
  std::mutex mutex_;
  std::unique_ptr<Tap> tap_;
  std::optional<Frame> before_;  ///< the frame read last: vectors to the next frame are carried forward
  std::map<int, Waiting> waiting_;
  std::vector<metrics::SequenceScorer> scorers_;
  std::optional<report::WorstFrames> worst_;
  std::optional<ComparisonSheet> sheet_;
  std::map<int, size_t> finished_;                          ///< by how many contenders
  std::vector<std::map<int, report::FrameResult>> frames_;  ///< those that all have finished; one map a compared preset
  std::vector<std::map<int, std::vector<report::StageCost>>> cost_;
  std::vector<int64_t> memory_;
};

}  // namespace aftershade::app
