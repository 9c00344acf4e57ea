#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/camera_attributes.h"
#include "core/io/json.h"
#include "core/io/sequence.h"

namespace aftershade::io {

namespace {

std::optional<Mat4> read_matrix(const JsonReader& frame, const std::string& key) {
  if (!frame.has(key)) return std::nullopt;
  const JsonReader value = frame.required(key);
  const auto elements = value.elements();
  if (elements.size() != 16) value.fail(cat("has ", elements.size(), " numbers; a matrix has 16, row by row"));
  Mat4 out;
  for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = elements[static_cast<size_t>(i)].number();
  return out;
}

double read_positive(const JsonReader& value) {
  const double number = value.number();
  if (!(number > 0)) value.fail(cat(number, " is out of range: must be above 0"));
  return number;
}

/// Camera space that looks along -Z to the canonical one.
Mat4 flip_z() {
  Mat4 out;
  out[2][2] = -1;
  return out;
}

}  // namespace

CameraFile::CameraFile(const std::string& path) { *this = parse(read_text_file(path), path); }

CameraFile CameraFile::parse(std::string_view json, const std::string& path) {
  CameraFile out;
  out.path_ = path;
  const JsonDocument document(json, path);
  const JsonReader root = document.root();
  root.allow({"unit", "near", "far", "frames"});
  root.optional("unit", [&](const JsonReader& v) { out.unit_ = read_unit(v); });
  root.optional("near", [&](const JsonReader& v) { out.near_ = read_positive(v); });
  root.optional("far", [&](const JsonReader& v) { out.far_ = read_positive(v); });
  if (out.near_ && out.far_ && *out.far_ <= *out.near_) root.required("far").fail("must lie beyond near");
  for (const auto& [key, frame] : root.required("frames").members()) {
    const auto number = parse_integer(key);
    if (!number) frame.fail(cat("\"", key, "\" is not a frame number"));
    frame.allow({"worldToCamera", "worldToNDC", "cameraToWorld", "focal_length_mm", "aperture_width_mm"});
    Lens lens{read_matrix(frame, "worldToCamera"), read_matrix(frame, "worldToNDC"),
              read_matrix(frame, "cameraToWorld")};
    frame.optional("focal_length_mm", [&](const JsonReader& v) { lens.focal_length_mm = read_positive(v); });
    frame.optional("aperture_width_mm", [&](const JsonReader& v) { lens.aperture_width_mm = read_positive(v); });
    const bool pair = lens.world_to_camera && lens.world_to_ndc;
    const bool placed_lens = lens.camera_to_world && lens.focal_length_mm > 0 && lens.aperture_width_mm > 0;
    const bool mixed = (lens.world_to_camera || lens.world_to_ndc) &&
                       (lens.camera_to_world || lens.focal_length_mm > 0 || lens.aperture_width_mm > 0);
    if (pair == placed_lens || mixed)
      frame.fail("needs worldToCamera and worldToNDC, or else cameraToWorld, focal_length_mm and aperture_width_mm");
    if (placed_lens && !inverse(*lens.camera_to_world)) frame.required("cameraToWorld").fail("is a singular matrix");
    out.frames_[*number] = lens;
  }
  return out;
}

Camera CameraFile::camera(int frame, Window display, float pixel_aspect, double unit_m, std::string* note) const {
  const auto found = frames_.find(frame);
  if (found == frames_.end()) {
    FrameNumbers numbers;
    for (const auto& [number, lens] : frames_) numbers.push_back(number);
    throw Error(ErrorCode::no_input, cat("camera file \"", path_, "\" has no camera for frame ", frame),
                cat("it has ", format_frames(numbers)));
  }
  const Lens& lens = found->second;
  const double scale = unit_ ? metres_per_unit(*unit_) : unit_m;
  Camera out;
  if (lens.world_to_camera) {
    out = with_context(cat(path_, ": frames.", frame), [&] {
      return normalize_camera(*lens.world_to_camera, *lens.world_to_ndc, display, pixel_aspect, scale, note);
    });
  } else {
    Mat4 view = *inverse(*lens.camera_to_world) * flip_z();
    for (int c = 0; c < 3; ++c) view[3][c] *= scale;
    out.world_to_camera = view;
    out.fx = display.width() * lens.focal_length_mm / lens.aperture_width_mm;  // conventions 4.4
    out.fy = out.fx * pixel_aspect;
    out.cx = display.min_x + 0.5 * display.width();
    out.cy = display.min_y + 0.5 * display.height();
  }
  if (near_) out.near_m = *near_ * scale;
  if (far_) out.far_m = *far_ * scale;
  return out;
}

}  // namespace aftershade::io
