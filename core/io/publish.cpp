#include "core/io/publish.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <random>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::io {

namespace {
/// A temporary that exists or is about to, where a signal handler can find it.
struct Slot {
  enum State { unused, claimed, listed };
  std::atomic<int> state{unused};
  char path[PATH_MAX];
};
std::array<Slot, 64> slots;
static_assert(std::atomic<int>::is_always_lock_free, "the signal handler reads it");

/// Lists a path in the table for as long as it lives.
class Listed {
 public:
  explicit Listed(const std::string& path) : slot_(claim()) {
    std::memcpy(slot_.path, path.c_str(), path.size() + 1);
    slot_.state.store(Slot::listed);
  }
  ~Listed() { slot_.state.store(Slot::unused); }
  Listed(const Listed&) = delete;
  Listed& operator=(const Listed&) = delete;

 private:
  static Slot& claim() {
    for (Slot& slot : slots)
      if (int expected = Slot::unused; slot.state.compare_exchange_strong(expected, Slot::claimed)) return slot;
    throw Error(ErrorCode::internal, "too many files are being written at once");
  }
  Slot& slot_;
};

struct Place {
  std::string folder, name;
};
Place place_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  if (slash == std::string::npos) return {".", path};
  return {slash == 0 ? "/" : path.substr(0, slash), path.substr(slash + 1)};
}

std::string host_name() {
  char name[HOST_NAME_MAX + 1] = {};
  if (::gethostname(name, sizeof name - 1) != 0) return "host";
  return name;
}

/// A name that neither *.exr nor a shell's * matches (reliability 1.4).
std::string temporary_path(const Place& place) {
  constexpr size_t kLongestStem = 100;
  std::string stem = place.name;
  if (stem.ends_with(".exr")) stem.resize(stem.size() - 4);
  stem = stem.substr(0, kLongestStem);
  std::random_device random;
  std::string path =
      cat(place.folder, "/.", stem, ".", host_name().substr(0, 64), ".", int64_t{::getpid()}, ".", random(), ".tmp");
  if (path.size() >= PATH_MAX) throw Error(ErrorCode::cannot_create, cat("cannot create ", path, ": name too long"));
  return path;
}

Error cannot_write(const std::string& path, int error) {
  return {ErrorCode::io, cat("cannot write ", path, ": ", std::strerror(error))};
}

/// A rename would put the file in place of a device such as /dev/null.
void check_target(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw Error(ErrorCode::cannot_create, cat("cannot write ", path, ": it is not a regular file"),
                "name a file that may be replaced, or none");
}

int create(const std::string& temporary, const Place& place, const std::string& path) {
  const int descriptor = ::open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor >= 0) return descriptor;
  const int error = errno;
  if (error == ENOSPC || error == EIO || error == EDQUOT || error == EMFILE || error == ENFILE)
    throw cannot_write(path, error);
  throw Error(ErrorCode::cannot_create,
              cat("cannot create ", place.name, " in folder ", place.folder, ": ", std::strerror(error)),
              "create the folder, or name one that can be written to");
}

/// 0, or the errno of what went wrong.
int write_all(int descriptor, std::span<const char> bytes) {
  constexpr size_t kPiece = 64 << 20;
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), std::min(bytes.size(), kPiece));
    if (count < 0 && errno != EINTR) return errno;
    if (count > 0) bytes = bytes.subspan(static_cast<size_t>(count));
  }
  return 0;
}

int flush(int descriptor) {
  // Some file systems (pipes of the proc kind) have nothing to flush.
  return ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS ? 0 : errno;
}
}  // namespace

void publish(std::span<const std::span<const char>> pieces, const std::string& path, bool fsync) {
  check_target(path);
  const Place place = place_of(path);
  const std::string temporary = temporary_path(place);
  const Listed listed(temporary);
  const int descriptor = create(temporary, place, path);
  int error = 0;
  for (size_t i = 0; i < pieces.size() && error == 0; ++i) error = write_all(descriptor, pieces[i]);
  if (error == 0 && fsync) error = flush(descriptor);
  // A network file system may report a full disk only here; the descriptor is gone whatever close says.
  if (::close(descriptor) != 0 && error == 0 && errno != EINTR) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(temporary.c_str());
  throw cannot_write(path, error);
}

void publish(std::span<const char> bytes, const std::string& path) { publish({&bytes, 1}, path, true); }

void remove_temporaries() noexcept {
  const int saved = errno;
  for (Slot& slot : slots)
    if (slot.state.load() == Slot::listed) ::unlink(slot.path);
  errno = saved;
}

std::optional<FileId> file_id(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return FileId{status.st_dev, status.st_ino};
}

}  // namespace aftershade::io
