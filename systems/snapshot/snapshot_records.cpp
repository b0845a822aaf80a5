#include "systems/snapshot/snapshot_records.h"

#include <algorithm>

namespace mobil {
namespace {

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

SavedMethod pack(const MuscleMethod& method) {
  const ReducedChoice& reduced = method.reduced;
  return {static_cast<std::uint32_t>(method.method),
          reduced.vectors,
          reduced.moving,
          reduced.corrected,
          {reduced.cells[0], reduced.cells[1], reduced.cells[2]},
          reduced.control_points,
          reduced.reported};
}

std::optional<MuscleMethod> unpack(const SavedMethod& saved) {
  if (saved.method > static_cast<std::uint32_t>(Method::none) || saved.moving > 1 || saved.corrected > 1 ||
      saved.control_points > 1 || saved.reported > 1) {
    return std::nullopt;
  }
  return MuscleMethod{static_cast<Method>(saved.method),
                      {saved.vectors,
                       saved.moving != 0,
                       saved.corrected != 0,
                       {saved.cells[0], saved.cells[1], saved.cells[2]},
                       saved.control_points != 0,
                       saved.reported != 0}};
}

}  // namespace

SavedChoice pack(const LegMuscles& choice) {
  SavedChoice saved{};
  saved.density = bits(choice.material.density_kg_m3);
  saved.young = bits(choice.material.young_pa);
  saved.poisson = bits(choice.material.poisson);
  saved.damping = bits(choice.damping_per_s);
  saved.stiffness_damping = bits(choice.stiffness_damping_s);
  saved.foundation = bits(choice.foundation_hz.value_or(0));
  saved.dt = bits(choice.dt_s.value_or(0));
  saved.muscles = static_cast<std::uint32_t>(choice.muscles.to_ulong());
  saved.drive = static_cast<std::uint32_t>(choice.drive);
  saved.element = static_cast<std::uint32_t>(choice.element);
  saved.mass = static_cast<std::uint32_t>(choice.mass);
  saved.inertia = choice.inertia;
  saved.line_motion = choice.line_motion;
  std::copy(choice.cells.begin(), choice.cells.end(), saved.cells);
  saved.has_foundation = choice.foundation_hz.has_value();
  saved.has_dt = choice.dt_s.has_value();
  saved.method = pack(MuscleMethod{choice.method, choice.reduced});
  return saved;
}

std::optional<LegMuscles> unpack(const SavedChoice& saved) {
  const auto method = unpack(saved.method);
  if (!method || saved.drive > static_cast<std::uint32_t>(Drive::force) ||
      saved.element > static_cast<std::uint32_t>(Element::one_point) ||
      saved.mass > static_cast<std::uint32_t>(Mass::consistent) || saved.inertia > 1 || saved.line_motion > 1 ||
      saved.has_foundation > 1 || saved.has_dt > 1) {
    return std::nullopt;
  }
  LegMuscles choice;
  choice.muscles = MuscleSet(saved.muscles);
  choice.drive = static_cast<Drive>(saved.drive);
  choice.method = method->method;
  choice.reduced = method->reduced;
  choice.material = {number(saved.density), number(saved.young), number(saved.poisson)};
  choice.element = static_cast<Element>(saved.element);
  choice.mass = static_cast<Mass>(saved.mass);
  choice.damping_per_s = number(saved.damping);
  choice.stiffness_damping_s = number(saved.stiffness_damping);
  choice.inertia = saved.inertia != 0;
  choice.line_motion = saved.line_motion != 0;
  if (saved.has_foundation != 0) choice.foundation_hz = number(saved.foundation);
  choice.cells = {saved.cells[0], saved.cells[1], saved.cells[2]};
  if (saved.has_dt != 0) choice.dt_s = number(saved.dt);
  return choice;
}

}  // namespace mobil
