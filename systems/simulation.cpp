#include <mobil/simulation.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <mobil/avoidance.h>
#include <mobil/components/avoidance.h>
#include <mobil/components/footing.h>
#include <mobil/engine/interrupt.h>
#include <mobil/host_parts.h>
#include <mobil/lod.h>
#include <mobil/muscle_library.h>
#include <mobil/schedule.h>
#include <mobil/step_report.h>
#include <mobil/systems/limits/style_limits.h>
#include <mobil/systems/people/step_log.h>
#include <mobil/systems/poses/roots.h>
#include <mobil/terrain.h>
#include "engine/state_hash.h"
#include "systems/avoidance/avoidance_module.h"
#include "systems/gait/gait.h"
#include "systems/lod/lod_module.h"
#include "systems/muscles/leg_moments.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/compact_pose.h"
#include "systems/people/fat_wobble.h"
#include "systems/people/ground_forces.h"
#include "systems/people/person_requests.h"
#include "systems/simulation_core.h"
#include "systems/simulation_queries.h"
#include "systems/snapshot/snapshot.h"
#include "systems/standard_modules.h"
#include "systems/states/compact.h"
#include "systems/states/muscle_verbs.h"
#include "systems/states/person_states.h"
#include "systems/states/sleep.h"
#include "systems/terrain/terrain_module.h"

namespace mobil::inline v0_3 {
/// Returns the error of a call that names a stale handle, or a person twice.
static tl::unexpected<Error> not_there(const char* call) {
  return fail(
      fmt::format("{}: a person is not there (a stale handle), or is named twice; spawn one first, and name each "
                  "once",
                  call),
      Status::stale_entity);
}

Simulation::Core::Core(const SimulationOptions& options, const Clock& of_clock, std::vector<Module> of_modules,
                       Schedule of_schedule)
    : world(options.memory),
      clock(of_clock),
      modules(std::move(of_modules)),
      schedule(std::move(of_schedule)),
      library(options.library_of != nullptr ? options.library_of->core_->library : std::make_shared<BellyLibrary>()),
      workspace(options.memory),
      tick{static_cast<float>(clock.tick_s()), 0} {
  const std::span ours(modules.data(), modules.size() - options.modules.size() - 1);
  workspace.get<MuscleMeans>() = {library, clock.tick_s(), ours};
  workspace.get<StepLog>().plan_for(clock.max_ticks());
  if (options.jobs) {
    jobs = *options.jobs;
  } else {
    threads.emplace(options.threads);
    jobs = threads->jobs();
  }
  world.set_owner_part(component_id<MuscleOwner>());
  for (const Module& module : ours)
    for (const ComponentId& part : module.parts) our_parts.push_back(part.id);
  std::ranges::sort(our_parts);
  auto& owned = workspace.get<SleepWork>().owned = our_parts;
  for (const std::uint64_t kept : {type_id<AvoidanceState<float>>(), type_id<Footing<float>>()})
    std::erase(owned, kept);
  for (const Module& module : modules)
    for (const GlobalPart& part : module.globals) world.globals().add(part);
  for (const Module& module : options.modules)
    for (const NamedResource& one : module.resources) world.share_as(one.part, one.resource);
}

Result<Simulation> Simulation::make(const SimulationOptions& options) {
  const FloatMode mode;
  const auto clock = Clock::make(options.tick_s, options.max_frame_s);
  if (!clock) return tl::unexpected(clock.error());
  std::vector<Module> modules = standard_modules();
  modules.insert(modules.end(), options.modules.begin(), options.modules.end());
  modules.push_back(step_memory_module());
  auto schedule = make_schedule(modules, options.memory);
  if (!schedule) return tl::unexpected(schedule.error());
  return Simulation(std::make_unique<Core>(options, *clock, std::move(modules), std::move(*schedule)));
}

Simulation::Simulation(std::unique_ptr<Core> core) : core_(std::move(core)) {}

Simulation::Simulation(const SimulationOptions& options)
    : Simulation([&] {
        auto made = make(options);
        if (!made) throw std::invalid_argument(made.error().message);
        return std::move(*made);
      }()) {}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

const World& Simulation::world() const {
  return core_->world;
}
Schedule& Simulation::schedule() {
  return core_->schedule;
}
const Schedule& Simulation::schedule() const {
  return core_->schedule;
}
std::span<const Module> Simulation::modules() const {
  return core_->modules;
}
std::uint32_t Simulation::ticks() const {
  return core_->tick.index;
}
double Simulation::tick_s() const {
  return core_->clock.tick_s();
}

Avoidance Simulation::avoidance() {
  return Avoidance(core_->frame);
}
Terrain Simulation::terrain() {
  return Terrain(core_->frame);
}
Lod Simulation::lod() {
  return Lod(core_->frame);
}
MuscleLibrary Simulation::muscle_library() const {
  return MuscleLibrary(core_->frame);
}
HostParts Simulation::parts() {
  return {core_->world, core_->our_parts};
}

Result<void> Simulation::spawn(std::span<const SpawnRequest> people, std::span<Entity> entities) {
  const FloatMode mode;
  if (people.size() != entities.size()) {
    return fail(
        fmt::format("spawn: {} people, and room for the handles of {}; give as many", people.size(), entities.size()));
  }
  auto made = spawn_people(scene_of(core_->frame), people, entities);
  if (!made)
    return fail(fmt::format("spawn: person {}: {}", made.error().person, made.error().error.message),
                made.error().error.status);
  return {};
}

Result<Entity> Simulation::spawn(const BodyRequest& body, const GaitRequest& gait) {
  const FloatMode mode;
  const SpawnRequest request{.body = body, .gait = gait};
  Entity entity;
  auto made = spawn_people(scene_of(core_->frame), {&request, 1}, {&entity, 1});
  if (!made) return tl::unexpected(made.error().error);
  return entity;
}

Result<Entity> Simulation::spawn_posed(const BodyRequest& body) {
  const FloatMode mode;
  return mobil::spawn_posed(core_->world, body);
}

Result<void> Simulation::set_pose(Entity person, const Pose<float>& pose, Arrival arrival) {
  const FloatMode mode;
  auto done = mobil::set_pose(core_->world, person, pose);
  if (done && arrival == Arrival::jumped) {
    forget_motion(core_->world, person);
    clear_pose_history(core_->world, person);
    settle_fat(core_->world, person);
  }
  core_->workspace.get<MuscleWork>().recent = {};
  return done;
}

Result<void> Simulation::despawn(std::span<const Entity> people) {
  return result_of("despawn", despawn_people(core_->world, core_->jobs, people));
}

Result<void> Simulation::despawn(Entity person) {
  return despawn(std::span(&person, 1));
}

/// Sets a resolved gait, or returns its error. A sleeper wakes for a change of style and during an earlier request.
Result<void> Simulation::ask(Entity person, const Result<Gait<float>>& gait) {
  if (!gait) return tl::unexpected(gait.error());
  const SleepTime now = time_of(core_->frame);
  if (is_asleep(core_->world, person)) {
    if (same_style(gait_of(core_->world, person)->style, gait->style) && !is_busy(core_->world, person, now)) {
      ask_sleepers(core_->world, core_->jobs, std::array{AskedSleeper{person, *gait}}, now);
      return {};
    }
    if (auto done = make_full(core_->frame, {&person, 1}); !done) return done;
  }
  return result_of("set_gait", core_->world.set(person, *gait));
}

Result<void> Simulation::change_gait(Entity person, const GaitChange& change) {
  const FloatMode mode;
  auto gait = changed_gait(core_->world, person, change);
  if (gait) keep_walk_limits(core_->world, core_->jobs, person, *gait, core_->workspace.get<SleepWork>().styles);
  return ask(person, gait);
}

Result<void> Simulation::set_gait(Entity person, const GaitRequest& asked) {
  const FloatMode mode;
  auto gait = new_gait(core_->world, person, asked);
  if (gait) keep_walk_limits(core_->world, core_->jobs, person, *gait, core_->workspace.get<SleepWork>().styles);
  return ask(person, gait);
}

std::optional<GaitRequest> Simulation::gait_request(Entity person) const {
  return mobil::gait_request(core_->world, person);
}

Result<void> Simulation::turn_to(Entity person, float heading_rad) {
  const FloatMode mode;
  return ask(person, turned_gait(core_->world, person, heading_rad));
}

Result<std::size_t> Simulation::change_gait(std::span<const WalkChange> changes) {
  const FloatMode mode;
  return mobil::change_walks(core_->frame, changes);
}

Result<void> Simulation::step_aside(Entity person, float left_m, float ahead_m) {
  const FloatMode mode;
  World::Transaction transaction(core_->world, core_->jobs);
  if (auto done = make_full(core_->frame, {&person, 1}); !done) return done;
  auto done = mobil::step_aside(core_->world, person, left_m, ahead_m);
  if (done) transaction.commit();
  return done;
}

Result<std::size_t> Simulation::set_state(std::span<const Entity> people, PersonState state, float within_m) {
  const FloatMode mode;
  if (!core_->world.alive_once(people) || !std::ranges::all_of(people, [&](Entity one) { return is_person(one); }))
    return not_there("set_state");
  return named("set_state", mobil::set_state(core_->frame, people, state, within_m));
}

void Simulation::reserve(std::size_t people) {
  core_->world.reserve_entities(people);
}

Status Simulation::read(Entity entity, const ComponentId& component, void* row) const {
  const World& world = core_->world;
  const auto place = world.find(entity);
  if (!place) return Status::stale_entity;
  if (const std::uint32_t column = place.table->column(component.id); column != Table::no_column) {
    place.table->read(place.row, column, static_cast<std::uint32_t>(component.value), row);
    return Status::ok;
  }
  if (mobil::is_compact(world, entity)) return read_compact(world, entity, component.id, row);
  return read_asleep(world, entity, time_of(core_->frame), component.id, row);
}

Status Simulation::read_tag(Entity entity, std::uint64_t tag, std::uint64_t& value) const {
  const auto place = core_->world.find(entity);
  if (!place) return Status::stale_entity;
  const ComponentId* const part = find_component(place.table->key(), tag);
  if (part == nullptr) return Status::missing;
  value = part->value;
  return Status::ok;
}

Result<void> Simulation::place(Entity person, float x_m, float z_m, float heading_rad) {
  const PlaceRequest to{person, x_m, z_m, heading_rad};
  if (auto good = check_place(core_->world, to); !good) return good;
  return place({&to, 1});
}

Result<void> Simulation::place(std::span<const PlaceRequest> places) {
  const FloatMode mode;
  std::vector<Entity>& people = core_->workspace.get<SleepWork>().rows;
  people.clear();
  for (const PlaceRequest& to : places) people.push_back(to.person);
  if (!core_->world.alive_once(people)) return not_there("place");
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (const auto good = check_place(core_->world, places[i]); !good)
      return fail(fmt::format("person {}: {}", i, good.error().message), good.error().status);
  }
  // Level of detail stores the places of sleepers that it manages; waking makes it check them again.
  std::erase_if(people, [&](Entity person) { return !core_->world.has<SleepsManaged>(person); });
  if (!people.empty()) {
    if (auto done = wake(core_->frame, std::vector(people)); !done) return done;
  }
  place_people(core_->world, time_of(core_->frame), places, core_->workspace.get<SleepWork>().ways);
  core_->workspace.get<MuscleWork>().recent = {};
  return {};
}

Result<void> Simulation::shift_origin(float x_m, float z_m) {
  const FloatMode mode;
  if (!(std::fabs(x_m) <= farthest_m && std::fabs(z_m) <= farthest_m))
    return fail(fmt::format("shift_origin: ({}, {}) m is not within ±1000000 m", x_m, z_m));
  shift_people(core_->world, x_m, z_m);
  shift_muscles(core_->world, x_m, z_m);
  shift_sleepers(core_->world, time_of(core_->frame), x_m, z_m);
  core_->workspace.get<MuscleWork>().recent = {};
  return {};
}

Result<void> Simulation::enable(std::span<const Entity> people, Feature feature, bool on) {
  const FloatMode mode;
  if (!core_->world.alive_once(people)) return not_there("enable");
  return named("enable", mobil::enable(core_->frame, people, feature, on));
}

Result<void> Simulation::roots(std::span<const Entity> people, std::span<Root> out, double ahead_s) const {
  const FloatMode mode;
  return read_roots(core_->world, people, time_of(core_->frame), ahead_s, out);
}

Result<void> Simulation::set_muscles(std::span<const Entity> people, const std::optional<LegMuscles>& choice) {
  const FloatMode mode;
  if (!core_->world.alive_once(people)) return not_there("set_muscles");
  return named("set_muscles", mobil::set_muscles(core_->frame, people, choice));
}

Result<void> Simulation::set_excitation(std::span<const Entity> people, Muscle muscle, Side side,
                                        std::span<const float> excitation) {
  const FloatMode mode;
  if (people.size() != excitation.size())
    return fail(
        fmt::format("set_excitation: {} people, and {} numbers; give as many", people.size(), excitation.size()));
  return named("set_excitation", mobil::set_excitation(core_->frame, people, muscle, side, excitation));
}

Result<void> Simulation::set_method(std::span<const Entity> people, Muscle muscle, const MuscleMethod& method) {
  const FloatMode mode;
  if (!core_->world.alive_once(people)) return not_there("set_method");
  return named("set_method", mobil::set_method(core_->frame, people, muscle, method));
}

MuscleMethod Simulation::method(Entity person, Muscle muscle) const {
  return method_of(core_->world, person, muscle);
}

Ticks Simulation::advance(double seconds) {
  const Ticks ticks = core_->clock.advance(seconds);
  const std::uint32_t to = core_->tick.index + ticks.count;
  try {
    tick(ticks.count);
  } catch (...) {
    core_->clock.give_back(to - core_->tick.index);
    throw;
  }
  return ticks;
}

void Simulation::tick(std::uint32_t count) {
  const FloatMode mode;
  core_->workspace.get<StepLog>().clear();
  if (count == 0) return;
  for (const auto begin : {&begin_lod_report, &begin_avoidance_report, &begin_terrain_report}) begin(core_->frame);
  for (std::uint32_t i = 0; i < count; ++i) {
    check_interrupt();
    const WholeScope tick;
    core_->schedule.tick(core_->world, core_->tick, core_->workspace, core_->jobs);
  }
}

std::span<const StepEvent> Simulation::events() const {
  return core_->workspace.get<StepLog>().events();
}

StepReport Simulation::report() const {
  return read_report(core_->schedule, core_->tick.index);
}

std::size_t Simulation::snapshot_bytes() const {
  return mobil::snapshot_bytes({core_->world, *core_->library, core_->modules, core_->jobs},
                               core_->workspace.get<SnapshotWork>());
}

Result<std::size_t> Simulation::save(std::span<std::byte> out) const {
  const std::int64_t tick = core_->clock.tick_units();
  const SnapshotTime time{tick, core_->clock.remainder_units() % tick, core_->tick.index};
  return save_snapshot({core_->world, *core_->library, core_->modules, core_->jobs}, time,
                       core_->workspace.get<SnapshotWork>(), out);
}

Result<void> Simulation::restore(std::span<const std::byte> in, const RestoreLimits& limits) {
  const FloatMode mode;
  const auto done =
      restore_snapshot({core_->world, *core_->library, core_->modules, core_->jobs}, {core_->clock.tick_units(), 0, 0},
                       core_->workspace.get<SnapshotWork>(), limits, in);
  if (!done) return fail("restore: " + done.error().message, done.error().status);
  core_->workspace.get<MuscleWork>().recent = {};
  core_->workspace.get<StepLog>().clear();
  core_->schedule.begin_anew();
  core_->tick.index = done->tick;
  core_->clock.set_remainder_units(done->remainder_units);
  return {};
}

Result<void> Simulation::restore(std::span<const std::byte> in) {
  return restore(in, RestoreLimits{});
}

std::uint64_t Simulation::state_hash() const {
  return state_hash_of(state_sum() + core_->world.globals().hash(), core_->tick.index);
}

std::uint64_t Simulation::state_sum() const {
  return mobil::state_hash(core_->world, core_->jobs);
}

bool Simulation::is_person(Entity entity) const {
  return mobil::is_person(core_->world, entity);
}

std::optional<PersonState> Simulation::state(Entity person) const {
  return person_state(core_->world, person);
}

std::vector<Entity> Simulation::people() const {
  return read_people(core_->world);
}

std::vector<MuscleRef> Simulation::muscles(Entity person) const {
  return muscles_of(core_->world, person);
}

std::optional<Person> Simulation::person(Entity entity) const {
  return read_person(*this, entity);
}

Entity Simulation::muscle(Entity person, Muscle muscle, Side side) const {
  return muscle_of(core_->world, person, muscle, side);
}

}  // namespace mobil::inline v0_3
