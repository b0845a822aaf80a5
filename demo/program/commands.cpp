#include "demo/program/commands.h"

#include <fmt/format.h>

#include <cstdio>

namespace mobil {

int exit_status_of(std::string_view command, const Result<void>& done) {
  if (done) return 0;
  fmt::print(stderr, "mobil {}: {}\n", command, done.error().message);
  return 2;
}

}  // namespace mobil
