#pragma once
#include <span>

#include "core/params/table.h"
#include "core/temporal/trajectory.h"

namespace aftershade::temporal {

enum class ChangeTest { near_moving, everywhere, never };

/// A two-sided temporal window (algorithms 7.8): the AO of frame f is the mean, along motion trajectories, of the
/// original AO of frames f-k to f+k. No recursion, so no resampling blur, no lag and no tail, and a pure function of
/// these frames:
///   AO = AO_f + sum_j w_j v_j r_j D_j / (w_0 + sum_j w_j v_j r_j),   D_j = AO_j (where the surface was) - AO_f
/// w_j = 1 - (j / (k + 1))^2: of all windows of 2k+1 frames the one whose result changes least from frame to frame when
/// the noise of the frames is independent (it has the least sum of (w_j - w_{j+1})^2; Epanechnikov's kernel).
/// v_j: share of the bilinear taps in frame j that see the surface (trajectory.h); 0 where it is hidden or outside.
/// r_j: 1, but near moving surfaces the share of trust that the neighbourhood's occluders were where they are in f.
/// Real changes of AO are wide in space and slow or sudden in time, the flicker of undersampling has zero mean:
/// S_j, the mean of D_j over the neighbourhood (of surfaces that move as well, or stand as well), is compared with that
/// of frames f-1 to f+1 and with the noise sigma that S has along the trajectory (median of third differences: neither
/// a bend nor a sudden change raises it):
///   r = 1 / (1 + t^2),  t = (S_j - S_ref)^2 / ((significance sigma)^2 + change^2)
/// Two frames at equal distances stay or go together, also judged by their mean, so that an AO that changes evenly
/// keeps both; for one whose counterpart does not see the surface, or does not exist, the noise is no excuse.
struct TemporalWindowParams {
  static constexpr std::string_view method = "temporal-window";
  static constexpr std::string_view summary = "two-sided temporal window over the AO along motion trajectories";
  int frames = 7;                 ///< k, on each side
  float distance_m = 0.05F;       ///< a tap this far from the expected tangent plane is another surface ...
  float distance_footprints = 2;  ///< ... unless it is within so many pixel footprints
  float moving_depth = 0.05F;     ///< moving surfaces may be off by this share of their depth besides
  float normal_deg = 60;          ///< largest angle between the normals
  float agreement_px = 0.25F;
  ChangeTest change_test = ChangeTest::near_moving;
  float occluder_radius_m = 1;  ///< how far occlusion reaches: the radius of the AO
  float neighbourhood_px = 8;   ///< half width of the square in which changes are averaged
  float change = 0.0003F;       ///< change of the neighbourhood's AO that is real
  float significance = 1;       ///< in standard deviations of its own flicker
  static const params::Table& table();
  bool operator==(const TemporalWindowParams&) const = default;
};

struct WindowedAo {
  Plane ao;
  Plane weight;  ///< sum of the weights over that of a whole window without rejection: 1 / sum w alone, to 1
};

/// The filtered AO of frames[centre]. `frames` are sorted by number; those further than params.frames, and those beyond
/// a gap in the numbers or a cut (a step in which more than 60 % of what was still seen is lost), are not used: at the
/// end of a shot a window is one-sided. Windows may differ in place and size: frames are aligned by absolute
/// coordinates. AO that is not finite counts as 1 in the centre and for nothing elsewhere; background keeps its own.
WindowedAo temporal_window(const TemporalWindowParams& params, std::span<const WindowFrame* const> frames,
                           size_t centre);

}  // namespace aftershade::temporal
