#pragma once
// Level of detail: chooses the deformation method of each muscle from the needs of a scene. A scene sets the acceptable
// error, in metres or in pixels of a camera, or the time a tick for all deformation. Each muscle gets the cheapest
// method whose measured error is acceptable (mobil/systems/accuracy/accuracy_table.h). A scene can change every tick.
//
//   Simulation simulation;
//   Lod lod = simulation.lod();
//   lod.set_scene({.camera = Viewpoint{.position_m = eye, .forward = gaze}, .tolerance_px = 1});
//   lod.prepare();                                           // once: no tick then waits for bases and meshes
//   lod.manage(person);                                       // with leg muscles of its own, or those of options
//   simulation.advance(frame_seconds);                       // chooses and switches
//   lod.why(person, Muscle::hamstrings)->text;                // "modal-8: 0.9 mm of 1.2 mm allowed; …"
//
// It costs nothing while it manages no person, and changes managed people only. Decisions are stored on the person's
// row (mobil/components/lod.h), and its progress in a global of the world. Both are state. With a given
// `machine_factor`, or without a budget, decisions depend on that state and the scene alone, not on clocks or threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include <mobil/components/lod.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>
#include <mobil/engine/phase.h>
#include <mobil/muscle_table.h>
#include <mobil/systems/accuracy/accuracy_table.h>
#include <mobil/systems/accuracy/lod_table.h>
#include <mobil/systems/lod/background.h>
#include <mobil/systems/states/lod_state.h>

namespace mobil::inline v0_3 {

/// The camera. A person in the cone and within `reach_m` is seen. A person outside the cone but within `near_m` is
/// simulated unseen, without control points. All other people are out of sight or out of reach, and their muscles are
/// not simulated. A person counts as a ball with a radius of 1 m around the pelvis.
struct Viewpoint {
  Vec3<float> position_m{};
  Vec3<float> forward{0, 0, 1};  // of any length above 0
  float half_angle_rad = 0.7F;   // of the cone through the picture's corners, up to 1.6
  float radians_per_pixel = 0.001F;
  float near_m = 3;
  float reach_m = 200;
};

/// Needs of the scene for all managed people. LodOverrides overrides them for one person.
struct LodScene {
  MuscleSet muscles = muscle_groups();
  /// Maximum error of a control point, m; 1 mm if unset. With a camera, `tolerance_px` and the distance replace it.
  std::optional<float> tolerance_m{};
  std::optional<Viewpoint> camera{};
  float tolerance_px = 1;
  /// Distance, m, by which a managed person and the camera together must approach for the person to be seen. Beyond it
  /// people sleep (PersonState::asleep), and within it they are awake but unseen. It needs a camera and must be at
  /// least 2 m. It should cover one second of the walk plus the camera's motion, in which the initial vibration of a
  /// muscle decays. If unset, no person is put to sleep and managed sleepers wake.
  std::optional<float> asleep_beyond_m{};
  /// True if unseen managed walkers without pending changes become compact (PersonState::compact). They become full
  /// when they are seen or another method is due. Compact people have no muscle handles, and full ones get new handles.
  bool compact_unseen = false;
  bool looked_at = true;  // control points are placed; with a camera, those of seen people
  /// Processor time a tick for the deformation of all people except compact ones, s. If the tolerances cost more, all
  /// of them are exceeded by the smallest common factor that fits. With neither tolerance nor camera the tolerance is
  /// 1 mm, and the factor can be below 1, so that the whole budget is used.
  std::optional<double> budget_s{};
};

/// Needs of one person that override those of the scene.
struct LodOverrides {
  std::optional<MuscleSet> muscles{};
  std::optional<float> tolerance_m{};
  std::optional<bool> looked_at{};  // true: always seen; false: always near but unseen
};

/// Parameters of the choice, and limits of the changes in one tick.
struct LodOptions {
  /// Hysteresis: a cheaper method must meet this fraction of the tolerance, 0 to 1. A dearer one is taken at once.
  float slack = 0.7F;
  /// Maximum number of methods changed in one tick, and their maximum predicted time, s (`switch_us` times the
  /// machine's factor). At least one method changes. Muscles that exceed their tolerance most come first, then those of
  /// the person with the lower entity index.
  std::uint32_t switches = 256;
  double switching_s = 0.001;
  /// Maximum numbers of people who wake and of people who fall asleep in one tick. The nearest wake first.
  std::uint32_t wakes = 3000, sleeps = 3000;
  /// Maximum number of people in one tick who get the muscles that they woke without, and of those who lose them
  /// because nothing of them is seen. People who exceed their tolerance most get them first.
  std::uint32_t begins = 100;
  /// Maximum numbers of people who become compact and full in one tick. Those over their tolerance most expand first.
  std::uint32_t compacts = 200, expands = 3000;
  /// Number of updates in which all people are evaluated once (`every` is the interval of updates).
  std::uint32_t stagger = 4;
  /// Safety factor on predicted errors, for bodies and walks that differ from the measured ones. It was set by 13 other
  /// bodies at 0.8 to 1.9 m/s, with and without inertia (lod_show_test). With 1.25, at least 99.7 % of ticks met the
  /// promised tolerance. For bodies of the reference height at up to 2 m/s errors were at most 1.93 times the table's;
  /// 2.5 times would still be within twice the tolerance. It holds for muscles simulated for at least two seconds: they
  /// start at rest, and that vibration decays by a factor of e⁻⁴ a second.
  float margin = 1.25F;
  /// Time of this machine over that of the table's machine. If unset, it is measured while the simulation runs.
  std::optional<double> machine_factor{};
  /// Returns the time of the last tick's deformation, s. If unset, the schedule's timings of `is_deformation` are used.
  std::function<double(const Schedule&)> measured_s{};
  /// Muscles of people who get them from `manage`, except which muscles and which method: those are chosen. Levels of
  /// active muscles set finite shape and tension (active_levels). If `finite_shape` is false, linear bellies are used.
  LegMuscles leg_muscles{};
  /// Makes missing bases while ticks run. If unset, a basis is made in the tick that first uses it. With it, a method
  /// is usable `making_ticks` after its first request, and the next coarser one is used until then. Choices therefore
  /// depend on ticks alone, if the same bases were prepared or loaded before. A basis that is late is waited for.
  Background background{};
  std::uint32_t making_ticks = 120;
  /// Number of ticks from one update to the next.
  std::uint32_t every = 1;
  /// Table used instead of the library's. It must stay valid as long as the simulation, or until other options are set.
  const AccuracyTable* table = nullptr;
};

/// Counts of all ticks of the last `advance` or `tick`. `waiting`, the queues and the figures below them are of the
/// last tick.
struct LodReport {
  // People evaluated, methods changed, methods left for later, and changes that Simulation refused.
  std::size_t evaluated = 0, switched = 0, waiting = 0, refused = 0;
  // People who woke, fell asleep, got the muscles that they woke without, and lost muscles that are not seen.
  std::size_t woken = 0, slept = 0, begun = 0, ended = 0;
  std::size_t compacted = 0, expanded = 0;               // people who became compact, and full
  std::size_t to_wake = 0, to_begin = 0, to_expand = 0;  // people queued for the next ticks
  float factor = 1;                                      // by which tolerances are exceeded under the budget
  double machine = 1;                                    // measured over predicted time, as used for planning
  double predicted_s = 0;                                // time of a tick's deformation with the present methods
  std::string refusal{};                                 // message of the last refusal
};

/// Reason for a muscle's method.
enum class Reason : std::uint8_t {
  tolerance,  // the cheapest method within the tolerance, or a dearer one within the hysteresis
  best,       // the method with the smallest error, which exceeds the tolerance
  budget,     // a better method would exceed the budget
  out_of_sight,
  out_of_reach,
  not_wanted,
  forced,          // by Lod::force
  refused,         // Simulation refused the chosen method; unchanged until the next `manage`
  switch_pending,  // the chosen method waits for its turn
};
inline constexpr std::array<std::string_view, 9> reason_name = {"tolerance",    "best there is", "budget",
                                                                "out of sight", "out of reach",  "not wanted",
                                                                "forced",       "refused",       "switch pending"};

/// A muscle's method and the reason for it. `level` is an index into `active_levels` if `active`, or else into
/// `levels`. The cost is of one leg's muscle a tick. `predicted_volume_off` is the relative error of an active muscle's
/// volume.
struct Choice {
  MuscleMethod method;
  bool active = false;
  std::size_t level = 0;
  float predicted_error_m = 0, tolerance_m = 0, predicted_volume_off = 0;
  double predicted_cost_us = 0;
  Reason reason = Reason::tolerance;
  std::string text;
};

/// Returns true for modules whose time counts toward the budget: bellies, their control points, and fading after
/// changes of method.
bool is_deformation(std::string_view module);

struct LodWork;  // systems/lod/lod_round.h

/// Interface to a simulation's level of detail (Simulation::lod). Each update evaluates a part of the managed people,
/// changes methods, wakes people who come into view and puts distant ones to sleep. It allocates only when crowds grow
/// or methods change. A call that fails changes nothing.
class Lod {
 public:
  explicit Lod(const Frame& frame) : frame_(frame) {}

  /// Sets the parameters of the choice from now on. Errors: a value out of range.
  Result<void> set_options(const LodOptions& options);
  /// Sets the needs of the scene from the next tick on. They are not state: a simulation that restores a snapshot keeps
  /// its own. Errors: a tolerance, budget or camera that is not finite and positive, `asleep_beyond_m` below 2 m or
  /// without a camera, muscles that are not in the table.
  Result<void> set_scene(const LodScene& needs);
  /// Returns the needs that were last set.
  const LodScene& scene() const;

  /// Makes the shared data of all methods that the scene, and people with these tolerances, can require of bodies of
  /// usual build, in parallel. No tick then waits for it. With a camera or a budget these are all methods, some ten
  /// seconds of one core. `progress` is called before each of them. Errors: `options.leg_muscles` out of range, a
  /// tolerance that is not positive.
  Result<void> prepare(std::span<const float> own_tolerances_m = {},
                       const std::function<void(std::size_t done, std::size_t of)>& progress = {});

  /// Manages a person's muscles from the next tick on. A second call replaces `needs`. A person without muscles gets
  /// those of `needs` or the scene, if any. A sleeper or compact person becomes full. Errors: a stale handle, a
  /// tolerance that is not positive, the errors of Simulation::set_muscles.
  Result<void> manage(Entity person, const LodOverrides& needs = {});
  /// Manages many people in parallel, all or none. Errors: those of one person, a person named twice.
  Result<void> manage(std::span<const Entity> people, const LodOverrides& needs = {});
  /// Manages walkers without muscles and puts them to sleep at once. They get muscles when they wake, as
  /// `options.leg_muscles` and the scene have them. A walker who cannot fall asleep is managed awake. Returns the
  /// number of sleepers. Errors: a stale handle, a person named twice, a person with muscles, the errors of
  /// Simulation::set_muscles.
  Result<std::size_t> manage_asleep(std::span<const Entity> people);
  /// Stops managing a person. Muscles keep their method, and those still to come begin. A sleeper wakes. Errors: a
  /// stale handle, a person who is not managed (Status::missing), the errors of muscles that begin.
  Result<void> release(Entity person);
  /// Stops managing many people, all or none. Errors: those of one person, a person named twice.
  Result<void> release(std::span<const Entity> people);

  /// Sets the method of one muscle until `unforce`. Errors: a person or muscle that is not managed, the errors of
  /// Simulation::set_method.
  Result<void> force(Entity person, Muscle muscle, const MuscleMethod& method);
  /// Returns the choice of a forced method to level of detail. Errors: a stale handle; Status::missing if the person or
  /// that muscle is not managed.
  Result<void> unforce(Entity person, Muscle muscle);

  /// Returns the counts of all ticks of the last `advance` or `tick`.
  const LodReport& report() const;
  /// Returns the number of muscles at each level, both legs, of active muscles or of others. The last element counts
  /// forced and refused methods.
  std::array<std::size_t, level_count + 1> muscles_by_level(bool active = false) const;
  /// Returns a muscle's method and the reason for it. Errors: a stale handle; Status::missing if the person is not
  /// managed or has no such muscle.
  Result<Choice> why(Entity person, Muscle muscle) const;

 private:
  LodWork& work() const;

  Frame frame_;
};

}  // namespace mobil::inline v0_3
