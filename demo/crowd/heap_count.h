#pragma once
// Counts the heap requests of the whole program: calls of malloc and related functions, which include those of operator
// new and of libraries.

#include <cstddef>

namespace mobil {

/// Returns true if this build counts requests: with glibc, and without a sanitizer (which has its own malloc).
bool heap_is_counted();

/// Resets the count to 0 and starts counting on all threads.
void start_heap_count();
/// Stops counting. Returns the number of requests.
std::size_t stop_heap_count();

}  // namespace mobil
