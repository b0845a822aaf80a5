/* The part of Godot 3's GDNative that mobil_crowd.c uses: functions by their places in the tables core 1.0 and
 * nativescript 1.0, which all of Godot 3 has. Types are opaque bytes, because their size decides how calls pass
 * them. */
#ifndef GDNATIVE_1_0_H
#define GDNATIVE_1_0_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef struct gd_variant {
  uint64_t opaque[3];
} gd_variant;
typedef struct gd_handle { /* a string, an array or a pool array */
  void* opaque;
} gd_handle;
typedef struct gd_vector3 {
  unsigned char opaque[12]; /* three floats */
} gd_vector3;
typedef void (*gd_function)(void);

typedef struct gd_table {
  unsigned int type, major, minor;
  const struct gd_table* next;
} gd_table;
typedef struct gd_core {
  gd_table head;
  unsigned int extension_count;
  const gd_table* const* extensions;
  gd_function function[744];
} gd_core;
typedef struct gd_nativescript {
  gd_table head;
  gd_function function[6];
} gd_nativescript;
enum { GD_CORE = 0, GD_NATIVESCRIPT = 1 }; /* type of a table */

typedef struct gd_init_options {
  bool in_editor;
  uint64_t hashes[3];
  gd_function report_version;
  void (*report_error)(const void* library, const char* text);
  void* library;
  const gd_core* core;
} gd_init_options;

typedef struct gd_create {
  void* (*create)(void* object, void* data);
  void* data;
  void (*release)(void* data);
} gd_create;
typedef struct gd_destroy {
  void (*destroy)(void* object, void* data, void* user);
  void* data;
  void (*release)(void* data);
} gd_destroy;
typedef struct gd_method {
  gd_variant (*call)(void* object, void* data, void* user, int count, gd_variant** arguments);
  void* data;
  void (*release)(void* data);
} gd_method;
typedef struct gd_method_attributes {
  int rpc; /* 0: none */
} gd_method_attributes;

static const gd_core* gd;
static const gd_nativescript* gd_script;

/* A function of a table as its type. */
#define GD(place, result, types) ((result(*) types)gd->function[place])
#define GD_SCRIPT(place, result, types) ((result(*) types)gd_script->function[place])

/* ---- Variants ---------------------------------------------------------------------------------------------------- */

static inline gd_variant gd_nil(void) {
  gd_variant made;
  GD(509, void, (gd_variant*))(&made);
  return made;
}
static inline gd_variant gd_int(int64_t value) {
  gd_variant made;
  GD(512, void, (gd_variant*, int64_t))(&made, value);
  return made;
}
static inline gd_variant gd_real(double value) {
  gd_variant made;
  GD(513, void, (gd_variant*, double))(&made, value);
  return made;
}
static inline gd_variant gd_place(const float* xyz) {
  gd_variant made;
  gd_vector3 value;
  memcpy(&value, xyz, sizeof value);
  GD(517, void, (gd_variant*, const gd_vector3*))(&made, &value);
  return made;
}
static inline bool gd_as_bool(const gd_variant* from) {
  return GD(537, bool, (const gd_variant*))(from);
}
static inline int64_t gd_as_int(const gd_variant* from) {
  return GD(539, int64_t, (const gd_variant*))(from);
}
static inline double gd_as_real(const gd_variant* from) {
  return GD(540, double, (const gd_variant*))(from);
}
static inline void gd_as_place(const gd_variant* from, float* xyz) {
  const gd_vector3 value = GD(544, gd_vector3, (const gd_variant*))(from);
  memcpy(xyz, &value, sizeof value);
}
static inline void* gd_as_object(const gd_variant* from) {
  return GD(554, void*, (const gd_variant*))(from);
}

/* ---- Strings and arrays ------------------------------------------------------------------------------------------ */

static inline gd_handle gd_string(const char* utf8) {
  gd_handle made;
  GD(574, void, (gd_handle*))(&made);
  GD(679, bool, (gd_handle*, const char*))(&made, utf8);
  return made;
}
static inline void gd_drop_string(gd_handle* string) {
  GD(721, void, (gd_handle*))(string);
}

/* Kinds of pool arrays. Each has sixteen functions, four of its write access, and one that makes a variant of it. */
enum { GD_INTS = 1, GD_REALS = 2, GD_STRINGS = 3, GD_PLACES_2D = 4, GD_PLACES = 5 };
/* Returns a pool array of `count` rows with `per_row` elements each; not of strings. Row i is row order[i] of `rows`,
 * or row i if `order` is null. */
static inline gd_variant gd_pool(int kind, const void* rows, const int* order, int count, int per_row) {
  static const size_t element_bytes[] = {1, 4, 4, 0, 8, 12};
  const size_t bytes = element_bytes[kind] * (size_t)per_row;
  const int first = 155 + 16 * kind, access = 295 + 4 * kind;
  gd_variant made;
  gd_handle pool;
  void* write;
  char* to;
  int i;
  GD(first, void, (gd_handle*))(&pool);
  GD(first + 9, void, (gd_handle*, int))(&pool, count * per_row);
  write = GD(first + 11, void*, (gd_handle*))(&pool);
  to = GD(access + 1, void*, (const void*))(write);
  for (i = 0; i < count; ++i)
    memcpy(to + (size_t)i * bytes, (const char*)rows + (size_t)(order == NULL ? i : order[i]) * bytes, bytes);
  GD(access + 3, void, (void*))(write);
  GD(530 + kind, void, (gd_variant*, const gd_handle*))(&made, &pool);
  GD(first + 15, void, (gd_handle*))(&pool);
  return made;
}
static inline gd_variant gd_strings(const char* (*nth)(int), int count) {
  const int first = 155 + 16 * GD_STRINGS;
  gd_variant made;
  gd_handle pool;
  int i;
  GD(first, void, (gd_handle*))(&pool);
  for (i = 0; i < count; ++i) {
    gd_handle string = gd_string(nth(i));
    GD(first + 3, void, (gd_handle*, const gd_handle*))(&pool, &string);
    gd_drop_string(&string);
  }
  GD(530 + GD_STRINGS, void, (gd_variant*, const gd_handle*))(&made, &pool);
  GD(first + 15, void, (gd_handle*))(&pool);
  return made;
}
/* Returns an array of `count` variants, which it takes. */
static inline gd_variant gd_array(gd_variant* variants, int count) {
  gd_variant made;
  gd_handle array;
  int i;
  GD(323, void, (gd_handle*))(&array);
  for (i = 0; i < count; ++i) {
    GD(336, void, (gd_handle*, const gd_variant*))(&array, &variants[i]);
    GD(570, void, (gd_variant*))(&variants[i]);
  }
  GD(529, void, (gd_variant*, const gd_handle*))(&made, &array);
  GD(361, void, (gd_handle*))(&array);
  return made;
}

/* ---- Objects, errors --------------------------------------------------------------------------------------------- */

static inline bool gd_has_method(const gd_variant* of, const char* name) {
  gd_handle string = gd_string(name);
  const bool has = GD(565, bool, (const gd_variant*, const gd_handle*))(of, &string);
  gd_drop_string(&string);
  return has;
}
/* Methods of engine classes; null if unknown. */
static inline void* gd_find_method(const char* type, const char* name) {
  return GD(732, void*, (const char*, const char*))(type, name);
}
/* Calls a method. Arguments and result are pointers: of integers, to int64_t. */
static inline void gd_call(void* method, void* object, const void** arguments, void* result) {
  GD(733, void, (void*, void*, const void**, void*))(method, object, arguments, result);
}
static inline void gd_error(const char* text, const char* function) {
  GD(741, void, (const char*, const char*, const char*, int))(text, function, "mobil_crowd.c", 0);
}

/* Takes the tables. Returns false if they have other versions, or if values that are read back differ. */
static inline bool gd_load(const gd_init_options* options) {
  const float xyz[3] = {1.5f, -2.25f, 3.0f};
  float back[3];
  gd_variant whole, part, place;
  unsigned int i;
  if (options->core->head.type != GD_CORE || options->core->head.major != 1) return false;
  gd = options->core;
  gd_script = NULL;
  for (i = 0; i < gd->extension_count; ++i)
    if (gd->extensions[i]->type == GD_NATIVESCRIPT && gd->extensions[i]->major == 1)
      gd_script = (const gd_nativescript*)gd->extensions[i];
  if (gd_script == NULL) return false;
  whole = gd_int(1234567890123);
  part = gd_real(0.625);
  place = gd_place(xyz);
  gd_as_place(&place, back);
  return gd_as_int(&whole) == 1234567890123 && gd_as_real(&part) == 0.625 && memcmp(back, xyz, sizeof xyz) == 0;
}

#endif
