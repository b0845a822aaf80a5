/* What a game plays by: events of steps, root motion, walks read back, people put elsewhere. A part of mobil.h, which
 * includes it; in the header that hosts have it stands in its place. Since interface 2. */
#ifndef MOBIL_PLAY_H
#define MOBIL_PLAY_H

/* ---- Play ------------------------------------------------------------------------------------------------------- */

/* What a walker is to do, as mobil_change_walk takes it: speed and step length (of who is to stand a speed of 0), the
 * heading to turn to; and the step frequency that follows, which is not among the `given`. `style`: room for as many
 * numbers as mobil_style has, to which `out` then points; null: without. All of it is as limits have it
 * (mobil_get_style). */
MOBIL_API int mobil_get_walk(mobil_sim* sim, mobil_id id, mobil_walk* out, float* style, size_t room);

/* Puts walkers elsewhere at once, all or none: rows of four floats, a place and a heading in rad. */
MOBIL_API int mobil_place_many(mobil_sim* sim, const mobil_id* ids, size_t count, const float* places, size_t stride);

/* The limits of ground, joints and pelvis that a walker is beyond now: few are, for a moment, while they change their
 * walk. A line each ("a knee is bent by 146 deg; the limit is 143.8"), all ended by a 0, are written to `text`; *length
 * is how many characters they have without it, and may be null. Without `text` the call writes nothing else; with too
 * little room it writes nothing else and returns MOBIL_ROOM. */
MOBIL_API int mobil_limit_violations(mobil_sim* sim, mobil_id id, char* text, size_t room, size_t* length);
/* How many people were beyond a limit in the last tick, and how many in all ticks together. Either may be null. */
MOBIL_API int mobil_limit_violation_counts(mobil_sim* sim, size_t* people, size_t* all);

/* What can happen in a walker's steps. */
enum {
  MOBIL_HEEL_STRIKE, /* a foot comes to the ground */
  MOBIL_TOE_OFF,     /* a foot leaves it */
  MOBIL_STOPPED,     /* who walked, or stepped on the spot or aside, stands */
  MOBIL_STARTED      /* who stood begins to step */
};
/* One thing that happened in a step. */
typedef struct mobil_event {
  mobil_id id;
  int kind, side;    /* MOBIL_HEEL_STRIKE and so on; MOBIL_RIGHT or MOBIL_LEFT */
  unsigned int tick; /* in which it was, from 1 on */
  float part;        /* of that tick which was over, 0 to 1: at (tick - 1 + part) times tick_s, to half a microsecond */
  float place[3];    /* on the ground under the foot's ankle when it lies flat; of who stops or starts on their line */
  float heading_rad; /* where the foot points; of who stops or starts the body */
} mobil_event;
/* What happened to who has MOBIL_STEP_EVENTS, in all ticks of the last mobil_advance or mobil_tick, in order of time.
 * *count is how many there are. Without `out` the call writes nothing else; with too little room it writes nothing else
 * and returns MOBIL_ROOM. Places are those of the tick, before a later mobil_shift_origin or mobil_place. Ticks that
 * run again after going back give their events again. */
MOBIL_API int mobil_events(mobil_sim* sim, mobil_event* out, size_t room, size_t* count);

/* Where a person is on the ground and heads, smooth along the walking line, without the sway of the hips. */
typedef struct mobil_root {
  double place[3], heading_rad;
} mobil_root;
/* The way from one root to another, in the host's axes as if the first headed along the axis ahead; by how much it
 * turned, to the left, rad. */
typedef struct mobil_motion {
  float way[3], turn_rad;
} mobil_motion;
/* `ahead_s` after the last tick, 0 to 0.2: alpha times tick_s for a frame. */
MOBIL_API int mobil_roots(mobil_sim* sim, const mobil_id* ids, size_t count, double ahead_s, mobil_root* out);
/* From `roots`, as mobil_roots wrote them before time went on, to where people are now; that is written over them. */
MOBIL_API int mobil_root_motion(mobil_sim* sim, const mobil_id* ids, size_t count, double ahead_s, mobil_root* roots,
                                mobil_motion* out);

#endif
