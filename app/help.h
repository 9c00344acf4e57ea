#pragma once
#include <string>

#include "app/commands.h"

namespace aftershade::app {

/// `aftershade -h`: fits a screen, starts with examples.
std::string short_help();
/// `aftershade --help`: every command with its one-line summary, exit codes.
std::string full_help();
/// `aftershade COMMAND -h`: synopsis, examples and the names of all options.
std::string short_help(const CommandText& command);
/// `aftershade COMMAND --help`: every option with its documentation.
std::string full_help(const CommandText& command);

/// `text` broken into lines of at most `width` columns, each after the first indented by `indent` blanks.
std::string wrap(const std::string& text, size_t width, size_t indent);

/// Exit statuses and what they mean, as help and manual print them.
struct ExitText {
  std::string status, meaning;
};
const std::vector<ExitText>& exit_texts();

}  // namespace aftershade::app
