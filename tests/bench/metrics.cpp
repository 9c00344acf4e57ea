// What each score costs per frame of 1920x1080, each alone and all together: bench_metrics [--frames N] [--threads N].
#include <cstdio>
#include <string>

#include "core/math/sampling.h"
#include "core/metrics/sequence_scores.h"
#include "tests/bench/timing.h"

namespace {

using namespace aftershade;
constexpr int kWidth = 1920, kHeight = 1080;

/// A camera that pans by half a pixel a frame over a wall with ribs, and two noisy pictures of it.
struct Frames {
  std::array<Plane, 3> color, true_color;
  Plane ao, true_ao, depth, velocity_x, velocity_y;
  Camera camera;
  explicit Frames(int number) {
    const auto plane = [&](auto&& value) {
      Plane out(kWidth, kHeight);
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) out(x, y) = value(x, y);
      return out;
    };
    const auto noise = [number](int x, int y, uint32_t seed) {
      return unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y + 4096 * number), seed));
    };
    for (uint32_t c = 0; c < 3; ++c) {
      true_color[c] = plane([&](int x, int y) { return 0.4F + 0.3F * static_cast<float>((x / 16 + y / 16 + c) % 2); });
      color[c] = plane([&](int x, int y) { return true_color[c](x, y) + 0.1F * noise(x, y, c); });
    }
    true_ao = copy_of(true_color[0]);
    ao = copy_of(color[0]);
    depth = plane([](int x, int) { return x % 64 < 2 ? 3.9F : 4.0F; });
    velocity_x = plane([](int x, int y) { return x > 900 && y > 500 && y < 600 ? 5.0F : 0.5F; });
    velocity_y = Plane(kWidth, kHeight);
    camera.fx = camera.fy = 1000;
    camera.cx = 960;
    camera.cy = 540;
    camera.world_to_camera = Mat4();
    (*camera.world_to_camera)[3][0] = -0.002 * number;
  }
  metrics::ScoredFrame scored(int number) const {
    metrics::ScoredFrame out;
    out.number = number;
    out.color = {color[0], color[1], color[2]};
    out.true_color = {true_color[0], true_color[1], true_color[2]};
    out.ao = ao;
    out.true_ao = true_ao;
    out.depth = depth;
    out.velocity_x = velocity_x;
    out.velocity_y = velocity_y;
    out.camera = camera;
    return out;
  }
};

/// Median milliseconds of a frame that has one before it.
double cost(const std::vector<std::string>& names, const std::vector<Frames>& frames) {
  metrics::SequenceScorer scorer(names);
  scorer.add(frames[0].scored(0));
  std::vector<double> times;
  for (int i = 1; i < static_cast<int>(frames.size()); ++i)
    times.push_back(tests::milliseconds([&] { scorer.add(frames[static_cast<size_t>(i)].scored(i)); }));
  return tests::median(times);
}

}  // namespace

int main(int argc, char** argv) {
  int count = 4;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--frames") count = std::max(2, std::atoi(argv[i + 1]));
    if (std::string(argv[i]) == "--threads") set_thread_count(std::atoi(argv[i + 1]));
  }
  std::vector<Frames> frames;
  for (int i = 0; i < count; ++i) frames.emplace_back(i);
  std::printf("%d threads, %dx%d\n", thread_count(), kWidth, kHeight);
  std::vector<std::string> all;
  for (const metrics::MetricInfo& metric : metrics::metric_infos()) {
    all.emplace_back(metric.name);
    std::printf("%-24s %8.1f ms\n", all.back().c_str(), cost({all.back()}, frames));
    std::fflush(stdout);
  }
  std::printf("%-24s %8.1f ms\n", "all together", cost(all, frames));
}
