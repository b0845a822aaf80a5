// Deprecated names, removed in 0.5, implemented by their replacements.

#include "systems/c/c_call.h"

namespace {

using namespace mobil;
using namespace mobil::c;

/// Changes those people who have the given state to full.
int make_full(mobil_sim* sim, const char* name, const mobil_id* ids, std::size_t count, PersonState state,
              float within_m) {
  return call(sim, name, [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (const int code = s.check_people()) return code;
    std::erase_if(s.people, [&](Entity person) { return s.world().state(person) != state; });
    return code_of(s.line, s.world().set_state(s.people, PersonState::full, within_m));
  });
}

}  // namespace

int mobil_state(mobil_sim* sim, mobil_id id, int* bits) {
  int state = 0;
  if (const int code = mobil_has(sim, id, bits)) return code;
  if (const int code = mobil_get_state(sim, id, &state)) return code;
  *bits |= state;
  return MOBIL_OK;
}

int mobil_sleep(mobil_sim* sim, const mobil_id* ids, size_t count, size_t* changed) {
  return mobil_set_state(sim, ids, count, MOBIL_ASLEEP, 0, changed);
}
int mobil_wake(mobil_sim* sim, const mobil_id* ids, size_t count, float within_m) {
  return make_full(sim, "mobil_wake", ids, count, PersonState::asleep, within_m);
}
int mobil_compact(mobil_sim* sim, const mobil_id* ids, size_t count, size_t* changed) {
  return mobil_set_state(sim, ids, count, MOBIL_COMPACT, 0, changed);
}
int mobil_expand(mobil_sim* sim, const mobil_id* ids, size_t count) {
  return make_full(sim, "mobil_expand", ids, count, PersonState::compact, 0.005F);
}
int mobil_set_forces(mobil_sim* sim, const mobil_id* ids, size_t count, int on) {
  return call(sim, "mobil_set_forces", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (const int code = s.people_once()) return code;
    return code_of(s.line, s.world().enable(s.people, Feature::forces, on != 0));
  });
}
int mobil_set_fat_wobble(mobil_sim* sim, const mobil_id* ids, size_t count, int on) {
  return mobil_enable(sim, ids, count, MOBIL_FAT, on);
}
int mobil_watch(mobil_sim* sim, const mobil_id* ids, size_t count, int on) {
  return mobil_enable(sim, ids, count, MOBIL_STEP_EVENTS, on);
}

int mobil_start_choosing(mobil_sim* sim, const mobil_lod_options* options, const mobil_muscles* muscles) {
  return mobil_lod_set_options(sim, options, muscles);
}
int mobil_set_scene(mobil_sim* sim, const mobil_scene* scene) {
  return mobil_lod_set_scene(sim, scene);
}
int mobil_prepare_scene(mobil_sim* sim) {
  return mobil_lod_prepare(sim);
}
int mobil_manage(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_needs* needs) {
  return mobil_lod_manage(sim, ids, count, needs);
}
int mobil_release(mobil_sim* sim, const mobil_id* ids, size_t count) {
  return mobil_lod_release(sim, ids, count);
}
int mobil_why(mobil_sim* sim, mobil_id id, int muscle, char* line, size_t room, float* error_m, double* cost_us) {
  return mobil_lod_why(sim, id, muscle, line, room, error_m, cost_us);
}
int mobil_way(int way, int muscle, float speed_m_s, float height_m, int inertia, int pulling, mobil_level* out) {
  return mobil_lod_level(way, muscle, speed_m_s, height_m, inertia, pulling, out);
}
int mobil_choose(mobil_sim* sim, mobil_lod_counts* out) {
  return out == nullptr ? int{MOBIL_OK} : mobil_lod_report(sim, out);
}

int mobil_start_avoidance(mobil_sim* sim, const mobil_avoidance_options* options) {
  if (const int code = mobil_avoidance_set_options(sim, options)) return code;
  if (const int code = mobil_avoidance_set_walls(sim, nullptr, 0, 0)) return code;
  return mobil_avoidance_set_discs(sim, nullptr, 0, 0);
}
int mobil_avoid(mobil_sim* sim, const mobil_id* ids, size_t count, int on) {
  return mobil_avoidance_manage(sim, ids, count, on);
}
int mobil_want(mobil_sim* sim, const mobil_id* ids, size_t count, const float* wishes, size_t stride) {
  return mobil_avoidance_set_desired_velocity(sim, ids, count, wishes, stride);
}
int mobil_set_walls(mobil_sim* sim, const float* walls, size_t stride, size_t count) {
  return mobil_avoidance_set_walls(sim, walls, stride, count);
}
int mobil_set_discs(mobil_sim* sim, const float* discs, size_t stride, size_t count) {
  return mobil_avoidance_set_discs(sim, discs, stride, count);
}
int mobil_steer(mobil_sim* sim, mobil_avoidance_counts* out) {
  return out == nullptr ? int{MOBIL_OK} : mobil_avoidance_report(sim, out);
}

int mobil_set_on_ground(mobil_sim* sim, const mobil_id* ids, size_t count, int on) {
  return mobil_terrain_manage(sim, ids, count, on);
}
int mobil_set_slowing(mobil_sim* sim, int on) {
  return mobil_terrain_set_speed_scaling(sim, on);
}
int mobil_ask_ground(mobil_sim* sim, float* places, size_t stride, mobil_id* who, size_t room, size_t* count) {
  return mobil_terrain_query(sim, places, stride, who, room, count);
}
int mobil_answer_ground(mobil_sim* sim, const float* ground, size_t stride, size_t count, size_t* unusable) {
  return mobil_terrain_resolve(sim, ground, stride, count, unusable);
}

int mobil_broken_limits(mobil_sim* sim, mobil_id id, char* text, size_t room, size_t* length) {
  return mobil_limit_violations(sim, id, text, room, length);
}
int mobil_beyond_limits(mobil_sim* sim, size_t* people, size_t* all) {
  return mobil_limit_violation_counts(sim, people, all);
}
