#include "core/color/display.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::color {

namespace {

namespace ocio = OCIO_NAMESPACE;

ocio::ConstCPUProcessorRcPtr make_processor() {
  const auto curve = ocio::ExponentWithLinearTransform::Create();
  curve->setGamma({2.4, 2.4, 2.4, 1.0});
  curve->setOffset({0.055, 0.055, 0.055, 0.0});
  curve->setDirection(ocio::TRANSFORM_DIR_INVERSE);  // forward decodes display values
  return ocio::Config::CreateRaw()->getProcessor(curve)->getDefaultCPUProcessor();
}

/// A comparison with NaN is false, so NaN becomes 0.
void clamp_row(float* row, int width) {
  for (int x = 0; x < width; ++x) row[x] = row[x] > 0 ? std::min(row[x], 1.0F) : 0.0F;
}

void convert_rows(std::span<const PlaneView, 3> rgb) {
  static const ocio::ConstCPUProcessorRcPtr processor = make_processor();
  const int width = rgb[0].width;
  for (int y = 0; y < rgb[0].height; ++y) {
    float *const r = rgb[0].row(y), *const g = rgb[1].row(y), *const b = rgb[2].row(y);
    for (float* row : {r, g, b}) clamp_row(row, width);
    ocio::PlanarImageDesc image(r, g, b, nullptr, width, 1);
    processor->apply(image);
    for (float* row : {r, g, b}) clamp_row(row, width);  // the curve's value at 1 may be off by rounding
  }
}

}  // namespace

void to_display(std::span<const PlaneView, 3> rgb) {
  if (rgb[0].empty()) return;
  try {
    convert_rows(rgb);
  } catch (const ocio::Exception& error) {
    throw Error(ErrorCode::internal, cat("OpenColorIO cannot make the sRGB display transform: ", error.what()),
                "check the OpenColorIO installation");
  }
}

}  // namespace aftershade::color
