#include "core/image/plane_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <mutex>
#include <new>
#include <vector>

namespace aftershade {

namespace {

constexpr size_t kLine = 64, kSmall = 128 << 10, kHugePage = 2 << 20;
#ifdef __SANITIZE_ADDRESS__
constexpr bool kKeeps = false;
#else
constexpr bool kKeeps = true;
#endif

/// Sizes that differ little are the same: an eighth of the power of two below is the step.
size_t rounded(size_t bytes) {
  const size_t step = std::bit_floor(bytes) / 8;
  return (bytes + step - 1) / step * step;
}

std::align_val_t alignment_of(size_t bytes) { return std::align_val_t{bytes < kHugePage ? kLine : kHugePage}; }

/// Large pages where the system has some: a fault for 2 MiB instead of 4 KiB, and fewer misses of address translation.
void* fresh(size_t bytes) {
  void* memory = ::operator new(bytes, alignment_of(bytes));
  if (bytes >= kHugePage) ::madvise(memory, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);
  return memory;
}

struct Block {
  void* memory;
  size_t bytes;
  size_t kept_since = 0;  ///< counted in blocks taken
};
void release(Block block) noexcept { ::operator delete(block.memory, alignment_of(block.bytes)); }

class Pool {
 public:
  void* take(size_t bytes) {
    {
      const std::lock_guard lock(mutex_);
      ++taken_;
      state_.used += bytes;
      state_.peak = std::max(state_.peak, state_.used);
      const auto newest = std::find_if(kept_.rbegin(), kept_.rend(), [&](const Block& b) { return b.bytes == bytes; });
      if (newest != kept_.rend()) {
        void* memory = newest->memory;
        kept_.erase(std::next(newest).base());
        state_.kept -= bytes;
        return memory;
      }
      while (!kept_.empty() && state_.used + state_.kept > state_.peak + state_.peak / 4) drop_one();
    }
    try {
      return fresh(bytes);
    } catch (const std::bad_alloc&) {
      release_kept();
    }
    try {
      return fresh(bytes);
    } catch (const std::bad_alloc&) {
      const std::lock_guard lock(mutex_);
      state_.used -= bytes;
      throw;
    }
  }

  void give(Block block) noexcept {
    const std::lock_guard lock(mutex_);
    state_.used -= block.bytes;
    block.kept_since = taken_;
    try {
      if (kKeeps) kept_.push_back(block);
    } catch (const std::bad_alloc&) {
      release(block);
      return;
    }
    if (kKeeps)
      state_.kept += block.bytes;
    else
      release(block);
  }

  void release_kept() noexcept {
    const std::lock_guard lock(mutex_);
    while (!kept_.empty()) drop(kept_.begin());
  }

  PlaneMemory state() {
    const std::lock_guard lock(mutex_);
    return state_;
  }

 private:
  /// Frames take the same sizes in the same order, so what was kept first is what is wanted next, unless nobody has
  /// wanted it for several frames.
  void drop_one() noexcept {
    constexpr size_t kStale = 2000;
    drop(taken_ - kept_.front().kept_since > kStale ? kept_.begin() : std::prev(kept_.end()));
  }

  void drop(std::vector<Block>::iterator block) noexcept {
    release(*block);
    state_.kept -= block->bytes;
    kept_.erase(block);
  }

  std::mutex mutex_;
  std::vector<Block> kept_;  ///< the one kept longest first
  PlaneMemory state_;
  size_t taken_ = 0;
};

/// Never destroyed: planes may outlive any static object.
Pool& pool() {
  static Pool& instance = *new Pool;
  return instance;
}

std::atomic<std::shared_ptr<MemoryAccount>>& account_slot() {
  static std::atomic<std::shared_ptr<MemoryAccount>> slot;
  return slot;
}

}  // namespace

float* take_plane_memory(size_t bytes) {
  return static_cast<float*>(bytes < kSmall ? fresh(bytes) : pool().take(rounded(bytes)));
}

void return_plane_memory(float* memory, size_t bytes) noexcept {
  if (bytes < kSmall)
    release({memory, bytes});
  else
    pool().give({memory, rounded(bytes)});
}

void MemoryAccount::add(size_t bytes) {
  const size_t now = used += bytes;
  size_t most = peak;
  while (most < now && !peak.compare_exchange_weak(most, now)) {
  }
}

OnAccount::OnAccount(std::shared_ptr<MemoryAccount> account) : before_(account_slot().exchange(std::move(account))) {}
OnAccount::~OnAccount() { account_slot() = before_; }
std::shared_ptr<MemoryAccount> current_account() { return account_slot(); }

PlaneMemory plane_memory() { return pool().state(); }
void release_plane_memory() noexcept { pool().release_kept(); }

}  // namespace aftershade
