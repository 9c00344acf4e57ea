#include "core/temporal/temporal_blur.h"
#include "tests/temporal/blur_frames.h"

namespace aftershade::tests {
namespace {

using temporal::BlurTaps;
using temporal::temporal_blur;
using temporal::TemporalBlurHistory;
using temporal::TemporalBlurParams;

/// The filter from the header, in double, one texel at a time.
struct Twin {
  const TemporalBlurParams& params;
  const BlurFrame& frame;
  Lens lens;

  int width() const { return frame.value.width(); }
  int height() const { return frame.value.height(); }
  bool surface(int x, int y) const { return std::isfinite(frame.grid.depth(x, y)); }
  Vec3 point(int x, int y) const {
    return lens.point(frame.pixel_x(x, y) + 0.5, frame.pixel_y(x, y) + 0.5, frame.grid.depth(x, y));
  }
  Vec3 normal(int x, int y) const {
    const auto& n = frame.picture.normals;
    const int px = frame.pixel_x(x, y) - frame.picture.origin_x, py = frame.pixel_y(x, y) - frame.picture.origin_y;
    return {n[0](px, py), n[1](px, py), n[2](px, py)};
  }
  double cut(double z) const {
    const double footprint = frame.grid.step * (lens.orthographic ? 1 : z) / std::min(lens.fx, lens.fy);
    return std::max<double>(params.cut_m, params.cut_footprints * footprint);
  }
  double distance(const Vec3& v, const Vec3& n) const {
    return std::abs(params.literal || n.length() == 0 ? v.z : v.dot(n));
  }
  using Image = std::vector<double>;
  double at(const Image& image, int x, int y) const { return image[static_cast<size_t>(y * width() + x)]; }

  Image blurred(Image image) const {
    const std::array<double, 3> weights =
        params.weights == BlurTaps::box ? std::array{1.0, 1.0, 1.0} : std::array{6.0, 4.0, 1.0};
    for (const bool down : {false, true}) {
      Image out = image;
      for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) {
          if (!surface(x, y)) continue;
          double sum = 0, total = 0;
          for (int t = -2; t <= 2; ++t) {
            const int tx = down ? x : x + t, ty = down ? y + t : y;
            if (tx < 0 || ty < 0 || tx >= width() || ty >= height() || !surface(tx, ty)) continue;
            if (distance(point(tx, ty) - point(x, y), normal(x, y)) > cut(point(x, y).z)) continue;
            sum += weights[static_cast<size_t>(std::abs(t))] * at(image, tx, ty);
            total += weights[static_cast<size_t>(std::abs(t))];
          }
          out[static_cast<size_t>(y * width() + x)] = sum / total;
        }
      image = out;
    }
    return image;
  }

  /// Value and w_geometry of the texel's history.
  std::pair<double, double> history(const TemporalBlurHistory& before, int x, int y) const {
    const int px = frame.pixel_x(x, y) - frame.picture.origin_x, py = frame.pixel_y(x, y) - frame.picture.origin_y;
    const double X = frame.where.x(px, py), Y = frame.where.y(px, py);
    if (!std::isfinite(X)) return {0, 0};
    const int step = frame.grid.step;
    const auto offset = [&](int p) { return p - step * static_cast<int>(std::floor(p / static_cast<double>(step))); };
    const double u = (X - 0.5 - offset(frame.pixel_x(x, y))) / step, v = (Y - 0.5 - offset(frame.pixel_y(x, y))) / step;
    const Vec3 expected = lens.point(X, Y, frame.where.depth(px, py));
    const double scale = cut(point(x, y).z) / params.cut_m;
    double same = 0, sum = 0, value = 0;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const int tx = static_cast<int>(std::floor(u)) + i - before.texel_x,
                  ty = static_cast<int>(std::floor(v)) + j - before.texel_y;
        if (tx < 0 || ty < 0 || tx >= before.value.width() || ty >= before.value.height()) continue;
        const auto& p = before.texels.point;
        const auto& n = before.texels.normal;
        if (!std::isfinite(p[2](tx, ty))) continue;
        const Vec3 seen(p[0](tx, ty), p[1](tx, ty), p[2](tx, ty)), up(n[0](tx, ty), n[1](tx, ty), n[2](tx, ty));
        const double along = lens.orthographic ? 1 : expected.length() / expected.z;
        const double d = distance(expected - seen, up) * (params.literal ? along : 1);
        const double t = std::clamp((d / scale - params.near_m) / (params.far_m - params.near_m), 0.0, 1.0);
        const double near = 1 - t * t * (3 - 2 * t);
        const double bilinear = (1 - std::abs(u - std::floor(u) - i)) * (1 - std::abs(v - std::floor(v) - j));
        if (near <= 0) continue;
        same += bilinear;
        sum += bilinear * near;
        value += bilinear * near * before.value(tx, ty);
      }
    return same < 0.25 ? std::pair(0.0, 0.0) : std::pair(value / sum, sum / same);
  }

  Image step(const TemporalBlurHistory& before) const {
    Image raw;
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width(); ++x) raw.push_back(frame.value(x, y));
    Image image = blurred(raw);
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width(); ++x) {
        const auto [old, geometry] = surface(x, y) ? history(before, x, y) : std::pair(0.0, 0.0);
        if (geometry == 0) continue;
        double& now = image[static_cast<size_t>(y * width() + x)];
        const double difference = std::abs(now - old) / std::max({now, old, 0.1});
        const double alike = 1 - std::min(1.0, params.difference_scale * difference);
        now += params.history_weight * geometry * alike * alike * (old - now);
      }
    return blurred(image);
  }
};

TEST(TemporalBlur, AgreesWithTheTwin) {
  for (const bool orthographic : {false, true})
    for (const bool literal : {false, true})
      for (const int step : {1, 2}) {
        const Lens lens{80, 60, 30, 20, orthographic};
        TemporalBlurParams params;
        params.literal = literal;
        params.weights = step == 1 ? BlurTaps::box : BlurTaps::binomial;
        params.cut_footprints = literal ? 0.5F : 1.5F;
        params.difference_scale = 0.7F;
        BlurFrame first(picture(61, 47, lens, slope_with_bars(lens), -3, 2), step);
        BlurFrame second(picture(63, 41, lens, slope_with_bars(lens), -4, 5), step);
        first.set_value(noise);
        second.set_value([](int x, int y) { return 0.5F * noise(x, y) + 0.5F * random_at(x, y, 10); });
        disturb(second, 3, 0.15F);
        TemporalBlurHistory history;
        first.run(params, history);
        const Twin::Image want = Twin{params, second, lens}.step(history);
        const Plane got = second.run(params, history);
        int off = 0, blended = 0;
        double far_off = 0;
        for (int y = 0; y < got.height(); ++y)
          for (int x = 0; x < got.width(); ++x) {
            const double error = std::abs(got(x, y) - want[static_cast<size_t>(y * got.width() + x)]);
            off += error > 2e-5;  // a neighbour within rounding of the cut
            far_off = std::max(far_off, error);
            blended += history.weight(x, y) > 0;
          }
        EXPECT_LE(off, 25) << far_off << ' ' << orthographic << literal << step;
        EXPECT_GT(blended, got.width() * got.height() / 4);
        EXPECT_LT(blended, got.width() * got.height() * 95 / 100);
      }
}

}  // namespace
}  // namespace aftershade::tests
