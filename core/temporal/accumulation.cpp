#include "core/temporal/accumulation.h"

#include "core/parallel/rows.h"
#include "core/temporal/accumulation_kernel.h"

namespace aftershade::temporal {

Past look_up(const AccumulationHistory& history, const Reprojected& reprojected, ConstPlaneView compared,
             float epsilon) {
  const int width = compared.width, height = compared.height;
  Past out{Plane(width, height, 1.0F), Plane(width, height), Plane(width, height)};
  if (history.ao.empty()) return out;
  const HistoryView before{history.ao, history.depth, history.weight, history.window.min_x, history.window.min_y};
  for_rows(height, [&](int y) {
    look_up_row({before, history.next, reprojected.x.row(y), reprojected.y.row(y), compared.row(y), width, epsilon,
                 out.ao.row(y), out.weight.row(y), out.next.row(y)});
  });
  return out;
}

AccumulationHistory accumulate(const Past& past, const Addition& addition, float max_weight) {
  const int width = addition.ao.width, height = addition.ao.height;
  AccumulationHistory now{addition.window, Plane(width, height), Plane(width, height), Plane(width, height), {}};
  for_rows(height, [&](int y) {
    accumulate_row({past.ao.row(y), past.weight.row(y), addition.ao.row(y), addition.weight.row(y),
                    addition.depth.row(y), width, max_weight, now.ao.row(y), now.weight.row(y), now.depth.row(y)});
  });
  return now;
}

void pack_literally(AccumulationHistory& history, float range_m) {
  for_rows(history.ao.height(), [&](int y) {
    pack_row({history.ao.row(y), history.depth.row(y), history.ao.width(), range_m});
  });
}

}  // namespace aftershade::temporal
