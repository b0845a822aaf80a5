#pragma once
// Labels of a test file, set once outside all namespaces: MOBIL_TEST_LABELS("threads;slow");
//   threads  also run under ThreadSanitizer
//   long     takes more than five seconds; CTest starts these first. Under ThreadSanitizer only TESTs with Thread or
//            AtOnce in their names run.
//   slow     long, and skipped under AddressSanitizer
//
// Labels of a whole folder (its name; programs, lab) are given in tests/CMakeLists.txt.
//
// A TEST that begins with MOBIL_SLOW() is skipped under sanitizers and valgrind, which are ten times slower
// (MOBIL_QUICK=1).

#include <cstdlib>

namespace mobil::tests {

/// Registers a file's labels with tests/main.cpp. The return value is unused.
int label(const char* file, const char* labels);

}  // namespace mobil::tests

#define MOBIL_JOIN_(a, b) a##b
#define MOBIL_JOIN(a, b) MOBIL_JOIN_(a, b)
#define MOBIL_TEST_LABELS(labels) \
  [[maybe_unused]] static const int MOBIL_JOIN(mobil_labels_, __COUNTER__) = ::mobil::tests::label(__FILE__, labels)

#define MOBIL_SLOW() \
  if (std::getenv("MOBIL_QUICK") != nullptr) GTEST_SKIP() << "slow, and MOBIL_QUICK is set"
