#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace aftershade::app {

/// Messages to stderr; data goes to stdout. A note that repeats is printed once. Of warnings that differ in their
/// numbers only, the first is printed, and summarise() says how many followed. Verbose prints them all.
class Log {
 public:
  enum class Level { errors, normal, verbose };
  void set_level(Level level) { level_ = level; }
  bool verbose() const { return level_ == Level::verbose; }

  void error(std::string_view text);
  void warning(std::string_view text);
  void note(std::string_view text, std::string_view where = "");  ///< the same text elsewhere is a repetition
  void line(std::string_view text);                               ///< always, however often
  void detail(std::string_view text);                             ///< only with -v

  /// Says how many warnings were held back since the last call.
  void summarise();

  /// A line that the next call overwrites; only for terminals.
  void status_line(std::string_view text);
  void end_status();

 private:
  void print(std::string_view prefix, std::string_view text);
  bool is_first_of_its_kind(std::string_view text);
  Level level_ = Level::normal;
  struct Repeated {
    std::string first;
    int more = 0;
  };
  std::map<std::string, Repeated> warned_;  ///< by the text without its digits
  std::set<std::string> noted_;
  bool status_shown_ = false;
};

/// The one log of the process.
Log& log();

/// How a run tells how far it is (--progress): a bar on a terminal, one line a frame elsewhere.
class ProgressPrinter {
 public:
  enum class Kind { none, plain, bar };
  explicit ProgressPrinter(Kind kind) : kind_(kind) {}
  void update(int frame, size_t done, size_t total, double milliseconds);
  void finish();

 private:
  Kind kind_;
  double total_ms_ = 0;
};
/// "auto", "bar", "plain" or "none"; auto is a bar when stderr is a terminal, else plain.
ProgressPrinter::Kind progress_kind(std::string_view name, bool quiet);

}  // namespace aftershade::app
