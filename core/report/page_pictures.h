#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "core/report/comparison.h"

/// How pictures get into the page: lossless, each as a PNG of its own or of what differs from another one.
namespace aftershade::report {

/// A picture of a set as the page holds it. `png` is the picture's, or, when `base` >= 0, that of its values minus
/// those of picture `base` of the set, modulo 256: AO and blur change little, so that is mostly zeros.
struct PackedPicture {
  int width = 0, height = 0;  ///< 0 x 0: there is none
  int base = -1;              ///< comes before in the order of unpacking; bases are never in a circle
  std::vector<unsigned char> png;
};

/// The base of each picture, or -1: among those before it the one that it differs least from, if that is less than
/// its pixels differ from their left neighbours. The picture `first` is before all others.
std::vector<int> bases_of(const std::vector<Picture>& pictures, size_t first);
/// Each picture as what is smaller: its own PNG or that of its difference from its base.
std::vector<PackedPicture> packed(const std::vector<Picture>& pictures, size_t first);

/// A frame with pictures of half the size `halvings` times: the whole frame scaled, the region cut around its middle.
ShownFrame smaller(const ShownFrame& frame, int halvings);

/// The frame with its pictures as JSON for the page's script (see page/pictures.js), one line.
std::string shown_text(const ShownFrame& frame, size_t first);

}  // namespace aftershade::report
