#include <array>

#include "core/temporal/history_use.h"
#include "tests/temporal/blur_frames.h"

namespace aftershade::tests {
namespace {

using temporal::code_of;
using temporal::HistoryUse;

/// Without w_difference all history that is found has weight, and none that is not.
TEST(HistoryUse, OfTheTemporalBlurIsUsedWhereItsHistoryWeighs) {
  for (const int step : {1, 2})
    for (const bool literal : {false, true}) {
      const Lens lens;
      BlurFrame first(picture(61, 41, lens, slope_with_bars(lens)), step),
          second(picture(61, 41, lens, slope_with_bars(lens)), step);
      temporal::TemporalBlurParams params;
      params.difference_scale = 0;
      params.literal = literal;
      temporal::TemporalBlurHistory history;
      const auto use_of = [&](const BlurFrame& frame) {
        return history_use(params, frame.grid, frame.surface, frame.where, history);
      };
      EXPECT_EQ(use_of(first)(0, 0), code_of(HistoryUse::none));
      first.run(params, history);
      disturb(second, 4, 0.1F);
      const Plane use = use_of(second);
      second.run(params, history);
      std::array<int, temporal::kHistoryUses> count{};
      int wrong = 0;
      for (int y = 0; y < use.height(); ++y)
        for (int x = 0; x < use.width(); ++x) {
          ++count[static_cast<size_t>(use(x, y))];
          wrong += (use(x, y) == code_of(HistoryUse::used)) != (history.weight(x, y) > 0) ? 1 : 0;
        }
      EXPECT_LE(wrong, 1) << "texels whose distance is the limit but for rounding";
      for (const HistoryUse reason : {HistoryUse::used, HistoryUse::unknown_motion, HistoryUse::other_surface})
        EXPECT_GT(count[static_cast<size_t>(reason)], 10) << static_cast<int>(reason);
      EXPECT_GT(count[static_cast<size_t>(HistoryUse::outside)], 0);
    }
}

}  // namespace
}  // namespace aftershade::tests
