#include "core/metrics/past.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel/rows.h"

namespace aftershade::metrics {

namespace {
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kAgreement_px = 0.5, kSameDepth = 0.05;

struct Place {
  double x, y, depth;
  bool moving;
};

/// Where the surface of pixel (x, y) was, in absolute coordinates.
Place place_before(const PastInput& in, int x, int y, double depth) {
  const double at_x = in.origin_x + x + 0.5, at_y = in.origin_y + y + 0.5;
  const bool vectors = !in.velocity_x.empty();
  const double by_x = at_x + (vectors ? static_cast<double>(in.velocity_x(x, y)) : NAN);
  const double by_y = at_y + (vectors ? static_cast<double>(in.velocity_y(x, y)) : NAN);
  const bool known = std::isfinite(by_x) && std::isfinite(by_y);
  if (!in.camera) return {by_x, by_y, depth, false};
  const Vec3 still = (*in.camera)(at_x, at_y, depth);
  const bool moves = known && !(std::hypot(by_x - still.x, by_y - still.y) <= kAgreement_px);
  return moves ? Place{by_x, by_y, still.z, true} : Place{still.x, still.y, still.z, false};
}

bool in_picture(const Place& place, ConstPlaneView plane) {
  return place.x >= 0.5 && place.y >= 0.5 && place.x <= plane.width - 0.5 && place.y <= plane.height - 0.5;
}

struct Pixel {
  int x = -1, y = -1;
};
/// Past::pixel_x, pixel_y of a place in index coordinates.
Pixel nearest_that_shows(const Place& place, ConstPlaneView depth_before) {
  Pixel best;
  if (!in_picture(place, depth_before)) return best;
  double least = INFINITY;
  const int x0 = static_cast<int>(place.x - 0.5), y0 = static_cast<int>(place.y - 0.5);
  for (int y = y0; y <= std::min(y0 + 1, depth_before.height - 1); ++y)
    for (int x = x0; x <= std::min(x0 + 1, depth_before.width - 1); ++x) {
      const double away_x = std::abs(x + 0.5 - place.x), away_y = std::abs(y + 0.5 - place.y);
      if (away_x >= 1 || away_y >= 1) continue;  // of no weight
      const double away = std::hypot(away_x, away_y);
      if (!(std::abs(1 - static_cast<double>(depth_before(x, y)) / place.depth) <= kSameDepth) || !(away < least))
        continue;
      least = away;
      best = {x, y};
    }
  return best;
}

/// Is w linear over three neighbours that hold the middle index `i`, or that end or start there?
template <class At>
bool on_a_line(At&& w, int i, int size) {
  constexpr double kTolerance = 0.01;
  const auto line = [&](int first) {
    if (first < 0 || first + 2 >= size) return false;
    return std::abs(w(first) - 2 * w(first + 1) + w(first + 2)) <= kTolerance * w(i);
  };
  return size < 3 || line(i - 1) || line(i - 2) || line(i);
}
}  // namespace

Past past_of(const PastInput& in) {
  const int width = in.depth.width, height = in.depth.height;
  Past past;
  Plane expected(width, height);
  for (Plane* plane : {&past.x, &past.y, &past.moving, &past.pixel_x, &past.pixel_y}) *plane = Plane(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const auto depth = static_cast<double>(in.depth(x, y));
      const bool surface = std::isfinite(depth) && depth > 0;
      Place place = surface ? place_before(in, x, y, depth) : Place{NAN, NAN, NAN, false};
      place.x -= in.origin_x;
      place.y -= in.origin_y;
      const Pixel pixel = nearest_that_shows(place, in.depth_before);
      past.x(x, y) = static_cast<float>(place.x);
      past.y(x, y) = static_cast<float>(place.y);
      past.moving(x, y) = place.moving ? 1.0F : 0.0F;
      past.pixel_x(x, y) = static_cast<float>(pixel.x);
      past.pixel_y(x, y) = static_cast<float>(pixel.y);
      expected(x, y) = static_cast<float>(place.depth);
    }
  });
  past.valid = same_surface({past.x, past.y, {}}, expected, in.depth_before, kSameDepth);
  return past;
}

Plane unstable_pixels(ConstPlaneView depth, int reach_px) {
  Plane thin(depth.width, depth.height);
  for_rows(depth.height, [&](int y) {
    const auto nearness = [&](int i, int j) {
      const auto z = static_cast<double>(depth(i, j));
      return z > 0 ? 1 / z : 0;  // background: 0
    };
    for (int x = 0; x < depth.width; ++x) {
      const bool across = on_a_line([&](int i) { return nearness(i, y); }, x, depth.width);
      const bool along = on_a_line([&](int j) { return nearness(x, j); }, y, depth.height);
      thin(x, y) = nearness(x, y) > 0 && !(across && along) ? 1.0F : 0.0F;
    }
  });
  Plane out = grown(thin, reach_px);
  for_rows(depth.height, [&](int y) {
    for (int x = 0; x < depth.width; ++x)
      if (!(depth(x, y) > 0) || !std::isfinite(depth(x, y))) out(x, y) = 0;
  });
  return out;
}

Plane grown(ConstPlaneView mask, int reach_px) {
  Plane wide(mask.width, mask.height), out(mask.width, mask.height);
  for_rows(mask.height, [&](int y) {
    for (int x = 0, last = -1; x < mask.width + reach_px; ++x) {  // last: end of what has been set
      if (x >= mask.width || !(mask(x, y) > 0.5F)) continue;
      const int end = std::min(x + reach_px, mask.width - 1);
      for (int i = std::max({x - reach_px, last + 1, 0}); i <= end; ++i) wide(i, y) = 1;
      last = end;
    }
  });
  for_rows(mask.height, [&](int y) {
    for (int j = std::max(y - reach_px, 0); j <= std::min(y + reach_px, mask.height - 1); ++j)
      for (int x = 0; x < mask.width; ++x) out(x, y) = std::max(out(x, y), wide(x, j));
  });
  return out;
}

Plane moving_footprint(const Past& past, int reach_px) {
  constexpr float kEnough = 4;
  const Plane& moving = past.moving;
  Plane together(moving.width(), moving.height());
  for_rows(moving.height(), [&](int y) {
    for (int x = 0; x < moving.width(); ++x) {
      float around = 0;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, moving.height() - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, moving.width() - 1); ++i) around += moving(i, j);
      together(x, y) = moving(x, y) > 0 && around >= kEnough ? 1.0F : 0.0F;
    }
  });
  return grown(together, reach_px);
}

Plane disoccluded(const Past& past) {
  Plane out(past.x.width(), past.x.height());
  for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x) {
      const Place place{static_cast<double>(past.x(x, y)), static_cast<double>(past.y(x, y)), 0, false};
      out(x, y) = in_picture(place, past.x) && past.pixel_x(x, y) < 0 ? 1.0F : 0.0F;
    }
  });
  return out;
}

Plane frames_since(ConstPlaneView event, ConstPlaneView since_before, const Past& past) {
  Plane out(event.width, event.height, std::numeric_limits<float>::infinity());
  for_rows(event.height, [&](int y) {
    for (int x = 0; x < event.width; ++x) {
      const int px = static_cast<int>(past.pixel_x(x, y)), py = static_cast<int>(past.pixel_y(x, y));
      if (event(x, y) > 0.5F)
        out(x, y) = 0;
      else if (!since_before.empty())
        out(x, y) = px >= 0 ? since_before(px, py) + 1 : kUnknown;
    }
  });
  return out;
}

}  // namespace aftershade::metrics
