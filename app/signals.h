#pragma once

namespace aftershade::app {

/// Installs handlers for SIGINT, SIGTERM and SIGHUP (unless nohup ignores it) that remove temporaries and end the
/// process by the signal, at once. SIGPIPE and SIGXFSZ become error returns of write().
void install_signal_handlers();

/// While one lives, the first signal only asks to stop (stop_signal()); a second one ends the process.
class GracefulStop {
 public:
  GracefulStop();
  ~GracefulStop();
  GracefulStop(const GracefulStop&) = delete;
  GracefulStop& operator=(const GracefulStop&) = delete;
};

/// The signal that asked to stop, or 0.
int stop_signal();

/// Ends the process by `signal` as if it had not been handled, so that a shell or a farm sees what happened.
[[noreturn]] void end_by_signal(int signal);

}  // namespace aftershade::app
