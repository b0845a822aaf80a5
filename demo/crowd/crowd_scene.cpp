#include "demo/crowd/crowd_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <mobil/avoidance.h>
#include <mobil/lod.h>
#include <mobil/shard_bytes.h>
#include <mobil/step_report.h>
#include <mobil/systems/cluster/shard.h>
#include "demo/bake/baked_file.h"

namespace mobil {
namespace {

constexpr double square_metres_each = 2.5;
constexpr std::size_t batch = 1000;  // people spawned between two updates of the progress bar
constexpr double settling_s = 2;     // vibrations of newly added muscles decay by e⁻⁴ per second
constexpr std::uint64_t exchange_stream = 0x30000;

}  // namespace

double crowd_side_m(std::size_t people) {
  return std::sqrt(square_metres_each * static_cast<double>(people));
}

CrowdScene::CrowdScene(const CrowdRequest& request) : request_(request) {
  due_.fill(-1);
  simulation_ = std::make_unique<Simulation>(
      SimulationOptions{.threads = request.threads, .memory = &memory_, .library_of = request.library});
  muscles_ = first_muscles();
}

/// Returns the method that most muscle groups of distant people need; all people start with it.
LegMuscles CrowdScene::first_muscles() const {
  LegMuscles choice;
  choice.muscles = request_.muscles;
  choice.inertia = request_.effects.inertia;
  choice.line_motion = request_.effects.line_motion;
  if (request_.effects.activation) choice.activation = ExcitationSource::phase;
  const LodTable lod_table(accuracy_table());
  const float limit_m = static_cast<float>(request_.tolerance_m) / LodOptions{}.margin;
  std::array<std::size_t, level_count> wanted{};
  for (std::uint32_t m = 0; m < muscle_count; ++m) {
    if (!choice.muscles[m]) continue;
    const LevelCase of = {m, LodTable::speed_step(1.35F, 1.72F), choice.inertia, request_.all_seen,
                          request_.effects.activation};
    ++wanted[lod_table.cheapest(of, limit_m)];
  }
  const auto most = static_cast<std::size_t>(std::ranges::max_element(wanted) - wanted.begin());
  const MuscleMethod method = level_method(most, request_.all_seen, request_.effects.activation);
  choice.method = method.method;
  choice.modal = method.modal;
  return choice;
}

std::size_t CrowdScene::bytes_of_people() const {
  return memory_.lent();
}

Result<std::unique_ptr<CrowdScene>> CrowdScene::make(const CrowdRequest& request, const Progress& progress) {
  auto scene = make_empty(request, progress);
  if (!scene) return scene;
  if (auto done = (*scene)->resize(request.people, progress); !done) return tl::unexpected(done.error());
  return scene;
}

Result<std::unique_ptr<CrowdScene>> CrowdScene::make_empty(const CrowdRequest& request, const Progress& progress) {
  std::unique_ptr<CrowdScene> scene(new CrowdScene(request));
  scene->request_.people = 0;
  if (request.library == nullptr) {
    if (auto done = load_baked_option(*scene->simulation_, request.baked); !done) return tl::unexpected(done.error());
  }
  if (request.effects.muscles) {
    LodOptions& options = scene->choosing_.emplace();
    // Near people change every second. The muscles of two people in a tick spread the switches over it.
    options.switches = static_cast<std::uint32_t>(2 * std::max<std::size_t>(request.muscles.count(), 1));
    // Needs change at most once a second, so checking some hundreds of people per tick is enough.
    options.stagger = static_cast<std::uint32_t>(std::clamp<std::size_t>(request.people / request.shards / 500, 8, 60));
    options.leg_muscles = scene->muscles_;
    if (!request.budget_s) options.machine_factor = 1;
    Lod lod = scene->simulation_->lod();
    if (auto done = lod.set_options(options); !done) return tl::unexpected(done.error());
    LodScene needs;
    needs.muscles = request.muscles;
    needs.tolerance_m = static_cast<float>(request.tolerance_m);
    needs.looked_at = request.all_seen;
    needs.compact_unseen = true;
    if (request.budget_s) needs.budget_s = *request.budget_s / request.shards;
    if (auto done = lod.set_scene(needs); !done) return tl::unexpected(done.error());
    const float near_m[] = {static_cast<float>(request.near_tolerance_m)};
    const auto preparing = [&](std::size_t done, std::size_t of) {
      if (progress) progress("preparing", done, of);
    };
    const auto tolerances_m = std::span(near_m).first(request.near > 0 ? 1 : 0);
    if (auto done = prepare_and_keep(*scene->simulation_, tolerances_m, preparing); !done)
      return tl::unexpected(done.error());
  }
  return scene;
}

bool CrowdScene::is_own(std::uint32_t place) const {
  return request_.shards == 1 || shard_of(place, request_.shards) == request_.shard;
}

/// Returns the slot of this shard's first walker whose place is not before `place`.
std::size_t CrowdScene::first_slot_from(std::uint32_t place) const {
  if (request_.shards == 1) return std::min<std::size_t>(place, walkers_.size());
  const auto found = std::ranges::lower_bound(walkers_, place, {}, &CrowdWalker::place);
  return static_cast<std::size_t>(found - walkers_.begin());
}

Result<void> CrowdScene::resize(std::size_t people, const Progress& progress) {
  const std::size_t before = std::exchange(request_.people, people);
  side_m_ = crowd_side_m(people);
  if (people < before) {
    const std::size_t first = first_slot_from(static_cast<std::uint32_t>(people));
    slots_.resize(walkers_.size() - first);
    std::iota(slots_.begin(), slots_.end(), static_cast<std::uint32_t>(first));
    leave(slots_);
    walkers_.resize(first);
  }
  walkers_.reserve(people / request_.shards);
  for (std::size_t first = before; first < people; first += batch) {
    slots_.clear();
    for (std::size_t place = first; place < std::min(first + batch, people); ++place) {
      const std::uint64_t number = director_.next_number++;
      if (!is_own(static_cast<std::uint32_t>(place))) continue;
      slots_.push_back(static_cast<std::uint32_t>(walkers_.size()));
      walkers_.push_back({.number = number, .place = static_cast<std::uint32_t>(place)});
    }
    if (auto done = come(slots_); !done) return done;
    if (progress) progress("spawning", std::min(first + batch, people), people);
  }
  distance_.reserve(walkers_.size());
  CrowdDecisions decisions;
  return choose_near(decisions);
}

Result<void> CrowdScene::settle(const Progress& progress, bool exchanges) {
  constexpr int max_ticks = 2000, quiet_ticks = 4;
  const auto tick_once = [&]() -> Result<void> {
    if (auto done = exchanges ? decide() : decide({}); !done) return tl::unexpected(done.error());
    tick();
    return {};
  };
  if (choosing_) {
    LodOptions at_once = *choosing_;
    at_once.stagger = 1;
    at_once.switches = 1'000'000;
    at_once.switching_s = 1;
    if (auto done = simulation_->lod().set_options(at_once); !done) return done;
    for (int i = 0, settled = 0; i < max_ticks && settled < quiet_ticks; ++i) {
      if (auto done = tick_once(); !done) return done;
      const LodReport& report = simulation_->lod().report();
      settled = report.switched + report.waiting == 0 ? settled + 1 : 0;
    }
    if (auto done = simulation_->lod().set_options(*choosing_); !done) return done;
  }
  const auto ticks = static_cast<std::size_t>(settling_s / simulation_->tick_s());
  for (std::size_t i = 0; i < ticks; ++i) {
    if (auto done = tick_once(); !done) return done;
    if (progress) progress("settling", i + 1, ticks);
  }
  return {};
}

/// Spawns new people in these slots, whose numbers and places are set. A random person who cannot walk is drawn again.
Result<void> CrowdScene::come(std::span<const std::uint32_t> slots) {
  requests_.assign(slots.size(), {});
  entities_.resize(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    CrowdWalker& walker = walkers_[slots[i]];
    walker = {.number = walker.number, .place = walker.place};
    const auto person = crowd_walker(request_.seed, walker.number, walker.draw);
    if (!person) return tl::unexpected(person.error());
    walker.party_place = static_cast<std::uint8_t>(walker.number - person->party_first);
    walker.usual_m_s = *person->gait.speed_m_s;
    const CrowdPlace place = crowd_place(request_.seed, walker.party());
    const CrowdOffset beside = crowd_abreast(walker.party_place, person->party_size, place.heading_rad);
    walker.x_m = place.across * static_cast<float>(side_m_) + beside.x_m;
    walker.z_m = place.along * static_cast<float>(side_m_) + beside.z_m;
    walker.heading_rad = place.heading_rad;
    SpawnRequest& request = requests_[i];
    request = {.body = person->body, .gait = person->gait};
    request.x_m = walker.x_m;
    request.z_m = walker.z_m;
    request.heading_rad = walker.heading_rad;
    if (request_.effects.muscles) request.muscles = muscles_;
    if (choosing_) request.parts = managed_parts();
  }
  if (auto done = simulation_->spawn(requests_, entities_); !done) return done;
  if (choosing_) {
    if (auto done = simulation_->lod().manage(entities_); !done) return done;
  }
  if (request_.effects.avoidance) {
    if (auto done = simulation_->avoidance().manage(entities_); !done) return done;
  }
  for (std::size_t i = 0; i < slots.size(); ++i) {
    CrowdWalker& walker = walkers_[slots[i]];
    walker.entity = entities_[i];
    keep_slot(slots[i]);
    plan(slots[i]);
    if (request_.effects.forces) simulation_->enable(walker.entity, Feature::forces);
  }
  return {};
}

void CrowdScene::keep_slot(std::size_t slot) {
  const std::uint32_t index = walkers_[slot].entity.index;
  if (slot_of_.size() <= index) slot_of_.resize(2 * index + std::size_t{1});
  slot_of_[index] = static_cast<std::uint32_t>(slot);
}

void CrowdScene::leave(std::span<const std::uint32_t> slots) {
  entities_.clear();
  for (const std::uint32_t slot : slots) {
    forget_plan(slot);
    entities_.push_back(walkers_[slot].entity);
  }
  simulation_->despawn(entities_);
}

/// Returns the people replaced in this tick, from a random place on, as many as churn and burst require.
CrowdOrders CrowdDirector::order(const CrowdRequest& request, std::uint32_t tick, double tick_s) {
  const auto a_second = static_cast<std::uint32_t>(std::lround(1 / tick_s));
  owed += request.churn_per_s * tick_s;
  auto leaving = static_cast<std::size_t>(owed);
  owed -= static_cast<double>(leaving);
  if (tick % a_second == a_second / 2) leaving += request.burst;
  leaving = std::min(leaving, request.people);
  if (leaving == 0) return {};
  CrowdRandom random(request.seed, exchanges++, exchange_stream);
  const CrowdOrders orders{next_number, static_cast<std::uint32_t>(random.below(request.people)),
                           static_cast<std::uint32_t>(leaving)};
  next_number += leaving;
  return orders;
}

Result<void> CrowdScene::exchange(const CrowdOrders& orders, CrowdDecisions& decisions) {
  const auto places = static_cast<std::uint32_t>(request_.people);
  slots_.clear();
  const auto add = [&](std::uint32_t from, std::uint32_t to, std::uint64_t number) {
    for (std::size_t s = first_slot_from(from); s < walkers_.size() && walkers_[s].place < to; ++s) {
      slots_.push_back(static_cast<std::uint32_t>(s));
      walkers_[s].number = number + (walkers_[s].place - from);
    }
  };
  const std::uint32_t to_the_end = std::min(orders.count, places - orders.first_place);
  add(orders.first_place, orders.first_place + to_the_end, orders.first_number);
  add(0, orders.count - to_the_end, orders.first_number + to_the_end);
  decisions.despawned += slots_.size();
  decisions.spawned += slots_.size();
  leave(slots_);
  return come(slots_);
}

Result<CrowdDecisions> CrowdScene::decide() {
  return decide(walkers_.empty() ? CrowdOrders{}
                                 : director_.order(request_, simulation_->ticks(), simulation_->tick_s()));
}

Result<CrowdDecisions> CrowdScene::decide(const CrowdOrders& orders) {
  CrowdDecisions decisions;
  if (walkers_.empty()) return decisions;
  const std::uint32_t now = simulation_->ticks();
  const auto a_second = static_cast<std::uint32_t>(std::lround(1 / simulation_->tick_s()));
  if (now % a_second == 0 && now > 0) {
    if (auto done = look_round(decisions); !done) return tl::unexpected(done.error());
  }
  if (orders.count > 0) {
    if (orders.count > request_.people || orders.first_place >= request_.people)
      return fail("orders refer to places outside the crowd");
    if (auto done = exchange(orders, decisions); !done) return tl::unexpected(done.error());
  }
  std::int32_t& first = due_[now % ring];
  while (first >= 0) {
    const auto slot = static_cast<std::size_t>(first);
    forget_plan(slot);
    if (auto done = carry_out(walkers_[slot], decisions); !done) return tl::unexpected(done.error());
    plan(slot);
  }
  return decisions;
}

Result<std::vector<std::byte>> CrowdScene::save() const {
  PlainBytes host;
  host.put(std::uint64_t{walkers_.size()});
  host.put_all(std::span<const CrowdWalker>(walkers_));
  host.put(due_);
  host.put(std::uint64_t{request_.people});
  return pack_shard(*simulation_, host.bytes());
}

Result<void> CrowdScene::restore(std::span<const std::byte> saved) {
  const auto host = unpack_shard(saved, *simulation_);
  if (!host) return tl::unexpected(host.error());
  PlainReader reader(*host);
  std::uint64_t count = 0, people = 0;
  reader.take(count);
  walkers_ = reader.take_many<CrowdWalker>(static_cast<std::size_t>(count));
  reader.take(due_);
  reader.take(people);
  if (!reader.whole()) return fail("the bytes of a crowd are inconsistent");
  request_.people = static_cast<std::size_t>(people);
  side_m_ = crowd_side_m(request_.people);
  for (std::size_t slot = 0; slot < walkers_.size(); ++slot) keep_slot(slot);
  distance_.reserve(walkers_.size());
  return {};
}

void CrowdScene::tick() {
  simulation_->tick();
}

std::array<std::size_t, level_count + 1> CrowdScene::muscles_by_level() const {
  return choosing_ ? simulation_->lod().muscles_by_level(request_.effects.activation)
                   : std::array<std::size_t, level_count + 1>{};
}

}  // namespace mobil
