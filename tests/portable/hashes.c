/* State hashes of a few scenes, a line each: equal on every machine that fuses multiply-adds. C89. Compile without
 * contraction, so that the requests are equal as well. */
#include <stdio.h>
#include <stdlib.h>

#define MOBIL_STATIC_LIBRARY /* as a host of the static library; it must not hide any name of the header */
#include <mobil/mobil.h>

enum { most = 20 };

static void need(mobil_sim* sim, int code) {
  if (code == MOBIL_OK) return;
  fprintf(stderr, "%s\n", mobil_message(sim));
  exit(2);
}

static void scene(const char* name, int people, int method, int control_points, int activation, int inertia, int forces,
                  unsigned int ticks) {
  mobil_options options;
  mobil_person person[most];
  mobil_muscles muscles;
  mobil_walk walk;
  mobil_id ids[most];
  mobil_sim* sim = NULL;
  char line[256];
  unsigned int hash[2];
  int i;
  mobil_defaults(MOBIL_OPTIONS, &options, sizeof options);
  if (mobil_create(&options, &sim, line, sizeof line) != MOBIL_OK) {
    fprintf(stderr, "%s\n", line);
    exit(2);
  }
  for (i = 0; i < people; ++i) {
    mobil_defaults(MOBIL_PERSON, &person[i], sizeof person[i]);
    person[i].height_m = 1.55f + 0.02f * (float)i;
    person[i].mass_kg = 60.0f + (float)i;
    person[i].given = MOBIL_SPEED;
    person[i].speed_m_s = 0.8f + 0.05f * (float)i;
    person[i].place[0] = (float)i;
    person[i].heading_rad = 0.2f * (float)(i % 5);
  }
  mobil_defaults(MOBIL_MUSCLES, &muscles, sizeof muscles);
  muscles.method = method;
  muscles.control_points = control_points;
  muscles.activation = activation;
  muscles.inertia = inertia;
  need(sim, mobil_spawn(sim, person, 0, (size_t)people, method < 0 ? NULL : &muscles, ids));
  if (forces) need(sim, mobil_enable(sim, ids, (size_t)people, MOBIL_FORCES, 1));
  need(sim, mobil_tick(sim, ticks));
  mobil_defaults(MOBIL_WALK, &walk, sizeof walk);
  walk.given = MOBIL_SPEED | MOBIL_HEADING;
  walk.speed_m_s = 1.3f;
  walk.heading_rad = 1.0f;
  need(sim, mobil_change_walk(sim, ids, (size_t)people / 2, &walk));
  need(sim, mobil_tick(sim, ticks));
  need(sim, mobil_hash(sim, hash));
  printf("%-24s %08x%08x\n", name, hash[1], hash[0]);
  fflush(stdout);
  mobil_destroy(sim);
}

int main(void) {
  scene("bones", most, -1, 0, 0, 0, 0, 120);
  scene("bones and forces", most, -1, 0, 0, 0, 1, 60);
  scene("static", most, MOBIL_STATIC, 1, 0, 0, 0, 20);
  scene("explicit", 3, MOBIL_EXPLICIT_CENTRAL, 1, 0, 0, 0, 10);
  scene("implicit", 3, MOBIL_NEWMARK, 1, 0, 0, 0, 10);
  scene("reduced, unseen", most, MOBIL_MODAL, 0, 0, 0, 0, 20);
  scene("reduced", most, MOBIL_MODAL, 1, 0, 0, 0, 20);
  scene("reduced, inertia", most, MOBIL_MODAL, 1, 0, 1, 0, 20);
  scene("reduced, pulling", most, MOBIL_MODAL, 1, MOBIL_BY_PHASE, 0, 0, 20);
  return 0;
}
