#pragma once
// Which method each muscle gets, from what a scene needs. A scene says what is good enough: metres for everybody or for
// one person, pixels of a camera, or a time a tick for all deformation together. Each muscle gets the
// cheapest method whose measured error meets it (mobil/systems/accuracy/accuracy_table.h). A scene can change in every
// tick.
//
//   Simulation simulation;
//   Lod lod = simulation.lod();
//   lod.set_scene({.camera = Viewpoint{.position_m = eye, .forward = gaze}, .tolerance_px = 1});
//   lod.prepare();                                           // once: no tick then waits for bases and meshes
//   lod.manage(person);                                       // with leg muscles of its own, or as options say
//   simulation.advance(frame_seconds);                       // chooses and switches
//   lod.why(person, Muscle::hamstrings)->text;                // "modal-8: 0.9 mm of 1.2 mm allowed; …"
//
// It costs nothing unless it manages people, and changes only those. Its decisions are on the person's row
// (mobil/components/lod.h). Its progress is a global of the world. Both are state. With `machine_factor` given, or
// without a budget, decisions depend on that state and the scene alone, not on clocks or threads.

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

/// The camera. Who is in the cone and no further than `reach_m` is seen; who is not in it but within `near_m` of the
/// camera moves on unseen, without control points; everybody else is out of sight or reach, and their muscles are not
/// simulated. People count as balls of 1 m round the pelvis.
struct Viewpoint {
  Vec3<float> position_m{};
  Vec3<float> forward{0, 0, 1};  // any length
  float half_angle_rad = 0.7F;   // of the cone round the picture's corners
  float radians_per_pixel = 0.001F;
  float near_m = 3;
  float reach_m = 200;
};

/// What the scene needs of everybody; LodOverrides overrides it for one person.
struct LodScene {
  MuscleSet muscles = muscle_groups();
  /// How far a control point may be from where it belongs, m. Of a camera: pixels, from which distance makes metres.
  std::optional<float> tolerance_m{};
  std::optional<Viewpoint> camera{};
  float tolerance_px = 1;
  /// Of a camera: managed people who would have to come nearer than this to be seen, m, walkers and camera together,
  /// are awake; others sleep (PersonState::asleep). Who wakes so moves on unseen until they are seen. 2 and more; so
  /// far that what a muscle's beginning excites has died away by then: a second's walk and a second of the camera's.
  /// Left out: nobody is put to sleep, and managed people who sleep wake.
  std::optional<float> asleep_beyond_m{};
  /// Managed walkers of whom nothing is seen are compact (PersonState::compact), as soon as no change of theirs waits,
  /// and full again when something is, or when another method is due. Handles of their muscles come and go with that.
  bool compact_unseen = false;
  bool looked_at = true;  // control points are placed; with a camera those seen are
  /// Processor time a tick for everybody's deformation, but for compact people's, s. Where tolerances cost more, all
  /// are missed by one factor, the least that fits. With neither tolerance nor camera everybody's is 1 mm, and the
  /// factor may be below 1: all of the budget is spent.
  std::optional<double> budget_s{};
};

/// Overrides the scene's needs for one person.
struct LodOverrides {
  std::optional<MuscleSet> muscles{};
  std::optional<float> tolerance_m{};
  std::optional<bool> looked_at{};  // counts as seen, or as near but unseen, whatever the camera sees
};

/// How methods are chosen, and how much may change in one tick.
struct LodOptions {
  /// A cheaper method is taken only where it meets this part of the tolerance; a dearer one at once. 0–1.
  float slack = 0.7F;
  /// Methods changed in one tick, at most; and the time that this may take, s, as predicted (`switch_us` times the
  /// machine's factor), one method at least. Who misses most comes first, then who has the lower entity index.
  std::uint32_t switches = 256;
  double switching_s = 0.001;
  /// People who wake in one tick, and who fall asleep, at most; the nearest wake first.
  std::uint32_t wakes = 3000, sleeps = 3000;
  /// People who woke and get muscles in one tick, at most, who misses most first; and who lose them again as nothing
  /// of them is seen any more.
  std::uint32_t begins = 100;
  /// People who become compact in one tick, and whole again, at most; of the latter those first who miss most.
  std::uint32_t compacts = 200, expands = 3000;
  /// Everybody is looked at every so many looks (`every` says how often one is).
  std::uint32_t stagger = 4;
  /// Factor on predicted errors, for bodies and walks other than the measured ones. Set by
  /// 13 other bodies at 0.8 to 1.9 m/s, with inertia and without (lod_show_test): with 1.25 at least 99.7 % of
  /// ticks kept to a promised tolerance; and at up to 2 m/s of the reference body's height errors were at most 1.93
  /// times the table's, where 2.5 would still be within twice the tolerance. It speaks of muscles that have been
  /// simulated for two seconds: one that is taken up begins at rest, and what that excites falls by e⁻⁴ a second.
  float margin = 1.25F;
  /// How much slower the machine is than the one of the table; left out, it is measured as the simulation runs.
  std::optional<double> machine_factor{};
  /// Seconds that the last tick's deformation took; left out: of the schedule's timings what deforms.
  std::function<double(const Schedule&)> measured_s{};
  /// Of people who get muscles by being managed: all but muscles and method, which are chosen. Of muscles that pull so
  /// are finite shape and tension (active_levels), unless `finite_shape` is false: then linear bellies serve.
  LegMuscles leg_muscles{};
  /// Makes bases that methods lack while ticks go on; with none they are made in the tick that takes them up. Until
  /// `making_ticks` after it was first called for a method is not taken up, and the next coarser one serves: what was
  /// chosen follows from ticks, as long as what was prepared or loaded before is the same. (What is not done by then is
  /// waited for.)
  Background background{};
  std::uint32_t making_ticks = 120;
  /// Ticks from one look to the next.
  std::uint32_t every = 1;
  /// Another table than the library's; must live as long as the simulation, or until other options are set.
  const AccuracyTable* table = nullptr;
};

/// What was chosen in all ticks of the last `advance` or `tick`: how often somebody was looked at; methods changed;
/// refusals; methods that are left for later, and the other figures as of the last tick.
struct LodReport {
  std::size_t evaluated = 0, switched = 0, waiting = 0, refused = 0;
  // People who woke, fell asleep, got the muscles that they woke without, lost muscles that nothing is seen of.
  std::size_t woken = 0, slept = 0, begun = 0, ended = 0;
  std::size_t compacted = 0, expanded = 0;               // people who became compact, and whole again
  std::size_t to_wake = 0, to_begin = 0, to_expand = 0;  // and who are to in the next ticks
  float factor = 1;                                      // by which tolerances are missed under the budget; 1 without
  double machine = 1;                                    // measured over predicted time, as planned by
  double predicted_s = 0;                                // a tick's deformation, as methods now are
  std::string refusal{};                                 // the last that Simulation gave, in one line
};

/// Why a muscle has its method.
enum class Reason : std::uint8_t {
  tolerance,  // the cheapest that meets it (or one dearer, within the hysteresis)
  best,       // none meets it
  budget,     // better would cost more than there is
  out_of_sight,
  out_of_reach,
  not_wanted,
  forced,          // by Lod::force
  refused,         // Simulation refused what was chosen; left as it is until asked again by `manage`
  switch_pending,  // another is chosen, and waits for its turn
};
inline constexpr std::array<std::string_view, 9> reason_name = {"tolerance",    "best there is", "budget",
                                                                "out of sight", "out of reach",  "not wanted",
                                                                "forced",       "refused",       "switch pending"};

/// Why a muscle has the method that it has. `level` is of the lod_table of `active` muscles or of others; costs are of
/// one leg's muscle, a tick; of active ones how much of its volume it has more or less.
struct Choice {
  MuscleMethod method;
  bool active = false;
  std::size_t level = 0;
  float predicted_error_m = 0, tolerance_m = 0, predicted_volume_off = 0;
  double predicted_cost_us = 0;
  Reason reason = Reason::tolerance;
  std::string text;
};

/// Whether a module's systems are part of what a budget is for: bellies, their control points, and what fades after
/// changes of method.
bool is_deformation(std::string_view module);

struct LodWork;  // systems/lod/lod_round.h

/// How finely a simulation computes whose muscles (Simulation::lod). Each tick looks at a part of the managed people,
/// changes methods, wakes who comes into view and puts to sleep who is far from it. Takes memory only as crowds grow
/// and methods change.
class Lod {
 public:
  explicit Lod(const Frame& frame) : frame_(frame) {}

  /// How methods are chosen from now on. Errors, in one line: what is out of range; nothing has changed.
  Result<void> set_options(const LodOptions& options);
  /// What the scene needs, from the next tick on. It is no state: a simulation that restores a snapshot keeps its own.
  /// Errors: a tolerance, budget or camera that is not finite and positive, muscles that are not in the table; nothing
  /// has changed.
  Result<void> set_scene(const LodScene& needs);
  /// What was last set.
  const LodScene& scene() const;

  /// Makes what methods share that the scene, and people with these tolerances of their own, may call for in bodies of
  /// usual build, with the simulation's jobs: then no tick waits for that. With a camera or a budget these are all
  /// methods, some ten seconds of one core; `progress` hears of them, mesh by mesh. Errors: options.leg_muscles out of
  /// range; a tolerance that is not positive; nothing has changed then.
  Result<void> prepare(std::span<const float> own_tolerances_m = {},
                       const std::function<void(std::size_t done, std::size_t of)>& progress = {});

  /// From the next tick on this person's muscles are chosen; asked again, by other needs. A person without
  /// muscles gets those of the needs or the scene, where these name some. Errors: a stale handle, a tolerance that is
  /// not positive, what Simulation::set_muscles refuses.
  Result<void> manage(Entity person, const LodOverrides& needs = {});
  /// The same of many, each named once, with the simulation's jobs. Errors, besides: somebody named twice; nobody is
  /// managed then who was not, nor has other needs.
  Result<void> manage(std::span<const Entity> people, const LodOverrides& needs = {});
  /// The same of many walkers without muscles, who fall asleep at once: they get muscles, and are managed, from waking
  /// on. `options.leg_muscles` and the scene say which. Who cannot fall asleep is managed awake. Returns how many
  /// sleep. Errors: a stale handle, somebody named twice, somebody with muscles, what Simulation::set_muscles
  /// refuses; nothing has changed then.
  Result<std::size_t> manage_asleep(std::span<const Entity> people);
  /// The person is no longer managed; muscles stay as they are, and those that were to come begin. A sleeper wakes.
  /// Errors: a stale handle, somebody who is not managed (Status::missing), what muscles are refused for; nothing has
  /// changed.
  Result<void> release(Entity person);
  /// The same of many, each named once; all or none.
  Result<void> release(std::span<const Entity> people);

  /// A method of the caller's choice, until `unforce`. Errors: someone not managed, what Simulation::set_method
  /// refuses.
  Result<void> force(Entity person, Muscle muscle, const MuscleMethod& method);
  /// The method is chosen again. Errors: a stale handle; Status::missing where the person, or that muscle, is not
  /// managed.
  Result<void> unforce(Entity person, Muscle muscle);

  /// What was chosen in all ticks of the last `advance` or `tick`.
  const LodReport& report() const;
  /// How many muscles have each level of a lod_table, both legs'; last, those with a method that was forced or refused.
  std::array<std::size_t, level_count + 1> muscles_by_level(bool active = false) const;
  /// Why a muscle has its method. Errors: a stale handle; Status::missing where the person is not managed or has no
  /// such muscle.
  Result<Choice> why(Entity person, Muscle muscle) const;

 private:
  LodWork& work() const;

  Frame frame_;
};

}  // namespace mobil::inline v0_3
