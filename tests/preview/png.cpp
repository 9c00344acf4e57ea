#include "tests/preview/png.h"

#include <zlib.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace aftershade::tests {

namespace {

void require(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(std::string("PNG: ") + what);
}

uint32_t big_endian(const std::vector<uint8_t>& bytes, size_t at) {
  require(at + 4 <= bytes.size(), "truncated");
  return uint32_t{bytes[at]} << 24 | uint32_t{bytes[at + 1]} << 16 | uint32_t{bytes[at + 2]} << 8 |
         uint32_t{bytes[at + 3]};
}

/// 9.4: the neighbour nearest to left + above - upper left.
int paeth(int left, int above, int upper_left) {
  const int estimate = left + above - upper_left;
  const int a = std::abs(estimate - left), b = std::abs(estimate - above), c = std::abs(estimate - upper_left);
  if (a <= b && a <= c) return left;
  return b <= c ? above : upper_left;
}

int predicted(int filter, int left, int above, int upper_left) {
  switch (filter) {
    case 0:
      return 0;
    case 1:
      return left;
    case 2:
      return above;
    case 3:
      return (left + above) / 2;
    case 4:
      return paeth(left, above, upper_left);
    default:
      throw std::runtime_error("PNG: unknown filter");
  }
}

std::vector<uint8_t> unfiltered(const std::vector<uint8_t>& raw, size_t row_bytes, size_t rows) {
  std::vector<uint8_t> out(row_bytes * rows);
  for (size_t y = 0; y < rows; ++y)
    for (size_t i = 0; i < row_bytes; ++i) {
      const size_t at = y * row_bytes + i;
      const int left = i >= 3 ? out[at - 3] : 0;
      const int above = y > 0 ? out[at - row_bytes] : 0;
      const int upper_left = i >= 3 && y > 0 ? out[at - row_bytes - 3] : 0;
      const int filter = raw[y * (row_bytes + 1)];
      out[at] = static_cast<uint8_t>(raw[y * (row_bytes + 1) + 1 + i] + predicted(filter, left, above, upper_left));
    }
  return out;
}

}  // namespace

Png read_png(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  require(bytes.size() > 8 && std::string(bytes.begin(), bytes.begin() + 8) == "\x89PNG\r\n\x1a\n", "no signature");
  Png out;
  std::vector<uint8_t> packed;
  for (size_t at = 8; at < bytes.size();) {
    const size_t size = big_endian(bytes, at), data = at + 8, end = data + size;
    require(end + 4 <= bytes.size(), "truncated chunk");
    require(crc32(0, &bytes[at + 4], static_cast<uInt>(size + 4)) == big_endian(bytes, end), "wrong checksum");
    out.chunks.emplace_back(&bytes[at + 4], &bytes[data]);
    if (out.chunks.back() == "IHDR") {
      out.width = static_cast<int>(big_endian(bytes, data));
      out.height = static_cast<int>(big_endian(bytes, data + 4));
      require(bytes[data + 8] == 8 && bytes[data + 9] == 2 && bytes[data + 12] == 0, "not 8-bit RGB without interlace");
    }
    if (out.chunks.back() == "IDAT") packed.insert(packed.end(), &bytes[data], &bytes[end]);
    at = end + 4;
  }
  require(!out.chunks.empty() && out.chunks.back() == "IEND", "no end");
  const size_t row_bytes = 3 * static_cast<size_t>(out.width), rows = static_cast<size_t>(out.height);
  std::vector<uint8_t> raw((row_bytes + 1) * rows);
  uLongf raw_size = raw.size();
  require(uncompress(raw.data(), &raw_size, packed.data(), packed.size()) == Z_OK && raw_size == raw.size(),
          "bad data");
  out.pixels = unfiltered(raw, row_bytes, rows);
  return out;
}

}  // namespace aftershade::tests
