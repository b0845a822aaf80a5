/* Level of detail of muscles. A part of mobil.h, which includes it. Functions since interface 4. */
#ifndef MOBIL_LOD_H
#define MOBIL_LOD_H

/* ---- Level of detail ----------------------------------------------------------------------------------------------
 */

/* Needs of a scene. Fields marked as optional are unset if they are not above 0. */
typedef struct mobil_scene {
  size_t size;
  unsigned int muscles;
  float tolerance_m; /* optional: that of the camera, or 1 mm */
  float tolerance_px;
  int has_camera; /* 1: the following fields are used */
  float eye[3], gaze[3];
  float half_angle_rad; /* of the cone through the picture's corners */
  float radians_per_pixel;
  float near_m, reach_m;     /* unseen people within near_m are simulated; beyond reach_m none are */
  float asleep_beyond_m;     /* people farther than this from being seen sleep; optional: none sleep */
  int compact_unseen;        /* 1: unseen people are compact */
  int looked_at;             /* without a camera: 1 places control points */
  double budget_s;           /* processor time a tick for deformation; optional: unlimited */
  unsigned int more_muscles; /* as in mobil_muscles; since interface 5 */
  int unused;
} mobil_scene;

/* Needs of one person that override those of the scene. */
typedef struct mobil_needs {
  size_t size;
  unsigned int muscles;      /* 0, with more_muscles: the scene's */
  float tolerance_m;         /* optional: the scene's */
  int looked_at;             /* negative: the scene's */
  unsigned int more_muscles; /* as in mobil_muscles; since interface 5 */
  int unused;
} mobil_needs;

/* Parameters of the choice, and limits of the changes in one tick. */
typedef struct mobil_lod_options {
  size_t size;
  float slack;           /* a cheaper method must meet this fraction of the tolerance */
  unsigned int switches; /* maximum number of methods changed in one tick */
  double switching_s;    /* maximum time of these changes */
  unsigned int stagger;  /* number of ticks in which all people are evaluated once */
  float margin;          /* safety factor on predicted errors */
  double machine_factor; /* time of this machine over that of the table's; optional: measured, and then choices depend
                            on it */
} mobil_lod_options;

/* Counts of all ticks of the last mobil_advance or mobil_tick. */
typedef struct mobil_lod_counts {
  size_t size;
  size_t looked_at, switched, waiting, refused, woken, slept, begun, ended, compacted, expanded;
  float factor;       /* by which tolerances are exceeded under the budget */
  double machine;     /* measured over predicted time */
  double predicted_s; /* time of a tick's deformation */
} mobil_lod_counts;

/* Sets the parameters. `muscles` (null: defaults) is used, except muscles and method, for people who get muscles by
 * mobil_lod_manage. */
MOBIL_API int mobil_lod_set_options(mobil_sim* sim, const mobil_lod_options* options, const mobil_muscles* muscles);
/* Sets the needs of the scene from the next tick on. */
MOBIL_API int mobil_lod_set_scene(mobil_sim* sim, const mobil_scene* scene);
/* Makes the shared data that the scene can require, in some seconds, so that no tick waits for it. */
MOBIL_API int mobil_lod_prepare(mobil_sim* sim);
/* Manages the muscles of people, each named once, from the next tick on; `needs` can be null. */
MOBIL_API int mobil_lod_manage(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_needs* needs);
/* Stops managing people. Methods stay as they are, sleepers wake, and muscles still to come begin. */
MOBIL_API int mobil_lod_release(mobil_sim* sim, const mobil_id* ids, size_t count);
/* Writes the counts. */
MOBIL_API int mobil_lod_report(mobil_sim* sim, mobil_lod_counts* out);
/* Writes the reason for a muscle's method in one line, and its predicted error and cost (both can be null). */
MOBIL_API int mobil_lod_why(mobil_sim* sim, mobil_id id, int muscle, char* line, size_t room, float* error_m,
                            double* cost_us);

/* One of the methods to choose from, and its measured error and cost. */
typedef struct mobil_level {
  const char* name;
  int method; /* this and the next two as in mobil_method */
  MOBIL_RENAMED(int, modes, vectors);
  int moving;
  float error_m; /* of control points, 99.9th percentile over a walk, in that body */
  float cost_us; /* of both legs' muscles and their control points, a tick of 1/60 s, on an Intel Xeon of 3 GHz */
} mobil_level;
/* Writes level `level`, from 0; MOBIL_MISSING after the last. `pulling` 1: active muscles. */
MOBIL_API int mobil_lod_level(int level, int muscle, float speed_m_s, float height_m, int inertia, int pulling,
                              mobil_level* out);

#endif
