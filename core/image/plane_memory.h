#pragma once
#include <atomic>
#include <cstddef>
#include <memory>

/// Where planes' storage comes from. Memory that the system has just handed out costs 0.15 ms of processor time a
/// megabyte before its first use (a fault a page), and a frame makes dozens of planes of the same few sizes: so what
/// one plane gives back another takes. All of it is safe to call from any thread.
namespace aftershade {

/// `bytes` of memory with any content, at a 64-byte boundary. Throws std::bad_alloc.
float* take_plane_memory(size_t bytes);
/// Gives back what take_plane_memory(bytes) returned.
void return_plane_memory(float* memory, size_t bytes) noexcept;

/// Bytes in planes of at least 128 KiB (smaller ones are never kept), an eighth more at most, for sizes that differ a
/// little to be the same; bytes kept for others; the most there ever were in planes. Kept memory never lifts the sum
/// above five quarters of that peak: before more is asked of the system, some goes back. (Without the quarter, the
/// sizes of a frame's phases push each other out, frame after frame.) Builds with AddressSanitizer keep none, so that
/// it sees every use after the end.
struct PlaneMemory {
  size_t used = 0, kept = 0, peak = 0;
};
PlaneMemory plane_memory();
/// Gives the kept memory back to the system.
void release_plane_memory() noexcept;

/// How much memory the planes have that were made on this account.
struct MemoryAccount {
  std::atomic<size_t> used = 0, peak = 0;  ///< bytes now, and at most so far
  void add(size_t bytes);
};
/// As long as it lives, planes that anybody makes go on `account`; null: on none. The program has one account at a
/// time, so the figures say something when nothing else goes on beside.
class OnAccount {
 public:
  explicit OnAccount(std::shared_ptr<MemoryAccount> account);
  ~OnAccount();
  OnAccount(const OnAccount&) = delete;

 private:
  std::shared_ptr<MemoryAccount> before_;
};
std::shared_ptr<MemoryAccount> current_account();

}  // namespace aftershade
