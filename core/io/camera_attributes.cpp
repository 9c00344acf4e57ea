#include "core/io/camera_attributes.h"

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::io {

namespace {

[[noreturn]] void refuse(std::string_view what) {
  throw Error(ErrorCode::data, std::string(what),
              "render the frame again with a camera, or give --camera FILE or --fov");
}

double largest(const Mat4& m) {
  double out = 0;
  for (int i = 0; i < 16; ++i) out = std::fmax(out, std::abs(m[i / 4][i % 4]));
  return out;
}

bool is_finite(const Mat4& m) {
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(m[i / 4][i % 4])) return false;
  return true;
}

/// Is this a rigid or scaled placement for row vectors: last column (0 0 0 1)?
bool is_affine(const Mat4& m) {
  const double tolerance = 1e-6 * std::fmax(1.0, largest(m));
  return std::abs(m[0][3]) + std::abs(m[1][3]) + std::abs(m[2][3]) <= tolerance && std::abs(m[3][3] - 1) <= 1e-6;
}

/// Camera space to NDC, for row vectors: x' = X fx + Z sx + tx, w = X .. + Z p + q. The depth column is arbitrary.
struct Lens {
  Mat4 view;        ///< world to the producer's camera space
  Mat4 projection;  ///< that space to NDC
};

/// How far `p` is from mapping X to x only and Y to y only, relative to the focal lengths.
double lens_error(const Mat4& p) {
  const double scale = std::fmin(std::abs(p[0][0]), std::abs(p[1][1]));
  if (!(scale > 0)) return INFINITY;
  return (std::abs(p[0][1]) + std::abs(p[1][0]) + std::abs(p[0][3]) + std::abs(p[1][3])) / scale;
}

std::optional<Lens> as_lens(const Mat4& view, const Mat4& ndc) {
  const auto camera_to_world = inverse(view);
  if (!camera_to_world || !is_affine(view)) return std::nullopt;
  return Lens{view, *camera_to_world * ndc};
}

/// The pair as row vectors, whichever way it is stored. A camera at the world's origin has no translation that could
/// tell, so the reading with the better lens is taken.
Lens find_lens(const Mat4& view, const Mat4& ndc) {
  if (!is_finite(view)) refuse("worldToCamera holds a number that is not finite");
  if (!is_finite(ndc)) refuse("worldToNDC holds a number that is not finite");
  if (!inverse(view)) refuse("worldToCamera is a singular matrix");
  const auto rows = as_lens(view, ndc), columns = as_lens(view.transposed(), ndc.transposed());
  if (!rows && !columns) refuse("worldToCamera is no camera position: it has a perspective part");
  const bool use_columns = columns && (!rows || lens_error(columns->projection) < lens_error(rows->projection));
  const Lens& lens = use_columns ? *columns : *rows;
  const double error = lens_error(lens.projection);
  if (std::isinf(error)) refuse("worldToNDC is a singular matrix");
  // Single precision leaves about 1e-4 where the camera is far from the origin.
  if (error > 0.02) refuse("worldToNDC and worldToCamera do not belong to the same camera");
  return lens;
}

/// Where NDC lies on the image along one axis: position in pixels = origin + scale * ndc.
struct Axis {
  double origin, scale;
};
struct Axes {
  Axis x, y;
};

/// NDC range from the signs and the principal point (cx, cy): y down is 0..1, y up may be either (conventions 4.4).
Axes axes_of(double fy, double cx, double cy, Window display) {
  const double w = display.width(), h = display.height(), left = display.min_x, top = display.min_y;
  if (fy < 0) return {{left, w}, {top, h}};
  const bool unit_range = std::hypot(cx - 0.5, cy - 0.5) < std::hypot(cx, cy);
  if (unit_range) return {{left, w}, {top + h, -h}};
  return {{left + w / 2, w / 2}, {top + h / 2, -h / 2}};
}

void check_aspect(const Camera& camera, float pixel_aspect, std::string* note) {
  const double ratio = camera.fy / camera.fx;
  if (note && std::abs(ratio - pixel_aspect) > 0.02 * pixel_aspect)
    *note = cat("the camera's focal lengths (", fixed(camera.fx, 2), " and ", fixed(camera.fy, 2),
                " px) do not fit the pixel aspect ", pixel_aspect, ": its matrices may belong to another window");
}

}  // namespace

Camera normalize_camera(Mat4 world_to_camera, Mat4 world_to_ndc, Window display, float pixel_aspect,
                        double metres_per_unit, std::string* note) {
  auto [view, p] = find_lens(world_to_camera, world_to_ndc);
  Camera camera;
  camera.orthographic = std::abs(p[2][3]) <= 1e-4 * std::abs(p[3][3]);  // else single precision leaves no exact 0
  // A right-handed world seen along +Z has a left-handed camera. Otherwise the camera looks along -Z, unless w grows
  // along +Z: then it is the world that is left-handed.
  const bool looks_along_minus_z = determinant3(view) > 0 && (camera.orthographic || p[2][3] < 0);
  const double forward = looks_along_minus_z ? -1 : 1;
  // |w| at unit distance: Mantra stores w = -z and means the image that division by z gives.
  const double w = std::abs(camera.orthographic ? p[3][3] : p[2][3]);
  if (!(w > 0)) refuse("worldToNDC is a singular matrix");
  const double fx = p[0][0] / w, fy = p[1][1] / w;
  const double cx = (camera.orthographic ? p[3][0] : forward * p[2][0]) / w;
  const double cy = (camera.orthographic ? p[3][1] : forward * p[2][1]) / w;
  const Axes axes = axes_of(fy, cx, cy, display);
  camera.fx = std::abs(axes.x.scale * fx);
  camera.fy = std::abs(axes.y.scale * fy);
  camera.cx = axes.x.origin + axes.x.scale * cx;
  camera.cy = axes.y.origin + axes.y.scale * cy;
  if (!std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy)) refuse("worldToNDC gives no finite focal length");
  Mat4 flip;
  flip[0][0] = fx < 0 ? -1 : 1;  // a camera space with +X left
  flip[2][2] = forward;
  view = view * flip;
  for (int c = 0; c < 3; ++c) view[3][c] *= metres_per_unit;
  if (camera.orthographic) camera.fx /= metres_per_unit, camera.fy /= metres_per_unit;
  camera.world_to_camera = view;
  check_aspect(camera, pixel_aspect, note);
  return camera;
}

namespace {

std::optional<Mat4> find_matrix(const ExrReader& file, int part, const std::string& pattern, std::string& found_name) {
  for (const std::string& name : file.attribute_names(part)) {
    if (!glob_match(pattern, name)) continue;
    found_name = name;
    if (auto matrix = file.matrix(part, name)) return matrix;
    throw Error(ErrorCode::data, cat("the attribute ", name, " is not a matrix"), "m44f or m44d is expected");
  }
  return std::nullopt;
}

}  // namespace

std::optional<Camera> camera_from_header(const ExrReader& file, int part, const CameraAttributes& names,
                                         double metres_per_unit, std::string* note) {
  std::string view_name, ndc_name;
  const auto view = find_matrix(file, part, names.world_to_camera, view_name);
  const auto ndc = find_matrix(file, part, names.world_to_ndc, ndc_name);
  if (!view || !ndc) return std::nullopt;
  return with_context(cat("attributes ", view_name, " and ", ndc_name), [&] {
    return normalize_camera(*view, *ndc, file.info().display_window, file.info().pixel_aspect, metres_per_unit, note);
  });
}

}  // namespace aftershade::io
