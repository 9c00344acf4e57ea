#include <algorithm>
#include <filesystem>

#include "app/job.h"
#include "app/log.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/preview/loader.h"

namespace aftershade::app {

namespace {

Input open_side(const std::string& input, const SheetArgs& args, const std::vector<std::string>& channels = {}) {
  InputArgs side;
  side.channels = channels;
  side.input = input;
  side.frames = args.frames;
  side.hash_digits = args.hash_digits;
  side.missing = "skip";
  return open_input(side);
}

/// The sequence after, with the AO that render wrote into it, whatever its producer's profile calls AO.
Input open_after(const SheetArgs& args) {
  Input after = open_side(args.after, args);
  for (const std::string name : {kOwnAoChannel, "AO"}) {
    const auto has = [&](const std::string& view) { return has_channel(after.source->info(), view, name); };
    if (std::all_of(after.views.begin(), after.views.end(), has)) return open_side(args.after, args, {"ao=" + name});
  }
  return after;
}

/// First, middle and last of the frames that both sides have.
std::vector<int> frames_to_show(const SheetArgs& args, const Input& before, const Input& after) {
  std::vector<int> common;
  for (const int frame : before.frames)
    if (after.found.sequence.path(frame)) common.push_back(frame);
  if (common.empty())
    throw Error(ErrorCode::no_input, "the two sequences have no frame in common", "their frame numbers must agree");
  if (!args.frames.empty() || common.size() <= 3) return common;
  return {common.front(), common[common.size() / 2], common.back()};
}

Frame load_side(const Input& side, int frame, RoleSet roles, bool layers) {
  auto loaded = side.source->load(frame, side.views.front(), roles, layers);
  if (!loaded) throw Error(ErrorCode::no_input, cat("frame ", frame, " of ", side.found.pattern.text(), " is missing"));
  return std::move(*loaded);
}

/// The picture inside the display window, so that frames with moving data windows line up.
std::vector<Plane> shown(const std::vector<Plane>& planes, size_t count, const Frame& frame, float background) {
  std::vector<Plane> out;
  for (size_t i = 0; i < count; ++i) {
    Plane plane(frame.display.width(), frame.display.height(), background);
    copy_at(planes[i], plane, frame.window.min_x - frame.display.min_x, frame.window.min_y - frame.display.min_y);
    out.push_back(std::move(plane));
  }
  return out;
}

preview::Cell beauty_cell(const Input& side, int number, const std::string& label) {
  const Frame frame = load_side(side, number, {}, true);
  for (const Layer& layer : frame.layers)
    if (layer.is_beauty && layer.planes.size() >= 3)
      return {shown(layer.planes, 3, frame, 0), label, frame.pixel_aspect};
  throw Error(ErrorCode::no_input, cat(side.found.pattern.text(), " has no colour channels"));
}

preview::Cell ao_cell(const Input& side, int number) {
  const Frame frame = load_side(side, number, {Role::ao}, false);
  return {shown(frame.planes(Role::ao), 1, frame, 1), "AO", frame.pixel_aspect};
}

}  // namespace

int sheet(const SheetArgs& args) {
  const Input before = open_side(args.before, args), after = open_after(args);
  const bool with_ao = after.source->available(after.views.front()).contains(Role::ao);
  if (!with_ao) log().note("the sequence after has no AO channel (render with --ao): the sheet shows before and after");
  preview::Sheet sheet;
  sheet.title = std::filesystem::path(after.found.pattern.text()).filename().string();
  sheet.style.max_cell_width_px = args.cell_width;
  for (const int frame : frames_to_show(args, before, after)) {
    std::vector<preview::Cell>& row = sheet.rows.emplace_back();
    row.push_back(beauty_cell(before, frame, cat("frame ", frame, ", before")));
    if (with_ao) row.push_back(ao_cell(after, frame));
    row.push_back(beauty_cell(after, frame, "after"));
    for (preview::Cell& cell : row) preview::shrink(cell, sheet.style);
  }
  const std::string note = preview::write_sheet(std::move(sheet), args.output);
  if (!note.empty()) log().note(note);
  return 0;
}

}  // namespace aftershade::app
