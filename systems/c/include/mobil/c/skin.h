/* Skin, clothes and hair as triangles, custom skins, and contact of muscles. The last two are not in WebAssembly. A
 * part of mobil.h, which includes it. Since interface 2; custom skins and contact since 3. */
#ifndef MOBIL_SKIN_H
#define MOBIL_SKIN_H

/* ---- Skin ------------------------------------------------------------------------------------------------------- */

/* Levels of detail with about 90000, 20000, 5000 and 1200 triangles, one mesh for each sex. */
enum { MOBIL_HERO, MOBIL_NEAR, MOBIL_FAR, MOBIL_DISTANT };
/* Parts of the skin, in the order of triangles. MOBIL_BARE_LEGS are below the shorts. */
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

/* Returns the number of vertices; 0 for an unknown sex or detail. The first call for each sex takes two seconds. */
MOBIL_API size_t mobil_skin_vertex_count(int sex, int detail);
/* Returns the number of indices, three per triangle. */
MOBIL_API size_t mobil_skin_index_count(int sex, int detail);
/* Writes the indices, three per triangle, part by part, with the front outside in the host's axes. `room` must be at
 * least their number. `first` (can be null) receives MOBIL_SKIN_PARTS + 1 numbers: the first triangle of each part, and
 * the number of triangles. */
MOBIL_API int mobil_skin_indices(mobil_sim* sim, int sex, int detail, unsigned int* out, size_t room,
                                 unsigned int* first);

/* Destination of one person's skin with clothes: three floats a vertex, `…_stride` bytes apart (0: tightly packed), in
 * `…_bytes` bytes. `normals` can be null. */
typedef struct mobil_skin_target {
  size_t size;
  mobil_id id;
  int detail;
  int sex; /* of the triangles; a person of the other sex is refused. Negative (default): the person's */
  void *positions, *normals;
  size_t position_stride, normal_stride;
  size_t position_bytes, normal_bytes;
  float origin[3]; /* subtracted before anything is placed */
  /* Vertices of each leg's muscles, right and left, three floats each, as mobil_write_surfaces wrote them with the same
   * origin. The skin moves over them. Can be null. */
  const float* muscles[2];
  size_t muscle_vertices[2];
  int flexing; /* 1: legs without vertices of muscles move as if they had some; default 0. The first person of a build
                * (3 kg/m2) takes one second */
  int unused;
  double ahead_s; /* time after the last tick, 0 to 0.2: alpha times tick_s for a frame; of sleepers ignored */
  float* bounds;  /* receives the minimum and the maximum coordinates of the positions, 6 floats; can be null */
} mobil_skin_target;
/* Writes the skins of people. The first person of a sex takes two seconds, the first of a build
 * (1.5 kg/m2) 0.25 to 0.5 s. */
MOBIL_API int mobil_write_skin(mobil_sim* sim, const mobil_skin_target* targets, size_t stride, size_t count);

/* Makes the skins of usual builds in some 10 s, and writes them with the shared meshes (some 10 MB) to `out`, if `room`
 * is enough; `bytes` (can be null) receives their number. Since interface 4. */
MOBIL_API int mobil_bake_skins(mobil_sim* sim, void* out, size_t room, size_t* bytes);
/* Loads the bytes of mobil_bake_skins in 5 to 50 ms. The first skins of a program then take no time. Bytes of another
 * version, or cut or altered ones, are refused and change nothing. Since interface 4. */
MOBIL_API int mobil_load_skins(mobil_sim* sim, const void* baked, size_t bytes);

/* A skin for the graphics card: the rest shape of a body, with four segments and weights a vertex (linear blend
 * skinning). A vertex is at the sum of weight * pose * inverse bind * position over its joints, with the poses that
 * mobil_poses writes as MOBIL_MATRIX. Over a walk half of the vertices are within 1 mm of mobil_write_skin, and all
 * within 25 mm of its surface. The skin of forearms slides along it by up to 45 mm, because the hand's turn is not
 * spread. The body is in the anatomical position, all rotations identity, over the origin.
 *
 * Arrays can be null. Vertices are doubled on seams of the texture: there are mobil_binding_vertex_count of them, and
 * `same_as` gives the number of each in mobil_write_skin. Triangles are in the order of mobil_skin_indices, so its
 * `first` applies to them. Since interface 4. */
typedef struct mobil_skin_binding {
  size_t size;
  int detail;            /* MOBIL_HERO and so on; default MOBIL_NEAR */
  int sex;               /* of the vertices; a person of the other sex is refused. Negative (default): the person's */
  size_t vertices;       /* room of the arrays for vertices, in vertices */
  float* positions;      /* 3 a vertex */
  float* normals;        /* 3 a vertex */
  float* tangents;       /* 4 a vertex, as in glTF */
  float* texture;        /* 2 a vertex: right and down from the upper left corner, 0 to 1 */
  unsigned char* joints; /* 4 a vertex: segments, heaviest first */
  float* weights;        /* 4 a vertex, which add up to 1 */
  unsigned int* same_as; /* 1 a vertex */
  unsigned int* indices; /* 3 a triangle: mobil_skin_index_count in all, the front outside in the host's axes */
  size_t index_room;
  float* inverse_binds; /* 12 a segment, three rows of four: MOBIL_SEGMENTS of them */
} mobil_skin_binding;
/* Returns the number of vertices of a binding; 0 for an unknown sex or detail. */
MOBIL_API size_t mobil_binding_vertex_count(int sex, int detail);
/* Writes the binding of a person's skin, for people of the same sex and similar build. Errors: a stale handle, an
 * unknown detail; MOBIL_ROOM if an array is too small. */
MOBIL_API int mobil_get_skin_binding(mobil_sim* sim, mobil_id like, const mobil_skin_binding* binding);

/* ---- Custom skins ------------------------------------------------------------------------------------------------ */

/* A mesh of legs, for example from a scan, that moves with the skin of a body. */
typedef struct mobil_custom_skin mobil_custom_skin;
/* Mesh of a right leg: vertices, three floats each, in the host's axes and unit, and triangles with the front outside.
 * The person stands at the origin in the anatomical position and heads ahead. A flat cap at the top is allowed and
 * removed. Over the last 6 cm the mesh blends into the body's skin. The left leg is the mirror image. */
typedef struct mobil_leg_mesh {
  size_t size;
  const float* positions;
  size_t vertices;
  const unsigned int* indices;
  size_t index_count; /* three per triangle */
  int detail;         /* of the body's skin that it moves with; default MOBIL_NEAR */
  int shorts_stay;    /* 1: the body's shorts are drawn over it; default 0 */
  /* Surfaces with the muscles that the skin moves over (mobil_skin_target.muscles); can be null. */
  const mobil_surfaces* surfaces;
} mobil_leg_mesh;
/* Binds a custom skin to a person's body, in 0.25 to 1 s, for people of the same sex and similar build. It stays valid
 * without the person and the surfaces. */
MOBIL_API int mobil_bind_custom_skin(mobil_sim* sim, mobil_id like, const mobil_leg_mesh* mesh,
                                     mobil_custom_skin** out);
MOBIL_API void mobil_drop_custom_skin(mobil_custom_skin* skin);                 /* null is allowed */
MOBIL_API size_t mobil_custom_skin_vertex_count(const mobil_custom_skin* skin); /* of both legs */
MOBIL_API size_t mobil_custom_skin_index_count(const mobil_custom_skin* skin);
/* Writes the indices, three per triangle, wound like mobil_skin_indices. `room` must be at least their number. */
MOBIL_API int mobil_custom_skin_indices(const mobil_custom_skin* skin, unsigned int* out, size_t room);
/* Writes the rest of mobil_skin_indices at its detail: the indices of the body's skin that the mesh does not replace,
 * to be drawn with it. A null `out` writes `count` only. */
MOBIL_API int mobil_custom_skin_rest(const mobil_custom_skin* skin, unsigned int* out, size_t room, size_t* count);
/* Writes the vertices of this mesh, like mobil_write_skin. `detail` of the targets is ignored. */
MOBIL_API int mobil_write_custom_skin(mobil_sim* sim, const mobil_custom_skin* skin, const mobil_skin_target* targets,
                                      size_t stride, size_t count);

/* ---- Contact ----------------------------------------------------------------------------------------------------- */

/* Possible contacts of single muscles with each other and with bones, on displayed surfaces. */
typedef struct mobil_contacts mobil_contacts;
/* Finds the contacts of surfaces at rest in a person's body, in half a second, for people of similar build. They stay
 * valid without the person and the surfaces. */
MOBIL_API int mobil_find_contacts(mobil_sim* sim, mobil_id like, const mobil_surfaces* surfaces, mobil_contacts** out);
MOBIL_API void mobil_drop_contacts(mobil_contacts* contacts); /* null is allowed */
/* Moves muscles apart in the positions and normals that mobil_write_surfaces has just written to the same targets, in
 * some 10 ms a person. Tangents stay. */
MOBIL_API int mobil_keep_apart(mobil_sim* sim, const mobil_contacts* contacts, const mobil_surface_target* targets,
                               size_t stride, size_t count);

#endif
