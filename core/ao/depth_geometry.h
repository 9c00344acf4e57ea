#pragma once
#include "core/ao/estimator.h"
#include "core/params/table.h"

namespace aftershade::ao {

/// What lies behind the first depth: as much as the thing is wide, or the same everywhere.
enum class ThicknessModel { width, constant };
/// What lies outside the image: nothing, or the surface at the border goes on as a plane.
enum class Border { open, extend };

/// How a depth buffer is read as solid things. Shared by slice-ao and its slow twin reference-ao.
struct DepthGeometry {
  ThicknessModel thickness = ThicknessModel::width;
  float thickness_ratio = 0.7F;                            ///< depth / visible width; ours, see core/ao/thickness.h
  float min_thickness_m = 0.001F, max_thickness_m = 1.0F;  ///< `constant` uses max_thickness_m
  Border border = Border::extend;
  NormalSource normals = NormalSource::automatic;
  bool operator==(const DepthGeometry&) const = default;
};

template <class P>
params::TableBuilder<P>& add_depth_geometry(params::TableBuilder<P>& table) {
  return table
      .add("thickness", static_cast<ThicknessModel P::*>(&P::thickness), {"width", "constant"},
           "How deep things are behind what is seen: in proportion to their visible width, or max_thickness_m "
           "everywhere.")
      .add("thickness_ratio", &P::thickness_ratio, {0, 100}, "Depth of a thing divided by its visible width.")
      .add("min_thickness_m", &P::min_thickness_m, {0, 1e6}, "Depth that even the thinnest thing has.")
      .add("max_thickness_m", &P::max_thickness_m, {0, 1e6},
           "Depth of things with no visible end, and the most of any.")
      .add("border", static_cast<Border P::*>(&P::border), {"open", "extend"},
           "Beyond the image is nothing, or the surfaces at the border go on as planes.")
      .add("normals", static_cast<NormalSource P::*>(&P::normals), {"auto", "file", "depth"},
           "Where normals come from: the file if it has them and else the depth, the file only, or the depth only.");
}

}  // namespace aftershade::ao
