#pragma once
// What a file of tests says of itself, once, outside all namespaces: MOBIL_TEST_LABELS("threads;slow");
//   threads  also under ThreadSanitizer
//   slow     takes more than five seconds: CTest begins with these
// Labels of a whole folder (its name; programs, lab) are given in tests/CMakeLists.txt.
//
// A TEST that begins with MOBIL_SLOW() is left out under sanitizers and valgrind, which take ten times as long (MOBIL_QUICK=1).

#include <cstdlib>

namespace mobil::tests {

/// Tells tests/main.cpp of them; returns a number that nobody needs.
int label(const char* file, const char* labels);

}  // namespace mobil::tests

#define MOBIL_JOIN_(a, b) a##b
#define MOBIL_JOIN(a, b) MOBIL_JOIN_(a, b)
#define MOBIL_TEST_LABELS(labels) \
  [[maybe_unused]] static const int MOBIL_JOIN(mobil_labels_, __COUNTER__) = ::mobil::tests::label(__FILE__, labels)

#define MOBIL_SLOW() \
  if (std::getenv("MOBIL_QUICK") != nullptr) GTEST_SKIP() << "slow, and MOBIL_QUICK is set"
