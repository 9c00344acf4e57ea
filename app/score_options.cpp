#include "app/commands.h"
#include "app/shared_options.h"
#include "core/metrics/sequence_scores.h"

namespace aftershade::app {

namespace {
using Args = ScoreArgs;

void add_sides(std::vector<Option<Args>>& t) {
  t.push_back({"result",
               "RESULT",
               &Args::input,
               "the sequence to score: a pattern, a frame, or a folder, as for render",
               {},
               true});
  t.push_back({"reference",
               "REFERENCE",
               &Args::reference,
               "what it should be; frames are matched by number, pictures by display window",
               {},
               true});
  t.push_back(
      {"--metric", "NAME", &Args::metrics,
       "a score, see METRICS; may be repeated; by default those that are required, else all that the files allow"});
  t.push_back({"--require", "METRIC>=NUMBER", &Args::requirements,
               "a bound (>=, >, <=, <) on the score of the whole sequence; when it is not met the exit status is 1; a "
               "score that is no number never meets it; may be repeated"});
  t.push_back({"--require-frames", "METRIC>=NUMBER", &Args::frame_requirements,
               "the same for the score of every frame that has one; may be repeated"});
  t.push_back({"--mask", "MASK", &Args::mask,
               "scores count where it is above 0.5: alpha, a channel, cryptomatte:OBJECT or cryptomatte:LAYER/OBJECT"});
  t.push_back({"--mask-from", "INPUT", &Args::mask_from,
               "the sequence with the mask; by default that of --geometry, else RESULT"});
  t.push_back({"--geometry", "INPUT", &Args::geometry,
               "the sequence with depth, vectors and cameras, when RESULT has none: usually what was rendered from"});
  t.push_back({"--json", "", &Args::json, "prints JSON"});
  t.push_back({"--csv", "", &Args::csv, "prints comma-separated values"});
  t.push_back({"--reference-profile", "NAME|FILE", &Args::reference_profile, "as --profile, for REFERENCE"});
  t.push_back({"--reference-channel", "ROLE=NAMES", &Args::reference_channels, "as --channel, for REFERENCE"});
  t.push_back(
      {"--missing", "POLICY", &Args::missing, "what to do about frames that one side lacks", {"error", "skip"}});
}
}  // namespace

const std::vector<Option<ScoreArgs>>& score_options() {
  static const std::vector<Option<Args>> table = [] {
    std::vector<Option<Args>> t;
    add_sides(t);
    add_input(t);
    std::erase_if(t, [](const auto& option) { return option.names.ends_with("-layers"); });
    for (Option<Args>& option : t)
      if (option.names == "--view") option.doc = "the view of multi-view files to score; the first by default";
    add_common(t);
    return t;
  }();
  return table;
}

}  // namespace aftershade::app
