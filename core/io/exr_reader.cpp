#include "core/io/exr_reader.h"

#include <ImfHeader.h>
#include <ImfThreading.h>

#include <algorithm>
#include <array>
#include <mutex>

#include "core/io/exr_codec.h"
#include "core/io/exr_decode.h"
#include "core/io/exr_limits.h"
#include "core/io/exr_standard.h"

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
    handles->standard_headers = has_standard_headers(handles->layout);
    if (!handles->standard_headers || limits.codecs == PixelCodecs::openexr) handles->openexr();
  });
  return handles;
}

/// Copies the pixels of `region` that both planes hold.
void copy_window(ConstPlaneView source, Window source_window, PlaneView target, Window target_window, Window region) {
  const Window both = intersection(region, intersection(source_window, target_window));
  for (int y = both.min_y; y <= both.max_y; ++y) {
    const float* from = source.row(y - source_window.min_y) + (both.min_x - source_window.min_x);
    std::copy_n(from, both.width(), target.row(y - target_window.min_y) + (both.min_x - target_window.min_x));
  }
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

bool ExrReader::Handles::uses_codecs(int compression) const {
  return limits.codecs == PixelCodecs::automatic && standard_headers && has_codec(compression);
}

Imf::MultiPartInputFile& ExrReader::Handles::openexr() const {
  if (!file) file = std::make_unique<Imf::MultiPartInputFile>(stream, Imf::globalThreadCount(), false);
  return *file;
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

// A channel that is asked for twice is decoded once and copied.
void ExrReader::decode(int part, std::span<const Request> requests, Window window, PackedImage* keep) const {
  const RowLayout layout(handles_->layout.parts.at(static_cast<size_t>(part)).channels);
  std::vector<Wanted> wanted;
  std::vector<size_t> source;  // of each request, in `wanted`
  std::vector<std::string> names;
  for (const Request& request : requests) {
    const int channel = layout.find(request.channel);
    if (channel < 0)
      throw Error(ErrorCode::no_input, cat(part_text(handles_->info, part), " has no channel ", request.channel));
    const auto index = static_cast<size_t>(channel);
    source.push_back(static_cast<size_t>(std::ranges::find(wanted, index, &Wanted::channel) - wanted.begin()));
    if (source.back() < wanted.size()) continue;
    wanted.push_back({index, request.target, {}});
    names.push_back(request.channel);
  }
  const std::string subject = names.empty()
                                  ? part_text(handles_->info, part)
                                  : cat("channel ", join(names, ", "), " of ", part_text(handles_->info, part));
  guarded(subject, [&] { decode_part(*handles_, part, wanted, window, keep); });
  const Window data = handles_->info.parts[static_cast<size_t>(part)].data_window;
  for (size_t i = 0; i < requests.size(); ++i) {
    const Wanted& done = wanted[source[i]];
    if (requests[i].found != nullptr) *requests[i].found = done.found;
    if (requests[i].target.data != done.target.data) copy_window(done.target, window, requests[i].target, window, data);
  }
}

void ExrReader::read(int part, std::span<const Request> requests, Window window) const {
  decode(part, requests, window, nullptr);
}

std::shared_ptr<const PackedImage> ExrReader::read_and_keep(int part, std::span<const Request> requests,
                                                            Window window) const {
  const RawPart& raw = handles_->layout.parts.at(static_cast<size_t>(part));
  const auto all = std::make_shared<PackedImage>(raw.geometry.window, raw.channels);
  decode(part, requests, window, all.get());
  return all;
}

}  // namespace aftershade::io
