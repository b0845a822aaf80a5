#include "systems/terrain/slowing.h"

#include <cmath>
#include <optional>

#include "assets/gait/slope_pace.h"
#include "components/avoidance.h"
#include "components/footing.h"
#include "systems/gait/gait.h"

namespace mobil {
namespace {

/// Keeps what a walker is to do on level ground: as their gait is, unless that is what slowing down has asked for.
void keep_level_walk(const Gait<float>& gait, Footing<float>& footing) {
  if (footing.level_speed_m_s > 0 && gait.speed_m_s == footing.slowed_speed_m_s &&
      gait.step_length_m == footing.slowed_length_m)
    return;
  footing.level_speed_m_s = gait.speed_m_s;
  footing.level_length_m = gait.step_length_m;
}

/// Usual steps become those of the new speed; others stay as long as they are, as the treads of stairs do.
GaitChange change_to(float height_m, const Footing<float>& footing, float speed_m_s) {
  constexpr float as_usual = 0.01F;
  GaitChange change{.speed_m_s = speed_m_s};
  const auto usual = resolve_gait(height_m, {.speed_m_s = footing.level_speed_m_s});
  const bool own_length =
      !usual || std::fabs(usual->step_length_m - footing.level_length_m) > as_usual * usual->step_length_m;
  if (own_length || speed_m_s == footing.level_speed_m_s) change.step_length_m = footing.level_length_m;
  return change;
}

}  // namespace

void find_slowed(World& world, std::span<const Entity> people, std::vector<WalkChange>& changes) {
  constexpr float least_part = 0.04F;  // less is not worth a step that is solved anew
  changes.clear();
  for (const Entity human : people) {
    auto footing = world.get<Footing>(human);
    const auto gait = world.get<Gait>(human);
    if (!footing || !gait || !(gait->speed_m_s > 0) || world.has<Course>(human)) continue;
    keep_level_walk(*gait, *footing);
    const float level = footing->level_speed_m_s, speed = slope_speed(level, footing->slows_for);
    const float off = std::fabs(speed - gait->speed_m_s);
    if (off == 0 || (speed != level && off < least_part * level)) continue;
    changes.push_back({human, change_to(world.get<BodySize>(human)->height_m, *footing, speed), {}});
    world.set(human, *footing);
  }
}

void keep_slowed(World& world, std::span<const WalkChange> changes) {
  for (const WalkChange& change : changes) {
    auto footing = *world.get<Footing>(change.human);
    const auto gait = world.get<Gait>(change.human);
    footing.slowed_speed_m_s = gait->speed_m_s;
    footing.slowed_length_m = gait->step_length_m;
    world.set(change.human, footing);
  }
}

}  // namespace mobil
