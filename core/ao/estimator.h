#pragma once

/// What every AO method lets its user choose.
namespace aftershade::ao {

/// Every pixel, one of every 2x2 block, or so and again every pixel that those blocks do not represent.
enum class Resolution { full, half, dual };
/// The file's where it has some and else the depth's, the file's only, the depth's only.
enum class NormalSource { automatic, file, depth };

}  // namespace aftershade::ao
