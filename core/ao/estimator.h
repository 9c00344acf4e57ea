#pragma once

/// What every AO method lets its user choose.
namespace aftershade::ao {

enum class Resolution { full, half };  ///< every pixel, or one of every 2x2 block
enum class NormalSource {
  automatic,
  file,
  depth
};  ///< the file's where it has some, the file's only, the depth's only

}  // namespace aftershade::ao
