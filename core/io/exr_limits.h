#pragma once
#include "core/io/exr_layout.h"
#include "core/io/exr_reader.h"

namespace aftershade::io {

/// Throws Error(data) when a part is deep, subsampled, mip- or rip-mapped, or asks for more than the limits or than a
/// file of this size can hold (reliability 1.3): before any pixel memory is taken.
void check_parts(const ExrLayout& layout, const ReadLimits& limits, int64_t file_size, const FileInfo& info);

/// Throws Error(data) "`what` is ... pixels, larger than ..." when a window is over the limits; its corners may be
/// anywhere.
void check_window(Window window, std::string_view what, const ReadLimits& limits);

}  // namespace aftershade::io
