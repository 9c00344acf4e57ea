#include "tests/bench/throughput/plan.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/base/text.h"
#include "core/io/exr_reader.h"
#include "tests/bench/throughput/stages.h"

namespace aftershade::tests::throughput {

namespace fs = std::filesystem;

namespace {

std::string text_of(Size size) { return cat(size.width, "x", size.height); }

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Parts, channels, types and compression.
std::string shape_of(const fs::path& file) {
  std::string text;
  const io::ExrReader reader(file);
  for (const io::PartInfo& part : reader.info().parts) {
    text += part.compression + ":";
    for (const io::ChannelInfo& channel : part.channels) text += cat(" ", channel.name, " ", to_text(channel.type));
  }
  return text;
}

void check_alike(const fs::path& made, const fs::path& original) {
  if (shape_of(made) != shape_of(original))
    throw std::runtime_error(
        cat(made.string(), " has ", shape_of(made), " where ", original.string(), " has ", shape_of(original)));
}

}  // namespace

Plan::Plan(const Options& options, fs::path work)
    : options_(options),
      work_(std::move(work)),
      self_(fs::read_symlink("/proc/self/exe")),
      program_(self_.parent_path() / "aftershade"),
      frames_{work_ / "frames", options.size, options.frames},
      large_{work_ / "large", options.large, options.large_frames} {
  if (!fs::exists(program_)) throw std::runtime_error(cat(program_.string(), " is missing: build aftershade first"));
  if (!found_in_path("oiiotool"))
    throw std::runtime_error("oiiotool is missing: apt-get install openimageio-tools, or tests/setup.sh");
  throughput::run({{program_, "render", "--help"}}, work_ / "help.txt");
  help_ = text_of(work_ / "help.txt");
}

bool Plan::offers(const std::string& option) const { return help_.find(option) != std::string::npos; }

void Plan::make(const FrameSet& set) const {
  throughput::run({{self_, "frames", set.folder, text_of(set.size), std::to_string(set.frames)}}, work_ / "log.txt");
}

void Plan::make_frames() {
  make(frames_);
  make(large_);
  const FrameSet first{frames_.folder, frames_.size, large_.frames};
  linked_ = linked_frames(first, work_ / "linked", options_.linked_frames);
  linked_large_ = linked_frames(large_, work_ / "linked-large", options_.linked_frames);
  one_ = linked_frames(first, work_ / "one", 1);
  many_ = linked_frames(frames_, work_ / "many", options_.memory_frames);
}

Command Plan::render(const FrameSet& set, const fs::path& out, const std::vector<std::string>& more) const {
  Command command{program_, "render", set.folder / "in.####.exr", "-o", out / "out.####.exr", "--progress",
                  "none",   "-q"};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

Job Plan::whole(const std::string& name, const FrameSet& set, const std::vector<std::string>& more) const {
  const fs::path out = work_ / "out";
  Command command = render(set, out, {"--threads", std::to_string(options_.cores)});
  command.insert(command.end(), more.begin(), more.end());
  return {name, {command}, out, set.frames, [=] { check_alike(out / "out.0001.exr", set.path(1)); }};
}

/// As much work as one job does: the second half starts without the history of the first.
Job Plan::halves() const {
  const int half = frames_.frames / 2;
  Job job{kHalves, {}, work_ / "out", frames_.frames};
  for (const auto& [first, last] : {std::pair{1, half}, std::pair{half + 1, frames_.frames}})
    job.commands.push_back(
        render(frames_, job.out, {"--threads", "1", "--preroll", "0", "--frames", cat(first, "-", last)}));
  return job;
}

/// # stands for four digits to OpenImageIO.
Job Plan::copies(const std::string& name, int processes) const {
  const fs::path out = work_ / "out";
  Job job{name, {}, out, frames_.frames, [=, this] { check_alike(out / "out.0001.exr", frames_.path(1)); }};
  for (int i = 0; i < processes; ++i) {
    const int first = 1 + i * frames_.frames / processes, last = (i + 1) * frames_.frames / processes;
    job.commands.push_back({"oiiotool", "--frames", cat(first, "-", last), frames_.folder / "in.#.exr", "-d", "half",
                            "-d", "Z=float", "-o", out / "out.#.exr"});
  }
  return job;
}

std::vector<Job> Plan::main_jobs() const {
  const fs::path gather_plus = work_ / "gather-plus.json";
  std::ofstream(gather_plus) << gather_plus_preset().dump(2) << "\n";
  std::vector<Job> jobs{copies(kCopy, 2), whole(kWhole, frames_, {})};
  if (offers("--recode")) jobs.push_back(whole(kRecode, frames_, {"--recode"}));
  jobs.push_back(copies(kOneCopy, 1));
  jobs.push_back(halves());
  if (offers("--fsync")) jobs.push_back(whole(kNoFsync, frames_, {"--fsync", "off"}));
  jobs.push_back(whole(kBlurJob, frames_, {"--only", "motion_blur"}));
  jobs.push_back(whole(kGatherPlusJob, linked_, {"--preset", gather_plus}));
  jobs.push_back(whole(kSmall, linked_, {}));
  jobs.push_back(whole(kLarge, linked_large_, {}));
  return jobs;
}

std::vector<Job> Plan::disk_jobs() const {
  std::vector<Job> jobs{whole(kDisk, frames_, {})};
  if (offers("--fsync")) jobs.push_back(whole(kDiskNoFsync, frames_, {"--fsync", "off"}));
  const fs::path out = options_.disk / "aftershade-throughput-out";
  for (Job& job : jobs) {
    job.commands[0][4] = out / "out.####.exr";
    job.out = out;
    job.check = nullptr;
  }
  return jobs;
}

/// Six presets by a job each, one after the other, and by one that reads every frame once.
std::vector<Job> Plan::compare_jobs() const {
  const std::vector<std::string> presets{"low-current-gen", "high-current-gen", "ultra-current-gen",
                                         "low-dx11",        "high-dx11",        "ultra-dx11"};
  const fs::path out = work_ / "out", script = work_ / "six.sh";
  const std::string threads = std::to_string(options_.cores);
  std::ofstream lines(script);
  lines << "set -e\n";
  for (const std::string& preset : presets) {
    lines << "mkdir -p '" << (out / preset).string() << "'\n";
    for (const std::string& word : render(frames_, out / preset, {"--preset", preset, "--threads", threads}))
      lines << "'" << word << "' ";
    lines << "\n";
  }
  Command compare{program_,
                  "compare",
                  frames_.folder / "in.####.exr",
                  "-o",
                  out,
                  "-p",
                  join(presets, ","),
                  "--metric",
                  "none",
                  "--no-report",
                  "--no-cost",
                  "-q"};
  compare.insert(compare.end(), {"--progress", "none", "--threads", threads});
  Command written = compare;
  written.emplace_back("--write-frames");
  const int frames = frames_.frames * static_cast<int>(presets.size());
  Job alone{kCompareAlone, {compare}, out, frames};
  alone.files = 0;
  return {{kSixJobs, {{"sh", script}}, out, frames}, {kCompareWritten, {written}, out, frames}, alone};
}

void Plan::run(Jobs& jobs) const {
  const Job version{kVersion, {{program_, "--version"}}, {}};
  jobs.run({version, whole(kOneFrame, one_, {})}, options_.quick_repetitions);
  jobs.run(main_jobs(), options_.repetitions);
  jobs.run(compare_jobs(), options_.repetitions);
  if (!options_.disk.empty()) jobs.run(disk_jobs(), options_.repetitions);
  if (options_.memory_frames > 0) jobs.run_and_drop_files(whole(kMemory, many_, {}));
  if (!options_.offline) return;
  const int first = 1 + (frames_.frames - options_.offline_frames) / 2, last = first + options_.offline_frames - 1;
  Job offline = whole(kOffline, frames_, {"--preset", "offline", "--frames", cat(first, "-", last)});
  offline.frames = options_.offline_frames;
  jobs.run_and_drop_files(offline);
}

params::Json Plan::json_of(Command command, const std::string& name) const {
  const fs::path file = work_ / name;
  command.insert(command.end(), {"--json", file});
  throughput::run({command}, work_ / "log.txt");
  return params::Json::parse(text_of(file));
}

params::Json Plan::stages() const {
  return json_of({self_, "stages", frames_.folder, text_of(frames_.size), std::to_string(frames_.frames),
                  std::to_string(2 * options_.repetitions + 1)},
                 "stages.json");
}

params::Json Plan::kernels() const {
  Command command{self_.parent_path() / "bench_kernels"};
  if (options_.smoke) command.emplace_back("--smoke");
  return json_of(command, "kernels.json");
}

}  // namespace aftershade::tests::throughput
