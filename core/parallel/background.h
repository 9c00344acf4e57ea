#pragma once
#include <functional>
#include <memory>

namespace aftershade {

/// Work that goes on beside the caller's, on the threads that for_rows uses. It may call for_rows itself. Whoever waits
/// in for_rows or wait() may run other work that has been started meanwhile, whatever it is, on its own stack: nobody
/// must hold a lock, or keep something in a thread_local, over either.
class Background {
 public:
  explicit Background(std::function<void()> work);
  /// Waits; what the work threw and nobody asked for is lost.
  ~Background();
  Background(Background&&) noexcept;
  Background& operator=(Background&&) = delete;

  /// Returns when the work is done; with one thread that is where it is done. Rethrows what it threw. Once only.
  void wait();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Runs `work` here. Where it waits in for_rows, it runs rows of its own only: it does not wait for the disk, say,
/// because work in the background does.
void undisturbed(const std::function<void()>& work);

}  // namespace aftershade
