#pragma once
// What can be chosen of leg muscles: which, by what method, of what tissue, with which effects.

#include <cstdint>
#include <optional>

#include <mobil/components/activation.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// How the far end of a belly is driven: `displacement` makes it follow the line of action exactly, `force` pulls it
/// with the spring force of the paper's equations 2 and 3.
enum class Drive : std::uint8_t { displacement, force };

/// Bellies that move along a few modes of a finer mesh (Method::modal).
struct ModalOptions {
  std::uint32_t modes = 12;    // 1–32
  bool moving = true;          // false: the static answer alone, which has no state
  bool corrected = true;       // the mesh's own error extrapolated away (assets/reduction/modal_basis.h)
  Cells cells = {4, 4, 16};    // of the mesh that the modes are of; has all nodes of LegMuscles::cells
  /// Whether someone looks: control points are placed (NodalDisplacement). Without, the state alone goes on.
  bool control_points = true;
  /// Whether BellyReport is written, which takes more than half as long as placing the control points.
  bool reported = true;
  /// Whether what moves is stiffened and damped by how hard the muscle pulls (LegMuscles::activation). The slowest
  /// motion of a belly that fascia holds at 7 Hz rises from 4 or 5 Hz to 13 or 15 at full activation; damping is 16 to
  /// 76 1/s instead of LegMuscles::damping_per_s.
  bool tuned = false;
  /// Whether control points are where linear statics has them, even where LegMuscles::finite_shape says otherwise.
  bool linear_shape = false;

  friend bool operator==(const ModalOptions&, const ModalOptions&) = default;
};

/// How one muscle is simulated, at its person's other choices.
struct MuscleMethod {
  Method method = Method::explicit_central;
  ModalOptions modal{};  // of Method::modal
};

/// Whether its tension stiffens it: of modal bellies that move.
constexpr bool is_tuned(const MuscleMethod& method) {
  return method.method == Method::modal && method.modal.moving && method.modal.tuned;
}

/// Alike in all that the method depends on. Whose control points are linear anyway is alike with and without
/// ModalOptions::linear_shape: of such a muscle Simulation::method answers with what it was chosen as.
inline bool same_method(const MuscleMethod& a, MuscleMethod b) {
  if (a.method != b.method || a.method != Method::modal) return a.method == b.method;
  if (is_tuned(a) == is_tuned(b)) b.modal.tuned = a.modal.tuned;
  if (!a.modal.control_points) b.modal.linear_shape = a.modal.linear_shape;
  return a.modal == b.modal;
}

/// Cells for close-ups, with all nodes of the paper's {2, 2, 8}.
inline constexpr Cells close_up_cells = {4, 4, 16};

/// How leg muscles deform. Every choice is a matter of which parts a muscle has (systems/muscles/muscle_parts.h).
struct LegMuscles {
  /// Which ones: the groups unless a scene comes close (muscle_members()) or calls for few.
  MuscleSet muscles{(1U << muscle_group_count) - 1};
  Drive drive = Drive::displacement;
  Method method = Method::explicit_central;
  ModalOptions modal{};  // of Method::modal
  Material material{};
  Element element = Element::full;  // but of Method::finite, whose elements have one point
  Mass mass = Mass::lumped;         // of CAA; ECD's is lumped, ICD's consistent, static has none
  double damping_per_s = 8;         // Rayleigh's α, 0–1000; not of what is tuned, or finite with activation
  double stiffness_damping_s = 0;   // Rayleigh's β, 0–1
  bool inertia = false;             // gravity and the acceleration of the muscle's frame
  bool line_motion = false;         // lengthening speed and moment arms: component LineMotion
  /// Muscles that pull: components Activation, Musculotendon. The tendon stretches, and the belly gets what it leaves.
  /// ExcitationSource::moments needs the person's forces (Feature::forces), and gives its row MomentReserve.
  ExcitationSource activation = ExcitationSource::none;
  /// Control points are where tissue at finite strain has them (nearly incompressible, short and thick where it pulls),
  /// not where linear statics do; the method's vibration goes on about that. Left out: where there is activation.
  /// Method::finite needs none, and takes none.
  std::optional<bool> finite_shape{};
  /// Fascia and neighbours as an elastic foundation sideways, (2πf)² times the mass, 0–1000 Hz. Left out: of single
  /// muscles that are drawn by displacement 7 Hz, on the shank 12, for what is long, thin and bent bows aside like a
  /// strut without; of groups that pull the same; of others 7 Hz with inertia, where a belly would sag by its own
  /// length, and none otherwise.
  std::optional<double> foundation_hz{};
  /// 81 nodes, the paper's choice for real time; meshes of {4, 4, 16}, {8, 8, 32} … have all its nodes. Method::finite
  /// wants close_up_cells: on 81 nodes it shows no better shape than finite_shape on a linear method.
  Cells cells = {2, 2, 8};
  /// Longest step; a tick is cut into equal ones no longer than that. Left out: of ECD, ICD and finite 0.9 of each
  /// individual's own critical step, of CAA the tick. Static has no steps.
  std::optional<double> dt_s{};

  friend bool operator==(const LegMuscles&, const LegMuscles&) = default;
};

/// Whether a muscle of this choice has control points (NodalDisplacement); whether these are reported (BellyReport);
/// whether it feels its frame's motion (FrameLoad); and whether it pulls (Activation).
constexpr bool has_control_points(const LegMuscles& choice) {
  return choice.method != Method::none && (choice.method != Method::modal || choice.modal.control_points);
}
constexpr bool is_reported(const LegMuscles& choice) {
  return has_control_points(choice) && (choice.method != Method::modal || choice.modal.reported);
}
constexpr bool feels_frame(const LegMuscles& choice) {
  const bool moves = choice.method == Method::modal && choice.modal.moving;
  return choice.inertia && (moves || has_control_points(choice));
}
constexpr bool has_activation(const LegMuscles& choice) {
  return choice.activation != ExcitationSource::none;
}
constexpr bool is_tuned(const LegMuscles& choice) {
  return is_tuned(MuscleMethod{choice.method, choice.modal});
}
/// Whether its control points are those of finite strain on top of a linear method.
constexpr bool has_finite_shape(const LegMuscles& choice) {
  const bool linear = choice.method == Method::modal && choice.modal.linear_shape;
  return has_control_points(choice) && !linear && choice.method != Method::finite &&
         choice.finite_shape.value_or(has_activation(choice));
}
/// What the far end of its belly may do: held or sliding.
constexpr FarEnd far_end_of(const LegMuscles& choice) {
  return choice.drive == Drive::displacement ? FarEnd::held : FarEnd::sliding;
}

}  // namespace mobil::inline v0_3
