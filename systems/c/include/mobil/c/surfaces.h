/* Bones and muscles as triangles. A part of mobil.h, which includes it; in the header that hosts have it stands in its
 * place. */
#ifndef MOBIL_SURFACES_H
#define MOBIL_SURFACES_H

/* ---- Surfaces -------------------------------------------------------------------------------------------------- */

/* What of a body becomes triangles. */
typedef struct mobil_surface_choice {
  size_t size;
  int bones;            /* 0 or 1 */
  int side;             /* MOBIL_RIGHT, MOBIL_LEFT, MOBIL_BOTH */
  unsigned int muscles; /* those and the cells that people have who are to show them */
  unsigned int cells[3];
  double detail; /* part of the triangles, 0.05 to 1 */
  int textured;  /* 1: texture places, and tangents on request */
} mobil_surface_choice;

/* One bone or muscle among the triangles. */
typedef struct mobil_part {
  const char* name; /* T4, thigh_left, soleus_right; as long as the surfaces */
  int segment;      /* of a bone */
  int muscle, side; /* of a muscle: whose mesh it follows; below 0: a bone */
  unsigned int first_vertex, vertices, first_index, indices;
} mobil_part;

/* Bound once to one person's body, some tens of milliseconds; good for everybody of similar build. Outlives the
 * person. */
MOBIL_API int mobil_bind_surfaces(mobil_sim* sim, mobil_id like, const mobil_surface_choice* choice,
                                  mobil_surfaces** out);
MOBIL_API void mobil_drop_surfaces(mobil_surfaces* surfaces);        /* null is allowed */
MOBIL_API size_t mobil_vertex_count(const mobil_surfaces* surfaces); /* of all parts */
MOBIL_API size_t mobil_index_count(const mobil_surfaces* surfaces);  /* three a triangle */
/* Three a triangle, wound so that the front is outside in the host's axes; `room` of them at least. */
MOBIL_API int mobil_indices(const mobil_surfaces* surfaces, unsigned int* out, size_t room);
/* Two a vertex, 0 to 1: along and around; of textured surfaces. `room`: of floats. */
MOBIL_API int mobil_texture_places(const mobil_surfaces* surfaces, float* out, size_t room);
/* The bones and muscles among the triangles, from 0 on. */
MOBIL_API int mobil_surface_part(const mobil_surfaces* surfaces, int part,
                                 mobil_part* out); /* MOBIL_MISSING behind the last */

/* One person's vertices: three floats each, of tangents four, `…_stride` bytes apart (0: close together), in memory of
 * so many bytes. Null normals and tangents are left out. Streams, also those of several targets, lie apart. */
typedef struct mobil_surface_target {
  size_t size;
  mobil_id id;
  const mobil_surfaces* surfaces;
  void *positions, *normals, *tangents;
  size_t position_stride, normal_stride, tangent_stride;
  size_t position_bytes, normal_bytes, tangent_bytes;
  float origin[3]; /* subtracted before anything is placed */
} mobil_surface_target;
/* Writes the vertices as they are after the last tick. */
MOBIL_API int mobil_write_surfaces(mobil_sim* sim, const mobil_surface_target* targets, size_t stride, size_t count);

#endif
