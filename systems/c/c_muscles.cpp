// Leg muscles: choice, changes, excitation, preparation.

#include <mobil/muscle_library.h>
#include <mobil/muscle_table.h>
#include "systems/c/c_call.h"

namespace mobil::inline v0_3::c {
namespace {

/// Converts the fields of a method that mobil_method and mobil_muscles have in common.
template <class S>
int method_of(Line& line, const S& given, MuscleMethod& to) {
  if (const int code = one_of(line, given.method, last_method, "method", to.method)) return code;
  if (given.modes < 0) return line.refuse(MOBIL_REFUSED, fmt::format("{} modes; choose 1 to 32", given.modes));
  to.modal = {static_cast<std::uint32_t>(given.modes),
              given.moving != 0,
              given.corrected != 0,
              {given.modal_cells[0], given.modal_cells[1], given.modal_cells[2]},
              given.control_points != 0,
              given.reported != 0,
              given.tuned != 0,
              given.linear_shape != 0};
  return MOBIL_OK;
}

int method_from(Line& line, const mobil_method* given, MuscleMethod& to) {
  mobil_method known;
  if (const int code = read_struct(line, given, "method", known)) return code;
  return method_of(line, known, to);
}

}  // namespace

int leg_muscles(Line& line, const mobil_muscles& given, LegMuscles& to) {
  MuscleMethod method;
  if (const int code = method_of(line, given, method)) return code;
  to.method = method.method;
  to.modal = method.modal;
  if (const int code = muscle_set(line, given.muscles, given.more_muscles, to.muscles)) return code;
  if (const int code = one_of(line, given.element, Element::one_point, "element", to.element)) return code;
  if (const int code = one_of(line, given.mass, Mass::consistent, "mass", to.mass)) return code;
  if (const int code = one_of(line, given.drive, Drive::force, "drive", to.drive)) return code;
  if (const int code = one_of(line, given.activation, ExcitationSource::moments, "activation", to.activation))
    return code;
  to.inertia = given.inertia != 0;
  to.line_motion = given.line_motion != 0;
  if (given.finite_shape >= 0) to.finite_shape = given.finite_shape != 0;
  to.cells = {given.cells[0], given.cells[1], given.cells[2]};
  to.material = {given.density_kg_m3, given.young_pa, given.poisson};
  to.damping_per_s = given.damping_per_s;
  to.stiffness_damping_s = given.stiffness_damping_s;
  if (!(given.foundation_hz < 0)) to.foundation_hz = given.foundation_hz;
  if (!(given.dt_s < 0)) to.dt_s = given.dt_s;
  return MOBIL_OK;
}

}  // namespace mobil::inline v0_3::c

using namespace mobil;
using namespace mobil::c;

int mobil_find_muscle(const char* name) {
  const auto muscle = name == nullptr ? std::nullopt : find_muscle(name);
  return muscle ? static_cast<int>(*muscle) : int{MOBIL_MISSING};
}

const char* mobil_muscle_name(int muscle) {
  const auto all = muscles();
  return muscle < 0 || static_cast<std::size_t>(muscle) >= all.size()
             ? nullptr
             : all[static_cast<std::size_t>(muscle)].name.data();
}

int mobil_prepare(mobil_sim* sim, const mobil_muscles* muscles) {
  return call(sim, "mobil_prepare", [&](mobil_sim& s) {
    mobil_muscles known;
    if (const int code = read_struct(s.line, muscles, "muscles", known)) return code;
    LegMuscles choice;
    if (const int code = leg_muscles(s.line, known, choice)) return code;
    const auto done = s.world().muscle_library().prepare(choice);
    return done ? int{MOBIL_OK} : s.line.refuse(done.error());
  });
}

int mobil_bake(mobil_sim* sim, void* out, size_t room, size_t* bytes) {
  return call(sim, "mobil_bake",
              [&](mobil_sim& s) { return write_baked(s.line, s.world().muscle_library().bake(), out, room, bytes); });
}

int mobil_load_baked(mobil_sim* sim, const void* baked, size_t bytes) {
  return call(sim, "mobil_load_baked", [&](mobil_sim& s) {
    if (baked == nullptr) return s.line.refuse_null("baked");
    const auto done = s.world().muscle_library().load({static_cast<const std::byte*>(baked), bytes});
    return done ? int{MOBIL_OK} : s.line.refuse(done.error());
  });
}

int mobil_set_muscles(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_muscles* muscles) {
  return call(sim, "mobil_set_muscles", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    std::optional<LegMuscles> choice;
    if (muscles != nullptr) {
      mobil_muscles known;
      if (const int code = read_struct(s.line, muscles, "muscles", known)) return code;
      if (const int code = leg_muscles(s.line, known, choice.emplace())) return code;
    }
    if (const int code = s.people_once()) return code;
    return code_of(s.line, s.world().set_muscles(s.people, choice));
  });
}

int mobil_set_method(mobil_sim* sim, const mobil_id* ids, size_t count, int muscle, const mobil_method* method) {
  return call(sim, "mobil_set_method", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    Muscle of{};
    if (const int code = muscle_number(s.line, muscle, of)) return code;
    MuscleMethod to;
    if (const int code = method_from(s.line, method, to)) return code;
    if (const int code = s.people_once()) return code;
    return code_of(s.line, s.world().set_method(s.people, of, to));
  });
}

int mobil_get_method(mobil_sim* sim, mobil_id id, int muscle, mobil_method* out) {
  return call(sim, "mobil_get_method", [&](mobil_sim& s) {
    Muscle of{};
    if (const int code = muscle_number(s.line, muscle, of)) return code;
    if (!s.world().is_person(entity_of(id))) return s.line.refuse(Error{{}, Status::stale_entity});
    const MuscleMethod now = s.world().method(entity_of(id), of);
    auto to = usual<mobil_method>();
    to.method = static_cast<int>(now.method);
    to.modes = static_cast<int>(now.modal.modes);
    to.moving = now.modal.moving;
    to.corrected = now.modal.corrected;
    to.control_points = now.modal.control_points;
    to.reported = now.modal.reported;
    to.tuned = now.modal.tuned;
    to.linear_shape = now.modal.linear_shape;
    for (std::size_t i = 0; i < 3; ++i) to.modal_cells[i] = now.modal.cells[i];
    return write_struct(s.line, to, out, "out");
  });
}

int mobil_set_excitation(mobil_sim* sim, const mobil_id* ids, size_t count, int muscle, int side,
                         const float* excitation, size_t stride) {
  return call(sim, "mobil_set_excitation", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    std::size_t apart = stride;
    if (const int code = row_stride(s.line, excitation, count, 1, "excitation", apart)) return code;
    Muscle of{};
    if (const int code = muscle_number(s.line, muscle, of)) return code;
    Side on{};
    if (const int code = one_of(s.line, side, Side::left, "side", on)) return code;
    s.row.clear();
    for (std::size_t i = 0; i < count; ++i) s.row.push_back(*row_at(excitation, i, apart, sizeof(float)));
    return code_of(s.line, s.world().set_excitation(s.people, of, on, s.row));
  });
}
