#include "engine/jobs.h"

#if defined(__SSE2__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace mobil {
namespace {
#if defined(__SSE2__)
constexpr unsigned long flush_bits = _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON;
unsigned long control() {
  return _mm_getcsr();
}
void set_control(unsigned long word) {
  _mm_setcsr(static_cast<unsigned>(word));
}
#elif defined(__aarch64__)
constexpr unsigned long flush_bits = 1UL << 24;
unsigned long control() {
  unsigned long word;
  asm volatile("mrs %0, fpcr" : "=r"(word));
  return word;
}
void set_control(unsigned long word) {
  asm volatile("msr fpcr, %0" ::"r"(word));
}
#else
constexpr unsigned long flush_bits = 0;
unsigned long control() {
  return 0;
}
void set_control(unsigned long) {}
#endif
}  // namespace

FlushDenormals::FlushDenormals() : before_(control()) {
  set_control(before_ | flush_bits);
}

// Only the two bits go back: exception flags that were raised meanwhile stay raised.
FlushDenormals::~FlushDenormals() {
  set_control((control() & ~flush_bits) | (before_ & flush_bits));
}

}  // namespace mobil
