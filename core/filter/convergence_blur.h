#pragma once
#include "core/filter/bilateral_blur.h"

namespace aftershade::filter {

/// Convergence-aware spatial filter (Mattausch, Scherzer, Wimmer, CGF 2010; algorithms 6):
///   AO_f(p) = sum_q g(s(p) |p - q|) conv(q) AO(q) / sum_q g conv(q)
/// as two passes of the bilateral blur, its radius at p times 1 - conv(p): a converged texel is left as it is, to the
/// bit, and those around it lean on it. `convergence` on the grid, 0 to 1.
Plane convergence_blur(const BilateralBlurParams& params, ConstPlaneView value, ConstPlaneView convergence,
                       const SampleGrid& grid, const Surface& surface);

}  // namespace aftershade::filter
