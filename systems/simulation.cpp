#include <mobil/simulation.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/components/avoidance.h>
#include <mobil/components/compact.h>
#include <mobil/components/fat.h>
#include <mobil/components/footing.h>
#include <mobil/schedule.h>
#include <mobil/systems/people/person.h>
#include <mobil/systems/people/step_watch.h>
#include <mobil/systems/people/style_limits.h>
#include "engine/row_hash.h"
#include "engine/state_hash.h"
#include "systems/gait/gait.h"
#include "systems/muscles/compact.h"
#include "systems/muscles/leg_moments.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/muscles/sleep.h"
#include "systems/people/fat_wobble.h"
#include "systems/people/ground_forces.h"
#include "systems/people/whole.h"
#include "systems/simulation_reading.h"
#include "systems/simulation_world.h"
#include "systems/snapshot/snapshot.h"
#include "systems/standard_modules.h"
#include "systems/simulation_waking.h"

namespace mobil::inline v0_3 {
namespace {

/// An error with the name of the call that it is of.
template <class T>
Result<T> named(const char* call, Result<T> result) {
  if (result) return result;
  return fail(fmt::format("{}: {}", call, result.error().message), result.error().status);
}

}  // namespace

Simulation::Simulation(const SimulationOptions& options, Clock clock)
    : world_(std::make_unique<World>(options.memory)),
      clock_(clock),
      modules_(standard_modules()),
      library_(options.library_of != nullptr ? options.library_of->library_ : std::make_shared<BellyLibrary>()),
      workspace_(std::make_unique<Workspace>(options.memory)),
      tick_{static_cast<float>(clock.tick_s()), 0} {
  workspace_->get<MuscleMeans>() = {library_, clock.tick_s()};
  workspace_->get<StepLog>().plan_for(clock.most_ticks());
  if (options.jobs) {
    jobs_ = *options.jobs;
  } else {
    threads_.emplace(options.threads);
    jobs_ = threads_->jobs();
  }
  world_->set_owner_part(component_part<MuscleOwner>());
  for (const Module& module : modules_)
    for (const KeyPart& part : module.parts) our_parts_.push_back(part.id);
  std::ranges::sort(our_parts_);
  auto& owned = workspace_->get<SleepWork>().owned = our_parts_;
  for (const std::uint64_t kept : {type_id<Course<float>>(), type_id<Footing<float>>()}) std::erase(owned, kept);
  modules_.insert(modules_.end(), options.modules.begin(), options.modules.end());
  for (const Module& module : options.modules) {
    for (const NamedResource& one : module.resources) world_->share_as(one.part, one.resource);
  }
}

Result<Simulation> Simulation::make(const SimulationOptions& options) {
  const auto clock = Clock::make(options.tick_s, options.max_frame_s);
  if (!clock) return tl::unexpected(clock.error());
  Simulation simulation(options, *clock);
  auto schedule = make_schedule(simulation.modules_, options.memory);
  if (!schedule) return tl::unexpected(schedule.error());
  simulation.schedule_ = std::make_unique<Schedule>(std::move(*schedule));
  return simulation;
}

Simulation::Simulation(const SimulationOptions& options)
    : Simulation([&] {
        auto made = make(options);
        if (!made) throw std::invalid_argument(made.error().message);
        return std::move(*made);
      }()) {}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

bool Simulation::ours(std::uint64_t part) const {
  return std::ranges::binary_search(our_parts_, part);
}

Result<void> Simulation::destroy(Entity entity) {
  const auto place = world_->find(entity);
  if (!place) return fail(Status::stale_entity);
  const auto one_of_ours = [&](const KeyPart& part) { return ours(part.id); };
  if (std::ranges::any_of(place.table->key(), one_of_ours)) return fail(Status::not_yours);
  return result_of("destroy", world_->destroy(entity));
}

MuscleScene Simulation::muscle_scene() {
  return scene_of({*world_, jobs_, tick_, *workspace_});
}

Result<void> Simulation::spawn(std::span<const SpawnRequest> people, std::span<Entity> entities) {
  if (people.size() != entities.size()) {
    return fail(
        fmt::format("spawn: {} people, and room for the handles of {}; give as many", people.size(), entities.size()));
  }
  auto made = spawn_people(muscle_scene(), people, entities);
  if (!made)
    return fail(fmt::format("spawn: person {}: {}", made.error().person, made.error().error.message),
                made.error().error.status);
  return {};
}

Result<Entity> Simulation::spawn(const BodyRequest& body, const GaitRequest& gait) {
  const SpawnRequest request{.body = body, .gait = gait};
  Entity entity;
  auto made = spawn_people(muscle_scene(), {&request, 1}, {&entity, 1});
  if (!made) return tl::unexpected(made.error().error);
  return entity;
}

Result<Entity> Simulation::spawn_posed(const BodyRequest& body) {
  return mobil::spawn_posed(*world_, body);
}

Result<void> Simulation::set_pose(Entity human, const Pose<float>& pose, Arrival arrival) {
  auto done = mobil::set_pose(*world_, human, pose);
  if (done && arrival == Arrival::jumped) {
    forget_motion(*world_, human);
    forget_past(*world_, human);
    settle_fat(*world_, human);
  }
  workspace_->get<MuscleWork>().recent = {};
  return done;
}

Result<void> Simulation::despawn(std::span<const Entity> people) {
  return result_of("despawn", despawn_people(*world_, jobs_, people));
}

Result<void> Simulation::despawn(Entity human) {
  return despawn(std::span(&human, 1));
}

Result<void> Simulation::prepare(const LegMuscles& choice) {
  return named("prepare", library_->prepare(choice, tick_s(), jobs_));
}

std::vector<std::byte> Simulation::bake() const {
  return library_->bake();
}

Result<void> Simulation::load_baked(std::span<const std::byte> baked) {
  return named("load_baked", library_->load(baked));
}

/// A walker, awake or asleep, is asked for what could be made of a request.
Result<void> Simulation::ask(Entity human, const Result<Gait<float>>& gait) {
  if (!gait) return tl::unexpected(gait.error());
  const SleepTime now{tick_.index, tick_.dt_s};
  if (is_asleep(human)) {
    if (same_style(gait_of(*world_, human)->style, gait->style) && !is_busy(*world_, human, now)) {
      ask_sleepers(*world_, jobs_, std::array{AskedSleeper{human, *gait}}, now);
      return {};
    }
    if (auto done = make_whole_for(human); !done) return done;
  }
  return result_of("set_gait", world_->set(human, *gait));
}

Result<void> Simulation::change_gait(Entity human, const GaitChange& change) {
  auto gait = changed_gait(*world_, human, change);
  if (gait) keep_walk_limits(*world_, jobs_, human, *gait, workspace_->get<SleepWork>().styles);
  return ask(human, gait);
}

Result<void> Simulation::set_gait(Entity human, const GaitRequest& asked) {
  auto gait = new_gait(*world_, human, asked);
  if (gait) keep_walk_limits(*world_, jobs_, human, *gait, workspace_->get<SleepWork>().styles);
  return ask(human, gait);
}

Result<std::vector<StyleChange>> Simulation::style_changes(const BodyRequest& body, const GaitRequest& asked) {
  const auto made = make_body(body);
  if (!made) return tl::unexpected(made.error());
  auto gait = resolve_gait(*made, asked);
  if (!gait) return tl::unexpected(gait.error());
  return keep_walk_limits(body_size(body), *gait);
}

std::vector<BrokenLimit> Simulation::broken_limits(Entity person) const {
  return mobil::broken_limits(world(), person);
}

std::optional<GaitRequest> Simulation::gait_request(Entity human) const {
  return mobil::gait_request(*world_, human);
}

Result<void> Simulation::turn_to(Entity human, float heading_rad) {
  return ask(human, turned_gait(*world_, human, heading_rad));
}

Result<std::size_t> Simulation::change_walks(std::span<const WalkChange> changes) {
  std::vector<Entity>& people = workspace_->get<SleepWork>().rows;
  people.clear();
  for (const WalkChange& change : changes) people.push_back(change.human);
  if (!world_->alive_once(people)) return fail(Status::stale_entity);
  const SleepTime now{tick_.index, tick_.dt_s};
  find_asked(*world_, jobs_, changes, now, workspace_->get<SleepWork>(), people);
  if (!people.empty()) {
    if (auto done = wake(std::vector(people)); !done) return tl::unexpected(done.error());
  }
  return ask_walks(*world_, jobs_, changes, now, workspace_->get<SleepWork>());
}

Result<void> Simulation::step_aside(Entity human, float left_m, float ahead_m) {
  World::Attempt attempt(*world_, jobs_);
  if (auto done = make_whole_for(human); !done) return done;
  auto done = mobil::step_aside(*world_, human, left_m, ahead_m);
  if (done) attempt.keep();
  return done;
}

Result<std::size_t> Simulation::sleep(std::span<const Entity> people) {
  if (!world_->alive_once(people)) return fail(Status::stale_entity);
  auto& work = workspace_->get<SleepWork>();
  return sleep_people(muscle_scene(), people, false, {}, work.owned, work, [&] { return expand(people); });
}

Result<void> Simulation::wake(std::span<const Entity> people, float within_m) {
  if (!world_->alive_once(people)) return fail(Status::stale_entity);
  return named("wake", mobil::wake(muscle_scene(), *workspace_, people, within_m));
}

Result<std::size_t> Simulation::compact(std::span<const Entity> people) {
  if (!world_->alive_once(people)) return fail(Status::stale_entity);
  return compact_people(muscle_scene(), people, workspace_->get<CompactWork>());
}

Result<void> Simulation::expand(std::span<const Entity> people) {
  if (!world_->alive_once(people)) return fail(Status::stale_entity);
  World::Attempt attempt(*world_, jobs_);
  auto done = expand_people(muscle_scene(), people, workspace_->get<CompactWork>());
  if (done) attempt.keep();
  return named("expand", std::move(done));
}

bool Simulation::is_compact(Entity human) const {
  return mobil::is_compact(*world_, human);
}

bool Simulation::is_asleep(Entity human) const {
  return mobil::is_asleep(*world_, human);
}

void Simulation::reserve(std::size_t people) {
  world_->reserve_entities(people);
}

Status Simulation::read_absent(Entity entity, std::uint64_t part, void* row) const {
  if (is_compact(entity)) return read_compact(*world_, entity, part, row);
  return read_asleep(*world_, entity, {tick_.index, tick_.dt_s}, part, row);
}

Result<void> Simulation::place(Entity human, float x_m, float z_m, float heading_rad) {
  const PlaceRequest to{human, x_m, z_m, heading_rad};
  if (auto good = check_place(*world_, to); !good) return good;
  return place({&to, 1});
}

Result<void> Simulation::place(std::span<const PlaceRequest> places) {
  std::vector<Entity>& people = workspace_->get<SleepWork>().rows;
  people.clear();
  for (const PlaceRequest& to : places) people.push_back(to.person);
  if (!world_->alive_once(people)) return fail(Status::stale_entity);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (const auto good = check_place(*world_, places[i]); !good)
      return fail(fmt::format("person {}: {}", i, good.error().message), good.error().status);
  }
  // Relevance knows where those were whom it put to sleep: it is to look at them again.
  std::erase_if(people, [&](Entity person) { return !world_->has<SleepsManaged>(person); });
  if (!people.empty()) {
    if (auto done = wake(std::vector(people)); !done) return done;
  }
  place_people(*world_, {tick_.index, tick_.dt_s}, places, workspace_->get<SleepWork>().ways);
  workspace_->get<MuscleWork>().recent = {};
  return {};
}

Result<void> Simulation::shift_origin(float x_m, float z_m) {
  if (!(std::fabs(x_m) <= farthest_m && std::fabs(z_m) <= farthest_m))
    return fail(fmt::format("shift_origin: ({}, {}) m is not within ±1000000 m", x_m, z_m));
  shift_people(*world_, x_m, z_m);
  shift_muscles(*world_, x_m, z_m);
  shift_sleepers(*world_, {tick_.index, tick_.dt_s}, x_m, z_m);
  workspace_->get<MuscleWork>().recent = {};
  return {};
}

Result<void> Simulation::watch_steps(std::span<const Entity> people, bool on) {
  if (!world_->alive_once(people)) return fail(Status::stale_entity);
  return result_of("watch_steps", mobil::watch_steps(*world_, jobs_, people, on));
}

Result<void> Simulation::set_fat_wobble(std::span<const Entity> people, bool on) {
  if (!world_->alive_once(people)) return fail(Status::stale_entity);
  return result_of("set_fat_wobble", mobil::set_fat_wobble(*world_, jobs_, people, on));
}

Result<void> Simulation::roots(std::span<const Entity> people, std::span<Root> out, double ahead_s) const {
  return read_roots(*world_, people, {tick_.index, tick_.dt_s}, ahead_s, out);
}

Result<void> Simulation::add_leg_muscles(Entity human, const LegMuscles& choice) {
  World::Attempt attempt(*world_, jobs_);
  if (auto done = make_muscles_whole({&human, 1}); !done) return done;
  auto done = mobil::add_leg_muscles(muscle_scene(), human, choice);
  if (done) {
    attempt.keep();
    SimulationWorld::choose_from_now(*this, human);
  }
  return named("add_leg_muscles", std::move(done));
}

Result<void> Simulation::change_leg_muscles(Entity human, const LegMuscles& choice) {
  if (is_person(human) && !has_any_muscles(*world_, human))
    return named("change_leg_muscles",
                 Result<void>(fail("this person has no leg muscles; add them first", Status::missing)));
  if (auto ok = check_leg_muscles(*world_, *library_, tick_s(), human, choice); !ok)
    return named("change_leg_muscles", std::move(ok));
  if (auto done = make_muscles_whole({&human, 1}); !done) return done;
  auto done = mobil::change_leg_muscles(muscle_scene(), human, choice);
  if (done) SimulationWorld::choose_from_now(*this, human);
  return named("change_leg_muscles", std::move(done));
}

Result<void> Simulation::remove_leg_muscles(Entity human) {
  if (is_person(human) && !has_any_muscles(*world_, human)) return result_of("remove_leg_muscles", Status::missing);
  if (auto done = make_muscles_whole({&human, 1}); !done) return done;
  const Status status = mobil::remove_leg_muscles(*world_, jobs_, human);
  if (status == Status::ok) SimulationWorld::choose_from_now(*this, human);
  return result_of("remove_leg_muscles", status);
}

/// A change of muscles, before which who is asleep or compact is whole again: they stay as they were where it fails.
template <class F>
Result<void> Simulation::of_whole(Entity human, const char* name, const F& change) {
  if (!is_asleep(human) && !is_compact(human) && !kept_choice(*world_, human)) return named(name, change());
  World::Attempt attempt(*world_, jobs_);
  if (auto done = make_muscles_whole({&human, 1}); !done) return done;
  auto done = change();
  if (done) attempt.keep();
  return named(name, std::move(done));
}

Result<void> Simulation::set_excitation(Entity human, Muscle muscle, Side side, float excitation) {
  return of_whole(human, "set_excitation",
                  [&] { return mobil::set_excitation(*world_, human, muscle, side, excitation); });
}
Result<void> Simulation::set_method(Entity human, Muscle muscle, const MuscleMethod& method) {
  return of_whole(human, "set_method", [&] { return mobil::set_method(muscle_scene(), human, muscle, method); });
}

MuscleMethod Simulation::method(Entity human, Muscle muscle) const {
  if (is_compact(human)) return compact_method(*world_, human, muscle);
  const Entity right_one = this->muscle(human, muscle, Side::right);
  return muscle_method(*world_, world_->alive(right_one) ? right_one : this->muscle(human, muscle, Side::left));
}

Ticks Simulation::advance(double seconds) {
  const Ticks ticks = clock_.advance(seconds);
  tick(ticks.count);
  return ticks;
}

void Simulation::tick(std::uint32_t count) {
  workspace_->get<StepLog>().clear();
  for (std::uint32_t i = 0; i < count; ++i) schedule_->tick(*world_, tick_, *workspace_, jobs_);
}

std::span<const StepEvent> Simulation::events() const {
  return workspace_->get<StepLog>().events();
}

StepReport Simulation::report() const {
  return read_report(*schedule_, tick_.index);
}

std::size_t Simulation::snapshot_bytes() const {
  return mobil::snapshot_bytes({*world_, *library_, modules_, jobs_}, workspace_->get<SnapshotWork>());
}

Result<std::size_t> Simulation::save(std::span<std::byte> out) const {
  const SnapshotTime time{clock_.tick_units(), clock_.remainder_units(), tick_.index};
  return save_snapshot({*world_, *library_, modules_, jobs_}, time, workspace_->get<SnapshotWork>(), out);
}

Result<void> Simulation::restore(std::span<const std::byte> in, const RestoreLimits& limits) {
  const auto done = restore_snapshot({*world_, *library_, modules_, jobs_}, {clock_.tick_units(), 0, 0},
                                     workspace_->get<SnapshotWork>(), limits, in);
  if (!done) return fail("restore: " + done.error().message, done.error().status);
  workspace_->get<MuscleWork>().recent = {};
  workspace_->get<StepLog>().clear();
  tick_.index = done->tick;
  clock_.set_remainder_units(done->remainder_units);
  return {};
}

std::uint64_t Simulation::state_hash() const {
  return state_hash_of(state_sum(), tick_.index);
}

std::uint64_t Simulation::state_sum() const {
  return mobil::state_hash(*world_, jobs_);
}

bool Simulation::is_person(Entity entity) const {
  return mobil::is_person(*world_, entity);
}

std::vector<Entity> Simulation::people() const {
  return read_people(*world_);
}

std::vector<OwnMuscle> Simulation::muscles(Entity human) const {
  return muscles_of(*world_, human);
}

std::optional<Human> Simulation::human(Entity entity) const {
  return read_human(*this, entity);
}

Entity Simulation::muscle(Entity human, Muscle muscle, Side side) const {
  return muscle_of(*world_, human, muscle, side);
}

}  // namespace mobil::inline v0_3
