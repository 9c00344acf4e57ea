#pragma once
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/motionblur/half_velocity.h"
#include "core/motionblur/motion.h"
#include "core/motionblur/tile_max.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

/// What a motion blur blurs with. What it does not ask for is not worked out.
class BlurScene {
 public:
  BlurScene(const motionblur::MotionParams& params, const motionblur::MotionSources& sources, float exposure_frames);
  Window window, display;
  ConstPlaneView depth;  ///< metres; empty (data == nullptr): the file has none
  float shutter_frames;  ///< the shutter's length

  /// Of the frame's window.
  const motionblur::Motion& motion() const;
  motionblur::HalfVelocity half_velocity(float max_radius_px) const;
  /// What became of pixels without a vector; known after either.
  motionblur::WithoutVector without() const { return without_; }

 private:
  motionblur::MotionParams params_;
  motionblur::MotionSources sources_;
  mutable std::optional<motionblur::Motion> motion_;
  mutable motionblur::WithoutVector without_;
};

/// The planes of a layer, to be blurred together.
std::vector<Plane*> channels_of(Layer& layer);

/// The AOVs of blurs that gather by tiles.
inline const AovSet kTileAovs{Aov::tile_velocity, Aov::neighbour_velocity};
inline bool wants_tiles(const Work& work) {
  return work.wants(Aov::tile_velocity) || work.wants(Aov::neighbour_velocity);
}
/// Gives those that are wanted, at every pixel of the frame's window.
void give_tiles(Work& work, const motionblur::VelocityTiles& tiles);

/// What all motion blur stages share: what they need, the motion of a frame, the shutter's length, the data window,
/// which layers are blurred. A method says how far its blur reaches and how it blurs; one that looks at neighbouring
/// frames extends needs(), observe() and restart(), which it calls.
///
/// The motion is the file's vectors; the camera's where the file has none, or where MotionParams asks for it. Then the
/// stage is windowed by one frame to either side, of which it keeps the cameras; at a sequence's ends one side stands
/// for both.
class BlurStage : public Stage {
 public:
  Needs needs(const Offer& offer) const override;
  void restart() override { cameras_.clear(); }
  void observe(const Work& work) override;
  void run(Work& work) final;

 protected:
  explicit BlurStage(const motionblur::MotionParams& motion) : motion_(motion) {}

  /// How far light gets from its pixel, in whole pixels. Asked for only where it may leave the data window.
  virtual int reach_px(const BlurScene& scene) const = 0;
  /// Blurs the layers in place; their planes cover scene.window. May add AOVs to the frame.
  virtual void blur(Work& work, const BlurScene& scene, std::span<Layer* const> layers) = 0;

  /// The motion of a frame that was observed, or of any frame with vectors: reads its roles, its named channels and the
  /// cameras observed beside it.
  motionblur::Motion motion_of(const Frame& frame) const;

 private:
  float shutter_frames(Work& work) const;
  std::optional<Camera> camera_of(int frame) const;
  motionblur::MotionSources sources_of(const Frame& frame) const;
  void report_motion(Work& work, motionblur::WithoutVector without) const;

  motionblur::MotionParams motion_;
  std::map<int, std::optional<Camera>> cameras_;  ///< of the frames observed lately, by number
};

}  // namespace aftershade::pipeline
