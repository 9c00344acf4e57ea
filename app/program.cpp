#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <new>

#include "app/commands.h"
#include "app/help.h"
#include "app/log.h"
#include "app/signals.h"
#include "core/base/error.h"
#include "core/io/threads.h"
#include "core/parallel/rows.h"

namespace aftershade::app {

namespace {

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

/// Answers -h, --help and --version wherever they stand; true when it did.
bool answer_help(const std::vector<std::string>& words) {
  const CommandText* command = nullptr;
  for (const CommandText& text : command_texts())
    if (!words.empty() && words.front() == text.name) command = &text;
  for (const std::string& word : words) {
    if (word == "-h") return print(command ? short_help(*command) : short_help()), true;
    if (word == "--help") return print(command ? full_help(*command) : full_help()), true;
    if (word == "--version") return print("aftershade " AFTERSHADE_VERSION "\n"), true;
  }
  return false;
}

/// The nearest option or command to what the parser did not understand.
std::string hint_for(const std::vector<std::string>& words, const CLI::App& app) {
  std::vector<std::string> names;
  if (app.get_subcommands().empty()) {
    for (const CommandText& text : command_texts()) names.push_back(text.name);
    return words.empty() ? "" : did_you_mean(words.front(), names);
  }
  const CLI::App* command = app.get_subcommands().front();
  for (const CLI::Option* option : command->get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const std::string& word : words)
    if (word.starts_with("--")) {
      const std::string name = word.substr(0, word.find('='));
      if (name == "--diagnostics") return "it is --aov all now";
      if (std::find(names.begin(), names.end(), name) == names.end()) return did_you_mean(name, names);
    }
  return "";
}

void apply(const CommonArgs& args) {
  if (args.quiet) log().set_level(Log::Level::errors);
  if (args.verbose) log().set_level(Log::Level::verbose);
  set_thread_count(args.threads);
  io::set_decoding_threads(thread_count());
}

/// What printf could not write: a full disk, a closed pipe.
void check_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw Error(ErrorCode::io, "standard output cannot be written to", "check the disk, or the program that reads it");
}

int parse_and_run(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) {
    print(short_help());
    return exit_status(ErrorCode::usage);
  }
  if (answer_help(words)) return 0;
  CLI::App app;
  app.set_help_flag();
  app.require_subcommand(1);
  std::vector<std::pair<CLI::App*, std::function<int()>>> commands;
  const auto add = [&]<class Args>(const char* name, const std::vector<Option<Args>>& table, int (*run)(const Args&)) {
    CLI::App* command = app.add_subcommand(name);
    command->set_help_flag();
    const auto args = std::make_shared<Args>();
    bind(*command, table, *args);
    commands.emplace_back(command, [args, run] {
      if constexpr (std::is_base_of_v<CommonArgs, Args>) apply(*args);
      return run(*args);
    });
  };
  add("render", render_options(), render);
  add("compare", compare_options(), compare);
  add("score", score_options(), score);
  add("tune", tune_options(), tune);
  add("inspect", inspect_options(), inspect);
  add("presets", presets_options(), presets);
  add("sheet", sheet_options(), sheet);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (app.get_subcommands().empty())
      throw Error(ErrorCode::usage, cat("there is no command \"", words.front(), "\""), hint_for(words, app));
    throw Error(ErrorCode::usage, error.what(), hint_for(words, app));
  }
  const auto typed = [](const auto& command) { return command.first->parsed(); };
  return std::find_if(commands.begin(), commands.end(), typed)->second();
}

}  // namespace

int run_program(int argc, char** argv) {
  try {
    install_signal_handlers();
    const int status = parse_and_run(argc, argv);
    check_output();
    return status;
  } catch (const Error& error) {
    log().error(error.what());
    return exit_status(error.code());
  } catch (const std::bad_alloc&) {
    log().error("out of memory (fewer --threads need less)");
    return exit_status(ErrorCode::memory);
  } catch (const std::exception& error) {
    log().error(std::string("internal error: ") + error.what());
    return exit_status(ErrorCode::internal);
  }
}

}  // namespace aftershade::app
