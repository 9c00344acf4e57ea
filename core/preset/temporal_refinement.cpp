#include "core/preset/temporal_refinement.h"

namespace aftershade::preset {

namespace {

using P = TemporalRefinementParams;

void add_validation(params::TableBuilder<P>& table) {
  table
      .add("validation", static_cast<ao::Validation P::*>(&P::validation), {"smooth", "binary", "off"},
           "How a change of distance to what is around lowers the trust in the AO so far: gradually, to nothing beyond "
           "a "
           "limit, or not at all.")
      .add("validation_sharpness", &P::validation_sharpness, {0, 1e6},
           "Smooth: trust is 1 / (1 + this times the largest change in radii).")
      .add("validation_limit", &P::validation_limit, {0, 1e6},
           "Binary: largest change, as a share of the radius, at which the AO so far is kept.")
      .add("validation_footprints", &P::validation_footprints, {0, 1000},
           "Changes up to this many pixel widths at the pixel's depth count as rounding.");
}

void add_blur(params::TableBuilder<P>& table) {
  table
      .add("blur_radius_px", &P::blur_radius_px, {0, 64},
           "Reach of the blur to each side where nothing has converged, at the reference height; 0 switches it off.")
      .add("reference_height_px", &P::reference_height_px, {1, 65536},
           "Image height at which blur_radius_px is meant; at other heights it scales with the height, though not "
           "below 2.")
      .add("edge_distance_m", &P::edge_distance_m, {0, 1000},
           "Distance from a pixel's tangent plane at which another pixel's share in the blur has fallen to a half.")
      .add("edge_footprints", &P::edge_footprints, {0.1, 100},
           "The same distance in pixel widths at the pixel's depth; the larger of the two counts.");
}

}  // namespace

const params::Table& TemporalRefinementParams::table() {
  static const params::Table records = [] {
    params::TableBuilder<P> table;
    ao::add_sphere_samples(table)
        .add("unconverged_samples", &P::unconverged_samples, {1, 1024},
             "Points tested instead while the pixel has fewer than converged_count.")
        .add("converged_count", &P::converged_count, {1, 4096},
             "Points, over all frames, from which on a pixel counts as converged and is not blurred.")
        .add("max_count", &P::max_count, {1, 4096},
             "Largest count of accumulated points: it bounds how slowly a pixel follows.")
        .add("epsilon", &P::epsilon, {0, 1e9},
             "Largest relative difference between expected and stored depth at which the AO of the frame before is "
             "used.")
        .add("reprojection", &P::reprojection, {"auto", "camera"},
             "Where the AO of the frame before is found: by the camera and, where the vectors disagree with it, by the "
             "vectors; or by the camera alone.")
        .add("agreement_px", &P::agreement_px, {0, 1000},
             "Largest difference between vector and camera motion at which a pixel counts as static.");
    add_validation(table);
    add_blur(table);
    return table.build();
  }();
  return records;
}

}  // namespace aftershade::preset
