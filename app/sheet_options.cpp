#include "app/commands.h"
#include "app/shared_options.h"

namespace aftershade::app {

const std::vector<Option<SheetArgs>>& sheet_options() {
  static const std::vector<Option<SheetArgs>> table = [] {
    using Args = SheetArgs;
    std::vector<Option<Args>> t;
    t.push_back({"input",
                 "INPUT",
                 &Args::input,
                 "a pattern, a frame, or a folder: with --preset what is to be rendered, without what render --aov has "
                 "written, or, with AFTER, the sequence before",
                 {},
                 true});
    t.push_back(
        {"after", "AFTER", &Args::after,
         "the sequence after; the AO that render wrote into it is shown, else the producer's, if there is one"});
    t.push_back({"-o,--output", "FILE.png", &Args::output, "the picture to write", {}, true});
    t.push_back({"--aov", "NAMES", &Args::aovs,
                 "the intermediate results to show: a name, a list with commas, or all; may be repeated; all by "
                 "default"});
    t.push_back({"--preroll", "FRAMES", &Args::preroll,
                 "with --preset: frames filtered before the first shown one to build up history; all is exact"});
    t.push_back(
        {"--cell-width", "PIXELS", &Args::cell_width, "width of one picture in the sheet", {}, false, {{16, 8192}}});
    add_preset(t);
    add_input(t);
    for (Option<Args>& option : t) {
      if (option.names == "--frames")
        option.doc = "frames to show; by default the middle one, with AFTER first, middle and last";
      if (option.names == "-p,--preset") option.doc = "renders INPUT with this preset, in memory, and shows that";
      if (option.names == "--view") option.doc = "the view of a multi-view file to show; the first by default";
    }
    add_common(t);
    return t;
  }();
  return table;
}

}  // namespace aftershade::app
