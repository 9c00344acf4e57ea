#include "core/report/worst_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/base/error.h"
#include "core/parallel/rows.h"

namespace aftershade::tests {
namespace {

using namespace report;

/// Owns the planes of one picture.
struct Image {
  std::vector<Plane> planes;
  Image(int width, int height, size_t count, float value) {
    for (size_t i = 0; i < count; ++i) planes.emplace_back(width, height, value);
  }
  Pixels pixels() const { return {planes.begin(), planes.end()}; }
};

Image noise(int width, int height, size_t count, unsigned seed) {
  Image out(width, height, count, 0);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(-0.2F, 1.4F);
  for (Plane& plane : out.planes)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) plane(x, y) = value(random);
  return out;
}

double seen(float value, bool grey) {
  const double clipped = std::isnan(value) ? 0.0 : std::clamp(static_cast<double>(value), 0.0, 1.0);
  return grey ? clipped : std::sqrt(clipped);
}

/// Straight from the header: every box of the size, every pixel of it.
FrameError naive(const std::vector<Image>& candidates, const Image& reference, int region_px) {
  const int width = reference.planes[0].width(), height = reference.planes[0].height();
  const size_t planes = reference.planes.size();
  std::vector<std::vector<uint64_t>> map(static_cast<size_t>(height),
                                         std::vector<uint64_t>(static_cast<size_t>(width)));
  FrameError out;
  for (const Image& candidate : candidates) {
    uint64_t sum = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double squares = 0;
        for (size_t p = 0; p < planes; ++p)
          squares +=
              std::pow(seen(candidate.planes[p](x, y), planes == 1) - seen(reference.planes[p](x, y), planes == 1), 2);
        const auto error = static_cast<uint64_t>(std::lround(squares / static_cast<double>(planes) * 65536));
        map[static_cast<size_t>(y)][static_cast<size_t>(x)] += error;
        sum += error;
      }
    out.worst = std::max(out.worst, std::sqrt(static_cast<double>(sum) / 65536 / (width * height)));
  }
  const int w = std::min(region_px, width), h = std::min(region_px, height);
  uint64_t best = 0;
  for (int y = 0; y + h <= height; ++y)
    for (int x = 0; x + w <= width; ++x) {
      uint64_t sum = 0;
      for (int j = y; j < y + h; ++j)
        for (int i = x; i < x + w; ++i) sum += map[static_cast<size_t>(j)][static_cast<size_t>(i)];
      if (sum > best) best = sum, out.region = {x, y, x + w - 1, y + h - 1};
    }
  return out;
}

std::vector<Pixels> pixels_of(const std::vector<Image>& images) {
  std::vector<Pixels> out;
  for (const Image& image : images) out.push_back(image.pixels());
  return out;
}

TEST(FrameErrors, AgreeWithTheNaiveTwin) {
  for (const size_t planes : {1U, 3U})
    for (const int region_px : {1, 5, 16, 40}) {
      const Image reference = noise(33, 21, planes, 1);
      std::vector<Image> candidates;
      candidates.push_back(noise(33, 21, planes, 2));
      candidates.push_back(noise(33, 21, planes, 3));
      candidates[1].planes[0](4, 4) = std::numeric_limits<float>::quiet_NaN();
      const FrameError expected = naive(candidates, reference, region_px);
      const FrameError found = frame_error(pixels_of(candidates), reference.pixels(), {}, region_px);
      EXPECT_EQ(found.worst, expected.worst) << planes << " planes, region " << region_px;
      EXPECT_EQ(found.region, expected.region) << planes << " planes, region " << region_px;
    }
}

TEST(FrameErrors, DoNotDependOnThreads) {
  const Image reference = noise(64, 48, 3, 5), candidate = noise(64, 48, 3, 6);
  const int threads = thread_count();
  set_thread_count(1);
  const FrameError one = frame_error({candidate.pixels()}, reference.pixels(), {}, 10);
  set_thread_count(4);
  const FrameError four = frame_error({candidate.pixels()}, reference.pixels(), {}, 10);
  set_thread_count(threads);
  EXPECT_EQ(one.worst, four.worst);
  EXPECT_EQ(one.region, four.region);
}

TEST(FrameErrors, WithoutReferenceTheSpreadOfTheCandidatesCounts) {
  Image a(30, 30, 1, 0.5F), b(30, 30, 1, 0.5F), c(30, 30, 1, 0.5F);
  b.planes[0](20, 3) = 0.75F;
  c.planes[0](20, 3) = 0.25F;
  const FrameError error = frame_error({a.pixels(), b.pixels(), c.pixels()}, {}, {}, 3);
  EXPECT_DOUBLE_EQ(error.worst, std::sqrt(0.25 / 900));
  EXPECT_TRUE(error.region.contains(20, 3));
}

TEST(FrameErrors, ASingleCandidateIsComparedWithTheInput) {
  Image input(8, 8, 3, 1.0F), candidate(8, 8, 3, 1.0F);
  for (Plane& plane : candidate.planes) plane(7, 7) = 0.25F;
  const FrameError error = frame_error({candidate.pixels()}, {}, input.pixels(), 2);
  EXPECT_DOUBLE_EQ(error.worst, std::sqrt(0.25 / 64));
  EXPECT_EQ(error.region, (Window{6, 6, 7, 7}));
  EXPECT_EQ(frame_error({Image(8, 8, 1, 0).pixels()}, {}, input.pixels(), 2).worst, 0) << "AO is no colour";
}

TEST(FrameErrors, NoneAnywhereIsTheMiddle) {
  const Image flat(30, 20, 3, 0.5F);
  const FrameError error = frame_error({flat.pixels()}, flat.pixels(), {}, 10);
  EXPECT_EQ(error.worst, 0);
  EXPECT_EQ(error.region, (Window{10, 5, 19, 14}));
}

/// Frame `number` of grey pictures that differ from the reference by `difference` in the pixel (x, y).
void offer(WorstFrames& worst, int number, float difference, int x = 0, int y = 0, int width = 40, int height = 20) {
  const Image reference(width, height, 1, 0.25F);
  Image candidate(width, height, 1, 0.25F);
  candidate.planes[0](x, y) += difference;
  worst.offer(number, {candidate.pixels()}, reference.pixels(), {});
}

std::vector<int> numbers_of(const std::vector<ShownFrame>& frames) {
  std::vector<int> out;
  for (const ShownFrame& frame : frames) out.push_back(frame.number);
  return out;
}

TEST(WorstFrames, KeepsTheWorstByNumber) {
  ShowOptions options;
  options.max_frames = 3;
  WorstFrames worst({0, 0, 39, 19}, options);
  const std::vector<float> errors{0.1F, 0.5F, 0.2F, 0.5F, 0.05F, 0.3F, 0.3F};
  for (size_t i = 0; i < errors.size(); ++i) offer(worst, static_cast<int>(i) + 100, errors[i]);
  EXPECT_EQ(numbers_of(worst.take()), (std::vector{101, 103, 105}));
  EXPECT_TRUE(worst.take().empty());
}

TEST(WorstFrames, PicturesAreCandidatesReferenceAndInput) {
  ShowOptions options;
  options.region_px = 10;
  options.whole_width_px = 20;
  WorstFrames worst({100, 50, 139, 69}, options);
  offer(worst, 1, 0.5F, 33, 17);
  const std::vector<ShownFrame> frames = worst.take();
  ASSERT_EQ(frames.size(), 1U);
  const ShownFrame& frame = frames[0];
  EXPECT_TRUE(frame.region.contains(133, 67));
  EXPECT_EQ(frame.region.width(), 10);
  EXPECT_NEAR(frame.error, 0.5 / std::sqrt(800), 1e-4);
  ASSERT_EQ(frame.whole.size(), 3U);
  ASSERT_EQ(frame.detail.size(), 3U);
  EXPECT_EQ(frame.whole[1].width, 20);
  EXPECT_EQ(frame.whole[1].rgb[0], 64);
  EXPECT_TRUE(frame.whole[2].empty());
  const auto x = static_cast<size_t>(133 - frame.region.min_x), y = static_cast<size_t>(67 - frame.region.min_y);
  EXPECT_EQ(frame.detail[0].rgb[3 * (y * 10 + x)], 191) << "0.75";
}

TEST(WorstFrames, SmallFramesAreTheirOwnDetail) {
  WorstFrames worst({0, 0, 39, 19}, {});
  offer(worst, 1, 0.5F);
  const std::vector<ShownFrame> frames = worst.take();
  EXPECT_TRUE(frames.at(0).detail.empty());
  EXPECT_EQ(frames[0].whole[0].width, 40);
}

TEST(WorstFrames, MemoryIsBounded) {
  ShowOptions options;
  options.max_bytes = 2 * 2 * 40 * 20 * 3;  // two frames of a candidate and a reference
  WorstFrames worst({0, 0, 39, 19}, options);
  for (int i = 0; i < 9; ++i) offer(worst, i, 0.05F * static_cast<float>(i));
  EXPECT_EQ(numbers_of(worst.take()), (std::vector{7, 8}));
  options.max_bytes = 1;
  WorstFrames one({0, 0, 39, 19}, options);
  for (int i = 0; i < 3; ++i) offer(one, i, 0.1F * static_cast<float>(i));
  EXPECT_EQ(numbers_of(one.take()), (std::vector{2}));
}

TEST(WorstFrames, OtherSizesAreRefused) {
  WorstFrames worst({0, 0, 39, 19}, {});
  EXPECT_THROW(offer(worst, 1, 0.5F, 0, 0, 41, 20), Error);
}

}  // namespace
}  // namespace aftershade::tests
