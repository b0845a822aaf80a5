// CrowdScene: changes of heading and speed, and the choice of near people.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <mobil/avoidance.h>
#include <mobil/each.h>
#include <mobil/lod.h>
#include "demo/crowd/crowd_scene.h"

namespace mobil {
namespace {

constexpr std::uint64_t return_stream = 0x40000;
constexpr float whole_turn = 2 * std::numbers::pi_v<float>;
constexpr float aims = 0.2F;   // maximum heading error of a returning walker, rad
constexpr float stays = 0.9F;  // factor on the squared distance of people who are already near

}  // namespace

/// Schedules the walker's next change.
void CrowdScene::plan(std::size_t slot) {
  CrowdWalker& walker = walkers_[slot];
  const float after_s = crowd_change(request_.seed, walker.party(), walker.changes, walker.stopped).after_s;
  const auto ticks = static_cast<std::uint32_t>(std::lround(static_cast<double>(after_s) / simulation_->tick_s()));
  walker.due =
      static_cast<std::uint16_t>((simulation_->ticks() + std::clamp<std::uint32_t>(ticks, 1, ring - 1)) % ring);
  walker.before = -1;
  walker.next = due_[walker.due];
  if (walker.next >= 0) walkers_[static_cast<std::size_t>(walker.next)].before = static_cast<std::int32_t>(slot);
  due_[walker.due] = static_cast<std::int32_t>(slot);
}

void CrowdScene::forget_plan(std::size_t slot) {
  const CrowdWalker& walker = walkers_[slot];
  (walker.before >= 0 ? walkers_[static_cast<std::size_t>(walker.before)].next : due_[walker.due]) = walker.next;
  if (walker.next >= 0) walkers_[static_cast<std::size_t>(walker.next)].before = walker.before;
}

/// Requests a heading. With avoidance it sets the desired velocity, and Avoidance requests the steps.
Result<void> CrowdScene::head_for(const CrowdWalker& walker, float heading_rad) {
  if (!request_.effects.avoidance) return simulation_->turn_to(walker.entity, heading_rad);
  const auto course = simulation_->get<AvoidanceState>(walker.entity);
  if (!course) return fail(course.error().status);
  const DesiredVelocity wish = {walker.entity, course->speed_m_s, heading_rad};
  return simulation_->avoidance().set_desired_velocity({&wish, 1});
}

/// Applies the next change of the walker's party. The usual speed replaces one that is impossible for body and style.
Result<void> CrowdScene::carry_out(CrowdWalker& walker, CrowdDecisions& decisions) {
  CrowdChange change = crowd_change(request_.seed, walker.party(), walker.changes++, walker.stopped, walker.usual_m_s);
  if (change.speed_m_s >= 0) {
    if (!simulation_->change_gait(walker.entity, {.speed_m_s = change.speed_m_s})) {
      change.speed_m_s = walker.usual_m_s;
      if (auto done = simulation_->change_gait(walker.entity, {.speed_m_s = change.speed_m_s}); !done) return done;
    }
    if (request_.effects.avoidance) {
      const DesiredVelocity wish = {walker.entity, change.speed_m_s, walker.heading_rad};
      if (auto done = simulation_->avoidance().set_desired_velocity({&wish, 1}); !done) return done;
    }
    walker.stopped = change.speed_m_s == 0;
    ++decisions.changed_speed;
  }
  if (change.turn_rad != 0 && !walker.returning) {
    walker.heading_rad = std::remainder(walker.heading_rad + change.turn_rad, whole_turn);
    if (auto done = head_for(walker, walker.heading_rad); !done) return done;
    ++decisions.turned;
  }
  return {};
}

/// Updates positions, returning walkers and near people; called once a second.
Result<void> CrowdScene::look_round(CrowdDecisions& decisions) {
  read_places();
  if (auto done = turn_back(decisions); !done) return done;
  return choose_near(decisions);
}

/// Reads positions of walking lines, because compact people have no pose. Reading block by block is 10 times faster
/// than one query per person.
void CrowdScene::read_places() {
  each(simulation_->world(), [&](const Rows& rows, const GaitState<Lanes<float>>& state) {
    for (std::uint32_t lane = 0; lane < rows.live; ++lane) {
      CrowdWalker& walker = walkers_[slot_of_[rows.entity[lane].index]];
      walker.x_m = state.line_x_m[lane];
      walker.z_m = state.line_z_m[lane];
    }
  });
}

/// Turns walkers outside the square toward a point of their own in its inner half. Their heading is corrected until
/// they are inside, because they leave the line to the point during the steps of a turn.
Result<void> CrowdScene::turn_back(CrowdDecisions& decisions) {
  const auto half_m = static_cast<float>(0.5 * side_m_);
  for (CrowdWalker& walker : walkers_) {
    const bool outside = std::max(std::abs(walker.x_m), std::abs(walker.z_m)) > half_m;
    if (!outside) {
      walker.returning = false;
      continue;
    }
    CrowdRandom random(request_.seed, walker.party(), return_stream);
    const float x_m = random.even(-0.5F, 0.5F) * half_m, z_m = random.even(-0.5F, 0.5F) * half_m;
    const float heading_rad = std::atan2(x_m - walker.x_m, z_m - walker.z_m);
    if (walker.returning && std::abs(std::remainder(heading_rad - walker.heading_rad, whole_turn)) < aims) continue;
    decisions.turned += walker.returning ? 0 : 1;
    walker.returning = true;
    walker.heading_rad = heading_rad;
    if (auto done = head_for(walker, heading_rad); !done) return done;
  }
  return {};
}

/// Chooses the people nearest to the viewer, with a slight preference for the current ones.
Result<void> CrowdScene::choose_near(CrowdDecisions& decisions) {
  if (!choosing_) return {};
  const std::size_t part =
      request_.near * (request_.shard + 1) / request_.shards - request_.near * request_.shard / request_.shards;
  const std::size_t near = std::min(part, walkers_.size());
  const Vec3<float> eye = viewer_m();
  distance_.clear();
  for (std::uint32_t i = 0; i < walkers_.size(); ++i) {
    const float x = walkers_[i].x_m - eye.x, z = walkers_[i].z_m - eye.z;
    distance_.emplace_back((x * x + z * z) * (walkers_[i].near ? stays : 1), i);
  }
  std::nth_element(distance_.begin(), distance_.begin() + static_cast<std::ptrdiff_t>(near), distance_.end());
  entities_.clear();  // people who become near are expanded together
  for (std::size_t k = 0; k < near; ++k)
    if (!walkers_[distance_[k].second].near) entities_.push_back(walkers_[distance_[k].second].entity);
  if (auto done = simulation_->set_state(entities_, PersonState::full); !done) return tl::unexpected(done.error());
  for (std::size_t k = 0; k < distance_.size(); ++k) {
    CrowdWalker& walker = walkers_[distance_[k].second];
    const bool is_near = k < near;
    if (is_near == walker.near) continue;
    walker.near = is_near;
    ++decisions.near_changed;
    LodOverrides needs;
    if (is_near) {
      needs.tolerance_m = static_cast<float>(request_.near_tolerance_m);
      needs.looked_at = true;
    }
    if (auto done = simulation_->lod().manage(walker.entity, needs); !done) return done;
  }
  return {};
}

}  // namespace mobil
