#include "core/temporal/history_use.h"

#include <array>

#include "core/temporal/accumulation.h"
#include "core/temporal/selective_temporal.h"
#include "tests/temporal/temporal_helpers.h"

namespace aftershade::tests {
namespace {

using temporal::code_of;
using temporal::HistoryUse;
using temporal::Reprojected;

constexpr int kWidth = 61, kHeight = 43;
constexpr Window kNow{10, -6, 10 + kWidth - 1, -6 + kHeight - 1};
constexpr Window kBefore{13, -9, 13 + kWidth + 2, -9 + kHeight - 5};

/// A frame with background, unknown pixels and pasts that lie up to 6 pixels away, and a history of layers of depth.
struct Frames {
  Plane depth = plane_of(kWidth, kHeight, [](int x, int y) { return noise(x, y, 2) < 0.1F ? kInf : 4.0F; });
  Plane stored = plane_of(kBefore.width(), kBefore.height(), [](int x, int y) {
    return noise(x, y, 3) < 0.1F ? 0.0F : (noise(x / 5, y / 5, 4) < 0.3F ? 6.0F : 4 + 0.3F * noise(x, y, 5));
  });
  Reprojected past{moved(kNow.min_x, true, 6), moved(kNow.min_y, false, 7),
                   plane_of(kWidth, kHeight, [](int x, int y) { return noise(x, y, 8) < 0.03F ? kNaN : 4.1F; })};

  static Plane moved(int min, bool along_x, int seed) {
    return plane_of(kWidth, kHeight, [=](int x, int y) {
      if (noise(x, y, 9) < 0.04F) return kNaN;
      return static_cast<float>(min + (along_x ? x : y)) + 0.5F + 12 * noise(x, y, seed) - 6;
    });
  }
};

/// The definition of each reason, in double.
HistoryUse twin(const Frames& f, int x, int y, double epsilon, bool nearest) {
  const double at_x = f.past.x(x, y), at_y = f.past.y(x, y), expected = f.past.depth(x, y);
  if (!std::isfinite(f.depth(x, y))) return HistoryUse::background;
  if (std::isnan(at_x) || std::isnan(at_y) || std::isnan(expected)) return HistoryUse::unknown_motion;
  const auto weight = [&](double column, double row) {
    if (!kBefore.contains(static_cast<int>(column), static_cast<int>(row))) return 0.0;
    const double z = f.stored(static_cast<int>(column) - kBefore.min_x, static_cast<int>(row) - kBefore.min_y);
    if (!(z > 0 && std::abs(1 - expected / z) < epsilon)) return 0.0;
    if (nearest) return 1.0;
    return (1 - std::abs(at_x - 0.5 - column)) * (1 - std::abs(at_y - 0.5 - row));
  };
  double found = 0;
  if (nearest)
    found = weight(std::floor(at_x), std::floor(at_y));
  else
    for (const int j : {0, 1})
      for (const int i : {0, 1}) found += weight(std::floor(at_x - 0.5) + i, std::floor(at_y - 0.5) + j);
  if (found >= 0.25) return HistoryUse::used;
  const bool inside = kBefore.contains(static_cast<int>(std::floor(at_x)), static_cast<int>(std::floor(at_y)));
  return inside ? HistoryUse::other_surface : HistoryUse::outside;
}

TEST(HistoryUse, AgreesWithTheTwinAndEveryReasonOccurs) {
  const Frames f;
  for (const bool nearest : {false, true}) {
    const Plane use = history_use(f.depth, f.past, f.past.depth, {f.stored, kBefore, 0.1F, nearest});
    std::array<int, temporal::kHistoryUses> count{};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        EXPECT_EQ(use(x, y), code_of(twin(f, x, y, double{0.1F}, nearest))) << x << ' ' << y;
        ++count[static_cast<size_t>(use(x, y))];
      }
    for (const HistoryUse reason : {HistoryUse::background, HistoryUse::used, HistoryUse::unknown_motion,
                                    HistoryUse::outside, HistoryUse::other_surface})
      EXPECT_GT(count[static_cast<size_t>(reason)], 20) << static_cast<int>(reason);
  }
}

TEST(HistoryUse, IsUsedExactlyWhereTheFiltersUseIt) {
  const Frames f;
  const auto ones = [&] { return Plane(kBefore.width(), kBefore.height(), 1); };
  const Plane ao(kWidth, kHeight, 0.5F);
  const temporal::AccumulationHistory cache{kBefore, ones(), copy_of(f.stored), ones(), {}};
  const temporal::Past found = temporal::look_up(cache, f.past, f.past.depth, 0.1F);
  for (const bool literal : {false, true}) {
    const Plane use = history_use(f.depth, f.past, f.past.depth, {f.stored, kBefore, 0.1F, literal});
    temporal::SelectiveTemporalParams params;
    params.selective = false;
    params.literal = literal;
    temporal::TemporalHistory history{kBefore, ones(), copy_of(f.stored), ones(), {}, {}, {}};
    temporal::selective_temporal_filter(params, ao, f.depth, Plane(), f.past, kNow, history);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (!std::isfinite(f.depth(x, y))) continue;
        const bool used = use(x, y) == code_of(HistoryUse::used);
        EXPECT_EQ(used, history.count(x, y) > 1) << x << ' ' << y << (literal ? " literally" : "");
        EXPECT_TRUE(literal || used == (found.weight(x, y) > 0)) << x << ' ' << y;
      }
  }
}

TEST(HistoryUse, WithoutHistoryThereIsNone) {
  const Frames f;
  const Plane use = history_use(f.depth, f.past, f.past.depth, {{}, {}, 0.1F});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      EXPECT_EQ(use(x, y), code_of(std::isfinite(f.depth(x, y)) ? HistoryUse::none : HistoryUse::background));
}

TEST(HistoryUse, MarksSurfacesOnly) {
  const Frames f;
  Plane use = history_use(f.depth, f.past, f.past.depth, {f.stored, kBefore, 0.1F});
  const Plane before = copy_of(use);
  mark(use, HistoryUse::stable, [](int x, int) { return x < 30; });
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool marked = x < 30 && std::isfinite(f.depth(x, y));
      EXPECT_EQ(use(x, y), marked ? code_of(HistoryUse::stable) : before(x, y));
    }
}

}  // namespace
}  // namespace aftershade::tests
