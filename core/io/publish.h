#pragma once
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace aftershade::io {

/// Writes `pieces` one behind the other to `path` so that the file appears complete or not at all: temporary
/// ".NAME.HOST.PID.RANDOM.tmp" in the same folder, write loop, fsync if asked for, checked close, rename. What is there
/// already is replaced if it is a regular file (links are followed to find out), refused otherwise. Throws
/// Error(cannot_create), or Error(io) with errno's text; the temporary is removed on every failure.
void publish(std::span<const std::span<const char>> pieces, const std::string& path, bool fsync);
void publish(std::span<const char> bytes, const std::string& path);  ///< one piece, with fsync

/// Removes the temporaries that this process has open, from a signal handler or an exit path: async-signal-safe.
void remove_temporaries() noexcept;

/// What a path leads to, whatever it is called: two names of one file have equal ids. nullopt when there is no such
/// file.
struct FileId {
  uint64_t device, inode;
  auto operator<=>(const FileId&) const = default;
};
std::optional<FileId> file_id(const std::string& path);

}  // namespace aftershade::io
