#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/sequence.h"

namespace aftershade::io {

namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_word(char c) { return is_digit(c) || is_letter(c); }

struct Token {
  size_t begin, end;
  int padding;
};

/// "%d" and "%04d" at `i`; "%4d" counts as "%04d", because nobody pads file names with blanks.
std::optional<Token> printf_token(std::string_view name, size_t i) {
  size_t end = i + 1;
  while (end < name.size() && is_digit(name[end])) ++end;
  if (end == name.size() || name[end] != 'd') return std::nullopt;
  const int padding = parse_integer(name.substr(i + 1, end - i - 1)).value_or(1);
  return Token{i, end + 1, padding};
}

/// "$F" and "$F4" at `i` (Houdini).
std::optional<Token> houdini_token(std::string_view name, size_t i) {
  if (i + 1 >= name.size() || name[i + 1] != 'F') return std::nullopt;
  size_t end = i + 2;
  while (end < name.size() && is_digit(name[end])) ++end;
  if (end < name.size() && is_letter(name[end])) return std::nullopt;  // another variable, $FF or $FRAME
  return Token{i, end, parse_integer(name.substr(i + 2, end - i - 2)).value_or(1)};
}

/// A run of # and @ at `i`.
Token hash_token(std::string_view name, size_t i, HashDigits hash) {
  Token token{i, i, 0};
  for (; token.end < name.size() && (name[token.end] == '#' || name[token.end] == '@'); ++token.end)
    token.padding += name[token.end] == '#' && hash == HashDigits::oiio ? 4 : 1;
  return token;
}

/// The last frame token of a file name: the frame number is by custom the last thing before the extension.
std::optional<Token> find_token(std::string_view name, HashDigits hash) {
  std::optional<Token> last;
  for (size_t i = 0; i < name.size();) {
    std::optional<Token> token;
    if (name[i] == '#' || name[i] == '@') token = hash_token(name, i, hash);
    if (name[i] == '%') token = printf_token(name, i);
    if (name[i] == '$') token = houdini_token(name, i);
    if (token) last = token;
    i = token ? token->end : i + 1;
  }
  return last;
}

/// The inline range that ends at the end of `before` ("shot.1001-1100"), as the index where it starts. Digits alone
/// belong to the name ("v2#", "shot010#"), and so does a range whose first number continues a word.
std::optional<size_t> find_inline_range(std::string_view before) {
  size_t begin = before.size();
  while (begin > 0 &&
         (is_digit(before[begin - 1]) || std::string_view("-,x:").find(before[begin - 1]) != std::string_view::npos))
    --begin;
  for (; begin < before.size(); ++begin) {
    const std::string_view range = before.substr(begin);
    if (begin > 0 && is_word(before[begin - 1])) continue;
    if (range.find('-', 1) == std::string_view::npos) return std::nullopt;
    try {
      parse_frames(range);
      return begin;
    } catch (const Error&) {  // not a range from here on
    }
  }
  return std::nullopt;
}

std::pair<std::string, std::string> split_folder(std::string_view path) {
  const size_t slash = path.rfind('/');
  if (slash == std::string_view::npos) return {".", std::string(path)};
  return {slash == 0 ? "/" : std::string(path.substr(0, slash)), std::string(path.substr(slash + 1))};
}

/// The end of the name before its extension; the extension is no frame number.
size_t stem_length(std::string_view name) {
  const size_t dot = name.rfind('.');
  if (dot == std::string_view::npos || dot == 0) return name.size();
  const std::string_view extension = name.substr(dot + 1);
  return std::all_of(extension.begin(), extension.end(), is_digit) ? name.size() : dot;
}

/// Is the run of digits [begin, end) a version or a size, as in "_v2", "4k" and "@2x"?
bool is_no_frame(std::string_view name, size_t begin, size_t end) {
  if (end < name.size() && is_letter(name[end])) return true;
  if (begin == 0 || (name[begin - 1] != 'v' && name[begin - 1] != 'V')) return false;
  return begin == 1 || !is_word(name[begin - 2]);
}

std::string digits_of(int frame, int padding) {
  std::string digits = cat(std::abs(static_cast<long long>(frame)));
  if (digits.size() < static_cast<size_t>(padding)) digits.insert(0, static_cast<size_t>(padding) - digits.size(), '0');
  return (frame < 0 ? "-" : "") + digits;
}

std::string in_folder(const std::string& folder, const std::string& name) {
  if (folder == ".") return name;
  return folder.ends_with('/') ? folder + name : folder + "/" + name;
}

}  // namespace

std::string Pattern::name(int frame) const {
  return has_token ? prefix + digits_of(frame, padding) + suffix : prefix + suffix;
}
std::string Pattern::path(int frame) const { return path_of(name(frame)); }
std::string Pattern::path_of(const std::string& name) const { return in_folder(folder, name); }
std::string Pattern::text() const {
  const std::string token(has_token ? static_cast<size_t>(padding) : 0, '#');
  return in_folder(folder, prefix + token + suffix);
}

std::optional<Pattern> parse_pattern(std::string_view text, HashDigits hash) {
  const auto [folder, name] = split_folder(text);
  const auto token = find_token(name, hash);
  if (!token) return std::nullopt;
  if (token->padding > 9)  // frame numbers are 32-bit integers
    throw Error(ErrorCode::usage,
                cat("\"", name, "\" asks for ", token->padding, " digits; frame numbers have at most 9"));
  Pattern pattern{.folder = folder,
                  .prefix = name.substr(0, token->begin),
                  .suffix = name.substr(token->end),
                  .padding = std::max(1, token->padding)};
  if (const auto begin = find_inline_range(pattern.prefix)) {
    pattern.range = parse_frames(std::string_view(pattern.prefix).substr(*begin));
    pattern.prefix.resize(*begin);
  }
  return pattern;
}

std::optional<Pattern> pattern_of_frame(std::string_view path) {
  const auto [folder, name] = split_folder(path);
  for (size_t end = stem_length(name); end > 0; --end) {
    if (!is_digit(name[end - 1])) continue;
    size_t begin = end;
    while (begin > 0 && is_digit(name[begin - 1])) --begin;
    if (is_no_frame(name, begin, end) || end - begin > 9) {
      end = begin + 1;
      continue;
    }
    const int padding = static_cast<int>(end - begin);
    const bool negative = begin > 0 && name[begin - 1] == '-' && (begin == 1 || !is_word(name[begin - 2]));
    return Pattern{.folder = folder,
                   .prefix = name.substr(0, begin - (negative ? 1 : 0)),
                   .suffix = name.substr(end),
                   .padding = padding};
  }
  return std::nullopt;
}

std::optional<int> frame_of_name(const Pattern& pattern, std::string_view name) {
  if (!pattern.has_token) return name == pattern.prefix + pattern.suffix ? std::optional(0) : std::nullopt;
  if (!name.starts_with(pattern.prefix)) return std::nullopt;
  name.remove_prefix(pattern.prefix.size());
  if (!name.ends_with(pattern.suffix)) return std::nullopt;
  name.remove_suffix(pattern.suffix.size());
  const bool negative = name.starts_with('-');
  const std::string_view digits = name.substr(negative ? 1 : 0);
  if (digits.empty() || !std::all_of(digits.begin(), digits.end(), is_digit)) return std::nullopt;
  const auto padding = static_cast<size_t>(pattern.padding);
  // The sign is extra; printf counts it, so -001 is a name of frame -1 under %04d too.
  const size_t least = negative && padding > 1 ? padding - 1 : padding;
  if (digits.size() < least || (digits.size() > padding && digits.front() == '0')) return std::nullopt;
  const auto frame = parse_integer(digits);
  if (!frame || (negative && *frame == 0)) return std::nullopt;
  return negative ? -*frame : *frame;
}

}  // namespace aftershade::io
