#pragma once
#include "core/motionblur/guertin2014.h"
#include "core/motionblur/mcguire2012.h"
#include "tests/motionblur/blur_scene.h"

/// Both literal methods under one name, for tests that ask the same of both.
namespace aftershade::tests {

inline void run_blur(const motionblur::Mcguire2012Params& params, const motionblur::GatherInput& input,
                     std::span<Plane* const> channels) {
  motionblur::mcguire2012_blur(params, input, channels);
}
inline void run_blur(const motionblur::Guertin2014Params& params, const motionblur::GatherInput& input,
                     std::span<Plane* const> channels) {
  motionblur::guertin2014_blur(params, input, channels);
}

/// Radius in pixels as given, whatever the image's height.
template <class Params>
Params literal(float radius_px) {
  Params params;
  params.max_radius_px = radius_px;
  params.reference_height_px = 1;
  return params;
}

/// The blurred channels; the scene is left alone.
template <class Params>
std::vector<Plane> literally_blurred(const Params& params, const BlurScene& scene) {
  std::vector<Plane> out;
  std::vector<Plane*> pointers;
  for (const Plane& plane : scene.channels) out.push_back(copy_of(plane));
  for (Plane& plane : out) pointers.push_back(&plane);
  const ConstPlaneView depth = scene.depth.empty() ? ConstPlaneView() : ConstPlaneView(scene.depth);
  run_blur(params, {depth, &scene.velocity, scene.window, static_cast<int>(params.reference_height_px)}, pointers);
  return out;
}

}  // namespace aftershade::tests
