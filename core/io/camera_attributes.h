#pragma once
#include <map>
#include <optional>
#include <string>

#include "core/camera/camera.h"
#include "core/image/window.h"
#include "core/io/exr_reader.h"
#include "core/io/profile.h"

namespace aftershade::io {

/// The canonical camera from a worldToCamera and a worldToNDC in any producer's convention (conventions 4.4): row or
/// column vectors, +Z or -Z forward, NDC 0..1 y down, 0..1 y up or -1..1 y up, w positive or negative. Lengths become
/// metres. Throws Error(data) naming the attribute when a matrix is singular or the result is no camera.
Camera normalize_camera(Mat4 world_to_camera, Mat4 world_to_ndc, Window display, float pixel_aspect,
                        double metres_per_unit);

/// The camera in a part's header, nullopt when the attributes are not there.
std::optional<Camera> camera_from_header(const ExrReader& file, int part, const CameraAttributes& names,
                                         double metres_per_unit);

/// A camera file (aftershade-camera(5)): per frame the two matrices, or a world matrix with focal length and aperture;
/// near, far and unit for all. Throws Error(config) naming file, frame and key.
class CameraFile {
 public:
  explicit CameraFile(const std::string& path);
  /// The camera of a frame; Error(no_input) when the file has none for it.
  Camera camera(int frame, Window display, float pixel_aspect) const;
  const std::optional<std::string>& unit() const { return unit_; }

 private:
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
