#include "app/commands.h"
#include "app/shared_options.h"

namespace aftershade::app {

namespace {
using Args = CompareArgs;

void add_comparison(std::vector<Option<Args>>& t) {
  t.push_back({"input", "INPUT", &Args::input, "a pattern, a frame, or a folder, as for render", {}, true});
  t.push_back({"-p,--presets",
               "NAME|FILE,...",
               &Args::presets,
               "shipped presets and preset files, separated by commas; may be repeated; all: every shipped one",
               {},
               true});
  t.push_back({"-o,--output",
               "DIR",
               &Args::output,
               "the folder for report.json, report.csv and report.html; made if its parent exists",
               {},
               true});
  t.push_back({"--reference", "PRESET|INPUT", &Args::references,
               "what results should be: a preset, whose result on the same frames counts, or a sequence with colour, "
               "AO or both; may be repeated, for colour and AO in sequences of their own"});
  t.push_back({"--metric", "NAME", &Args::metrics,
               "a score, see METRICS; may be repeated; none: no scores; by default all that there can be"});
  t.push_back({"--mask", "MASK", &Args::mask,
               "scores count where it is above 0.5: alpha, a channel, cryptomatte:OBJECT or cryptomatte:LAYER/OBJECT"});
  t.push_back({"--mask-from", "INPUT", &Args::mask_from, "the sequence with the mask, INPUT by default"});
  t.push_back(
      {"--set", "ID.KEY=VALUE", &Args::sets, "changes one value of every preset that has this stage; may be repeated"});
  t.push_back({"--only", "ID", &Args::only, "runs only this stage of the presets; may be repeated"});
  t.push_back({"--skip", "ID", &Args::skip, "leaves this stage out of every preset that has it; may be repeated"});
}

void add_outcome(std::vector<Option<Args>>& t) {
  t.push_back({"--write-frames", "", &Args::write_frames, "also writes every preset's frames, to DIR/PRESET/"});
  t.push_back({"--ao", "", &Args::ao,
               "with --write-frames: they have the AO as channel AO, as those of render --ao (half, 1 = open)"});
  t.push_back({"--no-cost", "", &Args::no_cost,
               "measures no times and no memory: frames are read and written while others are computed"});
  t.push_back({"--no-report", "", &Args::no_report, "writes no report.html, and needs no pictures"});
  t.push_back({"--sheet",
               "SHOWN",
               &Args::sheet,
               "also writes sheet.png: every preset's result and the reference, frame beside frame",
               {"ao", "color"}});
  t.push_back({"--sheet-frames", "RANGE", &Args::sheet_frames,
               "the frames of the sheet, at most 16; by default first, middle and last"});
  t.push_back({"--sheet-region", "X,Y,WIDTHxHEIGHT", &Args::sheet_region,
               "the pixels of the sheet, enlarged if there are few; by default the whole picture"});
  t.push_back({"--page-budget", "SIZE", &Args::page_budget, "the most that report.html may take, 24M by default"});
  t.push_back({"--ocio", "FILE", &Args::ocio,
               "an OpenColorIO configuration for the pictures; by default a built-in one for linear Rec.709"});
  t.push_back({"--view-transform", "NAME", &Args::view_transform,
               "the configuration's view for the pictures; built in: sRGB (default), ACES 1.0 SDR, Raw"});
  t.push_back({"--missing",
               "POLICY",
               &Args::missing,
               "what to do about holes in the sequence and in the reference",
               {"error", "skip"}});
  t.push_back({"--preroll", "FRAMES", &Args::preroll,
               "frames filtered before the first compared one to build up history; all is exact"});
  t.push_back({"--progress", "KIND", &Args::progress, "progress on stderr", {"auto", "bar", "plain", "none"}});
}
}  // namespace

const std::vector<Option<CompareArgs>>& compare_options() {
  static const std::vector<Option<Args>> table = [] {
    std::vector<Option<Args>> t;
    add_comparison(t);
    add_outcome(t);
    add_input(t);
    for (Option<Args>& option : t)
      if (option.names == "--view")
        option.doc =
            "a view of a multi-view file; may be repeated: the first is compared, all are written; all by default";
    add_common(t);
    return t;
  }();
  return table;
}

}  // namespace aftershade::app
