#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/camera/camera.h"
#include "core/image/window.h"
#include "core/io/exr_reader.h"
#include "core/io/profile.h"

namespace aftershade::io {

/// The canonical camera from a worldToCamera and a worldToNDC in any producer's convention (conventions 4.4): row or
/// column vectors, +Z or -Z forward, NDC 0..1 y down, 0..1 y up or -1..1 y up, w positive or negative. Lengths become
/// metres. With y up, 0..1 and -1..1 are told apart by the principal point: the lens shifts in x and y, as
/// fractions of the image, must add up to less than a quarter. Throws Error(data) naming the attribute when a matrix is
/// singular or the result is no camera. `note`, if given, receives a warning when focal lengths and pixel aspect
/// disagree by more than 2 %.
Camera normalize_camera(Mat4 world_to_camera, Mat4 world_to_ndc, Window display, float pixel_aspect,
                        double metres_per_unit, std::string* note = nullptr);

/// The camera in a part's header, nullopt when the attributes are not there.
std::optional<Camera> camera_from_header(const ExrReader& file, int part, const CameraAttributes& names,
                                         double metres_per_unit, std::string* note = nullptr);

/// A camera file (aftershade-camera(5)): per frame the two matrices, or a world matrix with focal length and aperture;
/// near, far and unit for all:
///
///   {"unit": "m", "near": 0.1, "far": 1000, "frames": {
///     "1001": {"worldToCamera": [16 numbers], "worldToNDC": [16 numbers]},
///     "1002": {"focal_length_mm": 35, "aperture_width_mm": 36, "cameraToWorld": [16 numbers]}}}
///
/// Matrices are row by row. The pair is what a header holds, in any convention that normalize_camera knows;
/// cameraToWorld is for row vectors (translation in elements 12 to 14), the camera looks along -Z with +Y up, as Maya,
/// Houdini and Blender have it. Throws Error(config) naming file, frame and key.
class CameraFile {
 public:
  explicit CameraFile(const std::string& path);
  static CameraFile parse(std::string_view json, const std::string& path);
  /// The camera of a frame, in metres; Error(no_input) when the file has none for it. `metres_per_unit` is used when
  /// the file states no unit of its own.
  Camera camera(int frame, Window display, float pixel_aspect, double metres_per_unit = 1,
                std::string* note = nullptr) const;
  const std::optional<std::string>& unit() const { return unit_; }

 private:
  CameraFile() = default;
  struct Lens {
    std::optional<Mat4> world_to_camera, world_to_ndc, camera_to_world;
    double focal_length_mm = 0, aperture_width_mm = 0;
  };
  std::string path_;
  std::map<int, Lens> frames_;
  std::optional<double> near_, far_;
  std::optional<std::string> unit_;
};

}  // namespace aftershade::io
