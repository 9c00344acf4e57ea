#include "app/commands.h"
#include "app/shared_options.h"

namespace aftershade::app {

namespace {

/// How a run goes about its frames.
void add_running(std::vector<Option<RenderArgs>>& t) {
  using Args = RenderArgs;
  t.push_back({"--missing",
               "POLICY",
               &Args::missing,
               "what to do about holes in the sequence, before frame 1",
               {"error", "skip"}});
  t.push_back({"--existing",
               "POLICY",
               &Args::existing,
               "what to do about output files that exist; skip leaves complete ones",
               {"overwrite", "skip", "error"}});
  t.push_back({"--keep-going", "", &Args::keep_going,
               "goes on after a frame that fails; the exit status is that of the first failure"});
  t.push_back({"--preroll", "FRAMES", &Args::preroll,
               "frames filtered before the first written one to build up history; all is exact"});
  t.push_back(
      {"--recode", "", &Args::recode, "decodes and encodes every channel again and changes nothing: no preset, no AO"});
  t.push_back(
      {"--memory", "SIZE", &Args::memory,
       "how much memory to use, such as 700M or 2G: how many frames are read and written while one is computed; "
       "half of what the machine or its cgroup has by default"});
  t.push_back({"--fsync",
               "SWITCH",
               &Args::fsync,
               "whether a file must have reached the disk before it gets its name",
               {"on", "off"}});
  t.push_back({"--progress", "KIND", &Args::progress, "progress on stderr", {"auto", "bar", "plain", "none"}});
  t.push_back({"-n,--dry-run", "", &Args::dry_run, "checks everything, prints what would be written, writes nothing"});
  t.push_back({"--print-config", "", &Args::print_config,
               "prints every value of the preset and where it came from, writes nothing"});
}

}  // namespace

const std::vector<Option<RenderArgs>>& render_options() {
  static const std::vector<Option<RenderArgs>> table = [] {
    using Args = RenderArgs;
    std::vector<Option<Args>> t;
    t.push_back({"input",
                 "INPUT",
                 &Args::input,
                 "a pattern (shot.####.exr, shot.%04d.exr, shot.@@@@.exr, shot.$F4.exr, shot.1001-1100#.exr), a frame, "
                 "or a folder",
                 {},
                 true});
    t.push_back({"-o,--output",
                 "OUTPUT",
                 &Args::output,
                 "a pattern with a frame token, an existing folder (input names are kept), or a file for one frame",
                 {},
                 true});
    add_preset(t);
    t.push_back({"--ao", "", &Args::ao,
                 "also writes the AO as channel AO (aftershade.AO if the file has an AO), half, 1 = open"});
    t.push_back({"--ao-only", "", &Args::ao_only, "writes files with the AO channel alone"});
    t.push_back({"--aov", "NAMES", &Args::aovs,
                 "also writes intermediate results, as channels aftershade.NAME: a name, a list with commas, or all "
                 "that the preset has; may be repeated"});
    t.push_back({"--data-window",
                 "POLICY",
                 &Args::data_window,
                 "what blur does that leaves the data window: cut it off, or let the window grow",
                 {"keep", "grow"}});
    t.push_back({"--compression", "NAME", &Args::compression,
                 "compression of changed parts: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab, or keep; by "
                 "default kept unless lossy"});
    add_running(t);
    add_input(t);
    add_common(t);
    return t;
  }();
  return table;
}

const std::vector<Option<InspectArgs>>& inspect_options() {
  static const std::vector<Option<InspectArgs>> table = [] {
    using Args = InspectArgs;
    std::vector<Option<Args>> t;
    t.push_back({"input", "INPUT", &Args::input, "a pattern, a frame, or a folder, as for render", {}, true});
    t.push_back({"--json", "", &Args::json, "prints JSON"});
    add_preset(t);
    add_input(t);
    add_common(t);
    return t;
  }();
  return table;
}

const std::vector<Option<PresetsArgs>>& presets_options() {
  static const std::vector<Option<PresetsArgs>> table = {
      {"action",
       "ACTION",
       &PresetsArgs::action,
       "list; show NAME; validate FILE...; diff A B; schema",
       {"list", "show", "validate", "diff", "schema"},
       true},
      {"names", "NAME|FILE", &PresetsArgs::names, "preset names or files"},
      {"--set", "ID.KEY=VALUE", &PresetsArgs::sets, "show: changes one value before showing; may be repeated"},
  };
  return table;
}

const std::vector<CommandText>& command_texts() {
  static const std::vector<CommandText> texts = {
      {"render",
       "INPUT -o OUTPUT [OPTION]...",
       "applies a preset to a sequence",
       texts_of(render_options()),
       {"aftershade render shot.####.exr -o out/ --preset high-dx11",
        "aftershade render shot.1001.exr -o out/shot.####.exr --frames 1001-1100 --set ao.radius_m=0.5 --ao"}},
      {"compare",
       "INPUT -p PRESET,... -o DIR [OPTION]...",
       "runs several presets and reports quality, flicker and cost",
       texts_of(compare_options()),
       {"aftershade compare shot.####.exr -p high-current-gen,high-dx11,my.json -o report",
        "aftershade compare shot.####.exr -p all --reference truth.####.exr -o report --frames 1001-1024"}},
      {"score",
       "RESULT REFERENCE [OPTION]...",
       "scores a sequence against a reference",
       texts_of(score_options()),
       {"aftershade score out/ truth.####.exr --geometry shot.####.exr",
        "aftershade score out/ truth.####.exr --require 'psnr>=35' --require 'ao_rmse<=0.06'"}},
      {"tune",
       "INPUT --reference REFERENCE --stage ID -o FILE.json [OPTION]...",
       "searches the numbers of a preset's stage for the best score within a budget",
       texts_of(tune_options()),
       {"aftershade tune shot.####.exr --reference truth.####.exr --stage ao --budget-ms 8 -o tuned.json",
        "aftershade tune shot.####.exr --reference offline --stage ao --parameters radius_m,scale -o tuned.json"}},
      {"inspect",
       "INPUT [OPTION]...",
       "prints what was recognised in a sequence, and why",
       texts_of(inspect_options()),
       {"aftershade inspect shot.####.exr"}},
      {"presets",
       "ACTION [NAME|FILE]...",
       "lists, shows, checks and compares presets",
       texts_of(presets_options()),
       {"aftershade presets diff high-current-gen high-dx11"}},
      {"sheet",
       "INPUT [AFTER] -o FILE.png [OPTION]...",
       "makes a contact sheet: the intermediate results of a preset or of rendered frames, or before, AO and after",
       texts_of(sheet_options()),
       {"aftershade sheet shot.####.exr --preset high-dx11 --frames 1010 -o sheet.png",
        "aftershade sheet rendered.####.exr -o sheet.png",
        "aftershade sheet shot.####.exr out/ -o sheet.png --frames 1001,1010,1020"}},
  };
  return texts;
}

}  // namespace aftershade::app
