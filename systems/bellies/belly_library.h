#pragma once
// What people share whose muscles are chosen alike: meshes, factorised operators, bases; each made once.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/muscle_table.h>
#include "assets/fem/belly_solver.h"
#include "assets/reduction/modal_basis.h"
#include "systems/deformation/belly.h"

namespace mobil::inline v0_3 {

/// Steps of a method that a tick may take.
inline constexpr std::uint32_t max_steps = 1'000'000;

/// Templates, solvers and bases, made when they are first asked for and kept. Solvers and bases are those of bodies in
/// the middle of a range of sizes: what one gets depends on one's own size alone.
class BellyLibrary {
 public:
  /// What a muscle of that size and choice (in range) shares with others. Errors: a `dt_s` above its critical step,
  /// which names the limit.
  Result<SharedBelly> shared(Muscle muscle, const LegMuscles& choice, const BellyScale<float>& scale, double tick_s);
  /// The same with what is its own.
  Result<Belly> belly(const MusclePlan& plan, const LegMuscles& choice, double tick_s);
  /// A choice's tissue and effects, once each: all but which muscles and by what method.
  std::shared_ptr<const LegMuscles> choice(const LegMuscles& choice);
  /// A choice with muscles and method, once each.
  std::shared_ptr<const LegMuscles> whole_choice(const LegMuscles& choice);
  /// Makes all that bodies of usual size share: templates and bases by jobs, solvers one after the other. Errors: as
  /// above.
  Result<void> prepare(const LegMuscles& choice, double tick_s, const Jobs& jobs);

  /// All templates, solvers and bases that there are, as bytes; and those that such bytes hold taken in, where they
  /// are not there yet: the same bits as made here. Errors of `load`, in one line, nothing having changed: bytes that
  /// were cut or altered, or baked by another version or kind of processor.
  std::vector<std::byte> bake() const;
  Result<void> load(std::span<const std::byte> baked);

 private:
  friend class ResourceList;  // systems/snapshot/snapshot_resources.h
  friend class BasisOrders;   // systems/lod/basis_orders.h

  struct Solver {
    const BellyTemplate* shape;
    std::shared_ptr<const BellySolver> solver;
  };
  /// Made with max_modes; the others are the first ones of those.
  struct BasisKey {
    double ratio, product;  // the centre of the range of bodies that it serves
    bool operator==(const BasisKey&) const = default;
  };
  struct Basis {
    Muscle muscle;
    LegMuscles choice;
    double middle_ratio, middle_product;
    std::shared_ptr<const ModalBasis> whole;
    std::vector<std::shared_ptr<const ModalBasis>> cut;
    bool given = false;  // by `prepare` or `load`
  };

  /// What takes long to find of a template.
  struct ShapeTables {
    CriticalSteps critical_steps;
    AxialStiffness axial;
    StaticStretch stretch;
  };
  /// What bytes hold; solvers by the number of their template here.
  struct Loaded {
    std::vector<std::unique_ptr<BellyTemplate>> templates;
    std::vector<std::pair<std::uint32_t, BellySolver>> solvers;
    std::vector<Basis> bases;
  };

  Result<const BellyTemplate*> shape(Muscle muscle, const LegMuscles& choice);
  std::shared_ptr<const FiniteShape> finite_shape(const BellyTemplate& shape);
  /// The template, or null; and one that differs in what the tissue itself does not depend on, or null.
  std::pair<const BellyTemplate*, const BellyTemplate*> find_shape(Muscle muscle, const LegMuscles& choice) const;
  static Result<std::unique_ptr<BellyTemplate>> make_shape(Muscle muscle, const LegMuscles& choice,
                                                           const BellyTemplate* alike,
                                                           std::optional<ShapeTables> known = std::nullopt);
  /// What a solver is for: a template, a method, a step, and the middle of the range of sizes.
  struct SolverKey {
    const BellyTemplate* shape;
    Method method;
    Mass mass;
    double dt_s, across, along;
  };
  static SolverKey solver_key(const BellyTemplate& shape, Method method, Mass mass, double dt_s,
                              const BellyScale<float>& scale);
  std::shared_ptr<const BellySolver> find_solver(const SolverKey& key) const;
  Result<std::shared_ptr<const BellySolver>> solver(const BellyTemplate& shape, Method method, Mass mass, double dt_s,
                                                    const BellyScale<float>& scale);
  Result<std::shared_ptr<const ModalBasis>> basis(Muscle muscle, const LegMuscles& choice,
                                                  const BellyScale<float>& scale);
  static BasisKey basis_key(const LegMuscles& choice, Muscle muscle, double ratio, double product);
  static std::vector<BasisKey> usual_bases(const LegMuscles& choice, Muscle muscle);
  Basis* find_basis(Muscle muscle, const LegMuscles& choice, const BasisKey& key);
  static ModalBasisOptions basis_options(const LegMuscles& choice, Muscle muscle, const BasisKey& key);
  static Result<Basis> make_basis(Muscle muscle, const LegMuscles& choice, const BasisKey& key);
  static std::shared_ptr<const ModalBasis> cut(Basis& made, std::uint32_t modes);
  void prepare_solvers(Muscle muscle, const LegMuscles& choice, double tick_s);
  static std::uint64_t maker();
  static std::uint64_t find_maker();
  Result<Loaded> read(std::span<const std::byte> baked) const;

  std::vector<std::shared_ptr<const LegMuscles>> choices_;
  std::vector<std::unique_ptr<BellyTemplate>> templates_;
  std::vector<Solver> solvers_;
  std::vector<Basis> bases_;
};

/// Of bellies against their templates, what people of usual build have: across over along, and across times along. One
/// person in a thousand is beyond; with modes of the usual mesh those are prepared for too.
namespace usual_sizes {
inline constexpr double min_ratio = 0.80, max_ratio = 1.26, min_product = 0.6, max_product = 1.3;
inline constexpr double rare_ratio = 1.05;  // times more or less
}  // namespace usual_sizes
/// The fewest equal steps of a tick that are no longer than dt_s, up to rounding.
std::uint32_t steps_of(double tick_s, double dt_s);
/// Whether a choice is in range, as far as that does not take a body to say.
Result<void> check_choice(const LegMuscles& choice, double tick_s);
/// What a modal belly's basis depends on of a choice, but for how many modes it has; all else is as in a
/// LegMuscles{}.
LegMuscles basis_choice(const LegMuscles& choice, Muscle muscle);
/// Of one that is, whether modal bellies can be so.
Result<void> check_modal(const LegMuscles& choice);
/// Of a choice in range: one muscle's sideways foundation, Hz.
double foundation_of(const LegMuscles& choice, Muscle muscle);
bool same_tissue(const LegMuscles& a, const LegMuscles& b);
/// The middle of the range of sizes that `value` is in, ranges going from 1 / width to width times their middle. By
/// multiplication alone: the same on every machine.
double middle_of_range(double value, double width);

}  // namespace mobil::inline v0_3
