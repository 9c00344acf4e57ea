#include "app/log.h"

#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <cstdlib>

#include "core/base/text.h"

namespace aftershade::app {

void Log::print(std::string_view prefix, std::string_view text) {
  end_status();
  std::fprintf(stderr, "%.*s%.*s\n", static_cast<int>(prefix.size()), prefix.data(), static_cast<int>(text.size()),
               text.data());
}

void Log::error(std::string_view text) { print("aftershade: error: ", text); }

void Log::warning(std::string_view text) {
  if (level_ != Level::errors && is_first_of_its_kind(text)) print("aftershade: warning: ", text);
}

void Log::note(std::string_view text, std::string_view where) {
  if (level_ != Level::errors && (verbose() || noted_.insert(std::string(text)).second))
    print("aftershade: ", cat(where, text));
}

bool Log::is_first_of_its_kind(std::string_view text) {
  if (verbose()) return true;
  std::string key(text);
  std::erase_if(key, [](unsigned char c) { return std::isdigit(c) != 0; });
  const auto [entry, inserted] = warned_.try_emplace(key, Repeated{std::string(text)});
  if (!inserted) ++entry->second.more;
  return inserted;
}

void Log::summarise() {
  for (auto& [key, repeated] : warned_)
    if (repeated.more > 0 && level_ != Level::errors)
      print("aftershade: ", cat(repeated.more, " more warnings like \"", repeated.first, "\"; -v shows all"));
  warned_.clear();
}

void Log::line(std::string_view text) { print("aftershade: ", text); }

void Log::detail(std::string_view text) {
  if (verbose()) print("aftershade: ", text);
}

void Log::status_line(std::string_view text) {
  std::fprintf(stderr, "\r%.*s\033[K", static_cast<int>(text.size()), text.data());
  std::fflush(stderr);
  status_shown_ = true;
}

void Log::end_status() {
  if (status_shown_) std::fputc('\n', stderr);
  status_shown_ = false;
}

Log& log() {
  static Log instance;
  return instance;
}

ProgressPrinter::Kind progress_kind(std::string_view name, bool quiet) {
  if (quiet || name == "none") return ProgressPrinter::Kind::none;
  if (name == "bar") return ProgressPrinter::Kind::bar;
  if (name == "plain") return ProgressPrinter::Kind::plain;
  const char* term = std::getenv("TERM");
  const bool terminal = isatty(STDERR_FILENO) != 0 && term && std::string_view(term) != "dumb";
  return terminal ? ProgressPrinter::Kind::bar : ProgressPrinter::Kind::plain;
}

void ProgressPrinter::update(int frame, size_t done, size_t total, double milliseconds) {
  total_ms_ += milliseconds;
  const double seconds_left =
      done ? total_ms_ / 1000 / static_cast<double>(done) * static_cast<double>(total - done) : 0;
  if (kind_ == Kind::plain) {
    log().line(cat("frame ", frame, " done, ", done, " of ", total, ", ", fixed(milliseconds, 0), " ms"));
  } else if (kind_ == Kind::bar) {
    constexpr size_t width = 30;
    const size_t filled = total ? width * done / total : width;
    log().status_line(cat("[", std::string(filled, '#'), std::string(width - filled, '-'), "] ", done, "/", total,
                          "  frame ", frame, "  ", fixed(milliseconds, 0), " ms  ", fixed(seconds_left, 0), " s left"));
  }
}

void ProgressPrinter::finish() { log().end_status(); }

}  // namespace aftershade::app
