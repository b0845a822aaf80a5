// Level of detail.

#include <mobil/systems/accuracy/lod_table.h>
#include "systems/c/c_call.h"

namespace {

using namespace mobil;
using namespace mobil::c;

std::optional<float> above_0(float number) {
  return number > 0 ? std::optional(number) : std::nullopt;
}

int needs_of(mobil_sim& sim, const mobil_scene* given, LodScene& to) {
  mobil_scene scene;
  if (const int code = read_struct(sim.line, given, "scene", scene)) return code;
  if (const int code = muscle_set(sim.line, scene.muscles, scene.more_muscles, to.muscles)) return code;
  to.tolerance_m = above_0(scene.tolerance_m);
  to.tolerance_px = scene.tolerance_px;
  if (scene.has_camera != 0)
    to.camera = Viewpoint{sim.axes.place_from(scene.eye),
                          sim.axes.direction_from(scene.gaze),
                          scene.half_angle_rad,
                          scene.radians_per_pixel,
                          scene.near_m,
                          scene.reach_m};
  to.asleep_beyond_m = above_0(scene.asleep_beyond_m);
  to.compact_unseen = scene.compact_unseen != 0;
  to.looked_at = scene.looked_at != 0;
  if (scene.budget_s > 0) to.budget_s = scene.budget_s;
  return MOBIL_OK;
}

}  // namespace

int mobil_lod_set_options(mobil_sim* sim, const mobil_lod_options* options, const mobil_muscles* muscles) {
  return call(sim, "mobil_lod_set_options", [&](mobil_sim& s) {
    mobil_lod_options known;
    if (const int code = read_struct(s.line, options, "options", known)) return code;
    LodOptions as;
    as.slack = known.slack;
    as.switches = known.switches;
    as.switching_s = known.switching_s;
    as.stagger = known.stagger;
    as.margin = known.margin;
    if (known.machine_factor > 0) as.machine_factor = known.machine_factor;
    if (muscles != nullptr) {
      mobil_muscles of;
      if (const int code = read_struct(s.line, muscles, "muscles", of)) return code;
      if (const int code = leg_muscles(s.line, of, as.leg_muscles)) return code;
    }
    return code_of(s.line, s.world().lod().set_options(as));
  });
}

int mobil_lod_set_scene(mobil_sim* sim, const mobil_scene* scene) {
  return call(sim, "mobil_lod_set_scene", [&](mobil_sim& s) {
    LodScene needs;
    if (const int code = needs_of(s, scene, needs)) return code;
    return code_of(s.line, s.world().lod().set_scene(needs));
  });
}

int mobil_lod_prepare(mobil_sim* sim) {
  return call(sim, "mobil_lod_prepare", [&](mobil_sim& s) { return code_of(s.line, s.world().lod().prepare()); });
}

int mobil_lod_manage(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_needs* needs) {
  return call(sim, "mobil_lod_manage", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    LodOverrides own;
    if (needs != nullptr) {
      mobil_needs known;
      if (const int code = read_struct(s.line, needs, "needs", known)) return code;
      if ((known.muscles | known.more_muscles) != 0) {
        if (const int code = muscle_set(s.line, known.muscles, known.more_muscles, own.muscles.emplace())) return code;
      }
      own.tolerance_m = above_0(known.tolerance_m);
      if (known.looked_at >= 0) own.looked_at = known.looked_at != 0;
    }
    if (const int code = s.check_people()) return code;
    return code_of(s.line, s.world().lod().manage(s.people, own));
  });
}

int mobil_lod_release(mobil_sim* sim, const mobil_id* ids, size_t count) {
  return call(sim, "mobil_lod_release", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (const int code = s.check_people()) return code;
    for (std::size_t i = 0; i < count; ++i)
      if (!is_managed(s.world().world(), s.people[i]))
        return s.line.refuse(MOBIL_MISSING, fmt::format("person {} is not managed; mobil_lod_manage does that", i));
    return code_of(s.line, s.world().lod().release(s.people));
  });
}

int mobil_lod_report(mobil_sim* sim, mobil_lod_counts* out) {
  return call(sim, "mobil_lod_report", [&](mobil_sim& s) {
    const LodReport& did = s.world().lod().report();
    const mobil_lod_counts to = {sizeof to,    did.evaluated, did.switched, did.waiting,    did.refused,
                                 did.woken,    did.slept,     did.begun,    did.ended,      did.compacted,
                                 did.expanded, did.factor,    did.machine,  did.predicted_s};
    return write_struct(s.line, to, out, "out");
  });
}

int mobil_lod_why(mobil_sim* sim, mobil_id id, int muscle, char* line, size_t room, float* error_m, double* cost_us) {
  return call(sim, "mobil_lod_why", [&](mobil_sim& s) {
    Muscle of{};
    if (const int code = muscle_number(s.line, muscle, of)) return code;
    const auto why = s.world().lod().why(entity_of(id), of);
    if (!why) return s.line.refuse(why.error());
    if (line != nullptr && room > 0) {
      const std::size_t length = std::min(room - 1, why->text.size());
      std::memcpy(line, why->text.data(), length);
      line[length] = 0;
    }
    if (error_m != nullptr) *error_m = why->predicted_error_m;
    if (cost_us != nullptr) *cost_us = why->predicted_cost_us;
    return int{MOBIL_OK};
  });
}

int mobil_lod_level(int level, int muscle, float speed_m_s, float height_m, int inertia, int pulling,
                    mobil_level* out) {
  static const LodTable lod_table(accuracy_table());
  if (out == nullptr) return MOBIL_REFUSED;
  if (muscle < 0 || static_cast<std::size_t>(muscle) >= max_muscles) return MOBIL_REFUSED;
  if (!(speed_m_s >= 0) || !(height_m > 0)) return MOBIL_REFUSED;
  if (level < 0 || static_cast<std::size_t>(level) >= level_count) return MOBIL_MISSING;
  const LevelCase of{static_cast<std::uint32_t>(muscle), LodTable::speed_step(speed_m_s, height_m), inertia != 0, true,
                     pulling != 0};
  const auto at = static_cast<std::uint32_t>(level);
  const LodLevel& is = levels_of(of.active)[at];
  *out = {is.name.data(),    static_cast<int>(is.method),         static_cast<int>(is.modes),
          is.moving ? 1 : 0, lod_table.error_m(of, at, height_m), lod_table.cost_us(of, at)};
  return MOBIL_OK;
}
