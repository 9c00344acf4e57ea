#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aftershade::tests {

/// C++ with the insides of comments, strings, raw strings and character constants replaced by spaces. Offsets and line
/// breaks stay, so that a place in the result is the same place in the text.
std::string code_only(std::string_view text);

/// The files that `text` includes, as written: "core/base/error.h" with its quotes, <vector> with its brackets.
struct Include {
  std::string name;
  int line;
};
std::vector<Include> includes(std::string_view text);

/// Names of the function-like macros that `text` defines.
std::vector<std::string> function_like_macros(std::string_view text);

/// A function with its body; lambdas and local classes inside count with it.
struct Function {
  std::string header;  ///< what stands before its body, in one line
  int line, lines;     ///< where it starts, and how many lines up to its closing brace
};
std::vector<Function> functions(std::string_view text);

}  // namespace aftershade::tests
