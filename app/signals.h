#pragma once

namespace aftershade::app {

/// Installs handlers for SIGINT, SIGTERM and SIGHUP: the first asks the run to stop after the frame at work, a second
/// one removes temporaries and ends the process by the signal. SIGPIPE and SIGXFSZ become error returns of write().
void install_signal_handlers();

/// The signal that asked to stop, or 0.
int stop_signal();

/// Ends the process by `signal` as if it had not been handled, so that a shell or a farm sees what happened.
[[noreturn]] void end_by_signal(int signal);

}  // namespace aftershade::app
