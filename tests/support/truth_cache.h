#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/support/truth.h"

/// Truth for tests, rendered once a machine: kept in the build folder under truth-cache, by a hash of the source text
/// that generates it, the scene and the parameters. A stale entry is never found. At most 240x135 pixels
/// (std::logic_error).
namespace aftershade::tests {

Plane cached_ao_truth(const std::string& scene, double time, int width, int height, const AoTruth& truth);
Plane cached_ao_change(const std::string& scene, double time, int width, int height, const AoTruth& truth);
std::vector<Plane> cached_blur_truth(const std::string& scene, double time, double shutter_frames, int samples,
                                     const RenderSettings& settings);

/// The planes kept under `key` (any text), or those of `make`, kept for the next time. All planes have one size.
std::vector<Plane> cached_planes(const std::string& key, const std::function<std::vector<Plane>()>& make);
/// The file that keeps them.
std::string cache_path(const std::string& key);

}  // namespace aftershade::tests
