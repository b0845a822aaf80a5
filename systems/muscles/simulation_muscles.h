#pragma once
// What can be chosen of leg muscles, and what people who choose alike share. Part of the front door
// (systems/simulation.h).

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "assets/fem/axial_stiffness.h"
#include "assets/fem/belly_solver.h"
#include "assets/fem/hexahedral_mesh.h"
#include "assets/fem/muscle_template.h"
#include "assets/muscles/muscle_plan.h"
#include "assets/muscles/muscle_table.h"
#include "assets/reduction/reduced_belly.h"
#include "components/body.h"
#include "components/muscle.h"
#include "engine/error.h"
#include "engine/jobs.h"

namespace mobil {

struct MuscleLines;  // systems/lines/muscle_lines.h

/// How the far end of a belly is driven: `displacement` makes it follow the line of action exactly, `force` pulls it
/// with the spring force of the paper's equations 2 and 3.
enum class Drive : std::uint8_t { displacement, force };

/// Bellies that move along a few vectors of a finer mesh (Method::reduced).
struct ReducedChoice {
  std::uint32_t vectors = 12;  // 1–32
  bool moving = true;          // false: the static answer alone, which has no state
  bool corrected = true;       // the mesh's own error extrapolated away (assets/reduction/reduced_basis.h)
  Cells cells = {4, 4, 16};    // of the mesh that the vectors are of; has all nodes of LegMuscles::cells
  /// Whether someone looks: control points are placed (NodalDisplacement). Without, the state alone goes on.
  bool control_points = true;
  /// Whether what control points did is told (BellyReport), which takes more than half as long as placing them.
  bool reported = true;

  friend bool operator==(const ReducedChoice&, const ReducedChoice&) = default;
};

/// How one muscle is simulated, at its person's other choices.
struct MuscleMethod {
  Method method = Method::ecd;
  ReducedChoice reduced{};  // of Method::reduced
};

/// How leg muscles deform. Every choice is a matter of which components a muscle has: see the tags below.
struct LegMuscles {
  /// Which ones: the groups unless a scene comes close (muscle_members()) or calls for few.
  MuscleSet muscles = muscle_groups();
  Drive drive = Drive::displacement;
  Method method = Method::ecd;
  ReducedChoice reduced{};  // of Method::reduced
  Material material{};
  Element element = Element::full;
  Mass mass = Mass::lumped;        // of CAA; ECD's is lumped, ICD's consistent, static has none
  double damping_per_s = 8;        // Rayleigh's α, 0–1000
  double stiffness_damping_s = 0;  // Rayleigh's β, 0–1
  bool inertia = false;            // gravity and the acceleration of the muscle's frame
  bool line_motion = false;        // lengthening speed and moment arms: component LineMotion
  /// Fascia and neighbours as an elastic foundation sideways, (2πf)² times the mass, 0–1000 Hz. Left out: 7 Hz with
  /// inertia, where a belly would sag by its own length without, and none otherwise.
  std::optional<double> foundation_hz{};
  /// 81 nodes, the paper's choice for real time; meshes of {4, 4, 16}, {8, 8, 32} … have all its nodes.
  Cells cells = {2, 2, 8};
  /// Longest step; a tick is cut into equal ones no longer than that. Left out: of ECD and ICD 0.9 of each individual's
  /// own critical step, of CAA the tick. Static has no steps.
  std::optional<double> dt_s{};

  friend bool operator==(const LegMuscles&, const LegMuscles&) = default;
};

// Tags of muscle tables. Who steps explicitly (ECD) has Substeps and NodalVelocity; who solves (ICD, CAA) SolvedSteps,
// NodalVelocity and a Shared<BellySolver>; who stands still (static) StaticSteps and a Shared<BellySolver>. Who moves
// along vectors (reduced) has a Shared<ReducedBasis>, ReducedState and ReducedMotion, or ReducedStatic where it has no
// motion of its own; only where someone looks ReducedShape and what all the others have, NodalDisplacement; and only
// where someone asks what all the others have, BellyReport. Those that feel inertia have FrameHistory and FrameLoad
// besides. Who has nothing but a line (none) has none of these. For a while after a change of method: Fade, FadeStart
// and ShownDisplacement (components/fade.h).

/// The number of equal steps a tick is cut into.
struct Substeps {};
struct SolvedSteps {};
struct StaticSteps {};
/// Of reduced bellies that show the static answer alone.
struct ReducedStatic {};
/// Floats that one block is worked on with.
struct ScratchFloats {};

/// What all people share whose muscles of a kind are alike but for size.
struct BellyTemplate {
  LegMuscles choice;
  Muscle muscle{};
  std::shared_ptr<const MuscleTemplate> shape;
  std::shared_ptr<const MuscleLines> lines;
  AxialStiffness axial;
  StaticStretch stretch;  // of the template's own size
};

/// One muscle of one person, checked and ready.
struct Belly {
  MusclePlan plan;
  const BellyTemplate* shape = nullptr;
  std::uint32_t steps = 1;                      // a tick
  std::shared_ptr<const BellySolver> solver;    // of ICD, CAA and static
  std::shared_ptr<const BellySolver> resting;   // of the shape that a belly with inertia begins with; else null
  std::shared_ptr<const ReducedBasis> basis;    // of reduced
  std::shared_ptr<const ReducedBelly> motions;  // of reduced: this body's own
  std::vector<float> motion, rest_shape;        // and its rows, ReducedMotion and ReducedShape
};

/// Templates, solvers and bases, made when they are first asked for and kept. Solvers and bases are those of bodies in
/// the middle of a range of sizes: what one gets depends on one's own size alone.
class BellyLibrary {
 public:
  /// Of muscles with a line alone, and of reduced ones, what bodies of about that size share. Of a choice in range.
  struct Common {
    const BellyTemplate* shape;
    std::shared_ptr<const ReducedBasis> basis;  // of reduced
  };
  Result<Common> shared(Muscle muscle, const LegMuscles& choice, const BellyScale<float>& scale);

  /// A person's chosen muscles in the table's order. Errors: a choice out of range; a `dt_s` above a belly's critical
  /// step, which names the muscle and the limit.
  Result<std::vector<Belly>> bellies(const Body& body, const LegMuscles& choice, double tick_s);
  /// Makes all that bodies of usual size share: templates and bases by jobs, solvers one after the other. Errors: as
  /// above.
  Result<void> prepare(const LegMuscles& choice, double tick_s, const Jobs& jobs);
  /// The one muscle of that plan. Errors name no muscle.
  Result<Belly> belly(const MusclePlan& plan, const LegMuscles& choice, double tick_s);

 private:
  friend class ResourceList;  // systems/snapshot/simulation_resources.h

  struct Solver {
    const BellyTemplate* shape;
    std::shared_ptr<const BellySolver> solver;
  };
  /// Made with most_vectors; the others are the first ones of those.
  struct BasisKey {
    double ratio, product;  // in the middle of the bodies that it is for
    bool operator==(const BasisKey&) const = default;
  };
  struct Basis {
    Muscle muscle;
    LegMuscles choice;
    double middle_ratio, middle_product;
    std::shared_ptr<const ReducedBasis> whole;
    std::vector<std::shared_ptr<const ReducedBasis>> cut;
  };

  Result<const BellyTemplate*> shape(Muscle muscle, const LegMuscles& choice);
  /// The template, or null; and one that differs in what the tissue itself does not depend on, or null.
  std::pair<const BellyTemplate*, const BellyTemplate*> find_shape(Muscle muscle, const LegMuscles& choice) const;
  static Result<std::unique_ptr<BellyTemplate>> make_shape(Muscle muscle, const LegMuscles& choice,
                                                           const BellyTemplate* alike);
  Result<std::shared_ptr<const BellySolver>> solver(const BellyTemplate& shape, Method method, Mass mass, double dt_s,
                                                    const BellyScale<float>& scale);
  Result<std::shared_ptr<const ReducedBasis>> basis(Muscle muscle, const LegMuscles& choice,
                                                    const BellyScale<float>& scale);
  static BasisKey basis_key(const LegMuscles& choice, double ratio, double product);
  static std::vector<BasisKey> usual_bases(const LegMuscles& choice);
  Basis* find_basis(Muscle muscle, const LegMuscles& choice, const BasisKey& key);
  static Result<Basis> make_basis(Muscle muscle, const LegMuscles& choice, const BasisKey& key);
  static std::shared_ptr<const ReducedBasis> cut(Basis& made, std::uint32_t vectors);
  void prepare_solvers(Muscle muscle, const LegMuscles& choice, double tick_s);

  std::vector<std::unique_ptr<BellyTemplate>> templates_;
  std::vector<Solver> solvers_;
  std::vector<Basis> bases_;
};

/// Of bellies against their templates, what people of usual build have: across over along, and across times along. One
/// person in a thousand is beyond; with vectors of the usual mesh those are prepared for too.
namespace usual_sizes {
inline constexpr double least_ratio = 0.80, most_ratio = 1.26, least_product = 0.6, most_product = 1.3;
inline constexpr double rare_ratio = 1.05;  // times more or less
}
/// Whether a choice is in range, as far as that does not take a body to say.
Result<void> check_choice(const LegMuscles& choice, double tick_s);
/// Of a choice in range: the sideways foundation, Hz.
double foundation_of(const LegMuscles& choice);
bool same_tissue(const LegMuscles& a, const LegMuscles& b);
/// Whether a muscle of this choice has control points; and whether it feels its frame's motion.
bool has_control_points(const LegMuscles& choice);
bool feels_frame(const LegMuscles& choice);
/// The middle of the range of sizes that `value` is in, ranges going from 1 / width to width times their middle. By
/// multiplication alone: the same on every machine.
double middle_of_range(double value, double width);

}  // namespace mobil
