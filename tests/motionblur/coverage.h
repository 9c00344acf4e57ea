#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <span>

#include "tests/motionblur/blur_scene.h"

/// The 1-D experiment of algorithms 3.5: how much of a moving foreground a blur shows, column by column, against the
/// share of the exposure during which the foreground is there.
namespace aftershade::tests {

/// Two layers in one dimension. The foreground is everything left of column 0, or a bar around it.
struct Layers {
  const char* name;
  float foreground_px, background_px;  ///< half velocities
  int bar_px;                          ///< 0: an edge
  int reach_px;                        ///< errors are taken over columns -reach to reach - 1
};

inline constexpr Layers kEdge{"A", 20, 0, 0, 30}, kBar{"B", 20, 0, 4, 30}, kStill{"C", 0, 20, 0, 30},
    kOpposed{"D", 10, -20, 0, 40}, kOvertaking{"E", 20, 15, 0, 40}, kOvertaken{"F", 5, 20, 0, 40};

/// Blurs all channels of a scene and leaves the scene alone.
using BlurFunction = std::function<std::vector<Plane>(const BlurScene&)>;

/// The columns are blurred in so many windows, each one column further right, and as many rows of each are read: a
/// mean over the jitters of the pixel at (0, 0) to (columns - 1, rows - 1). `margin` further rows lie above and below,
/// for blurs that look across the motion.
struct JitterMean {
  int columns = 4, rows = 4, margin = 0;
};

struct CoverageError {
  double mean, largest;  ///< of the absolute error
};

/// One channel, 1 on the foreground (at 1 m) and 0 on the background (at 10 m), equal in all rows.
BlurScene coverage_scene(const Layers& layers, Window window);

/// Foreground coverage of columns -kCoverageHalf to kCoverageHalf - 1.
inline constexpr int kCoverageHalf = 120;
std::vector<double> blurred_coverage(const BlurFunction& blur, const Layers& layers, JitterMean jitter = {});

/// Share of the exposure during which the foreground covers the centre of column x.
double true_coverage(const Layers& layers, int x);

CoverageError coverage_error(const BlurFunction& blur, const Layers& layers, JitterMean jitter = {});

struct ExpectedCoverage {
  Layers layers;
  CoverageError error;
};

/// Mean and largest error of every case within `tolerance` of the expected; records what they are.
void expect_coverage(const BlurFunction& blur, std::span<const ExpectedCoverage> cases, double tolerance,
                     JitterMean jitter = {});

}  // namespace aftershade::tests
