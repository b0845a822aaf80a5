#pragma once
// The facade: spawn people, give them muscles, advance time, read what became of them.
//
//   Simulation simulation;
//   const Entity human = *simulation.spawn({.height_m = 1.80F, .mass_kg = 80});
//   simulation.add_leg_muscles(human);
//   simulation.advance(frame_seconds);
//   simulation.get<Pose>(human)->position_m[index(Segment::head)];
//
// Everything else is a table: `world()` has all components to read, `schedule()` all systems in the order they run.
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
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>
#include <mobil/each.h>
#include <mobil/engine/clock.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/phase.h>
#include <mobil/engine/world.h>
#include <mobil/systems/muscles/own_muscle.h>
#include <mobil/systems/people/limit_watch.h>
#include <mobil/systems/people/person.h>
#include <mobil/systems/people/roots.h>
#include <mobil/systems/people/spawn.h>
#include <mobil/systems/people/step_watch.h>
#include <mobil/systems/people/style_limits.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include <mobil/systems/surfaces/nodal_view.h>

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
  /// share, and what a call works with until it returns.
  std::pmr::memory_resource* memory = std::pmr::get_default_resource();
  /// The host's own effects (mobil/engine/module.h), behind the library's.
  std::vector<Module> modules{};
  /// Another simulation, whose meshes, solvers and bases this one uses and adds to. What may add (prepare, load_baked,
  /// muscles and their methods, waking, restoring, Relevance) one of them at a time then does.
  const Simulation* library_of = nullptr;
};

/// How a posed person came to a pose.
enum class Arrival : std::uint8_t { moved, jumped };

/// One of a person's muscles, by side, with its plan.
struct HumanMuscle {
  MusclePlan plan;
  std::array<Entity, 2> entity;
  MuscleMethod method;  // as it is
};

/// One person with all that follows from what was asked for.
struct Human {
  Entity entity;
  Body body;
  Gait<float> gait;                  // as last asked for; zeros of posed people
  std::vector<HumanMuscle> muscles;  // in the table's order; empty without muscles
  LegMuscles leg_muscles;            // as asked for; means nothing without muscles
  bool posed = false;                // its host animates the skeleton: no gait
};

/// What one system cost: time of all threads together, and entities that it worked on.
struct SystemReport {
  std::string_view name, module;  // good as long as the simulation
  double seconds = 0;             // in the last tick
  std::uint64_t entities = 0;
  double total_seconds = 0;  // in all ticks since the schedule's timings were last reset
  std::uint64_t total_entities = 0;
};

/// Time of one phase of a tick (mobil/engine/phase.h), of the thread that ticks.
struct PhaseReport {
  std::string_view name, module;  // good as long as the simulation
  bool after = false;             // the systems; else before them
  double seconds = 0;             // in the last tick
  double total_seconds = 0;       // in all ticks since the schedule's timings were last reset
};

/// What simulating cost, system by system in the order of running. A system that matches no table reports 0 entities
/// and 0 s.
struct StepReport {
  std::uint32_t ticks = 0;  // run so far
  std::vector<SystemReport> systems;
  /// Bellies that were not finite at a tick's end and began anew, usually because a system of the host wrote NaN or
  /// infinity: in the last tick, and in all since timings were last reset.
  std::uint64_t restarted_bellies = 0, total_restarted_bellies = 0;
  /// People beyond a limit of joints, ground or pelvis while they change their walk, sleepers left out
  /// (mobil/systems/people/limit_watch.h): in the last tick, and summed over all ticks since timings were last reset.
  /// `broken_limits` tells which limits.
  std::uint64_t beyond_limits = 0, total_beyond_limits = 0;
  /// In the order of running.
  std::vector<PhaseReport> phases{};
};

struct MuscleScene;  // systems/muscles/leg_muscles.h

class BellyLibrary;  // systems/muscles/belly_library.h

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

  /// What of a walk's manner is otherwise than asked, in that order, because a limit of joints or ground would be
  /// broken or all but reached (mobil/systems/people/style_limits.h): spawn, change_gait, set_gait and change_walks
  /// keep to it, `gait_request` then says what is walked. Empty: nothing. Errors: as of spawn.
  static Result<std::vector<StyleChange>> style_changes(const BodyRequest& body, const GaitRequest& gait);
  /// The limits that a person is beyond in this tick, on level ground: none in a steady walk, seldom one in turns,
  /// stops and changes of speed of far styles. Empty too for those who sleep or are posed, and for a stale handle.
  std::vector<BrokenLimit> broken_limits(Entity person) const;

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
  Result<void> set_pose(Entity human, const Pose<float>& pose, Arrival arrival = Arrival::moved);
  /// The person goes, with their muscles; the handles are stale from then on. Errors: a stale handle.
  Result<void> despawn(Entity human);

  /// Many at once, with the simulation's jobs: the same bits as one by one, in a fraction of the time. `entities` is as
  /// long as `people`. All or none: an error names the number of the person, in one line, and the simulation is
  /// unchanged; `entities` mean nothing then.
  Result<void> spawn(std::span<const SpawnRequest> people, std::span<Entity> entities);
  /// The same of many, all or none. Errors: one of them is stale, or named twice.
  Result<void> despawn(std::span<const Entity> people);
  /// Makes the templates and bases that typical bodies share for this choice, with the simulation's jobs: then spawning
  /// them and changing their methods does not wait for that. Errors: a choice out of range; nothing has changed.
  Result<void> prepare(const LegMuscles& choice);
  /// All meshes, operators and bases that have been made so far, by `prepare` or by adding muscles, as bytes for a
  /// file: a program that loads them need not make them. They depend on no body and on no scene.
  std::vector<std::byte> bake() const;
  /// Takes in what `bake` wrote, in milliseconds: the bits are those that would be made here. The bytes are not needed
  /// afterwards. Errors, in one line: bytes that were cut or altered, or baked by another version of the library or on
  /// a processor that computes otherwise; nothing has changed then.
  Result<void> load_baked(std::span<const std::byte> baked);

  /// Asks a person to walk otherwise, from the next step on; speeds far from the present one are reached over several
  /// steps. A speed of 0 stops, a positive one starts again; what is left out stays, the style among it. Errors: a
  /// stale handle, a gait out of range; nothing has changed then.
  Result<void> change_gait(Entity human, const GaitChange& change);
  /// The same with all of a walk said anew: what is left out is as in a GaitRequest{}.
  Result<void> set_gait(Entity human, const GaitRequest& gait);
  /// What a walker is to do, as set_gait takes it; nothing for a stale handle and for posed people.
  std::optional<GaitRequest> gait_request(Entity human) const;
  /// Asks a person to turn to a heading (rad, about +Y, 0 toward +Z, positive to the left), the shorter way round, a
  /// part of it each step; who stands turns on the spot. Errors: a stale handle, a heading that is not finite;
  /// nothing has changed.
  Result<void> turn_to(Entity human, float heading_rad);
  /// change_gait and turn_to of many walkers at once, each named once, with the simulation's jobs. Who cannot walk so
  /// (a gait out of range, a posed person) is left as they are, and counted in the answer. Errors: a stale handle,
  /// somebody named twice; nothing has changed.
  Result<std::size_t> change_walks(std::span<const WalkChange> changes);
  /// Asks somebody who stands to step aside: to `left_m` to the left and `ahead_m` ahead of where they stand, negative
  /// to the right and back; at most 0.25 m aside and 0.20 m ahead or back for a leg of 0.85 m, in proportion to the
  /// leg. It begins within a quarter of a second and takes two steps of 0.3 to 0.5 s. Errors: a stale handle, a posed
  /// person, somebody who is to walk, a way out of range; nothing has changed.
  Result<void> step_aside(Entity human, float left_m, float ahead_m);

  /// Walkers whom nobody sees fall asleep: their rows go, and a hundred bytes are left from which they come back where
  /// they would be, walk, pose and lines to the bit. Muscles go, their handles too; they begin again on waking. A
  /// host's own parts stay. `get` reads a sleeper's body, walk and pose as anybody's (a pose takes some
  /// microseconds); change_gait, set_gait, turn_to, place, watch_steps, set_fat_wobble, roots and despawn work on
  /// sleepers, at the price of the strikes that follow; all other calls wake them, and so does what a sleeper cannot
  /// follow: another style, or a second request while the first is being carried out. Systems do not see them, nor does
  /// `each`. Who turns, changes speed or walks unevenly does not fall asleep, nor posed people, nor people whose
  /// muscles have several methods. A Relevance no longer manages whom this puts to sleep. Returns how many of these
  /// fell asleep. Errors: a stale handle, somebody named twice; nothing has changed.
  Result<std::size_t> sleep(std::span<const Entity> people);
  /// Sleepers wake; who is awake is left alone. Control points of their muscles are within `within_m` of where they
  /// would be, by running through the last half a second (5 mm), one (1 mm) or two (4 µm) of a person's walk as it now
  /// is: 0.6 µs a tick and person. From 15 mm on they begin at rest where the person stands in the stride; so do those
  /// who are turning or changing speed, and muscles that follow moments. Errors: a stale handle, somebody named twice;
  /// nothing has changed.
  Result<void> wake(std::span<const Entity> people, float within_m = 0.005F);
  /// False for a stale handle.
  bool is_asleep(Entity human) const;

  /// Walkers whom nobody looks at become compact: they go on as before, and so do their muscles, in a part of the time
  /// and of the memory. They have no pose of their own then, and the muscles are in the person's row: their handles go,
  /// others come when they are whole again. `get` makes Pose, JointAngles, Feet and CentreOfMass when it is asked (some
  /// microseconds), PoseWriter sixteen people's at a time; each<Pose> does not see them. change_gait, set_gait,
  /// turn_to, place, watch_steps, set_fat_wobble and despawn leave them compact; all other calls that change a person
  /// make them whole first. Control points are within 4 µm of where they would be. Posed people do not become compact,
  /// nor people with forces, nor whose muscles place control points, have effects, parts of the host's or a method
  /// other than reduced or none, nor while they fade. Returns how many of these are compact now. Errors: a stale
  /// handle, somebody named twice; nothing has changed.
  Result<std::size_t> compact(std::span<const Entity> people);
  /// Compact people are whole again; who is not compact is left alone. Errors: a stale handle, somebody named twice;
  /// nothing has changed.
  Result<void> expand(std::span<const Entity> people);
  /// False for a stale handle.
  bool is_compact(Entity human) const;

  /// Room for so many people more, beside what they themselves take.
  void reserve(std::size_t people);

  /// Puts a walker elsewhere at once: the point of the walking line beside the foot that bears, and the line's heading
  /// there (rad, about +Y). Pose and muscles go along, as if the world had been moved under them: no inertia is felt,
  /// and what the walker is about to do goes on, turned likewise: a walker spawned there has the same bits, but for the
  /// rounding of places. Ground reaction follows with the next tick. Compact people stay compact, sleepers asleep, but
  /// for those whom a Relevance put to sleep: they wake. Errors: a stale handle, a posed person, a place not within
  /// 1000 km, a heading not within ±10000; nothing has changed then.
  Result<void> place(Entity human, float x_m, float z_m, float heading_rad);
  /// The same of many. All or none. Errors: the same, with the number of the person; somebody named twice.
  Result<void> place(std::span<const PlaceRequest> places);

  /// The world's origin moves to (x, 0, z): every place becomes so much less, of people, of muscles and of what they
  /// remember, and everybody goes on unchanged; no inertia is felt. For worlds of many kilometres: floats are half a
  /// millimetre apart at 8 km. Shifts of whole multiples of 64 m toward where people are lose no bit of their places.
  /// Where the host asked things to go (headings, ways aside) is not touched. Ground reaction follows with the next
  /// tick. Errors: not within 1000 km; nothing has changed then.
  Result<void> shift_origin(float x_m, float z_m);

  /// The steps of walkers are watched from the next tick on, or no more: `events` tells what happens in them. Compact
  /// people are watched as well; who falls asleep is watched again on waking, and what happened meanwhile is not
  /// reported. All or none. Errors: a stale handle, somebody named twice, a posed person (Status::missing); nothing has
  /// changed.
  Result<void> watch_steps(std::span<const Entity> people, bool on = true);
  /// Heel strikes, toe-offs, stops and starts of who is watched, in all ticks of the last `advance` or
  /// `tick`: in order of time, at the same instant in the order of handles, whatever the threads. Until the next of
  /// those calls; handles of who went since are stale. No state, but who is watched is: peers watch the same people.
  std::span<const StepEvent> events() const;

  /// The effect of fat under the skin that wobbles (mobil/components/fat.h, systems/kinematics/fat_motion.h), of
  /// walkers and posed people, from the next tick on, or no more; skin shows it (mobil/skin_writer.h). Compact people
  /// and sleepers keep it, and it begins at rest when they are whole. All or none. Errors: a stale handle, somebody
  /// named twice; nothing has changed.
  Result<void> set_fat_wobble(std::span<const Entity> people, bool on = true);

  /// Where these people are on the ground `ahead_s` after the last tick (0 to 0.2 s; a frame's alpha times the tick),
  /// and where they head, smooth along the walking line: `root_motion` (mobil/systems/people/roots.h) tells the way
  /// between two of them. Compact people and sleepers too. Errors, in one line: a stale handle, a time out of range,
  /// spans not as long as each other; nothing is written then.
  Result<void> roots(std::span<const Entity> people, std::span<Root> out, double ahead_s = 0) const;

  /// The effect of ground reaction and joint moments (mobil/forces.h). Walkers' follow from their step, at once;
  /// posed people's from how their last three poses move, one tick late (systems/forces/forces.h says how): give them a
  /// pose before every tick, for one that stays is a stop, and near the origin, for places of single precision are 8 µm
  /// apart 64 m from there, which is 0.03 m/s². The masses of limbs of their own lie where the height has them.
  Result<void> add_forces(Entity human);
  /// The same for people named once each, or (on false) no more; who has them already, or none, is left alone. All of
  /// them, or nobody. Errors: stale handles.
  Result<void> set_forces(std::span<const Entity> people, bool on);
  /// Errors: a stale handle, or they are not there (Status::missing).
  Result<void> remove_forces(Entity human);

  /// The effect of leg muscles: lines of action and finite-element bellies of the muscles chosen, both legs, at rest
  /// where the person stands in the stride (with inertia under the load of that moment). Errors: a stale handle,
  /// muscles that are there already, a choice out of range, a step above an individual's critical step, which names the
  /// muscle and the limit; nothing has changed.
  Result<void> add_leg_muscles(Entity human, const LegMuscles& choice = {});
  /// Other muscles, or the same otherwise, from the next tick on: critical steps and substeps are computed anew. Those
  /// that stay keep their handles; of them displacement and velocity stay while the cells do (velocities are taken as
  /// they are, be they half a step back or not; from static on they begin with zero); other cells begin at rest.
  /// Where activation begins or ends, the belly's end is elsewhere at once: the belly follows statically, and what is
  /// shown fades to it. Inertia that begins under way lets the bellies sag. Every choice not made before is set up and
  /// kept. Errors: as above, and muscles that are not there; nothing has changed.
  Result<void> change_leg_muscles(Entity human, const LegMuscles& choice);
  /// Errors: a stale handle, or there are none (Status::missing).
  Result<void> remove_leg_muscles(Entity human);

  /// Another method for one muscle, both sides, from the next tick on; the person's other choices hold. What is shown
  /// of control points goes on without a jump in displacement or velocity: what the new method cannot begin with is
  /// added to what it computes and fades within `fade_s`. Errors: a stale handle, a muscle that is not there, a choice
  /// out of range; nothing has changed.
  Result<void> set_method(Entity human, Muscle muscle, const MuscleMethod& method);
  /// Current method; Method::none if the person has no such muscle.
  MuscleMethod method(Entity human, Muscle muscle) const;

  /// How hard a muscle is to pull from the next tick on, a share of the most that it can: for muscles chosen with
  /// ExcitationSource::host, which begin at 0.01, or where another source left them. It holds until it is set again;
  /// what lies outside 0.01 to 1 is taken as that end. Activation follows with 5 to 20 ms, or 20 to 78 when it falls.
  /// Errors: a stale handle, a muscle that is not there or not the host's to excite (Status::missing), a number that is
  /// not finite.
  Result<void> set_excitation(Entity human, Muscle muscle, Side side, float excitation);

  /// Runs as many whole ticks as fit into the accumulated time.
  Ticks advance(double seconds);
  /// Runs `count` ticks.
  void tick(std::uint32_t count = 1);
  /// Ticks run so far.
  std::uint32_t ticks() const { return tick_.index; }
  /// Length of a tick, s.
  double tick_s() const { return clock_.tick_s(); }
  /// Time simulated so far, s.
  double time_s() const { return tick_.index * clock_.tick_s(); }
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
  /// The same without the tick, as a sum over all people: those of the simulations that a crowd is divided into may be
  /// added up (state_hash_of in engine/state_hash.h).
  std::uint64_t state_sum() const;

  /// An entity's row of a component, or why there is none: get<Pose>(human).
  template <template <class> class C>
  Result<C<float>> get(Entity entity) const {
    Result<C<float>> row{tl::in_place};
    Status status = world_->read(entity, *row);
    if (status == Status::missing) status = read_absent(entity, type_id<C<float>>(), &*row);
    if (status != Status::ok) return fail(status);
    return row;
  }
  /// The value of an entity's tag.
  template <class Tag>
  Result<std::uint64_t> get(Entity entity) const {
    const auto value = world_->get<Tag>(entity);
    if (!value) return fail(value.error());
    return *value;
  }

  /// The host's own parts (mobil/engine/key.h) on people and muscles, and entities of the host's own: the one door to
  /// what rows are made of. They are in the state hash; in snapshots where a module names them
  /// (SimulationOptions::modules). A part of a muscle stays with it whatever its method. What is the library's, and its
  /// people and muscles, answer Status::not_yours: for these are the calls above.
  template <class P>
  Result<void> add(Entity entity, const P& part) {
    return result_of("add", ours(key_part(part).id) ? Status::not_yours : world_->add(entity, part));
  }
  /// Overwrites a component's row.
  template <template <class> class C>
  Result<void> set(Entity entity, const C<float>& row) {
    return result_of("set", ours(type_id<C<float>>()) ? Status::not_yours : world_->set(entity, row));
  }
  /// Overwrites a field; `values` is as long as the field is wide.
  template <class Tag>
  Result<void> set_field(Entity entity, std::span<const float> values) {
    return result_of("set_field", ours(type_id<Tag>()) ? Status::not_yours : world_->set_field<Tag>(entity, values));
  }
  /// Removes a part: a component by its template, a field or tag by its type.
  template <template <class> class C>
  Result<void> remove(Entity entity) {
    return result_of("remove", ours(type_id<C<float>>()) ? Status::not_yours : world_->remove<C>(entity));
  }
  template <class Tag>
  Result<void> remove(Entity entity) {
    return result_of("remove", ours(type_id<Tag>()) ? Status::not_yours : world_->remove<Tag>(entity));
  }
  /// An entity of the host's own, of its own parts.
  template <class... P>
  Result<Entity> create(const P&... parts) {
    if ((ours(key_part(parts).id) || ...)) return fail(Status::not_yours);
    return world_->create(parts...);
  }
  /// Destroys an entity that `create` made.
  Result<void> destroy(Entity entity);
  /// Takes a share in an immutable resource, for a Shared part.
  template <class T>
  Shared<T> share(std::shared_ptr<const T> resource) {
    return world_->share(std::move(resource));
  }

  /// Calls `f` with each block of all that have what its parameters name (mobil/each.h):
  ///   simulation.each([](const Rows& rows, const Pose<Lanes<float>>& pose, Fatigue<Lanes<float>>& fatigue) { … });
  /// The library's parts are there to be read: where `f` would write one, nothing is done and the answer is
  /// Status::not_yours. Within ticks a module's systems may write them.
  template <class F>
  Result<void> each(F&& f) {
    if (writes_ours(Signature<std::remove_cvref_t<F>>{})) return fail(Status::not_yours);
    mobil::each(*world_, f);
    return {};
  }
  template <class F>
  void each(F&& f) const {
    mobil::each(world(), f);
  }

  /// A person with body and plans of muscles, made when asked for (some microseconds); nothing for a stale handle.
  std::optional<Human> human(Entity entity) const;
  /// All people, in the order of their rows; until somebody comes or goes.
  std::vector<Entity> people() const;
  /// False for a stale handle and for entities that are not people.
  bool is_person(Entity entity) const;
  /// A person's muscles in the table's order; empty for a stale handle, without muscles, asleep and compact.
  std::vector<OwnMuscle> muscles(Entity human) const;
  /// A person's muscle; a stale handle where there is none.
  Entity muscle(Entity human, Muscle muscle, Side side) const;

  /// A muscle's control points where they are now, in its frame, as they are to be shown (what fades after a change of
  /// method included); `first` is null for a stale handle and where there are none: with Method::none, and where nobody
  /// asked for them. Until the next change of structure.
  NodalView nodal_displacement(Entity muscle) const { return mobil::nodal_displacement(*world_, muscle); }

  /// All tables, to be read.
  const World& world() const { return *world_; }
  /// All systems, in the order in which they run; timings can be reset and read.
  Schedule& schedule() { return *schedule_; }
  const Schedule& schedule() const { return *schedule_; }
  /// The library's, then the host's.
  std::span<const Module> modules() const { return modules_; }

 private:
  friend struct SimulationWorld;  // systems/simulation_world.h

  bool ours(std::uint64_t part) const;
  template <class... P>
  bool writes_ours(Parameters<P...>) const {
    return ((Parameter<P>::access().mode == Access::Mode::write && ours(Parameter<P>::access().id)) || ...);
  }
  Simulation(const SimulationOptions& options, Clock clock);
  MuscleScene muscle_scene();
  Status read_absent(Entity entity, std::uint64_t part, void* row) const;
  Result<void> make_whole(std::span<const Entity> people);
  Result<void> make_whole_for(Entity human);
  Result<void> make_muscles_whole(std::span<const Entity> people);
  template <class F>
  Result<void> of_whole(Entity human, const char* name, const F& change);
  Result<void> ask(Entity human, const Result<Gait<float>>& gait);

  std::unique_ptr<World> world_;
  Clock clock_;
  std::optional<Threads> threads_;
  Jobs jobs_;
  std::vector<Module> modules_;
  std::vector<std::uint64_t> our_parts_;  // of the library's modules, ascending
  std::unique_ptr<Schedule> schedule_;
  std::shared_ptr<BellyLibrary> library_;
  std::unique_ptr<Workspace> workspace_;
  Tick tick_;
};

}  // namespace mobil::inline v0_3
