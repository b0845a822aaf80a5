/* What is round walkers: others whose way they keep out of, walls, and ground that is not level. A part of mobil.h,
 * which includes it; in the header that hosts have it stands in its place. Since interface 3. */
#ifndef MOBIL_SURROUNDINGS_H
#define MOBIL_SURROUNDINGS_H

/* ---- Surroundings ------------------------------------------------------------------------------------------------ */

/* How much room people keep who avoid each other. What is out of range is taken as the end that is nearer. */
typedef struct mobil_avoidance {
  size_t size;
  float radius_h; /* half the breadth that two keep clear of each other, of the height, 0.02 to 0.5; usual 0.105: 0.18 m
                     at 1.72 m, the trunk's and that of turned shoulders */
  float overlap_m;   /* how far two may overlap who have waited, 0 to 0.2; usual 0.03 */
  float shoulders_h; /* half of the shoulders' breadth with the arms, of the height, radius_h to 0.5; usual 0.128: kept
                        clear of walls, discs and who avoids nobody; who comes nearer to others turns them */
} mobil_avoidance;

/* What mobil_steer did: people looked at; who chose a step; of these who had to keep to what others know of them, and
 * who gave way to somebody that chose at the same time; who stands though they want to walk. */
typedef struct mobil_steered {
  size_t size;
  size_t people, chose, kept_claim, gave_way, waiting;
} mobil_steered;

/* Begins, or begins anew with other options and without walls and discs; `options` null: usual ones. Who avoids others
 * already goes on to. */
MOBIL_API int mobil_start_avoidance(mobil_sim* sim, const mobil_avoidance* options);
/* From now on these walkers keep out of each other's way, and want what they were last asked to do (who does so already
 * keeps their wish and room); or no more (`on` 0), and go on as they now do, facing their way; whom a slope alone slows
 * goes on from it as they want. All or none. Who avoids others is asked by mobil_want: what mobil_change_walk asks
 * lasts until the next step. */
MOBIL_API int mobil_avoid(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
/* Where they want to go, all or none: rows of two floats, a speed in m/s (0: to stand) and a heading in rad. */
MOBIL_API int mobil_want(mobil_sim* sim, const mobil_id* ids, size_t count, const float* wishes, size_t stride);
/* Straight walls instead of those before: rows of six floats, two places. Heights do not count. Give them again after
 * mobil_shift_origin, as discs. */
MOBIL_API int mobil_set_walls(mobil_sim* sim, const float* walls, size_t stride, size_t count);
/* Players, cars, pillars, instead of those before: rows of seven floats, a place, a velocity (units of places a
 * second), and a radius (in that unit). */
MOBIL_API int mobil_set_discs(mobil_sim* sim, const float* discs, size_t stride, size_t count);
/* Chooses the steps of those who avoid others. Before each tick; `out` may be null. */
MOBIL_API int mobil_steer(mobil_sim* sim, mobil_steered* out);

/* From now on these walkers stand on the ground that mobil_answer_ground tells of, or (`on` 0) again on the level plane
 * through the origin. All or none. */
MOBIL_API int mobil_set_on_ground(mobil_sim* sim, const mobil_id* ids, size_t count, int on);
/* From the next mobil_answer_ground on, walkers on that ground slow down on slopes and stairs, one step after they come
 * there, and go on as asked where it is level; or no more (`on` 0). What mobil_change_walk and mobil_want ask is meant
 * for level ground. Usual: off. */
MOBIL_API int mobil_set_slowing(mobil_sim* sim, int on);
/* Where the ground has to be known before the next tick: 27 places for who takes a step (33 for who is new, or was put
 * elsewhere). Rows of three floats, a place whose height is 0; `who` (may be null) is whose they are. *count is how
 * many there are. Without `places` the call writes nothing else; with too little room it writes nothing else and
 * returns MOBIL_ROOM. Asking changes nothing. */
MOBIL_API int mobil_ask_ground(mobil_sim* sim, float* places, size_t stride, mobil_id* who, size_t room, size_t* count);
/* The ground at the places of the last mobil_ask_ground, in their order, before the next tick: rows of four floats, its
 * height, and its normal, of any length (0 0 0: level). Slopes above 45 degrees are taken as that. Of an answer
 * that is not a number, or whose normal does not point up, the plane of another under the same sole is taken, or level
 * ground at the height of the last foothold; `unusable` (may be null) is how many of those there were.
 * Where walkers slow down, call it also with no places: who was asked to walk otherwise since is looked at. */
MOBIL_API int mobil_answer_ground(mobil_sim* sim, const float* ground, size_t stride, size_t count, size_t* unusable);

#endif
