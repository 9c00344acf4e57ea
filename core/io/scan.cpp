#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/sequence.h"

namespace aftershade::io {

namespace fs = std::filesystem;

namespace {

/// Names of all entries of a folder, in one pass.
std::vector<std::string> names_in(const std::string& folder) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error)
    throw Error(ErrorCode::no_input, cat("cannot read folder \"", folder, "\": ", error.message()), "check the path");
  std::vector<std::string> names;
  for (; entries != fs::directory_iterator(); entries.increment(error))
    names.push_back(entries->path().filename().string());
  if (error) throw Error(ErrorCode::no_input, cat("cannot read folder \"", folder, "\" to its end: ", error.message()));
  std::sort(names.begin(), names.end());
  return names;
}

Sequence matches(const Pattern& pattern, const std::vector<std::string>& names) {
  std::vector<Sequence::Entry> entries;
  for (const std::string& name : names)
    if (const auto frame = frame_of_name(pattern, name)) entries.push_back({*frame, pattern.path_of(name)});
  return Sequence(std::move(entries));
}

/// The sequence to which the file `name` belongs. A number without leading zeros does not show its padding ("10" may be
/// followed by "9" or "09"): the padding that fits most files is taken.
FoundSequence sequence_around(Pattern pattern, const std::string& name, const std::vector<std::string>& names) {
  const char* digits = name.c_str() + pattern.prefix.size();
  if (*digits == '-') ++digits;
  const bool leading_zero = *digits == '0';
  FoundSequence best{pattern, matches(pattern, names)};
  for (int padding = pattern.padding - 1; padding >= 1 && !leading_zero; --padding) {
    pattern.padding = padding;
    Sequence found = matches(pattern, names);
    if (found.entries().size() > best.sequence.entries().size()) best = {pattern, std::move(found)};
  }
  return best;
}

FoundSequence single_file(const std::string& folder, const std::string& name) {
  Pattern pattern{.folder = folder, .prefix = name, .suffix = "", .has_token = false};
  return {pattern, Sequence({{0, pattern.path(0)}})};
}

std::string with_folder(const std::string& folder, const std::string& name) {
  return folder == "." ? name : folder + "/" + name;
}

/// Every EXR sequence of a folder; temporaries and hidden files do not count.
std::vector<FoundSequence> sequences_in(const std::string& folder) {
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> groups;
  for (const std::string& name : names_in(folder)) {
    if (name.starts_with('.') || !to_lower(name).ends_with(".exr")) continue;
    const auto pattern = pattern_of_frame(with_folder(folder, name));
    groups[pattern ? std::pair(pattern->prefix, pattern->suffix) : std::pair(name, std::string())].push_back(name);
  }
  std::vector<FoundSequence> found;
  for (auto& [key, names] : groups) {
    while (!names.empty()) {
      const auto pattern = pattern_of_frame(with_folder(folder, names.front()));
      found.push_back(pattern ? sequence_around(*pattern, names.front(), names) : single_file(folder, names.front()));
      const Pattern& taken = found.back().pattern;
      std::erase_if(names, [&](const std::string& name) { return frame_of_name(taken, name).has_value(); });
    }
  }
  return found;
}

std::string listed(const std::vector<FoundSequence>& sequences) {
  constexpr size_t kMost = 8;
  std::vector<std::string> lines;
  for (size_t i = 0; i < std::min(sequences.size(), kMost); ++i) {
    const auto& [pattern, sequence] = sequences[i];
    lines.push_back(pattern.has_token ? cat(pattern.text(), " ", format_frames(sequence.frames())) : pattern.text());
  }
  if (sequences.size() > kMost) lines.push_back(cat("and ", sequences.size() - kMost, " more"));
  return join(lines, ", ");
}

FoundSequence sequence_of_folder(const std::string& folder) {
  std::vector<FoundSequence> found = sequences_in(folder);
  if (found.empty()) throw Error(ErrorCode::no_input, cat("folder \"", folder, "\" holds no EXR file"));
  if (found.size() > 1)
    throw Error(ErrorCode::no_input, cat("folder \"", folder, "\" holds ", found.size(), " sequences: ", listed(found)),
                "name one of them");
  return std::move(found.front());
}

FoundSequence sequence_of_file(const std::string& path) {
  const fs::path file(path);
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  const auto pattern = pattern_of_frame(path);
  if (!pattern) return single_file(folder, file.filename().string());
  return sequence_around(*pattern, file.filename().string(), names_in(pattern->folder));
}

/// What there is instead, for the hint of an error.
std::string instead(const std::string& folder) {
  const auto found = sequences_in(folder);
  return found.empty() ? "" : cat("there is ", listed(found));
}

}  // namespace

FoundSequence find_sequence(const std::string& input, HashDigits hash) {
  std::string path = input;
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  std::error_code error;
  if (fs::is_directory(path, error)) return sequence_of_folder(path);
  if (fs::exists(path, error)) return sequence_of_file(path);
  const auto pattern = parse_pattern(path, hash);
  if (!pattern) {
    const fs::path file(path);
    const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
    throw Error(ErrorCode::no_input, cat("there is no file \"", input, "\""),
                fs::is_directory(folder, error) ? instead(folder) : "");
  }
  FoundSequence found{*pattern, matches(*pattern, names_in(pattern->folder))};
  if (found.sequence.empty())
    throw Error(ErrorCode::no_input, cat("no file matches \"", pattern->text(), "\""), instead(pattern->folder));
  return found;
}

}  // namespace aftershade::io
