#include "systems/terrain/speed_scaling.h"

#include <algorithm>
#include <cmath>

#include <mobil/components/avoidance.h>
#include <mobil/components/footing.h>
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {
namespace {

GaitChange change_to(float height_m, const LevelWalk& level, float speed_m_s) {
  GaitChange change{.speed_m_s = speed_m_s, .step_length_m = level.step_length_m};
  if (speed_m_s == level.speed_m_s) return change;
  const auto usual = resolve_gait(height_m, {.speed_m_s = level.speed_m_s}),
             slower = resolve_gait(height_m, {.speed_m_s = speed_m_s});
  if (usual && slower)
    change.step_length_m = std::max(std::min(level.step_length_m, slower->step_length_m),
                                    level.step_length_m / usual->step_length_m * slower->step_length_m);
  return change;
}

/// Marks a person as checked with this gait. `level` is the walk on level ground from which the person is slowed, zeros
/// if not slowed. A person who is already slowed stays so.
void mark(World& world, Entity person, const Gait<float>& gait, const LevelWalk& level) {
  auto footing = *world.get<Footing>(person);
  if (is_slowed(gait, footing)) return;
  footing.looked_at = gait.revision;
  footing.level_speed_m_s = level.speed_m_s;
  footing.level_length_m = level.step_length_m;
  world.set(person, footing);
}

}  // namespace

void find_slowed(World& world, const Jobs& jobs, std::span<const Entity> people, SpeedScaling& to,
                 std::optional<float> steepness) {
  constexpr float min_part = 0.04F;  // smaller changes are not worth solving a step again
  to.people.clear();
  to.sizes.clear();
  to.gaits.clear();
  for (const Entity person : people) {
    if (!steepness && world.has<AvoidanceState>(person)) continue;
    const auto footing = world.get<Footing>(person);
    const auto now = asked_body(world, person);
    if (!footing || !now) continue;
    const LevelWalk level = level_walk(now->gait, *footing);
    const float speed = slope_speed(level.speed_m_s, steepness.value_or(footing->slows_for));
    const float off = std::fabs(speed - now->gait.speed_m_s);
    if (off == 0 || (speed != level.speed_m_s && off < min_part * level.speed_m_s)) {
      mark(world, person, now->gait, {});
      continue;
    }
    const GaitChange change = change_to(now->size.leg_scale_m, level, speed);
    const auto gait = changed_gait(*now, change);
    if (!gait) {
      mark(world, person, now->gait, {});
      continue;
    }
    const bool has_style = speed != level.speed_m_s && !same_style(gait->style, {});
    to.people.push_back({{person, change, {}}, level, now->gait, has_style});
    if (!has_style) continue;
    to.sizes.push_back(now->size);
    to.gaits.push_back(*gait);
  }
  keep_walk_limits(jobs, to.sizes, to.gaits, to.styles);
  auto kept = to.gaits.cbegin();
  std::erase_if(to.people, [&](const SpeedScaling::One& one) {
    if (!one.has_style || same_style((kept++)->style, one.before.style)) return false;
    mark(world, one.change.person, one.before, {});
    return true;
  });
  to.changes.clear();
  for (const SpeedScaling::One& one : to.people) to.changes.push_back(one.change);
}

void keep_slowed(World& world, const SpeedScaling& to) {
  for (const auto& [change, level, before, has_style] : to.people) {
    const Gait<float> gait = asked_body(world, change.person)->gait;
    if (gait.revision == before.revision) continue;  // the request failed
    mark(world, change.person, gait, change.gait->speed_m_s == level.speed_m_s ? LevelWalk{} : level);
  }
}

}  // namespace mobil::inline v0_3
