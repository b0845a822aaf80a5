#pragma once
// The main interface: spawns people, gives them muscles, advances time and returns results.
//
//   Simulation simulation;
//   const Entity person = *simulation.spawn({.height_m = 1.80F, .mass_kg = 80});
//   simulation.set_muscles(person);
//   simulation.advance(frame_seconds);
//   simulation.get<Pose>(person)->position_m[index(Segment::head)];
//
// Data is stored in tables. `world()` gives read access to all components (mobil/engine/world.h; mobil/each.h reads
// them in blocks), and `schedule()` lists all systems in the order in which they run. All state belongs to a
// simulation, so a program can have any number of them.
//
// Threads: one thread at a time can change a simulation. Between changes any number of threads can call its const
// functions, except `save`, `snapshot_bytes`, `state_hash` and `state_sum`, which use the simulation's jobs or cache
// results. Each reading thread needs its own PoseWriter and SurfaceWriter.
//
// Errors: a call that can fail returns a Result, which is the value or an Error. An Error has a status code for the
// program and a one-line message for the user. A failed call changes nothing. (World and Schedule return the status
// code alone.)
//
// Memory: if it runs out while people are spawned or changed, std::bad_alloc is thrown and the simulation is unchanged,
// including future handles. Despawning never allocates.

#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/components/pose.h>
#include <mobil/engine/clock.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/systems/muscles/muscle_ref.h>
#include <mobil/systems/people/people.h>

namespace mobil::inline v0_3 {

class Simulation;

/// Time, threads, memory and modules of a simulation.
struct SimulationOptions {
  double tick_s = 1.0 / 60;    // 1e-5 to 1; above 0.25 fast walkers lose distance (one step a tick at most)
  double max_frame_s = 0.25;   // one tick to 60 s; the excess of a longer frame is dropped
  int threads = 1;             // size of the built-in pool; 0: one for each hardware thread
  std::optional<Jobs> jobs{};  // the host's job system, used instead of the pool
  /// Allocates everything that scales with the number of people: tables, handles, scratch memory. The heap is used for
  /// meshes and bases that bodies share, for temporaries of a call, and by level of detail, avoidance and terrain.
  std::pmr::memory_resource* memory = std::pmr::get_default_resource();
  /// The host's own modules (mobil/engine/module.h). They follow the library's modules.
  std::vector<Module> modules{};
  /// Another simulation whose meshes, solvers and bases this one shares. Simulations that share a library must not add
  /// to it concurrently. These calls add to it: `prepare`, `load`, setting muscles or methods, waking or restoring
  /// people, and ticks with level of detail.
  const Simulation* library_of = nullptr;
};

/// Motion from a posed person's last pose to the new one. `jumped` is a jump: muscles and fat feel no acceleration from
/// it.
enum class Arrival : std::uint8_t { moved, jumped };

class Avoidance;       // mobil/avoidance.h
class HostParts;       // mobil/host_parts.h
class Lod;             // mobil/lod.h
class MuscleLibrary;   // mobil/muscle_library.h
struct Person;         // mobil/systems/muscles/person.h
struct RestoreLimits;  // mobil/systems/snapshot/restore_limits.h
struct Root;           // mobil/systems/poses/roots.h
class Schedule;        // mobil/schedule.h
struct StepEvent;      // mobil/systems/people/step_event.h
struct StepReport;     // mobil/step_report.h
struct StyleChange;    // mobil/systems/limits/style_limits.h
class Terrain;         // mobil/terrain.h
class World;           // mobil/engine/world.h

class Simulation {
 public:
  /// Creates a simulation. Errors: `tick_s` or `max_frame_s` out of range (mobil/engine/clock.h), a module that
  /// conflicts with another one (mobil/engine/module.h).
  static Result<Simulation> make(const SimulationOptions& options = {});
  /// Creates a simulation like `make`, but throws std::invalid_argument with the message of the error.
  explicit Simulation(const SimulationOptions& options = {});
  ~Simulation();
  /// Moves a simulation. A moved-from one can only be destroyed or assigned to. References to its World stay valid.
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Spawns a walker at the origin, at right heel strike, heading toward +Z. Errors: a body or a gait that is out of
  /// range or unreachable.
  Result<Entity> spawn(const BodyRequest& body, const GaitRequest& gait = {});
  /// Spawns a person whose skeleton the host animates, in the anatomical position at the origin. Gait and kinematics do
  /// not run for posed people. Errors: a body out of range.
  Result<Entity> spawn_posed(const BodyRequest& body);
  /// Sets a posed person's skeleton for the end of the next tick (m, world frame). The pose is used without
  /// corrections, and leg muscles follow it. Muscles with inertia and wobbling fat feel the motion from the last pose
  /// to this one, unless the pose has `jumped`. Errors: a stale handle, a walker (Status::missing), a position not
  /// within 1000 km or a quaternion whose length is not 1 within 1 %, with the segment's name; the old pose then stays.
  Result<void> set_pose(Entity person, const Pose<float>& pose, Arrival arrival = Arrival::moved);
  /// Removes a person and their muscles. Their handles become stale. Errors: a stale handle.
  Result<void> despawn(Entity person);

  /// Spawns many walkers in parallel. The state has the same bits as after spawning them one by one, at a fraction of
  /// the cost. `entities` receives the handles and must be as long as `people`. All or none: an error states the index
  /// of the person, and `entities` is then unspecified.
  Result<void> spawn(std::span<const SpawnRequest> people, std::span<Entity> entities);
  /// Removes many people, all or none. Errors: a stale handle, a person named twice.
  Result<void> despawn(std::span<const Entity> people);
  /// Changes parts of a walker's gait from the next step on. Unset fields keep their value, including the style. A
  /// large change of speed takes several steps. Speed 0 stops the walker, and a positive one starts it again. Errors: a
  /// stale handle, a posed person, a gait out of range.
  Result<void> change_gait(Entity person, const GaitChange& change);
  /// Replaces a walker's whole gait from the next step on. Unset fields have the defaults of GaitRequest{}. Errors:
  /// those of `change_gait`.
  Result<void> set_gait(Entity person, const GaitRequest& gait);
  /// Returns the requested gait in the form that `set_gait` takes; nothing for a stale handle or a posed person.
  std::optional<GaitRequest> gait_request(Entity person) const;
  /// Turns a walker to a heading (rad about +Y, 0 toward +Z, positive to the left) by the shorter way, over several
  /// steps. A standing walker turns on the spot. Errors: a stale handle, a posed person, a heading not within ±10000.
  Result<void> turn_to(Entity person, float heading_rad);
  /// Changes gaits and headings of many walkers in parallel. Skips people who cannot walk as requested (a gait out of
  /// range, a posed person), and returns the number of skipped people. Errors: a stale handle, a person named twice.
  Result<std::size_t> change_gait(std::span<const WalkChange> changes);
  /// Makes a standing walker step `left_m` to the left and `ahead_m` ahead; negative values are right and back. The
  /// limits for a leg of 0.85 m are ±0.25 m sideways and ±0.20 m ahead, in proportion to leg length. The motion begins
  /// within 0.25 s and takes two steps of 0.3 to 0.5 s. Errors: a stale handle, a posed person, a walker with a
  /// requested speed above 0, a displacement out of range.
  Result<void> step_aside(Entity person, float left_m, float ahead_m);

  /// Changes people to a state where PersonState permits it, and returns how many of them are in that state now. A
  /// compact person who cannot fall asleep becomes full. Level of detail stops managing people whom this puts to sleep.
  ///
  /// `full` wakes sleepers and expands compact people. A sleeper's new muscles have control points within `within_m` of
  /// those of a person who was never asleep. To achieve this, the call simulates the last 0.5 s (5 mm), 1 s (1 mm) or
  /// 2.1 s (4 µm) of the walk. This costs 0.6 µs a tick and person. Muscles start at rest instead, at the person's
  /// phase of the stride, in three cases: `within_m` is 15 mm or more; the person turns or changes speed; excitation
  /// follows joint moments (ExcitationSource::moments). Errors: a stale handle, a person named twice,
  /// PersonState::posed.
  Result<std::size_t> set_state(std::span<const Entity> people, PersonState state, float within_m = 0.005F);
  Result<std::size_t> set_state(Entity person, PersonState state, float within_m = 0.005F) {
    return set_state(std::span(&person, 1), state, within_m);
  }
  /// Returns a person's state; nothing for a stale handle.
  std::optional<PersonState> state(Entity person) const;

  /// Reserves entity handles for this many more people. Their rows are allocated when they spawn.
  void reserve(std::size_t people);

  /// Moves a walker at once. The walking line is the path between the footholds along which the walker advances. `x_m`
  /// and `z_m` are its point next to the supporting foot, `heading_rad` its heading there (rad about +Y). Pose and
  /// muscles move rigidly with it and feel no inertia. Pending turns and steps continue, rotated by the same angle.
  /// Except for rounding of positions, the walker has the same bits as one spawned there. Ground reaction follows in
  /// the next tick. Compact people stay compact and sleepers asleep, but sleepers under level of detail wake. Errors: a
  /// stale handle, a posed person, a position not within 1000 km, a heading not within ±10000.
  Result<void> place(Entity person, float x_m, float z_m, float heading_rad);
  /// Moves many walkers, all or none. Errors: those of one walker, with the person's index; a person named twice.
  Result<void> place(std::span<const PlaceRequest> places);

  /// Moves the world's origin to (x, 0, z): subtracts it from every stored position, including motion history. Motion
  /// is unaffected, and no inertia is felt. Worlds of many kilometres need it, because floats are 0.5 mm apart at 8 km.
  /// Shifts by multiples of 64 m that bring the origin closer to the people are exact. Headings and steps aside that
  /// the host requested do not change. Ground reaction follows in the next tick. Errors: a shift not within 1000 km.
  Result<void> shift_origin(float x_m, float z_m);

  /// Switches a feature of people on or off from the next tick on, all or none. People who have that setting already
  /// are unchanged. Errors: a stale handle, a person named twice, step events of a posed person (Status::missing).
  Result<void> enable(std::span<const Entity> people, Feature feature, bool on = true);
  Result<void> enable(Entity person, Feature feature, bool on = true) {
    return enable(std::span(&person, 1), feature, on);
  }
  /// Returns heel strikes, toe-offs, stops and starts of people with Feature::step_events in all ticks of the last
  /// `advance` or `tick`. They are sorted by time and then by handle. Valid until the next of these calls. Handles of
  /// people despawned since are stale. Events are not state, but the feature is: peers must enable it for the same
  /// people.
  std::span<const StepEvent> events() const;

  /// Writes the roots of people: position on the plane y = 0 and heading, without the sway of a step. `ahead_s` is the
  /// time after the last tick (0 to 0.2 s; a frame's alpha times the tick). `root_motion` (mobil/systems/poses/roots.h)
  /// returns the motion between two roots. Compact people and sleepers have roots as well. Errors: a stale handle, a
  /// time out of range, spans of different lengths; nothing is written then.
  Result<void> roots(std::span<const Entity> people, std::span<Root> out, double ahead_s = 0) const;

  /// Sets the leg muscles of people from the next tick on: lines of action and finite-element bellies, in both legs.
  /// std::nullopt removes all muscles. New muscles start at rest, at the person's phase of the stride (with inertia:
  /// under the load of that moment).
  ///
  /// Muscles in both the old and the new choice keep their handles. If LegMuscles::cells are equal, they keep
  /// displacement and velocity (zero velocity after Method::statics); if not, they start at rest. If activation is
  /// switched on or off, the belly's end jumps and the belly takes its static shape. The displayed points fade to that
  /// shape. If inertia is switched on during a walk, bellies first sag under gravity. Critical steps and substeps are
  /// computed again. Meshes and bases for a new choice are made and kept.
  ///
  /// All or none, except changes made before memory ran out. Errors: a stale handle, a person named twice, a choice out
  /// of range, a LegMuscles::dt_s above a person's critical step (the message contains the muscle and the limit).
  Result<void> set_muscles(std::span<const Entity> people, const std::optional<LegMuscles>& choice);
  Result<void> set_muscles(Entity person, const LegMuscles& choice = {}) {
    return set_muscles(std::span(&person, 1), choice);
  }
  Result<void> set_muscles(Entity person, std::nullopt_t none) { return set_muscles(std::span(&person, 1), none); }

  /// Changes the method of one muscle, both sides, from the next tick on. The person's other choices stay. Displacement
  /// and velocity of displayed control points do not jump. Their difference from the new method's first state is added
  /// to its results, and fades to zero in 0.25 s. All or none, except changes made before memory ran out. Errors: a
  /// stale handle, a muscle that is not there, a choice out of range.
  Result<void> set_method(std::span<const Entity> people, Muscle muscle, const MuscleMethod& method);
  Result<void> set_method(Entity person, Muscle muscle, const MuscleMethod& method) {
    return set_method(std::span(&person, 1), muscle, method);
  }
  /// Returns the current method of a muscle; Method::none if the person has no such muscle.
  MuscleMethod method(Entity person, Muscle muscle) const;

  /// Sets the excitation of a muscle from the next tick on, as a fraction of the maximum. `excitation` has one value
  /// for each person, clamped to 0.01 to 1. The muscle must have ExcitationSource::host. It begins at 0.01, or at the
  /// value that another source left, and a value holds until it is set again. Activation follows with a time constant
  /// of 5 to 20 ms, or 20 to 78 ms when it falls. All or none. Errors: a stale handle, a muscle that is not there or
  /// has another source (Status::missing), a value that is not finite.
  Result<void> set_excitation(std::span<const Entity> people, Muscle muscle, Side side,
                              std::span<const float> excitation);
  Result<void> set_excitation(Entity person, Muscle muscle, Side side, float excitation) {
    return set_excitation(std::span(&person, 1), muscle, side, std::span(&excitation, 1));
  }

  /// Interfaces of one subject each: collision avoidance between walkers, the ground, level of detail, and the meshes
  /// and bases that muscles share (mobil/avoidance.h, mobil/terrain.h, mobil/lod.h, mobil/muscle_library.h). They stay
  /// valid as long as the simulation, also after it is moved.
  Avoidance avoidance();
  Terrain terrain();
  Lod lod();
  MuscleLibrary muscle_library() const;

  /// Adds the time of a frame, s, and runs as many whole ticks as fit into the accumulated time. If a phase throws, the
  /// remaining ticks run in the next call.
  Ticks advance(double seconds);
  /// Runs `count` ticks.
  void tick(std::uint32_t count = 1);
  /// Number of ticks run so far.
  std::uint32_t ticks() const;
  /// Length of a tick, s.
  double tick_s() const;
  /// Simulated time so far, s.
  double time_s() const { return ticks() * tick_s(); }
  /// Returns the time of each system and phase: in the last tick, and in all ticks since timings were last reset.
  StepReport report() const;
  /// Returns the size of a snapshot, bytes. It contains all rows and handles, the tick and the time accumulated since.
  /// It does not contain the scene, nor meshes and bases: `restore` makes those that are missing.
  std::size_t snapshot_bytes() const;
  /// Writes a snapshot to the caller's memory and returns its size, bytes. Allocates only for shared resources
  /// (Shared<T>) that no earlier snapshot contained. Errors: `out` is too small, a shared resource that no module
  /// names.
  Result<std::size_t> save(std::span<std::byte> out) const;
  /// Restores a snapshot bit for bit, handles included, in this or another simulation. Both must have the same tick
  /// length, and the same versions of the modules of all saved rows. Allocates nothing if the numbers of rows and
  /// people are the same as now. Bytes are never trusted: the call refuses truncated or altered ones, another format
  /// version, and a snapshot that exceeds memory or `limits`. The simulation is then unchanged, but keeps meshes made
  /// so far for the next attempt. Threads and reports are not state.
  Result<void> restore(std::span<const std::byte> in, const RestoreLimits& limits);
  /// Restores a snapshot with the default limits.
  Result<void> restore(std::span<const std::byte> in);
  /// Returns a hash of the whole state, independent of spawn order, row order and handles (engine/state_hash.h).
  std::uint64_t state_hash() const;
  /// Returns a sum of hashes over all people, without tick and globals. The sums of several simulations, each with a
  /// part of one crowd, can be added (state_hash_of in engine/state_hash.h).
  std::uint64_t state_sum() const;

  /// Returns an entity's row of a component, get<Pose>(person). Errors: a stale handle, no such component.
  template <template <class> class C>
  Result<C<float>> get(Entity entity) const {
    Result<C<float>> row{tl::in_place};
    if (const Status status = read(entity, component_id<C>(), &*row); status != Status::ok) return fail(status);
    return row;
  }
  /// Returns the value of an entity's tag.
  template <class Tag>
  Result<std::uint64_t> get(Entity entity) const {
    static_assert(!is_row<Tag>, "name the component without its number type: get<Pose>(entity)");
    std::uint64_t value = 0;
    if (const Status status = read_tag(entity, type_id<Tag>(), value); status != Status::ok) return fail(status);
    return value;
  }

  /// Returns access to the host's own parts on people and muscles, and to its own entities (mobil/host_parts.h).
  HostParts parts();

  /// Computes a person's body and muscle plans, in some microseconds; nothing for a stale handle.
  std::optional<Person> person(Entity entity) const;
  /// Returns all people in the order of their rows, which holds until a person is spawned or despawned.
  std::vector<Entity> people() const;
  /// Returns true for people; false for other entities and stale handles.
  bool is_person(Entity entity) const;
  /// Returns a person's muscles in the order of the muscle table; empty for a stale handle, for a person without
  /// muscles, and for compact people and sleepers.
  std::vector<MuscleRef> muscles(Entity person) const;
  /// Returns the handle of a person's muscle; a stale handle if the person has no such muscle.
  Entity muscle(Entity person, Muscle muscle, Side side) const;

  /// Returns all tables for reading.
  const World& world() const;
  /// Returns all systems in the order in which they run. Timings can be read and reset.
  Schedule& schedule();
  const Schedule& schedule() const;
  /// Returns the library's modules, then the host's.
  std::span<const Module> modules() const;

 private:
  struct Core;  // systems/simulation_core.h

  explicit Simulation(std::unique_ptr<Core> core);
  Status read(Entity entity, const ComponentId& component, void* row) const;
  Status read_tag(Entity entity, std::uint64_t tag, std::uint64_t& value) const;
  Result<void> ask(Entity person, const Result<Gait<float>>& gait);

  std::unique_ptr<Core> core_;
};

/// Returns the corrections that Simulation::spawn, change_gait and set_gait make to a requested walk, in their order.
/// They correct a walk that would violate, or nearly reach, a limit of joints or ground. Simulation::gait_request then
/// returns the corrected walk. Errors: those of spawn.
Result<std::vector<StyleChange>> style_changes(const BodyRequest& body, const GaitRequest& gait);

}  // namespace mobil::inline v0_3
