#pragma once
#include <ImfHeader.h>
#include <ImfPixelType.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/image/window.h"

/// EXR files of every kind, made and taken apart with OpenEXR and by hand, independently of core/io.
namespace aftershade::tests {

/// A folder that lives as long as the test.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }
  size_t file_count() const;

 private:
  std::string path_;
};

struct PartSpec {
  std::string name;
  Window window;
  std::map<std::string, Imf::PixelType> channels;
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  bool tiled = false;  ///< tiles of 16x8
  Imf::LineOrder line_order = Imf::INCREASING_Y;
  std::function<void(Imf::Header&)> more = [](Imf::Header&) {};
};

/// Pixels in their own types, by channel.
using Packed = std::map<std::string, std::vector<char>>;

/// Writes noise: in lossless parts every bit pattern (NaN payloads, denormals, uints above 2^24) occurs. One part
/// without a name makes a single-part file.
void make_exr(const std::string& path, const std::vector<PartSpec>& parts, Window display = {0, 0, 63, 47});

/// Decodes every part with OpenEXR.
std::vector<Packed> decode_all(const std::string& path);

struct Attribute {
  std::string name, type, bytes;
  bool operator==(const Attribute&) const = default;
};
/// A file taken apart by hand (OpenEXR File Layout). Chunks are without part number, in the order of the offset table.
struct FileParts {
  uint32_t version = 0;
  std::vector<std::vector<Attribute>> headers;
  std::vector<std::vector<std::string>> chunks;
};
FileParts take_apart(const std::string& path);
std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& bytes);

/// AFTERSHADE_DATA, or ../shared/data beside the sources.
std::string data_folder();

}  // namespace aftershade::tests
