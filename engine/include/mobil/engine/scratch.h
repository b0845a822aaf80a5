#pragma once
// Memory that a system works in and leaves nothing in: one buffer for each thread that works at once, lent for a range
// of blocks. Taking one from the pool needs no lock and no heap once there are enough.

#include <atomic>
#include <cstddef>
#include <memory_resource>

namespace mobil::inline v0_3 {

/// A pool of buffers of one size. `take` and `give` may be called from any threads at once, everything else by one
/// while nobody holds a buffer.
class ScratchPool {
 public:
  /// One buffer of the pool's size, in a list of all.
  struct Buffer {
    float* data = nullptr;
    std::atomic<bool> taken = false;
    Buffer* next = nullptr;
  };

  /// `memory` is asked by one thread at a time and must outlive the pool.
  explicit ScratchPool(std::pmr::memory_resource* memory);
  ~ScratchPool();
  ScratchPool(const ScratchPool&) = delete;
  ScratchPool& operator=(const ScratchPool&) = delete;

  /// Buffers of at least `floats`, enough for `threads` at once; a no-op where there are.
  void prepare(std::size_t floats, std::size_t threads);
  std::size_t floats() const { return floats_; }
  std::size_t count() const { return count_; }

  /// One that nobody holds, 64-byte aligned, with whatever the last holder left in it. Takes memory only where more
  /// threads hold one than ever before. Throws what the memory resource throws.
  Buffer* take();
  static void give(Buffer* buffer) { buffer->taken.store(false, std::memory_order_release); }

 private:
  Buffer* add(bool taken);
  void clear();

  std::pmr::memory_resource* memory_;
  std::atomic<Buffer*> first_ = nullptr;
  std::atomic_flag growing_;  // held meanwhile: a lock that needs no threads' library
  std::size_t floats_ = 0;
  std::size_t count_ = 0;
};

/// Holds a buffer of a pool; of none, nothing.
class ScratchLease {
 public:
  explicit ScratchLease(ScratchPool* pool) : buffer_(pool == nullptr ? nullptr : pool->take()) {}
  ~ScratchLease() {
    if (buffer_ != nullptr) ScratchPool::give(buffer_);
  }
  ScratchLease(const ScratchLease&) = delete;
  ScratchLease& operator=(const ScratchLease&) = delete;

  float* data() const { return buffer_ == nullptr ? nullptr : buffer_->data; }

 private:
  ScratchPool::Buffer* buffer_;
};

}  // namespace mobil::inline v0_3
