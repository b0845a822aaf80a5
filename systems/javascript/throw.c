/* Debian's C++ library for WebAssembly cannot throw. Exceptions (out of memory) end the module with one line. The module
 * also says which of the two it is. */
#include <stdio.h>
#include <stdlib.h>

void* __cxa_allocate_exception(size_t bytes) {
  return malloc(bytes);
}

void __cxa_throw(void* thrown, void* type, void (*destroy)(void*)) {
  (void)thrown, (void)type, (void)destroy;
  fputs("mobil: no memory, or a fault of the library's own; the module has ended\n", stderr);
  abort();
}

/* Returns 1 for mobil.wasm, 0 for mobil-plain.wasm. */
int mobil_fuses(void) {
#if defined(MOBIL_FUSES)
  return 1;
#else
  return 0;
#endif
}
