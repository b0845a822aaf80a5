#include "demo/town/town_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <mobil/avoidance.h>
#include <mobil/components/avoidance.h>
#include <mobil/step_report.h>
#include <mobil/terrain.h>
#include "demo/measure/measure.h"
#include "demo/measure/phase_time.h"
#include "demo/scene/crowd_people.h"

namespace mobil {
namespace {

// Distances at which a corner, or the destination, is reached.
constexpr float corner_m = 0.5F, arrived_m = 1;
constexpr std::uint32_t wishes_every = 6, ways_every = 120;  // ticks
constexpr float on_stairs_m_s = 0.65F;
constexpr std::uint64_t place_stream = 0x60000;

float squared(float x) {
  return x * x;
}
float apart_m(const GroundPoint& a, const GroundPoint& b) {
  return std::sqrt(squared(a.x_m - b.x_m) + squared(a.z_m - b.z_m));
}
GroundPoint place_of(const Root& root) {
  return {static_cast<float>(root.x_m), static_cast<float>(root.z_m)};
}

}  // namespace

TownScene::TownScene(TownPaths paths, const TownOptions& options)
    : paths_(std::move(paths)),
      simulation_(std::make_unique<Simulation>(SimulationOptions{.threads = options.threads})),
      seed_(options.seed) {
  simulation_->terrain().set_options({.slows_down = true});
  simulation_->terrain().set_heights([](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
    for (std::size_t i = 0; i < at.size(); ++i) out[i] = town_ground(at[i].x_m, at[i].z_m);
  });
}
TownScene::TownScene(TownScene&&) noexcept = default;
TownScene::~TownScene() = default;

Result<TownScene> TownScene::make(const TownOptions& options) {
  auto paths = TownPaths::make();
  if (!paths) return tl::unexpected(paths.error());
  TownScene scene(std::move(*paths), options);
  if (auto come = scene.people_come(options); !come) return tl::unexpected(come.error());
  return scene;
}

/// Spawns people at random points between two places. Parties stand together. The first person stands alone, at the start
/// of the tour.
Result<void> TownScene::people_come(const TownOptions& options) {
  const auto places = town_places();
  std::vector<SpawnRequest> requests(options.people);
  pedestrians_.resize(options.people);
  std::vector<GroundPoint> way;
  std::vector<GroundPoint> taken;
  for (std::size_t i = 0; i < options.people; ++i) {
    const CrowdPerson person = crowd_person(options.seed, i, 0);
    SpawnRequest& request = requests[i];
    request.body = person.body;
    request.gait = person.gait;
    Pedestrian& pedestrian = pedestrians_[i];
    pedestrian.speed_m_s = std::max(*person.gait.speed_m_s, 0.9F);
    request.gait.speed_m_s = 0;  // a walking start could be an unavoidable collision
    CrowdRandom random(options.seed, i, place_stream);
    GroundPoint at = places.front();
    constexpr int tries = 40;
    constexpr float least_apart_m = 0.7F;
    const bool follows = person.party_first > 0 && person.party_first < i;
    pedestrian.leader = follows ? person.party_first : i;
    const SpawnRequest& leader = requests[pedestrian.leader];
    const CrowdOffset off =
        crowd_abreast(static_cast<std::uint32_t>(i - pedestrian.leader), person.party_size, leader.heading_rad);
    const GroundPoint beside{leader.x_m + off.x_m, leader.z_m + off.z_m};
    const auto crowds = [&](const GroundPoint& other) { return apart_m(beside, other) < least_apart_m; };
    const bool joins = follows && std::ranges::none_of(taken, crowds) && !on_town_stairs(beside.x_m, beside.z_m);
    if (joins) at = beside;
    for (int k = 0; i > 0 && !joins && k < tries; ++k) {
      const GroundPoint from = places[random.below(places.size())], to = places[random.below(places.size())];
      paths_.find(from, to, way);
      if (way.empty()) continue;
      const float part = random.even(0, 1);
      at = {std::lerp(from.x_m, way.front().x_m, part), std::lerp(from.z_m, way.front().z_m, part)};
      const auto near = [&](const GroundPoint& other) { return apart_m(at, other) < 1; };
      if (std::ranges::none_of(taken, near) && !on_town_stairs(at.x_m, at.z_m)) break;
    }
    taken.push_back(at);
    request.x_m = at.x_m;
    request.z_m = at.z_m;
    request.heading_rad = joins ? leader.heading_rad : random.even(-3, 3);
    if (i == 0) request.heading_rad = 0;
  }
  people_.resize(options.people);
  roots_.resize(options.people);
  if (auto done = simulation_->spawn(requests, people_); !done) return done;
  if (auto done = simulation_->avoidance().set_walls(town_walls()); !done) return done;
  if (auto done = simulation_->avoidance().manage(people_); !done) return done;
  if (auto done = simulation_->terrain().manage(people_); !done) return done;
  if (auto done = simulation_->roots(people_, roots_); !done) return done;
  for (std::size_t i = 0; i < people_.size(); ++i) {
    pedestrians_[i].radius_m = simulation_->get<AvoidanceState>(people_[i])->radius_m;
    choose_place(i);
  }
  return {};
}

void TownScene::choose_place(std::size_t number) {
  Pedestrian& pedestrian = pedestrians_[number];
  const std::size_t places = town_places().size();
  if (number == 0 && pedestrian.toured < tour_stops) {
    pedestrian.place = ++pedestrian.toured;
  } else {
    CrowdRandom random(seed_, pedestrian.leader, place_stream + ++pedestrian.drawn);
    const std::size_t before = pedestrian.place;
    while (pedestrian.place == before) pedestrian.place = random.below(places);
  }
  find_way(number);
}

void TownScene::find_way(std::size_t number) {
  Pedestrian& pedestrian = pedestrians_[number];
  const double begin_s = wall_now_s();
  paths_.find(place_of(roots_[number]), town_places()[pedestrian.place], pedestrian.corners);
  report_.paths_s += wall_now_s() - begin_s;
  ++report_.paths;
  pedestrian.next = 0;
}

/// Requests a velocity toward the next corner, slower on stairs.
void TownScene::follow_way(std::size_t number) {
  Pedestrian& pedestrian = pedestrians_[number];
  const GroundPoint at = place_of(roots_[number]);
  while (pedestrian.next + 1 < pedestrian.corners.size() && apart_m(at, pedestrian.corners[pedestrian.next]) < corner_m)
    ++pedestrian.next;
  if (!pedestrian.corners.empty() && apart_m(at, pedestrian.corners.back()) < arrived_m) {
    ++report_.arrivals;
    choose_place(number);
  }
  DesiredVelocity wish{people_[number], 0, pedestrian.wish.heading_rad};
  if (!pedestrian.corners.empty()) {  // without a path the person waits
    const GroundPoint& to = pedestrian.corners[pedestrian.next];
    wish.heading_rad = std::atan2(to.x_m - at.x_m, to.z_m - at.z_m);
    wish.speed_m_s = on_town_stairs(at.x_m, at.z_m) ? on_stairs_m_s : pedestrian.speed_m_s;
  }
  constexpr float turned_rad = 0.01F;
  if (pedestrian.asked && wish.speed_m_s == pedestrian.wish.speed_m_s &&
      std::fabs(wish.heading_rad - pedestrian.wish.heading_rad) < turned_rad)
    return;
  pedestrian.wish = wish;
  pedestrian.asked = true;
  wishes_.push_back(wish);
}

void TownScene::tick() {
  const std::uint32_t now = simulation_->ticks();
  wishes_.clear();
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const auto turn = static_cast<std::uint32_t>(i);
    if ((now + turn) % ways_every == 0) find_way(i);
    if ((now + turn) % wishes_every == 0 || !pedestrians_[i].asked) follow_way(i);
  }
  (void)simulation_->avoidance().set_desired_velocity(wishes_);  // in range
  const double begin_s = wall_now_s();
  simulation_->tick();
  report_.tick_s += wall_now_s() - begin_s;
  report_.places_asked += simulation_->terrain().report().places;
  report_.avoidance_s += phase_s(*simulation_, "avoidance");
  report_.terrain_s += phase_s(*simulation_, "ground");
  ++report_.ticks;
  measure();
}

void TownScene::measure() {
  const std::vector<Root> before = roots_;
  (void)simulation_->roots(people_, roots_);
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const GroundPoint at = place_of(roots_[i]);
    report_.walked_m += std::hypot(roots_[i].x_m - before[i].x_m, roots_[i].z_m - before[i].z_m);
    for (std::size_t j = 0; j < i; ++j) {
      const float between_m = apart_m(at, place_of(roots_[j])) - pedestrians_[i].radius_m - pedestrians_[j].radius_m;
      report_.nearest_m = std::min(report_.nearest_m, static_cast<double>(between_m));
    }
    const float waits_s = simulation_->get<AvoidanceState>(people_[i])->waits_s;
    report_.longest_wait_s = std::max(report_.longest_wait_s, static_cast<double>(waits_s));
  }
}

}  // namespace mobil
