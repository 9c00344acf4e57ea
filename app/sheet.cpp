#include <algorithm>
#include <filesystem>
#include <limits>

#include "app/intermediates.h"
#include "app/job.h"
#include "app/log.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/roles.h"
#include "core/pipeline/named_channels.h"
#include "core/preview/loader.h"

namespace aftershade::app {

namespace {

/// A side of the sheet: `changes` may replace what was typed.
Input open_side(const SheetArgs& args, const std::string& input, const std::vector<std::string>& channels = {},
                const std::vector<std::string>& named = {}) {
  InputArgs side = args;
  side.input = input;
  side.channels.insert(side.channels.end(), channels.begin(), channels.end());
  side.missing = "skip";
  return open_input(side, named);
}

/// The sequence after, with the AO that render wrote into it, whatever its producer's profile calls AO.
Input open_after(const SheetArgs& args) {
  Input after = open_side(args, args.after);
  for (const std::string name : {kOwnAoChannel, "AO"}) {
    const auto has = [&](const std::string& view) { return has_channel(after.source->info(), view, name); };
    if (std::all_of(after.views.begin(), after.views.end(), has)) return open_side(args, args.after, {"ao=" + name});
  }
  return after;
}

/// First, middle and last of the frames that both sides have.
std::vector<int> frames_of_both(const SheetArgs& args, const Input& before, const Input& after) {
  std::vector<int> common;
  for (const int frame : before.frames)
    if (after.found.sequence.path(frame)) common.push_back(frame);
  if (common.empty())
    throw Error(ErrorCode::no_input, "the two sequences have no frame in common", "their frame numbers must agree");
  if (!args.frames.empty() || common.size() <= 3) return common;
  return {common.front(), common[common.size() / 2], common.back()};
}

/// The frames asked for, or the middle one.
std::vector<int> frames_of(const SheetArgs& args, const Input& input) {
  if (!args.frames.empty()) return input.frames;
  return {input.frames[input.frames.size() / 2]};
}

Frame load_frame(const Input& input, int frame, RoleSet roles, bool layers) {
  auto loaded = input.source->load(frame, input.views.front(), roles, layers);
  if (!loaded)
    throw Error(ErrorCode::no_input, cat("frame ", frame, " of ", input.found.pattern.text(), " is missing"));
  return std::move(*loaded);
}

preview::Cell loaded_beauty(const Input& input, int number, const std::string& label) {
  return beauty_cell(load_frame(input, number, {}, true), label, input.found.pattern.text());
}

preview::Cell ao_cell(const Input& input, int number) {
  const Frame frame = load_frame(input, number, {Role::ao}, false);
  preview::Cell cell;
  cell.planes.push_back(in_display(frame.planes(Role::ao)[0], frame, 1));
  cell.label = "AO";
  cell.pixel_aspect = frame.pixel_aspect;
  return cell;
}

preview::Sheet new_sheet(const SheetArgs& args, const Input& input, const std::string& what = "") {
  preview::Sheet sheet;
  sheet.title = std::filesystem::path(input.found.pattern.text()).filename().string() + what;
  sheet.style.max_cell_width_px = args.cell_width;
  return sheet;
}

preview::Sheet before_and_after(const SheetArgs& args) {
  const Input before = open_side(args, args.input), after = open_after(args);
  const bool with_ao = after.source->available(after.views.front()).contains(Role::ao);
  if (!with_ao) log().note("the sequence after has no AO channel (render with --ao): the sheet shows before and after");
  preview::Sheet sheet = new_sheet(args, after);
  for (const int frame : frames_of_both(args, before, after)) {
    std::vector<preview::Cell>& row = sheet.rows.emplace_back();
    row.push_back(loaded_beauty(before, frame, cat("frame ", frame, ", before")));
    if (with_ao) row.push_back(ao_cell(after, frame));
    row.push_back(loaded_beauty(after, frame, "after"));
    for (preview::Cell& cell : row) preview::shrink(cell, sheet.style);
  }
  return sheet;
}

/// Channels of intermediate results in the first view's part of the file, without its token.
std::vector<std::string> intermediate_channels(const Input& input) {
  const io::FileInfo& info = input.source->info();
  std::vector<std::string> names;
  for (size_t part = 0; part < info.parts.size(); ++part)
    for (const io::ChannelInfo& channel : info.parts[part].channels) {
      const auto name = io::name_in_view(info, static_cast<int>(part), channel.name, input.views.front());
      if (name && name->starts_with(kAovPrefix)) names.push_back(*name);
    }
  return names;
}

/// Of frames that were rendered with --aov.
preview::Sheet rendered(const SheetArgs& args) {
  Input input = open_side(args, args.input);
  const std::vector<std::string> channels = intermediate_channels(input);
  if (channels.empty())
    throw Error(ErrorCode::usage,
                cat(input.found.pattern.text(), " has no intermediate results (channels ", kAovPrefix, "*)"),
                "--preset NAME renders and shows them; or render with --aov all; or give a second sequence to compare "
                "with");
  input = open_side(args, args.input, {}, channels);
  preview::Sheet sheet = new_sheet(args, input);
  for (const int number : frames_of(args, input)) {
    const Frame frame = load_frame(input, number, {}, true);
    const pipeline::AovSet offered = aovs_in(frame.named);
    std::vector<CellGroup> groups;
    groups.emplace_back().push_back(beauty_cell(frame, cat("frame ", number), input.found.pattern.text()));
    std::ranges::move(
        intermediate_cells(frame.named, args.aovs.empty() ? offered : pipeline::aovs_from_names(args.aovs, offered),
                           args.aovs.empty(), frame),
        std::back_inserter(groups));
    add_rows(std::move(groups), sheet);
  }
  return sheet;
}

/// Turns finished frames into rows of the sheet.
class SheetSink final : public FrameSink {
 public:
  SheetSink(const Input& input, pipeline::AovSet aovs, preview::Sheet& sheet)
      : input_(input), aovs_(aovs), sheet_(sheet) {}

  void write(int number, const std::vector<Frame>& views) override {
    const Frame& frame = views.front();
    const std::string name = input_.found.pattern.text();
    std::vector<CellGroup> groups;
    groups.emplace_back().push_back(loaded_beauty(input_, number, cat("frame ", number, ", before")));
    groups.emplace_back().push_back(beauty_cell(frame, "after", name));
    std::ranges::move(intermediate_cells(frame.added, aovs_, false, frame), std::back_inserter(groups));
    add_rows(std::move(groups), sheet_);
  }

 private:
  const Input& input_;
  pipeline::AovSet aovs_;
  preview::Sheet& sheet_;
};

/// Renders in memory and shows what happens on the way.
preview::Sheet of_preset(const SheetArgs& args) {
  const preset::Preset preset = resolve_preset(args).preset;
  const pipeline::AovSet offered = pipeline::aovs_of(preset);
  const std::vector<std::string> all{"all"};
  pipeline::Outputs outputs;
  outputs.work.aovs = pipeline::aovs_from_names(args.aovs.empty() ? all : args.aovs, offered);
  const Input input = open_side(args, args.input, {}, pipeline::named_channels(preset));
  std::vector<pipeline::ViewPipeline> views;
  views.emplace_back(preset, input.views.front(), offer_of(input, input.views.front()), outputs);
  preview::Sheet sheet = new_sheet(args, input, cat(", preset ", preset.name));
  SheetSink sink(input, outputs.work.aovs, sheet);
  pipeline::RunOptions run;
  run.written = frames_of(args, input);
  run.on_disk = input.found.sequence.frames();
  run.preroll = preroll_of(args.preroll);
  run.frames_in_flight = 1;  // the sink reads frames too, and what that notes goes to the log at once
  run.on_progress = [](const pipeline::Progress& progress) {
    for (const pipeline::FrameReport& report : progress.reports) {
      for (const std::string& note : report.notes) log().note(note);
      for (const std::string& warning : report.warnings) log().warning(cat("frame ", progress.number, ": ", warning));
    }
  };
  pipeline::run(views, *input.source, sink, run);
  return sheet;
}

}  // namespace

int sheet(const SheetArgs& args) {
  const bool changes = !args.preset.empty() || !args.sets.empty() || !args.only.empty() || !args.skip.empty();
  if (!args.after.empty() && (changes || !args.aovs.empty()))
    throw Error(ErrorCode::usage, "two sequences are shown as they are: no preset runs, and no --aov is shown",
                "give one sequence");
  if (!to_lower(args.output).ends_with(".png"))
    throw Error(ErrorCode::usage, cat("-o ", args.output, ": a sheet is a PNG file, and this name does not say so"),
                "let it end in .png");
  preview::Sheet sheet = !args.after.empty() ? before_and_after(args) : changes ? of_preset(args) : rendered(args);
  const std::string note = preview::write_sheet(std::move(sheet), args.output);
  if (!note.empty()) log().note(note);
  log().summarise();
  return 0;
}

}  // namespace aftershade::app
