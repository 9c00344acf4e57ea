#include "core/io/exr_standard.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace aftershade::io {

namespace {
struct TypeSize {
  std::string_view type;
  size_t bytes;
};
constexpr TypeSize kSizes[] = {{"box2i", 16},
                               {"box2f", 16},
                               {"int", 4},
                               {"float", 4},
                               {"double", 8},
                               {"v2i", 8},
                               {"v2f", 8},
                               {"v2d", 16},
                               {"v3i", 12},
                               {"v3f", 12},
                               {"v3d", 24},
                               {"m33f", 36},
                               {"m33d", 72},
                               {"m44f", 64},
                               {"m44d", 128},
                               {"envmap", 1},
                               {"compression", 1},
                               {"lineOrder", 1},
                               {"keycode", 28},
                               {"rational", 8},
                               {"timecode", 8},
                               {"tiledesc", 9},
                               {"chromaticities", 32},
                               {"deepImageState", 1}};

struct NamedType {
  std::string_view name, type;
};
constexpr NamedType kTypes[] = {{"displayWindow", "box2i"},
                                {"dataWindow", "box2i"},
                                {"channels", "chlist"},
                                {"pixelAspectRatio", "float"},
                                {"screenWindowCenter", "v2f"},
                                {"screenWindowWidth", "float"},
                                {"lineOrder", "lineOrder"},
                                {"compression", "compression"},
                                {"tiles", "tiledesc"},
                                {"name", "string"},
                                {"type", "string"},
                                {"view", "string"},
                                {"chunkCount", "int"},
                                {"version", "int"},
                                {"multiView", "stringvector"},
                                {"preview", "preview"}};

bool is_string_list(std::string_view bytes) {
  while (bytes.size() >= 4) {
    int32_t length;
    std::memcpy(&length, bytes.data(), sizeof length);
    bytes.remove_prefix(sizeof length);
    if (length < 0 || static_cast<size_t>(length) > bytes.size()) return false;
    bytes.remove_prefix(static_cast<size_t>(length));
  }
  return bytes.empty();
}

bool is_preview(std::string_view bytes) {
  uint32_t size[2];
  if (bytes.size() < sizeof size) return false;
  std::memcpy(size, bytes.data(), sizeof size);
  constexpr uint32_t kLargest = 1 << 14;
  return size[0] <= kLargest && size[1] <= kLargest && bytes.size() == sizeof size + 4 * size_t{size[0]} * size[1];
}

bool is_standard(const RawAttribute& attribute, size_t longest_name) {
  if (attribute.name.size() > longest_name || attribute.type.size() > longest_name) return false;
  const auto named = std::ranges::find(kTypes, attribute.name, &NamedType::name);
  if (named != std::end(kTypes) && named->type != attribute.type) return false;
  const auto sized = std::ranges::find(kSizes, attribute.type, &TypeSize::type);
  if (sized != std::end(kSizes)) return sized->bytes == attribute.bytes.size();
  if (attribute.type == "stringvector") return is_string_list(attribute.bytes);
  if (attribute.type == "floatvector") return attribute.bytes.size() % sizeof(float) == 0;
  if (attribute.type == "preview") return is_preview(attribute.bytes);
  return attribute.type != "idmanifest";
}

bool is_standard(const RawPart& part, const ExrLayout& layout) {
  const auto number = [&](std::string_view name) {
    return value_of<float>(part.header.find(name), "float").value_or(1);
  };
  const float aspect = number("pixelAspectRatio");
  if (!std::isnormal(aspect) || aspect < 1e-6F || aspect > 1e6F || !(number("screenWindowWidth") >= 0)) return false;
  const int line_orders = part.geometry.tiled() ? 3 : 2;
  if (part.geometry.line_order >= line_orders) return false;
  if (format_channels(part.channels) != part.header.find("channels")->bytes) return false;
  const std::string_view type = part.geometry.tiled() ? "tiledimage" : "scanlineimage";
  if (part.type != type && !(part.type.empty() && !layout.multi_part())) return false;
  const size_t longest = (layout.version & ExrLayout::kLongNames) != 0 ? 255 : 31;
  return std::ranges::all_of(part.header.attributes,
                             [&](const RawAttribute& attribute) { return is_standard(attribute, longest); }) &&
         std::ranges::all_of(part.channels, [&](const RawChannel& channel) { return channel.name.size() <= longest; });
}

/// Of all parts of a file the names differ, and what concerns the whole picture is the same.
bool fit_together(const ExrLayout& layout) {
  std::set<std::string_view> names;
  for (const RawPart& part : layout.parts) {
    if (part.name.empty() || !names.insert(part.name).second || part.header.find("chunkCount") == nullptr) return false;
    for (const std::string_view shared : {"displayWindow", "pixelAspectRatio", "timeCode", "chromaticities"}) {
      const RawAttribute *mine = part.header.find(shared), *first = layout.parts[0].header.find(shared);
      if ((mine == nullptr) != (first == nullptr) || (mine != nullptr && mine->bytes != first->bytes)) return false;
    }
  }
  return true;
}
}  // namespace

bool has_standard_headers(const ExrLayout& layout) {
  const auto standard = [&](const RawPart& part) { return is_standard(part, layout); };
  return std::ranges::all_of(layout.parts, standard) && (!layout.multi_part() || fit_together(layout));
}

}  // namespace aftershade::io
