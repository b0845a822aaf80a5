#pragma once
// What `mobil compare` tells: a table for people, compare.json for scripts.

#include <string>
#include <vector>

#include "demo/lab/compare/compare_verdicts.h"

namespace mobil {

/// A line a walk and quantity, then the bounds that did not hold.
std::string comparison_text(const Comparison& comparison, const std::vector<Verdict>& verdicts);

/// The whole of compare.json: body, walks with every finding and curve, variations, verdicts.
std::string comparison_json(const Comparison& comparison, const std::vector<Verdict>& verdicts);

}  // namespace mobil
