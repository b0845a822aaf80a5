#include "demo/crowd/heap_count.h"

#include <atomic>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MOBIL_OWN_MALLOC 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define MOBIL_OWN_MALLOC 0
#endif
#endif
#if !defined(MOBIL_OWN_MALLOC)
#if defined(__GLIBC__)
#define MOBIL_OWN_MALLOC 1
#else
#define MOBIL_OWN_MALLOC 0
#endif
#endif

namespace mobil {
namespace {

// The whole program has one malloc, so the counter is global.
std::atomic<bool> counting = false;
std::atomic<std::size_t> requests = 0;

#if MOBIL_OWN_MALLOC
void count() {
  if (counting.load(std::memory_order_relaxed)) requests.fetch_add(1, std::memory_order_relaxed);
}
#endif

}  // namespace

bool heap_is_counted() {
  return MOBIL_OWN_MALLOC != 0;
}

void start_heap_count() {
  requests = 0;
  counting = true;
}

std::size_t stop_heap_count() {
  counting = false;
  return requests;
}

}  // namespace mobil

#if MOBIL_OWN_MALLOC
// The functions that glibc requires in a program that replaces malloc. Each forwards to glibc's own.
extern "C" {
void* __libc_malloc(std::size_t bytes);                           // NOLINT: glibc's names
void* __libc_calloc(std::size_t count, std::size_t bytes);        // NOLINT
void* __libc_realloc(void* memory, std::size_t bytes);            // NOLINT
void* __libc_memalign(std::size_t alignment, std::size_t bytes);  // NOLINT
void __libc_free(void* memory);                                   // NOLINT

void* malloc(std::size_t bytes) {
  mobil::count();
  return __libc_malloc(bytes);
}
void* calloc(std::size_t number, std::size_t bytes) {
  mobil::count();
  return __libc_calloc(number, bytes);
}
void* realloc(void* memory, std::size_t bytes) {
  mobil::count();
  return __libc_realloc(memory, bytes);
}
void free(void* memory) {
  __libc_free(memory);
}
void* memalign(std::size_t alignment, std::size_t bytes) {
  mobil::count();
  return __libc_memalign(alignment, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  mobil::count();
  return __libc_memalign(alignment, bytes);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
  if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) return EINVAL;
  mobil::count();
  void* const got = __libc_memalign(alignment, bytes);
  if (got == nullptr) return ENOMEM;
  *memory = got;
  return 0;
}
}
#endif
