#pragma once
#include <span>

#include "core/image/plane.h"

namespace aftershade::color {

/// Turns red, green and blue in place from scene-linear Rec.709 into the values an sRGB display takes, 0..1.
/// The three planes have one size. Values are clamped to 0..1 first (no tone mapping: a picture shows what a viewer
/// with a plain sRGB display transform shows); NaN becomes 0. The curve is OpenColorIO's ExponentWithLinear with
/// gamma 2.4 and offset 0.055: the sRGB curve of IEC 61966-2-1 to within 1e-5, its linear piece being made to meet the
/// other smoothly. OpenColorIO is asked for the transform itself, never for a named space of a configuration, so $OCIO
/// changes nothing.
void to_display(std::span<const PlaneView, 3> rgb);

}  // namespace aftershade::color
