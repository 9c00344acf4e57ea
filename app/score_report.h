#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/metrics/sequence_scores.h"

/// What `score` found, and how it is printed.
namespace aftershade::app {

/// --require 'METRIC>=NUMBER': of the whole sequence, or of every frame that has the score.
struct Requirement {
  std::string text, metric;
  bool least = true;    ///< >= or >; else <= or <
  bool strict = false;  ///< > or <
  double bound = 0;
  bool of_frames = false;        ///< --require-frames
  bool met(double value) const;  ///< NaN never is
};
/// Throws Error(usage) for anything else.
Requirement parse_requirement(const std::string& text, bool of_frames);

struct ScoreReport {
  std::string result, reference;  ///< patterns
  std::vector<std::string> metrics;
  std::vector<std::pair<int, metrics::Scores>> frames;
  metrics::Scores sequence;
  std::vector<Requirement> requirements;

  double of_sequence(const std::string& metric) const;  ///< NaN where there is none
};

/// A row per frame and one for the sequence ("all"), a few metrics at a time.
std::string table_text(const ScoreReport& report);
/// A line per frame and one with "all" in place of the frame, all metrics; "nan" where there is no number.
std::string csv_text(const ScoreReport& report);
/// Everything, with units and what each metric is; numbers that are not finite are null.
std::string json_text(const ScoreReport& report);

/// One line per requirement that is not met: the value, or how many frames do not meet it, and the worst frames.
std::vector<std::string> failures(const ScoreReport& report);

}  // namespace aftershade::app
