#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace aftershade {

/// Bytes that this process may use: those of the machine, or of the tightest of its cgroups (version 1 or 2), if that
/// is less. `root` stands before /proc and /sys (for tests). nullopt when neither tells.
std::optional<int64_t> usable_memory(const std::string& root = "");

/// "700M", "2G", "1.5 GiB", "4096" (bytes): bytes; K, M, G and T are powers of 1024. nullopt for anything else, and for
/// less than one byte.
std::optional<int64_t> parse_size(std::string_view text);
/// "683 MB", with the M of parse_size.
std::string size_text(int64_t bytes);

}  // namespace aftershade
