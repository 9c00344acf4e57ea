#include <algorithm>
#include <cmath>

#include "core/pipeline/blur_stage.h"

namespace aftershade::pipeline {

namespace {

class ScalableBlur final : public BlurStage {
 public:
  explicit ScalableBlur(const motionblur::ScalableBlurParams& params) : BlurStage(params), params_(params) {}

 private:
  /// Of half-exposure velocities.
  float limit_px(const BlurScene& scene) const {
    const int limit = params_.max_radius_px > 0 ? motionblur::max_radius_px(params_, scene.display.height())
                                                : std::max(scene.window.width(), scene.window.height());
    return static_cast<float>(limit);
  }

  int reach_px(const BlurScene& scene) const override {
    const float half = 0.5F * scene.shutter_frames;
    const float longest =
        motionblur::longest_displacement_px(scene.motion(), {-half, half}, motionblur::Path::straight);
    return static_cast<int>(std::ceil(std::min(longest, limit_px(scene))));
  }

  void blur(Work& work, const BlurScene& scene, std::span<Layer* const> layers) override {
    const motionblur::HalfVelocity velocity = scene.half_velocity(limit_px(scene));
    const int height = scene.display.height();
    const motionblur::GatherInput input{scene.depth, &velocity, scene.window, height};
    motionblur::HalfVelocity tiles;
    for (Layer* layer : layers)
      motionblur::scalable_motion_blur(params_, input, channels_of(*layer),
                                       work.wants(Aov::neighbour_velocity) ? &tiles : nullptr);
    if (work.wants(Aov::neighbour_velocity))
      add_tiles(work.frame, tiles, motionblur::radius_px(params_, velocity, height));
  }

  /// The neighbourhood's velocity at every pixel.
  static void add_tiles(Frame& frame, const motionblur::HalfVelocity& tiles, int tile) {
    if (tiles.x.empty()) return;
    const motionblur::TileGrid grid(tile, frame.window);
    for (const auto& [name, source] :
         {std::pair{"aftershade.neighbour_velocity.x", &tiles.x}, {"aftershade.neighbour_velocity.y", &tiles.y}}) {
      Plane plane(frame.window.width(), frame.window.height());
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x) plane(x, y) = (*source)(grid.column_of(x), grid.row_of(y));
      frame.added[name] = std::move(plane);
    }
  }

  motionblur::ScalableBlurParams params_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const motionblur::ScalableBlurParams& params) {
  return std::make_unique<ScalableBlur>(params);
}

}  // namespace aftershade::pipeline
