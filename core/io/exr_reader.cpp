#include "core/io/exr_reader.h"

#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfTiledInputPart.h>

#include <algorithm>
#include <array>
#include <mutex>

#include "core/io/exr_handles.h"
#include "core/io/exr_limits.h"

namespace aftershade::io {

namespace {
/// OpenEXR's own limits, a second line behind ours: 0, no limit, is its default.
void limit_openexr() {
  static std::once_flag once;
  std::call_once(once, [] {
    Imf::Header::setMaxImageSize(65536, 65536);
    Imf::Header::setMaxTileSize(4096, 4096);
  });
}

std::string text_attribute(const RawHeader& header, std::string_view name) {
  const RawAttribute* attribute = header.find(name);
  return attribute != nullptr && attribute->type == "string" ? attribute->bytes : std::string();
}

/// A `stringvector`: each text after its length.
std::vector<std::string> texts_attribute(const RawHeader& header, std::string_view name) {
  const RawAttribute* attribute = header.find(name);
  std::vector<std::string> texts;
  if (attribute == nullptr || attribute->type != "stringvector") return texts;
  for (std::string_view rest = attribute->bytes; rest.size() >= 4;) {
    uint32_t length;
    std::memcpy(&length, rest.data(), sizeof length);
    rest.remove_prefix(sizeof length);
    if (length > rest.size()) break;
    texts.emplace_back(rest.substr(0, length));
    rest.remove_prefix(length);
  }
  return texts;
}

PartInfo describe(const RawPart& raw) {
  PartInfo part{.name = raw.name,
                .view = text_attribute(raw.header, "view"),
                .data_window = raw.geometry.window,
                .channels = {},
                .compression = std::string(kCompressions[static_cast<size_t>(raw.geometry.compression)].name),
                .tiled = raw.geometry.tiled()};
  for (const RawChannel& channel : raw.channels) part.channels.push_back({channel.name, channel.type});
  return part;
}

void describe(const ExrLayout& layout, FileInfo& info) {
  const RawHeader& first = layout.parts[0].header;
  info.display_window = *value_of<Window>(first.find("displayWindow"), "box2i");
  info.pixel_aspect = value_of<float>(first.find("pixelAspectRatio"), "float").value_or(1);
  if (!layout.multi_part()) info.multi_view = texts_attribute(first, "multiView");
  for (const RawPart& part : layout.parts) info.parts.push_back(describe(part));
}

std::unique_ptr<ExrReader::Handles> open(const std::string& path, const ReadLimits& limits) {
  limit_openexr();
  auto handles = std::make_unique<ExrReader::Handles>(path, limits);
  guarded(path, [&] {
    handles->layout = parse_headers(handles->bytes, path, limits.max_parts);
    describe(handles->layout, handles->info);
    check_parts(handles->layout, limits, handles->bytes.size(), handles->info);
    read_offsets(handles->layout, handles->bytes, path);
    handles->file = std::make_unique<Imf::MultiPartInputFile>(handles->stream, Imf::globalThreadCount(), false);
  });
  return handles;
}

/// The pixels that are decoded for a request: whole tiles, or whole rows.
Window decode_window(const PartInfo& part, Window wanted) {
  Window window = part.data_window;
  if (part.tiled) return window;
  const Window overlap = intersection(window, wanted);
  window.min_y = overlap.min_y;
  window.max_y = overlap.max_y;
  return window;
}

bool covers(Window outer, Window inner) { return intersection(outer, inner) == inner; }

/// Copies the pixels of `region` that both planes hold.
void copy_window(ConstPlaneView source, Window source_window, PlaneView target, Window target_window, Window region) {
  const Window both = intersection(region, intersection(source_window, target_window));
  for (int y = both.min_y; y <= both.max_y; ++y) {
    const float* from = source.row(y - source_window.min_y) + (both.min_x - source_window.min_x);
    std::copy_n(from, both.width(), target.row(y - target_window.min_y) + (both.min_x - target_window.min_x));
  }
}

using Requests = std::span<const ExrReader::Request>;

/// Decodes each channel once: straight into its target when that holds all decoded pixels, else by way of a plane.
void decode_requests(const ExrReader::Handles& handles, int part, Requests requests, Window wanted) {
  const Window window = decode_window(handles.info.parts[static_cast<size_t>(part)], wanted);
  const bool direct = covers(wanted, window);
  std::vector<Plane> scratch(requests.size());
  Imf::FrameBuffer buffer;
  std::vector<ConstPlaneView> decoded(requests.size());
  for (size_t i = 0; i < requests.size(); ++i) {
    PlaneView plane = requests[i].target;
    if (!direct) plane = scratch[i] = Plane(window.width(), window.height());
    const Window covered = direct ? wanted : window;
    decoded[i] = plane;
    buffer.insert(requests[i].channel, slice(Imf::FLOAT, plane.data, covered, sizeof(float),
                                             static_cast<size_t>(plane.stride) * sizeof(float)));
  }
  decode(handles, part, buffer, window.min_y, window.max_y);
  for (size_t i = 0; !direct && i < requests.size(); ++i)
    copy_window(decoded[i], window, requests[i].target, wanted, window);
}
}  // namespace

std::string_view to_text(PixelType type) {
  return type == PixelType::half ? "half" : type == PixelType::single ? "float" : "uint";
}

const ChannelInfo* PartInfo::find(std::string_view channel) const {
  const auto found = std::ranges::find(channels, channel, &ChannelInfo::name);
  return found == channels.end() ? nullptr : &*found;
}

std::string part_text(const FileInfo& info, int part) {
  if (static_cast<size_t>(part) >= info.parts.size()) return info.path;
  const std::string& name = info.parts[static_cast<size_t>(part)].name;
  if (!name.empty()) return cat("part ", name, " of ", info.path);
  return info.parts.size() == 1 ? info.path : cat("part ", part, " of ", info.path);
}

std::string reason(const std::exception& error) {
  std::string text = error.what();
  for (size_t open = text.find(" \""); open != std::string::npos; open = text.find(" \"", open)) {
    const size_t close = text.find('"', open + 2);
    if (close == std::string::npos) break;
    text.erase(open, close + 1 - open);
  }
  return text;
}

Imf::Slice slice(Imf::PixelType type, void* data, Window window, size_t x_stride, size_t y_stride) {
  const auto to_origin = static_cast<uintptr_t>(int64_t{window.min_x}) * x_stride +
                         static_cast<uintptr_t>(int64_t{window.min_y}) * y_stride;
  return {type, reinterpret_cast<char*>(reinterpret_cast<uintptr_t>(data) - to_origin), x_stride, y_stride};
}

void decode(const ExrReader::Handles& handles, int part, const Imf::FrameBuffer& target, int first, int last) {
  if (!handles.info.parts[static_cast<size_t>(part)].tiled) {
    Imf::InputPart input(*handles.file, part);
    input.setFrameBuffer(target);
    input.readPixels(first, last);
    return;
  }
  Imf::TiledInputPart input(*handles.file, part);
  input.setFrameBuffer(target);
  input.readTiles(0, input.numXTiles() - 1, 0, input.numYTiles() - 1);
}

ExrReader::ExrReader(const std::string& path, const ReadLimits& limits) : handles_(open(path, limits)) {}
ExrReader::~ExrReader() = default;
ExrReader::ExrReader(ExrReader&&) noexcept = default;
const FileInfo& ExrReader::info() const { return handles_->info; }

namespace {
const RawHeader& header_of(const ExrReader::Handles& handles, int part) {
  return handles.layout.parts.at(static_cast<size_t>(part)).header;
}

template <class T>
Mat4 to_matrix(const std::array<T, 16>& values) {
  Mat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = static_cast<double>(values[static_cast<size_t>(i)]);
  return matrix;
}
}  // namespace

std::optional<Mat4> ExrReader::matrix(int part, const std::string& name) const {
  const RawAttribute* attribute = header_of(*handles_, part).find(name);
  if (const auto values = value_of<std::array<float, 16>>(attribute, "m44f")) return to_matrix(*values);
  if (const auto values = value_of<std::array<double, 16>>(attribute, "m44d")) return to_matrix(*values);
  return std::nullopt;
}

std::optional<double> ExrReader::number(int part, const std::string& name) const {
  const RawAttribute* attribute = header_of(*handles_, part).find(name);
  if (const auto value = value_of<float>(attribute, "float")) return *value;
  if (const auto value = value_of<double>(attribute, "double")) return *value;
  if (const auto value = value_of<int32_t>(attribute, "int")) return *value;
  struct Rational {
    int32_t numerator;
    uint32_t denominator;
  };
  if (const auto value = value_of<Rational>(attribute, "rational"); value && value->denominator != 0)
    return double{static_cast<double>(value->numerator)} / value->denominator;
  return std::nullopt;
}

std::optional<std::string> ExrReader::text(int part, const std::string& name) const {
  const RawAttribute* attribute = header_of(*handles_, part).find(name);
  if (attribute == nullptr || attribute->type != "string") return std::nullopt;
  return attribute->bytes;
}

std::vector<std::string> ExrReader::attribute_names(int part) const {
  std::vector<std::string> names;
  for (const RawAttribute& attribute : header_of(*handles_, part).attributes) names.push_back(attribute.name);
  return names;
}

void ExrReader::read(int part, std::span<const Request> requests, Window window) const {
  const PartInfo& part_info = handles_->info.parts.at(static_cast<size_t>(part));
  std::vector<Request> unique;
  std::vector<std::string> names;
  for (const Request& request : requests) {
    if (part_info.find(request.channel) == nullptr)
      throw Error(ErrorCode::no_input, cat(part_text(handles_->info, part), " has no channel ", request.channel));
    if (std::ranges::find(names, request.channel) != names.end()) continue;
    names.push_back(request.channel);
    unique.push_back(request);
  }
  if (unique.empty() || intersection(part_info.data_window, window).empty()) return;
  guarded(cat("channel ", join(names, ", "), " of ", part_text(handles_->info, part)),
          [&] { decode_requests(*handles_, part, unique, window); });
  for (const Request& request : requests) {
    const auto first = std::ranges::find(unique, request.channel, &Request::channel);
    if (first->target.data == request.target.data) continue;
    copy_window(first->target, window, request.target, window, part_info.data_window);
  }
}

}  // namespace aftershade::io
