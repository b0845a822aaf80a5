/* Skin, clothes and hair as triangles, a skin of one's own, contact of muscles; WebAssembly is without. A part of
 * mobil.h: in the header that hosts have it stands in the place of its include. Since interface 2, a skin of one's own
 * and contact since 3. */
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

/* ---- A skin of one's own ----------------------------------------------------------------------------------------- */

/* A mesh of legs, as from a scan, that moves with the skin of a body. */
typedef struct mobil_custom_skin mobil_custom_skin;
/* Vertices of a right leg, three floats each, in the host's axes and unit, the person standing at the origin in the
 * anatomical position and heading ahead, and its triangles, wound so that the front is outside in the host's axes. It
 * may be closed flat at its top, which is left out; over the last 6 cm it comes to the body's skin. The left leg is its
 * mirror image. */
typedef struct mobil_leg_mesh {
  size_t size;
  const float* positions;
  size_t vertices;
  const unsigned int* indices;
  size_t index_count; /* three a triangle */
  int detail;         /* of the body's skin that it moves with; usual MOBIL_NEAR */
  int shorts_stay;    /* 1: the body's shorts are drawn over it; usual 0 */
  /* Whose muscles the skin moves over when it is written (mobil_skin_target.muscles); null: without. */
  const mobil_surfaces* surfaces;
} mobil_leg_mesh;
/* Bound once to a person's body, a quarter of a second to one; good for people of the same sex and of similar build.
 * Outlives the person and the surfaces. */
MOBIL_API int mobil_bind_custom_skin(mobil_sim* sim, mobil_id like, const mobil_leg_mesh* mesh,
                                     mobil_custom_skin** out);
MOBIL_API void mobil_drop_custom_skin(mobil_custom_skin* skin);                 /* null is allowed */
MOBIL_API size_t mobil_custom_skin_vertex_count(const mobil_custom_skin* skin); /* of both legs */
MOBIL_API size_t mobil_custom_skin_index_count(const mobil_custom_skin* skin);
/* Three a triangle, wound as mobil_skin_indices; `room` of them at least. */
MOBIL_API int mobil_custom_skin_indices(const mobil_custom_skin* skin, unsigned int* out, size_t room);
/* Of mobil_skin_indices of its detail, what is not in its place: to be drawn besides. Null `out`: `count` alone. */
MOBIL_API int mobil_custom_skin_rest(const mobil_custom_skin* skin, unsigned int* out, size_t room, size_t* count);
/* As mobil_write_skin, the vertices of this mesh; of the targets `detail` does not matter. */
MOBIL_API int mobil_write_custom_skin(mobil_sim* sim, const mobil_custom_skin* skin, const mobil_skin_target* targets,
                                      size_t stride, size_t count);

/* ---- Contact ----------------------------------------------------------------------------------------------------- */

/* Single muscles kept out of each other and of bones, on what is drawn: which vertices may touch which. */
typedef struct mobil_contacts mobil_contacts;
/* Found once for surfaces, as they lie at rest in the body of a person; half a second. Good for people of
 * similar build. Outlives the person and the surfaces. */
MOBIL_API int mobil_find_contacts(mobil_sim* sim, mobil_id like, const mobil_surfaces* surfaces, mobil_contacts** out);
MOBIL_API void mobil_drop_contacts(mobil_contacts* contacts); /* null is allowed */
/* Moves muscles apart in what mobil_write_surfaces has just written to the same targets, positions and normals; some 10
 * ms a person. Tangents stay. */
MOBIL_API int mobil_keep_apart(mobil_sim* sim, const mobil_contacts* contacts, const mobil_surface_target* targets,
                               size_t stride, size_t count);

#endif
