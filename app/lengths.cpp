#include "app/lengths.h"

#include <algorithm>
#include <optional>

#include "app/log.h"
#include "core/base/text.h"

namespace aftershade::app {

namespace {

using params::Json;

/// Pixels that a metre spans at the depth looked at, and that a pixel's footprint spans (the larger of its sides is
/// meant where pixels are not square).
struct Scale {
  double px_per_m_x, px_per_m_y, footprint_px;
};

Scale scale_at(const Camera& camera, double depth_m) {
  const double depth = camera.orthographic ? 1 : depth_m;
  return {camera.fx / depth, camera.fy / depth, camera.fx / std::min(camera.fx, camera.fy)};
}

std::optional<Json> value(const preset::StageDescription& stage, std::string_view key) {
  for (const params::Record& record : preset::table_of(stage.params))
    if (record.key == key) return record.get(preset::values_of(stage.params));
  return std::nullopt;
}

double number(const preset::StageDescription& stage, std::string_view key) {
  const auto found = value(stage, key);
  return found ? found->get<double>() : 0;
}

struct Length {
  double px;
  std::string remark;
};

/// The clamp limits the vertical projected radius and shortens the horizontal one alike (core/ao/scalable_ao_kernel.h).
Length radius(const preset::StageDescription& stage, double metres, const Scale& scale, int display_height) {
  const double free_px = metres * scale.px_per_m_x, vertical_px = metres * scale.px_per_m_y;
  const double limit_px = number(stage, "max_radius_px") * display_height / number(stage, "reference_height_px");
  if (!value(stage, "max_radius_px") || limit_px <= 0 || vertical_px <= limit_px) return {free_px, ""};
  return {free_px * limit_px / vertical_px, cat(" (clamped from ", fixed(free_px, 1), " px)")};
}

/// "edge_distance_m" has "edge_footprints" beside it, "distance_m" has "distance_footprints": the larger counts.
Length threshold(const preset::StageDescription& stage, const std::string& key, double metres, const Scale& scale,
                 int grid_step) {
  const double metric_px = metres * scale.px_per_m_x;
  const std::string companion = key.substr(0, key.find('_')) + "_footprints";
  const double footprints = number(stage, companion), footprints_px = footprints * grid_step * scale.footprint_px;
  if (footprints_px <= metric_px) return {metric_px, ""};
  return {footprints_px,
          cat(" (", footprints, " footprints of the AO's grid; ", metres, " m alone is ", fixed(metric_px, 1), " px)")};
}

void warn_of(const std::string& key, double px, Window display) {
  if (px < 1)
    log().warning(
        cat(key, " is ", fixed(px, 2), " px at the median depth: AO will find nothing; is the unit right (--unit)?"));
  if (px > 0.5 * std::max(display.width(), display.height()))
    log().warning(cat(key, " is ", fixed(px, 0),
                      " px at the median depth, more than half a screen; is the unit right (--unit)?"));
}

}  // namespace

Json lengths_report(const preset::Preset& preset, const Frame& frame, double depth_m) {
  const Scale scale = scale_at(*frame.camera, depth_m);
  Json report = Json::object();
  int grid_step = 1;
  for (const preset::StageDescription& stage : preset.stages) {
    if (const auto resolution = value(stage, "resolution")) grid_step = *resolution == "half" ? 2 : 1;
    const auto channel = value(stage, "channel");
    const int step = channel && *channel != "" ? 1 : grid_step;  // named channels are filtered at every pixel
    for (const params::Record& record : preset::table_of(stage.params)) {
      if (!record.key.ends_with("_m")) continue;
      const double metres = record.get(preset::values_of(stage.params)).get<double>();
      const Length length = record.key == "radius_m"             ? radius(stage, metres, scale, frame.display.height())
                            : record.key.ends_with("distance_m") ? threshold(stage, record.key, metres, scale, step)
                                                                 : Length{metres * scale.px_per_m_x, ""};
      const std::string key = stage.id + "." + record.key;
      report[key] = cat(metres, " m, ", fixed(length.px, 1), " px", length.remark);
      if (record.key == "radius_m") warn_of(key, length.px, frame.display);
    }
  }
  return report;
}

}  // namespace aftershade::app
