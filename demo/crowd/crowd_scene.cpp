#include "demo/crowd/crowd_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assets/body/anthropometry.h"
#include "demo/bake/baked_file.h"
#include "systems/gait/gait.h"

namespace mobil {
namespace {

constexpr double square_metres_each = 2.5;
constexpr std::uint32_t most_draws = 20;
constexpr std::size_t batch = 1000;  // people who are spawned between two looks at the bar
constexpr double settling_s = 2;     // what the taking up of a muscle excites falls by e⁻⁴ a second
constexpr std::uint64_t exchange_stream = 0x30000;

}  // namespace

CrowdScene::CrowdScene(const CrowdRequest& request) : request_(request) {
  due_.fill(-1);
  simulation_ = std::make_unique<Simulation>(SimulationOptions{.threads = request.threads, .memory = &memory_});
  muscles_ = first_muscles();
}

/// What most of those far away need, so that nobody begins with another.
LegMuscles CrowdScene::first_muscles() const {
  LegMuscles choice;
  choice.inertia = request_.effects.inertia;
  choice.line_motion = request_.effects.line_motion;
  if (request_.effects.activation) choice.activation = ExcitationSource::phase;
  const RungLadder ladder(accuracy_table());
  const float limit_m = static_cast<float>(request_.tolerance_m) / RelevanceOptions{}.margin;
  std::array<std::size_t, rung_count> wanted{};
  for (std::uint32_t m = 0; m < muscle_group_count; ++m) {
    const RungCase of = {m, RungLadder::speed_step(1.35F, 1.72F), choice.inertia, request_.all_seen,
                         request_.effects.activation};
    ++wanted[ladder.cheapest(of, limit_m)];
  }
  const auto most = static_cast<std::size_t>(std::ranges::max_element(wanted) - wanted.begin());
  const MuscleMethod method = rung_method(most, request_.all_seen, request_.effects.activation);
  choice.method = method.method;
  choice.reduced = method.reduced;
  return choice;
}

std::size_t CrowdScene::bytes_of_people() const {
  return memory_.lent();
}

Result<std::unique_ptr<CrowdScene>> CrowdScene::make(const CrowdRequest& request, const Progress& progress) {
  std::unique_ptr<CrowdScene> scene(new CrowdScene(request));
  if (auto done = load_baked_option(*scene->simulation_, request.baked); !done) return tl::unexpected(done.error());
  if (request.effects.muscles) {
    RelevanceOptions options;
    options.switches = 8;  // near ones change every second: spread over it
    // Who needs otherwise says so once a second: some hundreds looked at each tick are soon enough.
    options.stagger = static_cast<std::uint32_t>(std::clamp<std::size_t>(request.humans / 500, 8, 60));
    options.leg_muscles = scene->muscles_;
    if (!request.budget_s) options.machine_factor = 1;
    scene->relevance_ = std::make_unique<Relevance>(*scene->simulation_, options);
    SceneNeeds needs;
    needs.tolerance_m = static_cast<float>(request.tolerance_m);
    needs.looked_at = request.all_seen;
    needs.compact_unseen = true;
    needs.budget_s = request.budget_s;
    if (auto done = scene->relevance_->set_scene(needs); !done) return tl::unexpected(done.error());
    const float near_m[] = {static_cast<float>(request.near_tolerance_m)};
    const auto preparing = [&](std::size_t done, std::size_t of) {
      if (progress) progress("preparing", done, of);
    };
    if (auto done = scene->relevance_->prepare(std::span(near_m).first(request.near > 0 ? 1 : 0), preparing); !done)
      return tl::unexpected(done.error());
  }
  if (auto done = scene->resize(request.humans, progress); !done) return tl::unexpected(done.error());
  return scene;
}

Result<void> CrowdScene::resize(std::size_t humans, const Progress& progress) {
  request_.humans = humans;
  side_m_ = std::sqrt(square_metres_each * static_cast<double>(humans));
  const std::size_t before = walkers_.size();
  if (humans < before) {
    leave(humans, before - humans);
    walkers_.resize(humans);
  }
  walkers_.resize(humans);
  distance_.reserve(humans);
  for (std::size_t slot = before; slot < humans; slot += batch) {
    if (auto done = come(slot, std::min(batch, humans - slot)); !done) return done;
    if (progress) progress("spawning", std::min(slot + batch, humans), humans);
  }
  CrowdDecisions decisions;
  return choose_near(decisions);
}

Result<void> CrowdScene::settle(const Progress& progress) {
  constexpr int most_updates = 20000, updates_a_tick = 8, quiet_updates = 40;
  const auto tick_once = [&]() -> Result<void> {
    if (auto done = decide(); !done) return tl::unexpected(done.error());
    tick();
    return {};
  };
  int quiet = 0;
  for (int i = 0; relevance_ && i < most_updates && quiet < quiet_updates; ++i) {
    const RelevanceReport report = choose_methods();
    quiet = report.switched + report.waiting == 0 ? quiet + 1 : 0;
    if (i % updates_a_tick != 0) continue;
    if (auto done = tick_once(); !done) return done;
  }
  const auto ticks = static_cast<std::size_t>(settling_s / simulation_->tick_s());
  for (std::size_t i = 0; i < ticks; ++i) {
    choose_methods();
    if (auto done = tick_once(); !done) return done;
    if (progress) progress("settling", i + 1, ticks);
  }
  return {};
}

/// New people in these slots, at places of their own. Who cannot walk as drawn is drawn again.
Result<void> CrowdScene::come(std::size_t slot, std::size_t count) {
  requests_.assign(count, {});
  entities_.resize(count);
  const auto draw = [&](std::size_t i) {
    CrowdWalker& walker = walkers_[slot + i];
    CrowdPerson person = crowd_person(request_.seed, walker.number, walker.draw);
    SpawnRequest& request = requests_[i];
    request.body = person.body;
    request.gait = person.gait;
    request.x_m = walker.x_m;
    request.z_m = walker.z_m;
    request.heading_rad = walker.heading_rad;
    if (request_.effects.muscles) request.muscles = muscles_;
    if (relevance_ != nullptr) request.parts = relevance_parts();
  };
  for (std::size_t i = 0; i < count; ++i) {
    CrowdWalker& walker = walkers_[slot + i];
    walker = {};
    walker.number = next_number_++;
    const CrowdPlace place = crowd_place(request_.seed, walker.number);
    walker.x_m = place.across * static_cast<float>(side_m_);
    walker.z_m = place.along * static_cast<float>(side_m_);
    walker.heading_rad = place.heading_rad;
    draw(i);
  }
  for (auto done = simulation_->spawn(requests_, entities_); !done; done = simulation_->spawn(requests_, entities_)) {
    std::size_t again = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto body = make_body(requests_[i].body);
      if (body && resolve_gait(*body, requests_[i].gait)) continue;
      if (++walkers_[slot + i].draw == most_draws) return done;
      ++again;
      draw(i);
    }
    if (again == 0) return done;
    drawn_again_ += again;
  }
  for (std::size_t i = 0; i < count; ++i) {
    CrowdWalker& walker = walkers_[slot + i];
    walker.entity = entities_[i];
    if (slot_of_.size() <= walker.entity.index) slot_of_.resize(2 * walker.entity.index + std::size_t{1});
    slot_of_[walker.entity.index] = static_cast<std::uint32_t>(slot + i);
    plan(slot + i);
    if (relevance_) {
      if (auto done = relevance_->manage(walker.entity); !done) return done;
    }
    if (request_.effects.forces) simulation_->add_forces(walker.entity);
  }
  return {};
}

void CrowdScene::leave(std::size_t slot, std::size_t count) {
  entities_.clear();
  for (std::size_t i = slot; i < slot + count; ++i) {
    forget_plan(i);
    entities_.push_back(walkers_[i].entity);
  }
  simulation_->despawn(entities_);
}

/// So many leave, whoever they are, and as many come in their stead.
Result<void> CrowdScene::exchange(std::size_t count, CrowdDecisions& decisions) {
  CrowdRandom random(request_.seed, exchanges_++, exchange_stream);
  count = std::min(count, walkers_.size());
  for (std::size_t slot = random.below(walkers_.size()); count > 0; slot = 0) {
    const std::size_t here = std::min(count, walkers_.size() - slot);
    leave(slot, here);
    if (auto done = come(slot, here); !done) return done;
    decisions.despawned += here;
    decisions.spawned += here;
    count -= here;
  }
  return {};
}

Result<CrowdDecisions> CrowdScene::decide() {
  CrowdDecisions decisions;
  if (walkers_.empty()) return decisions;
  const std::uint32_t now = simulation_->ticks();
  const auto a_second = static_cast<std::uint32_t>(std::lround(1 / simulation_->tick_s()));
  if (now % a_second == 0 && now > 0) {
    if (auto done = look_round(decisions); !done) return tl::unexpected(done.error());
  }
  owed_ += request_.churn_per_s * simulation_->tick_s();
  auto leaving = static_cast<std::size_t>(owed_);
  owed_ -= static_cast<double>(leaving);
  if (now % a_second == a_second / 2) leaving += request_.burst;
  if (leaving > 0) {
    if (auto done = exchange(leaving, decisions); !done) return tl::unexpected(done.error());
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

RelevanceReport CrowdScene::choose_methods() {
  return relevance_ ? relevance_->update() : RelevanceReport{};
}

void CrowdScene::tick() {
  simulation_->tick();
}

std::array<std::size_t, rung_count + 1> CrowdScene::muscles_by_rung() const {
  return relevance_ ? relevance_->muscles_by_rung(request_.effects.activation)
                    : std::array<std::size_t, rung_count + 1>{};
}

}  // namespace mobil
