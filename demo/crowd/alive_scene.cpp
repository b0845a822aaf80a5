#include "demo/crowd/alive_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/body/anthropometry.h"
#include "components/relevance.h"
#include "demo/bake/baked_file.h"
#include "systems/gait/asleep.h"
#include "systems/gait/gait.h"

namespace mobil {
namespace {

constexpr double ground_m2_each = 1;
constexpr std::size_t come_together = 1024;
constexpr std::uint32_t most_draws_alive = 20;
constexpr std::uint64_t camera_stream = 0x50000, inward_stream = 0x40000;
constexpr float eye_height_m = 5, flies_m_s = 8, turns_rad_s = 0.35F, half_angle_rad = std::numbers::pi_v<float> / 6;
constexpr float pixel_rad = 2 * half_angle_rad / 1920;
/// Some half a second of flying: muscles that begin then are within some millimetres when they are seen.
constexpr float asleep_beyond_m = 6;
/// Muscles that show up in a picture of so many pixels.
constexpr float tolerance_px = 2;

}  // namespace

AliveScene::AliveScene(const AliveRequest& request) : request_(request), threads_(request.threads) {
  due_.fill(nobody);
  side_m_ = std::sqrt(ground_m2_each * static_cast<double>(request.alive));
  simulation_ = std::make_unique<Simulation>(SimulationOptions{.jobs = threads_.jobs(), .memory = &memory_});
  RelevanceOptions options;
  options.machine_factor = 1;
  options.switching_s = 0.0005;
  options.wakes = 4000;
  relevance_ = std::make_unique<Relevance>(*simulation_, options);
  camera_.half_angle_rad = half_angle_rad;
  camera_.radians_per_pixel = pixel_rad;
  camera_.near_m = 2;
  // So far that the sector holds as many as are to be in view.
  camera_.reach_m = static_cast<float>(
      std::sqrt(static_cast<double>(request.in_view) * ground_m2_each / static_cast<double>(half_angle_rad)));
  camera_.position_m = {0, eye_height_m, 0};
}

Result<std::unique_ptr<AliveScene>> AliveScene::make(const AliveRequest& request,
                                                     const CrowdScene::Progress& progress) {
  std::unique_ptr<AliveScene> scene(new AliveScene(request));
  if (auto done = load_baked_option(*scene->simulation_, request.baked); !done) return tl::unexpected(done.error());
  SceneNeeds needs;
  needs.camera = scene->camera_;
  needs.tolerance_px = tolerance_px;
  if (!request.muscles) needs.muscles = 0;
  needs.asleep_beyond_m = asleep_beyond_m;
  needs.compact_unseen = true;
  if (auto done = scene->relevance_->set_scene(needs); !done) return tl::unexpected(done.error());
  const auto preparing = [&](std::size_t done, std::size_t of) {
    if (progress) progress("preparing", done, of);
  };
  if (request.muscles) {
    if (auto done = scene->relevance_->prepare({}, preparing); !done) return tl::unexpected(done.error());
  }
  const std::size_t before = scene->memory_.lent();
  scene->simulation_->reserve(request.alive);
  scene->walkers_.resize(request.alive);
  for (std::size_t first = 0; first < request.alive; first += come_together) {
    if (auto done = scene->come(first, std::min(come_together, request.alive - first)); !done)
      return tl::unexpected(done.error());
    if (progress) progress("spawning", std::min(first + come_together, request.alive), request.alive);
  }
  scene->bytes_asleep_ =
      static_cast<double>(scene->memory_.lent() - before) / static_cast<double>(scene->walkers_.size());
  return scene;
}

/// Asleep, at places of their own. Who cannot walk as drawn is drawn again.
Result<void> AliveScene::come(std::size_t first, std::size_t count) {
  requests_.assign(count, {});
  entities_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t number = first + i;
    Walker& walker = walkers_[number];
    SpawnRequest& request = requests_[i];
    for (;; ++walker.draw) {
      const CrowdPerson person = crowd_person(request_.seed, number, walker.draw);
      request.body = person.body;
      request.gait = person.gait;
      request.gait.style = snapped(person.gait.style);
      const auto body = make_body(request.body);
      if (body && resolve_gait(*body, request.gait)) break;
      if (walker.draw == most_draws_alive) return fail("nobody can be drawn who walks");
    }
    const CrowdPlace place = crowd_place(request_.seed, number);
    request.x_m = place.across * static_cast<float>(side_m_);
    request.z_m = place.along * static_cast<float>(side_m_);
    request.heading_rad = walker.heading_rad = place.heading_rad;
  }
  if (auto done = simulation_->spawn(requests_, entities_); !done) return done;
  if (auto slept = relevance_->manage_asleep(entities_); !slept) return tl::unexpected(slept.error());
  for (std::size_t i = 0; i < count; ++i) {
    const Entity entity = entities_[i];
    walkers_[first + i].entity = entity;
    if (number_of_.size() <= entity.index) number_of_.resize(std::max<std::size_t>(entity.index + 1, walkers_.size()));
    number_of_[entity.index] = static_cast<std::uint32_t>(first + i);
    plan(static_cast<std::uint32_t>(first + i));
  }
  return {};
}

void AliveScene::plan(std::uint32_t number) {
  Walker& walker = walkers_[number];
  const float after_s = crowd_change(request_.seed, number, walker.changes, walker.stopped).after_s;
  const auto ticks = static_cast<std::uint32_t>(std::lround(static_cast<double>(after_s) / simulation_->tick_s()));
  std::uint32_t& first = due_[(simulation_->ticks() + std::clamp<std::uint32_t>(ticks, 1, ring - 1)) % ring];
  walker.next = first;
  first = number;
}

/// Who has left the square heads for a point of their own in its inner half instead of turning elsewhere.
WalkChange AliveScene::next_change(std::uint32_t number) {
  Walker& walker = walkers_[number];
  const CrowdChange change = crowd_change(request_.seed, number, walker.changes++, walker.stopped);
  WalkChange out{walker.entity, std::nullopt, std::nullopt};
  if (change.speed_m_s >= 0) {
    out.gait = GaitChange{.speed_m_s = change.speed_m_s};
    walker.stopped = change.speed_m_s == 0;
  }
  if (change.turn_rad == 0) return out;
  const auto state = *simulation_->get<GaitState>(walker.entity);
  const auto half_m = static_cast<float>(0.5 * side_m_);
  walker.heading_rad = std::remainder(walker.heading_rad + change.turn_rad, 2 * std::numbers::pi_v<float>);
  if (std::max(std::abs(state.line_x_m), std::abs(state.line_z_m)) > half_m) {
    CrowdRandom random(request_.seed, number, inward_stream);
    const float x_m = random.even(-0.5F, 0.5F) * half_m, z_m = random.even(-0.5F, 0.5F) * half_m;
    walker.heading_rad = std::atan2(x_m - state.line_x_m, z_m - state.line_z_m);
  }
  out.heading_rad = walker.heading_rad;
  return out;
}

/// From a place of its own after each cut: ahead, and turning to and fro.
void AliveScene::fly() {
  const double tick_s = simulation_->tick_s();
  const auto every = static_cast<std::uint32_t>(std::max(1L, std::lround(request_.cut_every_s / tick_s)));
  const std::uint32_t take = simulation_->ticks() / every, since = simulation_->ticks() % every;
  const float since_s = static_cast<float>(since) * static_cast<float>(tick_s);
  CrowdRandom random(request_.seed, take, camera_stream);
  const auto side = static_cast<float>(side_m_);
  const float x_m = random.even(-0.35F, 0.35F) * side, z_m = random.even(-0.35F, 0.35F) * side;
  const float to_middle = std::atan2(-x_m, -z_m) + random.even(-0.6F, 0.6F);
  const float period_s = 4, swing_rad = turns_rad_s * period_s / 4;
  const float phase = since_s / period_s, saw = std::abs(std::remainder(phase, 2.0F));
  const float yaw = to_middle + swing_rad * 4 * (saw - 0.5F);
  const float far_m = flies_m_s * since_s;
  cut_ = since == 0;
  camera_.position_m = {x_m + far_m * std::sin(to_middle), eye_height_m, z_m + far_m * std::cos(to_middle)};
  camera_.forward = {std::sin(yaw), 0, std::cos(yaw)};
}

Result<std::size_t> AliveScene::decide() {
  now_.clear();
  std::uint32_t& first = due_[simulation_->ticks() % ring];
  for (std::uint32_t number = first; number != nobody; number = walkers_[number].next) now_.push_back(number);
  first = nobody;
  changes_.resize(now_.size());
  in_parallel(threads_.jobs(), now_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) changes_[i] = next_change(now_[i]);
  });
  for (const std::uint32_t number : now_) plan(number);
  if (auto done = simulation_->change_walks(changes_); !done) return tl::unexpected(done.error());
  fly();
  SceneNeeds needs = relevance_->scene();
  needs.camera = camera_;
  if (auto done = relevance_->set_scene(needs); !done) return tl::unexpected(done.error());
  return changes_.size();
}

RelevanceReport AliveScene::choose() {
  return relevance_->update();
}

AliveScene::Count AliveScene::count() const {
  Count count;
  simulation().each([&](const Rows& rows, const Tiers<Lanes<float>>& tiers) {
    count.awake += rows.live;
    for (std::uint32_t lane = 0; lane < rows.live; ++lane)
      count.seen += tiers.view[lane] == static_cast<std::uint32_t>(View::seen) ? 1 : 0;
  });
  return count;
}

}  // namespace mobil
