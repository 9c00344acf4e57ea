#include "tests/rules/source_text.h"

#include <algorithm>
#include <cctype>
#include <regex>

namespace aftershade::tests {

namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// Walks over a text and blanks what is not code.
class Blanker {
 public:
  explicit Blanker(std::string_view text) : text_(text), out_(text) {}

  std::string run() {
    while (at_ < text_.size()) step();
    return std::move(out_);
  }

 private:
  void step() {
    const char c = text_[at_];
    if (text_.substr(at_, 2) == "//")
      blank_to(line_end());
    else if (text_.substr(at_, 2) == "/*")
      blank_to(after("*/", at_ + 2));
    else if (c == '"' && is_raw())
      blank_to(raw_end());
    else if (c == '"' || (c == '\'' && !is_digit_separator()))
      blank_to(quoted_end(c));
    else
      ++at_;
  }

  void blank_to(size_t end) {
    for (; at_ < end; ++at_)
      if (text_[at_] != '\n') out_[at_] = ' ';
  }
  size_t after(std::string_view mark, size_t from) const {
    const size_t found = text_.find(mark, from);
    return found == std::string_view::npos ? text_.size() : found + mark.size();
  }
  size_t line_end() const {  // a backslash at its end continues a comment
    size_t end = text_.find('\n', at_);
    while (end != std::string_view::npos && end > 0 && text_[end - 1] == '\\') end = text_.find('\n', end + 1);
    return std::min(end, text_.size());
  }
  bool is_raw() const {
    return at_ > 0 && text_[at_ - 1] == 'R' && (at_ < 2 || !is_word(text_[at_ - 2]) || is_prefix());
  }
  bool is_prefix() const {
    return text_[at_ - 2] == 'u' || text_[at_ - 2] == 'U' || text_[at_ - 2] == 'L' || text_[at_ - 2] == '8';
  }
  size_t raw_end() const {
    const size_t open = text_.find('(', at_);
    if (open == std::string_view::npos) return text_.size();
    return after(")" + std::string(text_.substr(at_ + 1, open - at_ - 1)) + "\"", open);
  }
  size_t quoted_end(char quote) const {
    size_t end = at_ + 1;
    while (end < text_.size() && text_[end] != quote && text_[end] != '\n') end += text_[end] == '\\' ? 2 : 1;
    return std::min(end + 1, text_.size());
  }
  bool is_digit_separator() const {  // 1'000: the word that it stands in starts with a digit
    size_t start = at_;
    while (start > 0 && (is_word(text_[start - 1]) || text_[start - 1] == '\'')) --start;
    return start < at_ && std::isdigit(static_cast<unsigned char>(text_[start]));
  }

  std::string_view text_;
  std::string out_;
  size_t at_ = 0;
};

int line_of(std::string_view text, size_t at) {
  return static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
}

std::string one_line(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool space = std::isspace(static_cast<unsigned char>(c));
    if (!space || (!out.empty() && out.back() != ' ')) out += space ? ' ' : c;
  }
  if (out.ends_with(' ')) out.pop_back();
  return out;
}

/// Directives are not C++ statements: their braces and parentheses need not match.
std::string without_directives(std::string code) {
  bool directive = false;
  for (size_t at = 0; at < code.size();) {
    const size_t end = std::min(code.find('\n', at), code.size());
    const size_t first = code.find_first_not_of(" \t", at);
    directive = directive || (first < end && code[first] == '#');
    const bool continues = directive && end > at && code[end - 1] == '\\';
    if (directive)
      std::fill(code.begin() + static_cast<std::ptrdiff_t>(at), code.begin() + static_cast<std::ptrdiff_t>(end), ' ');
    directive = continues;
    at = end + 1;
  }
  return code;
}

enum class Scope { container, function, other };

std::string_view without_template(std::string_view header) {
  if (!header.starts_with("template")) return header;
  int depth = 0;
  for (size_t i = header.find('<'); i < header.size(); ++i) {
    if (header[i] == '<') ++depth;
    if (header[i] == '>' && --depth == 0) return header.substr(std::min(i + 2, header.size()));
  }
  return header;
}

/// `header`: what stands between the last statement of a namespace or class and an opening brace, in one line.
Scope scope_of(std::string_view header) {
  if (header.empty() || header.starts_with(',')) return Scope::function;  // goes on after the a_{1} of a constructor
  std::string_view rest = without_template(header);
  for (const std::string_view word : {"inline ", "static ", "typedef ", "const "})
    if (rest.starts_with(word)) rest.remove_prefix(word.size());
  const bool parameters = header.ends_with(')') || header.ends_with(") const") || header.ends_with(") noexcept");
  for (const std::string_view word : {"namespace", "extern ", "class ", "struct ", "union ", "enum "})
    if (rest.starts_with(word) && !parameters) return Scope::container;
  if (header.ends_with('=')) return Scope::other;
  return header.find('(') != std::string_view::npos || header.ends_with(']') ? Scope::function : Scope::other;
}

/// Finds the functions of a text by matching its braces.
class FunctionFinder {
 public:
  explicit FunctionFinder(std::string_view text) : code_(without_directives(code_only(text))) {}

  std::vector<Function> run() {
    for (size_t at = 0; at < code_.size(); ++at) step(at);
    return std::move(found_);
  }

 private:
  struct Open {
    Scope scope;
    size_t header_start;
    std::string header;
  };

  bool in_container() const { return open_.empty() || open_.back().scope == Scope::container; }

  void step(size_t at) {
    const char c = code_[at];
    if (c == '{') return open(at);
    if (c == '}') return close(at);
    if (!in_container()) return;
    if (c == '(') ++parentheses_;
    if (c == ')') --parentheses_;
    if (c == ';' && parentheses_ == 0) header_start_ = at + 1;
    if (c == ':' && is_access_label(at)) header_start_ = at + 1;
  }

  bool is_access_label(size_t at) const {
    const std::string header = one_line(std::string_view(code_).substr(header_start_, at - header_start_));
    return header == "public" || header == "private" || header == "protected";
  }

  void open(size_t at) {
    if (!in_container() || parentheses_ > 0) {
      open_.push_back({Scope::other, at, ""});
      return;
    }
    const size_t start = std::min(code_.find_first_not_of(" \t\r\n", header_start_), at);
    const std::string header = one_line(std::string_view(code_).substr(start, at - start));
    open_.push_back({scope_of(header), start, header});
    if (open_.back().scope == Scope::container) header_start_ = at + 1;
  }

  void close(size_t at) {
    if (open_.empty()) return;
    const Open top = std::move(open_.back());
    open_.pop_back();
    if (top.scope == Scope::function) {
      const int first = line_of(code_, top.header_start);
      found_.push_back({top.header, first, line_of(code_, at) - first + 1});
    }
    if (top.scope != Scope::other) header_start_ = at + 1;
  }

  std::string code_;
  std::vector<Open> open_;
  std::vector<Function> found_;
  size_t header_start_ = 0;
  int parentheses_ = 0;
};

}  // namespace

std::string code_only(std::string_view text) { return Blanker(text).run(); }

std::vector<Include> includes(std::string_view text) {
  static const std::regex directive("(^|\n)[ \t]*#[ \t]*include[ \t]*");
  const std::string code = code_only(text);
  std::vector<Include> out;
  for (std::sregex_iterator match(code.begin(), code.end(), directive), end; match != end; ++match) {
    const size_t start = static_cast<size_t>(match->position() + match->length());
    // The name of "core/x.h" is blank in `code`: it is read from the text, up to its closing mark.
    const size_t quote = std::min(text.find_first_of("\"<", static_cast<size_t>(match->position())), text.size());
    const size_t stop = text.find_first_of("\">", quote + 1);
    if (stop != std::string_view::npos)
      out.push_back({std::string(text.substr(quote, stop - quote + 1)), line_of(text, start)});
  }
  return out;
}

std::vector<std::string> function_like_macros(std::string_view text) {
  static const std::regex definition("(^|\n)[ \t]*#[ \t]*define[ \t]+(\\w+)\\(");
  const std::string code = code_only(text);
  std::vector<std::string> out;
  for (std::sregex_iterator match(code.begin(), code.end(), definition), end; match != end; ++match)
    out.push_back((*match)[2]);
  return out;
}

std::vector<Function> functions(std::string_view text) { return FunctionFinder(text).run(); }

}  // namespace aftershade::tests
