/* A crowd for Godot 3, as the NativeScript class MobilCrowd over libmobil.so. Poses are written into skeletons whose
 * bones are found by name; skins are arrays for ArrayMesh. All is in Godot's axes: y up, -z ahead.
 *
 * README.md has the commands that build it.
 */
#include "gdnative_1_0.h"

#include <mobil/mobil.h>
#include <stdlib.h>

typedef struct walker {
  mobil_id id;
  const void* skeleton;          /* of bind() */
  int64_t bone[MOBIL_SEGMENTS];  /* of each segment; -1: none */
  float rest[MOBIL_SEGMENTS][3]; /* place of the bone at rest, from its parent */
} walker;
typedef struct crowd {
  mobil_sim* sim;
  walker* walkers;
  int64_t count;
} crowd;
typedef struct transform {
  float turn[3][3], place[3];
} transform;

static void *is_class, *find_bone, *get_bone_rest, *set_bone_pose; /* methods of Object and Skeleton */

static bool ok(const crowd* self, int code, const char* function) {
  if (code == MOBIL_OK) return true;
  gd_error(mobil_message(self->sim), function);
  return false;
}

/* Returns the walker with the number in an argument, or null. */
static walker* walker_of(const crowd* self, const gd_variant* argument, const char* function) {
  const int64_t number = gd_as_int(argument);
  if (number >= 0 && number < self->count) return &self->walkers[number];
  gd_error("no person has that number; use those that spawn returns", function);
  return NULL;
}

/* Returns the skeleton in an argument, or null. Its methods are called by pointer, so no other object may pass. */
static void* skeleton_of(const gd_variant* argument, const char* function) {
  void* object = gd_has_method(argument, "set_bone_pose") ? gd_as_object(argument) : NULL;
  int64_t is = 0;
  if (object != NULL) {
    gd_handle name = gd_string("Skeleton");
    const void* by_name[] = {&name};
    gd_call(is_class, object, by_name, &is);
    gd_drop_string(&name);
  }
  if (is != 0) return object;
  gd_error("the second argument is not a Skeleton", function);
  return NULL;
}

/* spawn(height_m, mass_kg, woman, speed_m_s, place, heading_rad): the person's number, or -1 */
static gd_variant spawn(crowd* self, gd_variant** a) {
  mobil_person person;
  walker made = {{0, 0}, NULL, {0}, {{0}}};
  walker* more;
  mobil_defaults(MOBIL_PERSON, &person, sizeof person);
  person.height_m = (float)gd_as_real(a[0]);
  person.mass_kg = (float)gd_as_real(a[1]);
  person.sex = gd_as_bool(a[2]) ? MOBIL_WOMAN : MOBIL_MAN;
  person.given = MOBIL_SPEED;
  person.speed_m_s = (float)gd_as_real(a[3]);
  gd_as_place(a[4], person.place);
  person.heading_rad = (float)gd_as_real(a[5]);
  more = realloc(self->walkers, (size_t)(self->count + 1) * sizeof *more);
  if (more == NULL) {
    gd_error("out of memory", "spawn");
    return gd_int(-1);
  }
  self->walkers = more;
  if (!ok(self, mobil_spawn(self->sim, &person, 0, 1, NULL, &made.id), "spawn")) return gd_int(-1);
  more[self->count] = made;
  return gd_int(self->count++);
}

/* advance(seconds): the time from the last tick to the end of this frame, s, for pose() and place() */
static gd_variant advance(crowd* self, gd_variant** a) {
  mobil_ticks ticks = {0, 0, 0};
  ok(self, mobil_advance(self->sim, gd_as_real(a[0]), &ticks), "advance");
  return gd_real(ticks.alpha * mobil_tick_s(self->sim));
}

/* names(): of the segments, in the order of rest(), parents() and the binds of a Skin */
static gd_variant names(crowd* self, gd_variant** a) {
  (void)self, (void)a;
  return gd_strings(mobil_segment_name, MOBIL_SEGMENTS);
}

/* parents(): of the segments; the first is its own */
static gd_variant parents(crowd* self, gd_variant** a) {
  int parent[MOBIL_SEGMENTS], i;
  (void)self, (void)a;
  for (i = 0; i < MOBIL_SEGMENTS; ++i) parent[i] = mobil_segment_parent(i);
  return gd_pool(GD_INTS, parent, NULL, MOBIL_SEGMENTS, 1);
}

/* rest(person): places of the segments in the anatomical position, from their parents. Nothing is turned. */
static gd_variant rest(crowd* self, gd_variant** a) {
  mobil_segment body[MOBIL_SEGMENTS];
  float offset[MOBIL_SEGMENTS][3];
  const walker* of = walker_of(self, a[0], "rest");
  int i;
  if (of == NULL) return gd_nil();
  mobil_defaults(MOBIL_SEGMENT, &body[0], sizeof body[0]);
  if (!ok(self, mobil_get_body(self->sim, of->id, body, 0), "rest")) return gd_nil();
  for (i = 0; i < MOBIL_SEGMENTS; ++i) memcpy(offset[i], body[i].offset, sizeof offset[i]);
  return gd_pool(GD_PLACES, offset, NULL, MOBIL_SEGMENTS, 1);
}

/* bind(person, skeleton): finds the bones by name; returns how many. The rest of a bone must not be turned. */
static gd_variant bind(crowd* self, gd_variant** a) {
  walker* of = walker_of(self, a[0], "bind");
  void* skeleton = skeleton_of(a[1], "bind");
  int i, found = 0;
  if (of == NULL || skeleton == NULL) return gd_int(0);
  of->skeleton = skeleton;
  for (i = 0; i < MOBIL_SEGMENTS; ++i) {
    gd_handle name = gd_string(mobil_segment_name(i));
    const void* by_name[] = {&name};
    const void* by_number[] = {&of->bone[i]};
    transform at;
    gd_call(find_bone, skeleton, by_name, &of->bone[i]);
    gd_drop_string(&name);
    if (of->bone[i] < 0) continue;
    gd_call(get_bone_rest, skeleton, by_number, &at);
    memcpy(of->rest[i], at.place, sizeof at.place);
    ++found;
  }
  return gd_int(found);
}

/* pose(person, skeleton, ahead_s): sets the bones that bind() found */
static gd_variant pose(crowd* self, gd_variant** a) {
  float rows[MOBIL_SEGMENTS][3][4];
  mobil_pose_layout layout;
  const walker* of = walker_of(self, a[0], "pose");
  void* skeleton = skeleton_of(a[1], "pose");
  int i, row;
  if (of == NULL || skeleton == NULL) return gd_nil();
  if (skeleton != of->skeleton) {
    gd_error("this is not the skeleton of bind()", "pose");
    return gd_nil();
  }
  mobil_defaults(MOBIL_POSE_LAYOUT, &layout, sizeof layout);
  layout.form = MOBIL_MATRIX;
  layout.to_parent = 1;
  layout.ahead_s = gd_as_real(a[2]);
  if (!ok(self, mobil_poses(self->sim, &of->id, 1, &layout, rows, 0), "pose")) return gd_nil();
  for (i = 0; i < MOBIL_SEGMENTS; ++i) {
    transform to;
    const void* arguments[] = {&of->bone[i], &to};
    if (of->bone[i] < 0) continue;
    for (row = 0; row < 3; ++row) {
      memcpy(to.turn[row], rows[i][row], sizeof to.turn[row]);
      to.place[row] = rows[i][row][3] - of->rest[i][row];
    }
    gd_call(set_bone_pose, skeleton, arguments, NULL);
  }
  return gd_nil();
}

/* place(person, segment, ahead_s): of a segment's joint, in the world */
static gd_variant place(crowd* self, gd_variant** a) {
  float at[7];
  mobil_pose_layout layout;
  const walker* of = walker_of(self, a[0], "place");
  const int segment = (int)gd_as_int(a[1]);
  if (of == NULL) return gd_nil();
  mobil_defaults(MOBIL_POSE_LAYOUT, &layout, sizeof layout);
  layout.ahead_s = gd_as_real(a[2]);
  layout.segments = &segment;
  layout.segment_count = 1;
  if (!ok(self, mobil_poses(self->sim, &of->id, 1, &layout, at, 0), "place")) return gd_nil();
  return gd_place(at);
}

/* A skin's vertices and triangles, and lists for one surface. */
typedef struct skin_arrays {
  float *positions, *normals, *texture, *weights;
  unsigned char* joints;
  int *bones, *order, *numbers; /* the joints as Godot's bones; vertices of the surface; their numbers in it, from 1 */
  unsigned int* indices;
  int* index; /* of the surface */
} skin_arrays;

static bool make_arrays(skin_arrays* s, size_t vertices, size_t indices) {
  s->positions = calloc(12 * vertices, sizeof *s->positions);
  s->joints = calloc(4 * vertices, 1);
  s->bones = calloc(6 * vertices, sizeof *s->bones);
  s->indices = calloc(indices, sizeof *s->indices);
  s->index = calloc(indices, sizeof *s->index);
  if (!s->positions || !s->joints || !s->bones || !s->indices || !s->index) return false;
  s->normals = s->positions + 3 * vertices;
  s->texture = s->normals + 3 * vertices;
  s->weights = s->texture + 2 * vertices;
  s->order = s->bones + 4 * vertices;
  s->numbers = s->order + vertices;
  return true;
}

static void drop_arrays(skin_arrays* s) {
  free(s->positions);
  free(s->joints);
  free(s->bones);
  free(s->indices);
  free(s->index);
}

/* Returns arrays for ArrayMesh.add_surface_from_arrays: the triangles from `first` up to `end`, and their vertices.
 * Godot's fronts are wound clockwise. */
static gd_variant surface(const skin_arrays* s, size_t vertices, unsigned int first, unsigned int end) {
  static const int clockwise[] = {0, 2, 1};
  const int indices = (int)(3 * (end - first));
  gd_variant arrays[9];
  int count = 0, i;
  memset(s->numbers, 0, vertices * sizeof *s->numbers);
  for (i = 0; i < indices; ++i) {
    const unsigned int vertex = s->indices[3 * first + (unsigned int)(i - i % 3 + clockwise[i % 3])];
    if (s->numbers[vertex] == 0) {
      s->order[count] = (int)vertex;
      s->numbers[vertex] = ++count;
    }
    s->index[i] = s->numbers[vertex] - 1;
  }
  arrays[0] = gd_pool(GD_PLACES, s->positions, s->order, count, 1);
  arrays[1] = gd_pool(GD_PLACES, s->normals, s->order, count, 1);
  arrays[2] = arrays[3] = arrays[5] = gd_nil(); /* tangents, colours, second texture */
  arrays[4] = gd_pool(GD_PLACES_2D, s->texture, s->order, count, 1);
  arrays[6] = gd_pool(GD_INTS, s->bones, s->order, count, 4);
  arrays[7] = gd_pool(GD_REALS, s->weights, s->order, count, 4);
  arrays[8] = gd_pool(GD_INTS, s->index, NULL, indices, 1);
  return gd_array(arrays, 9);
}

/* skin(person, detail): surfaces for ArrayMesh, one for each part (mobil/c/skin.h). Bones of vertices are segments. */
static gd_variant skin(crowd* self, gd_variant** a) {
  mobil_skin_binding binding;
  mobil_person person;
  skin_arrays s;
  unsigned int first[MOBIL_SKIN_PARTS + 1];
  gd_variant surfaces[MOBIL_SKIN_PARTS], made = gd_nil();
  const walker* of = walker_of(self, a[0], "skin");
  size_t i;
  int part;
  mobil_defaults(MOBIL_PERSON, &person, sizeof person);
  if (of == NULL || !ok(self, mobil_get_person(self->sim, of->id, &person), "skin")) return made;
  mobil_defaults(MOBIL_SKIN_BINDING, &binding, sizeof binding);
  binding.detail = (int)gd_as_int(a[1]);
  binding.vertices = mobil_binding_vertex_count(person.sex, binding.detail);
  binding.index_room = mobil_skin_index_count(person.sex, binding.detail);
  if (make_arrays(&s, binding.vertices, binding.index_room)) {
    binding.positions = s.positions;
    binding.normals = s.normals;
    binding.texture = s.texture;
    binding.joints = s.joints;
    binding.weights = s.weights;
    binding.indices = s.indices;
    if (ok(self, mobil_get_skin_binding(self->sim, of->id, &binding), "skin") &&
        ok(self,
           mobil_skin_indices(self->sim, person.sex, binding.detail, (unsigned int*)s.index, binding.index_room, first),
           "skin")) {
      for (i = 0; i < 4 * binding.vertices; ++i) s.bones[i] = s.joints[i];
      for (part = 0; part < MOBIL_SKIN_PARTS; ++part)
        surfaces[part] = surface(&s, binding.vertices, first[part], first[part + 1]);
      made = gd_array(surfaces, MOBIL_SKIN_PARTS);
    }
  } else {
    gd_error("out of memory", "skin");
  }
  drop_arrays(&s);
  return made;
}

/* ---- The class --------------------------------------------------------------------------------------------------- */

typedef struct method {
  const char* name;
  int arguments;
  gd_variant (*call)(crowd* self, gd_variant** arguments);
} method;
static const method methods[] = {{"spawn", 6, spawn},     {"advance", 1, advance}, {"names", 0, names},
                                 {"parents", 0, parents}, {"rest", 1, rest},       {"bind", 2, bind},
                                 {"pose", 3, pose},       {"place", 3, place},     {"skin", 2, skin}};

static gd_variant call(void* object, void* data, void* user, int count, gd_variant** arguments) {
  const method* which = data;
  (void)object;
  if (user != NULL && count == which->arguments) return which->call(user, arguments);
  gd_error(user == NULL ? "there is no crowd" : "another number of arguments", which->name);
  return gd_nil();
}

static void* create(void* object, void* data) {
  crowd* made = calloc(1, sizeof *made);
  mobil_options options;
  char line[256];
  (void)object, (void)data;
  if (made == NULL) return NULL;
  mobil_defaults(MOBIL_OPTIONS, &options, sizeof options);
  options.axes = MOBIL_AXES_GODOT;
  if (mobil_create(&options, &made->sim, line, sizeof line) == MOBIL_OK) return made;
  gd_error(line, "MobilCrowd");
  free(made);
  return NULL;
}

static void destroy(void* object, void* data, void* user) {
  crowd* ended = user;
  (void)object, (void)data;
  if (ended == NULL) return;
  mobil_destroy(ended->sim);
  free(ended->walkers);
  free(ended);
}

#define EXPORTED __attribute__((visibility("default")))
EXPORTED void godot_gdnative_init(const gd_init_options* options) {
  if (gd_load(options)) return;
  gd_script = NULL;
  options->report_error(options->library, "mobil_crowd needs GDNative core 1.x and nativescript 1.x, those of Godot 3");
}
EXPORTED void godot_gdnative_terminate(const void* options) {
  (void)options;
}
EXPORTED void godot_nativescript_init(void* handle) {
  const gd_create made = {create, NULL, NULL};
  const gd_destroy ended = {destroy, NULL, NULL};
  const gd_method_attributes plain = {0};
  size_t i;
  if (gd_script == NULL) return;
  is_class = gd_find_method("Object", "is_class");
  find_bone = gd_find_method("Skeleton", "find_bone");
  get_bone_rest = gd_find_method("Skeleton", "get_bone_rest");
  set_bone_pose = gd_find_method("Skeleton", "set_bone_pose");
  GD_SCRIPT(0, void, (void*, const char*, const char*, gd_create, gd_destroy))
  (handle, "MobilCrowd", "Reference", made, ended);
  for (i = 0; i < sizeof methods / sizeof *methods; ++i) {
    const gd_method called = {call, (void*)&methods[i], NULL};
    GD_SCRIPT(2, void, (void*, const char*, const char*, gd_method_attributes, gd_method))
    (handle, "MobilCrowd", methods[i].name, plain, called);
  }
}
