#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <limits>

#include "core/base/error.h"
#include "core/io/file_source.h"

/// Sequences of small frames on disk, for tests of FileSource.
namespace aftershade::io {

namespace fs = std::filesystem;

inline constexpr float kInf = std::numeric_limits<float>::infinity();

/// One small frame on disk, described by its channels' constant values.
struct Picture {
  Window display{0, 0, 7, 5}, data{0, 0, 7, 5};
  std::vector<std::pair<std::string, float>> channels{{"R", 0.5F}, {"G", 0.25F}, {"B", 0.125F}, {"A", 1}, {"Z", 2}};
  std::vector<std::pair<std::string, Mat4>> matrices{};
};

class FileSourceTest : public ::testing::Test {
 protected:
  FileSourceTest() : folder_(fs::path(::testing::TempDir()) / ("file_source_" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~FileSourceTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const Picture& picture,
             const std::function<void(const std::string&, Plane&)>& edit = {}) const {
    std::vector<Plane> planes;
    NewFile file{.display_window = picture.display,
                 .data_window = picture.data,
                 .channels = {},
                 .matrices = picture.matrices,
                 .texts = {}};
    for (const auto& [channel, value] : picture.channels) {
      planes.emplace_back(picture.data.width(), picture.data.height(), value);
      if (edit) edit(channel, planes.back());
    }
    for (size_t i = 0; i < planes.size(); ++i)
      file.channels.push_back({picture.channels[i].first, PixelType::single, planes[i]});
    write_new_exr(file, path(name));
  }
  SourceOptions options(const std::string& pattern = "a.####.exr", const char* profile = "generic") const {
    SourceOptions out;
    out.sequence = find_sequence(path(pattern), HashDigits::one).sequence;
    out.profile = load_profile(profile);
    return out;
  }
  static std::string message(const std::function<void()>& work, ErrorCode code) {
    try {
      work();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    return "accepted";
  }
  static void expect_has(const std::string& text, std::initializer_list<const char*> pieces) {
    for (const char* piece : pieces) EXPECT_NE(text.find(piece), std::string::npos) << piece << " in: " << text;
  }
  fs::path folder_;
};

}  // namespace aftershade::io
