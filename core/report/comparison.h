#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/image/window.h"
#include "core/metrics/sequence_scores.h"
#include "core/preset/preset.h"
#include "core/preview/picture.h"

/// What a comparison of presets found, and how it is written: report.json, report.csv, report.html.
namespace aftershade::report {

/// A picture as a display shows it, made by preview::display_picture().
using Picture = preview::Picture;

struct StageCost {
  std::string id;  ///< the stage's, or "read" for the frame's decoding
  double milliseconds = 0;
};

struct FrameResult {
  int number = 0;
  metrics::Scores scores;
  std::vector<StageCost> cost;  ///< work shared by several presets in full; empty: not measured
};

struct Candidate {
  preset::Preset preset;
  std::vector<FrameResult> frames;
  metrics::Scores sequence;
  std::vector<StageCost> cost;  ///< of a frame: the median over the frames; empty: not measured
  int64_t memory_bytes = 0;     ///< most that was held for it at once; 0: not measured
};

/// A frame that the page shows: whole, and its worst region pixel by pixel. Element i is of candidate i, then come the
/// reference's (if the comparison has one) and the input's. A picture that is not there is empty.
struct ShownFrame {
  int number = 0;
  double error = 0;  ///< how bad it is beside the others
  Window region;     ///< of the display window's pixels, absolute coordinates
  std::vector<Picture> whole;
  std::vector<Picture> detail;  ///< empty: `whole` shows every pixel, and the region is all of it
};

struct Comparison {
  std::string program;    ///< "aftershade 1.2.3"
  std::string input;      ///< pattern of the sequence, as given
  std::string reference;  ///< preset or pattern; "": none
  std::string view_transform;
  int threads = 1;
  Window display;
  std::vector<int> frames;
  std::vector<std::string> metrics;  ///< computed ones, in the order of metric_infos()
  std::vector<Candidate> candidates;
  std::vector<ShownFrame> shown;     ///< by number; empty: no pictures
  std::vector<std::string> notes{};  ///< what a reader must know, such as that frames are missing
};

/// The whole comparison but its pictures. A score with nothing to count (NaN) is null, infinite ones are "inf", "-inf".
std::string json_text(const Comparison& comparison);
/// A line per preset and frame, and one per preset with "all" in place of the frame: scores, then milliseconds.
std::string csv_text(const Comparison& comparison);
/// One file that needs no other: data, pictures, style and script. At most `budget_bytes`: frames with the smallest
/// errors lose their pictures first, then pictures get smaller. `notes` gets what had to be left out.
/// Throws Error(usage) when not even the page without pictures fits.
std::string page_text(const Comparison& comparison, size_t budget_bytes, std::vector<std::string>& notes);

}  // namespace aftershade::report
