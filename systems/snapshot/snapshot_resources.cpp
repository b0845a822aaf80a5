#include "systems/snapshot/snapshot_resources.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "assets/fem/solver_arrays.h"
#include "assets/reduction/basis_arrays.h"
#include "engine/row_hash.h"
#include "engine/snapshot.h"
#include "systems/lines/muscle_lines.h"

namespace mobil::inline v0_3 {
namespace {

/// Hash of a sequence of numbers.
class Fingerprint {
 public:
  template <class T>
  void add(const std::vector<T>& values) {
    static_assert(std::is_same_v<T, float> || std::is_same_v<T, double> || std::is_same_v<T, std::uint32_t> ||
                  std::is_same_v<T, Vec3<double>> || std::is_same_v<T, StencilPair>);  // no padding
    hash_ = mix64(hash_ ^ hash_bytes(values.data(), values.size() * sizeof(T)));
  }
  void add(double value) { hash_ = mix64(hash_ ^ std::bit_cast<std::uint64_t>(value)); }
  void add(const Vec3<float>& v) {
    for (const float value : {v.x, v.y, v.z}) add(static_cast<double>(value));
  }
  void add(const MuscleLines::Point& point) {
    add(static_cast<double>(point.bone));
    add(point.at_m);
    add(static_cast<double>(point.hold));
    add(static_cast<double>(point.straight_to));
  }
  void add(const MuscleLines::Track& track) {
    add(track.at_zero);
    add(track.slope);
    for (const Vec3<float>& knot : track.cubic) add(knot);
  }
  std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0;
};

std::uint64_t fingerprint(const MuscleTemplate& shape) {
  Fingerprint print;
  const KernelArrays& k = shape.kernel;
  print.add(shape.mesh.node);
  print.add(shape.terms.pair);
  for (const auto* values :
       {&shape.critical_steps.ratio, &shape.critical_steps.foundation, &shape.critical_steps.top}) {
    print.add(*values);
  }
  for (const auto* values :
       {&k.individual, &k.shared, &k.consistent_mass_kg, &k.mass_kg, &k.inverse_mass, &k.far_share, &k.rest_m}) {
    print.add(*values);
  }
  const FiniteTissue& tissue = shape.finite.tissue;
  if (shape.finite.element.empty()) return print.hash();
  for (const double number : {tissue.shear_pa, tissue.bulk_over_shear, tissue.active_pa, tissue.passive_pa,
                              tissue.rest_over_optimal, tissue.force_slope, tissue.min_share, tissue.slack_tone}) {
    print.add(number);
  }
  for (const FiniteKernelElement& e : shape.finite.element) {
    for (const float number : {e.fibre[0], e.fibre[1], e.fibre_volume_m3, e.hourglass_across, e.rise})
      print.add(static_cast<double>(number));
  }
  return print.hash();
}

std::uint64_t fingerprint(const MuscleLines& lines) {
  Fingerprint print;
  for (const MuscleLines::Member& member : lines.members) {
    for (const MuscleLines::Point& point : member.path) print.add(point);
    print.add(static_cast<double>(member.weight));
    print.add(member.on_kneecap ? 1.0 : 0.0);
    if (member.on_kneecap) print.add(member.kneecap);
  }
  print.add(lines.rolling);
  print.add(lines.anchor);
  print.add(static_cast<double>(lines.towards));
  print.add(static_cast<double>(lines.start_m));
  return print.hash();
}

std::uint64_t fingerprint(const BellySolver& solver, const Cells& cells) {
  Fingerprint print;
  for (const double value : {solver.dt_s, solver.across, solver.along, static_cast<double>(solver.sweeps),
                             static_cast<double>(solver.refinements), static_cast<double>(solver.correction)}) {
    print.add(value);
  }
  each_array(solver, cells, [&](const auto& values, std::size_t) { print.add(values); });
  return print.hash();
}

std::uint64_t fingerprint(const ModalBasis& basis) {
  Fingerprint print;
  for (const double value : {1.0 * basis.modes, 1.0 * basis.inputs, basis.foundation_1_s2}) print.add(value);
  each_number(basis, [&](double value) { print.add(value); });
  each_array(basis, !basis.turned.vector.empty(), [&](const auto& values, std::size_t) { print.add(values); });
  return print.hash();
}

std::uint64_t fingerprint(const FiniteShape& shape) {
  Fingerprint print;
  for (const auto* values : {&shape.vector, &shape.even, &shape.stretch}) print.add(*values);
  for (const auto& vector : shape.coefficient) {
    for (const auto& amount : vector) {
      for (const float c : amount) print.add(static_cast<double>(c));
    }
  }
  return print.hash();
}

/// Return the options of a choice that tissue depends on, and those together with the drive.
LegMuscles tissue_of(const LegMuscles& choice) {
  LegMuscles tissue;
  tissue.material = choice.material;
  tissue.element = choice.element;
  tissue.cells = choice.cells;
  return tissue;
}
LegMuscles driven(const LegMuscles& choice, Muscle muscle) {
  LegMuscles alike = tissue_of(choice);
  alike.drive = choice.drive;
  alike.damping_per_s = choice.damping_per_s;
  alike.foundation_hz = foundation_of(choice, muscle);
  return alike;
}

Recipe recipe_of(ResourceKind kind, Muscle muscle, const LegMuscles& choice) {
  Recipe recipe{};
  recipe.kind = kind;
  recipe.muscle = static_cast<std::uint32_t>(muscle);
  recipe.choice = leg_muscles_words(choice);
  return recipe;
}
Recipe shape_recipe(ResourceKind kind, const BellyTemplate& made) {
  LegMuscles alike = driven(made.choice, made.muscle);
  alike.stiffness_damping_s = made.choice.stiffness_damping_s;
  const Method method = made.choice.method;  // of its critical steps
  alike.method = method == Method::implicit_central || method == Method::finite ? method : Method::explicit_central;
  return recipe_of(kind, made.muscle, alike);
}

std::uint64_t hash_of(const std::string& name) {
  return hash_bytes(name.data(), name.size());
}
Recipe named_recipe(const Module& module, const NamedResource& named) {
  Recipe recipe{};
  recipe.kind = ResourceKind::named;
  recipe.dt = hash_of(module.name);
  recipe.across = hash_of(named.name);
  recipe.along = named.part.id;
  return recipe;
}

double number(std::uint64_t bits) {
  return std::bit_cast<double>(bits);
}

BellyScale<float> scale_of(double across, double along) {
  return {static_cast<float>(across), static_cast<float>(along)};
}

/// Returns true if a number can be a belly's size relative to its template.
bool sound(double size) {
  return size >= 1e-2 && size <= 1e2;
}

/// Returns true if a choice's bases have the default mesh, as in choices without options for bases.
bool has_usual_basis(const LegMuscles& choice) {
  return choice.modal.cells == ModalOptions{}.cells;
}

/// Returns the number of nodes of the mesh that a resource needs, or that a choice will need later.
std::size_t nodes_of(const Recipe& recipe) {
  const auto choice = choice_of(recipe.choice);
  if (!choice) return 0;
  const bool with_basis =
      recipe.kind == ResourceKind::basis || (recipe.kind == ResourceKind::choice && !has_usual_basis(*choice));
  return with_basis ? std::max(node_count(choice->cells), node_count(choice->modal.cells)) : node_count(choice->cells);
}

}  // namespace

std::uint64_t resource_type(const Recipe& recipe) {
  switch (recipe.kind) {
    case ResourceKind::named:
      return recipe.along;
    case ResourceKind::choice:
      return type_id<LegMuscles>();
    case ResourceKind::shape:
      return type_id<MuscleTemplate>();
    case ResourceKind::lines:
      return type_id<MuscleLines>();
    case ResourceKind::solver:
      return type_id<BellySolver>();
    case ResourceKind::basis:
      return type_id<ModalBasis>();
    case ResourceKind::finite:
      return type_id<FiniteShape>();
    default:
      return 0;
  }
}

void ResourceList::learn(const World& world, const BellyLibrary& library, std::span<const Module> modules) {
  for (std::size_t number = known_.size(); number < world.resource_count(); ++number) {
    const void* resource = world.resource(number);
    Known known;
    for (const auto& made : library.choices_) {
      if (made.get() != resource) continue;
      known = {recipe_of(ResourceKind::choice, Muscle{}, *made), hash_of(*made)};
      known.recipe.muscle = max_muscles;
    }
    for (const auto& made : library.templates_) {
      if (made->shape.get() == resource) {
        known = {shape_recipe(ResourceKind::shape, *made), fingerprint(*made->shape)};
      } else if (made->finite.get() == resource) {
        known = {shape_recipe(ResourceKind::finite, *made), fingerprint(*made->finite)};
      } else if (made->lines.get() == resource) {
        known = {recipe_of(ResourceKind::lines, made->muscle, tissue_of(made->choice)), fingerprint(*made->lines)};
      }
    }
    for (const auto& made : library.solvers_) {
      if (made.solver.get() != resource) continue;
      const BellySolver& solver = *made.solver;
      known = {shape_recipe(ResourceKind::solver, *made.shape), fingerprint(solver, made.shape->choice.cells)};
      known.recipe.method = static_cast<std::uint32_t>(solver.method);
      known.recipe.mass = static_cast<std::uint32_t>(solver.method == Method::newmark ? solver.mass : Mass::lumped);
      known.recipe.dt = std::bit_cast<std::uint64_t>(solver.dt_s);
      known.recipe.across = std::bit_cast<std::uint64_t>(solver.across);
      known.recipe.along = std::bit_cast<std::uint64_t>(solver.along);
    }
    for (const auto& made : library.bases_) {
      const ModalBasis* basis = made.whole.get() == resource ? made.whole.get() : nullptr;
      for (const auto& cut : made.cut) basis = cut.get() == resource ? cut.get() : basis;
      if (basis == nullptr) continue;
      LegMuscles alike = basis_choice(made.choice, made.muscle);
      alike.modal.modes = basis->modes;
      known = {recipe_of(ResourceKind::basis, made.muscle, alike), fingerprint(*basis)};
      known.recipe.modes = basis->modes;
      known.recipe.across = std::bit_cast<std::uint64_t>(made.middle_ratio);
      known.recipe.along = std::bit_cast<std::uint64_t>(made.middle_product);
    }
    for (const Module& module : modules) {
      for (const NamedResource& named : module.resources) {
        if (named.resource.get() == resource) known = {named_recipe(module, named), 0};
      }
    }
    known_.push_back(known);
  }
}

Result<std::uint64_t> ResourceList::number_of(const SavedResource& saved, std::size_t max_nodes, World& world,
                                              BellyLibrary& library, std::span<const Module> modules) {
  const auto is = [&](std::size_t i) {
    return known_[i].fingerprint == saved.fingerprint && known_[i].recipe == saved.recipe;
  };
  const auto find = [&]() -> std::optional<std::uint64_t> {
    if (saved.number < known_.size() && is(saved.number)) return saved.number;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (is(i)) return i;
    }
    return std::nullopt;
  };
  if (saved.recipe.kind == ResourceKind::unknown || saved.recipe.kind > ResourceKind::named)
    return damaged("a recipe");
  if (const auto there = find()) return *there;
  if (saved.recipe.kind == ResourceKind::named)
    return fail(
        "the snapshot shares a named resource that no module here has; give it the modules that it was made with");
  if (const std::size_t nodes = nodes_of(saved.recipe); nodes > max_nodes && !is_there(saved.recipe, library)) {
    return fail(
        fmt::format("the snapshot needs a mesh of {} nodes that this simulation has not prepared, and at most {} may"
                    " be made; prepare or load it before, or raise RestoreLimits",
                    nodes, max_nodes));
  }
  if (auto made = make(saved.recipe, world, library); !made)
    return fail("the snapshot needs a muscle's mesh, solver, basis or shape that cannot be made again: " +
                made.error().message);
  learn(world, library, modules);
  if (const auto there = find()) return *there;
  return fail(
      fmt::format("a mesh, solver, basis or shape of {} comes out otherwise here than where the snapshot was made;"
                  " restore it with the program that made it, on a machine of the same kind",
                  saved.recipe.muscle < muscles().size() ? muscle_name(static_cast<Muscle>(saved.recipe.muscle))
                                                         : std::string_view("a muscle")));
}

bool ResourceList::is_there(const Recipe& recipe, BellyLibrary& library) {
  const auto choice = choice_of(recipe.choice);
  if (choice && recipe.kind == ResourceKind::choice) {
    const auto has_mesh = [&](const auto& made) { return same_tissue(made->choice, *choice); };
    const auto has_basis = [&](const auto& made) { return made.choice.modal.cells == choice->modal.cells; };
    return std::ranges::any_of(library.templates_, has_mesh) &&
           (has_usual_basis(*choice) || std::ranges::any_of(library.bases_, has_basis));
  }
  if (!choice || recipe.muscle >= muscles().size()) return false;
  const auto muscle = static_cast<Muscle>(recipe.muscle);
  const double across = number(recipe.across), along = number(recipe.along);
  const bool sized = recipe.kind == ResourceKind::basis || recipe.kind == ResourceKind::solver;
  if (sized && !(sound(across) && sound(along))) return false;
  if (recipe.kind == ResourceKind::basis) {
    return library.find_basis(muscle, *choice, BellyLibrary::basis_key(*choice, muscle, across, along)) != nullptr;
  }
  const BellyTemplate* const shape = library.find_shape(muscle, *choice).first;
  if (shape == nullptr || recipe.kind != ResourceKind::solver) return shape != nullptr;
  return library.find_solver(BellyLibrary::solver_key(*shape, static_cast<Method>(recipe.method),
                                                      static_cast<Mass>(recipe.mass), number(recipe.dt),
                                                      scale_of(across, along))) != nullptr;
}

Result<void> ResourceList::make(const Recipe& recipe, World& world, BellyLibrary& library) {
  const auto choice = choice_of(recipe.choice);
  if (choice && recipe.kind == ResourceKind::choice) {
    const auto made = library.whole_choice(*choice);
    world.share(made, hash_of(*made));
    return {};
  }
  if (!choice || recipe.muscle >= muscles().size()) return fail("its recipe is damaged");
  const auto muscle = static_cast<Muscle>(recipe.muscle);
  const double across = number(recipe.across), along = number(recipe.along);
  if (recipe.kind == ResourceKind::basis) {
    // These are midpoints of ranges; any size within a range leads to it.
    if (!sound(across) || !sound(along)) return fail("its recipe is damaged");
    auto basis = library.basis(muscle, *choice, scale_of(std::sqrt(along * across), std::sqrt(along / across)));
    if (!basis) return tl::unexpected(basis.error());
    world.share(std::move(*basis));
    return {};
  }
  const auto shape = library.shape(muscle, *choice);
  if (!shape) return tl::unexpected(shape.error());
  switch (recipe.kind) {
    case ResourceKind::shape:
      world.share((*shape)->shape);
      return {};
    case ResourceKind::lines:
      world.share((*shape)->lines);
      return {};
    case ResourceKind::finite:
      world.share(library.finite_shape(**shape));
      return {};
    case ResourceKind::solver: {
      if (!sound(across) || !sound(along) || recipe.method > static_cast<std::uint32_t>(Method::none) ||
          recipe.mass > static_cast<std::uint32_t>(Mass::consistent)) {
        return fail("its recipe is damaged");
      }
      auto solver = library.solver(**shape, static_cast<Method>(recipe.method), static_cast<Mass>(recipe.mass),
                                   number(recipe.dt), scale_of(across, along));
      if (!solver) return tl::unexpected(solver.error());
      world.share(std::move(*solver));
      return {};
    }
    default:
      return fail("its recipe is damaged");
  }
}

}  // namespace mobil::inline v0_3
