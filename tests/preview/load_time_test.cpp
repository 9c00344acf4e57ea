#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "core/base/text.h"

/// DESIGN 5: the program has no load-time dependency on OpenImageIO, which would cost every process 0.2 s.
namespace aftershade::tests {
namespace {

namespace fs = std::filesystem;

/// The shared objects that the dynamic linker would load for `command`, direct or not: what ldd prints. The linker is
/// asked through the environment, so nothing runs.
std::string shared_objects_of(const std::string& command) {
  const std::string traced = cat("LD_TRACE_LOADED_OBJECTS=1 ", command, " 2>&1");
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(traced.c_str(), "r"), pclose);
  std::string out;
  std::array<char, 4096> buffer{};
  while (pipe && fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) out += buffer.data();
  return out;
}

const fs::path kFolder = fs::path(AFTERSHADE_BINARY_DIR) / "bin";

TEST(LoadTime, ProgramLoadsNeitherOpenImageIoNorOpenColorIo) {
  const fs::path program = kFolder / "aftershade";
  ASSERT_TRUE(fs::exists(program)) << "THE PROGRAM IS MISSING: build the target aftershade";
  const std::string objects = shared_objects_of(cat("'", program.string(), "'"));
  ASSERT_NE(objects.find("libOpenEXR"), std::string::npos) << "the dynamic linker told nothing:\n" << objects;
  for (const char* library : {"libOpenImageIO", "libOpenColorIO", "libopencv", "aftershade-preview"})
    EXPECT_EQ(objects.find(library), std::string::npos) << library << " is loaded with the program:\n" << objects;
}

/// The same question gets the other answer where OpenImageIO is linked; otherwise the test above could not fail.
TEST(LoadTime, ModuleBringsOpenImageIo) {
  const std::string objects =
      shared_objects_of(cat("LD_PRELOAD='", (kFolder / "aftershade-preview.so").string(), "' /bin/true"));
  EXPECT_NE(objects.find("libOpenImageIO"), std::string::npos) << objects;
  EXPECT_NE(objects.find("libOpenColorIO"), std::string::npos) << objects;
}

}  // namespace
}  // namespace aftershade::tests
