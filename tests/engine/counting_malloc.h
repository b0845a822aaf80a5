#pragma once
// Replaces the whole program's malloc functions by versions that count, so that requests of libraries count as well.
// Include it in one source file of a test program. It counts nothing without glibc, or under a sanitizer, which also
// replaces malloc.

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MOBIL_COUNTS_MALLOC 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define MOBIL_COUNTS_MALLOC 0
#endif
#endif
#if !defined(MOBIL_COUNTS_MALLOC)
#ifdef __GLIBC__
#define MOBIL_COUNTS_MALLOC 1
#else
#define MOBIL_COUNTS_MALLOC 0
#endif
#endif

namespace mobil {
inline std::atomic<std::size_t> malloc_requests = 0;
inline constexpr bool counts_malloc = MOBIL_COUNTS_MALLOC != 0;
}  // namespace mobil

#if MOBIL_COUNTS_MALLOC
extern "C" {
void* __libc_malloc(std::size_t);                 // NOLINT: glibc's own names
void* __libc_calloc(std::size_t, std::size_t);    // NOLINT
void* __libc_realloc(void*, std::size_t);         // NOLINT
void* __libc_memalign(std::size_t, std::size_t);  // NOLINT

void* malloc(std::size_t bytes) noexcept {
  ++mobil::malloc_requests;
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) noexcept {
  ++mobil::malloc_requests;
  return __libc_calloc(count, bytes);
}
void* realloc(void* memory, std::size_t bytes) noexcept {
  ++mobil::malloc_requests;
  return __libc_realloc(memory, bytes);
}
void* memalign(std::size_t alignment, std::size_t bytes) noexcept {
  ++mobil::malloc_requests;
  return __libc_memalign(alignment, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  return memalign(alignment, bytes);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) noexcept {
  *memory = memalign(alignment, bytes);
  return *memory == nullptr ? ENOMEM : 0;
}
}
#endif
