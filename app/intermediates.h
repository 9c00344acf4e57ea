#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/image/frame.h"
#include "core/pipeline/aov.h"
#include "core/preview/sheet.h"

/// Intermediate results as pictures.
namespace aftershade::app {

/// What every channel of an intermediate result is called before its name.
inline constexpr std::string_view kAovPrefix = "aftershade.";

/// The AOVs whose channels are all there.
pipeline::AovSet aovs_in(const std::map<std::string, Plane>& channels);

/// A picture, and behind it what explains its colours.
using CellGroup = std::vector<preview::Cell>;

/// The pictures of one frame's channels, in the order of the pipeline: those of `aovs`, and, if `others`, every other
/// channel whose name begins with kAovPrefix, as grey from its least to its largest value. Labels tell the scale.
std::vector<CellGroup> intermediate_cells(const std::map<std::string, Plane>& channels, pipeline::AovSet aovs,
                                          bool others, const Frame& frame);

/// A plane of `frame` inside its display window, so that frames with moving data windows line up.
Plane in_display(ConstPlaneView plane, const Frame& frame, float background);

/// The beauty of a frame with layers; Error(no_input) naming `sequence` when it has none.
preview::Cell beauty_cell(const Frame& frame, const std::string& label, const std::string& sequence);

/// Shrinks the pictures and puts them into rows of up to four, not counting what explains their colours. What goes to
/// the sheet holds no more than what is shown.
void add_rows(std::vector<CellGroup> groups, preview::Sheet& sheet);

}  // namespace aftershade::app
