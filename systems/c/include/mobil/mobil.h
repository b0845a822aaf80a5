/* C89 interface of mobil: crowds of walking people with deforming leg muscles.
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
 * Calls. A function that can fail returns MOBIL_OK (0) or a negative code. mobil_message then returns one line with the
 * mistake, the valid range and the remedy. A failed call changes nothing, except that interrupted ticks stay
 * (mobil_set_interrupt). Nothing is global or thrown. The only callbacks are `jobs`, `memory`, the ground
 * (mobil_terrain_set_heights) and mobil_set_interrupt. One call at a time can use a simulation; a second one, by
 * another thread or by a callback, returns MOBIL_BUSY. A program can have any number of simulations.
 *
 * Memory. The caller owns all arrays. Rows are `stride` bytes apart; 0 means tightly packed. No pointer is kept after a
 * call, except those of mobil_options, mobil_terrain_set_heights and mobil_set_interrupt. Strings are UTF-8. Returned
 * strings are valid as long as the simulation or the library.
 *
 * Structs begin with their size in the caller's header, which mobil_defaults writes. Programs built with an older
 * header keep working. One built with a newer header is refused only if it uses a new field.
 *
 * Units are SI and radians. Positions, directions, rotations and surfaces are in the axes and the unit of length of
 * mobil_options; all other numbers are SI. In all axes a heading is 0 along the axis ahead and grows to the walker's
 * left. */
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
/* Deprecated names compile until 0.5, with a warning that contains the new name. */
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

/* Version of this header. The library's version, mobil_interface(), must be equal or greater. */
#define MOBIL_INTERFACE 7
MOBIL_API int mobil_interface(void);               /* the library's MOBIL_INTERFACE */
MOBIL_API const char* mobil_library_version(void); /* "0.3.0" */

typedef struct mobil_sim mobil_sim;           /* one world */
typedef struct mobil_surfaces mobil_surfaces; /* bones and muscles of one body as triangles */
typedef struct mobil_id {
  unsigned int index, generation; /* handle of a person; zeros: no person */
} mobil_id;

enum {
  MOBIL_OK = 0,
  MOBIL_STALE = -1,       /* a stale or invalid handle */
  MOBIL_MISSING = -2,     /* the person does not have it */
  MOBIL_ALREADY = -3,     /* the person has it already */
  MOBIL_REFUSED = -4,     /* a value out of range, a null pointer or damaged bytes; the message has details */
  MOBIL_ROOM = -5,        /* the caller's memory is too small */
  MOBIL_MEMORY = -6,      /* out of memory */
  MOBIL_STRUCT = -7,      /* a struct's size is not valid for this library */
  MOBIL_INTERNAL = -8,    /* an internal error of the library */
  MOBIL_INTERRUPTED = -9, /* ended by the function of mobil_set_interrupt */
  MOBIL_BUSY = -10        /* a call of another thread or around this callback runs; mobil_message is that call's */
};

/* Axes of the host. */
enum {
  MOBIL_AXES_Y_UP,   /* x left, y up, z ahead, right-handed: glTF, three.js; the library's own */
  MOBIL_AXES_UNITY,  /* x right, y up, z ahead, left-handed */
  MOBIL_AXES_UNREAL, /* x ahead, y right, z up, left-handed; with units_per_m 100 */
  MOBIL_AXES_GODOT,  /* x right, y up, z back, right-handed */
  MOBIL_AXES_Z_UP    /* x ahead, y left, z up, right-handed: ROS, many CAD programs */
};
enum { MOBIL_RIGHT, MOBIL_LEFT, MOBIL_BOTH };

/* A part of a tick's work, for the range begin to end. */
typedef void (*mobil_work)(void* context, size_t begin, size_t end);
/* The host's threads. `parallel_for` receives `user`, divides 0 to `count` into disjoint ranges, calls `work` for each
 * on any thread, and returns when all calls have returned. Results do not depend on the division. */
typedef struct mobil_jobs {
  void* user;
  void (*parallel_for)(void* user, size_t count, mobil_work work, void* context);
  size_t threads; /* approximate number of threads */
} mobil_jobs;

/* Allocator for all memory that scales with the number of people; the rest uses the heap. The library calls it from any
 * thread, one at a time. */
typedef struct mobil_memory {
  void* user;
  void* (*allocate)(void* user, size_t bytes, size_t alignment); /* returns null if out of memory */
  void (*release)(void* user, void* memory, size_t bytes, size_t alignment);
} mobil_memory;

/* Options of a simulation; mobil_defaults writes the defaults. */
typedef struct mobil_options {
  size_t size;
  double tick_s;       /* 1e-5 to 1; default 1/60. Above 0.25 fast walkers lose distance: one step a tick at most */
  double max_frame_s;  /* tick_s to 60, default 0.25; the time of a frame beyond it is dropped */
  int threads;         /* of the built-in pool, default 1; 0: one for each hardware thread */
  int axes;            /* MOBIL_AXES_… */
  float units_per_m;   /* of positions and surfaces; 0.001 to 1e6, default 1 */
  mobil_jobs jobs;     /* parallel_for null: the built-in pool */
  mobil_memory memory; /* allocate null: the heap */
} mobil_options;

/* Kind of struct for mobil_defaults. */
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
  MOBIL_TERRAIN_COUNTS,
  MOBIL_SEGMENT,
  MOBIL_SKIN_BINDING
};
/* Fills a struct of kind `which` with defaults. `size` is its size in the caller's header. */
MOBIL_API int mobil_defaults(int which, void* filled, size_t size);

/* Creates a simulation. If that fails, `line` (`room` bytes, can be null) receives the message. */
MOBIL_API int mobil_create(const mobil_options* options, mobil_sim** out, char* line, size_t room);
MOBIL_API void mobil_destroy(mobil_sim* sim); /* null is allowed */
/* Returns the message of the last failed call; "" before the first. Valid until the next call. */
MOBIL_API const char* mobil_message(const mobil_sim* sim);

/* ---- People ---------------------------------------------------------------------------------------------------- */

enum { MOBIL_THIN, MOBIL_AVERAGE, MOBIL_ATHLETIC, MOBIL_HEAVY }; /* constitution */
enum { MOBIL_MAN, MOBIL_WOMAN };                                 /* sex */

/* Bits of `given`: the numbers of a walk that are set. Two of speed, step length and step frequency determine the
 * third. One alone is completed by the usual walk for that leg length and age, in shoes. */
enum { MOBIL_SPEED = 1, MOBIL_STEP_LENGTH = 2, MOBIL_STEP_FREQUENCY = 4, MOBIL_STYLE = 8, MOBIL_HEADING = 16 };

/* A request for a person, in m, kg and rad; positions in the axes and the unit of mobil_options. */
typedef struct mobil_person {
  size_t size;
  float height_m, mass_kg; /* 1.2 to 2.2; 30 to 200, in the range of real bodies of that height; children: less */
  float endo, meso, ecto;  /* somatotype, 0.1 to 12; 3 4 3: derived from height and mass */
  int constitution;
  int given;                                         /* bits MOBIL_SPEED and so on; 0: 5 km/h */
  float speed_m_s, step_length_m, step_frequency_hz; /* speed 0: standing */
  const float* style;                                /* `style_count` values, in the order of mobil_style */
  size_t style_count;                                /* further values of mobil_style have their defaults */
  float place[3], heading_rad;                       /* on the ground; the height is ignored */
  int posed, unused; /* posed 1: the host animates the skeleton by mobil_set_poses; starts at the origin */
  int sex, unused_2; /* changes skin, fat and muscle; since interface 2 */
  float age_y;       /* 6 to 95 years, kept to half years; 0: 25; since interface 7 */
} mobil_person;

/* A change of walk. Values that are not `given` stay. */
typedef struct mobil_walk {
  size_t size;
  int given;
  float speed_m_s, step_length_m, step_frequency_hz;
  const float* style;
  size_t style_count;
  float heading_rad; /* reached by the shorter way */
} mobil_walk;

/* A parameter of a walk's style. */
typedef struct mobil_style_number {
  const char *name, *unit, *meaning; /* unit "1": dimensionless */
  float low, high, usual;
} mobil_style_number;
/* Writes the style parameter with index `number`, from 0; MOBIL_MISSING after the last. */
MOBIL_API int mobil_style(int number, mobil_style_number* out);
/* Sets sex, age, height, mass and usual speed of a person to typical ones. Deviations are standard scores of stature
 * and of body mass index for that sex and age; 0 is the median. `style` receives `room` numbers of the usual style, in
 * the order of mobil_style, and becomes the person's; it can be null. Returns MOBIL_REFUSED for bodies that mobil_spawn
 * refuses; the person is then unchanged. Since interface 7. */
MOBIL_API int mobil_typical_person(int sex, float age_y, float height_z, float mass_index_z, float* style, size_t room,
                                   mobil_person* person);

struct mobil_muscles;
/* Spawns people, all or none. A null `muscles` means no muscles. Posed people start in the anatomical position. */
MOBIL_API int mobil_spawn(mobil_sim* sim, const mobil_person* people, size_t stride, size_t count,
                          const struct mobil_muscles* muscles, mobil_id* out);
/* Removes people and their muscles, all or none. Their ids become stale. */
MOBIL_API int mobil_despawn(mobil_sim* sim, const mobil_id* ids, size_t count);
/* Writes all people, in no particular order. A null `out` writes *count only, a small one also returns MOBIL_ROOM. */
MOBIL_API int mobil_people(mobil_sim* sim, mobil_id* out, size_t room, size_t* count);
/* Writes a person's request, with a null style. Position and heading are the present ones of the walking line. */
MOBIL_API int mobil_get_person(mobil_sim* sim, mobil_id id, mobil_person* out);
/* Writes a walker's style in the order of mobil_style. It is the requested one, or one corrected toward the default if
 * a foot would go under the ground, or a joint or the pelvis would exceed its limit. */
MOBIL_API int mobil_get_style(mobil_sim* sim, mobil_id id, float* out, size_t room);
/* States of a person (mobil_get_state), and bits of a person's features (mobil_has). Sleepers regain their features on
 * waking. */
enum {
  MOBIL_FULL = 0,
  MOBIL_POSED = 1,   /* the host animates the skeleton; permanent */
  MOBIL_ASLEEP = 2,  /* unseen: about 100 bytes, no muscles, almost no cost */
  MOBIL_COMPACT = 4, /* unseen: walk and muscles continue at a fraction of the cost */
  MOBIL_HAS_MUSCLES = 8,
  MOBIL_HAS_FORCES = 16,
  MOBIL_MANAGED = 32,    /* mobil_lod_manage */
  MOBIL_WATCHED = 64,    /* MOBIL_STEP_EVENTS */
  MOBIL_AVOIDS = 128,    /* mobil_avoidance_manage */
  MOBIL_ON_GROUND = 256, /* mobil_terrain_manage */
  MOBIL_HAS_FAT = 512
};
MOBIL_API int mobil_get_state(mobil_sim* sim, mobil_id id, int* state);
MOBIL_API int mobil_has(mobil_sim* sim, mobil_id id, int* bits);

/* Changes people's walks from the next step on, all or none: one walk for each person. */
MOBIL_API int mobil_change_walks(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_walk* walks,
                                 size_t stride);
/* Changes the walks of people to the same one, all or none. */
MOBIL_API int mobil_change_walk(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_walk* walk);
/* Makes a standing walker step left and ahead, m; negative: right and back. Up to 0.25 and 0.20 for a leg of 0.85 m. */
MOBIL_API int mobil_step_aside(mobil_sim* sim, mobil_id id, float left_m, float ahead_m);
/* Moves a walker at once, without inertia. mobil_place_many moves many. */
MOBIL_API int mobil_place(mobil_sim* sim, mobil_id id, const float place[3], float heading_rad);
/* Moves the world's origin: subtracts `to` from all positions. The height is ignored. */
MOBIL_API int mobil_shift_origin(mobil_sim* sim, const float to[3]);
/* Sets the poses of posed people for the end of the next tick: 48 times position x y z and quaternion x y z w, in the
 * world. With `jumped` 1 muscles and fat feel no inertia from the last pose to this one. */
MOBIL_API int mobil_set_poses(mobil_sim* sim, const mobil_id* ids, size_t count, const float* poses, size_t stride,
                              int jumped);
/* Changes people to MOBIL_FULL, MOBIL_ASLEEP or MOBIL_COMPACT where possible; `changed` (can be null) are those in it
 * now. Control points of muscles that begin on waking are within `within_m` (usually 0.005) of an awake person's. */
MOBIL_API int mobil_set_state(mobil_sim* sim, const mobil_id* ids, size_t count, int state, float within_m,
                              size_t* changed);
/* Optional features of people. */
enum {
  MOBIL_STEP_EVENTS, /* mobil_events; not for posed people. In mobil_hash: peers must enable it for the same people */
  MOBIL_FAT,         /* wobbling of subcutaneous fat (mobil_write_skin) */
  MOBIL_FORCES       /* ground reaction and joint moments */
};
/* Switches a feature on or off (`on` 0) from the next tick on, all or none. People with that setting are unchanged. */
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
};                                                            /* method; the last needs cells of 4, 4, 16 */
enum { MOBIL_FULL_INTEGRATION, MOBIL_BBAR, MOBIL_ONE_POINT }; /* element */
enum { MOBIL_LUMPED, MOBIL_CONSISTENT };                      /* mass */
enum { MOBIL_BY_DISPLACEMENT, MOBIL_BY_FORCE };               /* drive */
enum { MOBIL_NO_ACTIVATION, MOBIL_BY_PHASE, MOBIL_BY_HOST, MOBIL_BY_MOMENTS }; /* activation */
enum {
  MOBIL_HAMSTRINGS,
  MOBIL_QUADRICEPS,
  MOBIL_TRICEPS_SURAE,
  MOBIL_TIBIALIS_ANTERIOR,
  MOBIL_GLUTEUS_MAXIMUS = 16,
  MOBIL_HIP_ABDUCTORS,
  MOBIL_ILIOPSOAS,
  MOBIL_SHORT_ADDUCTORS,
  MOBIL_ADDUCTOR_MAGNUS,
  MOBIL_DEEP_CALF,
  MOBIL_PERONEALS,
  MOBIL_TOE_EXTENSORS
}; /* groups; single muscles: mobil_find_muscle */

/* Method of one muscle. */
typedef struct mobil_method {
  size_t size;
  int method;
  MOBIL_RENAMED(int, modes, vectors); /* 1 to 32; this and all further fields are for MOBIL_MODAL */
  int moving, corrected, control_points, reported, tuned, linear_shape; /* 0 or 1 */
  unsigned int modal_cells[3];
} mobil_method;

/* Choice of leg muscles and of their deformation. */
typedef struct mobil_muscles {
  size_t size;
  unsigned int muscles; /* bits 1 << MOBIL_HAMSTRINGS and so on; default: the first four groups */
  int method;           /* this and the fields to modal_cells are those of mobil_method */
  MOBIL_RENAMED(int, modes, vectors);
  int moving, corrected, control_points, reported, tuned, linear_shape;
  unsigned int modal_cells[3];
  int element, mass, drive, activation;
  int inertia, line_motion; /* 0 or 1 */
  int finite_shape;         /* 0 or 1; negative: 1 with activation */
  unsigned int cells[3];
  double density_kg_m3, young_pa, poisson; /* 1 to 1e6, 1 to 1e12, -0.99 to 0.4999 */
  double damping_per_s, stiffness_damping_s;
  double foundation_hz;      /* negative: chosen for each muscle */
  double dt_s;               /* negative: 0.9 of each individual's critical step */
  unsigned int more_muscles; /* bits of muscles 32 and above, as 1 << (muscle - 32); since interface 5 */
  int unused;
} mobil_muscles;

MOBIL_API int mobil_find_muscle(const char* name);   /* MOBIL_MISSING if unknown */
MOBIL_API const char* mobil_muscle_name(int muscle); /* null after the last */

/* Makes the shared data of these muscles for bodies of usual build, so that no later call waits for it. */
MOBIL_API int mobil_prepare(mobil_sim* sim, const mobil_muscles* muscles);
/* Writes all meshes and bases made so far. A null `out` writes *bytes only. */
MOBIL_API int mobil_bake(mobil_sim* sim, void* out, size_t room, size_t* bytes);
/* Loads the bytes of mobil_bake, in milliseconds. */
MOBIL_API int mobil_load_baked(mobil_sim* sim, const void* baked, size_t bytes);
/* Adds muscles to people or changes those that they have; null removes them. All or none. Only if memory runs out,
 * people before that point have changed. */
MOBIL_API int mobil_set_muscles(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_muscles* muscles);
/* Changes the method of one muscle, both sides, without a jump. All or none, with the same exception. */
MOBIL_API int mobil_set_method(mobil_sim* sim, const mobil_id* ids, size_t count, int muscle,
                               const mobil_method* method);
/* Writes the present method of a muscle. */
MOBIL_API int mobil_get_method(mobil_sim* sim, mobil_id id, int muscle, mobil_method* out);
/* Sets the excitation of a muscle with MOBIL_BY_HOST, one value for each person, clamped to 0.01 to 1. */
MOBIL_API int mobil_set_excitation(mobil_sim* sim, const mobil_id* ids, size_t count, int muscle, int side,
                                   const float* excitation, size_t stride);

#include <mobil/c/lod.h>

/* ---- Time ------------------------------------------------------------------------------------------------------ */

/* Result of a frame. */
typedef struct mobil_ticks {
  unsigned int count; /* ticks that ran */
  double alpha;       /* position of the frame's end in the next tick, 0 to 1 */
  double dropped_s;   /* time dropped from a frame that was too long */
} mobil_ticks;
/* Adds the time of a frame and runs as many ticks as fit into the accumulated time; `out` can be null. */
MOBIL_API int mobil_advance(mobil_sim* sim, double seconds, mobil_ticks* out);
/* Runs a number of ticks, independent of the accumulated time. */
MOBIL_API int mobil_tick(mobil_sim* sim, unsigned int ticks);
MOBIL_API double mobil_time_s(const mobil_sim* sim); /* simulated so far */
/* Returns 0 to go on, any other value to end the call. Must not use the simulation. */
typedef int (*mobil_interrupt)(void* user);
/* Sets the function that long calls ask about every 0.05 s, on their thread, or none (null). It ends them:
 * - mobil_tick and mobil_advance end between two ticks, and their finished ticks stay. The remaining ones of
 *   mobil_advance run with the next frame, those of mobil_tick do not run. A single tick is never cut.
 * - mobil_set_muscles, mobil_set_method and mobil_set_excitation end between two people: those before have changed.
 * - Calls that write vertices, snapshots or baked data leave the memory partly written.
 * - All other calls change nothing. Finished meshes and bases of muscles stay, so a repeated call continues. */
MOBIL_API int mobil_set_interrupt(mobil_sim* sim, mobil_interrupt interrupt, void* user);
MOBIL_API double mobil_tick_s(const mobil_sim* sim); /* of one tick */

/* ---- Reading --------------------------------------------------------------------------------------------------- */

enum { MOBIL_SEGMENTS = 48 }; /* of a skeleton */
/* Names, parents and indices of segments, 0 to MOBIL_SEGMENTS - 1. */
MOBIL_API const char* mobil_segment_name(int segment); /* null after the last */
MOBIL_API int mobil_segment_parent(int segment);       /* the pelvis is its own parent */
MOBIL_API int mobil_find_segment(const char* name);    /* MOBIL_MISSING if unknown */
#include <mobil/c/body.h>

/* Format of a segment's pose. */
enum {
  MOBIL_PLACE_AND_QUATERNION, /* x y z, x y z w: 7 floats a segment */
  MOBIL_MATRIX,               /* three rows of four: 12 floats */
  MOBIL_DUAL_QUATERNION       /* real part x y z w first: 8 floats */
};
/* Instant, segments and format of written poses. */
typedef struct mobil_pose_layout {
  size_t size;
  int form;
  int to_parent;       /* 1: relative to the parent segment; the pelvis relative to the world */
  double ahead_s;      /* time after the last tick, 0 to 0.2: alpha times tick_s for a frame */
  const int* segments; /* null: all 48; if not null, at least one */
  size_t segment_count;
  size_t segment_stride; /* bytes; 0: tightly packed */
} mobil_pose_layout;
/* Writes the exact poses of people at any instant, without lag or interpolation. A null `layout` means positions and
 * quaternions after the last tick. */
MOBIL_API int mobil_poses(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_pose_layout* layout, void* out,
                          size_t stride);

/* Kinds of rows of floats, one row for each person. Index 0 is right, 1 left. */
enum {
  MOBIL_JOINTS,  /* 13: pelvis rotation, list, tilt; hip flexion [2], knee flexion [2], ankle dorsiflexion [2], shoulder
                    flexion [2], elbow flexion [2]; rad */
  MOBIL_FEET,    /* 20: heel [2][3], toe joint [2][3], toe tip [2][3], phase of the gait cycle [2] */
  MOBIL_CENTRE,  /* 3: centre of mass */
  MOBIL_STEP,    /* 3, walkers only: steps taken; supporting side; s since its heel strike */
  MOBIL_GROUND,  /* 12, with forces: force [2][3] in N, centre of pressure [2][3] */
  MOBIL_MOMENTS, /* 6, with forces: hip, knee, ankle, each [2]; N m, extensor and plantarflexor positive */
  MOBIL_FREE_MOMENTS, /* 2, with forces: of each foot about the vertical at its centre of pressure; N m, to the left */
  MOBIL_HIP,          /* 4, with forces: frontal and transverse moments of the hip, each [2]; N m, abductor and inward
                         rotator positive */
  MOBIL_ROWS
};
MOBIL_API int mobil_row_floats(int what); /* floats in a row of that kind */
/* Writes the rows of people, `stride` bytes apart. */
MOBIL_API int mobil_read(mobil_sim* sim, int what, const mobil_id* ids, size_t count, float* out, size_t stride);

/* Kinds of rows of one muscle and side. */
enum {
  MOBIL_LINE,        /* 4: length m, rest length m, stiffness N/m, force N */
  MOBIL_LINE_MOTION, /* 4: lengthening m/s; moment arms about hip, knee, ankle, m */
  MOBIL_REPORT,      /* 5: elongation m, reaction N, volume ratio, kinetic and strain energy J */
  MOBIL_ACTIVATION,  /* 2: excitation, activation */
  MOBIL_TENDON,      /* 5: fibre m, tendon m, pennation rad, force N, belly m */
  MOBIL_NODES,       /* 3 for each node: displacement of control points in the muscle's frame, m */
  MOBIL_MUSCLE_ROWS
};
/* Returns the floats in a row of a person's muscle, because the number of nodes differs. Negative if there is no
 * row. */
MOBIL_API int mobil_muscle_row_floats(mobil_sim* sim, int what, mobil_id id, int muscle, int side);
/* Writes the rows of one muscle of people. */
MOBIL_API int mobil_read_muscles(mobil_sim* sim, int what, const mobil_id* ids, size_t count, int muscle, int side,
                                 float* out, size_t stride);

/* Cost of a system in the last tick. */
typedef struct mobil_system {
  const char *name, *module;
  double seconds;  /* summed over all threads */
  double entities; /* processed */
} mobil_system;
MOBIL_API int mobil_cost(mobil_sim* sim, int system, mobil_system* out); /* MOBIL_MISSING after the last */
/* Cost of a phase in the last tick. Phases such as level of detail, avoidance and terrain run on the calling thread,
 * before or after the systems. */
typedef struct mobil_phase {
  const char *name, *module;
  int after; /* 1: after the systems */
  double seconds;
} mobil_phase;
MOBIL_API int mobil_phase_cost(mobil_sim* sim, int phase, mobil_phase* out); /* MOBIL_MISSING after the last */

#include <mobil/c/surfaces.h>

/* ---- State ----------------------------------------------------------------------------------------------------- */

/* Return the size of a snapshot, bytes, and write it (MOBIL_ROOM if `room` is smaller). */
MOBIL_API size_t mobil_snapshot_bytes(mobil_sim* sim);
MOBIL_API int mobil_save(mobil_sim* sim, void* out, size_t room, size_t* bytes); /* `bytes` can be null */
/* Restores a snapshot to the last bit, handles included. Bytes are never trusted. Management of people is state; scene,
 * walls, discs, options and ground are not. Limits are those of mobil_defaults. */
MOBIL_API int mobil_restore(mobil_sim* sim, const void* bytes, size_t count);
/* Limits on the resources that restoring can use. A snapshot's checksum detects accidents, not attackers, so the host
 * must authenticate the sender of bytes from a network. */
typedef struct mobil_limits {
  size_t size;
  size_t rows;       /* people and muscles together; default 1000000 */
  size_t mesh_nodes; /* of a mesh that must be made; default 500; 0: no new meshes */
  double seconds;    /* time after which no further mesh is made; default 10 */
  int numbers;       /* 1 (default): refuses numbers that are not finite */
  size_t resources;  /* meshes, solvers, bases and choices that rows share; default 2000 */
  size_t steps;      /* substeps of a muscle in a tick; default 2000; 0: no muscles */
} mobil_limits;
/* Restores a snapshot within limits. */
MOBIL_API int mobil_restore_within(mobil_sim* sim, const void* bytes, size_t count, const mobil_limits* limits);
/* Writes a 64-bit hash of the state, lower half first: equal for equal states, on any threads, machine and row
 * order. */
MOBIL_API int mobil_hash(mobil_sim* sim, unsigned int out[2]);
#include <mobil/c/play.h>
#include <mobil/c/skin.h>
#include <mobil/c/surroundings.h>

#include <mobil/c/deprecated.h>

#ifdef __cplusplus
}
#endif
#endif
