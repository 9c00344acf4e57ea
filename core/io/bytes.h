#pragma once
#include <ImfIO.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace aftershade::io {

/// Random access to the bytes of a file or of memory.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  virtual int64_t size() const = 0;
  /// Fills `target` from `offset` on; throws Iex::InputExc when the source ends before.
  virtual void read_at(int64_t offset, std::span<char> target) const = 0;
};

/// A regular file, opened for reading. Throws Error(no_input) with errno's text.
class FileBytes final : public ByteSource {
 public:
  explicit FileBytes(const std::string& path);
  ~FileBytes() override;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;
  int64_t size() const override { return size_; }
  void read_at(int64_t offset, std::span<char> target) const override;

 private:
  std::string path_;
  int descriptor_ = -1;
  int64_t size_ = 0;
};

/// Bytes somebody else owns.
class MemoryBytes final : public ByteSource {
 public:
  explicit MemoryBytes(std::span<const char> bytes) : bytes_(bytes) {}
  int64_t size() const override { return static_cast<int64_t>(bytes_.size()); }
  void read_at(int64_t offset, std::span<char> target) const override;

 private:
  std::span<const char> bytes_;
};

/// A byte source as OpenEXR reads it; buffered, because headers are read byte by byte.
class SourceStream final : public Imf::IStream {
 public:
  SourceStream(const ByteSource& source, const std::string& name) : IStream(name.c_str()), source_(source) {}
  bool read(char target[], int count) override;
  uint64_t tellg() override { return static_cast<uint64_t>(position_); }
  void seekg(uint64_t position) override { position_ = static_cast<int64_t>(position); }

 private:
  const ByteSource& source_;
  std::vector<char> buffer_;
  int64_t buffer_start_ = 0, position_ = 0;
};

/// Memory that OpenEXR writes a file into.
class MemoryStream final : public Imf::OStream {
 public:
  MemoryStream() : OStream("memory") {}
  void write(const char source[], int count) override;
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }
  std::vector<char>& bytes() { return bytes_; }

 private:
  std::vector<char> bytes_;
  uint64_t position_ = 0;
};

}  // namespace aftershade::io
