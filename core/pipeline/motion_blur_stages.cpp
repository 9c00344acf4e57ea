#include <cmath>

#include "core/base/text.h"
#include "core/parallel/rows.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

namespace {

/// The window in which blurred pixels can appear: `reach` pixels around the data, but not past the display window.
Window blurred_window(const Frame& frame, int reach) {
  const Window w = frame.window;
  const Window spread{w.min_x - reach, w.min_y - reach, w.max_x + reach, w.max_y + reach};
  return intersection(spread, united(frame.display, w));
}

/// Share of the light below which nobody needs to hear of its loss.
constexpr double kWorthSaying = 1e-3;

/// Sum of |value| of the first three planes over the pixels inside or outside `inner`.
double energy(const Layer& layer, Window window, Window inner, bool inside) {
  double sum = 0;
  for (size_t c = 0; c < layer.planes.size() && c < 3; ++c)
    for (int y = 0; y < window.height(); ++y)
      for (int x = 0; x < window.width(); ++x) {
        const float value = layer.planes[c](x, y);
        if (inner.contains(x + window.min_x, y + window.min_y) == inside && std::isfinite(value))
          sum += std::abs(value);
      }
  return sum;
}

class ScalableBlur final : public Stage {
 public:
  explicit ScalableBlur(const motionblur::ScalableBlurParams& params) : params_(params) {}

  Needs needs(const Offer&) const override {
    Needs needs;
    needs.any_of = {Role::velocity_next, Role::velocity_prev};
    needs.optional = {Role::depth};
    needs.layers = true;
    return needs;
  }

  void run(Work& work) override {
    Frame& frame = work.frame;
    const int radius = motionblur::max_radius_px(params_, frame.display.height());
    const Window data = frame.window;
    work.change_window(blurred_window(frame, radius));
    const motionblur::HalfVelocity velocity = half_velocity(work, static_cast<float>(radius));
    const motionblur::BlurInput input{frame.has(Role::depth) ? ConstPlaneView(frame.depth()) : ConstPlaneView(),
                                      &velocity, frame.window, frame.display.height()};
    motionblur::HalfVelocity tiles;
    for (Layer& layer : frame.layers)
      if (layer.receives_blur) blur(layer, input, work.options.diagnostics ? &tiles : nullptr);
    if (work.options.diagnostics) add_tiles(frame, tiles, radius);
    if (!work.options.grow_data_window) crop(work, data);
  }

 private:
  void blur(Layer& layer, const motionblur::BlurInput& input, motionblur::HalfVelocity* tiles) const {
    std::vector<Plane*> channels;
    for (Plane& plane : layer.planes) channels.push_back(&plane);
    motionblur::scalable_motion_blur(params_, input, channels, tiles);
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

  /// Back to the data window, saying how much light that cuts off.
  static void crop(Work& work, Window data) {
    const Frame& frame = work.frame;
    if (frame.window == data) return;
    double lost = 0, kept = 0;
    for (const Layer& layer : frame.layers)
      if (layer.receives_blur) {
        lost += energy(layer, frame.window, data, false);
        kept += energy(layer, frame.window, data, true);
      }
    if (lost > kWorthSaying * (lost + kept))
      work.warn(cat("the data window cuts off ", fixed(100 * lost / (lost + kept), 2),
                    " % of the blurred light; --data-window grow keeps it"));
    work.change_window(data);
  }

  static void add_tiles(Frame& frame, const motionblur::HalfVelocity& tiles, int tile) {
    for (const auto& [name, source] :
         {std::pair{"aftershade.tile_velocity.x", &tiles.x}, {"aftershade.tile_velocity.y", &tiles.y}}) {
      if (source->empty()) continue;
      Plane plane(frame.window.width(), frame.window.height());
      const auto tile_of = [tile](int absolute, int first) {
        return static_cast<int>(std::floor(static_cast<double>(absolute) / tile) -
                                std::floor(static_cast<double>(first) / tile));
      };
      for_rows(plane.height(), [&](int y) {
        for (int x = 0; x < plane.width(); ++x)
          plane(x, y) = (*source)(tile_of(x + frame.window.min_x, frame.window.min_x),
                                  tile_of(y + frame.window.min_y, frame.window.min_y));
      });
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
