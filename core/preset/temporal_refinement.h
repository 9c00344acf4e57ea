#pragma once
#include "core/ao/sample_validation.h"
#include "core/filter/bilateral_blur.h"
#include "core/temporal/reprojection.h"

namespace aftershade::preset {

/// Temporal refinement of SSAO (Mattausch, Scherzer, Wimmer, "High-Quality Screen-Space Ambient Occlusion using
/// Temporal Coherence", CGF 2010, cited by seed 000 as TSSAO; algorithms 6, from memory of the paper). Samples are
/// accumulated, not frames: with n samples so far and k new ones, whose sequence goes on from the n,
///   AO = (n AO_before + k AO_now) / (n + k), n = min(n + k, n_max)
/// n is the texel's convergence. It is 0 after a disocclusion and shrinks where the surfaces around have changed their
/// distance (ao::ValidationParams). Texels with few samples take more, and lean on converged neighbours until they have
/// enough (filter::convergence_blur; what is kept is not blurred).
struct TemporalRefinementParams : ao::SphereSamples, ao::ValidationParams {
  static constexpr std::string_view method = "temporal-refinement";
  static constexpr std::string_view summary = "Mattausch, Scherzer and Wimmer's temporal refinement of SSAO (2010)";
  TemporalRefinementParams() { samples = 8; }
  int unconverged_samples = 32;
  int converged_count = 100;  ///< ours
  int max_count = 500;
  float epsilon = 0.1F;
  temporal::ReprojectionSource reprojection = temporal::ReprojectionSource::automatic;
  float agreement_px = 0.5F;
  float blur_radius_px = 8;  ///< ours, and all of the blur's
  float reference_height_px = 1080;
  float edge_distance_m = 0.05F, edge_footprints = 2;
  static const params::Table& table();
  filter::BilateralBlurParams blur() const {
    filter::BilateralBlurParams out;
    out.radius_px = blur_radius_px;
    out.reference_height_px = reference_height_px;
    out.edge_distance_m = edge_distance_m;
    out.edge_footprints = edge_footprints;
    return out;
  }
  bool operator==(const TemporalRefinementParams&) const = default;
};

}  // namespace aftershade::preset
