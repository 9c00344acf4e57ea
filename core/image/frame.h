#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/camera.h"
#include "core/image/plane.h"
#include "core/image/role.h"
#include "core/image/window.h"

namespace aftershade {

/// Channels that an effect changes together, such as the beauty's R, G, B and A: scene-linear, premultiplied.
struct Layer {
  std::string name;                   ///< "" for the beauty, else the layer's name in the file
  std::vector<std::string> channels;  ///< full channel names in the file, one a plane
  std::vector<Plane> planes;          ///< all of the frame's window; 0 where the file has no pixel
  int alpha = -1;                     ///< index of the alpha plane, or -1
  int part = 0;                       ///< the part of the file that holds it
  Window data_window;                 ///< of that part: the pixels that are written; blur may let it grow
  bool receives_ao = false;
  bool receives_blur = false;
  bool is_beauty = false;
  bool changed = false;  ///< a stage has changed its pixels
};

/// What a source keeps of a frame's file for the sink, such as decoded bytes.
struct FileData {
  virtual ~FileData() = default;
};

/// What stages find out about a frame as it was read (core/pipeline/geometry.h), for all presets that run on it.
struct SharedData {
  virtual ~SharedData() = default;
};

/// One view of one frame: what effects read (roles), what they change (layers), what they add (added).
/// All planes cover `window`; index (0, 0) is absolute pixel (window.min_x, window.min_y). Effects align frames by
/// absolute coordinates, because windows move.
struct Frame {
  int number = 0;
  std::string view;  ///< "" when the file has no views
  int part = 0;      ///< the part of the file that added channels go to: the beauty's
  Window window;  ///< union of the data windows of the view's roles, layers and named channels, whichever of them are
                  ///< loaded
  Window display;
  float pixel_aspect = 1;  ///< width / height of a pixel
  std::optional<Camera> camera;
  std::optional<float> shutter_angle_deg;  ///< the header's shutterAngle: 360 exposes the whole frame interval
  std::array<std::vector<Plane>, kRoleCount> roles;
  std::vector<Layer> layers;
  /// Single channels of the file that filters work on, by the name a preset gives them (without view), as they are
  /// stored; NaN, which filters leave out, where the file has no pixel.
  std::map<std::string, Plane> named;
  /// Channels to add, by name without view ("AO", "aftershade.mask"); half in the file unless `part` has them already.
  /// A name that is also in `named` means that channel, in whichever part it lies: its pixels change, nothing else.
  std::map<std::string, Plane> added;
  std::shared_ptr<const FileData> file;  ///< null: the sink reads the file again
  std::shared_ptr<SharedData> geometry;  ///< null: every preset finds out for itself

  bool has(Role role) const { return !roles[static_cast<size_t>(role)].empty(); }
  std::vector<Plane>& planes(Role role) { return roles[static_cast<size_t>(role)]; }
  const std::vector<Plane>& planes(Role role) const { return roles[static_cast<size_t>(role)]; }
  const Plane& depth() const { return planes(Role::depth).at(0); }
};

/// The same frame once more, for another preset: its planes are shared (Plane::shared).
Frame shared(const Frame& frame);

/// Where frames come from: files, or memory in tests.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The frame with these roles (those it has of them) and, if asked, its layers; nullopt when there is no such frame.
  virtual std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool with_layers) = 0;
};

/// Where finished frames go: every view of one frame at once.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  virtual void write(int number, const std::vector<Frame>& views) = 0;
};

}  // namespace aftershade
