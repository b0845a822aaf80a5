/* Prints the number of triangles of each skin, and hashes of them and of the vertices of somebody who walks. */
#include <stdio.h>
#include <stdlib.h>

#include <mobil/mobil.h>

static unsigned int hash_of(const void* bytes, size_t count) { /* FNV-1a */
  const unsigned char* at = (const unsigned char*)bytes;
  unsigned int hash = 2166136261U;
  while (count-- > 0) hash = (hash ^ *at++) * 16777619U;
  return hash;
}

static int print_skin(mobil_sim* sim, mobil_id walker, int sex, int detail) {
  static const char* const sexes[] = {"man", "woman"};
  static const char* const details[] = {"hero", "near", "far", "distant"};
  const size_t indices = mobil_skin_index_count(sex, detail), vertices = mobil_skin_vertex_count(sex, detail);
  unsigned int* index = (unsigned int*)malloc(indices * sizeof *index);
  float* place = (float*)malloc(3 * vertices * sizeof *place);
  mobil_skin_target target;
  int status = 1;
  mobil_defaults(MOBIL_SKIN_TARGET, &target, sizeof target);
  target.id = walker, target.detail = detail;
  target.positions = place, target.position_bytes = 3 * vertices * sizeof *place;
  if (index && place && mobil_skin_indices(sim, sex, detail, index, indices, NULL) == 0 &&
      mobil_write_skin(sim, &target, 0, 1) == 0) {
    printf("%s, %s: %u triangles %08x, vertices %08x\n", sexes[sex], details[detail], (unsigned int)(indices / 3),
           hash_of(index, indices * sizeof *index), hash_of(place, 3 * vertices * sizeof *place));
    status = 0;
  }
  free(index);
  free(place);
  return status;
}

int main(void) {
  mobil_options options;
  mobil_person person[2];
  mobil_id id[2];
  mobil_sim* sim = NULL;
  int sex, detail;
  mobil_defaults(MOBIL_OPTIONS, &options, sizeof options);
  if (mobil_create(&options, &sim, NULL, 0)) return 1;
  for (sex = 0; sex < 2; ++sex) {
    mobil_defaults(MOBIL_PERSON, &person[sex], sizeof person[sex]);
    person[sex].sex = sex;
  }
  if (mobil_spawn(sim, person, 0, 2, NULL, id) || mobil_tick(sim, 30)) return 2;
  for (sex = 0; sex < 2; ++sex)
    for (detail = MOBIL_HERO; detail <= MOBIL_DISTANT; ++detail)
      if (print_skin(sim, id[sex], sex, detail)) return 3;
  mobil_destroy(sim);
  return 0;
}
