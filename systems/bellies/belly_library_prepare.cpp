// Builds the shared data of bodies of usual build ahead of time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <mobil/engine/interrupt.h>
#include "systems/bellies/belly_library.h"

namespace mobil::inline v0_3 {
namespace {

/// Result of a job for a muscle: the built part or an error.
template <class T>
struct Wanted {
  Muscle muscle;
  std::unique_ptr<T> made{};
  std::string error{};

  void take(Result<T> result) {
    if (result) {
      made = std::make_unique<T>(std::move(*result));
    } else {
      error = result.error().message;
    }
  }
};

template <class T>
Result<void> all_made(const std::vector<Wanted<T>>& wanted) {
  for (const auto& one : wanted) {
    if (one.made == nullptr) return fail(fmt::format("{}: {}", muscle_name(one.muscle), one.error));
  }
  return {};
}

}  // namespace

Result<void> BellyLibrary::prepare(const LegMuscles& choice, double tick_s, const Jobs& jobs) {
  if (auto ok = check_choice(choice, tick_s); !ok) return ok;
  std::vector<Wanted<std::unique_ptr<BellyTemplate>>> shapes;
  std::vector<Wanted<Basis>> bases;
  std::vector<BasisKey> keys;
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    if (!choice.muscles[m]) continue;
    const auto muscle = static_cast<Muscle>(m);
    if (find_shape(muscle, choice).first == nullptr) shapes.push_back({.muscle = muscle});
    if (choice.method != Method::modal) continue;
    for (const BasisKey& key : usual_bases(choice, muscle)) {
      if (Basis* const found = find_basis(muscle, choice, key)) {
        cut(*found, choice.modal.modes);
        found->given = true;
        continue;
      }
      bases.push_back({.muscle = muscle});
      keys.push_back(key);
    }
  }
  const auto keep = [&] {
    for (auto& one : shapes)
      if (one.made != nullptr) templates_.push_back(std::move(*one.made));
    for (auto& one : bases) {
      if (one.made == nullptr) continue;
      one.made->given = true;
      bases_.push_back(std::move(*one.made));
    }
  };
  // Most expensive jobs first.
  const auto make = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i < bases.size()) {
        bases[i].take(make_basis(bases[i].muscle, choice, keys[i]));
      } else {
        auto& one = shapes[i - bases.size()];
        one.take(make_shape(one.muscle, choice, find_shape(one.muscle, choice).second));
      }
    }
  };
  try {
    in_parallel(jobs, bases.size() + shapes.size(), make);
  } catch (const Interrupted&) {
    keep();
    throw;
  }
  if (auto ok = all_made(shapes); !ok) return ok;
  if (auto ok = all_made(bases); !ok) return ok;
  keep();
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    if (choice.muscles[m]) prepare_solvers(static_cast<Muscle>(m), choice, tick_s);
  }
  return {};
}

/// Ignores failures: a body whose critical step is below a fixed step gets its own error later.
void BellyLibrary::prepare_solvers(Muscle muscle, const LegMuscles& choice, double tick_s) {
  const bool solves =
      choice.method == Method::statics || choice.method == Method::implicit_central || choice.method == Method::newmark;
  const bool rests =
      choice.inertia && (solves || choice.method == Method::explicit_central || choice.method == Method::finite);
  if (!solves && !rests) return;
  constexpr double step = 1.05;  // no range of sizes is narrower
  MusclePlan plan;
  plan.muscle = muscle;
  for (double ratio = usual_sizes::min_ratio; ratio < usual_sizes::max_ratio * step; ratio *= step) {
    for (double product = usual_sizes::min_product; product < usual_sizes::max_product * step; product *= step) {
      plan.scale = {static_cast<float>(std::sqrt(product * ratio)), static_cast<float>(std::sqrt(product / ratio))};
      (void)belly(plan, choice, tick_s);
    }
  }
}

}  // namespace mobil::inline v0_3
