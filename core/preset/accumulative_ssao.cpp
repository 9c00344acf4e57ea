#include "core/preset/accumulative_ssao.h"

namespace aftershade::preset {

const params::Table& AccumulativeSsaoParams::table() {
  using P = AccumulativeSsaoParams;
  static const params::Table records = [] {
    params::TableBuilder<P> table;
    return ao::add_sphere_samples(table)
        .add("accumulated_frames", &P::accumulated_frames, {2, 10000},
             "Frames that are averaged: a plain mean until there are so many, and from then on a new frame weighs one "
             "part in so many; few make the AO follow faster, many make it smoother.")
        .add("epsilon", &P::epsilon, {0, 1e9},
             "Largest relative difference between expected and stored depth at which the AO of the frame before is "
             "used.")
        .add("miss_samples_factor", &P::miss_samples_factor, {1, 64},
             "Where there is no AO to go on from, test so many times the points, which then count as so many frames.")
        .add("literal", &P::literal,
             "As the seed is written: a new frame always weighs one part in accumulated_frames, and the depth compared "
             "with the stored one is the pixel's current depth instead of the expected one.")
        .add("literal_packing", &P::literal_packing,
             "Keep depth and AO between frames as the seed does, in one texture of four 8-bit channels.")
        .add("packed_range_m", &P::packed_range_m, {1e-6, 1e9}, "Depth that literal_packing stores as 1.")
        .add("reprojection", &P::reprojection, {"auto", "camera"},
             "Where the AO of the frame before is found: by the camera and, where the vectors disagree with it, by the "
             "vectors; or by the camera alone, as in the seed.")
        .add("agreement_px", &P::agreement_px, {0, 1000},
             "Largest difference between vector and camera motion at which a pixel counts as static.")
        .build();
  }();
  return records;
}

}  // namespace aftershade::preset
