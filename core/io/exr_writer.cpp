#include "core/io/exr_writer.h"

#include <ImfHeader.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/io/exr_handles.h"
#include "core/io/exr_pixels.h"
#include "core/io/exr_plan.h"
#include "core/io/publish.h"

namespace aftershade::io {

namespace {
/// Depth of pixels that nothing wrote is background; every other channel's is 0 (black, transparent, no motion, no id).
float outside_value(const RawChannel& channel) {
  const bool is_depth = channel.name == "Z" || channel.name.ends_with(".Z");
  return is_depth && channel.type != PixelType::uint ? std::numeric_limits<float>::infinity() : 0.0F;
}

/// Decodes the channels that the source has into an image that covers its data window or more.
void decode_source(const ExrReader::Handles& source, int part, PackedImage& image) {
  const PartInfo& info = source.info.parts[static_cast<size_t>(part)];
  Imf::FrameBuffer all = frame_buffer(image), existing;
  for (const ChannelInfo& channel : info.channels) existing.insert(channel.name, all[channel.name]);
  decode(source, part, existing, info.data_window.min_y, info.data_window.max_y);
  for (PackedChannel& channel : image.channels)
    fill_outside(channel, image.window, info.data_window, outside_value(channel.info));
}

/// The pixels of a part with its writes done.
PackedImage changed_pixels(const ExrReader::Handles& source, const PlannedPart& part) {
  PackedImage image{part.geometry.window, {}};
  for (const RawChannel& channel : part.channels) image.add(channel);
  if (part.copy_channels) decode_source(source, part.source_part, image);
  for (const PlannedPart::Write& write : part.writes)
    pack(write.write->pixels, write.write->window, *image.find(write.channel), image.window);
  return image;
}

/// A header for encoding alone: what OpenEXR needs to know and the packed image does not say.
Imf::Header encoding_header(const PlannedPart& part) {
  Imf::Header header;
  if (const auto level = value_of<float>(part.header.find("dwaCompressionLevel"), "float"))
    header.dwaCompressionLevel() = *level;
  return header;
}

/// A part encoded as a file of its own, whose chunks are taken over.
struct EncodedPart {
  std::vector<char> bytes;
  ExrLayout layout;
};
EncodedPart encode_part(const ExrReader::Handles& source, const PlannedPart& part) {
  PackedImage image = changed_pixels(source, part);
  EncodedPart encoded{encode(image, part.geometry, encoding_header(part)), {}};
  const MemoryBytes memory(encoded.bytes);
  encoded.layout = parse_headers(memory, source.info.path, 1);
  read_offsets(encoded.layout, memory, source.info.path);
  return encoded;
}

/// Appends the chunks of one part in the order in which they lie in their file, and notes where they begin.
void append_chunks(std::vector<char>& out, std::span<uint64_t> table, const ExrLayout& layout, int part,
                   const ByteSource& source, std::optional<int32_t> part_number) {
  const std::vector<uint64_t>& offsets = layout.parts[static_cast<size_t>(part)].offsets;
  std::vector<int64_t> order(offsets.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int64_t index) { return offsets[static_cast<size_t>(index)]; });
  for (const int64_t index : order) {
    table[static_cast<size_t>(index)] = out.size();
    if (part_number) {
      const std::string number = bytes_of(*part_number);
      out.insert(out.end(), number.begin(), number.end());
    }
    const std::vector<char> chunk = read_chunk(layout, part, index, source);
    out.insert(out.end(), chunk.begin(), chunk.end());
  }
}

void append_part(std::vector<char>& out, std::span<uint64_t> table, const ExrReader::Handles& source,
                 const PlannedPart& part, std::optional<int32_t> part_number) {
  guarded(part_text(source.info, part.source_part), [&] {
    if (part.writes.empty())
      return append_chunks(out, table, source.layout, part.source_part, source.bytes, part_number);
    const EncodedPart encoded = encode_part(source, part);
    append_chunks(out, table, encoded.layout, 0, MemoryBytes(encoded.bytes), part_number);
  });
}

std::vector<char> assemble(const ExrReader::Handles& source, const Plan& plan) {
  std::vector<RawHeader> headers;
  int64_t chunks = 0;
  for (const PlannedPart& part : plan.parts) {
    headers.push_back(part.header);
    chunks += part.geometry.chunk_count();
  }
  const std::string head = format_headers(plan.version, headers);
  std::vector<uint64_t> table(static_cast<size_t>(chunks));
  std::vector<char> out(head.begin(), head.end());
  out.reserve(static_cast<size_t>(source.bytes.size()) + head.size());
  out.resize(head.size() + table.size() * sizeof(uint64_t));
  const bool numbered = (plan.version & ExrLayout::kMultiPart) != 0;
  std::span<uint64_t> rest(table);
  for (size_t i = 0; i < plan.parts.size(); ++i) {
    const auto count = static_cast<size_t>(plan.parts[i].geometry.chunk_count());
    append_part(out, rest.first(count), source, plan.parts[i],
                numbered ? std::optional(static_cast<int32_t>(i)) : std::nullopt);
    rest = rest.subspan(count);
  }
  std::memcpy(out.data() + head.size(), table.data(), table.size() * sizeof(uint64_t));
  return out;
}

/// Opens the finished bytes as a reader would: every chunk must be there.
void check_complete(std::span<const char> bytes, const std::string& path) {
  try {
    const MemoryBytes memory(bytes);
    ExrLayout layout = parse_headers(memory, path, std::numeric_limits<int>::max());
    read_offsets(layout, memory, path);
    SourceStream stream(memory, path);
    const Imf::MultiPartInputFile file(stream, 0, false);
    for (int part = 0; part < file.parts(); ++part)
      if (!file.partComplete(part)) throw Iex::InputExc("chunks are missing");
  } catch (const std::exception& error) {
    throw Error(ErrorCode::internal, cat("the file made for ", path, " is not valid: ", reason(error)));
  }
}
}  // namespace

std::vector<std::string> write_exr(const ExrReader& source, std::span<const ChannelWrite> writes,
                                   const std::string& path, const WriteOptions& options) {
  const Plan plan = plan_output(source.handles(), writes, options);
  const std::vector<char> bytes = assemble(source.handles(), plan);
  check_complete(bytes, path);
  publish(bytes, path);
  return plan.notes;
}

void write_new_exr(const NewFile& file, const std::string& path) {
  const Window display = file.display_window;
  Imf::Header header;
  header.displayWindow() = {{display.min_x, display.min_y}, {display.max_x, display.max_y}};
  for (const auto& [name, matrix] : file.matrices) header.insert(name, Imf::M44fAttribute(Imath::M44f(matrix)));
  for (const auto& [name, text] : file.texts) header.insert(name, Imf::StringAttribute(text));
  PackedImage image{file.data_window, {}};
  for (const NewChannel& channel : file.channels)
    pack(channel.pixels, file.data_window, image.add(RawChannel{channel.name, channel.type}), file.data_window);
  Geometry geometry;
  geometry.compression = *compression_from_name("zip");
  const std::vector<char> bytes = guarded(path, [&] { return encode(image, geometry, header); });
  check_complete(bytes, path);
  publish(bytes, path);
}

}  // namespace aftershade::io
