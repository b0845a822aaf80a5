/* Surroundings of walkers: collision avoidance, obstacles and uneven ground. A part of mobil.h, which includes it.
 * Functions since interface 4. */
#ifndef MOBIL_SURROUNDINGS_H
#define MOBIL_SURROUNDINGS_H

/* ---- Avoidance --------------------------------------------------------------------------------------------------- */

/* Distances that managed walkers keep. Values are clamped to their ranges. */
typedef struct mobil_avoidance_options {
  size_t size;
  float radius_h;    /* half the breadth that two walkers keep clear, over height, 0.02 to 0.5; default 0.105: 0.18 m at
                        1.72 m, for the trunk and turned shoulders */
  float overlap_m;   /* maximum overlap of two walkers after waiting, 0 to 0.2; default 0.03 */
  float shoulders_h; /* half the breadth of the shoulders with the arms, over height, radius_h to 0.5; default 0.128.
                        Kept clear of walls, discs and unmanaged people; closer to others the shoulders turn */
} mobil_avoidance_options;

/* Counts of all ticks of the last mobil_advance or mobil_tick. `people`: managed in the last tick. `chose`: chosen
 * steps. `kept_reservation`: steps that kept the reservation. `yielded`: steps that yielded to one chosen in the same
 * tick. `waiting`: steps on which a walker stands but wants to walk. */
typedef struct mobil_avoidance_counts {
  size_t size;
  size_t people, chose;
  MOBIL_RENAMED(size_t, kept_reservation, kept_claim);
  MOBIL_RENAMED(size_t, yielded, gave_way);
  size_t waiting;
} mobil_avoidance_counts;

/* Sets the options, for people managed from now on; null: defaults. */
MOBIL_API int mobil_avoidance_set_options(mobil_sim* sim, const mobil_avoidance_options* options);
/* Starts or stops (`on` 0) to manage walkers, all or none. The desired velocity is initially that of the last request.
 * Walkers who are managed already keep their desired velocity and distances. Released walkers keep their present gait
 * and face their way; one slowed by a slope alone returns to the desired gait after it. Use
 * mobil_avoidance_set_desired_velocity for managed walkers: changes by mobil_change_walk last until the next step. */
MOBIL_API int mobil_avoidance_manage(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
/* Sets desired velocities, all or none: rows of two floats, a speed in m/s (0: stand) and a heading in rad. */
MOBIL_API int mobil_avoidance_set_desired_velocity(mobil_sim* sim, const mobil_id* ids, size_t count,
                                                   const float* wishes, size_t stride);
/* Replaces all straight walls: rows of six floats, two positions. Heights are ignored. Walls and discs must be set
 * again after mobil_shift_origin. */
MOBIL_API int mobil_avoidance_set_walls(mobil_sim* sim, const float* walls, size_t stride, size_t count);
/* Replaces all discs (players, cars, pillars): rows of seven floats, a position, a velocity (units of length a second)
 * and a radius (units of length). */
MOBIL_API int mobil_avoidance_set_discs(mobil_sim* sim, const float* discs, size_t stride, size_t count);
/* As the two calls above, for floors that lie above each other. `heights`: rows of two floats, bottom and top of each
 * wall or disc (units of length). Walkers whose ground is at or above the top, or more than 2 m below the bottom, do
 * not see it. Null: all heights. Refused: a top that is not above the bottom. */
MOBIL_API int mobil_avoidance_set_walls_between(mobil_sim* sim, const float* walls, size_t stride, const float* heights,
                                                size_t heights_stride, size_t count);
MOBIL_API int mobil_avoidance_set_discs_between(mobil_sim* sim, const float* discs, size_t stride, const float* heights,
                                                size_t heights_stride, size_t count);
/* Writes the counts. */
MOBIL_API int mobil_avoidance_report(mobil_sim* sim, mobil_avoidance_counts* out);

/* ---- Terrain ----------------------------------------------------------------------------------------------------- */

/* Writes the ground at `count` positions, which are rows of three floats with height 0; `who` are the people. `ground`
 * has rows of four floats, initially zero: height, and a normal of any length (level if zero). Slopes are limited to 45
 * degrees. A result that is not finite, or has a normal that does not point up, is replaced: by the plane of another
 * query under the same sole, or by level ground at the last height. Must return 0; any other value ends the call: the
 * tick does not run, and mobil_advance or mobil_tick is refused. It must not use the simulation. */
typedef int (*mobil_heights)(void* user, const float* places, const mobil_id* who, size_t count, float* ground);
/* Counts of all ticks of the last mobil_advance or mobil_tick: managed people (of the last tick), queried steps,
 * queried positions, and results that could not be used. */
typedef struct mobil_terrain_counts {
  size_t size;
  size_t people, asked, places, unusable;
} mobil_terrain_counts;

/* Sets the function that resolves queries from now on, on the calling thread. It gets 27 positions for each step, and
 * 33 for people who are new or were moved. Null: use mobil_terrain_query. */
MOBIL_API int mobil_terrain_set_heights(mobil_sim* sim, mobil_heights heights, void* user);
/* Puts walkers on that ground, or (`on` 0) back on the level plane through the origin, all or none. */
MOBIL_API int mobil_terrain_manage(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
/* Switches speed scaling on or off (`on` 0, the default) from the next resolved queries on. Walkers on that ground slow
 * down on slopes and stairs, one step after they get there, and resume the requested walk on level ground. Requests by
 * mobil_change_walk and mobil_avoidance_set_desired_velocity are for level ground. */
MOBIL_API int mobil_terrain_set_speed_scaling(mobil_sim* sim, int on);
/* Writes the queries of the next tick, in the form that mobil_heights gets, for a host without such a function. `who`
 * can be null. *count is the number of positions. If `places` is null, only *count is written; if `room` is too small
 * as well, and the call returns MOBIL_ROOM. The simulation does not change. */
MOBIL_API int mobil_terrain_query(mobil_sim* sim, float* places, size_t stride, mobil_id* who, size_t room,
                                  size_t* count);
/* Sets the ground at the positions of the last mobil_terrain_query, in their order and in the form of mobil_heights,
 * before the next tick. `unusable` (can be null) is the number of results that could not be used. With speed scaling
 * call it also without positions: it adapts walks that were requested since the last call. */
MOBIL_API int mobil_terrain_resolve(mobil_sim* sim, const float* ground, size_t stride, size_t count, size_t* unusable);
/* Writes the counts. */
MOBIL_API int mobil_terrain_report(mobil_sim* sim, mobil_terrain_counts* out);

#endif
