#include "tests/rules/rules.h"

#include <gtest/gtest.h>

namespace aftershade::tests {
namespace {

/// Every file of the project through one rule.
Violations violations(Violations (*rule)(const SourceFile&)) {
  static const std::vector<SourceFile> files = project_files(AFTERSHADE_SOURCE_DIR);
  EXPECT_GT(files.size(), 100U) << "the project's files were not found in " AFTERSHADE_SOURCE_DIR;
  Violations out;
  for (const SourceFile& file : files)
    for (std::string& violation : rule(file)) out.push_back(std::move(violation));
  return out;
}

std::string lines(const Violations& violations) {
  std::string out;
  for (const std::string& violation : violations) out += violation + "\n";
  return out;
}

TEST(House, IncludesRunDownwards) { EXPECT_EQ(lines(violations(check_floors)), ""); }
TEST(House, LibrariesStayInTheirFolders) { EXPECT_EQ(lines(violations(check_libraries)), ""); }
TEST(House, FilesHaveAtMost400Lines) { EXPECT_EQ(lines(violations(check_file_length)), ""); }
TEST(House, FunctionsHaveAtMost60Lines) { EXPECT_EQ(lines(violations(check_functions)), ""); }
TEST(House, NoFunctionLikeMacros) { EXPECT_EQ(lines(violations(check_macros)), ""); }
TEST(House, NoPathsOfOneMachine) { EXPECT_EQ(lines(violations(check_machine_paths)), ""); }
TEST(House, TopLevelIsFixed) {
  const std::filesystem::path root(AFTERSHADE_SOURCE_DIR);
  EXPECT_EQ(lines(check_top_level(top_level_folders(root), read_text(root / ".gitignore"))), "");
}

// The rules themselves, on small bad samples: that a check can be seen to fail.

TEST(Floors, UpwardsSidewaysAndUnknown) {
  const auto check = [](const std::string& path, const std::string& include) {
    return lines(check_floors({path, "#include \"" + include + "\"\n"}));
  };
  EXPECT_EQ(check("core/ao/x.cpp", "core/filter/y.h"), "");
  EXPECT_EQ(check("core/ao/x.cpp", "core/ao/y.h"), "");
  EXPECT_EQ(check("core/image/x.cpp", "core/camera/camera.h"), "");
  EXPECT_EQ(check("tests/ao/x.cpp", "app/y.h"), "");
  EXPECT_EQ(check("core/ao/x.cpp", "core/preset/y.h"),
            "core/ao/x.cpp:1: #include \"core/preset/y.h\" runs upwards from core/ao\n");
  EXPECT_EQ(check("core/io/x.h", "core/filter/y.h"),
            "core/io/x.h:1: #include \"core/filter/y.h\" runs sideways from core/io\n");
  EXPECT_EQ(check("core/pipeline/x.h", "app/y.h"),
            "core/pipeline/x.h:1: #include \"app/y.h\" runs upwards from core/pipeline\n");
  EXPECT_EQ(check("core/base/x.h", "tests/support/y.h"),
            "core/base/x.h:1: #include \"tests/support/y.h\" tests is not for core/base\n");
  EXPECT_EQ(check("core/attic/x.h", "core/base/y.h"),
            "core/attic/x.h:1: #include \"core/base/y.h\" core/attic is on no floor\n");
  EXPECT_EQ(check("core/base/x.cpp", "error.h"),
            "core/base/x.cpp:1: #include \"error.h\" is not written from the root\n");
}

TEST(Libraries, OutsideTheirFolders) {
  const auto check = [](const std::string& path, const std::string& include) {
    return lines(check_libraries({path, "\n#  include " + include + "\n"}));
  };
  EXPECT_EQ(check("core/io/x.cpp", "<ImfHeader.h>"), "");
  EXPECT_EQ(check("tests/support/x.cpp", "<OpenEXR/ImfHeader.h>"), "");
  EXPECT_EQ(check("core/math/x.h", "<ImathVec.h>"), "");
  EXPECT_EQ(check("core/params/x.h", "<nlohmann/json.hpp>"), "");
  EXPECT_EQ(check("app/x.h", "<CLI/CLI.hpp>"), "");
  EXPECT_EQ(check("core/ao/x.cpp", "<ImfHeader.h>"), "core/ao/x.cpp:2: OpenEXR is not for this folder\n");
  EXPECT_EQ(check("core/ao/x.cpp", "<OpenEXR/ImfHeader.h>"), "core/ao/x.cpp:2: OpenEXR is not for this folder\n");
  EXPECT_EQ(check("core/pipeline/x.cpp", "<nlohmann/json.hpp>"),
            "core/pipeline/x.cpp:2: nlohmann-json is not for this folder\n");
  EXPECT_EQ(check("tests/cli/x.cpp", "\"CLI/CLI.hpp\""), "tests/cli/x.cpp:2: CLI11 is not for this folder\n");
  EXPECT_EQ(check("app/x.cpp", "<OpenImageIO/imageio.h>"), "app/x.cpp:2: OpenImageIO is not for this folder\n");
}

TEST(Includes, InCommentsAndStringsDoNotCount) {
  EXPECT_EQ(check_floors({"core/base/x.cpp", "// #include \"app/y.h\"\nauto t = R\"(\n#include \"app/y.h\"\n)\";\n"}),
            Violations{});
  EXPECT_EQ(check_floors({"core/base/x.cpp", "/*\n*/ int a;\n#include \"app/y.h\" // why\n"}).size(), 1U);
}

TEST(FileLength, FourHundredAndOne) {
  EXPECT_TRUE(check_file_length({"core/base/x.cpp", std::string(400, '\n')}).empty());
  EXPECT_EQ(lines(check_file_length({"tests/x/x.cpp", std::string(401, '\n')})),
            "tests/x/x.cpp: has 401 lines; 400 are the limit\n");
  EXPECT_FALSE(check_file_length({"tests/run.sh", std::string(401, '\n')}).empty());
  EXPECT_TRUE(check_file_length({"configs/preset.schema.json", std::string(401, '\n')}).empty());
}

TEST(Macros, FunctionLikeOnes) {
  EXPECT_TRUE(check_macros({"core/base/x.h", "#define WIDTH (3)\n#pragma once\n// #define F(x)\n"}).empty());
  EXPECT_EQ(lines(check_macros({"core/base/x.h", "  # define MAX(a, b) a\n"})),
            "core/base/x.h: defines the macro MAX()\n");
  EXPECT_FALSE(check_macros({"app/x.cpp", "int a;\n#define F() a\n"}).empty());
  EXPECT_TRUE(check_macros({"tests/x/x.cpp", "#define F() a\n"}).empty());
}

TEST(MachinePaths, AreFound) {
  const std::string home = std::string("/") + "home/";
  EXPECT_EQ(lines(check_machine_paths({"README.md", "see\n" + home + "me/x"})),
            "README.md:2: names a path of one machine: " + home + "me/x\n");
  EXPECT_FALSE(check_machine_paths({"x.sh", std::string("cd \"/") + "work/main\""}).empty());
  EXPECT_TRUE(check_machine_paths({"x.sh", "cd ../work/main $HOME/root/x https://a.org/home/x"}).empty());
}

TEST(TopLevel, OtherFoldersAreFound) {
  const std::string ignored = "/build*/\n/out/\n";
  EXPECT_TRUE(check_top_level({"app", "core", ".git", "build", "build-asan", "out"}, ignored).empty());
  EXPECT_EQ(lines(check_top_level({"tools"}, ignored)),
            "tools/ is no room of the house: app, core, configs, tests, examples, man\n");
}

}  // namespace
}  // namespace aftershade::tests
