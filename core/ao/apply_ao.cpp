#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ao/apply_ao.cpp"  // this file, compiled once a SIMD target
#include "core/ao/apply_ao.h"

#include <hwy/foreach_target.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/ao/apply_ao_kernel.h"
#include "core/base/error.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

/// Colour, and the ambient light in it: empty where everything is darkened.
using Darkened = std::pair<PlaneView, ConstPlaneView>;

void darken(const ApplyAoParams& params, ConstPlaneView ao, ConstPlaneView baked, std::span<const Darkened> planes) {
  for_rows(ao.height, [&](int y) {
    for (const auto& [colour, ambient] : planes)
      apply_ao_row({ao.row(y), baked.empty() ? nullptr : baked.row(y), params.baked == BakedAo::multiply,
                    ambient.empty() ? nullptr : ambient.row(y), params.strength, params.minimum, colour.width,
                    colour.row(y)});
  });
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::ao {

const params::Table& ApplyAoParams::table() {
  using P = ApplyAoParams;
  static const params::Table records =
      params::TableBuilder<P>()
          .add("target", &P::target, {"auto", "everything", "ambient", "none"},
               "What the AO darkens: the ambient light in the picture where the file has it and else everything, "
               "everything, "
               "the ambient light only, or nothing.")
          .add("strength", &P::strength, {0, 4}, "How much of the AO is applied; 1 is all of it.")
          .add("minimum", &P::minimum, {0, 1}, "The darkest factor that the AO may come to.")
          .add("baked", &P::baked, {"ignore", "multiply", "min"},
               "How an ambient occlusion that the file already has (role ao) joins in: not at all, multiplied, or the "
               "darker of the two.")
          .build();
  return records;
}

ApplyTarget resolved_target(const ApplyAoParams& params, const Frame& frame) {
  if (params.target != ApplyTarget::automatic) return params.target;
  return frame.has(Role::ambient) ? ApplyTarget::ambient : ApplyTarget::everything;
}

namespace {

HWY_EXPORT(darken);

/// The plane of the ambient role that belongs to a layer's channel: by its last letter where that is R, G or B, since
/// files list channels alphabetically, else by its place.
size_t ambient_component(const Layer& layer, size_t plane) {
  constexpr std::string_view kComponents = "RGB";
  const std::string_view name =
      plane < layer.channels.size() ? std::string_view(layer.channels[plane]) : std::string_view();
  const size_t component = name.empty() ? std::string_view::npos : kComponents.find(name.back());
  return component != std::string_view::npos ? component : plane % kComponents.size();
}

}  // namespace

void apply_ao(const ApplyAoParams& params, ConstPlaneView ao, Frame& frame) {
  const ApplyTarget target = resolved_target(params, frame);
  if (target == ApplyTarget::none) return;
  if (target == ApplyTarget::ambient && !frame.has(Role::ambient))
    throw Error(ErrorCode::data,
                "frame " + std::to_string(frame.number) + " has no ambient channels to apply the AO to",
                "name them with --channel ambient=..., or use target \"everything\"");
  if (params.baked != BakedAo::ignore && !frame.has(Role::ao))
    throw Error(ErrorCode::data, "frame " + std::to_string(frame.number) + " has no ambient occlusion of its own",
                "name its channel with --channel ao=..., or use baked \"ignore\"");
  std::vector<std::pair<PlaneView, ConstPlaneView>> planes;
  for (Layer& layer : frame.layers) {
    if (!layer.receives_ao) continue;
    for (size_t i = 0; i < layer.planes.size(); ++i) {
      if (static_cast<int>(i) == layer.alpha) continue;
      planes.emplace_back(layer.planes[i], target == ApplyTarget::ambient
                                               ? frame.planes(Role::ambient).at(ambient_component(layer, i)).view()
                                               : ConstPlaneView());
    }
  }
  const ConstPlaneView baked = params.baked == BakedAo::ignore ? ConstPlaneView() : frame.planes(Role::ao)[0];
  HWY_DYNAMIC_DISPATCH(darken)(params, ao, baked, planes);
}

}  // namespace aftershade::ao
#endif
