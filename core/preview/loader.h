#pragma once
#include <string>

#include "core/preview/sheet.h"

/// The program's side of aftershade-preview.so. The module brings OpenImageIO and OpenColorIO with it (0.2 s, some 260
/// shared objects), so the first call of a function below loads it and nothing else does.
/// Both functions throw Error(internal) when the module is missing or belongs to another version of the program.
namespace aftershade::preview {

/// Brings a picture to the size at which the sheet shows it, square pixels, values clamped to 0..1 in scene-linear
/// light (NaN becomes 0, and so never reaches the filter). Does nothing to a picture that has this size already.
/// write_sheet does this for every cell; call it right after filling a cell to hold no more than what is shown.
void shrink(Cell& cell, const SheetStyle& style);

/// Draws the sheet and writes it as an 8-bit sRGB PNG that appears complete or not at all. Uses the sheet up.
/// Returns a note for the user, or an empty text: labels are left out when the font is missing.
/// Throws Error(usage) when the sheet has no picture, a cell has neither 0, 1 nor 3 planes of one size or no positive
/// pixel aspect, or the sheet exceeds 65500 pixels in a direction; Error(cannot_create) or Error(io) when `png_path`
/// cannot be written.
std::string write_sheet(Sheet sheet, const std::string& png_path);

}  // namespace aftershade::preview
