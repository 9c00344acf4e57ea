#include "app/signals.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "core/io/publish.h"

namespace aftershade::app {

namespace {

volatile std::sig_atomic_t g_stop_signal = 0;

void restore_and_raise(int signal) {
  std::signal(signal, SIG_DFL);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  sigprocmask(SIG_UNBLOCK, &set, nullptr);
  ::raise(signal);
}

void on_signal(int signal) {
  if (g_stop_signal != 0) {
    io::remove_temporaries();
    restore_and_raise(signal);
  }
  g_stop_signal = signal;
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

int stop_signal() { return g_stop_signal; }

void end_by_signal(int signal) {
  io::remove_temporaries();
  restore_and_raise(signal);
  std::_Exit(128 + signal);
}

}  // namespace aftershade::app
