#pragma once
#include <span>
#include <string>

namespace aftershade::io {

/// Writes `bytes` to `path` so that the file appears complete or not at all: temporary ".NAME.HOST.PID.RANDOM.tmp" in
/// the same folder, write loop, fsync, checked close, rename. Throws Error(cannot_create) or Error(io) with errno's
/// text; the temporary is removed on every failure.
void publish(std::span<const char> bytes, const std::string& path);

/// Removes the temporaries that this process has open, from a signal handler or an exit path: async-signal-safe.
void remove_temporaries() noexcept;

/// Do both paths name the same file (device and inode)? False when one does not exist.
bool same_file(const std::string& a, const std::string& b);

}  // namespace aftershade::io
