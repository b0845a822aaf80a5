/* How finely whose muscles are computed. A part of mobil.h, which includes it; in the header that hosts have it stands
 * in its place. Calls since interface 4. */
#ifndef MOBIL_LOD_H
#define MOBIL_LOD_H

/* ---- Level of detail ----------------------------------------------------------------------------------------------
 */

/* What is good enough. A number that is not above 0 is left out, where it says so. */
typedef struct mobil_scene {
  size_t size;
  unsigned int muscles;
  float tolerance_m; /* left out: of the camera, or 1 mm */
  float tolerance_px;
  int has_camera; /* 1: what follows counts */
  float eye[3], gaze[3];
  float half_angle_rad; /* of the cone round the picture's corners */
  float radians_per_pixel;
  float near_m, reach_m; /* unseen but within near_m move on; beyond reach_m nothing does */
  float asleep_beyond_m; /* who would have to come that near to be seen sleeps; left out: nobody */
  int compact_unseen;    /* 1: of whom nothing is seen is compact */
  int looked_at;         /* without a camera: whether control points are placed */
  double budget_s;       /* processor time a tick for deformation; left out: none */
} mobil_scene;

/* What one person needs otherwise. */
typedef struct mobil_needs {
  size_t size;
  unsigned int muscles; /* 0: the scene's */
  float tolerance_m;    /* left out: the scene's */
  int looked_at;        /* below 0: the scene's */
} mobil_needs;

/* How methods are chosen, and how much may change in one tick. */
typedef struct mobil_lod_options {
  size_t size;
  float slack;           /* a cheaper method is taken where it meets this part of the tolerance */
  unsigned int switches; /* methods changed in one tick, at most */
  double switching_s;    /* and the time that this may take */
  unsigned int stagger;  /* everybody is looked at every so many ticks */
  float margin;          /* what predicted errors are multiplied by */
  double machine_factor; /* how much slower this machine is than the table's; left out: measured, so that choices
                            depend on it */
} mobil_lod_options;

/* What was chosen in all ticks of the last mobil_advance or mobil_tick. */
typedef struct mobil_lod_counts {
  size_t size;
  size_t looked_at, switched, waiting, refused, woken, slept, begun, ended, compacted, expanded;
  float factor;       /* by which tolerances are missed under the budget */
  double machine;     /* measured over predicted time */
  double predicted_s; /* a tick's deformation */
} mobil_lod_counts;

/* Sets how methods are chosen; `muscles` (null: usual ones) are all but muscles and method of those whom managing gives
 * some. */
MOBIL_API int mobil_lod_set_options(mobil_sim* sim, const mobil_lod_options* options, const mobil_muscles* muscles);
/* Sets what the scene needs, from the next tick on. */
MOBIL_API int mobil_lod_set_scene(mobil_sim* sim, const mobil_scene* scene);
/* Makes what the scene may call for: some seconds, and no tick waits later. */
MOBIL_API int mobil_lod_prepare(mobil_sim* sim);
/* From the next tick on muscles of these people, each named once, are chosen; `needs` may be null. */
MOBIL_API int mobil_lod_manage(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_needs* needs);
/* Methods stay as they are and are no longer chosen. Who sleeps wakes; muscles that were to come begin. */
MOBIL_API int mobil_lod_release(mobil_sim* sim, const mobil_id* ids, size_t count);
/* Writes what was chosen. */
MOBIL_API int mobil_lod_report(mobil_sim* sim, mobil_lod_counts* out);
/* Why a muscle has its method, in one line; its predicted error and cost (both may be null). */
MOBIL_API int mobil_lod_why(mobil_sim* sim, mobil_id id, int muscle, char* line, size_t room, float* error_m,
                            double* cost_us);

/* One method with its numbers, of those among which is chosen, and what was measured of it. */
typedef struct mobil_level {
  const char* name;
  int method; /* these three as in mobil_method */
  MOBIL_RENAMED(int, modes, vectors);
  int moving;
  float error_m;               /* of control points, the 99.9th percentile over a walk, in that body */
  float cost_us; /* of both legs' muscles and their control points, a tick of 1/60 s, on an Intel Xeon of 3 GHz */
} mobil_level;
/* Levels from 0 on; MOBIL_MISSING behind the last. `pulling` 1: of muscles with an activation. */
MOBIL_API int mobil_lod_level(int level, int muscle, float speed_m_s, float height_m, int inertia, int pulling,
                              mobil_level* out);

#endif
