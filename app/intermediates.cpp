#include "app/intermediates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/placed.h"
#include "core/preview/false_color.h"
#include "core/preview/loader.h"
#include "core/temporal/history_use.h"

namespace aftershade::app {

namespace {

using pipeline::Aov;
using preview::Cell;
using preview::Rgb;

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();  // black in every picture
constexpr size_t kPicturesInARow = 4;

/// By HistoryUse: Okabe and Ito's colours, which people who do not tell red from green tell apart.
constexpr std::array<Rgb, temporal::kHistoryUses> kUseColors{{{0.00F, 0.00F, 0.00F},    // background
                                                              {0.00F, 0.42F, 0.31F},    // used: bluish green, dark
                                                              {0.45F, 0.45F, 0.45F},    // stable
                                                              {0.95F, 0.95F, 0.95F},    // none
                                                              {0.80F, 0.47F, 0.65F},    // unknown motion: purple
                                                              {0.94F, 0.89F, 0.26F},    // outside: yellow
                                                              {0.84F, 0.37F, 0.00F},    // other surface: vermillion
                                                              {0.00F, 0.45F, 0.70F},    // surroundings: blue
                                                              {0.34F, 0.71F, 0.91F}}};  // value: sky blue

Cell cell_of(std::vector<Plane> planes, std::string label, const Frame& frame, bool is_display) {
  Cell cell;
  cell.planes = std::move(planes);
  cell.label = std::move(label);
  cell.pixel_aspect = frame.pixel_aspect;
  cell.is_display = is_display;
  return cell;
}

Cell grey_cell(ConstPlaneView plane, float black, float white, std::string label, const Frame& frame) {
  std::vector<Plane> planes;
  planes.push_back(preview::scaled(plane, black, white));
  return cell_of(std::move(planes), std::move(label), frame, false);
}

std::string number_text(float value) { return cat(std::round(value * 1000) / 1000); }

/// Grey from 0 to the largest value, which the label tells.
Cell measured_cell(ConstPlaneView plane, const std::string& name, const std::string& unit, const Frame& frame) {
  const float white = preview::range_of(plane).largest;
  return grey_cell(plane, 0, white, cat(name, ": white is ", number_text(white), unit), frame);
}

/// Which codes a picture has, and how much of it; the background aside.
Cell use_legend(ConstPlaneView codes) {
  std::array<size_t, temporal::kHistoryUses> count{};
  size_t all = 0;
  for (int y = 0; y < codes.height; ++y)
    for (int x = 0; x < codes.width; ++x) {
      const float code = std::round(codes(x, y));
      if (!(code >= 0 && code < temporal::kHistoryUses)) continue;
      ++count[static_cast<size_t>(code)];
      if (code != code_of(temporal::HistoryUse::background)) ++all;
    }
  Cell legend;
  for (size_t code = 1; code < count.size(); ++code) {
    if (count[code] == 0) continue;
    const double share = 100.0 * static_cast<double>(count[code]) / static_cast<double>(all);
    legend.legend.push_back({kUseColors[code], cat(temporal::kHistoryUseTexts[code], ": ", fixed(share, 1), " %")});
  }
  legend.label = "of all surface pixels";
  return legend;
}

CellGroup use_cells(ConstPlaneView codes, const Frame& frame) {
  CellGroup group;
  group.push_back(cell_of(preview::coded(codes, kUseColors), "history, why it was rejected", frame, true));
  group.push_back(use_legend(codes));
  return group;
}

CellGroup velocity_cells(ConstPlaneView x, ConstPlaneView y, const std::string& name, const Frame& frame) {
  const float longest = preview::longest_of(x, y);
  CellGroup group;
  group.push_back(
      cell_of(preview::wheel(x, y, longest), cat(name, ": longest ", fixed(longest, 1), " px"), frame, true));
  return group;
}

/// What the hues of velocity_cells() mean.
Cell wheel_cell() {
  constexpr int kSize_px = 120;
  Cell cell;
  cell.planes = preview::wheel_key(kSize_px);
  cell.label = "direction of velocities";
  cell.is_display = true;
  return cell;
}

CellGroup cells_of(Aov aov, const std::vector<Plane>& planes, const Frame& frame) {
  const auto one = [](Cell cell) {
    CellGroup group;
    group.push_back(std::move(cell));
    return group;
  };
  const auto share = [&](const char* label) { return one(grey_cell(planes[0], 0, 1, label, frame)); };
  const auto measured = [&](const char* label, const char* unit = "") {
    return one(measured_cell(planes[0], label, unit, frame));
  };
  switch (aov) {
    case Aov::ao_raw:
      return share("AO raw");
    case Aov::ao_blurred:
      return share("AO blurred");
    case Aov::ao_upsampled:
      return share("AO at full resolution");
    case Aov::ao_filtered:
      return share("AO filtered in time");
    case Aov::thickness:
      return measured("thickness", " m");
    case Aov::mask:
      return share("mask: white is stable");
    case Aov::history_age:
      return measured("history age");
    case Aov::history_weight:
      return share("weight of the history: white is 1");
    case Aov::window_weight:
      return share("weight of the window: white is all of it");
    case Aov::confidence:
      return share("confidence in the history: white is 1");
    case Aov::rejected:
      return use_cells(planes[0], frame);
    case Aov::tile_velocity:
      return velocity_cells(planes[0], planes[1], "tile velocity", frame);
    case Aov::neighbour_velocity:
      return velocity_cells(planes[0], planes[1], "neighbour velocity", frame);
    case Aov::guessed:
      return measured("guessed background");
  }
  return {};
}

bool is_known(const std::string& channel) {
  return std::any_of(pipeline::kAovs.begin(), pipeline::kAovs.end(), [&](const pipeline::AovInfo& entry) {
    const auto channels = pipeline::channels_of(entry.aov);
    return std::find(channels.begin(), channels.end(), channel) != channels.end();
  });
}

}  // namespace

pipeline::AovSet aovs_in(const std::map<std::string, Plane>& channels) {
  pipeline::AovSet aovs;
  for (const pipeline::AovInfo& entry : pipeline::kAovs) {
    const auto names = pipeline::channels_of(entry.aov);
    if (std::all_of(names.begin(), names.end(), [&](const std::string& name) { return channels.contains(name); }))
      aovs.insert(entry.aov);
  }
  return aovs;
}

std::vector<CellGroup> intermediate_cells(const std::map<std::string, Plane>& channels, pipeline::AovSet aovs,
                                          bool others, const Frame& frame) {
  std::vector<CellGroup> groups;
  size_t velocities = 0;  // groups up to the last of them
  for (const pipeline::AovInfo& entry : pipeline::kAovs) {
    if (!aovs.contains(entry.aov)) continue;
    std::vector<Plane> planes;
    for (const std::string& name : pipeline::channels_of(entry.aov))
      planes.push_back(in_display(channels.at(name), frame, kNothing));
    groups.push_back(cells_of(entry.aov, planes, frame));
    if (entry.is_vector) velocities = groups.size();
  }
  if (velocities > 0) groups[velocities - 1].push_back(wheel_cell());
  if (!others) return groups;
  for (const auto& [name, plane] : channels) {
    if (!name.starts_with(kAovPrefix) || is_known(name)) continue;
    const preview::Range range = preview::range_of(plane);
    const std::string label =
        cat(name.substr(kAovPrefix.size()), ": ", number_text(range.least), " to ", number_text(range.largest));
    groups.emplace_back().push_back(
        grey_cell(in_display(plane, frame, kNothing), range.least, range.largest, label, frame));
  }
  return groups;
}

Plane in_display(ConstPlaneView plane, const Frame& frame, float background) {
  return placed(plane, frame.window, frame.display, background);
}

Cell beauty_cell(const Frame& frame, const std::string& label, const std::string& sequence) {
  for (const Layer& layer : frame.layers) {
    if (!layer.is_beauty || layer.planes.size() < 3) continue;
    std::vector<Plane> planes;
    for (size_t i = 0; i < 3; ++i) planes.push_back(in_display(layer.planes[i], frame, 0));
    return cell_of(std::move(planes), label, frame, false);
  }
  throw Error(ErrorCode::no_input, cat(sequence, " has no colour channels"));
}

void add_rows(std::vector<CellGroup> groups, preview::Sheet& sheet) {
  for (size_t i = 0; i < groups.size(); ++i) {
    if (i % kPicturesInARow == 0) sheet.rows.emplace_back();
    for (Cell& cell : groups[i]) {
      preview::shrink(cell, sheet.style);
      sheet.rows.back().push_back(std::move(cell));
    }
  }
}

}  // namespace aftershade::app
