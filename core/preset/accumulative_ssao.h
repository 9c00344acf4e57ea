#pragma once
#include "core/ao/sphere_kernel.h"
#include "core/temporal/reprojection.h"

namespace aftershade::preset {

/// "Accumulative Screen Space Ambient Occlusion" (2009; seed 003): sphere-kernel SSAO at full resolution with new
/// samples every frame, averaged over time through a reprojection cache,
///   AO = AO_now / 30 + AO_before 29 / 30,
/// and this frame's AO alone where the cache misses: where the depth stored a frame ago is not the one that the pixel's
/// point had there. Points are carried by the delta matrix (current view -> last view -> last projection), so each
/// frame's own lens counts, and where they move by themselves by the vectors.
struct AccumulativeSsaoParams : ao::SphereSamples {
  static constexpr std::string_view method = "accumulative-ssao";
  static constexpr std::string_view summary = "Accumulative SSAO (2009): sphere-kernel AO averaged over frames";
  int accumulated_frames = 30;
  float epsilon = 0.02F;        ///< ours: the seed says "a certain threshold"
  int miss_samples_factor = 4;  ///< ours: the seed says "more samples can be taken"
  bool literal = false;
  bool literal_packing = false;
  float packed_range_m = 100;  ///< ours
  temporal::ReprojectionSource reprojection = temporal::ReprojectionSource::automatic;
  float agreement_px = 0.5F;
  static const params::Table& table();
  bool operator==(const AccumulativeSsaoParams&) const = default;
};

}  // namespace aftershade::preset
