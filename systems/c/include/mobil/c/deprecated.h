/* Deprecated names, each with its replacement. They are removed in 0.5. A part of mobil.h. */
#ifndef MOBIL_DEPRECATED_H
#define MOBIL_DEPRECATED_H

/* ---- Deprecated -------------------------------------------------------------------------------------------------- */

/* The attribute of each name states its replacement. */
enum {
  MOBIL_CHOOSING MOBIL_DEPRECATED("MOBIL_LOD_OPTIONS") = MOBIL_LOD_OPTIONS,
  MOBIL_CHOSEN MOBIL_DEPRECATED("MOBIL_LOD_COUNTS") = MOBIL_LOD_COUNTS,
  MOBIL_AVOIDANCE MOBIL_DEPRECATED("MOBIL_AVOIDANCE_OPTIONS") = MOBIL_AVOIDANCE_OPTIONS,
  MOBIL_STEERED MOBIL_DEPRECATED("MOBIL_AVOIDANCE_COUNTS") = MOBIL_AVOIDANCE_COUNTS,
  MOBIL_ECD MOBIL_DEPRECATED("MOBIL_EXPLICIT_CENTRAL") = MOBIL_EXPLICIT_CENTRAL,
  MOBIL_ICD MOBIL_DEPRECATED("MOBIL_IMPLICIT_CENTRAL") = MOBIL_IMPLICIT_CENTRAL,
  MOBIL_CAA MOBIL_DEPRECATED("MOBIL_NEWMARK") = MOBIL_NEWMARK,
  MOBIL_REDUCED MOBIL_DEPRECATED("MOBIL_MODAL") = MOBIL_MODAL
};
typedef mobil_lod_options mobil_choosing MOBIL_DEPRECATED("mobil_lod_options");
typedef mobil_lod_counts mobil_chosen MOBIL_DEPRECATED("mobil_lod_counts");
typedef mobil_level mobil_way_figures MOBIL_DEPRECATED("mobil_level");
typedef mobil_avoidance_options mobil_avoidance MOBIL_DEPRECATED("mobil_avoidance_options");
typedef mobil_avoidance_counts mobil_steered MOBIL_DEPRECATED("mobil_avoidance_counts");
typedef mobil_custom_skin mobil_own_skin MOBIL_DEPRECATED("mobil_custom_skin");
MOBIL_API MOBIL_DEPRECATED("mobil_get_state and mobil_has") int mobil_state(mobil_sim* sim, mobil_id id, int* bits);
/* mobil_wake does not change compact people, and mobil_expand does not change sleepers. */
MOBIL_API MOBIL_DEPRECATED("mobil_set_state") int mobil_sleep(mobil_sim* sim, const mobil_id* ids, size_t count,
                                                              size_t* changed);
MOBIL_API MOBIL_DEPRECATED("mobil_set_state") int mobil_wake(mobil_sim* sim, const mobil_id* ids, size_t count,
                                                             float within_m);
MOBIL_API MOBIL_DEPRECATED("mobil_set_state") int mobil_compact(mobil_sim* sim, const mobil_id* ids, size_t count,
                                                                size_t* changed);
MOBIL_API MOBIL_DEPRECATED("mobil_set_state") int mobil_expand(mobil_sim* sim, const mobil_id* ids, size_t count);
MOBIL_API MOBIL_DEPRECATED("mobil_enable") int mobil_set_forces(mobil_sim* sim, const mobil_id* ids, size_t count,
                                                                int on);
MOBIL_API MOBIL_DEPRECATED("mobil_enable") int mobil_set_fat_wobble(mobil_sim* sim, const mobil_id* ids, size_t count,
                                                                    int on);
MOBIL_API MOBIL_DEPRECATED("mobil_enable") int mobil_watch(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
MOBIL_API MOBIL_DEPRECATED("mobil_lod_set_options") int mobil_start_choosing(mobil_sim* sim,
                                                                             const mobil_lod_options* options,
                                                                             const mobil_muscles* muscles);
MOBIL_API MOBIL_DEPRECATED("mobil_lod_set_scene") int mobil_set_scene(mobil_sim* sim, const mobil_scene* scene);
MOBIL_API MOBIL_DEPRECATED("mobil_lod_prepare") int mobil_prepare_scene(mobil_sim* sim);
MOBIL_API MOBIL_DEPRECATED("mobil_lod_manage") int mobil_manage(mobil_sim* sim, const mobil_id* ids, size_t count,
                                                                const mobil_needs* needs);
MOBIL_API MOBIL_DEPRECATED("mobil_lod_release") int mobil_release(mobil_sim* sim, const mobil_id* ids, size_t count);
MOBIL_API MOBIL_DEPRECATED("mobil_lod_why") int mobil_why(mobil_sim* sim, mobil_id id, int muscle, char* line,
                                                          size_t room, float* error_m, double* cost_us);
MOBIL_API MOBIL_DEPRECATED("mobil_lod_level") int mobil_way(int way, int muscle, float speed_m_s, float height_m,
                                                            int inertia, int pulling, mobil_level* out);
/* `out` can be null. */
MOBIL_API MOBIL_DEPRECATED("mobil_lod_report") int mobil_choose(mobil_sim* sim, mobil_lod_counts* out);
/* Also removes walls and discs. */
MOBIL_API MOBIL_DEPRECATED("mobil_avoidance_set_options") int mobil_start_avoidance(
    mobil_sim* sim, const mobil_avoidance_options* options);
MOBIL_API MOBIL_DEPRECATED("mobil_avoidance_manage") int mobil_avoid(mobil_sim* sim, const mobil_id* ids, size_t count,
                                                                     int on);
MOBIL_API MOBIL_DEPRECATED("mobil_avoidance_set_desired_velocity") int mobil_want(mobil_sim* sim, const mobil_id* ids,
                                                                                  size_t count, const float* wishes,
                                                                                  size_t stride);
MOBIL_API MOBIL_DEPRECATED("mobil_avoidance_set_walls") int mobil_set_walls(mobil_sim* sim, const float* walls,
                                                                            size_t stride, size_t count);
MOBIL_API MOBIL_DEPRECATED("mobil_avoidance_set_discs") int mobil_set_discs(mobil_sim* sim, const float* discs,
                                                                            size_t stride, size_t count);
/* `out` can be null. */
MOBIL_API MOBIL_DEPRECATED("mobil_avoidance_report") int mobil_steer(mobil_sim* sim, mobil_avoidance_counts* out);
MOBIL_API MOBIL_DEPRECATED("mobil_terrain_manage") int mobil_set_on_ground(mobil_sim* sim, const mobil_id* ids,
                                                                           size_t count, int on);
MOBIL_API MOBIL_DEPRECATED("mobil_terrain_set_speed_scaling") int mobil_set_slowing(mobil_sim* sim, int on);
MOBIL_API MOBIL_DEPRECATED("mobil_terrain_query") int mobil_ask_ground(mobil_sim* sim, float* places, size_t stride,
                                                                       mobil_id* who, size_t room, size_t* count);
MOBIL_API MOBIL_DEPRECATED("mobil_terrain_resolve") int mobil_answer_ground(mobil_sim* sim, const float* ground,
                                                                            size_t stride, size_t count,
                                                                            size_t* unusable);
MOBIL_API MOBIL_DEPRECATED("mobil_limit_violations") int mobil_broken_limits(mobil_sim* sim, mobil_id id, char* text,
                                                                             size_t room, size_t* length);
MOBIL_API MOBIL_DEPRECATED("mobil_limit_violation_counts") int mobil_beyond_limits(mobil_sim* sim, size_t* people,
                                                                                   size_t* all);
MOBIL_API MOBIL_DEPRECATED("mobil_bind_custom_skin") int mobil_bind_own_skin(mobil_sim* sim, mobil_id like,
                                                                             const mobil_leg_mesh* mesh,
                                                                             mobil_custom_skin** out);
MOBIL_API MOBIL_DEPRECATED("mobil_drop_custom_skin") void mobil_drop_own_skin(mobil_custom_skin* skin);
MOBIL_API MOBIL_DEPRECATED("mobil_custom_skin_vertex_count") size_t
    mobil_own_skin_vertex_count(const mobil_custom_skin* skin);
MOBIL_API MOBIL_DEPRECATED("mobil_custom_skin_index_count") size_t
    mobil_own_skin_index_count(const mobil_custom_skin* skin);
MOBIL_API MOBIL_DEPRECATED("mobil_custom_skin_indices") int mobil_own_skin_indices(const mobil_custom_skin* skin,
                                                                                   unsigned int* out, size_t room);
MOBIL_API MOBIL_DEPRECATED("mobil_custom_skin_rest") int mobil_own_skin_rest(const mobil_custom_skin* skin,
                                                                             unsigned int* out, size_t room,
                                                                             size_t* count);
MOBIL_API MOBIL_DEPRECATED("mobil_write_custom_skin") int mobil_write_own_skin(mobil_sim* sim,
                                                                               const mobil_custom_skin* skin,
                                                                               const mobil_skin_target* targets,
                                                                               size_t stride, size_t count);

#endif
