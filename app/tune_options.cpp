#include "app/commands.h"
#include "app/shared_options.h"

namespace aftershade::app {

namespace {

using Args = TuneArgs;

void add_goal(std::vector<Option<Args>>& t) {
  t.push_back({"--reference",
               "REFERENCE",
               &Args::reference,
               "what the result should be: a sequence (of AO or of colour, as the metric wants), or a preset, whose "
               "result is taken",
               {},
               true});
  t.push_back({"--stage", "ID", &Args::stage, "the stage of the preset to tune", {}, true});
  t.push_back(
      {"-o,--output",
       "FILE.json",
       &Args::output,
       "the preset to write; FILE.front.json beside it gets all the best trade-offs between score and cost, and "
       "the measured costs",
       {},
       true});
  t.push_back(
      {"-p,--preset", "NAME|FILE", &Args::preset, "shipped preset or preset file to start from; high-dx11 by default"});
  t.push_back({"--set", "ID.KEY=VALUE", &Args::sets, "changes one value of the preset first; may be repeated"});
  t.push_back({"--parameters", "KEY,...", &Args::parameters,
               "the parameters to search; by default every number above 0, between a quarter of its value and four "
               "times it. KEY=MIN:MAX gives the range"});
  t.push_back({"--metric", "NAME", &Args::metric,
               "the score, as aftershade score names it; by default ao_rmse for a stage of the AO, else psnr"});
  t.push_back({"--mask", "MASK", &Args::mask, "where to count, as for aftershade score"});
  t.push_back({"--budget-ms", "MS", &Args::budget_ms, "most milliseconds that the stage may take for a frame"});
  t.push_back({"--budget-mb", "MB", &Args::budget_mb,
               "most megabytes that planes may hold until the stage is done with a frame"});
}

void add_search(std::vector<Option<Args>>& t) {
  t.push_back({"--evaluations",
               "N",
               &Args::evaluations,
               "presets to try, at most; ctrl-C ends earlier, with the best so far",
               {},
               false,
               {{1, 1000000}}});
  t.push_back({"--seed",
               "N",
               &Args::seed,
               "another seed begins elsewhere; with the same one and the same --cost-table the result is the same",
               {},
               false,
               {{0, 2147483647}}});
  t.push_back({"--cost-table", "FILE.front.json", &Args::cost_table,
               "takes the costs that an earlier run measured; by default they are measured first"});
  t.push_back({"--holdout", "RANGE", &Args::holdout,
               "frames that are not tuned on: their score is told for comparison, before and after"});
  t.push_back({"--preroll", "FRAMES", &Args::preroll,
               "frames filtered before each scored one to build up history; all is exact"});
}

}  // namespace

const std::vector<Option<TuneArgs>>& tune_options() {
  static const std::vector<Option<Args>> table = [] {
    std::vector<Option<Args>> t;
    t.push_back({"input", "INPUT", &Args::input, "a pattern, a frame, or a folder, as for render", {}, true});
    add_goal(t);
    add_search(t);
    add_input(t);
    for (Option<Args>& option : t) {
      if (option.names == "--frames")
        option.doc = "frames to tune on; by default four from the whole sequence. They are all kept in memory";
      if (option.names == "--view") option.doc = "the view to tune on; the first by default";
    }
    add_common(t);
    return t;
  }();
  return table;
}

}  // namespace aftershade::app
