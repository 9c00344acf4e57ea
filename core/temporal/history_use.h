#pragma once
#include <array>
#include <functional>
#include <string_view>

#include "core/filter/sample_grid.h"
#include "core/temporal/reprojection.h"
#include "core/temporal/temporal_blur.h"

/// What became of each pixel's history, for those who look into a filter. The filters themselves never ask: these are
/// passes of their own, over what the filters were given.
namespace aftershade::temporal {

/// The codes are written to files.
enum class HistoryUse {
  background = 0,  ///< no surface
  used = 1,
  stable = 2,                ///< not asked for: the pixel keeps the AO of its frame
  none = 3,                  ///< there is none: first frame, cut
  unknown_motion = 4,        ///< nobody knows where the surface was
  outside = 5,               ///< it was outside the image
  other_surface = 6,         ///< another one was seen there: disocclusion
  changed_surroundings = 7,  ///< it was found, but what occludes it has moved
  changed_value = 8,         ///< it was found, but the value there is too different
};
inline constexpr int kHistoryUses = 9;
/// What they mean in a few words, by code.
inline constexpr std::array<std::string_view, kHistoryUses> kHistoryUseTexts{"no surface",
                                                                             "used",
                                                                             "stable, not asked for",
                                                                             "there is none",
                                                                             "motion unknown",
                                                                             "outside the image before",
                                                                             "another surface was there",
                                                                             "surroundings changed",
                                                                             "value changed"};
constexpr float code_of(HistoryUse use) { return static_cast<float>(use); }

/// What a filter by reprojection looks for its history in.
struct StoredHistory {
  ConstPlaneView depth;  ///< metres, 0: background; empty: there is no history
  Window window;         ///< of it, absolute
  float epsilon;         ///< relative difference of depth up to which it is the same surface
  bool nearest = false;  ///< looked up at the nearest pixel instead of the four around
};

/// Of the look-up of selective_temporal_filter() and look_up(): background, used, none, unknown_motion, outside or
/// other_surface at every pixel of `depth`. `compared` is the depth that the stored one must equal. Outside: the
/// nearest pixel is. Used is to the bit where those functions find history.
Plane history_use(ConstPlaneView depth, const Reprojected& past, ConstPlaneView compared, const StoredHistory& stored);

/// The same of temporal_blur()'s look-up in the history as it is before that step, at the grid's texels; distances
/// within rounding of the limit may fall to either side.
Plane history_use(const TemporalBlurParams& params, const filter::SampleGrid& grid, const filter::Surface& surface,
                  const Reprojected& past, const TemporalBlurHistory& before);

/// Pixels with a surface for which `where` holds get the code of `reason`.
void mark(Plane& use, HistoryUse reason, const std::function<bool(int x, int y)>& where);

}  // namespace aftershade::temporal
