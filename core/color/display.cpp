#include "core/color/display.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/color/view.h"

namespace aftershade::color {

namespace {

/// A comparison with NaN is false, so NaN becomes `least` where that is 0.
void clamp_row(float* row, int width, float least, float most) {
  for (int x = 0; x < width; ++x) row[x] = row[x] > least ? std::min(row[x], most) : least;
}

/// As far as half floats reach, so that every transform's arithmetic stays finite.
void make_finite(float* row, int width) {
  constexpr float kHalfMax = 65504;
  for (int x = 0; x < width; ++x) row[x] = row[x] == row[x] ? std::clamp(row[x], -kHalfMax, kHalfMax) : 0.0F;
}

}  // namespace

struct DisplayTransform::Processor {
  ocio::ConstCPUProcessorRcPtr of_pixels;
};

DisplayTransform::DisplayTransform(const DisplayOptions& options) {
  View view = options.ocio.empty() ? built_in_view(options.view) : view_of_file(options.ocio, options.view);
  processor_ = std::make_shared<Processor>(Processor{std::move(view.processor)});
  name_ = std::move(view.name);
}

void DisplayTransform::apply(std::span<const PlaneView, 3> rgb) const {
  const int width = rgb[0].width;
  if (rgb[0].empty()) return;
  try {
    for (int y = 0; y < rgb[0].height; ++y) {
      float *const r = rgb[0].row(y), *const g = rgb[1].row(y), *const b = rgb[2].row(y);
      for (float* row : {r, g, b}) make_finite(row, width);
      ocio::PlanarImageDesc image(r, g, b, nullptr, width, 1);
      processor_->of_pixels->apply(image);
      for (float* row : {r, g, b}) clamp_row(row, width, 0.0F, 1.0F);
    }
  } catch (const ocio::Exception& error) {
    throw Error(ErrorCode::internal, cat("OpenColorIO cannot apply ", name_, ": ", error.what()),
                "check the OpenColorIO installation");
  }
}

void to_display(std::span<const PlaneView, 3> rgb) {
  static const DisplayTransform srgb{DisplayOptions{}};
  srgb.apply(rgb);
}

}  // namespace aftershade::color
