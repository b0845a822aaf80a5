#include <mobil/systems/states/tiers.h>

#include <array>
#include <cstdint>

#include <mobil/systems/accuracy/accuracy_table.h>
#include "systems/accuracy/packed_rungs.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"

namespace mobil::inline v0_3 {

std::span<const KeyPart> managed_parts() {
  static constexpr std::array parts = {component_part<Needs>(), component_part<Tiers>()};
  return parts;
}

bool is_managed(const World& world, Entity human) {
  return world.has<Needs>(human) || world.has<SleepsManaged>(human);
}

Tiers<float> tiers_of(const World& world, Entity human) {
  const auto before = world.get<Tiers>(human);
  const bool anew = !before || before->relative_size == 0;
  Tiers<float> tiers = before.value_or(Tiers<float>{});
  if (anew) tiers.view = static_cast<std::uint32_t>(View::out_of_reach);
  tiers.muscles = tiers.effects = 0;
  tiers.relative_size = 1;
  for (const OwnMuscle& own : muscles_of(world, human)) {
    const auto m = static_cast<std::uint32_t>(own.muscle);
    const Entity one = world.alive(own.entity[Side::right]) ? own.entity[Side::right] : own.entity[Side::left];
    if (tiers.muscles == 0) {
      const LegMuscles& choice = *world.shared<LegMuscles>(one);
      tiers.effects = (choice.inertia ? tier_inertia : 0U) | (pulls_alive(choice) ? tier_living : 0U);
    }
    set_bit(tiers.muscles, m, true);
    if (!anew && bit_at(before->muscles, m) && rung_at(tiers.rung, m) == forced_rung) continue;
    const MuscleMethod method = muscle_method(world, one);
    const std::uint32_t rung = rung_of(method, is_living(tiers));
    set_rung(tiers.rung, m, rung);
    set_rung(tiers.goal, m, rung);
    set_bit(tiers.points, m, method.method != Method::none && method.reduced.control_points);
  }
  return tiers;
}

std::uint32_t rung_of(const MuscleMethod& method, bool living) {
  if (method.method == Method::none) return 0;
  const Ladder& ladder = rungs_of(living);
  const ReducedChoice& reduced = method.reduced;
  const bool moving = reduced.moving && (reduced.tuned || !living);
  std::uint32_t nearest = rung_count - (living || method.method != Method::reduced ? 1 : 2);
  for (std::uint32_t r = rung_count - 1; r > 0; --r) {
    const Rung& rung = ladder[r];
    if (rung.method != method.method) continue;
    if (rung.method != Method::reduced) return r;
    if (moving != rung.moving || (living && rung.finite_shape == reduced.linear_shape)) continue;
    if (!moving || (reduced.cells == rung.cells && reduced.vectors <= rung.vectors)) nearest = r;
  }
  return nearest;
}

MuscleMethod rung_method(std::size_t rung, bool control_points, bool living) {
  const Rung& of = rungs_of(living)[rung];
  MuscleMethod method{of.method, {}};
  if (of.method == Method::reduced) {
    method.reduced = {of.vectors,     of.moving, true,     of.cells,
                      control_points, false,     of.tuned, living && !of.finite_shape};
  }
  return method;
}

}  // namespace mobil::inline v0_3
