#pragma once
#include "core/image/frame.h"
#include "core/params/table.h"

namespace aftershade::ao {

enum class ApplyTarget { automatic, everything, ambient, none };
enum class BakedAo { ignore, multiply, least };

/// How AO darkens a layer (seed 004, "Change application: modulate everything, modulate ambient"), scene-linear:
///   a = max(minimum, 1 - strength (1 - AO))
///   everything: RGB a;   ambient: RGB - (1 - a) ambient
/// `baked` first joins an AO that the file already has, 1 = open, as SOMA "uses high frequency AO baked into the
/// diffuse texture in addition" (seed 001): the product, or the least of the two. Alpha is untouched, and no value is
/// made negative that was not.
struct ApplyAoParams {
  static constexpr std::string_view method = "apply-ao";
  static constexpr std::string_view summary = "darkens the chosen layers by the AO";
  ApplyTarget target = ApplyTarget::automatic;  ///< automatic: ambient where the file has it, else everything
  float strength = 1;
  float minimum = 0;
  BakedAo baked = BakedAo::ignore;
  static const params::Table& table();
  bool operator==(const ApplyAoParams&) const = default;
};

/// What `automatic` comes to for this frame.
ApplyTarget resolved_target(const ApplyAoParams& params, const Frame& frame);

/// Darkens every layer with receives_ao. `ao` covers the frame's window. Error(data) where the frame lacks the ambient
/// light or the AO that is asked for.
void apply_ao(const ApplyAoParams& params, ConstPlaneView ao, Frame& frame);

}  // namespace aftershade::ao
