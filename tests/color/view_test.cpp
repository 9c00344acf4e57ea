#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/base/error.h"
#include "core/color/display.h"

namespace aftershade::tests {
namespace {

namespace fs = std::filesystem;
using color::DisplayOptions;
using color::DisplayTransform;

std::array<float, 3> shown(const DisplayOptions& options, std::array<float, 3> rgb) {
  std::array<Plane, 3> planes{Plane(1, 1, rgb[0]), Plane(1, 1, rgb[1]), Plane(1, 1, rgb[2])};
  DisplayTransform(options).apply(std::array<PlaneView, 3>{planes[0], planes[1], planes[2]});
  return {planes[0](0, 0), planes[1](0, 0), planes[2](0, 0)};
}

/// What leaves a constructor with these options: its error, or an empty text.
std::optional<Error> error_of(const DisplayOptions& options) {
  try {
    const DisplayTransform made(options);
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

/// A file in a folder of its own, since tests run side by side, that goes with the object.
class ConfigFile {
 public:
  explicit ConfigFile(const std::string& text) {
    std::string folder = (fs::path(testing::TempDir()) / "view_test.XXXXXX").string();
    path_ = std::string(mkdtemp(folder.data())) + "/view_test.ocio";
    std::ofstream(path_) << text;
  }
  ~ConfigFile() { fs::remove_all(fs::path(path_).parent_path()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// Two displays: on the first "Half" halves the values and "Same" keeps them; "Quarter" is the second's alone.
constexpr char kConfig[] = R"(ocio_profile_version: 2
roles:
  default: linear
  scene_linear: linear
displays:
  screen:
    - !<View> {name: Half, colorspace: half}
    - !<View> {name: Same, colorspace: linear}
  wall:
    - !<View> {name: Quarter, colorspace: quarter}
    - !<View> {name: Half, colorspace: quarter}
colorspaces:
  - !<ColorSpace>
    name: linear
  - !<ColorSpace>
    name: half
    from_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: quarter
    from_scene_reference: !<MatrixTransform> {matrix: [0.25, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 1]}
)";

TEST(View, DefaultIsWhatToDisplayShows) {
  for (const float value : {-1.0F, 0.0F, 0.002F, 0.18F, 0.7F, 1.0F, 9.0F}) {
    std::array<Plane, 3> planes{Plane(1, 1, value), Plane(1, 1, value), Plane(1, 1, value)};
    color::to_display(std::array<PlaneView, 3>{planes[0], planes[1], planes[2]});
    EXPECT_EQ(shown({}, {value, value, value})[0], planes[0](0, 0)) << value;
  }
  EXPECT_EQ(DisplayTransform({}).name(), "sRGB");
}

TEST(View, RawClampsOnly) { EXPECT_EQ(shown({"", "Raw"}, {-0.5F, 0.25F, 3.0F}), (std::array{0.0F, 0.25F, 1.0F})); }

// ACES 1.0: the reference rendering takes 18 % grey to 4.8 nit on a cinema screen of 48 nit white and 0.02 nit black;
// video's dim surround raises (4.8 - 0.02) / (48 - 0.02) to the power 0.9811, and sRGB encodes that as 0.356.
TEST(View, AcesPutsMiddleGreyAtATenthOfDisplayLight) {
  const auto grey = shown({"", "ACES 1.0 SDR"}, {0.18F, 0.18F, 0.18F});
  for (const float value : grey) EXPECT_NEAR(value, 0.356F, 0.001F);
  const auto bright = shown({"", "ACES 1.0 SDR"}, {4.0F, 4.0F, 4.0F});
  EXPECT_GT(bright[1], 0.9F);
  EXPECT_LT(bright[1], 1.0F);
}

TEST(View, NothingThatIsNotANumberGetsThrough) {
  constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
  for (const char* view : {"sRGB", "ACES 1.0 SDR", "Raw"})
    for (const float value : shown({"", view}, {kInf, -kInf, kNan})) {
      EXPECT_GE(value, 0.0F) << view;
      EXPECT_LE(value, 1.0F) << view;
    }
}

TEST(View, UnknownNameListsTheViews) {
  const auto error = error_of({"", "Raww"});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::usage);
  EXPECT_EQ(error->message(), "there is no view \"Raww\" in the built-in configuration");
  EXPECT_EQ(error->hint(), "did you mean \"Raw\"? there are: sRGB, ACES 1.0 SDR, Raw");
}

TEST(View, OfAFileByNameDisplayOrDefault) {
  const ConfigFile file(kConfig);
  const auto red = [&](const char* view) { return shown({file.path(), view}, {0.5F, 0, 0})[0]; };
  EXPECT_FLOAT_EQ(red(""), 0.25F);
  EXPECT_FLOAT_EQ(red("Half"), 0.25F) << "the default display's goes first";
  EXPECT_FLOAT_EQ(red("Same"), 0.5F);
  EXPECT_FLOAT_EQ(red("Quarter"), 0.125F) << "a view that only another display has";
  EXPECT_FLOAT_EQ(red("wall/Half"), 0.125F);
  EXPECT_EQ(DisplayTransform({file.path(), ""}).name(), "screen/Half (view_test.ocio)");
  const auto error = error_of({file.path(), "None"});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::usage);
  EXPECT_EQ(error->hint(), "there are: Half, Same, wall/Quarter, wall/Half");
}

TEST(View, FilesThatCannotBeUsed) {
  EXPECT_EQ(error_of({"/no/such/config.ocio", ""})->code(), ErrorCode::no_input);
  const ConfigFile file("this is not OpenColorIO\n");
  EXPECT_EQ(error_of({file.path(), ""})->code(), ErrorCode::config);
}

TEST(View, EnvironmentChangesNothing) {
  const auto before = shown({}, {0.18F, 0.5F, 0.02F});
  setenv("OCIO", "/no/such/config.ocio", 1);
  setenv("OCIO_ACTIVE_VIEWS", "None", 1);
  EXPECT_EQ(shown({}, {0.18F, 0.5F, 0.02F}), before);
  unsetenv("OCIO");
  unsetenv("OCIO_ACTIVE_VIEWS");
}

}  // namespace
}  // namespace aftershade::tests
