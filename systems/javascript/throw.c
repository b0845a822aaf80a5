/* Debian's C++ library for WebAssembly cannot throw. Exceptions (out of memory) end the module with one line. */
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
