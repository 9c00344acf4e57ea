#include "core/report/page_pictures.h"

#include <algorithm>
#include <cstdlib>

#include "core/base/text.h"
#include "core/parallel/rows.h"
#include "core/report/json.h"

namespace aftershade::report {

using params::Json;

namespace {

/// A step of codes modulo 256 as a distance.
int distance(unsigned char a, unsigned char b) {
  return std::abs(static_cast<int>(static_cast<signed char>(static_cast<unsigned char>(a - b))));
}

uint64_t difference(const Picture& a, const Picture& b) {
  uint64_t sum = 0;
  for (size_t i = 0; i < a.rgb.size(); ++i) sum += static_cast<uint64_t>(distance(a.rgb[i], b.rgb[i]));
  return sum;
}

uint64_t unevenness(const Picture& picture) {
  uint64_t sum = 0;
  const size_t row = static_cast<size_t>(picture.width) * 3;
  for (size_t i = 0; i < picture.rgb.size(); ++i)
    sum += static_cast<uint64_t>(distance(picture.rgb[i], i % row < 3 ? 0 : picture.rgb[i - 3]));
  return sum;
}

int base_of(const std::vector<Picture>& pictures, const std::vector<size_t>& before, size_t index) {
  const Picture& picture = pictures[index];
  int base = -1;
  uint64_t least = unevenness(picture);
  for (const size_t other : before) {
    if (pictures[other].width != picture.width || pictures[other].height != picture.height) continue;
    const uint64_t sum = difference(picture, pictures[other]);
    if (sum < least) least = sum, base = static_cast<int>(other);
  }
  return base;
}

Picture delta(const Picture& picture, const Picture& base) {
  Picture out = picture;
  for (size_t i = 0; i < out.rgb.size(); ++i) out.rgb[i] = static_cast<unsigned char>(picture.rgb[i] - base.rgb[i]);
  return out;
}

/// With a base what is smaller; a difference that is small beyond doubt is not tried against the picture itself.
PackedPicture packed_picture(const Picture& picture, const Picture* base, int base_index) {
  constexpr uint64_t kBeyondDoubt = 4;
  PackedPicture out{picture.width, picture.height, -1, {}};
  if (base) out.base = base_index, out.png = preview::png(delta(picture, *base));
  if (base && kBeyondDoubt * difference(picture, *base) < unevenness(picture)) return out;
  std::vector<unsigned char> plain = preview::png(picture);
  if (!base || plain.size() <= out.png.size()) out.base = -1, out.png = std::move(plain);
  return out;
}

std::vector<size_t> order_of(size_t count, size_t first) {
  std::vector<size_t> order;
  if (first < count) order.push_back(first);
  for (size_t i = 0; i < count; ++i)
    if (i != first) order.push_back(i);
  return order;
}

std::string base64(const std::vector<unsigned char>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    unsigned bits = 0;
    for (size_t j = 0; j < 3; ++j) bits = bits << 8 | (j < count ? bytes[i + j] : 0U);
    for (size_t j = 0; j < 4; ++j) out += j <= count ? kDigits[bits >> (18 - 6 * j) & 63] : '=';
  }
  return out;
}

Json json_of(const std::vector<PackedPicture>& pictures) {
  Json out = Json::array();
  for (const PackedPicture& picture : pictures) {
    if (picture.png.empty())
      out.push_back(nullptr);
    else
      out.push_back(
          {{"width", picture.width}, {"height", picture.height}, {"base", picture.base}, {"png", base64(picture.png)}});
  }
  return out;
}

/// The middle of a picture, of at most width x height.
Picture middle_of(const Picture& picture, int width, int height) {
  const int x0 = (picture.width - width) / 2, y0 = (picture.height - height) / 2;
  Picture out{width, height, {}};
  for (int y = 0; y < height; ++y) {
    const auto* row = picture.rgb.data() + 3 * (static_cast<ptrdiff_t>(y0 + y) * picture.width + x0);
    out.rgb.insert(out.rgb.end(), row, row + 3 * static_cast<ptrdiff_t>(width));
  }
  return out;
}

}  // namespace

std::vector<int> bases_of(const std::vector<Picture>& pictures, size_t first) {
  const std::vector<size_t> order = order_of(pictures.size(), first);
  std::vector<int> bases(pictures.size(), -1);
  for_rows(static_cast<int>(order.size()), [&](int place) {
    const std::vector<size_t> before(order.begin(), order.begin() + place);
    const size_t index = order[static_cast<size_t>(place)];
    bases[index] = base_of(pictures, before, index);
  });
  return bases;
}

std::vector<PackedPicture> packed(const std::vector<Picture>& pictures, size_t first) {
  const std::vector<int> bases = bases_of(pictures, first);
  std::vector<PackedPicture> out(pictures.size());
  for_rows(static_cast<int>(pictures.size()), [&](int index) {
    const auto i = static_cast<size_t>(index);
    const Picture* base = bases[i] < 0 ? nullptr : &pictures[static_cast<size_t>(bases[i])];
    if (!pictures[i].empty()) out[i] = packed_picture(pictures[i], base, bases[i]);
  });
  return out;
}

ShownFrame smaller(const ShownFrame& frame, int halvings) {
  if (halvings <= 0) return frame;
  ShownFrame out = frame;
  const auto halved = [&](int size) { return std::max(1, size >> halvings); };
  for (Picture& picture : out.whole)
    if (!picture.empty()) picture = preview::resized(picture, halved(picture.width), halved(picture.height));
  // Without a detail the whole frame had every pixel: its middle would show less than what is left of it.
  if (out.detail.empty()) return out;
  const int width = halved(frame.region.width()), height = halved(frame.region.height());
  for (Picture& picture : out.detail)
    if (!picture.empty()) picture = middle_of(picture, width, height);
  out.region.min_x += (frame.region.width() - width) / 2;
  out.region.min_y += (frame.region.height() - height) / 2;
  out.region.max_x = out.region.min_x + width - 1;
  out.region.max_y = out.region.min_y + height - 1;
  return out;
}

std::string shown_text(const ShownFrame& frame, size_t first) {
  const Window& region = frame.region;
  Json json{
      {"frame", frame.number},
      {"error", frame.error},
      {"region", {{"x", region.min_x}, {"y", region.min_y}, {"width", region.width()}, {"height", region.height()}}},
      {"whole", json_of(packed(frame.whole, first))}};
  json["detail"] = frame.detail.empty() ? Json(nullptr) : json_of(packed(frame.detail, first));
  return dumped(json);
}

}  // namespace aftershade::report
