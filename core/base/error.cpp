#include "core/base/error.h"

#include <utility>

namespace aftershade {

int exit_status(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage: return 64;
    case ErrorCode::data: return 65;
    case ErrorCode::no_input: return 66;
    case ErrorCode::internal: return 70;
    case ErrorCode::memory: return 33;
    case ErrorCode::cannot_create: return 73;
    case ErrorCode::io: return 74;
    case ErrorCode::config: return 78;
  }
  return 70;
}

Error::Error(ErrorCode code, std::string message, std::string hint)
    : code_(code), message_(std::move(message)), hint_(std::move(hint)) {
  compose();
}

void Error::add_context(std::string_view context) {
  message_ = std::string(context) + ": " + message_;
  compose();
}

void Error::compose() { text_ = hint_.empty() ? message_ : message_ + " (" + hint_ + ")"; }

}  // namespace aftershade
