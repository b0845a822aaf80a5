#include "systems/bellies/belly_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <mobil/engine/interrupt.h>
#include "assets/reduction/modal_rows.h"
#include "assets/surfaces/muscle_lattice.h"
#include "systems/deformation/deformation.h"
#include "systems/lines/line_of_action.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double lowest_ratio = 0.4, highest_ratio = 3.2;  // across over along; bodies in range have 0.44 to 3.06
// About 5 mm sideways per g. Muscles on the shank are held more tightly.
constexpr double thigh_hz = 7, shank_hz = 12;

/// Returns the mass for the critical step. The consistent mass is lighter in the relevant modes.
Mass stepped_mass(const LegMuscles& choice) {
  return choice.method == Method::implicit_central ? Mass::consistent : Mass::lumped;
}

Strain strain_of(const LegMuscles& choice) {
  return choice.method == Method::finite ? Strain::finite : Strain::small;
}

bool same_template(const LegMuscles& a, const LegMuscles& b, Muscle muscle) {
  return same_tissue(a, b) && a.drive == b.drive && stepped_mass(a) == stepped_mass(b) &&
         strain_of(a) == strain_of(b) && a.damping_per_s == b.damping_per_s &&
         a.stiffness_damping_s == b.stiffness_damping_s && foundation_of(a, muscle) == foundation_of(b, muscle);
}

Result<std::uint32_t> steps(const MuscleTemplate& shape, const LegMuscles& choice, const BellyScale<float>& scale,
                            double tick_s) {
  if (choice.method == Method::statics) return 1U;
  if (choice.method == Method::newmark) return choice.dt_s ? steps_of(tick_s, *choice.dt_s) : 1U;
  const auto critical =
      critical_step(shape.critical_steps, static_cast<double>(scale.across), static_cast<double>(scale.along));
  if (!critical) return tl::unexpected(critical.error());
  if (!choice.dt_s) {
    if (tick_s > max_steps * *critical) {
      return fail(fmt::format(
          "this belly's critical step is {:.3g} s, and a tick takes at most {} steps; choose softer tissue, a coarser"
          " mesh, or newmark",
          *critical, max_steps));
    }
    return substeps_within(*critical, tick_s);
  }
  if (*choice.dt_s > *critical) {
    return fail(
        fmt::format("a step of {:.6g} s is above this belly's critical step of {:.6g} s; give a shorter one,"
                    " leave it out, or take newmark",
                    *choice.dt_s, *critical));
  }
  return steps_of(tick_s, *choice.dt_s);
}

MuscleOptions options_of(const LegMuscles& choice, Muscle muscle) {
  MuscleOptions options;
  options.far_end = far_end_of(choice);
  options.damping_per_s = choice.damping_per_s;
  options.lowest_ratio = lowest_ratio;
  options.highest_ratio = highest_ratio;
  options.element = choice.element;
  options.mass = stepped_mass(choice);
  options.strain = strain_of(choice);
  options.stiffness_damping_s = choice.stiffness_damping_s;
  options.foundation_hz = foundation_of(choice, muscle);
  return options;
}

}  // namespace

std::uint32_t steps_of(double tick_s, double dt_s) {
  return static_cast<std::uint32_t>(std::max(1.0, std::ceil(tick_s / dt_s * (1 - 1e-12))));
}

Result<void> check_choice(const LegMuscles& choice, double tick_s) {
  if (choice.drive > Drive::force || choice.method > last_method || choice.element > Element::one_point ||
      choice.mass > Mass::consistent || choice.activation > ExcitationSource::moments) {
    return fail(
        "a drive, method, element, mass or activation is none of those named; take one of the enumerations' values");
  }
  if (has_activation(choice) && choice.drive == Drive::force)
    return fail("activation draws the belly's end to a place; take Drive::displacement, or no activation");
  if (has_finite_shape(choice) && choice.drive == Drive::force)
    return fail("finite shapes are those of a belly whose end is held; take Drive::displacement, or no finite_shape");
  if (choice.method == Method::finite && choice.stiffness_damping_s > 0)
    return fail(
        "Method::finite is damped by damping_per_s alone; leave stiffness_damping_s at 0, or take explicit-central or "
        "newmark");
  if (is_tuned(choice) && !has_activation(choice)) {
    return fail(
        "tuned bellies are as stiff as their muscle pulls: choose LegMuscles::activation too, or leave tuned out");
  }
  if (choice.muscles.none() || (choice.muscles >> muscles().size()).any()) {
    return fail(
        fmt::format("the muscles chosen must be some of the table's {} rows; take usual_muscles(),"
                    " muscle_members() or find_muscle(name)",
                    muscles().size()));
  }
  if (auto ok = check_material(choice.material); !ok) return ok;
  if (auto ok = check_cells(choice.cells); !ok) return ok;
  const auto first = static_cast<Muscle>(std::countr_zero(choice.muscles.to_ullong()));
  if (auto ok = check_muscle_options(options_of(choice, first)); !ok) return ok;
  if (!choice.dt_s) return {};
  const double least = tick_s / static_cast<double>(max_steps);
  if (!(*choice.dt_s >= least && std::isfinite(*choice.dt_s))) {
    return fail(fmt::format("a step of {} s must be finite and at least {:.3g} s; give another or leave it out",
                            *choice.dt_s, least));
  }
  return {};
}

double foundation_of(const LegMuscles& choice, Muscle muscle) {
  if (choice.foundation_hz) return *choice.foundation_hz;
  // The belly's response to a force is tabulated without a foundation.
  if ((!is_muscle_group(muscle) || has_activation(choice)) && (choice.drive == Drive::displacement || choice.inertia))
    return on_shank(muscle) ? shank_hz : thigh_hz;
  return choice.inertia ? thigh_hz : 0;
}

bool same_tissue(const LegMuscles& a, const LegMuscles& b) {
  return a.material == b.material && a.element == b.element && a.cells == b.cells;
}

double middle_of_range(double value, double width) {
  const double step = width * width;
  double at = 1;
  while (at * width < value) at *= step;
  while (at > value * width) at /= step;
  return at;
}

std::pair<const BellyTemplate*, const BellyTemplate*> BellyLibrary::find_shape(Muscle muscle,
                                                                               const LegMuscles& choice) const {
  const BellyTemplate* alike = nullptr;
  for (const auto& made : templates_) {
    if (made->muscle != muscle || !same_tissue(made->choice, choice)) continue;
    if (same_template(made->choice, choice, muscle)) return {made.get(), made.get()};
    alike = made.get();
  }
  return {nullptr, alike};
}

Result<std::unique_ptr<BellyTemplate>> BellyLibrary::make_shape(Muscle muscle, const LegMuscles& choice,
                                                                const BellyTemplate* alike,
                                                                std::optional<ShapeTables> known) {
  check_interrupt();
  auto mesh = bend_block(choice.cells, muscle_lattice(muscle), reference_belly_m(muscle), belly_grading);
  if (!mesh) return tl::unexpected(mesh.error());
  const MuscleOptions options = options_of(choice, muscle);
  std::optional<CriticalSteps> steps;
  if (known) steps = std::move(known->critical_steps);
  auto shape = make_muscle_template(std::move(*mesh), choice.material, options, std::move(steps));
  if (!shape) return tl::unexpected(shape.error());
  auto made = std::make_unique<BellyTemplate>();
  made->choice = choice;
  made->muscle = muscle;
  if (known) {
    made->axial = std::move(known->axial);
    made->stretch = std::move(known->stretch);
  } else if (alike != nullptr) {
    made->axial = alike->axial;
  } else {
    made->axial = tabulate_axial_stiffness(shape->terms, shape->kernel.far_share, lowest_ratio, highest_ratio);
  }
  if (!known) {
    // Groups are held sideways only if they have inertia, and then settle under the load at that instant.
    const bool held = !is_muscle_group(muscle);
    const bool as_alike =
        alike != nullptr && (!held || foundation_of(alike->choice, muscle) == foundation_of(choice, muscle));
    made->stretch = as_alike ? alike->stretch : static_stretch(shape->terms, 1, 1, held ? options.foundation_hz : 0);
  }
  made->lines = alike ? alike->lines : std::make_shared<const MuscleLines>(make_muscle_lines(muscle));
  made->shape = std::make_shared<const MuscleTemplate>(std::move(*shape));
  return made;
}

std::shared_ptr<const LegMuscles> BellyLibrary::choice(const LegMuscles& choice) {
  LegMuscles kept = choice;
  kept.muscles = LegMuscles{}.muscles;
  kept.method = LegMuscles{}.method;
  kept.modal = {};
  return whole_choice(kept);
}

std::shared_ptr<const LegMuscles> BellyLibrary::whole_choice(const LegMuscles& choice) {
  for (const auto& made : choices_) {
    if (*made == choice) return made;
  }
  choices_.push_back(std::make_shared<const LegMuscles>(choice));
  return choices_.back();
}

Result<const BellyTemplate*> BellyLibrary::shape(Muscle muscle, const LegMuscles& choice) {
  const auto [found, alike] = find_shape(muscle, choice);
  if (found != nullptr) return found;
  auto made = make_shape(muscle, choice, alike);
  if (!made) return tl::unexpected(made.error());
  templates_.push_back(std::move(*made));
  return templates_.back().get();
}

std::shared_ptr<const FiniteShape> BellyLibrary::finite_shape(const BellyTemplate& shape) {
  const auto own = std::ranges::find(templates_, &shape, &std::unique_ptr<BellyTemplate>::get);
  std::shared_ptr<const FiniteShape>& made = (*own)->finite;
  if (made == nullptr) {
    const MuscleTemplate& of = *shape.shape;
    made = std::make_shared<const FiniteShape>(
        make_finite_shape(shape.muscle, of.mesh, static_stretch(of.terms, 1, 1, of.options.foundation_hz)));
  }
  return made;
}

BellyLibrary::SolverKey BellyLibrary::solver_key(const BellyTemplate& shape, Method method, Mass mass, double dt_s,
                                                 const BellyScale<float>& scale) {
  // The operator over S depends on S / l and, if it contains mass, on S·l. The operator of ICD is only the mass.
  const auto across = static_cast<double>(scale.across), along = static_cast<double>(scale.along);
  const bool massive = method == Method::newmark || shape.shape->options.foundation_hz > 0;
  const double ratio = method == Method::implicit_central
                           ? 1
                           : std::clamp(middle_of_range(across / along, 1.06), lowest_ratio, highest_ratio);
  const double product = method == Method::implicit_central || !massive ? 1 : middle_of_range(across * along, 1.12);
  return {&shape, method, mass, dt_s, std::sqrt(product * ratio), std::sqrt(product / ratio)};
}

std::shared_ptr<const BellySolver> BellyLibrary::find_solver(const SolverKey& key) const {
  const double step_s = key.method == Method::statics ? 0 : key.dt_s;
  for (const Solver& made : solvers_) {
    const BellySolver& s = *made.solver;
    const bool same_mass = key.method != Method::newmark || s.mass == key.mass;
    if (made.shape == key.shape && s.method == key.method && same_mass && s.dt_s == step_s && s.across == key.across &&
        s.along == key.along) {
      return made.solver;
    }
  }
  return nullptr;
}

Result<std::shared_ptr<const BellySolver>> BellyLibrary::solver(const BellyTemplate& shape, Method method, Mass mass,
                                                                double dt_s, const BellyScale<float>& scale) {
  const SolverKey key = solver_key(shape, method, mass, dt_s, scale);
  if (auto found = find_solver(key)) return found;
  check_interrupt();
  auto solver = make_belly_solver(*shape.shape, method, mass, dt_s, key.across, key.along);
  if (!solver) return tl::unexpected(solver.error());
  solvers_.push_back({&shape, std::make_shared<const BellySolver>(std::move(*solver))});
  return solvers_.back().solver;
}

Result<SharedBelly> BellyLibrary::shared(Muscle muscle, const LegMuscles& choice, const BellyScale<float>& scale,
                                         double tick_s) {
  SharedBelly belly;
  const auto made = shape(muscle, choice);
  if (!made) return tl::unexpected(made.error());
  belly.shape = *made;
  if (choice.method == Method::none) return belly;
  if (has_finite_shape(choice) || (choice.method == Method::finite && has_activation(choice)))
    belly.finite = finite_shape(**made);
  if (choice.method == Method::modal) {
    auto along = basis(muscle, choice, scale);
    if (!along) return tl::unexpected(along.error());
    belly.basis = std::move(*along);
    return belly;
  }
  const auto count = steps(*belly.shape->shape, choice, scale, tick_s);
  if (!count) return tl::unexpected(count.error());
  belly.steps = *count;
  const auto solve_with = [&](Method method, std::shared_ptr<const BellySolver>& to) -> Result<void> {
    auto found = solver(*belly.shape, method, choice.mass, tick_s / belly.steps, scale);
    if (!found) return tl::unexpected(found.error());
    to = std::move(*found);
    return {};
  };
  if (choice.method != Method::explicit_central && choice.method != Method::finite) {
    if (auto ok = solve_with(choice.method, belly.solver); !ok) return tl::unexpected(ok.error());
  }
  if (choice.inertia) {
    if (auto ok = solve_with(Method::statics, belly.resting); !ok) return tl::unexpected(ok.error());
  }
  return belly;
}

Result<Belly> BellyLibrary::belly(const MusclePlan& plan, const LegMuscles& choice, double tick_s) {
  if (auto ok = check_choice(choice, tick_s); !ok) return tl::unexpected(ok.error());
  auto common = shared(plan.muscle, choice, plan.scale, tick_s);
  if (!common) return tl::unexpected(common.error());
  Belly belly{std::move(*common), plan, {}, {}, {}};
  if (choice.method != Method::modal) return belly;
  const ModalBasis& basis = *belly.basis;
  ModalBellies one;
  one.tuned = is_tuned(choice);
  if (auto solved = solve_bellies(basis, {&plan.scale, 1}, one); !solved) return tl::unexpected(solved.error());
  const double damping = basis.options.damping_per_s;
  std::vector<Lanes<float>> words(
      std::max(modal_motion_width(one.modes, one.inputs), modal_shape_width(one.modes, one.inputs)));
  const auto first_lanes = [&](std::size_t width) {
    std::vector<float> row(width);
    for (std::size_t w = 0; w < width; ++w) row[w] = words[w][0];
    return row;
  };
  write_motions(one, damping, static_cast<double>(static_cast<float>(tick_s)), words[0].lane);
  belly.motion = first_lanes(modal_motion_width(one.modes, one.inputs));
  if (choice.modal.control_points) {
    write_shapes(one, damping, words[0].lane);
    belly.rest_shape = first_lanes(modal_shape_width(one.modes, one.inputs));
  }
  belly.motions = std::make_shared<const ModalBelly>(belly_of(one, 0));
  return belly;
}

}  // namespace mobil::inline v0_3
