#pragma once
#include <span>

#include "core/io/exr_bytes.h"
#include "core/io/exr_handles.h"
#include "core/io/exr_pixels.h"

namespace aftershade::io {

/// A channel of the part's RowLayout on its way into a plane that covers `window`.
struct Wanted {
  size_t channel;
  PlaneView target;
  NotNumbers found;  ///< pixels that are no numbers, among those that both the part and the window have
};

/// Decodes the rows of a part that `window` has, on all threads: chunks of known compressions here, all others with
/// OpenEXR. `keep`, when not null, becomes the pixels of all channels and of the whole part; it has its window and
/// channels. Throws what OpenEXR throws, or Error.
void decode_part(const ExrReader::Handles& handles, int part, std::span<Wanted> wanted, Window window,
                 PackedImage* keep);

}  // namespace aftershade::io
