#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/temporal/accumulation.cpp"  // this file, compiled once a SIMD target
#include "core/temporal/accumulation.h"

#include <hwy/foreach_target.h>

#include "core/parallel/rows.h"
#include "core/temporal/accumulation_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

void look_up_rows(const AccumulationHistory& history, const Reprojected& reprojected, ConstPlaneView compared,
                  float epsilon, Past& out) {
  const HistoryView before{history.ao, history.depth, history.weight, history.window.min_x, history.window.min_y};
  for_rows(compared.height, [&](int y) {
    look_up_row({before, history.next, reprojected.x.row(y), reprojected.y.row(y), compared.row(y), compared.width,
                 epsilon, out.ao.row(y), out.weight.row(y), out.next.row(y)});
  });
}

void accumulate_rows(const Past& past, const Addition& addition, float max_weight, AccumulationHistory& now) {
  for_rows(addition.ao.height, [&](int y) {
    accumulate_row({past.ao.row(y), past.weight.row(y), addition.ao.row(y), addition.weight.row(y),
                    addition.depth.row(y), addition.ao.width, max_weight, now.ao.row(y), now.weight.row(y),
                    now.depth.row(y)});
  });
}

void pack_rows(AccumulationHistory& history, float range_m) {
  for_rows(history.ao.height(), [&](int y) {
    pack_row({history.ao.row(y), history.depth.row(y), history.ao.width(), range_m});
  });
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::temporal {

namespace {
HWY_EXPORT(look_up_rows);
HWY_EXPORT(accumulate_rows);
HWY_EXPORT(pack_rows);
}  // namespace

Past look_up(const AccumulationHistory& history, const Reprojected& reprojected, ConstPlaneView compared,
             float epsilon) {
  const int width = compared.width, height = compared.height;
  Past out{Plane(width, height, 1.0F), Plane(width, height), Plane(width, height)};
  if (!history.ao.empty()) HWY_DYNAMIC_DISPATCH(look_up_rows)(history, reprojected, compared, epsilon, out);
  return out;
}

AccumulationHistory accumulate(const Past& past, const Addition& addition, float max_weight) {
  const int width = addition.ao.width, height = addition.ao.height;
  AccumulationHistory now{addition.window, Plane(width, height), Plane(width, height), Plane(width, height), {}};
  HWY_DYNAMIC_DISPATCH(accumulate_rows)(past, addition, max_weight, now);
  return now;
}

void pack_literally(AccumulationHistory& history, float range_m) { HWY_DYNAMIC_DISPATCH(pack_rows)(history, range_m); }

}  // namespace aftershade::temporal
#endif
