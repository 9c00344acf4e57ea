#include <cmath>

#include "core/base/text.h"
#include "core/motionblur/tile_max.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

namespace {

/// Share of the light below which nobody needs to hear of its loss.
constexpr double kWorthSaying = 1e-3;

Window expanded(Window w, int reach) { return {w.min_x - reach, w.min_y - reach, w.max_x + reach, w.max_y + reach}; }

/// The longest vector, rounded up to whole pixels.
int reach_px(const motionblur::HalfVelocity& velocity) {
  double longest = 0;
  for (int y = 0; y < velocity.x.height(); ++y)
    for (int x = 0; x < velocity.x.width(); ++x) {
      const double vx = velocity.x(x, y), vy = velocity.y(x, y);
      longest = std::max(longest, vx * vx + vy * vy);
    }
  return static_cast<int>(std::ceil(std::sqrt(longest)));
}

/// Sum of |value| of the first three planes inside `inner` and everywhere.
struct Light {
  double inside = 0, all = 0;
};
Light light_of(const Layer& layer, Window window, Window inner) {
  Light light;
  for (size_t c = 0; c < layer.planes.size() && c < 3; ++c)
    for (int y = 0; y < window.height(); ++y)
      for (int x = 0; x < window.width(); ++x) {
        const double value = std::abs(layer.planes[c](x, y));
        if (!std::isfinite(value)) continue;
        light.all += value;
        if (inner.contains(x + window.min_x, y + window.min_y)) light.inside += value;
      }
  return light;
}

class ScalableBlur final : public Stage {
 public:
  explicit ScalableBlur(const motionblur::ScalableBlurParams& params) : params_(params) {}

  Needs needs(const Offer&) const override {
    Needs needs;
    needs.any_of = {Role::velocity_next, Role::velocity_prev};
    needs.optional = {Role::depth};
    needs.layers = needs.window = true;
    return needs;
  }

  void run(Work& work) override {
    Frame& frame = work.frame;
    const int radius = motionblur::max_radius_px(params_, frame.display.height());
    motionblur::HalfVelocity velocity = half_velocity(work, static_cast<float>(radius));
    const int reach = reach_px(velocity);
    const Window widest = united(frame.display, frame.window);  // blur may fill the picture, not leave it
    const Window window = intersection(expanded(frame.window, reach), widest);
    if (window != frame.window) {
      work.change_window(window);
      velocity = half_velocity(work, static_cast<float>(radius));
    }
    const motionblur::BlurInput input{frame.has(Role::depth) ? ConstPlaneView(frame.depth()) : ConstPlaneView(),
                                      &velocity, frame.window, frame.display.height()};
    motionblur::HalfVelocity tiles;
    for (Layer& layer : frame.layers) {
      if (!layer.receives_blur) continue;
      blur(layer, input, work.options.diagnostics ? &tiles : nullptr);
      if (work.options.grow_data_window)
        layer.data_window = intersection(expanded(layer.data_window, reach), widest);
      else
        warn_of_lost_light(work, layer);
    }
    if (work.options.diagnostics) add_tiles(frame, tiles, radius);
  }

 private:
  void blur(Layer& layer, const motionblur::BlurInput& input, motionblur::HalfVelocity* tiles) const {
    std::vector<Plane*> channels;
    for (Plane& plane : layer.planes) channels.push_back(&plane);
    motionblur::scalable_motion_blur(params_, input, channels, tiles);
    layer.changed = true;
  }

  static void warn_of_lost_light(Work& work, const Layer& layer) {
    const Light light = light_of(layer, work.frame.window, layer.data_window);
    const double lost = light.all > 0 ? 1 - light.inside / light.all : 0;
    if (lost > kWorthSaying)
      work.warn(cat("the data window cuts off ", fixed(100 * lost, 2),
                    " % of the blurred light; --data-window grow keeps it"));
  }

  motionblur::HalfVelocity half_velocity(Work& work, float radius) const {
    const auto plane = [&](Role role, size_t i) {
      return work.frame.has(role) ? ConstPlaneView(work.frame.planes(role)[i]) : ConstPlaneView();
    };
    return motionblur::half_velocity(plane(Role::velocity_prev, 0), plane(Role::velocity_prev, 1),
                                     plane(Role::velocity_next, 0), plane(Role::velocity_next, 1), shutter_frames(work),
                                     radius);
  }

  float shutter_frames(Work& work) const {
    if (!params_.shutter_from_header) return params_.shutter_frames;
    if (work.frame.shutter_angle_deg) return *work.frame.shutter_angle_deg / 360.0F;
    work.note(cat("no shutterAngle in the header: the shutter is ", params_.shutter_frames, " frames"));
    return params_.shutter_frames;
  }

  /// The neighbourhood's velocity at every pixel.
  static void add_tiles(Frame& frame, const motionblur::HalfVelocity& tiles, int tile) {
    if (tiles.x.empty()) return;
    const motionblur::TileGrid grid(tile, frame.window);
    for (const auto& [name, source] :
         {std::pair{"aftershade.tile_velocity.x", &tiles.x}, {"aftershade.tile_velocity.y", &tiles.y}}) {
      Plane plane(frame.window.width(), frame.window.height());
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x) plane(x, y) = (*source)(grid.column_of(x), grid.row_of(y));
      frame.added[name] = std::move(plane);
    }
  }

  motionblur::ScalableBlurParams params_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const motionblur::ScalableBlurParams& params) {
  return std::make_unique<ScalableBlur>(params);
}

}  // namespace aftershade::pipeline
