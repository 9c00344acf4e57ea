#pragma once
#include <exception>
#include <string>
#include <string_view>

namespace aftershade {

/// What kind of thing went wrong; each has one exit status (sysexits.h, see exit_status()).
enum class ErrorCode { usage, data, no_input, internal, memory, cannot_create, io, config };

/// The process exit status of an error: usage 64, data 65, no_input 66, internal 70, memory 33 (OpenCue's
/// out-of-memory status), cannot_create 73, io 74, config 78.
int exit_status(ErrorCode code);

/// The one exception type. `what()` is the whole text: "context: context: message (hint)".
/// Context is added on the way up with add_context(); it is caught once, in main.
class Error : public std::exception {
 public:
  Error(ErrorCode code, std::string message, std::string hint = {});
  const char* what() const noexcept override { return text_.c_str(); }
  ErrorCode code() const { return code_; }
  const std::string& message() const { return message_; }  ///< with context, without hint
  const std::string& hint() const { return hint_; }        ///< what to do about it; may be empty
  /// Puts "while reading frame 1042 (beauty.1042.exr)" before the message.
  void add_context(std::string_view context);

 private:
  void compose();
  ErrorCode code_;
  std::string message_, hint_, text_;
};

/// Runs `work`; an Error that leaves it carries `context` in front. Other exceptions pass unchanged.
template <class Work>
auto with_context(std::string_view context, Work&& work) {
  try {
    return work();
  } catch (Error& error) {
    error.add_context(context);
    throw;
  }
}

}  // namespace aftershade
