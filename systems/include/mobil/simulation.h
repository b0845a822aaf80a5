#pragma once
// The facade: spawn people, give them muscles, advance time, read what became of them.
//
//   Simulation simulation;
//   const Entity person = *simulation.spawn({.height_m = 1.80F, .mass_kg = 80});
//   simulation.set_muscles(person);
//   simulation.advance(frame_seconds);
//   simulation.get<Pose>(person)->position_m[index(Segment::head)];
//
// Everything else is a table: `world()` has all components to read (mobil/engine/world.h; mobil/each.h for a block at a
// time), `schedule()` all systems in the order they run.
// Nothing is global; any number of simulations may live side by side.
//
// Threads: one at a time may change a simulation. Between changes any number may read it at once: every const call but
// `save`, `snapshot_bytes` and `state_hash`, which work with the simulation's jobs or keep what they learn; PoseWriter
// and SurfaceWriter too, one of them a thread.
//
// Whatever can fail answers with a Result: what was asked for, or an Error with a code for the program and a line for
// its user. What failed has changed nothing. (World and Schedule, inside, answer with the code alone.)
//
// Where memory runs out as people come or change, std::bad_alloc is thrown and the simulation is unchanged, including
// future handles. Despawning never allocates.

#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include <mobil/components/pose.h>
#include <mobil/engine/module.h>
#include <mobil/systems/muscles/muscle_ref.h>
#include <mobil/systems/people/person_requests.h>
#include <mobil/systems/people/person_state.h>
#include <mobil/systems/people/spawn.h>
#include <mobil/systems/people/step_event.h>
#include <mobil/systems/poses/roots.h>
#include <mobil/systems/snapshot/restore_limits.h>

namespace mobil::inline v0_3 {

class Simulation;

/// Time, threads, memory and modules of a simulation. Ranges: `tick_s` 1e-5 to 1 s, `max_frame_s` from one tick to 60
/// s.
struct SimulationOptions {
  double tick_s = 1.0 / 60;
  double max_frame_s = 0.25;   // of a longer frame the rest is dropped and reported
  int threads = 1;             // of the built-in pool; 0: as many as the machine has
  std::optional<Jobs> jobs{};  // the caller's own job system instead
  /// Of all that grows with people: tables, handles, what systems work in. From the heap are the tables that bodies
  /// share, what a call works with until it returns, and what level of detail, avoidance and terrain work in.
  std::pmr::memory_resource* memory = std::pmr::get_default_resource();
  /// The host's own effects (mobil/engine/module.h), behind the library's.
  std::vector<Module> modules{};
  /// Another simulation, whose meshes, solvers and bases this one uses and adds to. Simulations that
  /// share a library must not add to it concurrently: preparing and loading, muscles and their methods, waking,
  /// restoring, ticks with level of detail.
  const Simulation* library_of = nullptr;
};

/// How a posed person came to a pose.
enum class Arrival : std::uint8_t { moved, jumped };

class Avoidance;      // mobil/avoidance.h
class HostParts;      // mobil/host_parts.h
struct Person;        // mobil/systems/muscles/person.h
class Lod;            // mobil/lod.h
class MuscleLibrary;  // mobil/muscle_library.h
class Schedule;       // mobil/schedule.h
struct StepReport;    // mobil/step_report.h
class Terrain;        // mobil/terrain.h
class World;          // mobil/engine/world.h

class Simulation {
 public:
  /// Errors, in one line: tick_s or max_frame_s out of range (mobil/engine/clock.h), a module that does not fit the
  /// others (mobil/engine/module.h).
  static Result<Simulation> make(const SimulationOptions& options = {});
  /// As `make`; throws std::invalid_argument with its line.
  explicit Simulation(const SimulationOptions& options = {});
  ~Simulation();
  /// What was moved from may be destroyed or assigned to. References to the world go along.
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// A person at the origin, right heel striking, walking toward +Z. Errors: a body or a gait out of range or
  /// unreachable, one line each; the simulation is unchanged.
  Result<Entity> spawn(const BodyRequest& body, const GaitRequest& gait = {});
  /// A person whose host animates the skeleton, in the anatomical position at the origin: no gait, nothing of
  /// kinematics. Errors: a body out of range, in one line; the simulation is unchanged.
  Result<Entity> spawn_posed(const BodyRequest& body);
  /// Where a posed person's skeleton is at the end of the next tick, taken as it is. Leg muscles follow. Errors, which
  /// name the segment: a stale handle, a walker (Status::missing), a place not within 1000 km, a quaternion whose
  /// length is not 1 within 1 %; the pose then stays. Muscles with inertia feel the way from the last pose, and so does
  /// fat that wobbles, unless it has `jumped`.
  Result<void> set_pose(Entity person, const Pose<float>& pose, Arrival arrival = Arrival::moved);
  /// The person goes, with their muscles; the handles are stale from then on. Errors: a stale handle.
  Result<void> despawn(Entity person);

  /// Many at once, with the simulation's jobs: the same bits as one by one, in a fraction of the time. `entities` is as
  /// long as `people`. All or none: an error names the number of the person, in one line, and the simulation is
  /// unchanged; `entities` mean nothing then.
  Result<void> spawn(std::span<const SpawnRequest> people, std::span<Entity> entities);
  /// The same of many, all or none. Errors: one of them is stale, or named twice.
  Result<void> despawn(std::span<const Entity> people);
  /// Asks a person to walk otherwise, from the next step on; speeds far from the present one are reached over several
  /// steps. A speed of 0 stops, a positive one starts again; what is left out stays, the style among it. Errors: a
  /// stale handle, a gait out of range; nothing has changed then.
  Result<void> change_gait(Entity person, const GaitChange& change);
  /// The same with all of a walk said anew: what is left out is as in a GaitRequest{}.
  Result<void> set_gait(Entity person, const GaitRequest& gait);
  /// What a walker is to do, as set_gait takes it; nothing for a stale handle and for posed people.
  std::optional<GaitRequest> gait_request(Entity person) const;
  /// Asks a person to turn to a heading (rad, about +Y, 0 toward +Z, positive to the left), the shorter way round, a
  /// part of it each step; who stands turns on the spot. Errors: a stale handle, a heading that is not finite;
  /// nothing has changed.
  Result<void> turn_to(Entity person, float heading_rad);
  /// The same and turn_to of many walkers at once, each named once, with the simulation's jobs. Who cannot walk so (a
  /// gait out of range, a posed person) is left as they are, and counted in the answer. Errors: a stale handle,
  /// somebody named twice; nothing has changed.
  Result<std::size_t> change_gait(std::span<const WalkChange> changes);
  /// Asks somebody who stands to step aside: to `left_m` to the left and `ahead_m` ahead of where they stand, negative
  /// to the right and back; at most 0.25 m aside and 0.20 m ahead or back for a leg of 0.85 m, in proportion to the
  /// leg. It begins within a quarter of a second and takes two steps of 0.3 to 0.5 s. Errors: a stale handle, a posed
  /// person, somebody who is to walk, a way out of range; nothing has changed.
  Result<void> step_aside(Entity person, float left_m, float ahead_m);

  /// People become of that state who may (PersonState says who); those who are already are left alone. Returns how
  /// many of these are in it now. Compact people who are to fall asleep and may not are full. `full` wakes sleepers and
  /// expands compact people; muscles that begin are within `within_m` of where they would be, by running through the
  /// last half a second (5 mm), one (1 mm) or two (4 µm) of a person's walk as it now is: 0.6 µs a tick and person.
  /// From 15 mm on they begin at rest where the person stands in the stride; so do those of people who are turning or
  /// changing speed, and muscles that follow moments. Level of detail no longer manages whom this puts to sleep.
  /// Errors: a stale handle, somebody named twice, PersonState::posed; nothing has changed.
  Result<std::size_t> set_state(std::span<const Entity> people, PersonState state, float within_m = 0.005F);
  Result<std::size_t> set_state(Entity person, PersonState state, float within_m = 0.005F) {
    return set_state(std::span(&person, 1), state, within_m);
  }
  /// Nothing for a stale handle.
  std::optional<PersonState> state(Entity person) const { return person_state(world(), person); }

  /// Room for so many people more, beside what they themselves take.
  void reserve(std::size_t people);

  /// Puts a walker elsewhere at once: the point of the walking line beside the foot that bears, and the line's heading
  /// there (rad, about +Y). Pose and muscles go along, as if the world had been moved under them: no inertia is felt,
  /// and what the walker is about to do goes on, turned likewise: a walker spawned there has the same bits, but for the
  /// rounding of places. Ground reaction follows with the next tick. Compact people stay compact, sleepers asleep, but
  /// for those whom a level of detail put to sleep: they wake. Errors: a stale handle, a posed person, a place not
  /// within 1000 km, a heading not within ±10000; nothing has changed then.
  Result<void> place(Entity person, float x_m, float z_m, float heading_rad);
  /// The same of many. All or none. Errors: the same, with the number of the person; somebody named twice.
  Result<void> place(std::span<const PlaceRequest> places);

  /// The world's origin moves to (x, 0, z): every place becomes so much less, of people, of muscles and of what they
  /// remember, and everybody goes on unchanged; no inertia is felt. For worlds of many kilometres: floats are half a
  /// millimetre apart at 8 km. Shifts of whole multiples of 64 m toward where people are lose no bit of their places.
  /// Where the host asked things to go (headings, ways aside) is not touched. Ground reaction follows with the next
  /// tick. Errors: not within 1000 km; nothing has changed then.
  Result<void> shift_origin(float x_m, float z_m);

  /// People have a feature (Feature) from the next tick on, or no more; who has it already, or has it not, is left
  /// alone. All or none. Errors: a stale handle, somebody named twice, step events of a posed person (Status::missing);
  /// nothing has changed.
  Result<void> enable(std::span<const Entity> people, Feature feature, bool on = true);
  Result<void> enable(Entity person, Feature feature, bool on = true) {
    return enable(std::span(&person, 1), feature, on);
  }
  /// Heel strikes, toe-offs, stops and starts of who is watched, in all ticks of the last `advance` or
  /// `tick`: in order of time, at the same instant in the order of handles, whatever the threads. Until the next of
  /// those calls; handles of who went since are stale. No state, but who is watched is: peers watch the same people.
  std::span<const StepEvent> events() const;

  /// Where these people are on the ground `ahead_s` after the last tick (0 to 0.2 s; a frame's alpha times the tick),
  /// and where they head, smooth along the walking line: `root_motion` (mobil/systems/poses/roots.h) tells the way
  /// between two of them. Compact people and sleepers too. Errors, in one line: a stale handle, a time out of range,
  /// spans not as long as each other; nothing is written then.
  Result<void> roots(std::span<const Entity> people, std::span<Root> out, double ahead_s = 0) const;

  /// Sets the leg muscles of these people from the next tick on: lines of action and finite-element bellies of the
  /// muscles chosen, both legs. With std::nullopt all muscles go. New muscles begin at rest at the person's phase of
  /// the stride (with inertia: under the load of that moment). Muscles that stay keep their handles. They keep
  /// displacement and velocity if their cells stay, with a velocity of zero after Method::statics; else they begin at
  /// rest. If activation begins or ends, the belly's end moves at once. The belly then follows statically, and the
  /// displayed points fade to it. Inertia that begins during a walk lets the bellies sag. Critical steps and substeps
  /// are computed again; new choices are set up and kept. All or none, but for changes made before memory ran out.
  /// Errors: a stale handle, a person named twice, a choice out of range, a step above an individual's critical step,
  /// which names the muscle and the limit; nothing has changed.
  Result<void> set_muscles(std::span<const Entity> people, const std::optional<LegMuscles>& choice);
  Result<void> set_muscles(Entity person, const LegMuscles& choice = {}) {
    return set_muscles(std::span(&person, 1), choice);
  }
  Result<void> set_muscles(Entity person, std::nullopt_t none) { return set_muscles(std::span(&person, 1), none); }

  /// Another method for one muscle, both sides, from the next tick on; the person's other choices hold. All or none,
  /// but for changes made before memory ran out. The displayed control points show no jump in displacement or velocity:
  /// the difference to the new method's start is added to its results and fades within `fade_s`. Errors: a stale
  /// handle, a muscle that is not there, a choice out of range; nothing has changed.
  Result<void> set_method(std::span<const Entity> people, Muscle muscle, const MuscleMethod& method);
  Result<void> set_method(Entity person, Muscle muscle, const MuscleMethod& method) {
    return set_method(std::span(&person, 1), muscle, method);
  }
  /// Current method; Method::none if the person has no such muscle.
  MuscleMethod method(Entity person, Muscle muscle) const;

  /// How hard a muscle is to pull from the next tick on, a share of the most that it can: for muscles chosen with
  /// ExcitationSource::host, which begin at 0.01, or where another source left them. It holds until it is set again;
  /// what lies outside 0.01 to 1 is taken as that end. Activation follows with 5 to 20 ms, or 20 to 78 when it falls.
  /// A number for each; all or none. Errors: a stale handle, a muscle that is not there or not the host's to excite
  /// (Status::missing), a number that is not finite; nothing has changed.
  Result<void> set_excitation(std::span<const Entity> people, Muscle muscle, Side side,
                              std::span<const float> excitation);
  Result<void> set_excitation(Entity person, Muscle muscle, Side side, float excitation) {
    return set_excitation(std::span(&person, 1), muscle, side, std::span(&excitation, 1));
  }

  /// Who keeps out of each other's way, where the ground is, how finely whose muscles are computed, and the meshes and
  /// bases that muscles share: verbs of one subject each, in mobil/avoidance.h, mobil/terrain.h, mobil/lod.h and
  /// mobil/muscle_library.h. Each is valid as long as the simulation, also once that has been moved.
  Avoidance avoidance();
  Terrain terrain();
  Lod lod();
  MuscleLibrary muscle_library() const;

  /// Runs as many whole ticks as fit into the accumulated time. Where a phase throws, the ticks that have not run are
  /// run by the next call.
  Ticks advance(double seconds);
  /// Runs `count` ticks.
  void tick(std::uint32_t count = 1);
  /// Ticks run so far.
  std::uint32_t ticks() const;
  /// Length of a tick, s.
  double tick_s() const;
  /// Time simulated so far, s.
  double time_s() const { return ticks() * tick_s(); }
  /// What the last tick cost, and all of them, system by system.
  StepReport report() const;
  /// The state alone as bytes, in the caller's memory: all rows and handles, the tick and the time fed since. Neither
  /// scene nor meshes nor bases: those are made again where they are missing. `save` says how many bytes it wrote,
  /// `snapshot_bytes` of them, and takes memory only for resources that no snapshot had met before. Errors: too little
  /// room; a shared resource that no module names.
  std::size_t snapshot_bytes() const;
  /// Writes the snapshot; see `snapshot_bytes`.
  Result<std::size_t> save(std::span<std::byte> out) const;
  /// Restores what was saved to the last bit, handles included, here or in another simulation whose tick is as long and
  /// which has the modules of the rows saved, in the same versions; where rows and people are as many as they were,
  /// without taking memory. Bytes are never trusted: what was cut, altered or made by another format version is refused
  /// in one line, and so is what does not fit in memory or is beyond the limits; the simulation is then unchanged
  /// (meshes made on the way stay, for the next time). Threads and reports are not state.
  Result<void> restore(std::span<const std::byte> in, const RestoreLimits& limits = {});
  /// Hash of the whole state; independent of spawn order, row order and handles (engine/state_hash.h).
  std::uint64_t state_hash() const;
  /// The same without the tick and without globals, as a sum over all people: those of the simulations that a crowd is
  /// divided into may be added up (state_hash_of in engine/state_hash.h).
  std::uint64_t state_sum() const;

  /// An entity's row of a component, or why there is none: get<Pose>(person).
  template <template <class> class C>
  Result<C<float>> get(Entity entity) const {
    Result<C<float>> row{tl::in_place};
    if (const Status status = read(entity, component_id<C>(), &*row); status != Status::ok) return fail(status);
    return row;
  }
  /// The value of an entity's tag.
  template <class Tag>
  Result<std::uint64_t> get(Entity entity) const {
    static_assert(!is_row<Tag>, "name the component without its number type: get<Pose>(entity)");
    std::uint64_t value = 0;
    if (const Status status = read_tag(entity, type_id<Tag>(), value); status != Status::ok) return fail(status);
    return value;
  }

  /// The host's own parts on people and muscles, and entities of its own (mobil/host_parts.h).
  HostParts parts();

  /// A person with body and plans of muscles, made when asked for (some microseconds); nothing for a stale handle.
  std::optional<Person> person(Entity entity) const;
  /// All people, in the order of their rows; until somebody comes or goes.
  std::vector<Entity> people() const;
  /// False for a stale handle and for entities that are not people.
  bool is_person(Entity entity) const;
  /// A person's muscles in the table's order; empty for a stale handle, without muscles, asleep and compact.
  std::vector<MuscleRef> muscles(Entity person) const;
  /// A person's muscle; a stale handle where there is none.
  Entity muscle(Entity person, Muscle muscle, Side side) const;

  /// All tables, to be read.
  const World& world() const;
  /// All systems, in the order in which they run; timings can be reset and read.
  Schedule& schedule();
  const Schedule& schedule() const;
  /// The library's, then the host's.
  std::span<const Module> modules() const;

 private:
  struct Core;  // systems/simulation_core.h

  explicit Simulation(std::unique_ptr<Core> core);
  Status read(Entity entity, const ComponentId& component, void* row) const;
  Status read_tag(Entity entity, std::uint64_t tag, std::uint64_t& value) const;
  Result<void> ask(Entity person, const Result<Gait<float>>& gait);

  std::unique_ptr<Core> core_;
};

}  // namespace mobil::inline v0_3
