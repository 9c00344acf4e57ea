#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "app/manual.h"
#include "core/base/error.h"

namespace aftershade::app {
namespace {

const std::string kRoot = AFTERSHADE_SOURCE_DIR "/";

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

class Document : public testing::TestWithParam<const char*> {};

/// A committed document is what the tables produce. AFTERSHADE_UPDATE_DOCUMENTS=1 rewrites it.
TEST_P(Document, HoldsWhatTheTablesProduce) {
  const std::string path = kRoot + GetParam();
  const std::string committed = read(path);
  ASSERT_NE(committed.find("BEGIN GENERATED "), std::string::npos) << path;
  const std::string fresh = with_generated_parts(committed);
  if (std::getenv("AFTERSHADE_UPDATE_DOCUMENTS")) std::ofstream(path, std::ios::binary) << fresh;
  EXPECT_TRUE(committed == fresh || std::getenv("AFTERSHADE_UPDATE_DOCUMENTS"))
      << path << " is stale: run AFTERSHADE_UPDATE_DOCUMENTS=1 build/bin/test_documents";
}
INSTANTIATE_TEST_SUITE_P(All, Document, testing::Values("man/aftershade.1", "man/aftershade-preset.5", "README.md"),
                         [](const auto& param) {
                           std::string name = param.param;
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

TEST(GeneratedParts, ReplaceWhatStandsBetweenTheMarks) {
  const std::string old = "a\n.\\\" BEGIN GENERATED exit status\nstale\n.\\\" END GENERATED\nb\n";
  const std::string fresh = with_generated_parts(old);
  EXPECT_EQ(fresh.find("stale"), std::string::npos);
  EXPECT_NE(fresh.find(".B 64"), std::string::npos);
  EXPECT_EQ(with_generated_parts(fresh), fresh);
  EXPECT_TRUE(fresh.starts_with("a\n") && fresh.ends_with("\nb\n"));
}

TEST(GeneratedParts, UnknownNameIsAnError) { EXPECT_THROW(generated_part("nonsense"), Error); }

/// The arguments of a macro are in quotes: a quote within would end them and be printed.
TEST(GeneratedParts, HeadsOfParametersHaveNoQuotesWithin) {
  std::istringstream lines(generated_part("methods"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(".BR ")) {
      EXPECT_EQ(std::ranges::count(line, '"'), 2) << line;
    }
  }
}

TEST(Manual, EveryCommandHasItsOptionsInThePage) {
  const std::string page = read(kRoot + "man/aftershade.1");
  for (const CommandText& command : command_texts())
    EXPECT_NE(page.find("BEGIN GENERATED options " + command.name + "\n"), std::string::npos) << command.name;
}

}  // namespace
}  // namespace aftershade::app
