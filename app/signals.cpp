#include "app/signals.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "core/io/publish.h"

namespace aftershade::app {

namespace {

volatile std::sig_atomic_t g_graceful = 0;
volatile std::sig_atomic_t g_stop_signal = 0;

void restore_and_raise(int signal) {
  std::signal(signal, SIG_DFL);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  ::raise(signal);
}

void on_signal(int signal) {
  if (g_graceful == 0 || g_stop_signal != 0) {
    io::remove_temporaries();
    restore_and_raise(signal);
  }
  g_stop_signal = signal;
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (signal != SIGHUP || !is_ignored(signal)) sigaction(signal, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

GracefulStop::GracefulStop() { g_graceful = 1; }
GracefulStop::~GracefulStop() { g_graceful = 0; }

int stop_signal() { return g_stop_signal; }

void end_by_signal(int signal) {
  io::remove_temporaries();
  restore_and_raise(signal);
  std::_Exit(128 + signal);
}

}  // namespace aftershade::app
