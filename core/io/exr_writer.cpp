#include "core/io/exr_writer.h"

#include <Iex.h>
#include <ImfHeader.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <limits>

#include "core/io/exr_decode.h"
#include "core/io/exr_encode.h"
#include "core/io/publish.h"

namespace aftershade::io {

namespace {
/// The output, chunk by chunk.
struct FileBytesToBe {
  std::string head;  ///< headers, then offset tables
  std::vector<PartChunks> parts;
  std::vector<std::span<const char>> pieces;  ///< head and chunks, as they lie in the file
};

PartChunks chunks_of(const ExrReader::Handles& source, const PlannedPart& part, const PackedParts& decoded,
                     std::optional<int32_t> part_number, bool recode) {
  return guarded(part_text(source.info, part.source_part), [&] {
    if (!part.encode) return copy_chunks(source.layout, part.source_part, source.bytes, part_number);
    if (!part.copy_channels) return encode_chunks(source, part, nullptr, part_number, recode);
    if (const auto found = decoded.find(part.source_part); found != decoded.end())
      return encode_chunks(source, part, found->second.get(), part_number, recode);
    const RawPart& raw = source.layout.parts[static_cast<size_t>(part.source_part)];
    PackedImage image(raw.geometry.window, raw.channels);
    decode_part(source, part.source_part, {}, {}, &image);
    return encode_chunks(source, part, &image, part_number, recode);
  });
}

/// Lays the chunks of each part behind those of the part before and notes where they begin.
void lay_out(FileBytesToBe& file) {
  size_t chunks = 0;
  for (const PartChunks& part : file.parts) chunks += part.bytes.size();
  std::vector<uint64_t> table(chunks);
  uint64_t position = file.head.size() + table.size() * sizeof(uint64_t);
  std::span<uint64_t> rest(table);
  file.pieces.push_back({});  // the head
  for (const PartChunks& part : file.parts) {
    for (const int64_t index : part.order) {
      const std::span<const char> chunk = part.bytes[static_cast<size_t>(index)];
      rest[static_cast<size_t>(index)] = position;
      position += chunk.size();
      file.pieces.push_back(chunk);
    }
    rest = rest.subspan(part.bytes.size());
  }
  file.head.append(reinterpret_cast<const char*>(table.data()), table.size() * sizeof(uint64_t));
  file.pieces[0] = file.head;
}

FileBytesToBe assemble(const ExrReader::Handles& source, const Plan& plan, const PackedParts& decoded, bool recode) {
  std::vector<RawHeader> headers;
  for (const PlannedPart& part : plan.parts) headers.push_back(part.header);
  FileBytesToBe file{format_headers(plan.version, headers), {}, {}};
  const bool numbered = (plan.version & ExrLayout::kMultiPart) != 0;
  for (size_t i = 0; i < plan.parts.size(); ++i)
    file.parts.push_back(chunks_of(source, plan.parts[i], decoded,
                                   numbered ? std::optional(static_cast<int32_t>(i)) : std::nullopt, recode));
  lay_out(file);
  return file;
}

/// Pieces of a file, one behind the other.
class PieceBytes final : public ByteSource {
 public:
  explicit PieceBytes(std::span<const std::span<const char>> pieces) : pieces_(pieces) {
    for (const std::span<const char> piece : pieces_) ends_.push_back(size() + static_cast<int64_t>(piece.size()));
  }
  int64_t size() const override { return ends_.empty() ? 0 : ends_.back(); }
  void read_at(int64_t offset, std::span<char> target) const override {
    while (!target.empty()) {
      const auto at = static_cast<size_t>(std::ranges::upper_bound(ends_, offset) - ends_.begin());
      if (offset < 0 || at == ends_.size()) throw Iex::InputExc("the file ends too early");
      const auto rest = static_cast<size_t>(ends_[at] - offset);
      const std::span<char> part = target.first(std::min(target.size(), rest));
      std::copy_n(pieces_[at].end() - static_cast<std::ptrdiff_t>(rest), part.size(), part.begin());
      target = target.subspan(part.size());
      offset += static_cast<int64_t>(part.size());
    }
  }

 private:
  std::span<const std::span<const char>> pieces_;
  std::vector<int64_t> ends_;
};

/// Reads the finished bytes as a reader would, but for the pixels: every chunk must be there and lie in the file.
void check_complete(std::span<const std::span<const char>> pieces, const std::string& path) {
  try {
    const PieceBytes bytes(pieces);
    ExrLayout layout = parse_headers(bytes, path, std::numeric_limits<int>::max());
    read_offsets(layout, bytes, path);
    for (size_t part = 0; part < layout.parts.size(); ++part)
      for (size_t i = 0; i < layout.parts[part].offsets.size(); ++i)
        find_chunk(layout, static_cast<int>(part), static_cast<int64_t>(i), bytes);
  } catch (const std::exception& error) {
    throw Error(ErrorCode::internal, cat("the file made for ", path, " is not valid: ", reason(error)));
  }
}
}  // namespace

std::vector<std::string> write_exr(const ExrReader& source, std::span<const ChannelWrite> writes,
                                   const std::string& path, const WriteOptions& options, const PackedParts& decoded) {
  const Plan plan = plan_output(source.handles(), writes, options);
  const FileBytesToBe file = assemble(source.handles(), plan, decoded, options.recode);
  check_complete(file.pieces, path);
  publish(file.pieces, path, options.fsync);
  return plan.notes;
}

void write_new_exr(const NewFile& file, const std::string& path) {
  const Window display = file.display_window;
  Imf::Header header;
  header.displayWindow() = {{display.min_x, display.min_y}, {display.max_x, display.max_y}};
  for (const auto& [name, matrix] : file.matrices) header.insert(name, Imf::M44fAttribute(Imath::M44f(matrix)));
  for (const auto& [name, text] : file.texts) header.insert(name, Imf::StringAttribute(text));
  std::vector<RawChannel> channels;
  for (const NewChannel& channel : file.channels) channels.push_back(RawChannel{channel.name, channel.type});
  const PackedImage image(file.data_window, std::move(channels));
  std::fill_n(image.pixels.data(), image.pixels.size(), '\0');
  for (const NewChannel& channel : file.channels)
    for (int y = 0; y < file.data_window.height(); ++y)
      pack_row(channel.type, channel.pixels.row(y), file.data_window.width(),
               image.row(static_cast<size_t>(image.layout.find(channel.name)), file.data_window.min_y + y));
  Geometry geometry;
  geometry.compression = *compression_from_name("zip");
  const std::vector<char> bytes = guarded(path, [&] { return encode(image, geometry, header); });
  const std::span<const char> piece(bytes);
  check_complete({&piece, 1}, path);
  publish(bytes, path);
}

}  // namespace aftershade::io
