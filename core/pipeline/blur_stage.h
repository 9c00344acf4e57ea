#pragma once
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/motionblur/motion.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

/// What a motion blur blurs with.
struct BlurScene {
  motionblur::Motion motion;  ///< of the frame's window
  float shutter_frames;       ///< the shutter's length
  ConstPlaneView depth;       ///< metres; empty (data == nullptr): the file has none
  Window window, display;
};

/// The planes of a layer, to be blurred together.
std::vector<Plane*> channels_of(Layer& layer);

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

  /// How far light gets from its pixel, in whole pixels.
  virtual int reach_px(const BlurScene& scene) const = 0;
  /// Blurs the layers in place; their planes cover scene.window. May add diagnostics and further channels to the frame.
  virtual void blur(Work& work, const BlurScene& scene, std::span<Layer* const> layers) = 0;

  /// The motion of a frame that was observed, or of any frame with vectors: reads its roles, its named channels and the
  /// cameras observed beside it.
  motionblur::Motion motion_of(const Frame& frame, motionblur::WithoutVector* without = nullptr) const;

 private:
  float shutter_frames(Work& work) const;
  std::optional<Camera> camera_of(int frame) const;
  BlurScene scene_of(const Frame& frame, float shutter_frames, motionblur::Motion motion) const;
  void report_motion(Work& work, motionblur::WithoutVector without) const;

  motionblur::MotionParams motion_;
  std::map<int, std::optional<Camera>> cameras_;  ///< of the frames observed lately, by number
};

}  // namespace aftershade::pipeline
