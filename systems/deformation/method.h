#pragma once
// A way to deform bellies as one value: what it puts on a muscle's row, how a belly begins and goes on in it, and its
// systems. Each has a file of its own here (method_stepped, method_static, method_modal, method_finite) and a row in
// `deformation_methods`. What all muscles have whatever their method is systems/muscles/muscle_parts.h.

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

/// What a muscle's parts follow from. Muscles of one kind share a table.
struct MuscleKind {
  Muscle muscle{};
  MuscleMethod method{};  // as it is
  FarEnd far_end = FarEnd::held;
  bool inertia = false, line_motion = false;  // effects
  ExcitationSource activation = ExcitationSource::none;
  bool fading = false;          // a change of method has left something over
  std::uint32_t steps = 1;      // a tick
  Shared<LegMuscles> choice{};  // tissue and effects; muscles and method are as in a LegMuscles{}
  Shared<MuscleLines> lines{};
  Shared<MuscleTemplate> shape{};  // whose nodes are the control points; null without
  Shared<BellySolver> solver{};    // null where the method has none
  Shared<ModalBasis> basis{};      // of modal, else null
  Shared<FiniteShape> finite{};    // of who shows finite strain, else null
};

/// The belly that a muscle is about to become. `load` is the last tick's.
struct NextBelly {
  const Belly& belly;
  const LegMuscles& choice;
  const LineOfAction<float>& line;
  const BellyLoad& load;
};

/// What a muscle was: what its method computed, what it showed, and whether its control points were placed. `apart`:
/// what it showed was no motion of the belly, for a change before this one still faded, or finite strain or the end's
/// place came or went. Handed over as motion that would ring, and grow from change to change.
struct PastBelly {
  BellyMotion computed, shown;
  bool seen = false, apart = false;

  const BellyMotion& motion() const { return apart ? computed : shown; }
};

/// What a belly begins with: displacement and velocity of its control points, the state of a modal one, and what
/// fades (mobil/components/fade.h). Empty where there is no such thing, or where it stays as it is.
struct Beginning {
  std::vector<float> displacement, velocity, state, fade;
};

struct DeformationMethod {
  Method method;
  /// Its systems, and every part that they need and no other method has.
  Module (*module)();
  /// The parts that a muscle of that kind has because of its method, besides its control points'.
  void (*parts)(const MuscleKind& kind, std::vector<ComponentId>& parts);
  /// Whether a table's parts are this method's: its resources are set in `kind`. Fills in method, steps.
  bool (*recognise)(const Archetype& key, MuscleKind& kind);
  /// What its control points do between ticks: displacement and velocity. Nothing where that cannot be told.
  std::optional<BellyMotion> (*computed)(const World& world, Entity muscle, float tick_s, LastReducedBelly& last);
  /// Under its line's length and what loads it, so that it does not ring: at rest, or, where it `moves`, at the speed
  /// that its loads have.
  Beginning (*begin)(const NextBelly& next, bool moves);
  /// The static answer to what drives its end alone, and how that moves.
  BellyMotion (*at_rest)(const NextBelly& next);
  /// Going on from what was shown; `keeps`: the state of the modal belly stays as it is.
  Beginning (*go_on)(const NextBelly& next, const PastBelly& past, bool keeps);
};

/// `at_rest` of methods that displace nodes: the template's shape drawn out, with finite strain the one that it
/// replaces.
BellyMotion stretched_at_rest(const NextBelly& next);

/// `computed` and `go_on` of methods whose state is how their nodes move.
std::optional<BellyMotion> nodal_motion(const World& world, Entity muscle, float tick_s, LastReducedBelly& last);
Beginning go_on_as_nodes(const NextBelly& next, const PastBelly& past, bool keeps);

/// One a Method, but for Method::none.
std::span<const DeformationMethod> deformation_methods();
/// Null for Method::none.
const DeformationMethod* deformation_method(Method method);

}  // namespace mobil::inline v0_3
