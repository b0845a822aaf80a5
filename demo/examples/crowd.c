/* The C interface in C89: forty people walk, two of them with muscles whose surfaces are written into a vertex buffer.
 * Then a snapshot is restored, and the second run has bit-identical results.
 *
 *   cc -std=c89 demo/examples/crowd.c -I<prefix>/include -L<prefix>/lib -lmobil */
#include <mobil/mobil.h>
#include <stdio.h>
#include <stdlib.h>

enum { crowd = 40, seen = 2, frames = 60 };

typedef struct vertex {
  float position[3], normal[3];
} vertex;

static mobil_sim* sim;

static void need(int code) {
  if (code == MOBIL_OK) return;
  fprintf(stderr, "%s\n", mobil_message(sim));
  exit(2);
}

static void make(void) {
  mobil_options options;
  char line[256];
  mobil_defaults(MOBIL_OPTIONS, &options, sizeof options);
  if (mobil_create(&options, &sim, line, sizeof line) == MOBIL_OK) return;
  fprintf(stderr, "%s\n", line);
  exit(2);
}

static void spawn(mobil_id* ids) {
  mobil_person people[crowd];
  mobil_muscles muscles;
  int i;
  for (i = 0; i < crowd; ++i) {
    mobil_defaults(MOBIL_PERSON, &people[i], sizeof people[i]);
    people[i].height_m = 1.6f + 0.007f * (float)i;
    people[i].given = MOBIL_SPEED;
    people[i].speed_m_s = 1.0f + 0.01f * (float)i;
    people[i].place[0] = (float)(i % 8);
    people[i].place[2] = (float)(i / 8);
  }
  need(mobil_spawn(sim, people, 0, crowd, NULL, ids));
  mobil_defaults(MOBIL_MUSCLES, &muscles, sizeof muscles);
  muscles.method = MOBIL_MODAL;
  need(mobil_set_muscles(sim, ids, seen, &muscles));
}

/* Writes the input of a renderer: matrices of all people, vertices of the visible ones. Returns the maximum height. */
static double draw(const mobil_id* ids, mobil_surfaces* surfaces, double ahead_s, vertex* vertices, float* matrices) {
  const size_t count = mobil_vertex_count(surfaces);
  mobil_surface_target targets[seen];
  mobil_pose_layout layout;
  double highest = 0;
  size_t i;
  mobil_defaults(MOBIL_POSE_LAYOUT, &layout, sizeof layout);
  layout.form = MOBIL_MATRIX;
  layout.ahead_s = ahead_s;
  need(mobil_poses(sim, ids, crowd, &layout, matrices, 0));
  for (i = 0; i < seen; ++i) {
    mobil_defaults(MOBIL_SURFACE_TARGET, &targets[i], sizeof targets[i]);
    targets[i].id = ids[i];
    targets[i].surfaces = surfaces;
    targets[i].positions = vertices[i * count].position;
    targets[i].normals = vertices[i * count].normal;
    targets[i].position_stride = targets[i].normal_stride = sizeof(vertex);
    targets[i].position_bytes = count * sizeof(vertex);
    targets[i].normal_bytes = count * sizeof(vertex) - sizeof vertices->position;
  }
  need(mobil_write_surfaces(sim, targets, 0, seen));
  for (i = 0; i < seen * count; ++i)
    if (vertices[i].position[1] > highest) highest = vertices[i].position[1];
  return highest;
}

int main(void) {
  static float matrices[crowd * MOBIL_SEGMENTS * 12];
  mobil_id ids[crowd];
  mobil_surface_choice choice;
  mobil_surfaces* surfaces;
  vertex* vertices;
  void* snapshot;
  size_t bytes;
  unsigned int first[2], again[2];
  double highest = 0;
  int frame;

  make();
  spawn(ids);
  mobil_defaults(MOBIL_SURFACE_CHOICE, &choice, sizeof choice);
  need(mobil_bind_surfaces(sim, ids[0], &choice, &surfaces));
  vertices = malloc(seen * mobil_vertex_count(surfaces) * sizeof *vertices);
  snapshot = malloc(bytes = mobil_snapshot_bytes(sim));
  if (vertices == NULL || snapshot == NULL) return 2;
  need(mobil_save(sim, snapshot, bytes, &bytes));

  for (frame = 0; frame < frames; ++frame) {
    mobil_ticks ticks;
    need(mobil_advance(sim, 1.0 / 50, &ticks));
    highest = draw(ids, surfaces, ticks.alpha * mobil_tick_s(sim), vertices, matrices);
  }
  need(mobil_hash(sim, first));

  need(mobil_restore(sim, snapshot, bytes));
  for (frame = 0; frame < frames; ++frame) need(mobil_advance(sim, 1.0 / 50, NULL));
  need(mobil_hash(sim, again));

  printf("mobil %s: %d people, %lu vertices for each of %d, up to %.2f m; after %.2f s %08x%08x, second run %s\n",
         mobil_library_version(), crowd, (unsigned long)mobil_vertex_count(surfaces), seen, highest, mobil_time_s(sim),
         first[1], first[0], first[0] == again[0] && first[1] == again[1] ? "identical" : "DIFFERENT");
  mobil_drop_surfaces(surfaces);
  mobil_destroy(sim);
  free(vertices);
  free(snapshot);
  return highest > 1.4 && first[0] == again[0] && first[1] == again[1] ? 0 : 1;
}
