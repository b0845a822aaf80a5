#pragma once
// Scratch memory of systems: one buffer for each concurrent thread, lent for a range of blocks. Once there are enough
// buffers, taking one needs no lock and no heap.

#include <atomic>
#include <cstddef>
#include <memory_resource>

namespace mobil::inline v0_3 {

/// A pool of buffers of one size. `take` and `give` are thread-safe. All other functions need a single thread and no
/// taken buffers.
class ScratchPool {
 public:
  /// One buffer of the pool's size, in a linked list.
  struct Buffer {
    float* data = nullptr;
    std::atomic<bool> taken = false;
    Buffer* next = nullptr;
  };

  /// `memory` must outlive the pool; one thread at a time calls it.
  explicit ScratchPool(std::pmr::memory_resource* memory);
  ~ScratchPool();
  ScratchPool(const ScratchPool&) = delete;
  ScratchPool& operator=(const ScratchPool&) = delete;

  /// Makes buffers of at least `floats` for `threads` at once; does nothing if they exist.
  void prepare(std::size_t floats, std::size_t threads);
  std::size_t floats() const { return floats_; }
  std::size_t count() const { return count_; }

  /// Returns a free buffer, 64-byte aligned, with the previous user's contents. Allocates only if more threads hold
  /// buffers than ever before. Throws what the memory resource throws.
  Buffer* take();
  static void give(Buffer* buffer) { buffer->taken.store(false, std::memory_order_release); }

 private:
  Buffer* add(bool taken);
  void clear();

  std::pmr::memory_resource* memory_;
  std::atomic<Buffer*> first_ = nullptr;
  std::atomic_flag growing_;  // held during `add`: a lock without a threading library
  std::size_t floats_ = 0;
  std::size_t count_ = 0;
};

/// Holds a buffer of a pool; null without a pool.
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
