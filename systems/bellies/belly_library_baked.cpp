// Contents of a library as baked bytes (baked_bytes.h): counts, templates, solvers, bases. A
// template stores only the tables that are expensive to compute, solvers and bases only their arrays. The lengths of
// these arrays follow from the choice, so an altered length cannot mislead the reader.
#include <algorithm>

#include "assets/fem/solver_arrays.h"
#include "assets/reduction/basis_arrays.h"
#include "assets/surfaces/muscle_lattice.h"
#include "engine/row_hash.h"
#include "systems/bellies/baked_bytes.h"
#include "systems/bellies/belly_library.h"
#include "systems/bellies/leg_muscles_io.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::uint64_t magic = 0x346b626c69626f6d;  // "mobilbk4", little-endian
constexpr double any_tick_s = 1;  // a choice without its own step is in range at any tick

void write(BakeWriter& out, Muscle muscle, const LegMuscles& choice) {
  out.put(static_cast<std::uint32_t>(muscle));
  for (const std::uint64_t word : leg_muscles_words(choice)) out.put(word);
}

/// A muscle and its choice.
struct Chosen {
  Muscle muscle{};
  LegMuscles choice;
};

Chosen read_chosen(BakeReader& in) {
  const auto last = static_cast<std::uint32_t>(muscles().size() - 1);
  const auto muscle = static_cast<Muscle>(in.take_up_to(last));
  LegMusclesWords words{};
  for (std::uint64_t& word : words) word = in.take<std::uint64_t>();
  const auto named = choice_of(words);
  if (!named) in.refuse();
  LegMuscles choice = named.value_or(LegMuscles{});
  choice.dt_s.reset();
  if (!check_choice(choice, any_tick_s)) in.refuse();
  for (const Cells& cells : {choice.cells, choice.modal.cells}) {
    std::uint64_t nodes = 1;
    for (const std::uint32_t count : cells) nodes *= std::uint64_t{std::min(count, largest_mesh_nodes)} + 1;
    if (nodes > largest_mesh_nodes || nodes <= 1) in.refuse();
  }
  return {muscle, choice};
}

/// Reads the arguments of a table, which must ascend.
void read_ascending(BakeReader& in, std::vector<double>& values, std::size_t length) {
  in(values, length);
  if (values.empty() || !std::is_sorted(values.begin(), values.end()) || !(values.front() > 0)) in.refuse();
}

void write(BakeWriter& out, const CriticalSteps& steps, const AxialStiffness& axial, const StaticStretch& stretch) {
  out.put(static_cast<std::uint32_t>(steps.ratio.size()));
  out.put(static_cast<std::uint32_t>(steps.foundation.size()));
  out.put(static_cast<std::uint32_t>(axial.ratio.size()));
  for (const auto* values : {&steps.ratio, &steps.foundation, &steps.top, &axial.ratio, &axial.per_ratio}) {
    out(*values, values->size());
  }
  out(stretch.displacement, stretch.displacement.size());
  for (const double number : {steps.stiffness_damping_s, steps.foundation_1_s2, stretch.stiffness_n_per_m})
    out.put(number);
}

void read(BakeReader& in, const LegMuscles& choice, Muscle muscle, CriticalSteps& steps, AxialStiffness& axial,
          StaticStretch& stretch) {
  const auto ratios = in.take<std::uint32_t>(), foundations = in.take<std::uint32_t>(),
             axials = in.take<std::uint32_t>();
  read_ascending(in, steps.ratio, ratios);
  in(steps.foundation, foundations);
  if (!in.sound() || steps.foundation.empty() || steps.foundation.front() != 0 ||
      !std::is_sorted(steps.foundation.begin(), steps.foundation.end()) ||
      (foundations > 1) != (foundation_of(choice, muscle) > 0)) {
    in.refuse();
  }
  in(steps.top, std::size_t{ratios} * foundations);
  read_ascending(in, axial.ratio, axials);
  in(axial.per_ratio, axials);
  if (in.sound()) in(stretch.displacement, 3 * std::size_t{node_count(choice.cells)});
  for (double* const number : {&steps.stiffness_damping_s, &steps.foundation_1_s2, &stretch.stiffness_n_per_m})
    *number = in.take<double>();
}

void write(BakeWriter& out, const BellySolver& solver, const Cells& cells) {
  const BandFactor& factor = solver.factor;
  for (const std::uint32_t number :
       {static_cast<std::uint32_t>(solver.method), static_cast<std::uint32_t>(solver.mass), solver.sweeps,
        solver.refinements, factor.components, factor.first_node, factor.nodes}) {
    out.put(number);
  }
  for (const double number : {solver.dt_s, solver.across, solver.along, static_cast<double>(solver.correction)})
    out.put(number);
  each_array(solver, cells, out);
}

BellySolver read_solver(BakeReader& in, const Cells& cells) {
  constexpr std::uint32_t max_sweeps = 64;
  BellySolver solver;
  BandFactor& factor = solver.factor;
  solver.method = static_cast<Method>(in.take_up_to(static_cast<std::uint32_t>(Method::none)));
  solver.mass = static_cast<Mass>(in.take_up_to(static_cast<std::uint32_t>(Mass::consistent)));
  solver.sweeps = in.take_up_to(max_sweeps);
  solver.refinements = in.take_up_to(max_sweeps);
  factor.components = in.take_up_to(3);
  factor.first_node = in.take<std::uint32_t>();
  factor.nodes = in.take_up_to(node_count(cells));
  for (double* const number : {&solver.dt_s, &solver.across, &solver.along}) *number = in.take<double>();
  solver.correction = static_cast<float>(in.take<double>());
  const std::uint32_t first = plane_nodes(cells), all = node_count(cells) - first;
  const bool whole = factor.nodes == all || factor.nodes == all - first;
  if (!whole || factor.first_node != first ||
      factor.components != (solver.method == Method::implicit_central ? 1U : 3U))
    in.refuse();
  each_array(solver, cells, [&](auto& array, std::size_t length) {
    if (in.sound()) in(array, length);
    // Couplings are within the factor. The arrays that follow have the lengths that they state.
    for (std::uint32_t n = 0; in.sound() && n < factor.before.size() && n < factor.after.size(); ++n) {
      if (factor.before[n] > n || factor.after[n] >= factor.nodes - n) in.refuse();
    }
  });
  return solver;
}

void write(BakeWriter& out, const ModalBasis& basis) {
  const bool turned = !basis.turned.vector.empty();
  out.put(basis.modes);
  out.put(std::uint32_t{turned});
  each_number(basis, [&](double number) { out.put(number); });
  each_array(basis, turned, out);
}

ModalBasis read_basis(BakeReader& in, const Cells& cells, ModalBasisOptions options) {
  options.modes = in.take_up_to(max_modes);
  const bool turned = in.take_up_to(1) != 0;
  auto basis = basis_outline(cells, options);
  if (!basis) {
    in.refuse();
    return {};
  }
  each_number(*basis, [&](double& number) { number = in.take<double>(); });
  each_array(*basis, turned, [&](auto& array, std::size_t length) {
    if (in.sound()) in(array, length);
  });
  return std::move(*basis);
}

}  // namespace

/// Returns a hash of everything that determines the bits of a file: the muscles' meshes, and the results for a small
/// belly on this machine. Another version of the library, or a processor that computes differently, has another value.
std::uint64_t BellyLibrary::maker() {
  static const std::uint64_t maker = find_maker();
  return maker;
}

std::uint64_t BellyLibrary::find_maker() {
  BakeWriter out;
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    const auto muscle = static_cast<Muscle>(m);
    out.put(reference_belly_m(muscle));
    for (const LatticeStation& s : muscle_lattice(muscle)) {
      for (const float number : {s.t, s.offset_x_m, s.offset_y_m, s.semi_x_m, s.semi_y_m, s.shear_x_m, s.shear_y_m}) {
        out.put(number);
      }
    }
  }
  LegMuscles small;
  small.cells = {1, 1, 2};
  LegMuscles finite = small;
  finite.method = Method::finite;
  if (const auto shape = make_shape(Muscle{}, finite, nullptr)) {
    for (const double top : (*shape)->shape->critical_steps.top) out.put(top);
  }
  if (const auto shape = make_shape(Muscle{}, small, nullptr)) {
    const BellyTemplate& made = **shape;
    write(out, made.muscle, made.choice);
    write(out, made.shape->critical_steps, made.axial, made.stretch);
    if (const auto solver = make_belly_solver(*made.shape, Method::statics, Mass::lumped, 1))
      write(out, *solver, small.cells);
  }
  ModalBasisOptions few;
  few.modes = 2;
  few.ratio_width = 1;
  few.control_cells = small.cells;
  const auto mesh = bend_block({2, 2, 4}, muscle_lattice(Muscle{}), reference_belly_m(Muscle{}), belly_grading);
  if (const auto basis = make_modal_basis(*mesh, small.material, small.element, few)) write(out, *basis);
  return hash_bytes(out.bytes.data(), out.bytes.size());
}

std::vector<std::byte> BellyLibrary::bake() const {
  BakeWriter out;
  for (const std::size_t count : {templates_.size(), solvers_.size(), bases_.size()})
    out.put(static_cast<std::uint32_t>(count));
  for (const auto& made : templates_) {
    write(out, made->muscle, made->choice);
    write(out, made->shape->critical_steps, made->axial, made->stretch);
  }
  for (const Solver& made : solvers_) {
    const auto at = std::find_if(templates_.begin(), templates_.end(),
                                 [&](const auto& shape) { return shape.get() == made.shape; });
    out.put(static_cast<std::uint32_t>(at - templates_.begin()));
    write(out, *made.solver, made.shape->choice.cells);
  }
  for (const Basis& made : bases_) {
    write(out, made.muscle, made.choice);
    out.put(made.middle_ratio);
    out.put(made.middle_product);
    write(out, *made.whole);
    out.put(static_cast<std::uint32_t>(made.cut.size()));
    for (const auto& cut : made.cut) write(out, *cut);
  }
  return sealed(out, magic, maker());
}

Result<BellyLibrary::Loaded> BellyLibrary::read(std::span<const std::byte> baked) const {
  const auto contents = opened(baked, magic, &BellyLibrary::maker, "bellies");
  if (!contents) return tl::unexpected(contents.error());
  BakeReader in(*contents);
  Loaded loaded;
  const auto templates = in.take<std::uint32_t>(), solvers = in.take<std::uint32_t>(), bases = in.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < templates && in.sound(); ++i) {
    const auto [muscle, choice] = read_chosen(in);
    ShapeTables tables;
    mobil::read(in, choice, muscle, tables.critical_steps, tables.axial, tables.stretch);
    if (!in.sound()) break;
    const BellyTemplate* alike = find_shape(muscle, choice).second;
    for (const auto& before : loaded.templates) {
      if (alike == nullptr && before->muscle == muscle && same_tissue(before->choice, choice)) alike = before.get();
    }
    auto shape = make_shape(muscle, choice, alike, std::move(tables));
    if (!shape) return tl::unexpected(shape.error());
    loaded.templates.push_back(std::move(*shape));
  }
  for (std::uint32_t i = 0; i < solvers && in.sound(); ++i) {
    const auto of = in.take<std::uint32_t>();
    if (of >= loaded.templates.size()) in.refuse();
    if (in.sound()) loaded.solvers.emplace_back(of, read_solver(in, loaded.templates[of]->choice.cells));
  }
  for (std::uint32_t i = 0; i < bases && in.sound(); ++i) {
    const Chosen chosen = read_chosen(in);
    const LegMuscles& choice = chosen.choice;
    BasisKey key{};
    key.ratio = in.take<double>();
    key.product = in.take<double>();
    if (!in.sound()) break;
    const auto one = [&] {
      return std::make_shared<const ModalBasis>(
          read_basis(in, choice.modal.cells, basis_options(choice, chosen.muscle, key)));
    };
    Basis basis{chosen.muscle, choice, key.ratio, key.product, one(), {}, true};
    const std::uint32_t cuts = in.take_up_to(max_modes);
    for (std::uint32_t cut = 0; cut < cuts && in.sound(); ++cut) basis.cut.push_back(one());
    loaded.bases.push_back(std::move(basis));
  }
  if (!in.whole()) return fail("the baked bellies do not agree with themselves; bake them again");
  return loaded;
}

Result<void> BellyLibrary::load(std::span<const std::byte> baked) {
  auto loaded = read(baked);
  if (!loaded) return tl::unexpected(loaded.error());
  std::vector<const BellyTemplate*> here;
  for (auto& shape : loaded->templates) {
    const BellyTemplate* known = find_shape(shape->muscle, shape->choice).first;
    if (known == nullptr) {
      templates_.push_back(std::move(shape));
      known = templates_.back().get();
    }
    here.push_back(known);
  }
  for (auto& [of, new_solver] : loaded->solvers) {
    BellySolver& solver = new_solver;
    const bool known = std::any_of(solvers_.begin(), solvers_.end(), [&, at = here[of]](const Solver& made) {
      const BellySolver &a = *made.solver, &b = solver;
      return made.shape == at && a.method == b.method && a.mass == b.mass && a.dt_s == b.dt_s && a.across == b.across &&
             a.along == b.along;
    });
    if (!known) solvers_.push_back({here[of], std::make_shared<const BellySolver>(std::move(solver))});
  }
  for (Basis& basis : loaded->bases) {
    LegMuscles choice = basis.choice;
    choice.modal.modes = basis.whole->modes;
    Basis* const known = find_basis(basis.muscle, choice, {basis.middle_ratio, basis.middle_product});
    if (known == nullptr) {
      bases_.push_back(std::move(basis));
      continue;
    }
    known->given = true;
    for (auto& cut : basis.cut) {
      const bool there = std::any_of(known->cut.begin(), known->cut.end(),
                                     [&](const auto& made) { return made->modes == cut->modes; });
      if (!there) known->cut.push_back(std::move(cut));
    }
  }
  return {};
}

}  // namespace mobil::inline v0_3
