#include "core/io/bytes.h"

#include <Iex.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::io {

namespace {
[[noreturn]] void end_of_file() { throw Iex::InputExc("the file ends too early"); }

Error unreadable(const std::string& path, int error) {
  return {ErrorCode::no_input, cat("cannot read ", path, ": ", std::strerror(error))};
}

int64_t regular_file_size(const std::string& path, int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) throw unreadable(path, errno);
  if (S_ISDIR(status.st_mode)) throw unreadable(path, EISDIR);
  if (!S_ISREG(status.st_mode)) throw Error(ErrorCode::no_input, cat("cannot read ", path, ": not a regular file"));
  return status.st_size;
}
}  // namespace

// O_NONBLOCK: opening a pipe must not wait for its writer.
FileBytes::FileBytes(const std::string& path)
    : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) throw unreadable(path, errno);
  try {
    size_ = regular_file_size(path, descriptor_);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

FileBytes::~FileBytes() { ::close(descriptor_); }

void FileBytes::read_at(int64_t offset, std::span<char> target) const {
  while (!target.empty()) {
    const ssize_t count = ::pread(descriptor_, target.data(), target.size(), offset);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw unreadable(path_, errno);
    if (count == 0) end_of_file();
    offset += count;
    target = target.subspan(static_cast<size_t>(count));
  }
}

void MemoryBytes::read_at(int64_t offset, std::span<char> target) const {
  const auto wanted = static_cast<int64_t>(target.size());
  if (offset < 0 || offset > size() || wanted > size() - offset) end_of_file();
  std::copy_n(bytes_.begin() + offset, target.size(), target.begin());
}

bool SourceStream::read(char target[], int count) {
  constexpr int64_t kBuffer = 1 << 16;
  if (count < 0 || position_ < 0 || position_ > source_.size() || count > source_.size() - position_) end_of_file();
  if (count >= kBuffer) {
    source_.read_at(position_, {target, static_cast<size_t>(count)});
  } else {
    const int64_t buffered = buffer_start_ + static_cast<int64_t>(buffer_.size());
    if (position_ < buffer_start_ || position_ + count > buffered) {
      buffer_.resize(static_cast<size_t>(std::min(kBuffer, source_.size() - position_)));
      buffer_start_ = position_;
      source_.read_at(position_, buffer_);
    }
    std::copy_n(buffer_.begin() + (position_ - buffer_start_), count, target);
  }
  position_ += count;
  return position_ < source_.size();
}

void MemoryStream::write(const char source[], int count) {
  const uint64_t end = position_ + static_cast<uint64_t>(count);
  if (end > bytes_.size()) bytes_.resize(end);
  std::copy_n(source, count, bytes_.begin() + static_cast<std::ptrdiff_t>(position_));
  position_ = end;
}

}  // namespace aftershade::io
