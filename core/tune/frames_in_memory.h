#pragma once
#include <map>
#include <string>
#include <utility>

#include "core/image/frame.h"

namespace aftershade::tune {

/// The frames of another source, each read once, when it is first asked for; what is given out shares its planes
/// (Plane::shared).
class FramesInMemory final : public FrameSource {
 public:
  /// Frames are read with `roles`, and with their layers if `layers`, which must cover all that anybody asks for.
  FramesInMemory(FrameSource& source, RoleSet roles, bool layers) : source_(source), roles_(roles), layers_(layers) {}

  /// With `sharing`, stages also find what others found out about a frame (pipeline::Geometry); without, each run makes
  /// it anew, as it must where its time is measured.
  void share_geometry(bool sharing) { sharing_ = sharing; }

  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool with_layers) override;

 private:
  FrameSource& source_;
  RoleSet roles_;
  bool layers_, sharing_ = true;
  std::map<std::pair<int, std::string>, Frame> frames_;
};

}  // namespace aftershade::tune
