#pragma once
#include <optional>

#include "core/pipeline/needs.h"
#include "core/pipeline/work.h"
#include "core/temporal/reprojection.h"

namespace aftershade::pipeline {

/// Share of a picture without a past that makes it a cut (algorithms 13).
inline constexpr double kCut = 0.6;

/// Adds what `reprojection_of` reads: camera positions, vectors, or both, by `source` and by what there is.
void add_reprojection_needs(Needs& needs, const Offer& offer, temporal::ReprojectionSource source);

/// What `reprojection_of` reads, with the planes that it had to make.
struct ReprojectionSources {
  temporal::VelocityPlanes scattered;
  temporal::ReprojectionInput input;
};
ReprojectionSources reprojection_sources(Work& work, const std::optional<Camera>& before);

/// Where each pixel's surface was one frame before: by the cameras, `before` being that of frame f-1 if it is known,
/// and by the backward vectors; where a file has forward vectors only, by those of frame f-1 carried forward.
temporal::Reprojected reprojection_of(Work& work, const std::optional<Camera>& before,
                                      temporal::ReprojectionSource source, float agreement_px);

}  // namespace aftershade::pipeline
