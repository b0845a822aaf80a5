#include <mobil/systems/states/lod_state.h>

#include <array>
#include <cstdint>

#include <mobil/systems/accuracy/accuracy_table.h>
#include "systems/accuracy/packed_levels.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"

namespace mobil::inline v0_3 {

std::span<const ComponentId> managed_parts() {
  static constexpr std::array parts = {component_id<LodRequest>(), component_id<LodState>()};
  return parts;
}

bool is_managed(const World& world, Entity person) {
  return world.has<LodRequest>(person) || world.has<SleepsManaged>(person);
}

LodState<float> lod_state_of(const World& world, Entity person) {
  const auto before = world.get<LodState>(person);
  const bool anew = !before || before->relative_size == 0;
  LodState<float> lod_state = before.value_or(LodState<float>{});
  if (anew) lod_state.view = static_cast<std::uint32_t>(View::out_of_reach);
  set_bits(lod_state.muscles, {});
  lod_state.effects = 0;
  lod_state.relative_size = 1;
  for (const MuscleRef& own : muscles_of(world, person)) {
    const auto m = static_cast<std::uint32_t>(own.muscle);
    const Entity one = world.alive(own.entity[Side::right]) ? own.entity[Side::right] : own.entity[Side::left];
    if (all_bits(lod_state.muscles) == 0) {
      const LegMuscles& choice = *world.shared<LegMuscles>(one);
      lod_state.effects = (choice.inertia ? lod_inertia : 0U) | (pulls_alive(choice) ? lod_active : 0U);
    }
    set_bit(lod_state.muscles, m, true);
    if (!anew && bit_at(before->muscles, m) && level_at(lod_state.level, m) == forced_level) continue;
    const MuscleMethod method = muscle_method(world, one);
    const std::uint32_t level = level_of(method, is_active(lod_state));
    set_level(lod_state.level, m, level);
    set_level(lod_state.goal, m, level);
    set_bit(lod_state.points, m, method.method != Method::none && method.modal.control_points);
  }
  return lod_state;
}

std::uint32_t level_of(const MuscleMethod& method, bool active) {
  if (method.method == Method::none) return 0;
  const LodLevels& all = levels_of(active);
  const ModalOptions& modal = method.modal;
  const bool moving = modal.moving && (modal.tuned || !active);
  std::uint32_t nearest = level_count - (active || method.method != Method::modal ? 1 : 2);
  for (std::uint32_t r = level_count - 1; r > 0; --r) {
    const LodLevel& level = all[r];
    if (level.method != method.method) continue;
    if (level.method != Method::modal) return r;
    if (moving != level.moving || (active && level.finite_shape == modal.linear_shape)) continue;
    if (!moving || (modal.cells == level.cells && modal.modes <= level.modes)) nearest = r;
  }
  return nearest;
}

MuscleMethod level_method(std::size_t level, bool control_points, bool active) {
  const LodLevel& of = levels_of(active)[level];
  MuscleMethod method{of.method, {}};
  if (of.method == Method::modal) {
    method.modal = {of.modes, of.moving, true, of.cells, control_points, false, of.tuned, active && !of.finite_shape};
  }
  return method;
}

}  // namespace mobil::inline v0_3
