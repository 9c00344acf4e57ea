#include "tests/io/exr_files.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

namespace aftershade::tests {

namespace {
size_t size_of(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }

Imf::Slice slice_on(Imf::PixelType type, char* pixels, Window w) {
  return Imf::Slice::Make(type, pixels, {{w.min_x, w.min_y}, {w.max_x, w.max_y}});
}

size_t area(Window w) { return static_cast<size_t>(w.width()) * static_cast<size_t>(w.height()); }

Imf::FrameBuffer buffer_on(Packed& pixels, const Imf::ChannelList& channels, Window window) {
  Imf::FrameBuffer buffer;
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    std::vector<char>& bytes = pixels[it.name()];
    bytes.resize(area(window) * size_of(it.channel().type));
    buffer.insert(it.name(), slice_on(it.channel().type, bytes.data(), window));
  }
  return buffer;
}

bool is_lossless(Imf::Compression c) { return c <= Imf::PIZ_COMPRESSION; }

void fill(Packed& pixels, const PartSpec& spec, unsigned seed) {
  std::mt19937 random(seed);
  for (auto& [name, bytes] : pixels)
    for (size_t i = 0; i + 1 < bytes.size(); i += 2) {
      // Lossy methods get halves and floats near 1: bits 0x3c00 to 0x3dff.
      const auto bits = static_cast<uint16_t>(is_lossless(spec.compression) ? random() : 0x3c00 + random() % 512);
      std::memcpy(bytes.data() + i, &bits, 2);
    }
}

Imf::Header header_of(const PartSpec& spec, Window display, bool multi_part) {
  const Window& w = spec.window;
  Imf::Header header;
  header.displayWindow() = {{display.min_x, display.min_y}, {display.max_x, display.max_y}};
  header.dataWindow() = {{w.min_x, w.min_y}, {w.max_x, w.max_y}};
  header.compression() = spec.compression;
  header.lineOrder() = spec.line_order;
  if (spec.tiled) header.setTileDescription({16, 8, Imf::ONE_LEVEL});
  if (multi_part) {
    header.setName(spec.name);
    header.setType(spec.tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
  }
  for (const auto& [name, type] : spec.channels) header.channels().insert(name, Imf::Channel(type));
  spec.more(header);
  return header;
}

template <class Scanlines, class Tiles, class... Place>
void write_pixels(const PartSpec& spec, const Imf::FrameBuffer& buffer, Place&&... place) {
  if (spec.tiled) {
    Tiles out(place...);
    out.setFrameBuffer(buffer);
    out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
  } else {
    Scanlines out(place...);
    out.setFrameBuffer(buffer);
    out.writePixels(spec.window.height());
  }
}

template <class T>
T take(const std::string& bytes, size_t& at) {
  T value;
  std::memcpy(&value, bytes.substr(at, sizeof value).data(), sizeof value);
  at += sizeof value;
  return value;
}
std::string take_name(const std::string& bytes, size_t& at) {
  const std::string name = bytes.c_str() + at;
  at += name.size() + 1;
  return name;
}

std::vector<Attribute> take_header(const std::string& bytes, size_t& at) {
  std::vector<Attribute> header;
  for (std::string name = take_name(bytes, at); !name.empty(); name = take_name(bytes, at)) {
    const std::string type = take_name(bytes, at);
    const auto size = static_cast<size_t>(take<int32_t>(bytes, at));
    header.push_back({name, type, bytes.substr(at, size)});
    at += size;
  }
  return header;
}

size_t chunk_count(const std::vector<Attribute>& header) {
  Window window;
  uint8_t compression = 0;
  bool tiled = false;
  for (const Attribute& a : header) {
    if (a.name == "dataWindow") std::memcpy(&window, a.bytes.data(), sizeof window);
    if (a.name == "compression") compression = static_cast<uint8_t>(a.bytes[0]);
    if (a.name == "tiles") tiled = true;
  }
  const int rows[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  const int across = tiled ? (window.width() + 15) / 16 : 1, row = tiled ? 8 : rows[compression];
  return static_cast<size_t>(across * ((window.height() + row - 1) / row));
}
}  // namespace

TempFolder::TempFolder() {
  std::string name = std::filesystem::temp_directory_path() / "aftershade-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}
TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}
size_t TempFolder::file_count() const {
  const std::filesystem::directory_iterator files(path_);
  return static_cast<size_t>(std::distance(begin(files), end(files)));
}

void make_exr(const std::string& path, const std::vector<PartSpec>& parts, Window display) {
  const bool multi_part = !parts[0].name.empty();
  std::vector<Imf::Header> headers;
  std::vector<Packed> pixels(parts.size());
  std::vector<Imf::FrameBuffer> buffers;
  for (size_t i = 0; i < parts.size(); ++i) {
    headers.push_back(header_of(parts[i], display, multi_part));
    buffers.push_back(buffer_on(pixels[i], headers[i].channels(), parts[i].window));
    fill(pixels[i], parts[i], static_cast<unsigned>(i + 1));
  }
  if (!multi_part)
    return write_pixels<Imf::OutputFile, Imf::TiledOutputFile>(parts[0], buffers[0], path.c_str(), headers[0]);
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (size_t i = 0; i < parts.size(); ++i)
    write_pixels<Imf::OutputPart, Imf::TiledOutputPart>(parts[i], buffers[i], file, static_cast<int>(i));
}

std::vector<Packed> decode_all(const std::string& path) {
  Imf::MultiPartInputFile file(path.c_str());
  std::vector<Packed> parts(static_cast<size_t>(file.parts()));
  for (int i = 0; i < file.parts(); ++i) {
    const Imath::Box2i box = file.header(i).dataWindow();
    Imf::InputPart part(file, i);
    part.setFrameBuffer(buffer_on(parts[static_cast<size_t>(i)], file.header(i).channels(),
                                  {box.min.x, box.min.y, box.max.x, box.max.y}));
    part.readPixels(box.min.y, box.max.y);
  }
  return parts;
}

FileParts take_apart(const std::string& path) {
  const std::string bytes = read_file(path);
  size_t at = 4;
  FileParts file;
  file.version = take<uint32_t>(bytes, at);
  const bool multi_part = (file.version & 0x1000) != 0;
  do file.headers.push_back(take_header(bytes, at));
  while (multi_part && bytes.at(at) != '\0');
  if (multi_part) ++at;
  for (const auto& header : file.headers) {
    const bool tiled = std::ranges::count(header, std::string("tiles"), &Attribute::name) > 0;
    std::vector<std::string>& chunks = file.chunks.emplace_back();
    for (size_t i = chunk_count(header); i > 0; --i) {
      const size_t start = take<uint64_t>(bytes, at) + (multi_part ? 4 : 0);
      size_t size_at = start + (tiled ? 16 : 4);
      const auto size = static_cast<size_t>(take<int32_t>(bytes, size_at));
      chunks.push_back(bytes.substr(start, size_at - start + size));
    }
  }
  return file;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void write_file(const std::string& path, const std::string& bytes) {
  std::filesystem::remove(path);  // a truncated file would be flushed to disk on close, which is slow
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string data_folder() {
  const char* set = std::getenv("AFTERSHADE_DATA");
  return set != nullptr ? set : std::string(AFTERSHADE_SOURCE_DIR) + "/../shared/data";
}

}  // namespace aftershade::tests
