/* What is round walkers: others whose way they keep out of, walls, and ground that is not level. A part of mobil.h,
 * which includes it; in the header that hosts have it stands in its place. Calls since interface 4. */
#ifndef MOBIL_SURROUNDINGS_H
#define MOBIL_SURROUNDINGS_H

/* ---- Avoidance --------------------------------------------------------------------------------------------------- */

/* How much room people keep who avoid each other. What is out of range is taken as the end that is nearer. */
typedef struct mobil_avoidance_options {
  size_t size;
  float radius_h; /* half the breadth that two keep clear of each other, of the height, 0.02 to 0.5; usual 0.105: 0.18 m
                     at 1.72 m, the trunk's and that of turned shoulders */
  float overlap_m;   /* how far two may overlap who have waited, 0 to 0.2; usual 0.03 */
  float shoulders_h; /* half of the shoulders' breadth with the arms, of the height, radius_h to 0.5; usual 0.128: kept
                        clear of walls, discs and who avoids nobody; who comes nearer to others turns them */
} mobil_avoidance_options;

/* Counts of all ticks of the last mobil_advance or mobil_tick. `people`: looked at in the last tick. `chose`: choices
 * of a step. `kept_reservation`: choices that kept to the announced step. `yielded`: choices that gave way to a
 * simultaneous one. `waiting`: choices to stand although the walker wants to walk. */
typedef struct mobil_avoidance_counts {
  size_t size;
  size_t people, chose;
  MOBIL_RENAMED(size_t, kept_reservation, kept_claim);
  MOBIL_RENAMED(size_t, yielded, gave_way);
  size_t waiting;
} mobil_avoidance_counts;

/* Sets the room of people managed from now on; `options` null: usual. */
MOBIL_API int mobil_avoidance_set_options(mobil_sim* sim, const mobil_avoidance_options* options);
/* From now on these walkers keep out of each other's way, and want what they were last asked to do (who does so already
 * keeps their wish and room); or no more (`on` 0), and go on as they now do, facing their way; whom a slope alone slows
 * goes on from it as they want. All or none. Who avoids others is asked by mobil_avoidance_set_desired_velocity: what
 * mobil_change_walk asks lasts until the next step. */
MOBIL_API int mobil_avoidance_manage(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
/* Where they want to go, all or none: rows of two floats, a speed in m/s (0: to stand) and a heading in rad. */
MOBIL_API int mobil_avoidance_set_desired_velocity(mobil_sim* sim, const mobil_id* ids, size_t count,
                                                   const float* wishes, size_t stride);
/* Straight walls instead of those before: rows of six floats, two places. Heights do not count. Give them again after
 * mobil_shift_origin, as discs. */
MOBIL_API int mobil_avoidance_set_walls(mobil_sim* sim, const float* walls, size_t stride, size_t count);
/* Players, cars, pillars, instead of those before: rows of seven floats, a place, a velocity (units of places a
 * second), and a radius (in that unit). */
MOBIL_API int mobil_avoidance_set_discs(mobil_sim* sim, const float* discs, size_t stride, size_t count);
/* Writes what was chosen. */
MOBIL_API int mobil_avoidance_report(mobil_sim* sim, mobil_avoidance_counts* out);

/* ---- Terrain ----------------------------------------------------------------------------------------------------- */

/* Answers how the ground is at `count` places, rows of three floats whose height is 0; `who` are whose they are. Writes
 * rows of four floats, all zero before: the height, and the normal, of any length (0 0 0: level). Slopes above 45
 * degrees are taken as that. Of an answer that is not a number, or whose normal does not point up, the plane of another
 * under the same sole is taken, or level ground at the height of the last foothold. Returns 0; otherwise the tick does
 * not run, and mobil_advance or mobil_tick is refused. It must not use the simulation. */
typedef int (*mobil_heights)(void* user, const float* places, const mobil_id* who, size_t count, float* ground);
/* What the ground was asked in all ticks of the last mobil_advance or mobil_tick: people on it in the last of them; how
 * often somebody's ground was asked for, at how many places; and how many answers could not be used. */
typedef struct mobil_terrain_counts {
  size_t size;
  size_t people, asked, places, unusable;
} mobil_terrain_counts;

/* Answers from now on, on the thread that ticks: 27 places for who takes a step (33 for who is new, or was put
 * elsewhere). Null: use mobil_terrain_query. */
MOBIL_API int mobil_terrain_set_heights(mobil_sim* sim, mobil_heights heights, void* user);
/* From now on these walkers stand on that ground, or (`on` 0) again on the level plane through the origin. All or none.
 */
MOBIL_API int mobil_terrain_manage(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
/* From the next answers on, walkers on that ground slow down on slopes and stairs, one step after they come there, and
 * go on as asked where it is level; or no more (`on` 0). What mobil_change_walk and
 * mobil_avoidance_set_desired_velocity ask is meant for level ground. Usual: off. */
MOBIL_API int mobil_terrain_set_speed_scaling(mobil_sim* sim, int on);
/* For a host without mobil_heights: where the ground has to be known before the next tick, as mobil_heights is asked;
 * `who` may be null. *count is how many places there are. Without `places` the call writes nothing else; with too
 * little room it writes nothing else and returns MOBIL_ROOM. Asking changes nothing. */
MOBIL_API int mobil_terrain_query(mobil_sim* sim, float* places, size_t stride, mobil_id* who, size_t room,
                                  size_t* count);
/* The ground at the places of the last mobil_terrain_query, in their order, before the next tick, as mobil_heights
 * answers; `unusable` (may be null) is how many answers could not be used. If walkers slow down on slopes, call it
 * without places too. It then adapts walks that were requested since the last call. */
MOBIL_API int mobil_terrain_resolve(mobil_sim* sim, const float* ground, size_t stride, size_t count, size_t* unusable);
/* Writes what the ground was asked. */
MOBIL_API int mobil_terrain_report(mobil_sim* sim, mobil_terrain_counts* out);

#endif
