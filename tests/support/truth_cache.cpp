#include "tests/support/truth_cache.h"

#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/base/text.h"
#include "core/math/sampling.h"
#include "tests/support/scenes.h"

namespace aftershade::tests {

namespace {
using Size = std::array<int32_t, 3>;  // planes, width, height

void require_small(int width, int height) {
  if (width * height > 240 * 135) throw std::logic_error("truth in tests is at most 240x135 pixels");
}

std::vector<Plane> read_planes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Size size{};
  if (!file.read(reinterpret_cast<char*>(size.data()), sizeof size)) return {};
  std::vector<Plane> planes;
  for (int32_t i = 0; i < size[0]; ++i) {
    Plane plane(size[1], size[2]);
    for (int y = 0; y < plane.height(); ++y)
      file.read(reinterpret_cast<char*>(plane.row(y)), static_cast<std::streamsize>(sizeof(float)) * plane.width());
    planes.push_back(std::move(plane));
  }
  return file ? std::move(planes) : std::vector<Plane>{};
}

/// Written beside and renamed, because several tests may fill the cache at once.
void write_planes(const std::vector<Plane>& planes, const std::string& path) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  const std::string temporary = cat(path, ".", static_cast<int>(getpid()));
  std::ofstream file(temporary, std::ios::binary);
  const Size size{static_cast<int32_t>(planes.size()), planes.at(0).width(), planes.at(0).height()};
  file.write(reinterpret_cast<const char*>(size.data()), sizeof size);
  for (const Plane& plane : planes)
    for (int y = 0; y < plane.height(); ++y)
      file.write(reinterpret_cast<const char*>(plane.row(y)),
                 static_cast<std::streamsize>(sizeof(float)) * plane.width());
  file.close();
  if (file) std::filesystem::rename(temporary, path);
}

/// 128 bits of the text.
std::string hash_of(std::string_view text) {
  std::array<uint32_t, 4> state{1, 2, 3, 4};
  for (char c : text)
    for (uint32_t& word : state) word = mix_bits(word * 0x01000193U + static_cast<unsigned char>(c));
  std::string out;
  for (uint32_t word : state)
    for (int shift = 28; shift >= 0; shift -= 4) out += "0123456789abcdef"[(word >> shift) & 15U];
  return out;
}
}  // namespace

std::string cache_path(const std::string& key) {
  return cat(AFTERSHADE_TRUTH_CACHE "/", hash_of(cat(AFTERSHADE_GENERATOR_HASH, " ", key)), ".planes");
}

std::vector<Plane> cached_planes(const std::string& key, const std::function<std::vector<Plane>()>& make) {
  const std::string path = cache_path(key);
  std::vector<Plane> planes = read_planes(path);
  if (!planes.empty()) return planes;
  planes = make();
  write_planes(planes, path);
  return planes;
}

namespace {
template <class Make>
Plane cached_ao_plane(const char* what, Make&& make, const std::string& scene, double time, int width, int height,
                      const AoTruth& truth) {
  require_small(width, height);
  const std::string key = cat(what, " ", scene, " ", time, " ", width, " ", height, " ", truth.radius_m, " ",
                              static_cast<int>(truth.weighting), " ", static_cast<int>(truth.falloff), " ", truth.rays);
  auto planes = cached_planes(key, [&] {
    std::vector<Plane> made;
    made.push_back(make(find_scene(scene), time, width, height, truth));
    return made;
  });
  return std::move(planes.at(0));
}
}  // namespace

Plane cached_ao_truth(const std::string& scene, double time, int width, int height, const AoTruth& truth) {
  return cached_ao_plane("ao", ambient_occlusion_truth, scene, time, width, height, truth);
}

Plane cached_ao_change(const std::string& scene, double time, int width, int height, const AoTruth& truth) {
  return cached_ao_plane("ao change", ambient_occlusion_change, scene, time, width, height, truth);
}

std::vector<Plane> cached_blur_truth(const std::string& scene, double time, double shutter_frames, int samples,
                                     const RenderSettings& settings) {
  require_small(settings.width, settings.height);
  const std::string key = cat("blur ", scene, " ", time, " ", shutter_frames, " ", samples, " ", settings.width, " ",
                              settings.height, " ", settings.colour_samples);
  return cached_planes(key,
                       [&] { return motion_blur_truth(find_scene(scene), time, shutter_frames, samples, settings); });
}

}  // namespace aftershade::tests
