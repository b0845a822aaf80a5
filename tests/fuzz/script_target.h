#pragma once
// A walk's script, and its requests to an average body.

#include <mobil/anthropometry.h>
#include "demo/walk/walk_script.h"
#include "tests/fuzz/fuzz_input.h"

namespace mobil::fuzz {

inline void fuzz_script(Input input) {
  static const Body body = *make_body({});
  const auto script = parse_walk_script(text_of(input), "fuzz.csv");
  if (held(script)) (void)held(plan_changes(*script, body, {}));
}

}  // namespace mobil::fuzz
