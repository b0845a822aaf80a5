/* mobil for any language: crowds of people who walk, and whose leg muscles deform as they do. C89.
 *
 *   mobil_options options;
 *   mobil_person person;
 *   mobil_sim* sim;
 *   mobil_id id;
 *   char line[256];
 *   mobil_defaults(MOBIL_OPTIONS, &options, sizeof options);
 *   if (mobil_create(&options, &sim, line, sizeof line) != MOBIL_OK) { puts(line); return 1; }
 *   mobil_defaults(MOBIL_PERSON, &person, sizeof person);
 *   mobil_spawn(sim, &person, 0, 1, NULL, &id);
 *   mobil_advance(sim, frame_s, NULL);
 *   mobil_poses(sim, &id, 1, NULL, matrices, 0);
 *
 * Calls. Every function that can fail returns MOBIL_OK (0) or a code below 0, and leaves one line that says what was
 * wrong, the valid range and how to mend it: mobil_message. What failed has changed nothing. Nothing is global, nothing
 * is thrown, nobody is called back but `jobs`, `memory` and the ground (mobil_terrain_set_heights). One thread at a
 * time may use a simulation; any number of simulations may live side by side.
 *
 * Memory. Arrays are the caller's. Rows lie `stride` bytes apart; 0: close together. No pointer is kept after the call
 * but those of mobil_options and mobil_terrain_set_heights. Strings are UTF-8; those that come out live as long as the
 * simulation or the library.
 *
 * Structs begin with their size, as the caller knows it: mobil_defaults writes it. A program that was built against an
 * older header goes on working, and one built against a newer header is refused only where it asks for something new.
 *
 * Units. SI, radians. Places, directions, rotations and surfaces are in the axes and the unit of length of
 * mobil_options; all other numbers are SI. A heading is 0 along the axis ahead and grows to the left of who walks, in
 * all axes. */
#ifndef MOBIL_H
#define MOBIL_H

#include <stddef.h>
#if defined(MOBIL_STATIC_LIBRARY)
#define MOBIL_API
#elif defined(_WIN32) && defined(MOBIL_BUILD)
#define MOBIL_API __declspec(dllexport)
#elif defined(_WIN32)
#define MOBIL_API __declspec(dllimport)
#else
#define MOBIL_API __attribute__((visibility("default")))
#endif
/* Old names, which go in 0.5, still compile, with a warning that gives the new one. */
#if defined(__GNUC__)
#define MOBIL_DEPRECATED(use) __attribute__((deprecated("use " use)))
#define MOBIL_RENAMED(type, name, old) \
  __extension__ union {                \
    type name;                         \
    type old MOBIL_DEPRECATED(#name);  \
  }
#else
#define MOBIL_DEPRECATED(use)
#define MOBIL_RENAMED(type, name, old) \
  union {                              \
    type name;                         \
    type old;                          \
  }
#endif
#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header. mobil_interface() is the library's: equal or greater serves. */
#define MOBIL_INTERFACE 4
MOBIL_API int mobil_interface(void);               /* the library's MOBIL_INTERFACE */
MOBIL_API const char* mobil_library_version(void); /* "0.3.0" */

typedef struct mobil_sim mobil_sim;           /* one world */
typedef struct mobil_surfaces mobil_surfaces; /* bones and muscles of one body as triangles */
typedef struct mobil_id {
  unsigned int index, generation; /* a person; zeros: nobody */
} mobil_id;

enum {
  MOBIL_OK = 0,
  MOBIL_STALE = -1,   /* a person who is gone, or never was */
  MOBIL_MISSING = -2, /* the person has no such thing */
  MOBIL_ALREADY = -3, /* the person has it already */
  MOBIL_REFUSED = -4, /* a value out of range, a null pointer, damaged bytes: the line says which */
  MOBIL_ROOM = -5,    /* the caller's memory is too small */
  MOBIL_MEMORY = -6,  /* there is no memory */
  MOBIL_STRUCT = -7,  /* a struct's size is not one that this library knows */
  MOBIL_INTERNAL = -8 /* a fault of the library's own */
};

/* What the host calls ahead, up and left. */
enum {
  MOBIL_AXES_Y_UP,   /* x left, y up, z ahead, right-handed: glTF, three.js; the library's own */
  MOBIL_AXES_UNITY,  /* x right, y up, z ahead, left-handed */
  MOBIL_AXES_UNREAL, /* x ahead, y right, z up, left-handed; with units_per_m 100 */
  MOBIL_AXES_GODOT,  /* x right, y up, z back, right-handed */
  MOBIL_AXES_Z_UP    /* x ahead, y left, z up, right-handed: ROS, many CAD programs */
};
enum { MOBIL_RIGHT, MOBIL_LEFT, MOBIL_BOTH };

/* Does the work of a tick: calls `work(context, begin, end)` for disjoint ranges that together are 0 to `count`, on any
 * threads, and returns when all have returned. Results do not depend on how it cuts. */
typedef void (*mobil_work)(void* context, size_t begin, size_t end);
/* The host's threads: `parallel_for` cuts the range 0 to `count` and calls `work` for each part, as mobil_work says.
 * `user` is handed back to it. */
typedef struct mobil_jobs {
  void* user;
  void (*parallel_for)(void* user, size_t count, mobil_work work, void* context);
  size_t threads; /* about how many work at once */
} mobil_jobs;

/* Memory for all that grows with people; the rest comes from the heap. Any thread may call it, one at a time. */
typedef struct mobil_memory {
  void* user;
  void* (*allocate)(void* user, size_t bytes, size_t alignment); /* null: there is none */
  void (*release)(void* user, void* memory, size_t bytes, size_t alignment);
} mobil_memory;

/* How a simulation runs; mobil_defaults gives the usual values. */
typedef struct mobil_options {
  size_t size;
  double tick_s;       /* 1e-5 to 1; usual 1/60 */
  double max_frame_s;  /* of a longer frame the rest is dropped; tick_s to 60, usual 0.25 */
  int threads;         /* of the built-in pool; 0: as many as the machine has; usual 1 */
  int axes;            /* MOBIL_AXES_… */
  float units_per_m;   /* of places and surfaces; 0.001 to 1e6, usual 1 */
  mobil_jobs jobs;     /* parallel_for null: the built-in pool */
  mobil_memory memory; /* allocate null: the heap */
} mobil_options;

/* Which struct mobil_defaults fills. */
enum {
  MOBIL_OPTIONS,
  MOBIL_PERSON,
  MOBIL_WALK,
  MOBIL_MUSCLES,
  MOBIL_METHOD,
  MOBIL_POSE_LAYOUT,
  MOBIL_SCENE,
  MOBIL_NEEDS,
  MOBIL_LOD_OPTIONS,
  MOBIL_LOD_COUNTS,
  MOBIL_SURFACE_CHOICE,
  MOBIL_SURFACE_TARGET,
  MOBIL_LIMITS,
  MOBIL_SKIN_TARGET,
  MOBIL_AVOIDANCE_OPTIONS,
  MOBIL_AVOIDANCE_COUNTS,
  MOBIL_LEG_MESH,
  MOBIL_TERRAIN_COUNTS
};
/* Fills a struct of that kind, as large as the caller knows it. */
MOBIL_API int mobil_defaults(int which, void* filled, size_t size);

/* `line` (`room` bytes, may be null) says why nothing was made. */
MOBIL_API int mobil_create(const mobil_options* options, mobil_sim** out, char* line, size_t room);
MOBIL_API void mobil_destroy(mobil_sim* sim); /* null is allowed */
/* The line of the last call that failed; "" before the first. Good until the next call. */
MOBIL_API const char* mobil_message(const mobil_sim* sim);

/* ---- People ---------------------------------------------------------------------------------------------------- */

enum { MOBIL_THIN, MOBIL_AVERAGE, MOBIL_ATHLETIC, MOBIL_HEAVY }; /* constitution */
enum { MOBIL_MAN, MOBIL_WOMAN };                                 /* sex */

/* Which numbers of a walk are said; of speed, step length and step frequency two give the third, and one alone is
 * completed as people of that leg would. */
enum { MOBIL_SPEED = 1, MOBIL_STEP_LENGTH = 2, MOBIL_STEP_FREQUENCY = 4, MOBIL_STYLE = 8, MOBIL_HEADING = 16 };

/* A person as asked for. m, kg, rad; places in the axes and the unit of mobil_options. */
typedef struct mobil_person {
  size_t size;
  float height_m, mass_kg; /* 1.2 to 2.2; 30 to 200, of what lives at that height */
  float endo, meso, ecto;  /* somatotype, 0.1 to 12; 3 4 3: as height and mass make it */
  int constitution;
  int given;                                         /* MOBIL_SPEED and so on; without: 5 km/h */
  float speed_m_s, step_length_m, step_frequency_hz; /* a speed of 0 stands */
  const float* style;                                /* `style_count` values, in the order of mobil_style */
  size_t style_count;                                /* fewer than mobil_style has: the others are usual */
  float place[3], heading_rad;                       /* on the ground: the height does not count */
  int posed, unused; /* posed 1: the host animates the skeleton by mobil_set_poses; begins at the origin */
  int sex;           /* whose girths the skin has; since interface 2 */
} mobil_person;

/* How a walk is to become: what is not `given` stays. */
typedef struct mobil_walk {
  size_t size;
  int given;
  float speed_m_s, step_length_m, step_frequency_hz;
  const float* style;
  size_t style_count;
  float heading_rad; /* to turn to, the shorter way round */
} mobil_walk;

/* One number of a walk's style. */
typedef struct mobil_style_number {
  const char *name, *unit, *meaning; /* unit "1": none */
  float low, high, usual;
} mobil_style_number;
/* The numbers of a style, from 0 on; MOBIL_MISSING behind the last. */
MOBIL_API int mobil_style(int number, mobil_style_number* out);

struct mobil_muscles;
/* Makes people, all or none. `muscles` may be null: then they have none. Posed people begin in the anatomical position.
 */
MOBIL_API int mobil_spawn(mobil_sim* sim, const mobil_person* people, size_t stride, size_t count,
                          const struct mobil_muscles* muscles, mobil_id* out);
/* They go, with their muscles; all or none. Their ids are stale from then on. */
MOBIL_API int mobil_despawn(mobil_sim* sim, const mobil_id* ids, size_t count);
/* Everybody, in no particular order. `out` null, or too few: *count alone, and then MOBIL_ROOM. */
MOBIL_API int mobil_people(mobil_sim* sim, mobil_id* out, size_t room, size_t* count);
/* What was asked of a person; style is null. Place and heading are those of the walking line now. */
MOBIL_API int mobil_get_person(mobil_sim* sim, mobil_id id, mobil_person* out);
/* A walker's style, in the order of mobil_style: as it was asked for, or nearer to the usual one, where a foot would go
 * under the ground, or a joint or the pelvis further than people's go. */
MOBIL_API int mobil_get_style(mobil_sim* sim, mobil_id id, float* out, size_t room);
/* How much of a person there is (mobil_get_state); and bits of what a person has (mobil_has): what sleepers have they
 * have again on waking. */
enum {
  MOBIL_FULL = 0,
  MOBIL_POSED = 1,   /* the host animates the skeleton; stays so */
  MOBIL_ASLEEP = 2,  /* whom nobody sees: some 100 bytes, no muscles, hardly any cost */
  MOBIL_COMPACT = 4, /* whom nobody looks at: walks, and muscles move, at a part of the cost */
  MOBIL_HAS_MUSCLES = 8,
  MOBIL_HAS_FORCES = 16,
  MOBIL_MANAGED = 32,    /* mobil_lod_manage */
  MOBIL_WATCHED = 64,    /* step events */
  MOBIL_AVOIDS = 128,    /* mobil_avoidance_manage */
  MOBIL_ON_GROUND = 256, /* mobil_terrain_manage */
  MOBIL_HAS_FAT = 512
};
MOBIL_API int mobil_get_state(mobil_sim* sim, mobil_id id, int* state);
MOBIL_API int mobil_has(mobil_sim* sim, mobil_id id, int* bits);

/* Asks people to walk otherwise, from the next step on. Nobody is changed where one of them cannot walk so. */
MOBIL_API int mobil_change_walks(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_walk* walks,
                                 size_t stride);
/* The same, one walk for all of them. */
MOBIL_API int mobil_change_walk(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_walk* walk);
/* Who stands steps aside, m to the left and ahead (negative: to the right and back; up to 0.25 and 0.20). */
MOBIL_API int mobil_step_aside(mobil_sim* sim, mobil_id id, float left_m, float ahead_m);
/* Puts a walker elsewhere at once; no inertia is felt. Of many: mobil_place_many. */
MOBIL_API int mobil_place(mobil_sim* sim, mobil_id id, const float place[3], float heading_rad);
/* The origin moves there: every place becomes so much less. The height does not count. */
MOBIL_API int mobil_shift_origin(mobil_sim* sim, const float to[3]);
/* Poses of posed people, who take them at the end of the next tick: 48 times place x y z and quaternion x y z w, in the
 * world. `jumped` 1: muscles and fat feel no inertia of the way there. */
MOBIL_API int mobil_set_poses(mobil_sim* sim, const mobil_id* ids, size_t count, const float* poses, size_t stride,
                              int jumped);
/* People become MOBIL_FULL, MOBIL_ASLEEP or MOBIL_COMPACT, who may. Control points of muscles that begin on waking are
 * within `within_m` of where they would be; usual 0.005. `changed` (may be null): how many of these are in it now. */
MOBIL_API int mobil_set_state(mobil_sim* sim, const mobil_id* ids, size_t count, int state, float within_m,
                              size_t* changed);
/* What people have on demand. */
enum {
  MOBIL_STEP_EVENTS, /* mobil_events; not of posed people. Is part of mobil_hash: peers watch the same people */
  MOBIL_FAT,         /* that wobbles under the skin (mobil_write_skin) */
  MOBIL_FORCES       /* ground reaction and joint moments */
};
/* From the next tick on they have it, or no more (`on` 0); who has it so already is left alone. All or none. */
MOBIL_API int mobil_enable(mobil_sim* sim, const mobil_id* ids, size_t count, int feature, int on);

/* ---- Muscles --------------------------------------------------------------------------------------------------- */

enum {
  MOBIL_STATIC,
  MOBIL_EXPLICIT_CENTRAL,
  MOBIL_IMPLICIT_CENTRAL,
  MOBIL_NEWMARK,
  MOBIL_MODAL,
  MOBIL_NONE,
  MOBIL_FINITE
};                                                            /* method; the last wants cells of 4, 4, 16 */
enum { MOBIL_FULL_INTEGRATION, MOBIL_BBAR, MOBIL_ONE_POINT }; /* element */
enum { MOBIL_LUMPED, MOBIL_CONSISTENT };                      /* mass */
enum { MOBIL_BY_DISPLACEMENT, MOBIL_BY_FORCE };               /* drive */
enum { MOBIL_NO_ACTIVATION, MOBIL_BY_PHASE, MOBIL_BY_HOST, MOBIL_BY_MOMENTS }; /* activation */
enum {
  MOBIL_HAMSTRINGS,
  MOBIL_QUADRICEPS,
  MOBIL_TRICEPS_SURAE,
  MOBIL_TIBIALIS_ANTERIOR
}; /* further: mobil_find_muscle */

/* How one muscle is simulated. */
typedef struct mobil_method {
  size_t size;
  int method;
  MOBIL_RENAMED(int, modes, vectors); /* of MOBIL_MODAL, as all that follows: 1 to 32 */
  int moving, corrected, control_points, reported, tuned, linear_shape; /* 0 or 1 */
  unsigned int modal_cells[3];
} mobil_method;

/* How leg muscles deform. */
typedef struct mobil_muscles {
  size_t size;
  unsigned int muscles; /* a bit each, 1 << MOBIL_HAMSTRINGS and so on; usual: the four groups */
  int method;           /* and what of mobil_method stands here again */
  MOBIL_RENAMED(int, modes, vectors);
  int moving, corrected, control_points, reported, tuned, linear_shape;
  unsigned int modal_cells[3];
  int element, mass, drive, activation;
  int inertia, line_motion; /* 0 or 1 */
  int finite_shape;         /* 0 or 1; below 0: where there is activation */
  unsigned int cells[3];
  double density_kg_m3, young_pa, poisson; /* 1 to 1e6, 1 to 1e12, -0.99 to 0.4999 */
  double damping_per_s, stiffness_damping_s;
  double foundation_hz; /* below 0: as the muscle needs it */
  double dt_s;          /* below 0: 0.9 of each individual's critical step */
} mobil_muscles;

MOBIL_API int mobil_find_muscle(const char* name);   /* below 0: MOBIL_MISSING */
MOBIL_API const char* mobil_muscle_name(int muscle); /* null behind the last */

/* Makes what these muscles share in bodies of usual build, so that nobody waits for it later. */
MOBIL_API int mobil_prepare(mobil_sim* sim, const mobil_muscles* muscles);
/* All meshes and bases that were made so far, as bytes. `out` null: *bytes alone. */
MOBIL_API int mobil_bake(mobil_sim* sim, void* out, size_t room, size_t* bytes);
/* Takes in what mobil_bake wrote, in milliseconds. */
MOBIL_API int mobil_load_baked(mobil_sim* sim, const void* baked, size_t bytes);
/* Muscles come where there are none, and become these where there are; null: they go. Where memory runs out, those
 * before the one for whom there was none have them. */
MOBIL_API int mobil_set_muscles(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_muscles* muscles);
/* Another method of one muscle, both sides, without a jump; memory as above. */
MOBIL_API int mobil_set_method(mobil_sim* sim, const mobil_id* ids, size_t count, int muscle,
                               const mobil_method* method);
/* The method that a muscle has now. */
MOBIL_API int mobil_get_method(mobil_sim* sim, mobil_id id, int muscle, mobil_method* out);
/* How hard a muscle of MOBIL_BY_HOST is to pull, one number a person; what is beyond 0.01 to 1 is taken as the end. */
MOBIL_API int mobil_set_excitation(mobil_sim* sim, const mobil_id* ids, size_t count, int muscle, int side,
                                   const float* excitation, size_t stride);

#include <mobil/c/lod.h>

/* ---- Time ------------------------------------------------------------------------------------------------------ */

/* What a frame amounted to. */
typedef struct mobil_ticks {
  unsigned int count; /* ticks that ran */
  double alpha;       /* how far into the next one the frame is, 0 to 1 */
  double dropped_s;   /* of a frame that was too long */
} mobil_ticks;
/* As many ticks as the time fed so far makes; `out` may be null. */
MOBIL_API int mobil_advance(mobil_sim* sim, double seconds, mobil_ticks* out);
/* So many ticks, whatever the time. */
MOBIL_API int mobil_tick(mobil_sim* sim, unsigned int ticks);
MOBIL_API double mobil_time_s(const mobil_sim* sim); /* simulated so far */
MOBIL_API double mobil_tick_s(const mobil_sim* sim); /* of one tick */

/* ---- Reading --------------------------------------------------------------------------------------------------- */

enum { MOBIL_SEGMENTS = 48 }; /* of a skeleton */
/* Names, parents and numbers of segments, 0 to MOBIL_SEGMENTS - 1. */
MOBIL_API const char* mobil_segment_name(int segment); /* null behind the last */
MOBIL_API int mobil_segment_parent(int segment);       /* the pelvis is its own */
MOBIL_API int mobil_find_segment(const char* name);    /* below 0: MOBIL_MISSING */

/* How a segment's pose is written. */
enum {
  MOBIL_PLACE_AND_QUATERNION, /* x y z, x y z w: 7 floats a segment */
  MOBIL_MATRIX,               /* three rows of four: 12 */
  MOBIL_DUAL_QUATERNION       /* real part x y z w first: 8 */
};
/* Which segments of a pose are written, at what instant, and how. */
typedef struct mobil_pose_layout {
  size_t size;
  int form;
  int to_parent;       /* 1: relative to the segment's parent, the pelvis to the world */
  double ahead_s;      /* so long after the last tick, 0 to 0.2: alpha times tick_s for a frame */
  const int* segments; /* null: all 48; else one at least */
  size_t segment_count;
  size_t segment_stride; /* bytes; 0: close together */
} mobil_pose_layout;
/* Poses at any instant, exactly: no lag, no interpolation. `layout` null: places and quaternions after the last tick.
 */
MOBIL_API int mobil_poses(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_pose_layout* layout, void* out,
                          size_t stride);

/* Rows as floats, one a person. Index 0 is right, 1 left. */
enum {
  MOBIL_JOINTS,  /* 13: pelvis rotation, list, tilt; hip flexion [2], knee flexion [2], ankle dorsiflexion [2], shoulder
                    flexion [2], elbow flexion [2]; rad */
  MOBIL_FEET,    /* 20: heel [2][3], toe joint [2][3], toe tip [2][3], phase of the gait cycle [2] */
  MOBIL_CENTRE,  /* 3: centre of mass */
  MOBIL_STEP,    /* 3, of walkers: steps taken; the side that bears; s since it struck */
  MOBIL_GROUND,  /* 12, with forces: force [2][3] in N, centre of pressure [2][3] */
  MOBIL_MOMENTS, /* 6, with forces: hip, knee, ankle, each [2]; N m, extensor and plantarflexor positive */
  MOBIL_ROWS
};
MOBIL_API int mobil_row_floats(int what); /* floats in a row of that kind */
/* The rows of these people, `stride` bytes apart. */
MOBIL_API int mobil_read(mobil_sim* sim, int what, const mobil_id* ids, size_t count, float* out, size_t stride);

/* The same of one muscle and side. */
enum {
  MOBIL_LINE,        /* 4: length m, rest length m, stiffness N/m, force N */
  MOBIL_LINE_MOTION, /* 4: lengthening m/s; moment arms about hip, knee, ankle, m */
  MOBIL_REPORT,      /* 5: elongation m, reaction N, volume ratio, kinetic and strain energy J */
  MOBIL_ACTIVATION,  /* 2: excitation, activation */
  MOBIL_TENDON,      /* 5: fibre m, tendon m, pennation rad, force N, belly m */
  MOBIL_NODES,       /* 3 a node: displacement of control points in the muscle's frame, m */
  MOBIL_MUSCLE_ROWS
};
/* Of a person's muscle: nodes differ. Below 0 where there is none. */
MOBIL_API int mobil_muscle_row_floats(mobil_sim* sim, int what, mobil_id id, int muscle, int side);
/* The rows of one muscle of these people. */
MOBIL_API int mobil_read_muscles(mobil_sim* sim, int what, const mobil_id* ids, size_t count, int muscle, int side,
                                 float* out, size_t stride);

/* What each system cost in the last tick. */
typedef struct mobil_system {
  const char *name, *module;
  double seconds;  /* of all threads together */
  double entities; /* worked on */
} mobil_system;
MOBIL_API int mobil_cost(mobil_sim* sim, int system, mobil_system* out); /* MOBIL_MISSING behind the last */
/* What each phase of the last tick cost: work on the thread that ticks, before the systems or after them, as level of
 * detail, avoidance and terrain do it. */
typedef struct mobil_phase {
  const char *name, *module;
  int after; /* 1: the systems */
  double seconds;
} mobil_phase;
MOBIL_API int mobil_phase_cost(mobil_sim* sim, int phase, mobil_phase* out); /* MOBIL_MISSING behind the last */

#include <mobil/c/surfaces.h>

/* ---- State ----------------------------------------------------------------------------------------------------- */

/* A snapshot: how many bytes it takes now, and the bytes (MOBIL_ROOM where `room` is less). */
MOBIL_API size_t mobil_snapshot_bytes(mobil_sim* sim);
MOBIL_API int mobil_save(mobil_sim* sim, void* out, size_t room, size_t* bytes); /* `bytes` may be null */
/* What was saved, to the last bit, handles included. Bytes are never trusted. What is managed is state; scene, walls,
 * discs, options and the ground are not. Limits are those of mobil_defaults. */
MOBIL_API int mobil_restore(mobil_sim* sim, const void* bytes, size_t count);
/* How much a snapshot may ask for. Its seal tells accidents, not attackers: of bytes from a network the host must know
 * whose they are. */
typedef struct mobil_limits {
  size_t size;
  size_t rows;       /* people and muscles together; usual 1000000 */
  size_t mesh_nodes; /* of any one mesh that must be made; usual 500; 0: none is made that is not there */
  double seconds;    /* after which no further mesh is made; usual 10 */
  int numbers;       /* usual 1: a number that is not finite is refused */
  size_t resources;  /* meshes, solvers, bases and choices that rows share; usual 2000 */
  size_t steps;      /* that any one muscle may take in a tick; usual 2000; 0: no muscles */
} mobil_limits;
/* The same within these limits. */
MOBIL_API int mobil_restore_within(mobil_sim* sim, const void* bytes, size_t count, const mobil_limits* limits);
/* 64 bits, the lower half first: equal states, equal hashes, whatever threads, machine and order of rows. */
MOBIL_API int mobil_hash(mobil_sim* sim, unsigned int out[2]);
#include <mobil/c/play.h>
#include <mobil/c/skin.h>
#include <mobil/c/surroundings.h>

#include <mobil/c/deprecated.h>

#ifdef __cplusplus
}
#endif
#endif
