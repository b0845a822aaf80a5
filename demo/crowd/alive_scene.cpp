#include "demo/crowd/alive_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/components/lod.h>
#include <mobil/each.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/shard_bytes.h>
#include <mobil/systems/cluster/shard.h>
#include <mobil/systems/people/sleepers.h>
#include "demo/bake/baked_file.h"

namespace mobil {
namespace {

constexpr double ground_m2_each = 1;
constexpr std::size_t come_together = 1024;
constexpr std::uint64_t camera_stream = 0x50000, inward_stream = 0x40000;
constexpr float eye_height_m = 5, flies_m_s = 8, turns_rad_s = 0.35F, half_angle_rad = std::numbers::pi_v<float> / 6;
constexpr float pixel_rad = 2 * half_angle_rad / 1920;
/// About 0.6 s of flight and walk, after which newly started muscles are accurate to a few millimetres.
constexpr float asleep_beyond_m = 6;
/// Maximum error of muscles in the picture, pixels.
constexpr float tolerance_px = 2;

Viewpoint first_view(const AliveRequest& request) {
  Viewpoint camera;
  camera.position_m = {0, eye_height_m, 0};
  camera.half_angle_rad = half_angle_rad;
  camera.radians_per_pixel = pixel_rad;
  camera.near_m = 2;
  // The sector up to this distance contains `in_view` people.
  camera.reach_m = static_cast<float>(
      std::sqrt(static_cast<double>(request.in_view) * ground_m2_each / static_cast<double>(half_angle_rad)));
  return camera;
}

}  // namespace

double side_of(const AliveRequest& request) {
  return std::sqrt(ground_m2_each * static_cast<double>(request.alive));
}

AliveScene::AliveScene(const AliveRequest& request) : request_(request), threads_(request.threads) {
  side_m_ = side_of(request);
  simulation_ = std::make_unique<Simulation>(
      SimulationOptions{.jobs = threads_.jobs(), .memory = &memory_, .library_of = request.library});
  LodOptions options;
  options.machine_factor = 1;
  options.switching_s = 0.0005;
  options.wakes = 4000;
  (void)simulation_->lod().set_options(options);  // in range
  camera_ = first_view(request);
}

Result<std::unique_ptr<AliveScene>> AliveScene::make_empty(const AliveRequest& request) {
  std::unique_ptr<AliveScene> scene(new AliveScene(request));
  if (request.library == nullptr) {
    if (auto done = load_baked_option(*scene->simulation_, request.baked); !done) return tl::unexpected(done.error());
  }
  LodScene needs;
  needs.camera = scene->camera_;
  needs.tolerance_px = tolerance_px;
  if (!request.muscles) needs.muscles = 0;
  needs.asleep_beyond_m = asleep_beyond_m;
  needs.compact_unseen = true;
  if (auto done = scene->simulation_->lod().set_scene(needs); !done) return tl::unexpected(done.error());
  if (!request.muscles) return scene;
  if (auto done = prepare_and_keep(*scene->simulation_, {}, {}); !done) return tl::unexpected(done.error());
  return scene;
}

Result<void> AliveScene::populate() {
  for (std::uint32_t number = 0; number < request_.alive; ++number) {
    if (request_.shards == 1 || shard_of(number, request_.shards) == request_.shard)
      walkers_.push_back({.number = number});
  }
  simulation_->reserve(walkers_.size());
  for (std::size_t first = 0; first < walkers_.size(); first += come_together) {
    if (auto done = come(first, std::min(come_together, walkers_.size() - first)); !done) return done;
  }
  return {};
}

/// Spawns people asleep, at random places. A random person who cannot walk is drawn again.
Result<void> AliveScene::come(std::size_t first, std::size_t count) {
  requests_.assign(count, {});
  entities_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Walker& walker = walkers_[first + i];
    SpawnRequest& request = requests_[i];
    const auto person = crowd_walker(request_.seed, walker.number, walker.draw);
    if (!person) return tl::unexpected(person.error());
    request.body = person->body;
    request.gait = person->gait;
    request.gait.style = snapped(person->gait.style);
    const CrowdPlace place = crowd_place(request_.seed, walker.number);
    request.x_m = place.across * static_cast<float>(side_m_);
    request.z_m = place.along * static_cast<float>(side_m_);
    request.heading_rad = walker.heading_rad = place.heading_rad;
  }
  if (auto done = simulation_->spawn(requests_, entities_); !done) return done;
  if (auto slept = simulation_->lod().manage_asleep(entities_); !slept) return tl::unexpected(slept.error());
  for (std::size_t i = 0; i < count; ++i) {
    const auto slot = static_cast<std::uint32_t>(first + i);
    walkers_[slot].entity = entities_[i];
    keep_slot(slot);
    due_[next_due(slot)].push_back(slot);
  }
  return {};
}

void AliveScene::keep_slot(std::uint32_t slot) {
  const std::uint32_t index = walkers_[slot].entity.index;
  if (slot_of_.size() <= index) slot_of_.resize(std::max<std::size_t>(index + std::size_t{1}, walkers_.size()));
  slot_of_[index] = slot;
}

std::size_t AliveScene::next_due(std::uint32_t slot) const {
  const Walker& walker = walkers_[slot];
  const float after_s = crowd_change(request_.seed, walker.number, walker.changes, walker.stopped).after_s;
  const auto ticks = static_cast<std::uint32_t>(std::lround(static_cast<double>(after_s) / simulation_->tick_s()));
  return (simulation_->ticks() + std::clamp<std::uint32_t>(ticks, 1, ring - 1)) % ring;
}

/// Returns a person's next change. People outside the square turn toward a point of their own in its inner half.
WalkChange AliveScene::next_change(std::uint32_t slot) {
  Walker& walker = walkers_[slot];
  const CrowdChange change = crowd_change(request_.seed, walker.number, walker.changes++, walker.stopped);
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
    CrowdRandom random(request_.seed, walker.number, inward_stream);
    const float x_m = random.even(-0.5F, 0.5F) * half_m, z_m = random.even(-0.5F, 0.5F) * half_m;
    walker.heading_rad = std::atan2(x_m - state.line_x_m, z_m - state.line_z_m);
  }
  out.heading_rad = walker.heading_rad;
  return out;
}

Viewpoint fly(const AliveRequest& request, std::uint32_t tick, double tick_s) {
  Viewpoint camera = first_view(request);
  const auto every = static_cast<std::uint32_t>(std::max(1L, std::lround(request.cut_every_s / tick_s)));
  const std::uint32_t take = tick / every, since = tick % every;
  const float since_s = static_cast<float>(since) * static_cast<float>(tick_s);
  CrowdRandom random(request.seed, take, camera_stream);
  const auto side = static_cast<float>(side_of(request));
  const float x_m = random.even(-0.35F, 0.35F) * side, z_m = random.even(-0.35F, 0.35F) * side;
  const float to_middle = std::atan2(-x_m, -z_m) + random.even(-0.6F, 0.6F);
  const float period_s = 4, swing_rad = turns_rad_s * period_s / 4;
  const float phase = since_s / period_s, saw = std::abs(std::remainder(phase, 2.0F));
  const float yaw = to_middle + swing_rad * 4 * (saw - 0.5F);
  const float far_m = flies_m_s * since_s;
  camera.position_m = {x_m + far_m * std::sin(to_middle), eye_height_m, z_m + far_m * std::cos(to_middle)};
  camera.forward = {std::sin(yaw), 0, std::cos(yaw)};
  return camera;
}

Result<std::size_t> AliveScene::decide(const Viewpoint& camera) {
  std::vector<std::uint32_t>& now = due_[simulation_->ticks() % ring];
  changes_.resize(now.size());
  next_due_.resize(now.size());
  in_parallel(threads_.jobs(), now.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      changes_[i] = next_change(now[i]);
      next_due_[i] = next_due(now[i]);
    }
  });
  for (std::size_t i = 0; i < now.size(); ++i) due_[next_due_[i]].push_back(now[i]);
  now.clear();
  if (auto done = simulation_->change_gait(changes_); !done) return tl::unexpected(done.error());
  camera_ = camera;
  LodScene needs = simulation_->lod().scene();
  needs.camera = camera_;
  if (auto done = simulation_->lod().set_scene(needs); !done) return tl::unexpected(done.error());
  return changes_.size();
}

std::vector<CrowdCamera::Drawn> AliveScene::seen() const {
  std::vector<CrowdCamera::Drawn> people;
  each(simulation().world(), [&](const Rows& rows, const LodState<Lanes<float>>& lod_state) {
    for (std::uint32_t lane = 0; lane < rows.live; ++lane) {
      if (lod_state.view[lane] != static_cast<std::uint32_t>(View::seen)) continue;
      const Entity who = rows.entity[lane];
      people.push_back({who, number_of(who), (lod_state.effects[lane] & lod_bare) == 0});
    }
  });
  return people;
}

Camera picture_from(const Viewpoint& camera) {
  const Vec3<float>&at = camera.position_m, &f = camera.forward;
  return {.eye = at, .target = {at.x + 10 * f.x, at.y - 2.2F, at.z + 10 * f.z}, .vertical_fov_deg = 33};
}

Result<std::vector<std::byte>> AliveScene::save() const {
  PlainBytes host;
  host.put(std::uint64_t{walkers_.size()});
  host.put_all(std::span<const Walker>(walkers_));
  for (const auto& slots : due_) {
    host.put(std::uint64_t{slots.size()});
    host.put_all(std::span<const std::uint32_t>(slots));
  }
  host.put(camera_);
  return pack_shard(*simulation_, host.bytes());
}

Result<void> AliveScene::restore(std::span<const std::byte> saved) {
  const auto host = unpack_shard(saved, *simulation_);
  if (!host) return tl::unexpected(host.error());
  PlainReader reader(*host);
  std::uint64_t count = 0;
  Viewpoint camera;
  reader.take(count);
  auto walkers = reader.take_many<Walker>(static_cast<std::size_t>(count));
  auto due = due_;
  std::vector<bool> is_due(walkers.size());
  bool sound = std::ranges::all_of(walkers, [&](const Walker& one) { return simulation_->is_person(one.entity); });
  std::size_t due_together = 0;
  for (auto& slots : due) {
    std::uint64_t size = 0;
    reader.take(size);
    slots = reader.take_many<std::uint32_t>(static_cast<std::size_t>(size));
    due_together += slots.size();
    for (const std::uint32_t slot : slots) {
      sound = sound && slot < walkers.size() && !is_due[slot];
      if (sound) is_due[slot] = true;
    }
  }
  reader.take(camera);
  if (!reader.whole() || !sound || due_together != walkers.size()) return fail("the bytes of a crowd are inconsistent");
  walkers_ = std::move(walkers);
  due_ = std::move(due);
  camera_ = camera;
  for (std::uint32_t slot = 0; slot < walkers_.size(); ++slot) keep_slot(slot);
  LodScene needs = simulation_->lod().scene();
  needs.camera = camera_;
  return simulation_->lod().set_scene(needs);
}

AliveScene::Count AliveScene::count() const {
  Count count;
  each(simulation().world(), [&](const Rows& rows, const LodState<Lanes<float>>& lod_state) {
    count.awake += rows.live;
    for (std::uint32_t lane = 0; lane < rows.live; ++lane)
      count.seen += lod_state.view[lane] == static_cast<std::uint32_t>(View::seen) ? 1 : 0;
  });
  return count;
}

}  // namespace mobil
