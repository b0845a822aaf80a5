/* Step events, root motion, present walks and placing of people. A part of mobil.h, which includes it. Since interface
 * 2. */
#ifndef MOBIL_PLAY_H
#define MOBIL_PLAY_H

/* ---- Play ------------------------------------------------------------------------------------------------------- */

/* Writes a walker's requested walk, as mobil_change_walk takes it: speed, step length and heading, or speed 0 to stand.
 * The resulting step frequency is written too, but is not `given`. `style` has room for all values of mobil_style, and
 * `out` points to it; null skips the style. All values are corrected to the limits (mobil_get_style). */
MOBIL_API int mobil_get_walk(mobil_sim* sim, mobil_id id, mobil_walk* out, float* style, size_t room);

/* Moves walkers at once, all or none: rows of four floats, a position and a heading in rad. */
MOBIL_API int mobil_place_many(mobil_sim* sim, const mobil_id* ids, size_t count, const float* places, size_t stride);

/* Writes the limits of ground, joints and pelvis that a walker violates now. Few walkers do, briefly, while they change
 * their walk. `text` receives one line for each ("a knee is bent by 146 deg; the limit is 143.8") and a final 0.
 * *length is the number of characters without the 0, and can be null. If `text` is null, only *length is written; if
 * `room` is too small as well, and the call returns MOBIL_ROOM. */
MOBIL_API int mobil_limit_violations(mobil_sim* sim, mobil_id id, char* text, size_t room, size_t* length);
/* Writes the numbers of people beyond a limit in the last tick, and in all ticks together. Either can be null. */
MOBIL_API int mobil_limit_violation_counts(mobil_sim* sim, size_t* people, size_t* all);

/* Kinds of step events. */
enum {
  MOBIL_HEEL_STRIKE, /* a foot touches the ground */
  MOBIL_TOE_OFF,     /* a foot leaves the ground */
  MOBIL_STOPPED,     /* a person who walked, or stepped on the spot or aside, stands */
  MOBIL_STARTED      /* a standing person begins to step */
};
/* One step event. */
typedef struct mobil_event {
  mobil_id id;
  int kind, side;    /* MOBIL_HEEL_STRIKE and so on; MOBIL_RIGHT or MOBIL_LEFT */
  unsigned int tick; /* the tick of the event, from 1 */
  float part;        /* fraction of that tick, 0 to 1: time (tick - 1 + part) times tick_s, to half a microsecond */
  float place[3];    /* on the ground under the ankle of the flat foot; stops and starts: on the walking line */
  float heading_rad; /* of the foot; stops and starts: of the body */
} mobil_event;
/* Writes the events of people with MOBIL_STEP_EVENTS in all ticks of the last mobil_advance or mobil_tick, by time.
 * *count is their number. If `out` is null, only *count is written; if `room` is too small as well, and the call
 * returns MOBIL_ROOM. Positions are those at the tick, before a later mobil_shift_origin or mobil_place. Ticks that run
 * again after a rollback write their events again. */
MOBIL_API int mobil_events(mobil_sim* sim, mobil_event* out, size_t room, size_t* count);

/* Position and heading of a person on the ground, smooth along the walking line, without the sway of the hips. */
typedef struct mobil_root {
  double place[3], heading_rad;
} mobil_root;
/* Motion from one root to another, in the host's axes with the first root's heading along the axis ahead, and the turn
 * to the left, rad. */
typedef struct mobil_motion {
  float way[3], turn_rad;
} mobil_motion;
/* Writes the roots of people `ahead_s` after the last tick, 0 to 0.2: alpha times tick_s for a frame. */
MOBIL_API int mobil_roots(mobil_sim* sim, const mobil_id* ids, size_t count, double ahead_s, mobil_root* out);
/* Writes the motion from `roots`, which mobil_roots or an earlier call wrote, to the present roots, and stores these in
 * `roots`. */
MOBIL_API int mobil_root_motion(mobil_sim* sim, const mobil_id* ids, size_t count, double ahead_s, mobil_root* roots,
                                mobil_motion* out);

#endif
