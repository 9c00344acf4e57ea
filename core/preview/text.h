#pragma once
#include <OpenImageIO/imagebuf.h>

#include <optional>
#include <string>

#include "core/preview/sheet_layout.h"

namespace aftershade::preview {

/// The font file to draw with: `wanted`, or, when that is empty, DejaVu Sans where Debian, Fedora, Arch or
/// $OPENIMAGEIO_FONTS have it. nullopt when it is missing or OpenImageIO cannot draw with it.
std::optional<std::string> usable_font(const std::string& wanted);

/// The width in pixels of one line of text; control characters count as blanks.
int text_width(const std::string& text, int size_px, const std::string& font);

/// Draws one line of light grey text into `box`, left, all lines of one box height on the same base line. What does not
/// fit the width ends in "...".
void draw_text(OIIO::ImageBuf& canvas, const Box& box, const std::string& text, int size_px, const std::string& font);

}  // namespace aftershade::preview
