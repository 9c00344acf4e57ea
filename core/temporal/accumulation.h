#pragma once
#include "core/image/plane.h"
#include "core/image/window.h"
#include "core/temporal/reprojection.h"

namespace aftershade::temporal {

/// A reprojection cache of AO (Nehab et al. 2007; seed 003; Mattausch, Scherzer, Wimmer 2010): AO found so far, and how
/// much it weighs, counted in frames or in samples. Empty planes: nothing is known.
struct AccumulationHistory {
  Window window;    ///< absolute coordinates of the planes
  Plane ao, depth;  ///< depth in metres, background 0
  Plane weight;
  Plane next;  ///< where the texel's sequence of samples goes on; empty if nobody asks
};

/// The cache as the pixels of a frame find it; weight 0 is a cache miss (ao 1, next 0).
struct Past {
  Plane ao, weight, next;
};

/// Looks up where `reprojected` says; `compared` is the depth that the stored one must equal within the relative
/// `epsilon`. Four bilinear taps, each checked on its own (algorithms 7.3).
Past look_up(const AccumulationHistory& history, const Reprojected& reprojected, ConstPlaneView compared,
             float epsilon);

/// What is added to the cache: this frame's AO, what it weighs, and the depth it is stored with.
struct Addition {
  ConstPlaneView ao, weight, depth;
  Window window;
};

/// AO = (n AO_old + k AO_new) / (n + k), n = min(n + k, max_weight): seed 003's running mean and TSSAO's formula
/// (algorithms 6, 14 item 14). Returns the history of this frame but for `next`. AO that is not finite counts as 1.
AccumulationHistory accumulate(const Past& past, const Addition& addition, float max_weight);

/// Seed 003 keeps depth and AO in one texture of four 8-bit channels. The history after that: depth as a share of
/// `range_m` in three digits of base 256, each stored as the nearest of 255 steps (algorithms 14, item 17: off by up to
/// 0.0020 of the range), AO in 255 steps. Depths beyond the range become the range.
void pack_literally(AccumulationHistory& history, float range_m);

}  // namespace aftershade::temporal
