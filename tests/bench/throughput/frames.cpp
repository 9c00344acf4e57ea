#include "tests/bench/throughput/frames.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <half.h>
#include <linux/magic.h>
#include <sys/vfs.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/base/text.h"
#include "core/parallel/rows.h"
#include "tests/support/render.h"
#include "tests/support/scene_files.h"
#include "tests/support/scenes.h"

namespace aftershade::tests::throughput {

namespace fs = std::filesystem;

namespace {

/// The channels of one file, as OpenEXR takes them.
class Channels {
 public:
  explicit Channels(Size size) : size_(size) {}

  /// `value(x, y)` as half.
  template <class Value>
  void add_half(const std::string& name, Value&& value) {
    halves_.emplace_back(fill<half>(value));
    insert(name, Imf::HALF, halves_.back().data(), sizeof(half));
  }
  template <class Value>
  void add_float(const std::string& name, Value&& value) {
    floats_.emplace_back(fill<float>(value));
    insert(name, Imf::FLOAT, floats_.back().data(), sizeof(float));
  }

  void write(Imf::Header header, const fs::path& path) const {
    header.channels() = list_;
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer_);
    file.writePixels(size_.height);
  }

 private:
  template <class Type, class Value>
  std::vector<Type> fill(const Value& value) const {
    std::vector<Type> pixels;
    pixels.reserve(static_cast<size_t>(size_.width) * static_cast<size_t>(size_.height));
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x) pixels.push_back(Type(static_cast<float>(value(x, y))));
    return pixels;
  }
  void insert(const std::string& name, Imf::PixelType type, void* pixels, size_t bytes) {
    list_.insert(name, Imf::Channel(type));
    buffer_.insert(name, Imf::Slice(type, static_cast<char*>(pixels), bytes, bytes * static_cast<size_t>(size_.width)));
  }

  Size size_;
  Imf::ChannelList list_;
  Imf::FrameBuffer buffer_;
  std::vector<std::vector<half>> halves_;  // a moved vector keeps its pixels where they are
  std::vector<std::vector<float>> floats_;
};

/// The perspective camera to OpenEXR's NDC, (0, 0) and (1, 1) being the image's upper left and lower right corners.
Mat4 camera_to_ndc(const Camera& camera, Size size) {
  constexpr double kNear_m = 0.01;  // where NDC depth is 0
  const double w = size.width, h = size.height;
  return {camera.fx / w, 0, 0, 0, 0, -camera.fy / h, 0, 0, camera.cx / w, camera.cy / h, 1, 1, 0, 0, -kNear_m, 0};
}

Imf::Header header_of(const Frame& frame, Size size) {
  Imf::Header header(size.width, size.height);
  const Mat4& world_to_camera = *frame.camera->world_to_camera;
  header.insert("worldToCamera", Imf::M44fAttribute(Imath::M44f(world_to_camera)));
  header.insert("worldToNDC", Imf::M44fAttribute(Imath::M44f(world_to_camera * camera_to_ndc(*frame.camera, size))));
  return header;
}

Channels channels_of(const Frame& frame, Size size) {
  Channels out(size);
  const Layer& beauty = frame.layers.at(0);
  for (size_t c = 0; c < beauty.planes.size(); ++c) out.add_half(beauty.channels[c], beauty.planes[c]);
  out.add_float("Z", [&](int x, int y) { return std::min(frame.depth()(x, y), 1e10F); });
  const Mat4 camera_to_world = inverse(*frame.camera->world_to_camera).value();
  const auto& normal = frame.planes(Role::normal);
  for (const int axis : {0, 1, 2})
    out.add_half(cat("N.", "XYZ"[axis]), [&](int x, int y) {
      return transform_direction(Vec3(normal[0](x, y), normal[1](x, y), normal[2](x, y)), camera_to_world)[axis];
    });
  const auto& velocity = frame.planes(Role::velocity_prev);
  out.add_half("backward.u", velocity[0]);
  out.add_half("backward.v", [&](int x, int y) { return -velocity[1](x, y); });
  return out;
}

void make_frame(const FrameSet& set, int number) {
  const RoleSet roles{Role::depth, Role::normal, Role::velocity_prev};
  Frame frame = render(find_scene("grass"), number, {set.size.width, set.size.height, 1}, roles);
  add_render_noise(frame, kNoiseRms);
  channels_of(frame, set.size).write(header_of(frame, set.size), set.path(number));
}

/// What the frames in a folder were made from.
std::string recipe(const FrameSet& set) {
  return cat("grass ", set.size.width, "x", set.size.height, ", ", set.frames, " frames, noise ", kNoiseRms, "\n");
}

}  // namespace

std::string four_digits(int number) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "%04d", number);
  return digits;
}

fs::path FrameSet::path(int number) const { return folder / ("in." + four_digits(number) + ".exr"); }

int64_t FrameSet::raw_bytes() const { return int64_t{kBytesPerPixel} * size.width * size.height; }

double FrameSet::packed_bytes() const {
  double sum = 0;
  for (int number = 1; number <= frames; ++number) sum += static_cast<double>(fs::file_size(path(number)));
  return sum / frames;
}

void make_frames(const FrameSet& set) {
  const fs::path note = set.folder / "recipe.txt";
  std::ifstream made(note);
  if (std::string(std::istreambuf_iterator<char>(made), {}) == recipe(set)) return;
  fs::remove_all(set.folder);
  fs::create_directories(set.folder);
  constexpr int kAtOnce = 4;  // each takes memory
  for (int first = 1; first <= set.frames; first += kAtOnce)
    for_rows(std::min(kAtOnce, set.frames - first + 1), [&](int i) { make_frame(set, first + i); });
  std::ofstream(note) << recipe(set);
}

FrameSet linked_frames(const FrameSet& set, const fs::path& folder, int numbers) {
  const FrameSet links{folder, set.size, numbers};
  fs::remove_all(folder);
  fs::create_directories(folder);
  const int period = std::max(2 * (set.frames - 1), 1);
  for (int i = 0; i < numbers; ++i) {
    const int step = i % period, number = 1 + std::min(step, period - step);
    fs::create_symlink(fs::absolute(set.path(number)), links.path(i + 1));
  }
  return links;
}

std::string memory_file_system(const fs::path& folder) {
  struct statfs status {};
  if (::statfs(folder.c_str(), &status) != 0) return "";
  if (status.f_type == TMPFS_MAGIC) return "tmpfs";
  return status.f_type == RAMFS_MAGIC ? "ramfs" : "";
}

}  // namespace aftershade::tests::throughput
