#pragma once
// Level of detail: chooses the deformation method of each muscle from the needs of a scene. A scene sets the acceptable
// error, in metres or in pixels of a camera, or a time budget for all deformation in a tick. Each muscle gets the
// cheapest method whose measured error is acceptable (mobil/systems/accuracy/accuracy_table.h). A scene can change
// every tick.
//
//   Simulation simulation;
//   Lod lod = simulation.lod();
//   lod.set_scene({.camera = Viewpoint{.position_m = eye, .forward = gaze}, .tolerance_px = 1});
//   lod.prepare();                                           // once: no tick then waits for bases and meshes
//   lod.manage(person);                                       // adds the scene's muscles if the person has none
//   simulation.advance(frame_seconds);                       // chooses and switches
//   lod.why(person, Muscle::hamstrings)->text;                // "modal-8: 0.9 mm of 1.2 mm allowed; …"
//
// It costs nothing while it manages no person, and it changes managed people only. Decisions about a person are stored
// on the person's row (mobil/components/lod.h). The progress of its updates is stored in a global of the world
// (LodProgress). Both are state. With a given `machine_factor`, or without a budget, decisions depend only on that
// state, the scene and the options, and not on clocks or threads.

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
  float half_angle_rad = 0.7F;   // between `forward` and a corner of the picture, up to 1.6
  float radians_per_pixel = 0.001F;
  float near_m = 3;
  float reach_m = 200;
};

/// Needs of the scene for all managed people. LodOverrides overrides them for one person.
struct LodScene {
  MuscleSet muscles = usual_muscles();
  /// Maximum error of a control point, m; 1 mm if unset. With a camera, `tolerance_px` and the distance replace it.
  std::optional<float> tolerance_m{};
  std::optional<Viewpoint> camera{};
  float tolerance_px = 1;
  /// Sleep threshold, m. A person's distance from view is the distance that person and camera together must move until
  /// the person is seen or near. Beyond the threshold managed people sleep (PersonState::asleep); within it they are
  /// awake. The threshold needs a camera and must be at least 2 m. It should cover the motion of walker and camera in
  /// one second, because the initial vibration of a muscle takes that long to decay. If unset, no person is put to
  /// sleep and managed sleepers wake.
  std::optional<float> asleep_beyond_m{};
  /// True if unseen managed walkers become compact (PersonState::compact) once no change of method is pending. They
  /// become full when they are seen or a change of method is due. Compact people have no muscle handles, and full ones
  /// get new handles.
  bool compact_unseen = false;
  bool looked_at = true;  // control points are placed; with a camera, those of seen people
  /// Processor time a tick for the deformation of all people except compact ones, s. If the methods that meet all
  /// tolerances cost more, all tolerances are multiplied by the smallest common factor that keeps the budget. With
  /// neither tolerance nor camera the tolerance is 1 mm. The factor can then be below 1, so that the whole budget is
  /// used.
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
  /// Sleepers wake without muscles. Maximum number of woken people who get muscles in one tick, and of people who lose
  /// muscles because none of them is seen. People who exceed their tolerance most get them first.
  std::uint32_t begins = 100;
  /// Maximum numbers of people who become compact, and of people who become full again, in one tick. People who exceed
  /// their tolerance most become full first.
  std::uint32_t compacts = 200, expands = 3000;
  /// Number of updates after which all people have been evaluated once (`every` is the interval between updates).
  std::uint32_t stagger = 4;
  /// Safety factor on predicted errors, for bodies and walks that differ from the measured ones. The default was chosen
  /// with 13 other bodies at 0.8 to 1.9 m/s, with and without inertia (lod_show_test). At least 99.7 % of ticks met the
  /// tolerance. For bodies of the reference height at up to 2 m/s errors were at most 1.93 times those of the table. An
  /// error of 2.5 times the table's would be twice the tolerance. The margin holds for muscles simulated for at least
  /// two seconds. Muscles start at rest, and the resulting vibration decays by a factor of e⁻⁴ a second.
  float margin = 1.25F;
  /// Time that this machine takes, relative to the machine of the table. If unset, it is measured while the simulation
  /// runs.
  std::optional<double> machine_factor{};
  /// Returns the time of the last tick's deformation, s. If unset, the schedule's timings of `is_deformation` are used.
  std::function<double(const Schedule&)> measured_s{};
  /// Options of the muscles that `manage` adds. Its fields `muscles`, `method` and `modal` are ignored, because the
  /// scene and level of detail set them. For active muscles the level also sets `finite_shape` and `modal.tuned`
  /// (active_levels), unless `finite_shape` is false; then bellies are linear.
  LegMuscles leg_muscles{};
  /// Executor that makes missing bases while ticks run. If unset, a basis is made in the tick that first uses it. With
  /// an executor, a method becomes usable `making_ticks` after its first request, and the next coarser one is used
  /// until then. Choices therefore depend on ticks and not on the executor's speed, if the same bases were prepared or
  /// loaded before. A tick waits for a basis that is not ready in time.
  Background background{};
  std::uint32_t making_ticks = 120;
  /// Number of ticks from one update to the next.
  std::uint32_t every = 1;
  /// Table used instead of the library's. It must stay valid as long as the simulation, or until other options are set.
  const AccuracyTable* table = nullptr;
};

/// Counts of all ticks of the last `advance` or `tick`. `waiting`, the counts `to_…`, `factor`, `machine` and
/// `predicted_s` are of the last tick.
struct LodReport {
  // People evaluated, methods changed, methods left for later, and changes that Simulation refused.
  std::size_t evaluated = 0, switched = 0, waiting = 0, refused = 0;
  // People who woke, fell asleep, got the muscles that they woke without, and lost muscles that are not seen.
  std::size_t woken = 0, slept = 0, begun = 0, ended = 0;
  std::size_t compacted = 0, expanded = 0;               // people who became compact, and full
  std::size_t to_wake = 0, to_begin = 0, to_expand = 0;  // people who wait for a later tick
  float factor = 1;                                      // by which the budget multiplies all tolerances
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
/// `levels`. `predicted_cost_us` is the cost of the muscle of one leg in a tick. `predicted_volume_off` is the relative
/// error of an active muscle's volume.
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

  /// Makes the shared data of methods in parallel, for bodies of usual build, so that no tick waits for it. It covers
  /// all methods that the scene, or people with these tolerances, can require. With a camera or a budget these are all
  /// methods, which take about ten seconds of one core. `progress` is called before each method. Errors:
  /// `options.leg_muscles` out of range, a tolerance that is not positive.
  Result<void> prepare(std::span<const float> own_tolerances_m = {},
                       const std::function<void(std::size_t done, std::size_t of)>& progress = {});

  /// Manages a person's muscles from the next tick on. A second call replaces `needs`. A person without muscles gets
  /// those of `needs` or the scene, if any. A sleeper or compact person becomes full. Errors: a stale handle, a
  /// tolerance that is not positive, the errors of Simulation::set_muscles.
  Result<void> manage(Entity person, const LodOverrides& needs = {});
  /// Manages many people in parallel, all or none. Errors: those of one person, a person named twice.
  Result<void> manage(std::span<const Entity> people, const LodOverrides& needs = {});
  /// Manages walkers without muscles and puts them to sleep at once. When they wake, they get the muscles of the scene
  /// with the options of LodOptions::leg_muscles. A walker who cannot fall asleep is managed awake. Returns the number
  /// of sleepers. Errors: a stale handle, a person named twice, a person with muscles, the errors of
  /// Simulation::set_muscles.
  Result<std::size_t> manage_asleep(std::span<const Entity> people);
  /// Stops managing a person. Muscles keep their method, and a person who woke without muscles gets them. A sleeper
  /// wakes. Errors: a stale handle, a person who is not managed (Status::missing), the errors of muscles that begin.
  Result<void> release(Entity person);
  /// Stops managing many people, all or none. Errors: those of one person, a person named twice.
  Result<void> release(std::span<const Entity> people);

  /// Sets the method of one muscle until `unforce`. Errors: a person or muscle that is not managed, the errors of
  /// Simulation::set_method.
  Result<void> force(Entity person, Muscle muscle, const MuscleMethod& method);
  /// Lets level of detail choose the method of a forced muscle again. Errors: a stale handle; Status::missing if the
  /// person or that muscle is not managed.
  Result<void> unforce(Entity person, Muscle muscle);

  /// Returns the counts of all ticks of the last `advance` or `tick`.
  const LodReport& report() const;
  /// Returns the number of muscles at each level, counted in both legs: of active muscles, or of all others. The last
  /// element counts muscles with a forced or refused method.
  std::array<std::size_t, level_count + 1> muscles_by_level(bool active = false) const;
  /// Returns a muscle's method and the reason for it. Errors: a stale handle; Status::missing if the person is not
  /// managed or has no such muscle.
  Result<Choice> why(Entity person, Muscle muscle) const;

 private:
  LodWork& work() const;

  Frame frame_;
};

}  // namespace mobil::inline v0_3
