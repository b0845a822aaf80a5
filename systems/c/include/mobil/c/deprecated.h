/* Deprecated names, which go in 0.5, and what takes their place. A part of mobil.h, which includes it; in the header
 * that hosts have it stands in its place. */
#ifndef MOBIL_DEPRECATED_H
#define MOBIL_DEPRECATED_H

/* ---- Deprecated -------------------------------------------------------------------------------------------------- */

#define MOBIL_CHOOSING MOBIL_LOD_OPTIONS
#define MOBIL_CHOSEN MOBIL_LOD_COUNTS
#define MOBIL_AVOIDANCE MOBIL_AVOIDANCE_OPTIONS
#define MOBIL_STEERED MOBIL_AVOIDANCE_COUNTS
/** Now mobil_lod_options. */
typedef mobil_lod_options mobil_choosing;
/** Now mobil_lod_counts. */
typedef mobil_lod_counts mobil_chosen;
/** Now mobil_level. */
typedef mobil_level mobil_way_figures;
/** Now mobil_avoidance_options. */
typedef mobil_avoidance_options mobil_avoidance;
/** Now mobil_avoidance_counts. */
typedef mobil_avoidance_counts mobil_steered;

/* mobil_get_state and mobil_has: the bits of both. */
MOBIL_API int mobil_state(mobil_sim* sim, mobil_id id, int* bits);
/* mobil_set_state. mobil_wake leaves compact people as they are, and mobil_expand sleepers. */
MOBIL_API int mobil_sleep(mobil_sim* sim, const mobil_id* ids, size_t count, size_t* changed);
MOBIL_API int mobil_wake(mobil_sim* sim, const mobil_id* ids, size_t count, float within_m);
MOBIL_API int mobil_compact(mobil_sim* sim, const mobil_id* ids, size_t count, size_t* changed);
MOBIL_API int mobil_expand(mobil_sim* sim, const mobil_id* ids, size_t count);
/* mobil_enable. */
MOBIL_API int mobil_set_forces(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
MOBIL_API int mobil_set_fat_wobble(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
MOBIL_API int mobil_watch(mobil_sim* sim, const mobil_id* ids, size_t count, int on);

/* mobil_lod_set_options, _set_scene, _prepare, _manage, _release, _why and _level. */
MOBIL_API int mobil_start_choosing(mobil_sim* sim, const mobil_choosing* options, const mobil_muscles* muscles);
MOBIL_API int mobil_set_scene(mobil_sim* sim, const mobil_scene* scene);
MOBIL_API int mobil_prepare_scene(mobil_sim* sim);
MOBIL_API int mobil_manage(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_needs* needs);
MOBIL_API int mobil_release(mobil_sim* sim, const mobil_id* ids, size_t count);
MOBIL_API int mobil_why(mobil_sim* sim, mobil_id id, int muscle, char* line, size_t room, float* error_m,
                        double* cost_us);
MOBIL_API int mobil_way(int way, int muscle, float speed_m_s, float height_m, int inertia, int pulling,
                        mobil_way_figures* out);
/* mobil_lod_report: ticks choose. `out` may be null. */
MOBIL_API int mobil_choose(mobil_sim* sim, mobil_chosen* out);

/* mobil_avoidance_set_options: this also takes walls and discs away. */
MOBIL_API int mobil_start_avoidance(mobil_sim* sim, const mobil_avoidance* options);
/* mobil_avoidance_manage, _want, _set_walls and _set_discs. */
MOBIL_API int mobil_avoid(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
MOBIL_API int mobil_want(mobil_sim* sim, const mobil_id* ids, size_t count, const float* wishes, size_t stride);
MOBIL_API int mobil_set_walls(mobil_sim* sim, const float* walls, size_t stride, size_t count);
MOBIL_API int mobil_set_discs(mobil_sim* sim, const float* discs, size_t stride, size_t count);
/* mobil_avoidance_report: ticks choose. `out` may be null. */
MOBIL_API int mobil_steer(mobil_sim* sim, mobil_steered* out);

/* mobil_terrain_manage, _set_slowing, _ask and _answer. */
MOBIL_API int mobil_set_on_ground(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
MOBIL_API int mobil_set_slowing(mobil_sim* sim, int on);
MOBIL_API int mobil_ask_ground(mobil_sim* sim, float* places, size_t stride, mobil_id* who, size_t room, size_t* count);
MOBIL_API int mobil_answer_ground(mobil_sim* sim, const float* ground, size_t stride, size_t count, size_t* unusable);

#endif
