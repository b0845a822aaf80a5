// Bases of modal bellies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "assets/surfaces/muscle_lattice.h"
#include "systems/bellies/belly_library.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double ratio_step = 1.1;    // between the middles of ranges of slenderness, each of which twelve modes cover
constexpr double product_step = 1.5;  // between the middles of ranges of size, which matter only for the foundation

}  // namespace

LegMuscles basis_choice(const LegMuscles& choice, Muscle muscle) {
  LegMuscles alike;
  alike.drive = choice.drive;
  alike.modal.corrected = choice.modal.corrected;
  alike.modal.cells = choice.modal.cells;
  alike.material = choice.material;
  alike.element = choice.element;
  alike.damping_per_s = choice.damping_per_s;
  alike.inertia = choice.inertia;
  alike.foundation_hz = foundation_of(choice, muscle);
  alike.cells = choice.cells;
  return alike;
}

Result<void> check_modal(const LegMuscles& choice) {
  const std::uint32_t modes = choice.modal.modes;
  if (modes < 1 || modes > max_modes) {
    return fail(fmt::format("{} modes of a modal belly are out of range; choose 1 to {}", modes, max_modes));
  }
  if (choice.stiffness_damping_s != 0) {
    return fail(
        fmt::format("a modal belly has no stiffness damping, and {} s was asked; leave it at 0 or take another"
                    " method",
                    choice.stiffness_damping_s));
  }
  return {};
}

BellyLibrary::BasisKey BellyLibrary::basis_key(const LegMuscles& choice, Muscle muscle, double ratio, double product) {
  return {middle_of_range(ratio, std::sqrt(ratio_step)),
          foundation_of(choice, muscle) > 0 ? middle_of_range(product, std::sqrt(product_step)) : 1};
}

std::vector<BellyLibrary::BasisKey> BellyLibrary::usual_bases(const LegMuscles& choice, Muscle muscle) {
  std::vector<BasisKey> keys;
  const bool fine = choice.modal.cells[2] > ModalOptions{}.cells[2];  // such a basis takes half a second or more
  const double beyond = fine ? 1 : usual_sizes::rare_ratio, max_ratio = usual_sizes::max_ratio * beyond;
  for (double ratio = usual_sizes::min_ratio / beyond;; ratio *= ratio_step) {
    const double at_ratio = std::min(ratio, max_ratio);
    for (double product = usual_sizes::min_product;; product *= product_step) {
      const double at_product = std::min(product, usual_sizes::max_product);
      const BasisKey key = basis_key(choice, muscle, at_ratio, at_product);
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
      if (at_product < product) break;
    }
    if (at_ratio < ratio) break;
  }
  return keys;
}

BellyLibrary::Basis* BellyLibrary::find_basis(Muscle muscle, const LegMuscles& choice, const BasisKey& key) {
  const auto at = std::find_if(bases_.begin(), bases_.end(), [&](const Basis& made) {
    return made.muscle == muscle && key == BasisKey{made.middle_ratio, made.middle_product} &&
           made.whole->modes >= choice.modal.modes && basis_choice(made.choice, muscle) == basis_choice(choice, muscle);
  });
  return at == bases_.end() ? nullptr : &*at;
}

ModalBasisOptions BellyLibrary::basis_options(const LegMuscles& choice, Muscle muscle, const BasisKey& key) {
  ModalBasisOptions options;
  options.far_end = far_end_of(choice);
  options.frame_loads = choice.inertia;
  options.corrected = choice.modal.corrected;
  options.foundation_hz = foundation_of(choice, muscle);
  options.damping_per_s = choice.damping_per_s;
  options.middle_ratio = key.ratio;
  options.ratio_width = std::sqrt(ratio_step);
  options.middle_product = key.product;
  options.control_cells = choice.cells;
  return options;
}

Result<BellyLibrary::Basis> BellyLibrary::make_basis(Muscle muscle, const LegMuscles& choice, const BasisKey& key) {
  if (auto ok = check_modal(choice); !ok) return tl::unexpected(ok.error());
  const auto mesh = bend_block(choice.modal.cells, muscle_lattice(muscle), reference_belly_m(muscle), belly_grading);
  if (!mesh) return tl::unexpected(mesh.error());
  ModalBasisOptions options = basis_options(choice, muscle, key);
  const auto make = [&](std::uint32_t count) {
    options.modes = count;
    return make_modal_basis(*mesh, choice.material, choice.element, options);
  };
  auto whole = make(max_modes);
  if (!whole) whole = make(choice.modal.modes);  // a small mesh cannot have that many
  if (!whole) return tl::unexpected(whole.error());
  Basis made{muscle, choice, key.ratio, key.product, std::make_shared<const ModalBasis>(std::move(*whole)), {}};
  cut(made, choice.modal.modes);
  return made;
}

std::shared_ptr<const ModalBasis> BellyLibrary::cut(Basis& made, std::uint32_t modes) {
  if (modes == made.whole->modes) return made.whole;
  for (const auto& cut : made.cut) {
    if (cut->modes == modes) return cut;
  }
  made.cut.push_back(std::make_shared<const ModalBasis>(truncated(*made.whole, modes)));
  return made.cut.back();
}

Result<std::shared_ptr<const ModalBasis>> BellyLibrary::basis(Muscle muscle, const LegMuscles& choice,
                                                              const BellyScale<float>& scale) {
  if (auto ok = check_modal(choice); !ok) return tl::unexpected(ok.error());
  const auto across = static_cast<double>(scale.across), along = static_cast<double>(scale.along);
  const BasisKey key = basis_key(choice, muscle, across / along, across * along);
  if (Basis* const found = find_basis(muscle, choice, key)) return cut(*found, choice.modal.modes);
  auto made = make_basis(muscle, choice, key);
  if (!made) return tl::unexpected(made.error());
  bases_.push_back(std::move(*made));
  return cut(bases_.back(), choice.modal.modes);
}

}  // namespace mobil::inline v0_3
