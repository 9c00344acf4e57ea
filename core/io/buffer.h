#pragma once
#include <cstddef>
#include <utility>

#include "core/image/plane_memory.h"

namespace aftershade::io {

/// Bytes of a frame's pixels or file, any content at first, from where planes have theirs.
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(size_t size)
      : size_(size), bytes_(size > 0 ? reinterpret_cast<char*>(take_plane_memory(size)) : nullptr) {}
  ~Buffer() {
    if (bytes_ != nullptr) return_plane_memory(reinterpret_cast<float*>(bytes_), size_);
  }
  Buffer(Buffer&& other) noexcept
      : size_(std::exchange(other.size_, 0)), bytes_(std::exchange(other.bytes_, nullptr)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(size_, other.size_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }

  char* data() const { return bytes_; }
  size_t size() const { return size_; }

 private:
  size_t size_ = 0;
  char* bytes_ = nullptr;
};

}  // namespace aftershade::io
