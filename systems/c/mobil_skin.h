/* Skin, clothes and hair as triangles; WebAssembly is without. A part of mobil.h: in the header that hosts have it
 * stands in the place of its include. Since interface 2. */
#ifndef MOBIL_SKIN_H
#define MOBIL_SKIN_H

/* ---- Skin ------------------------------------------------------------------------------------------------------- */

/* Detail: some 90000, 20000, 5000 and 1200 triangles, the same for all men and for all women. */
enum { MOBIL_HERO, MOBIL_NEAR, MOBIL_FAR, MOBIL_DISTANT };
/* What triangles are, in their order; MOBIL_BARE_LEGS below the shorts. */
enum {
  MOBIL_BARE_SKIN,
  MOBIL_BARE_LEGS,
  MOBIL_LIPS,
  MOBIL_HAIR,
  MOBIL_SHIRT,
  MOBIL_SHORTS,
  MOBIL_SHOES,
  MOBIL_SKIN_PARTS
};

/* Zero for another sex or detail. The first call takes two seconds, once in a process for each sex. */
MOBIL_API size_t mobil_skin_vertex_count(int sex, int detail);
/* Three a triangle. */
MOBIL_API size_t mobil_skin_index_count(int sex, int detail);
/* Three a triangle, part by part, wound so that the front is outside in the host's axes; `room` of them at least.
 * `first`: room for MOBIL_SKIN_PARTS + 1 numbers, of each part where it begins in triangles, and
 * behind the last how many there are; null: without. */
MOBIL_API int mobil_skin_indices(mobil_sim* sim, int sex, int detail, unsigned int* out, size_t room,
                                 unsigned int* first);

/* One person's skin, dressed: three floats a vertex, `…_stride` bytes apart (0: close together), in memory of so many
 * bytes. `normals` may be null. */
typedef struct mobil_skin_target {
  size_t size;
  mobil_id id;
  int detail;
  int sex; /* of the triangles; a person of the other is refused. Below 0, as usual: whoever it is */
  void *positions, *normals;
  size_t position_stride, normal_stride;
  size_t position_bytes, normal_bytes;
  float origin[3]; /* subtracted before anything is placed */
  /* The vertices of each leg's muscles, right and left, three floats each, as mobil_write_surfaces wrote them with the
   * same origin: the skin moves over them. Null: without. */
  const float* muscles[2];
  size_t muscle_vertices[2];
  int flexing; /* 1: legs without vertices of muscles move as if they had some; usual 0. A second for the first of a
                * build (3 kg/m2) */
} mobil_skin_target;
/* Writes the skins as people are after the last tick. The first person of a sex takes two seconds, the
 * first of a build (1.5 kg/m2) a quarter to half a second. */
MOBIL_API int mobil_write_skin(mobil_sim* sim, const mobil_skin_target* targets, size_t stride, size_t count);

#endif
