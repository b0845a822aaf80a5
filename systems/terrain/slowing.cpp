#include "systems/terrain/slowing.h"

#include <cmath>
#include <optional>

#include "assets/gait/slope_pace.h"
#include "components/avoidance.h"
#include "components/footing.h"
#include "systems/gait/gait.h"
#include "systems/people/style_limits.h"

namespace mobil {
namespace {

/// Usual steps become those of the new speed; others stay as long as they are, as the treads of stairs do.
GaitChange change_to(float height_m, const LevelWalk& level, float speed_m_s) {
  constexpr float as_usual = 0.01F;
  GaitChange change{.speed_m_s = speed_m_s};
  const auto usual = resolve_gait(height_m, {.speed_m_s = level.speed_m_s});
  const bool own_length =
      !usual || std::fabs(usual->step_length_m - level.step_length_m) > as_usual * usual->step_length_m;
  if (own_length || speed_m_s == level.speed_m_s) change.step_length_m = level.step_length_m;
  return change;
}

/// False where limits of joints and ground would draw the style that was asked for toward the usual one.
bool keeps_style(const AskedBody& now, const GaitChange& change) {
  if (same_style(now.gait.style, {})) return true;
  auto gait = changed_gait(now, change);
  if (!gait) return false;
  keep_walk_limits(now.size, *gait);
  return same_style(gait->style, now.gait.style);
}

}  // namespace

void find_slowed(World& world, std::span<const Entity> people, std::vector<WalkChange>& changes) {
  constexpr float least_part = 0.04F;  // less is not worth a step that is solved anew
  changes.clear();
  for (const Entity human : people) {
    auto footing = world.get<Footing>(human);
    const auto now = asked_body(world, human);
    if (!footing || !now || !(now->gait.speed_m_s > 0) || world.has<Course>(human)) continue;
    const LevelWalk level = level_walk(now->gait, *footing);
    const float speed = slope_speed(level.speed_m_s, footing->slows_for);
    const float off = std::fabs(speed - now->gait.speed_m_s);
    if (off == 0 || (speed != level.speed_m_s && off < least_part * level.speed_m_s)) continue;
    const GaitChange change = change_to(now->size.height_m, level, speed);
    if (!keeps_style(*now, change)) continue;
    changes.push_back({human, change, {}});
    footing->level_speed_m_s = level.speed_m_s;
    footing->level_length_m = level.step_length_m;
    world.set(human, *footing);
  }
}

void keep_slowed(World& world, std::span<const WalkChange> changes) {
  for (const WalkChange& change : changes) {
    auto footing = *world.get<Footing>(change.human);
    const Gait<float> gait = asked_body(world, change.human)->gait;
    footing.slowed_speed_m_s = gait.speed_m_s;
    footing.slowed_length_m = gait.step_length_m;
    world.set(change.human, footing);
  }
}

}  // namespace mobil
