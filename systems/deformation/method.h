#pragma once
// Interface of a deformation method: its parts of a muscle's row, the beginning and continuation of a belly, and its
// systems. Each method has a file here (method_stepped, method_static, method_modal, method_finite) and a row in
// `deformation_methods`. Parts common to all methods are in systems/muscles/muscle_parts.h.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include <mobil/schedule.h>
#include "assets/finite/finite_shape.h"
#include "systems/deformation/belly.h"
#include "systems/deformation/belly_motion.h"

namespace mobil::inline v0_3 {

/// Properties that determine a muscle's parts. Muscles of one kind share a table.
struct MuscleKind {
  Muscle muscle{};
  MuscleMethod method{};  // current method
  FarEnd far_end = FarEnd::held;
  bool inertia = false, line_motion = false;  // effects
  ExcitationSource activation = ExcitationSource::none;
  bool fading = false;          // the last change of method still fades
  std::uint32_t steps = 1;      // per tick
  Shared<LegMuscles> choice{};  // tissue and effects; muscles and method as in LegMuscles{}
  Shared<MuscleLines> lines{};
  Shared<MuscleTemplate> shape{};  // its nodes are the control points; null without them
  Shared<BellySolver> solver{};    // null if the method has none
  Shared<ModalBasis> basis{};      // of modal, otherwise null
  Shared<FiniteShape> finite{};    // for finite strain, otherwise null
};

/// The belly that a muscle is about to get. `load` is that of the last tick.
struct NextBelly {
  const Belly& belly;
  const LegMuscles& choice;
  const LineOfAction<float>& line;
  const BellyLoad& load;
};

/// Former state of a muscle: motion computed by its method, shown motion, and `seen` if its control points were placed.
/// `apart` is true if the shown motion was not the belly's own: an earlier change still faded, or finite strain or the
/// end's position appeared or disappeared. As motion it would make the belly ring, more at each change.
struct PastBelly {
  BellyMotion computed, shown;
  bool seen = false, apart = false;

  const BellyMotion& motion() const { return apart ? computed : shown; }
};

/// Initial state of a belly: displacement and velocity of its control points, state of a modal belly, and fading
/// difference (mobil/components/fade.h). A vector is empty if the method has no such state or keeps it.
struct Beginning {
  std::vector<float> displacement, velocity, state, fade;
};

struct DeformationMethod {
  Method method;
  /// Returns its systems, and all parts that they need and no other method has.
  Module (*module)();
  /// Adds the parts that this method gives a muscle of that kind, other than those of its control points.
  void (*parts)(const MuscleKind& kind, std::vector<ComponentId>& parts);
  /// Returns true if a table's parts are this method's, and sets method and steps. The resources in `kind` must be set.
  bool (*recognise)(const Archetype& key, MuscleKind& kind);
  /// Returns displacement and velocity of the control points between ticks, or nothing if they cannot be determined.
  std::optional<BellyMotion> (*computed)(const World& world, Entity muscle, float tick_s, LastReducedBelly& last);
  /// Returns an initial state under the line's length and the loads that does not ring: at rest, or with `moves` at the
  /// velocity of its loads.
  Beginning (*begin)(const NextBelly& next, bool moves);
  /// Returns the static solution for the drive of the end alone, with its velocity.
  BellyMotion (*at_rest)(const NextBelly& next);
  /// Continues from the shown motion. With `keeps` the state of the modal belly stays unchanged.
  Beginning (*go_on)(const NextBelly& next, const PastBelly& past, bool keeps);
};

/// Implements `at_rest` for methods that displace nodes: the template's stretched shape, or with finite strain the
/// shape that finite strain replaces.
BellyMotion stretched_at_rest(const NextBelly& next);

/// Implement `computed` and `go_on` for methods whose state is the motion of their nodes.
std::optional<BellyMotion> nodal_motion(const World& world, Entity muscle, float tick_s, LastReducedBelly& last);
Beginning go_on_as_nodes(const NextBelly& next, const PastBelly& past, bool keeps);

/// Returns one entry per Method, without Method::none.
std::span<const DeformationMethod> deformation_methods();
/// Returns null for Method::none.
const DeformationMethod* deformation_method(Method method);

}  // namespace mobil::inline v0_3
