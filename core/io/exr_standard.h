#pragma once
#include "core/io/exr_layout.h"

namespace aftershade::io {

/// Is every attribute that OpenEXR knows what the standard says: its type, its size, its values? Then it would accept
/// the headers, too. What is odd is left to OpenEXR to judge, so that both ways of reading agree.
bool has_standard_headers(const ExrLayout& layout);

}  // namespace aftershade::io
