#pragma once
// How often the whole program asks for heap memory: malloc and its kin, in which operator new and libraries' own
// requests end.

#include <cstddef>

namespace mobil {

/// Whether this build counts: with glibc, without a sanitizer (which has a malloc of its own).
bool heap_is_counted();

/// Begins anew, from 0, on all threads.
void start_heap_count();
/// Requests since then; no more are counted.
std::size_t stop_heap_count();

}  // namespace mobil
