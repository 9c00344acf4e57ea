#pragma once
#include <charconv>
#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aftershade {

namespace detail {
inline void append(std::string& out, std::string_view text) { out += text; }
inline void append(std::string& out, char c) { out += c; }
template <class T>
requires(std::integral<T> && !std::same_as<T, bool>) || std::floating_point<T> void append(std::string& out, T value) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  out.append(buffer, end);
}
}  // namespace detail

/// The parts as one text; numbers in their shortest form that reads back exactly, in the C locale.
template <class... Parts>
std::string cat(const Parts&... parts) {
  std::string out;
  (detail::append(out, parts), ...);
  return out;
}

/// `value` with `digits` digits after the point.
std::string fixed(double value, int digits);

std::vector<std::string> split(std::string_view text, char separator);
std::string join(std::span<const std::string> parts, std::string_view separator);
std::string to_lower(std::string_view text);

/// The whole of `text` as a number, in the C locale; nullopt when it is not one.
std::optional<double> parse_number(std::string_view text);
std::optional<int> parse_integer(std::string_view text);

/// Does `text` match `pattern`, where `*` stands for any run of characters? Case-insensitive.
bool glob_match(std::string_view pattern, std::string_view text);

/// The candidate nearest to `word` by edit distance, if it is near enough to be a typing error.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string> candidates);

/// `did you mean "x"?`, or an empty text.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace aftershade
