// Bases of reduced bellies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "systems/simulation_muscles.h"

namespace mobil {
namespace {

constexpr double ratio_step = 1.1;    // between the middles of ranges of slenderness: twelve vectors serve such a range
constexpr double product_step = 1.5;  // between those of size, which the foundation alone goes by

Result<void> check(const LegMuscles& choice) {
  const std::uint32_t vectors = choice.reduced.vectors;
  if (vectors < 1 || vectors > most_vectors) {
    return fail(fmt::format("{} vectors of a reduced belly are out of range; choose 1 to {}", vectors, most_vectors));
  }
  if (choice.stiffness_damping_s != 0) {
    return fail(
        fmt::format("a reduced belly has no stiffness damping, and {} s was asked; leave it at 0 or take another"
                    " method",
                    choice.stiffness_damping_s));
  }
  return {};
}

/// Alike but for how many vectors there are.
bool same_basis(const LegMuscles& a, const LegMuscles& b) {
  return same_tissue(a, b) && a.drive == b.drive && a.inertia == b.inertia && a.damping_per_s == b.damping_per_s &&
         foundation_of(a) == foundation_of(b) && a.reduced.cells == b.reduced.cells &&
         a.reduced.corrected == b.reduced.corrected;
}

}  // namespace

Result<std::shared_ptr<const ReducedBasis>> BellyLibrary::basis(Muscle muscle, const LegMuscles& choice,
                                                                const BellyScale<float>& scale) {
  if (auto ok = check(choice); !ok) return tl::unexpected(ok.error());
  const auto across = static_cast<double>(scale.across), along = static_cast<double>(scale.along);
  const double ratio_width = std::sqrt(ratio_step);
  const double ratio = middle_of_range(across / along, ratio_width);
  const double product = foundation_of(choice) > 0 ? middle_of_range(across * along, std::sqrt(product_step)) : 1;
  const std::uint32_t vectors = choice.reduced.vectors;
  auto at = std::find_if(bases_.begin(), bases_.end(), [&](const Basis& made) {
    return made.muscle == muscle && made.middle_ratio == ratio && made.middle_product == product &&
           made.whole->vectors >= vectors && same_basis(made.choice, choice);
  });
  if (at == bases_.end()) {
    const auto mesh = bend_block(choice.reduced.cells, muscle_cage(muscle), reference_belly_m(muscle), belly_grading);
    if (!mesh) return tl::unexpected(mesh.error());
    ReducedOptions options;
    options.far_end = choice.drive == Drive::displacement ? FarEnd::held : FarEnd::sliding;
    options.frame_loads = choice.inertia;
    options.corrected = choice.reduced.corrected;
    options.foundation_hz = foundation_of(choice);
    options.damping_per_s = choice.damping_per_s;
    options.middle_ratio = ratio;
    options.ratio_width = ratio_width;
    options.middle_product = product;
    options.control_cells = choice.cells;
    const auto make = [&](std::uint32_t count) {
      options.vectors = count;
      return make_reduced_basis(*mesh, choice.material, choice.element, options);
    };
    auto whole = make(most_vectors);
    if (!whole) whole = make(vectors);  // a small mesh may not have so many
    if (!whole) return tl::unexpected(whole.error());
    bases_.push_back({muscle, choice, ratio, product, std::make_shared<const ReducedBasis>(std::move(*whole)), {}});
    at = std::prev(bases_.end());
  }
  if (vectors == at->whole->vectors) return at->whole;
  for (const auto& cut : at->cut) {
    if (cut->vectors == vectors) return cut;
  }
  at->cut.push_back(std::make_shared<const ReducedBasis>(truncated(*at->whole, vectors)));
  return at->cut.back();
}

}  // namespace mobil
