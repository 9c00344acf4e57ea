#include "core/preview/picture.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "core/preview/module.h"
#include "core/preview/sheet_layout.h"

namespace aftershade::preview {

namespace {

void rethrow(const std::optional<Error>& error) {
  if (error) throw Error(*error);
}

/// A comparison with NaN is false, so NaN becomes 0.
unsigned char code_value(float value) {
  return static_cast<unsigned char>((value > 0 ? std::min(value, 1.0F) : 0.0F) * 255.0F + 0.5F);
}

Plane scaled(const Plane& plane, PixelSize size) {
  Plane out(size.width, size.height);
  std::optional<Error> error;
  loaded_module().resize(copy_of(plane), out, thread_count(), error);
  rethrow(error);
  return out;
}

Picture picture_of(const std::vector<Plane>& planes) {
  Picture out{planes[0].width(), planes[0].height(), {}};
  out.rgb.resize(static_cast<size_t>(out.width) * static_cast<size_t>(out.height) * 3);
  unsigned char* value = out.rgb.data();
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (const size_t channel : {0U, 1U, 2U}) *value++ = code_value(planes[planes.size() == 3 ? channel : 0](x, y));
  return out;
}

std::vector<Plane> planes_of(const Picture& picture) {
  std::vector<Plane> out;
  for (size_t channel = 0; channel < 3; ++channel) {
    Plane& plane = out.emplace_back(picture.width, picture.height);
    const unsigned char* value = picture.rgb.data() + channel;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x, value += 3) plane(x, y) = static_cast<float>(*value) / 255.0F;
  }
  return out;
}

}  // namespace

std::string view_name(const color::DisplayOptions& options) {
  std::string name;
  std::optional<Error> error;
  loaded_module().view_name(options, name, error);
  rethrow(error);
  return name;
}

Picture display_picture(std::span<const ConstPlaneView> planes, const color::DisplayOptions& options,
                        PictureSize size) {
  if (planes.empty() || planes[0].empty()) return {};
  if (planes.size() != 1 && planes.size() != 3)
    throw Error(ErrorCode::internal, "a picture has neither one nor three planes");
  std::vector<Plane> own;
  for (const ConstPlaneView& plane : planes) own.push_back(copy_of(plane));
  std::optional<Error> error;
  if (own.size() == 3) loaded_module().to_display(std::array<PlaneView, 3>{own[0], own[1], own[2]}, options, error);
  rethrow(error);
  const PixelSize full{planes[0].width, planes[0].height};
  // The height follows; what is drawn wider than any picture may be is only ever made narrower.
  const PixelSize target = size.max_width_px > 0 ? fitted(full, size.pixel_aspect, {size.max_width_px, 1 << 16}) : full;
  if (target != full)
    for (Plane& plane : own) plane = scaled(plane, target);
  return picture_of(own);
}

Picture resized(const Picture& picture, int width, int height) {
  if (picture.empty()) return {};
  std::vector<Plane> planes = planes_of(picture);
  for (Plane& plane : planes) plane = scaled(plane, {width, height});
  return picture_of(planes);
}

std::vector<unsigned char> png(const Picture& picture) {
  std::vector<unsigned char> bytes;
  std::optional<Error> error;
  loaded_module().encode_png(picture, bytes, error);
  rethrow(error);
  return bytes;
}

}  // namespace aftershade::preview
