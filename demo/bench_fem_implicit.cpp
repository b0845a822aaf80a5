#include "demo/bench_fem.h"
namespace mobil {
Result<void> bench_fem_implicit(BenchRun&) {
  return {};
}
}  // namespace mobil
