#pragma once
#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/text.h"

/// One record per command-line option: the parser, both help texts, the manual and the README table are loops over
/// them.
namespace aftershade::app {

/// An option of a command whose typed values go into struct Args. "-o,--output" and "OUTPUT" describe it to people; a
/// name without dashes is positional.
template <class Args>
struct Option {
  using Member = std::variant<bool Args::*, int Args::*, std::string Args::*, std::optional<double> Args::*,
                              std::vector<std::string> Args::*>;
  std::string names, value;
  Member member;
  std::string doc;
  std::vector<std::string> choices = {};
  bool required = false;
  struct Range {
    int min, max;  ///< both allowed
  };
  std::optional<Range> range = {};
};

/// What documentation needs to know of an option, whatever its command.
struct OptionText {
  std::string names, value, doc;
};

/// The documentation with the choices or the range behind it.
template <class Args>
OptionText text_of(const Option<Args>& option) {
  std::string doc = option.doc;
  if (!option.choices.empty()) doc += " (" + join(option.choices, ", ") + ")";
  if (option.range) doc += cat(" (", option.range->min, " to ", option.range->max, ")");
  return {option.names, option.value, doc};
}

template <class Args>
std::vector<OptionText> texts_of(const std::vector<Option<Args>>& table) {
  std::vector<OptionText> texts;
  for (const Option<Args>& option : table) texts.push_back(text_of(option));
  return texts;
}

/// Makes `command` parse the table's options into `args`; unset members keep their defaults.
template <class Args>
void bind(CLI::App& command, const std::vector<Option<Args>>& table, Args& args) {
  for (const Option<Args>& option : table) {
    const auto add = [&](auto member) -> CLI::Option* {
      auto& target = args.*member;
      using Target = std::decay_t<decltype(target)>;
      if constexpr (std::is_same_v<Target, bool>) {
        return command.add_flag(option.names, target);
      } else {
        CLI::Option* added = command.add_option(option.names, target);
        if constexpr (std::is_same_v<Target, std::vector<std::string>>) {
          // What follows an option's value is not the option's.
          added->expected(1)->take_all()->allow_extra_args(!option.names.starts_with('-'));
        }
        return added;
      }
    };
    CLI::Option* added = std::visit(add, option.member);
    if (!option.choices.empty()) added->check(CLI::IsMember(option.choices));
    if (option.range) added->check(CLI::Range(option.range->min, option.range->max));
    if (option.required) added->required();
  }
}

}  // namespace aftershade::app
