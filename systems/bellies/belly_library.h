#pragma once
// Data shared by people whose muscles are chosen alike: meshes, factorised operators and bases, each built once.

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

/// Maximum number of steps of a method in a tick.
inline constexpr std::uint32_t max_steps = 1'000'000;

/// Templates, solvers and bases, built when first requested and then kept. Solvers and bases belong to a body in the
/// middle of a range of sizes, so a body's result depends only on its own size.
class BellyLibrary {
 public:
  /// Returns the shared data of a muscle of this size and choice (in range). Error: a `dt_s` above its critical step,
  /// with the limit in the message.
  Result<SharedBelly> shared(Muscle muscle, const LegMuscles& choice, const BellyScale<float>& scale, double tick_s);
  /// Returns the shared data together with the body's own.
  Result<Belly> belly(const MusclePlan& plan, const LegMuscles& choice, double tick_s);
  /// Returns the single shared copy of a choice's tissue and effects, without muscles, method and modal options.
  std::shared_ptr<const LegMuscles> choice(const LegMuscles& choice);
  /// Returns the single shared copy of a choice including muscles and method.
  std::shared_ptr<const LegMuscles> whole_choice(const LegMuscles& choice);
  /// Builds all shared data for bodies of usual size: templates and bases in parallel jobs, solvers one after the
  /// other. Errors: as for `shared`.
  Result<void> prepare(const LegMuscles& choice, double tick_s, const Jobs& jobs);

  /// `bake` serializes all templates, solvers and bases. `load` adds those that are missing, with the same bits as if
  /// built here. A failed `load` returns a one-line error and changes nothing: bytes that were cut or altered, or baked
  /// by another version or kind of processor.
  std::vector<std::byte> bake() const;
  Result<void> load(std::span<const std::byte> baked);

 private:
  friend class ResourceList;  // systems/snapshot/snapshot_resources.h
  friend class BasisOrders;   // systems/lod/basis_orders.h

  struct Solver {
    const BellyTemplate* shape;
    std::shared_ptr<const BellySolver> solver;
  };
  /// The middle of the range of bodies that a basis serves, with max_modes. Smaller bases are its first modes.
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
    bool given = false;  // provided by `prepare` or `load`
  };

  /// Tables of a template that are expensive to compute.
  struct ShapeTables {
    CriticalSteps critical_steps;
    AxialStiffness axial;
    StaticStretch stretch;
  };
  /// Data read from bytes. A solver refers to its template by index here.
  struct Loaded {
    std::vector<std::unique_ptr<BellyTemplate>> templates;
    std::vector<std::pair<std::uint32_t, BellySolver>> solvers;
    std::vector<Basis> bases;
  };

  Result<const BellyTemplate*> shape(Muscle muscle, const LegMuscles& choice);
  std::shared_ptr<const FiniteShape> finite_shape(const BellyTemplate& shape);
  /// Returns the template or null, and a template with the same tissue or null.
  std::pair<const BellyTemplate*, const BellyTemplate*> find_shape(Muscle muscle, const LegMuscles& choice) const;
  static Result<std::unique_ptr<BellyTemplate>> make_shape(Muscle muscle, const LegMuscles& choice,
                                                           const BellyTemplate* alike,
                                                           std::optional<ShapeTables> known = std::nullopt);
  /// Key of a solver: template, method, step, and the middle of the range of sizes.
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

/// Usual sizes of bellies relative to their templates: ratio is across over along, product is across times along. One
/// person in a thousand is outside. With modes of the usual mesh, `prepare` covers rare people as well.
namespace usual_sizes {
inline constexpr double min_ratio = 0.80, max_ratio = 1.26, min_product = 0.6, max_product = 1.3;
inline constexpr double rare_ratio = 1.05;  // margin beyond either end
}  // namespace usual_sizes
/// Returns the minimum number of equal steps of a tick that are no longer than dt_s, up to rounding.
std::uint32_t steps_of(double tick_s, double dt_s);
/// Fails if a choice is out of range, as far as this can be checked without a body.
Result<void> check_choice(const LegMuscles& choice, double tick_s);
/// Returns the parts of a choice on which a modal belly's basis depends, without the number of modes. All other fields
/// are those of LegMuscles{}.
LegMuscles basis_choice(const LegMuscles& choice, Muscle muscle);
/// Fails if a choice in range does not allow modal bellies.
Result<void> check_modal(const LegMuscles& choice);
/// Returns one muscle's sideways foundation, Hz, for a choice in range.
double foundation_of(const LegMuscles& choice, Muscle muscle);
bool same_tissue(const LegMuscles& a, const LegMuscles& b);
/// Returns the middle of the range of sizes that contains `value`. Ranges extend from 1 / width to width times their
/// middle. Uses only multiplications and divisions in a fixed order, so the result is the same on every machine.
double middle_of_range(double value, double width);

}  // namespace mobil::inline v0_3
