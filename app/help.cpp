#include "app/help.h"

#include <algorithm>

#include "core/base/text.h"

namespace aftershade::app {

namespace {
constexpr size_t kWidth = 100, kColumn = 30;

std::string option_line(const OptionText& option) {
  const bool positional = !option.names.starts_with('-');
  std::string head = "  " + (positional ? option.value : join(split(option.names, ','), ", "));
  if (!positional && !option.value.empty()) head += " " + option.value;
  const std::string body = wrap(option.doc, kWidth - kColumn, kColumn);
  if (head.size() + 2 <= kColumn) return head + std::string(kColumn - head.size(), ' ') + body + "\n";
  return head + "\n" + std::string(kColumn, ' ') + body + "\n";
}

std::string examples_of(const CommandText& command) {
  std::string text;
  for (const std::string& example : command.examples) text += "  " + example + "\n";
  return text;
}
}  // namespace

std::string wrap(const std::string& text, size_t width, size_t indent) {
  std::string out;
  size_t column = 0;
  for (const std::string& word : split(text, ' ')) {
    if (column > 0 && column + 1 + word.size() > width) {
      out += "\n" + std::string(indent, ' ');
      column = 0;
    } else if (column > 0) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out;
}

const std::vector<ExitText>& exit_texts() {
  static const std::vector<ExitText> texts = {
      {"0", "all frames written or validly skipped"},
      {"1", "score: a requirement is not met"},
      {"33", "out of memory"},
      {"64", "wrong use of the command line"},
      {"65", "damaged or inconsistent input"},
      {"66", "missing input: file, frame, channel, camera"},
      {"70", "internal error"},
      {"73", "the output cannot be created"},
      {"74", "reading or writing failed"},
      {"78", "wrong preset, profile or camera file"},
  };
  return texts;
}

std::string short_help() {
  std::string text =
      "aftershade: ambient occlusion, temporal filtering and motion blur for EXR sequences\n\n"
      "Examples:\n";
  for (const CommandText& command : command_texts()) text += "  " + command.examples.front() + "\n";
  text += "\nCommands:\n";
  for (const CommandText& command : command_texts())
    text += "  " + command.name + std::string(10 - command.name.size(), ' ') + command.summary + "\n";
  text +=
      "\n  aftershade COMMAND -h       options of a command\n"
      "  aftershade COMMAND --help   the same with their documentation\n"
      "  aftershade --help           this and the exit statuses; aftershade --version\n";
  return text;
}

std::string full_help() {
  std::string text = short_help() + "\nExit status:\n";
  for (const ExitText& exit : exit_texts())
    text += "  " + exit.status + std::string(4 - exit.status.size(), ' ') + exit.meaning + "\n";
  text += "  A run that a signal stopped ends by that signal.\n";
  return text;
}

std::string short_help(const CommandText& command) {
  constexpr char kHardBlank = '\x1f';  // keeps an option and its value on one line
  std::vector<std::string> names;
  for (const OptionText& option : command.options)
    if (option.names.starts_with('-'))
      names.push_back(split(option.names, ',').back() + (option.value.empty() ? "" : kHardBlank + option.value));
  std::string options = wrap(join(names, " "), kWidth, 2);
  std::replace(options.begin(), options.end(), kHardBlank, ' ');
  return cat("aftershade ", command.name, ": ", command.summary, "\n\nExamples:\n", examples_of(command),
             "\nUsage: aftershade ", command.name, " ", command.synopsis, "\n\nOptions:\n  ", options,
             "\n\n  aftershade ", command.name, " --help says what each does\n");
}

std::string full_help(const CommandText& command) {
  std::string text = "aftershade " + command.name + ": " + command.summary + "\n\nUsage: aftershade " + command.name +
                     " " + command.synopsis + "\n\nExamples:\n" + examples_of(command) + "\nOptions:\n";
  for (const OptionText& option : command.options) text += option_line(option);
  return text;
}

}  // namespace aftershade::app
