#include "tests/engine/counting_heap.h"

#include <malloc.h>

#include <cstdint>
#include <cstdlib>
#include <new>

namespace mobil {
std::atomic<std::size_t> heap_requests = 0;
std::atomic<std::size_t> heap_refuse_at = SIZE_MAX;
std::atomic<std::size_t> heap_lent = 0;

static void* counted(std::size_t bytes, std::size_t alignment) {
  if (heap_requests++ >= heap_refuse_at) throw std::bad_alloc();
  void* memory = nullptr;
  if (posix_memalign(&memory, alignment < sizeof(void*) ? sizeof(void*) : alignment, bytes) != 0)
    throw std::bad_alloc();
  heap_lent += malloc_usable_size(memory);
  return memory;
}

static void give_back(void* memory) {
  heap_lent -= malloc_usable_size(memory);
  std::free(memory);
}
}  // namespace mobil

// Every other form of new and delete ends in these. (When they are inlined, gcc reports a mismatched pair.)
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  return mobil::counted(bytes, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return mobil::counted(bytes, static_cast<std::size_t>(alignment));
}
// AddressSanitizer replaces this form separately.
[[gnu::noinline]] void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  try {
    return mobil::counted(bytes, alignof(std::max_align_t));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  mobil::give_back(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  mobil::give_back(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  mobil::give_back(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  mobil::give_back(memory);
}
