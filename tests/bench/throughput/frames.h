#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

/// The frames that bench_throughput works on.
namespace aftershade::tests::throughput {

struct Size {
  int width = 1920, height = 1080;
};

inline constexpr double kNoiseRms = 0.008;  ///< of display values, gamma 2.2
inline constexpr int kChannels = 10, kBytesPerPixel = 9 * 2 + 4;

/// FOLDER/in.####.exr, numbered from 1.
struct FrameSet {
  std::filesystem::path folder;
  Size size;
  int frames;

  std::filesystem::path path(int number) const;
  int64_t raw_bytes() const;    ///< of one frame's pixels
  double packed_bytes() const;  ///< of one file, in the mean
};

/// Frames 1 to `frames` of the synthetic grass scene, one ray a pixel, with colour noise; R G B A, N.X N.Y N.Z and
/// backward.u backward.v half, Z float, camera matrices in the header, ZIP by OpenEXR's own writer at its default
/// level. What a run before has made in the same way is kept.
void make_frames(const FrameSet& set);

/// Frames 1 to `numbers` as links to those of `set`, there and back again: 1 2 3 2 1 2 3 ...
FrameSet linked_frames(const FrameSet& set, const std::filesystem::path& folder, int numbers);

/// What kind of file system a folder is on, such as "tmpfs"; empty when it is not one in memory.
std::string memory_file_system(const std::filesystem::path& folder);

/// The number in four digits.
std::string four_digits(int number);

}  // namespace aftershade::tests::throughput
