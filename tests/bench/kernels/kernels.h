#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/filter/pyramid.h"
#include "core/filter/sample_grid.h"
#include "core/motionblur/half_velocity.h"
#include "core/temporal/reprojection.h"
#include "core/temporal/selective_temporal.h"
#include "tests/support/render.h"

/// The hot kernels, each as its public function on planes small enough to stay in a processor's own cache.
namespace aftershade::tests::kernels {

inline constexpr int kWidth = 256, kHeight = 64, kPixels = kWidth * kHeight;

/// A piece of the grass scene that kernels read, and what some of them leave behind.
struct Inputs {
  Inputs();
  Inputs(const Inputs&) = delete;

  Frame frame;
  std::optional<Camera> camera_before;
  filter::Surface surface;  ///< pixel lengths are those of an image of 1080 lines
  filter::SampleGrid grid;  ///< half resolution
  filter::DepthPyramid pyramid;
  Plane ao, half_ao;
  temporal::ReprojectionInput before;
  motionblur::Motion motion;
  motionblur::HalfVelocity velocity;
  temporal::TemporalHistory history;
};

struct Kernel {
  std::string name;
  bool gathers;  ///< its time is spent on values from places that differ from pixel to pixel
  std::function<void()> run;
};
/// THE list: a line adds a kernel. They refer to `inputs`.
std::vector<Kernel> all_kernels(Inputs& inputs);

}  // namespace aftershade::tests::kernels
