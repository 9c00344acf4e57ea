#pragma once
#include <cstdint>

namespace aftershade::temporal {

/// Surface pixels, and those of them without a past.
struct HistoryShare {
  int64_t surface = 0, lost = 0;
};

}  // namespace aftershade::temporal
