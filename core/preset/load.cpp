#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "core/base/embedded.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/preset/merge.h"

namespace aftershade::presets {
std::span<const EmbeddedFile> embedded_files();  // configs/*.json, written by the build
}

namespace aftershade::preset {

using params::Json;
namespace fs = std::filesystem;

namespace {

/// A preset's text and where it came from.
struct Source {
  std::string label;     ///< in messages and as origin: the shipped name, or the file as it was written
  std::string identity;  ///< the same for the same preset, however it was written
  fs::path folder;       ///< what its "extends" is relative to
  std::string text;
};

bool is_file_name(std::string_view text) { return text.find('/') != std::string_view::npos || text.ends_with(".json"); }

Source open_shipped(const std::string& name) {
  for (const EmbeddedFile& file : presets::embedded_files())
    if (file.name == name) return {name, name, {}, std::string(file.text)};
  const std::vector<std::string> names = shipped_presets();
  const std::string guess = did_you_mean(name, names);
  throw Error(ErrorCode::config, cat("unknown preset \"", name, "\""),
              guess.empty() ? "shipped are " + join(names, ", ") + "; the name of a file ends in .json" : guess);
}

Source open_file(const fs::path& path) {
  std::error_code ignored;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || fs::is_directory(path, ignored))
    throw Error(ErrorCode::no_input,
                cat(path.string(), ": the preset file cannot be read: ", std::strerror(stream ? EISDIR : errno)),
                "give a shipped preset's name or a readable .json file");
  std::string text(std::istreambuf_iterator<char>(stream), {});
  return {path.string(), fs::weakly_canonical(path, ignored).string(), path.parent_path(), std::move(text)};
}

Source open_source(const std::string& name_or_file, const fs::path& folder) {
  return is_file_name(name_or_file) ? open_file((folder / name_or_file).lexically_normal())
                                    : open_shipped(name_or_file);
}

/// Fails on a key that an object has twice, which the JSON library would silently drop.
class DuplicateKeys {
 public:
  explicit DuplicateKeys(std::string label) : label_(std::move(label)) {}
  bool operator()(int /*depth*/, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) open_.emplace_back();
    if (event == Json::parse_event_t::object_end) open_.pop_back();
    if (event == Json::parse_event_t::key && !open_.back().insert(parsed.get<std::string>()).second)
      throw Error(ErrorCode::config,
                  cat(label_, ": the key \"", parsed.get<std::string>(), "\" is given twice in one object"));
    return true;
  }

 private:
  std::string label_;
  std::vector<std::set<std::string>> open_;
};

/// The library's message without its "[json.exception...] parse error at line 1, column 2: ".
std::string reason(std::string_view what) {
  const size_t start = what.find(": ");
  return std::string(start == std::string_view::npos ? what : what.substr(start + 2));
}

Json parse(const Source& source) {
  try {
    return Json::parse(source.text, DuplicateKeys(source.label));
  } catch (const Json::parse_error& error) {
    const std::string_view before = std::string_view(source.text).substr(0, error.byte == 0 ? 0 : error.byte - 1);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const size_t column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0: the first line
    throw Error(ErrorCode::config, cat(source.label, ": line ", line, ", column ", column, ": ", reason(error.what())),
                "the file is not valid JSON");
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::config, cat(source.label, ": ", error.what()), "the file is not valid JSON");
  }
}

Resolved resolve(const Json& json, const Source& source, std::vector<std::string> chain);

Resolved resolve_parent(const std::string& parent, const Source& source, const std::vector<std::string>& chain) {
  const Source opened = with_context(source.label + ": extends", [&] { return open_source(parent, source.folder); });
  if (std::find(chain.begin(), chain.end(), opened.identity) != chain.end())
    throw Error(ErrorCode::config, cat(source.label, ": extends \"", parent, "\" in a circle: ", join(chain, " -> "),
                                       " -> ", opened.identity));
  return resolve(parse(opened), opened, chain);
}

Resolved resolve(const Json& json, const Source& source, std::vector<std::string> chain) {
  chain.push_back(source.identity);
  Resolved out;
  if (json.is_object() && json.contains("extends") && json["extends"].is_string())
    out = resolve_parent(json["extends"].get<std::string>(), source, chain);
  out.preset.name = source.label.ends_with(".json") ? fs::path(source.label).stem().string() : source.label;
  merge_file(out, json, source.label);
  return out;
}

}  // namespace

std::vector<std::string> shipped_presets() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : presets::embedded_files()) names.emplace_back(file.name);
  std::sort(names.begin(), names.end());
  return names;
}

Resolved load_preset(const std::string& name_or_file, const std::vector<std::string>& sets) {
  const Source source = open_source(name_or_file, {});
  Resolved out = resolve(parse(source), source, {});
  for (const std::string& set : sets) merge_set(out, set);
  return out;
}

Preset from_json(const Json& json, std::string_view where) {
  const fs::path path(where);
  return resolve(json, {std::string(where), fs::path(where).lexically_normal().string(), path.parent_path(), {}}, {})
      .preset;
}

}  // namespace aftershade::preset
