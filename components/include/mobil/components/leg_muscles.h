#pragma once
// Options of leg muscles: the muscles themselves, method, tissue and effects.

#include <cstdint>
#include <optional>

#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// Drive of the far end of a belly. With `displacement` it follows the line of action exactly; with `force` it is
/// pulled with the spring force of the paper's equations 2 and 3.
enum class Drive : std::uint8_t { displacement, force };

/// Bellies that move along a few modes of a finer mesh (Method::modal).
struct ModalOptions {
  std::uint32_t modes = 12;  // 1–32
  bool moving = true;        // false: static solution only, without state
  bool corrected = true;     // extrapolates the mesh's own error away (assets/reduction/modal_basis.h)
  Cells cells = {4, 4, 16};  // of the modes' mesh, which has all nodes of LegMuscles::cells
  /// Control points are placed (NodalDisplacement). Without them only the state is advanced.
  bool control_points = true;
  /// BellyReport is written, at more than half the cost of placing the control points.
  bool reported = true;
  /// Activation stiffens and damps moving modes (LegMuscles::activation). The slowest motion of a belly that fascia
  /// holds at 7 Hz rises from 4 or 5 Hz to 13 or 15 at full activation. Damping is 16 to 76 1/s instead of
  /// LegMuscles::damping_per_s.
  bool tuned = false;
  /// Control points follow linear statics, even if LegMuscles::finite_shape requests finite strain.
  bool linear_shape = false;

  friend bool operator==(const ModalOptions&, const ModalOptions&) = default;
};

/// Method of one muscle; its person's other options apply to it as well.
struct MuscleMethod {
  Method method = Method::explicit_central;
  ModalOptions modal{};  // for Method::modal
};

/// Returns true for moving modal bellies that activation stiffens.
constexpr bool is_tuned(const MuscleMethod& method) {
  return method.method == Method::modal && method.modal.moving && method.modal.tuned;
}

/// Returns true if two methods agree in all that affects the result. `tuned` counts only for moving modes,
/// ModalOptions::linear_shape only with control points.
inline bool same_method(const MuscleMethod& a, MuscleMethod b) {
  if (a.method != b.method || a.method != Method::modal) return a.method == b.method;
  if (is_tuned(a) == is_tuned(b)) b.modal.tuned = a.modal.tuned;
  if (!a.modal.control_points) b.modal.linear_shape = a.modal.linear_shape;
  return a.modal == b.modal;
}

/// Cells for close-ups, with all nodes of the paper's {2, 2, 8}.
inline constexpr Cells close_up_cells = {4, 4, 16};

/// Options of leg muscles. Each is implemented by the parts that a muscle's row has (systems/muscles/muscle_parts.h).
struct LegMuscles {
  /// Simulated muscles: the groups, unless a scene shows close-ups (muscle_members()) or needs only a few.
  MuscleSet muscles{(1U << usual_muscle_count) - 1};
  Drive drive = Drive::displacement;
  Method method = Method::explicit_central;
  ModalOptions modal{};  // for Method::modal
  Material material{};
  Element element = Element::full;  // not used by Method::finite, whose elements have one point
  Mass mass = Mass::lumped;         // of CAA; ECD's is lumped, ICD's consistent, static has none
  double damping_per_s = 8;         // Rayleigh's α, 0–1000; not for tuned modes, or finite with activation
  double stiffness_damping_s = 0;   // Rayleigh's β, 0–1
  bool inertia = false;             // gravity and the acceleration of the muscle's frame
  bool line_motion = false;         // lengthening speed and moment arms: component LineMotion
  /// Active muscles: components Activation, Musculotendon. The tendon stretches, and the belly takes the rest.
  /// ExcitationSource::moments needs the person's forces (Feature::forces), and adds MomentReserve to that row.
  ExcitationSource activation = ExcitationSource::none;
  /// Control points show tissue at finite strain (nearly incompressible, short and thick where active) instead of
  /// linear statics. The method's vibration is added to that shape. Default: on with activation. Method::finite ignores
  /// it.
  std::optional<bool> finite_shape{};
  /// Fascia and neighbours as an elastic foundation sideways, (2πf)² times the mass, 0–1000 Hz. Default for single
  /// muscles and active groups, if driven by displacement or with inertia: 7 Hz, on the shank 12 Hz, because long,
  /// thin, bent bellies would buckle. Default for others: 7 Hz with inertia, because a belly would sag by its own
  /// length; else none.
  std::optional<double> foundation_hz{};
  /// 81 nodes, the paper's choice for real time; meshes of {4, 4, 16}, {8, 8, 32} … have all its nodes. Method::finite
  /// needs close_up_cells: on 81 nodes its shape is not better than finite_shape on a linear method.
  Cells cells = {2, 2, 8};
  /// Longest step; a tick is divided into equal steps of at most that length. Default: 0.9 of each individual's own
  /// critical step for ECD, ICD and finite, the tick for CAA. Static has no steps.
  std::optional<double> dt_s{};

  friend bool operator==(const LegMuscles&, const LegMuscles&) = default;
};

/// Return true if a muscle with these options has control points (NodalDisplacement), is reported (BellyReport), is
/// loaded by its frame's motion (FrameLoad), or is active (Activation).
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
/// Returns true if control points show finite strain on top of a linear method.
constexpr bool has_finite_shape(const LegMuscles& choice) {
  const bool linear = choice.method == Method::modal && choice.modal.linear_shape;
  return has_control_points(choice) && !linear && choice.method != Method::finite &&
         choice.finite_shape.value_or(has_activation(choice));
}
/// Returns the condition at the belly's far end: held or sliding.
constexpr FarEnd far_end_of(const LegMuscles& choice) {
  return choice.drive == Drive::displacement ? FarEnd::held : FarEnd::sliding;
}

}  // namespace mobil::inline v0_3
