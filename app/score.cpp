#include <algorithm>
#include <cstdio>

#include "app/log.h"
#include "app/mask.h"
#include "app/score_report.h"
#include "app/scored_input.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::app {

namespace {

/// What both sides and the sequences beside them have in common.
InputArgs common_args(const ScoreArgs& args, const std::string& input) {
  InputArgs out;
  out.input = input;
  out.frames = args.frames;
  out.hash_digits = args.hash_digits;
  out.missing = args.missing;
  out.views = args.views;
  return out;
}

bool is_of_picture(const std::string& channel) { return channel.starts_with("color=") || channel.starts_with("ao="); }

/// RESULT: what options say of depth and motion is meant for --geometry when there is one.
InputArgs result_args(const ScoreArgs& args) {
  if (args.geometry.empty()) return args;
  InputArgs out = common_args(args, args.input);
  out.profile = args.profile;
  std::copy_if(args.channels.begin(), args.channels.end(), std::back_inserter(out.channels), is_of_picture);
  return out;
}
InputArgs geometry_args(const ScoreArgs& args) {
  InputArgs out = args;
  out.input = args.geometry;
  out.profile.clear();
  std::erase_if(out.channels, is_of_picture);
  return out;
}
InputArgs reference_args(const ScoreArgs& args) {
  InputArgs out = common_args(args, args.reference);
  out.profile = args.reference_profile;
  out.channels = args.reference_channels;
  return out;
}

/// The numbers of `frames` that a sequence does not have.
std::vector<int> lacking(const Input& input, const std::vector<int>& frames) {
  std::vector<int> out;
  for (const int frame : frames)
    if (!input.found.sequence.path(frame)) out.push_back(frame);
  return out;
}

/// The frames of both; one that a side lacks is an error unless it is to be skipped.
std::vector<int> frames_of_both(const ScoreArgs& args, const Input& result, const Input& reference) {
  for (const auto& [side, other] : {std::pair(&result, &reference), std::pair(&reference, &result)}) {
    const std::vector<int> missing = lacking(*side, other->frames);
    if (missing.empty()) continue;
    const std::string text = cat(side->found.pattern.text(), " lacks frames ", io::format_frames(missing), " of ",
                                 other->found.pattern.text());
    if (args.missing == "error")
      throw Error(ErrorCode::no_input, text, "--frames chooses frames, --missing skip scores those that both have");
    log().warning(text);
  }
  std::vector<int> frames;
  for (const int frame : result.frames)
    if (std::find(reference.frames.begin(), reference.frames.end(), frame) != reference.frames.end())
      frames.push_back(frame);
  if (frames.empty())
    throw Error(ErrorCode::no_input, "the two sequences have no frame in common", "their frame numbers must agree");
  return frames;
}

std::vector<Requirement> requirements_of(const ScoreArgs& args) {
  std::vector<Requirement> out;
  for (const std::string& text : args.requirements) out.push_back(parse_requirement(text, false));
  for (const std::string& text : args.frame_requirements) out.push_back(parse_requirement(text, true));
  return out;
}

/// The sequences of a run, opened.
struct ScoreJob {
  ScoredSide result, reference;
  std::optional<Input> geometry_input;  ///< of --geometry
  std::optional<MaskReader> mask;
  Scorable scorable;
  std::vector<int> frames;
  bool follows = false;  ///< some metric looks at depth or motion

  const Input& geometry() const { return geometry_input ? *geometry_input : result.input; }
  const std::string& geometry_view() const { return geometry_input ? geometry_input->views.front() : result.view; }
};

ScoreJob open_job(const ScoreArgs& args) {
  ScoreJob job{open_scored_side(result_args(args)), open_scored_side(reference_args(args)), {}, {}, {}, {}, false};
  job.frames = frames_of_both(args, job.result.input, job.reference.input);
  if (!args.geometry.empty()) job.geometry_input = open_input(geometry_args(args));
  if (!args.mask_from.empty() && args.mask.empty())
    throw Error(ErrorCode::usage, "--mask-from without --mask", "--mask alpha, or a channel, or cryptomatte:NAME");
  if (!args.mask.empty()) {
    if (args.mask_from.empty()) {
      job.mask.emplace(args.mask, job.geometry(), job.geometry_view());
    } else {
      const Input from = open_input(common_args(args, args.mask_from));
      job.mask.emplace(args.mask, from, from.views.front());
    }
  }
  job.scorable = {job.result.color && job.reference.color, job.result.ao && job.reference.ao, true, false, false};
  add_geometry(job.geometry(), job.geometry_view(), job.scorable);
  return job;
}

/// Has the geometry a surface mask or motion to give?
bool has_depth(const ScoreJob& job) {
  return job.geometry().source->available(job.geometry_view()).contains(Role::depth);
}

void score_frames(const ScoreJob& job, ScoreReport& report) {
  const auto any = [&](auto member) {
    return std::any_of(report.metrics.begin(), report.metrics.end(), [&](const std::string& name) {
      const auto infos = metrics::metric_infos();
      return std::any_of(infos.begin(), infos.end(), [&](const auto& m) { return m.name == name && member(m); });
    });
  };
  const bool color = any([](const auto&m) { return !m.of_ao; }), ao = any([](const auto&m) { return m.of_ao; });
  const bool geometry = has_depth(job) && (ao || any([](const auto& m) { return m.temporal; }));
  metrics::SequenceScorer scorer(report.metrics);
  for (const int frame : job.frames) {
    with_context(cat("frame ", frame), [&] {
      const SidePlanes result = load_side(job.result, frame, color, ao);
      const SidePlanes reference = load_side(job.reference, frame, color, ao);
      std::optional<GeometryPlanes> planes;
      if (geometry) planes = load_geometry(job.geometry(), job.geometry_view(), frame);
      const Plane mask = job.mask ? job.mask->load(frame) : Plane();
      report.frames.emplace_back(
          frame, scorer.add(scored_frame(frame, result, &reference, planes ? &*planes : nullptr, mask)));
    });
  }
  report.sequence = scorer.sequence();
}

}  // namespace

int score(const ScoreArgs& args) {
  if (args.json && args.csv) throw Error(ErrorCode::usage, "--json and --csv exclude each other");
  ScoreReport report;
  report.requirements = requirements_of(args);
  std::vector<std::string> asked = args.metrics;
  for (const Requirement& requirement : report.requirements) asked.push_back(requirement.metric);
  const ScoreJob job = open_job(args);
  report.metrics = metrics_to_score(asked, job.scorable);
  report.result = job.result.input.found.pattern.text();
  report.reference = job.reference.input.found.pattern.text();
  score_frames(job, report);
  const std::string text = args.json ? json_text(report) : args.csv ? csv_text(report) : table_text(report);
  std::fwrite(text.data(), 1, text.size(), stdout);
  const std::vector<std::string> failed = failures(report);
  for (const std::string& line : failed) log().error(line);
  return failed.empty() ? 0 : kRequirementFailed;
}

}  // namespace aftershade::app
