#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/compare_sheet.h"
#include "app/job.h"
#include "app/mask.h"
#include "app/scored_input.h"

namespace aftershade::app {

/// A preset that takes part in a comparison.
struct Contender {
  preset::Preset preset;
  std::vector<pipeline::ViewPipeline> views;      ///< the first one is scored
  std::function<std::string(int)> output_path{};  ///< of its frames; empty: they are not written
};

/// A comparison, resolved from what was typed and validated before frame 1.
struct CompareJob {
  Input input;
  std::string view;                    ///< that is scored and shown
  std::vector<Contender> contenders;   ///< those compared, then the reference preset if it is none of them
  size_t compared = 0;                 ///< how many of the contenders are compared
  std::optional<size_t> reference;     ///< the contender whose result is the reference
  std::vector<ScoredSide> references;  ///< or sequences: the first with colour, the first with AO
  std::string reference_text;          ///< for people; "": none
  std::optional<MaskReader> mask;
  std::optional<std::string> ao_channel;  ///< where contenders leave their AO, if anybody looks at it
  bool write_ao = false;                  ///< files have that channel too
  std::vector<std::string> metrics;       ///< none: nothing is scored
  std::vector<int> frames;
  int preroll = 40;
  bool geometry = false;  ///< depth and motion are there for scores
  bool pictures = false;
  bool measure = false;
  std::optional<SheetPlan> sheet;
};
CompareJob resolve_comparison(const CompareArgs& args);

}  // namespace aftershade::app
