#include "core/preview/module.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>

namespace aftershade::tests {
namespace {

using namespace preview;
namespace fs = std::filesystem;

std::optional<Error> opening(const fs::path& module) {
  try {
    open_module(std::array{module});
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

TEST(Module, LiesBesideTheExecutable) {
  const auto candidates = module_candidates();
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_TRUE(fs::equivalent(candidates[0], fs::path(AFTERSHADE_BINARY_DIR) / "bin" / "aftershade-preview.so"));
  EXPECT_EQ(candidates[1].parent_path().filename(), "aftershade");  // .../lib/aftershade/aftershade-preview.so
  EXPECT_FALSE(opening(candidates[0]).has_value());
}

TEST(Module, MissingIsAnErrorThatSaysWhatToDo) {
  const auto error = opening("/no/such/folder/aftershade-preview.so");
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code(), ErrorCode::internal);
  EXPECT_NE(error->message().find("/no/such/folder/aftershade-preview.so"), std::string::npos) << error->message();
  EXPECT_NE(error->hint().find("reinstall"), std::string::npos) << error->hint();
}

TEST(Module, OtherFilesAreRefused) {
  const fs::path text = fs::path(testing::TempDir()) / "aftershade-not-a-module.so";
  std::ofstream(text) << "no shared object";
  const auto no_object = opening(text);
  fs::remove(text);
  ASSERT_TRUE(no_object.has_value());
  EXPECT_EQ(no_object->code(), ErrorCode::internal);

  const auto no_table = opening("libm.so.6");  // not a file here; found by the linker it would have no table
  ASSERT_TRUE(no_table.has_value());
  EXPECT_EQ(no_table->code(), ErrorCode::internal);
}

}  // namespace
}  // namespace aftershade::tests
