#pragma once
#include "tests/support/render.h"

namespace aftershade::tests {

/// Frames first to last of a scene, rendered when they are asked for: the canonical frames without any file.
class SceneSource final : public FrameSource {
 public:
  SceneSource(const Scene& scene, const RenderSettings& settings, int first, int last)
      : scene_(scene), settings_(settings), first_(first), last_(last) {}

  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool with_layers) override {
    if (number < first_ || number > last_ || !view.empty()) return std::nullopt;
    return render(scene_, number, settings_, roles, with_layers);
  }

 private:
  const Scene& scene_;
  RenderSettings settings_;
  int first_, last_;
};

}  // namespace aftershade::tests
