#include "tests/rules/rules.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>

#include "core/base/text.h"
#include "tests/rules/source_text.h"

namespace aftershade::tests {

namespace fs = std::filesystem;

namespace {

/// DESIGN 1: a folder includes only folders on lower floors.
const std::vector<std::vector<std::string>> kFloors{{"core/base"},
                                                    {"core/math", "core/params", "core/parallel", "core/simd"},
                                                    {"core/camera"},
                                                    {"core/image"},
                                                    {"core/io", "core/color", "core/filter"},
                                                    {"core/ao", "core/temporal", "core/motionblur", "core/metrics"},
                                                    {"core/preset"},
                                                    {"core/pipeline", "core/preview"},
                                                    {"core/report", "core/tune"},
                                                    {"app"}};

bool is_in(std::string_view path, std::string_view folder) {
  return path.starts_with(folder) && path.size() > folder.size() && path[folder.size()] == '/';
}

/// The folder of the house that holds a path: "core/io", "app", "tests"; "" for none.
std::string folder_of(const std::string& path) {
  const size_t first = path.find('/');
  if (first == std::string::npos) return "";
  if (path.substr(0, first) != "core") return path.substr(0, first);
  return path.substr(0, path.find('/', first + 1));
}

std::optional<size_t> floor_of(const std::string& folder) {
  for (size_t i = 0; i < kFloors.size(); ++i)
    if (std::find(kFloors[i].begin(), kFloors[i].end(), folder) != kFloors[i].end()) return i;
  return std::nullopt;
}

bool is_cpp(const std::string& path) { return path.ends_with(".h") || path.ends_with(".cpp"); }
bool is_source(const std::string& path) {
  return is_cpp(path) || path.ends_with(".sh") || path.ends_with("CMakeLists.txt");
}
bool is_ours(const std::string& path) { return is_in(path, "app") || is_in(path, "core") || is_in(path, "tests"); }

std::string check_include(const SourceFile& file, const std::string& target) {
  const std::string from = folder_of(file.path), to = folder_of(target);
  if (to != "app" && to != "core" && to != "tests" && !to.starts_with("core/")) return "is not written from the root";
  if (from == "tests" || from == to) return "";
  const auto from_floor = floor_of(from), to_floor = floor_of(to);
  if (!from_floor) return from + " is on no floor";
  if (!to_floor) return to + " is not for " + from;
  if (*to_floor > *from_floor) return "runs upwards from " + from;
  return *to_floor == *from_floor ? "runs sideways from " + from : "";
}

/// A library, how its headers start, and the folders that may include them.
struct Library {
  std::string_view name;
  std::vector<std::string_view> headers;
  std::vector<std::string_view> folders;
};
const std::array<Library, 4> kLibraries{
    {{"OpenEXR", {"<Imf", "<OpenEXR/", "<openexr", "<Iex", "<IlmThread"}, {"core/io", "tests"}},
     {"nlohmann-json",
      {"<nlohmann/"},
      {"core/params", "core/io", "core/preset", "core/report", "core/tune", "app", "tests"}},
     {"CLI11", {"<CLI/"}, {"app"}},
     {"OpenImageIO", {"<OpenImageIO/"}, {"core/preview", "tests"}}}};

std::vector<std::string> gitignored_folders(const std::string& gitignore) {
  std::vector<std::string> out;
  for (const std::string& line : split(gitignore, '\n'))
    if (line.size() > 2 && line.starts_with('/') && line.ends_with('/')) out.push_back(line.substr(1, line.size() - 2));
  return out;
}

bool is_ignored(const std::string& folder, const std::string& gitignore) {
  if (folder.starts_with('.')) return true;
  const auto patterns = gitignored_folders(gitignore);
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return glob_match(pattern, folder); });
}

}  // namespace

Violations check_floors(const SourceFile& file) {
  Violations out;
  if (!is_cpp(file.path) || !is_ours(file.path)) return out;
  for (const Include& include : includes(file.text)) {
    if (!include.name.starts_with('"')) continue;
    const std::string target = include.name.substr(1, include.name.size() - 2);
    const std::string wrong = check_include(file, target);
    if (!wrong.empty()) out.push_back(cat(file.path, ":", include.line, ": #include ", include.name, " ", wrong));
  }
  return out;
}

Violations check_libraries(const SourceFile& file) {
  Violations out;
  if (!is_cpp(file.path)) return out;
  const auto starts = [](const std::string& name) {
    return [&name](std::string_view start) { return name.starts_with(start); };
  };
  const auto holds = [&](std::string_view folder) { return is_in(file.path, folder); };
  for (const Include& include : includes(file.text)) {
    const std::string bracketed = "<" + include.name.substr(1);  // "CLI/CLI.hpp" reaches the same header
    for (const Library& library : kLibraries)
      if (std::any_of(library.headers.begin(), library.headers.end(), starts(bracketed)) &&
          std::none_of(library.folders.begin(), library.folders.end(), holds))
        out.push_back(cat(file.path, ":", include.line, ": ", library.name, " is not for this folder"));
  }
  return out;
}

Violations check_file_length(const SourceFile& file) {
  if (!is_source(file.path) || !is_ours(file.path)) return {};
  const auto lines = std::count(file.text.begin(), file.text.end(), '\n');
  if (lines <= 400) return {};
  return {cat(file.path, ": has ", lines, " lines; 400 are the limit")};
}

Violations check_functions(const SourceFile& file) {
  Violations out;
  if (!is_cpp(file.path) || !is_ours(file.path)) return out;
  for (const Function& function : functions(file.text))
    if (function.lines > 60)
      out.push_back(
          cat(file.path, ":", function.line, ": has ", function.lines, " lines; 60 are the limit: ", function.header));
  return out;
}

Violations check_macros(const SourceFile& file) {
  Violations out;
  if (!is_cpp(file.path) || !(is_in(file.path, "app") || is_in(file.path, "core"))) return out;
  for (const std::string& name : function_like_macros(file.text))
    out.push_back(cat(file.path, ": defines the macro ", name, "()"));
  return out;
}

Violations check_machine_paths(const SourceFile& file) {
  Violations out;
  static const std::array<std::string, 4> kNames{"home", "root", "work", "Users"};
  for (const std::string& name : kNames)
    for (size_t at = 0; (at = file.text.find("/" + name + "/", at)) != std::string::npos; ++at) {
      const char before = at == 0 ? ' ' : file.text[at - 1];
      if (std::isalnum(static_cast<unsigned char>(before)) ||
          std::string_view("_.-~/})>*").find(before) != std::string_view::npos)
        continue;
      const auto line = std::count(file.text.begin(), file.text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
      out.push_back(cat(file.path, ":", line, ": names a path of one machine: ", file.text.substr(at, 40)));
    }
  return out;
}

Violations check_top_level(const std::vector<std::string>& folders, const std::string& ignored) {
  static const std::vector<std::string> kRooms{"app", "core", "configs", "tests", "examples", "man"};
  Violations out;
  for (const std::string& folder : folders)
    if (!is_ignored(folder, ignored) && std::find(kRooms.begin(), kRooms.end(), folder) == kRooms.end())
      out.push_back(folder + "/ is no room of the house: " + join(kRooms, ", "));
  return out;
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

std::vector<SourceFile> project_files(const fs::path& root) {
  const std::string ignored = read_text(root / ".gitignore");
  std::vector<SourceFile> out;
  for (fs::recursive_directory_iterator entry(root), end; entry != end; ++entry) {
    const std::string name = entry->path().filename().string();
    const bool top = entry.depth() == 0;
    if (entry->is_directory() && (name == "__pycache__" || (name != ".ci" && is_ignored(name, top ? ignored : ""))))
      entry.disable_recursion_pending();
    else if (entry->is_regular_file() && !entry->is_symlink())
      out.push_back({entry->path().lexically_relative(root).generic_string(), read_text(entry->path())});
  }
  return out;
}

std::vector<std::string> top_level_folders(const fs::path& root) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(root))
    if (entry.is_directory()) out.push_back(entry.path().filename().string());
  return out;
}

}  // namespace aftershade::tests
