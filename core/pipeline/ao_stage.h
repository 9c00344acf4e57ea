#pragma once
#include <cmath>
#include <type_traits>

#include "core/ao/thickness.h"
#include "core/parallel/rows.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

/// A copy of the AO at every pixel, whatever resolution it has by now.
inline Plane ao_at_pixels(Work& work) {
  return work.ao_at_pixels ? copy_of(work.ao) : filter::values_at_pixels(work.ao, *work.grid, work.surface());
}

/// A stage that makes AO of one frame, with no history. `Params` has `resolution` and `normals`; `Estimate` is
/// Plane(const Params&, Work&) and returns the AO on work.grid; at every pixel for Resolution::dual.
template <class Params, Plane (*Estimate)(const Params&, Work&)>
class AoStage final : public Stage {
 public:
  /// `optional`: roles that it uses besides if they are there.
  explicit AoStage(const Params& params, RoleSet optional = {}) : params_(params), optional_(optional) {}

  Needs needs(const Offer&) const override {
    Needs needs;
    needs.required = {Role::depth};
    needs.optional = optional_;
    (params_.normals == ao::NormalSource::file ? needs.required : needs.optional).insert(Role::normal);
    needs.lens = needs.makes_ao = true;
    needs.aovs = {Aov::ao_raw};
    if (kReadsSolids) needs.aovs.insert(Aov::thickness);
    needs.makes_ao_at_pixels = params_.resolution != ao::Resolution::half;
    return needs;
  }

  void run(Work& work) override {
    work.choose_normals(params_.normals);
    const filter::Surface& surface = work.surface();
    const bool full = params_.resolution == ao::Resolution::full;
    work.grid = full ? filter::full_grid(surface) : filter::half_grid(surface);
    work.ao = Estimate(params_, work);
    work.ao_at_pixels = params_.resolution != ao::Resolution::half;
    if (work.wants(Aov::ao_raw)) work.give(Aov::ao_raw, ao_at_pixels(work));
    if constexpr (kReadsSolids)
      if (work.wants(Aov::thickness)) work.give(Aov::thickness, thickness(surface));
  }

 private:
  Plane thickness(const filter::Surface& surface) const {
    Plane out = ao::thickness_map(params_, surface.depth, surface.projection);
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x)
        if (!(std::isfinite(surface.depth(x, y)) && surface.depth(x, y) > 0)) out(x, y) = 0;
    });
    return out;
  }

  static constexpr bool kReadsSolids = std::is_base_of_v<ao::DepthGeometry, Params>;
  Params params_;
  RoleSet optional_;
};

}  // namespace aftershade::pipeline
