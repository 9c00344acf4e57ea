#include "app/compared_frames.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::app {

namespace {

report::Pixels pixels_of(const SidePlanes& side, bool color) {
  if (!color) return side.ao.empty() ? report::Pixels{} : report::Pixels{side.ao};
  if (side.color[0].empty()) return {};
  return {side.color[0], side.color[1], side.color[2]};
}

/// Is anything done with pixels but writing them?
bool looks(const CompareJob& job) { return job.pictures || job.sheet || !job.metrics.empty(); }

/// The compared presets, and the reference unless it is one of them.
std::vector<std::string> names_on_sheet(const CompareJob& job) {
  std::vector<std::string> names;
  for (size_t i = 0; i < job.compared; ++i) names.push_back(job.contenders[i].preset.name);
  if (!job.references.empty() || (job.reference && *job.reference >= job.compared)) names.emplace_back("reference");
  return names;
}

/// What waits for other presets does not belong to this one's memory.
void make_own(SidePlanes& planes) {
  for (Plane& plane : planes.color) plane.make_own();
  planes.ao.make_own();
}

/// The stages' medians over the frames, in the order of the first frame.
std::vector<report::StageCost> median_cost(const std::vector<report::FrameResult>& frames) {
  std::vector<report::StageCost> out;
  if (frames.empty()) return out;
  for (const report::StageCost& stage : frames.front().cost) {
    std::vector<double> times;
    for (const report::FrameResult& frame : frames)
      for (const report::StageCost& cost : frame.cost)
        if (cost.id == stage.id) times.push_back(cost.milliseconds);
    std::sort(times.begin(), times.end());
    out.push_back({stage.id, 0.5 * (times[(times.size() - 1) / 2] + times[times.size() / 2])});
  }
  return out;
}

}  // namespace

/// The source, with depth, vectors and the beauty of every compared frame kept for scores.
class ComparedFrames::Tap final : public FrameSource {
 public:
  Tap(ComparedFrames& frames, FrameSource& source) : frames_(frames), source_(source) {}
  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool with_layers) override {
    if (view != frames_.job_.view) return source_.load(number, view, roles, with_layers);
    if (frames_.job_.geometry) roles.insert({Role::depth, Role::velocity_prev, Role::velocity_next});
    auto frame = source_.load(number, view, roles, with_layers || (looks(frames_.job_) && frames_.is_compared(number)));
    if (frame) frames_.add_input(*frame);
    return frame;
  }

 private:
  ComparedFrames& frames_;
  FrameSource& source_;
};

class ComparedFrames::Sink final : public FrameSink {
 public:
  Sink(ComparedFrames& frames, size_t contender, FrameSink* files)
      : frames_(frames), contender_(contender), files_(files) {}
  void write(int number, const std::vector<Frame>& views) override {
    frames_.add_result(contender_, number, views.front());
    if (!files_) return;
    std::vector<Frame> written;
    for (const Frame& view : views) {
      written.push_back(shared(view));
      if (!frames_.job_.write_ao) written.back().added.erase(frames_.ao_channel());
    }
    files_->write(number, written);
  }

 private:
  ComparedFrames& frames_;
  size_t contender_;
  FrameSink* files_;
};

ComparedFrames::ComparedFrames(const CompareJob& job, const report::ShowOptions& show)
    : job_(job),
      tap_(std::make_unique<Tap>(*this, *job.input.source)),
      frames_(job.compared),
      cost_(job.compared),
      memory_(job.compared) {
  if (!job.metrics.empty())
    for (size_t i = 0; i < job.compared; ++i) scorers_.emplace_back(job.metrics);
  const Window display = job.input.source->info().display_window;
  if (job.pictures) worst_.emplace(display, show);
  if (job.sheet) sheet_.emplace(*job.sheet, display, names_on_sheet(job));
}
ComparedFrames::~ComparedFrames() = default;

FrameSource& ComparedFrames::source() { return *tap_; }

std::unique_ptr<FrameSink> ComparedFrames::sink(size_t contender, FrameSink* files) {
  return std::make_unique<Sink>(*this, contender, files);
}

void ComparedFrames::add_input(const Frame& frame) {
  if (!looks(job_)) return;
  const bool follows = before_ && before_->number == frame.number - 1;
  if (is_compared(frame.number)) {
    Waiting waiting;
    waiting.results.resize(job_.contenders.size());
    waiting.input = shared(frame);
    if (job_.geometry) waiting.geometry = geometry_of(frame, follows ? &*before_ : nullptr);
    for (auto& planes : waiting.input->roles) planes.clear();
    waiting.input->file.reset();
    const std::lock_guard lock(mutex_);
    waiting_.emplace(frame.number, std::move(waiting));
  }
  before_ = shared(frame);
  before_->layers.clear();
  before_->file.reset();
}

void ComparedFrames::add_result(size_t contender, int number, const Frame& frame) {
  if (const auto waiting = with_result(contender, number, frame))
    with_context(cat("frame ", number), [&] { finish(number, *waiting); });
  if (finished_[number] == job_.contenders.size())
    for (auto& frames : frames_) frames[number].number = number;
}

/// The frame, once every contender has finished it. No lock is held where rows are waited for.
std::unique_ptr<ComparedFrames::Waiting> ComparedFrames::with_result(size_t contender, int number, const Frame& frame) {
  const std::lock_guard lock(mutex_);
  ++finished_[number];
  const auto found = waiting_.find(number);
  if (found == waiting_.end()) return nullptr;
  Waiting& waiting = found->second;
  const auto ao = frame.added.find(ao_channel());
  SidePlanes result = side_planes(frame, ao == frame.added.end() ? Plane() : ao->second.shared(),
                                  *job_.input.found.sequence.path(number));
  // A preset without motion blur and AO apart leaves the layers alone, and they were not loaded for it.
  if (result.color[0].empty()) result.color = side_planes(*waiting.input, Plane(), "").color;
  if (job_.measure) make_own(result);
  waiting.results[contender] = std::move(result);
  if (finished_[number] < job_.contenders.size()) return nullptr;
  auto done = std::make_unique<Waiting>(std::move(waiting));
  waiting_.erase(found);
  return done;
}

SidePlanes ComparedFrames::reference_of(int number, const Waiting& waiting) const {
  SidePlanes out;
  if (job_.reference) {
    const SidePlanes& result = *waiting.results[*job_.reference];
    out = {"the result of " + job_.reference_text, result.display, {}, result.ao.shared()};
    for (size_t c = 0; c < 3; ++c) out.color[c] = result.color[c].shared();
  }
  for (const ScoredSide& side : job_.references) {
    SidePlanes planes = load_side(side, number, side.color && out.color[0].empty(), side.ao && out.ao.empty());
    out.path = planes.path;
    out.display = planes.display;
    if (out.color[0].empty()) out.color = std::move(planes.color);
    if (out.ao.empty()) out.ao = std::move(planes.ao);
  }
  return out;
}

void ComparedFrames::finish(int number, Waiting& waiting) {
  const SidePlanes reference = reference_of(number, waiting);
  const bool has_reference = !job_.reference_text.empty();
  const Plane mask = job_.mask ? job_.mask->load(number) : Plane();
  std::vector<metrics::Scores> scores;  // all or none, so that a frame that fails is not told half
  for (size_t i = 0; i < scorers_.size(); ++i)
    scores.push_back(scorers_[i].add(scored_frame(number, *waiting.results[i], has_reference ? &reference : nullptr,
                                                  job_.geometry ? &waiting.geometry : nullptr, mask)));
  if (worst_) show(number, waiting, reference);
  if (sheet_ && sheet_->wants(number)) add_to_sheet(number, waiting, reference);
  for (size_t i = 0; i < scores.size(); ++i) frames_[i][number].scores = std::move(scores[i]);
}

void ComparedFrames::add_to_sheet(int number, const Waiting& waiting, const SidePlanes& reference) {
  std::vector<report::Pixels> pictures;
  for (size_t i = 0; i < job_.compared; ++i) pictures.push_back(pixels_of(*waiting.results[i], sheet_->shows_color()));
  pictures.push_back(pixels_of(reference, sheet_->shows_color()));
  sheet_->add(number, pictures);
}

void ComparedFrames::show(int number, const Waiting& waiting, const SidePlanes& reference) {
  // A reference of AO alone is compared with the AO.
  const SidePlanes input = side_planes(*waiting.input, Plane(), "");
  const bool color = !input.color[0].empty() && (job_.reference_text.empty() || !reference.color[0].empty());
  std::vector<report::Pixels> results;
  for (size_t i = 0; i < job_.compared; ++i) results.push_back(pixels_of(*waiting.results[i], color));
  worst_->offer(number, results, pixels_of(reference, color), pixels_of(input, color));
}

bool ComparedFrames::is_compared(int number) const {
  return std::binary_search(job_.frames.begin(), job_.frames.end(), number);
}

void ComparedFrames::add_cost(const pipeline::Progress& progress) {
  if (!progress.written || progress.program >= job_.compared || !job_.measure) return;
  const std::lock_guard lock(mutex_);
  std::vector<report::StageCost>& cost = cost_[progress.program][progress.number];
  cost.push_back({"read", progress.read_milliseconds});
  for (const auto& time : progress.reports.front().times) cost.push_back({time.id, time.milliseconds});
  memory_[progress.program] = static_cast<int64_t>(progress.memory_bytes);
}

report::Comparison ComparedFrames::take() {
  report::Comparison out;
  out.input = job_.input.found.pattern.text();
  out.reference = job_.reference_text;
  out.display = job_.input.source->info().display_window;
  out.metrics = job_.metrics;
  for (size_t i = 0; i < job_.compared; ++i) {
    report::Candidate& candidate = out.candidates.emplace_back();
    candidate.preset = job_.contenders[i].preset;
    for (auto& [number, result] : frames_[i]) {
      result.cost = std::move(cost_[i][number]);
      candidate.frames.push_back(std::move(result));
    }
    if (i < scorers_.size()) candidate.sequence = scorers_[i].sequence();
    candidate.cost = median_cost(candidate.frames);
    candidate.memory_bytes = memory_[i];
  }
  for (const report::FrameResult& frame : out.candidates.front().frames) out.frames.push_back(frame.number);
  if (worst_) out.shown = worst_->take();
  return out;
}

}  // namespace aftershade::app
