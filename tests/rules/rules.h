#pragma once
#include <filesystem>
#include <string>
#include <vector>

/// The rules of the house (DESIGN 1 and 6, issue 2 item 9), each a function from files to what is wrong with them.
namespace aftershade::tests {

/// A file by its path from the root of the project, with '/' between folders.
struct SourceFile {
  std::string path, text;
};

using Violations = std::vector<std::string>;

Violations check_floors(const SourceFile& file);         ///< includes run downwards only, and are written from the root
Violations check_libraries(const SourceFile& file);      ///< who may see OpenEXR, nlohmann-json, CLI11 and OpenImageIO
Violations check_file_length(const SourceFile& file);    ///< 400 lines
Violations check_functions(const SourceFile& file);      ///< 60 lines
Violations check_macros(const SourceFile& file);         ///< no function-like macro in app/ and core/
Violations check_machine_paths(const SourceFile& file);  ///< no path of one machine

/// `folders` of the root; those that start with a dot or that `ignored` (the text of .gitignore) names do not count.
Violations check_top_level(const std::vector<std::string>& folders, const std::string& ignored);

/// Every file under `root` except in folders that start with a dot (but .ci) or that .gitignore names.
std::vector<SourceFile> project_files(const std::filesystem::path& root);
std::vector<std::string> top_level_folders(const std::filesystem::path& root);
std::string read_text(const std::filesystem::path& file);

}  // namespace aftershade::tests
