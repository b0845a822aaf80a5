#include <mobil/engine/scratch.h>

#include <new>

namespace mobil::inline v0_3 {
namespace {
constexpr std::size_t alignment = 64;
}

ScratchPool::ScratchPool(std::pmr::memory_resource* memory) : memory_(memory) {}

ScratchPool::~ScratchPool() {
  clear();
}

void ScratchPool::clear() {
  for (Buffer* buffer = first_.load(); buffer != nullptr;) {
    Buffer* next = buffer->next;
    if (buffer->data != nullptr) memory_->deallocate(buffer->data, floats_ * sizeof(float), alignment);
    buffer->~Buffer();
    memory_->deallocate(buffer, sizeof(Buffer), alignof(Buffer));
    buffer = next;
  }
  first_ = nullptr;
  count_ = 0;
}

void ScratchPool::prepare(std::size_t floats, std::size_t threads) {
  if (floats > floats_) {
    threads = threads > count_ ? threads : count_;
    clear();
    floats_ = floats;
  }
  while (count_ < threads) add(false);
}

ScratchPool::Buffer* ScratchPool::add(bool taken) {
  void* place = memory_->allocate(sizeof(Buffer), alignof(Buffer));
  auto* buffer = new (place) Buffer;
  try {
    // jemalloc 5.3 loses track of its memory after an aligned request of no bytes.
    if (floats_ > 0) buffer->data = static_cast<float*>(memory_->allocate(floats_ * sizeof(float), alignment));
  } catch (...) {
    memory_->deallocate(place, sizeof(Buffer), alignof(Buffer));
    throw;
  }
  buffer->taken.store(taken, std::memory_order_relaxed);
  buffer->next = first_.load(std::memory_order_relaxed);
  first_.store(buffer, std::memory_order_release);
  ++count_;
  return buffer;
}

ScratchPool::Buffer* ScratchPool::take() {
  for (Buffer* buffer = first_.load(std::memory_order_acquire); buffer != nullptr; buffer = buffer->next) {
    const bool free = !buffer->taken.load(std::memory_order_relaxed);
    if (free && !buffer->taken.exchange(true, std::memory_order_acquire)) return buffer;
  }
  while (growing_.test_and_set(std::memory_order_acquire)) {
  }
  struct Release {
    std::atomic_flag& flag;
    ~Release() { flag.clear(std::memory_order_release); }
  } const release{growing_};
  return add(true);
}

}  // namespace mobil::inline v0_3
