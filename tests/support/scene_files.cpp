#include "tests/support/scene_files.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/io/exr_writer.h"
#include "core/math/sampling.h"

namespace aftershade::tests {

namespace {
using io::PixelType;
constexpr double kNear_m = 0.01;  // where NDC depth is 0

/// The channels of a file, with the planes they refer to.
class FileBuilder {
 public:
  explicit FileBuilder(const Frame& frame) {
    file_.display_window = frame.display;
    file_.data_window = frame.window;
  }
  void add(const std::string& name, PixelType type, ConstPlaneView pixels) {
    file_.channels.push_back({name, type, pixels});
  }
  /// A channel computed from pixel coordinates; the plane is kept until the file is written.
  template <class Value>
  void add_computed(const std::string& name, PixelType type, Value&& value) {
    Plane plane(file_.data_window.width(), file_.data_window.height());
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) plane(x, y) = static_cast<float>(value(x, y));
    kept_.push_back(std::move(plane));
    add(name, type, kept_.back());
  }
  io::NewFile& file() { return file_; }

 private:
  io::NewFile file_;
  std::vector<Plane> kept_;  // a moved Plane keeps its pixels where they are
};

/// Camera space to OpenEXR's NDC: (0, 0) and (1, 1) are the display window's upper left and lower right corners.
Mat4 camera_to_ndc(const Camera& camera, const Window& display) {
  const double w = display.width(), h = display.height();
  const double sx = camera.fx / w, sy = -camera.fy / h;
  const double x0 = (camera.cx - display.min_x) / w, y0 = (camera.cy - display.min_y) / h;
  if (camera.orthographic) return Mat4(sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, 1, 0, x0, y0, 0, 1);
  return Mat4(sx, 0, 0, 0, 0, sy, 0, 0, x0, y0, 1, 1, 0, 0, -kNear_m, 0);
}

void add_normals(FileBuilder& builder, const Frame& frame) {
  const Mat4 camera_to_world = inverse(*frame.camera->world_to_camera).value();
  const auto& normal = frame.planes(Role::normal);
  constexpr std::array<const char*, 3> names{"N.X", "N.Y", "N.Z"};
  for (int axis = 0; axis < 3; ++axis)
    builder.add_computed(names[static_cast<size_t>(axis)], PixelType::half, [&](int x, int y) {
      return transform_direction(Vec3(normal[0](x, y), normal[1](x, y), normal[2](x, y)), camera_to_world)[axis];
    });
}

void add_velocity(FileBuilder& builder, const std::string& layer, const std::vector<Plane>& mv) {
  builder.add(layer + ".u", PixelType::single, mv[0]);
  builder.add_computed(layer + ".v", PixelType::single, [&](int x, int y) { return -mv[1](x, y); });
}

/// Zero mean, unit variance: the sum of twelve uniform numbers, less its mean.
double gaussian_like(int x, int y, int frame, int channel) {
  double sum = -6;
  for (uint32_t i = 0; i < 12; ++i)
    sum += static_cast<double>(
        unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(frame),
                                 16 * static_cast<uint32_t>(channel) + i)));
  return sum;
}
}  // namespace

void add_render_noise(Frame& frame, double rms) {
  constexpr double kGamma = 2.2;
  for (int c = 0; c < 3; ++c) {
    Plane& plane = frame.layers.at(0).planes.at(static_cast<size_t>(c));
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) {
        const double display =
            std::pow(std::max(0.0F, plane(x, y)), 1 / kGamma) + rms * gaussian_like(x, y, frame.number, c);
        plane(x, y) = static_cast<float>(std::pow(std::max(0.0, display), kGamma));
      }
  }
}

void write_scene_file(const Frame& frame, const std::string& path) {
  FileBuilder builder(frame);
  const Layer& beauty = frame.layers.at(0);
  for (size_t c = 0; c < beauty.planes.size(); ++c) builder.add(beauty.channels[c], PixelType::half, beauty.planes[c]);
  for (const auto& [role, name] : {std::pair{Role::depth, "Z"}, {Role::depth2, "depth2.Z"}})
    if (frame.has(role))
      builder.add_computed(name, PixelType::single,
                           [&plane = frame.planes(role)[0]](int x, int y) { return std::min(plane(x, y), 1e10F); });
  add_normals(builder, frame);
  add_velocity(builder, "forward", frame.planes(Role::velocity_next));
  add_velocity(builder, "backward", frame.planes(Role::velocity_prev));
  constexpr std::array<const char*, 3> ambient{"diffuse_indirect.R", "diffuse_indirect.G", "diffuse_indirect.B"};
  for (size_t c = 0; c < 3; ++c) builder.add(ambient[c], PixelType::half, frame.planes(Role::ambient)[c]);
  const Mat4& world_to_camera = *frame.camera->world_to_camera;
  builder.file().matrices = {{"worldToCamera", world_to_camera},
                             {"worldToNDC", world_to_camera * camera_to_ndc(*frame.camera, frame.display)}};
  io::write_new_exr(builder.file(), path);
}

void write_ao_file(const Frame& frame, ConstPlaneView ao, const std::string& path) {
  FileBuilder builder(frame);
  builder.add("AO", PixelType::half, ao);
  io::write_new_exr(builder.file(), path);
}

void write_color_file(const Frame& frame, const std::vector<Plane>& rgba, const std::string& path) {
  FileBuilder builder(frame);
  constexpr std::array<const char*, 4> names{"R", "G", "B", "A"};
  for (size_t c = 0; c < rgba.size(); ++c) builder.add(names[c], PixelType::half, rgba[c]);
  io::write_new_exr(builder.file(), path);
}

}  // namespace aftershade::tests
