/* Bones and muscles as triangles. A part of mobil.h, which includes it. */
#ifndef MOBIL_SURFACES_H
#define MOBIL_SURFACES_H

/* ---- Surfaces -------------------------------------------------------------------------------------------------- */

/* Selection of surfaces. */
typedef struct mobil_surface_choice {
  size_t size;
  int bones;            /* 0 or 1 */
  int side;             /* MOBIL_RIGHT, MOBIL_LEFT, MOBIL_BOTH */
  unsigned int muscles; /* muscles and cells must be those of the people */
  unsigned int cells[3];
  double detail;             /* fraction of the triangles, 0.05 to 1 */
  int textured;              /* 1: texture coordinates, and tangents on request */
  unsigned int more_muscles; /* as in mobil_muscles; since interface 5 */
} mobil_surface_choice;

/* One bone or muscle of the surfaces. */
typedef struct mobil_part {
  const char* name; /* T4, thigh_left, soleus_right; valid as long as the surfaces */
  int segment;      /* of a bone */
  int muscle, side; /* the muscle whose mesh it follows; negative: a bone */
  unsigned int first_vertex, vertices, first_index, indices;
} mobil_part;

/* Binds surfaces to a person's body, in some tenths of a second, for people of similar build. They stay valid without
 * the person. */
MOBIL_API int mobil_bind_surfaces(mobil_sim* sim, mobil_id like, const mobil_surface_choice* choice,
                                  mobil_surfaces** out);
MOBIL_API void mobil_drop_surfaces(mobil_surfaces* surfaces);        /* null is allowed */
MOBIL_API size_t mobil_vertex_count(const mobil_surfaces* surfaces); /* of all parts */
MOBIL_API size_t mobil_index_count(const mobil_surfaces* surfaces);  /* three per triangle */
/* Writes the indices, three per triangle, front outside in the host's axes; `room` must be their number or more. */
MOBIL_API int mobil_indices(const mobil_surfaces* surfaces, unsigned int* out, size_t room);
/* Writes texture coordinates of textured surfaces: two floats a vertex, 0 to 1, along and around. `room` counts
 * floats. */
MOBIL_API int mobil_texture_places(const mobil_surfaces* surfaces, float* out, size_t room);
/* Writes four bytes a vertex, 0 to 255 for 0 to 1: texture coordinates along and around, tendon (0 belly, 1 tendon) and
 * aponeurosis (1: the sheet in which a tendon continues covers the belly). Bones have zeros. `room` counts bytes. Since
 * interface 6. */
MOBIL_API int mobil_surface_tissue(const mobil_surfaces* surfaces, unsigned char* out, size_t room);
/* Writes bone or muscle `part` of the surfaces, from 0. */
MOBIL_API int mobil_surface_part(const mobil_surfaces* surfaces, int part,
                                 mobil_part* out); /* MOBIL_MISSING after the last */

/* Destination of one person's vertices: three floats each (tangents: four), `…_stride` bytes apart (0: tightly packed),
 * in `…_bytes` bytes. Normals and tangents can be null. Streams, also of several targets, must not overlap. */
typedef struct mobil_surface_target {
  size_t size;
  mobil_id id;
  const mobil_surfaces* surfaces;
  void *positions, *normals, *tangents;
  size_t position_stride, normal_stride, tangent_stride;
  size_t position_bytes, normal_bytes, tangent_bytes;
  float origin[3]; /* subtracted before anything is placed */
  int unused;
  double ahead_s; /* time after the last tick, 0 to 0.2: alpha times tick_s for a frame */
} mobil_surface_target;
/* Writes the vertices of people. */
MOBIL_API int mobil_write_surfaces(mobil_sim* sim, const mobil_surface_target* targets, size_t stride, size_t count);

#endif
