#pragma once

/// What every AO method lets its user choose.
namespace aftershade::ao {

/// Every pixel, one of every 2x2 block, or so and again every pixel that those blocks do not represent.
enum class Resolution { full, half, dual };
enum class NormalSource {
  automatic,
  file,
  depth
};  ///< the file's where it has some, the file's only, the depth's only

}  // namespace aftershade::ao
