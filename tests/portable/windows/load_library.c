/* A host on Windows that loads mobil.dll at run time, as engines and scripting languages do. Prints the state's hash,
 * which is the same for any number of threads. */
#include <stdio.h>
#include <windows.h>

#define MOBIL_STATIC_LIBRARY /* declares the functions without dllimport */
#include <mobil/mobil.h>

#define GET(name, result, parameters)                                                      \
  result(*name##_) parameters = (result(*) parameters)(void*)GetProcAddress(library, #name); \
  if (name##_ == NULL) return 2

int main(void) {
  HMODULE library = LoadLibraryA("mobil.dll");
  mobil_options options;
  mobil_person person[40];
  mobil_id id[40];
  unsigned int hash[2], first[2] = {0, 0};
  int threads, i;
  if (library == NULL) return 1;
  {
    GET(mobil_defaults, int, (int, void*, size_t));
    GET(mobil_create, int, (const mobil_options*, mobil_sim**, char*, size_t));
    GET(mobil_spawn, int,
        (mobil_sim*, const mobil_person*, size_t, size_t, const struct mobil_muscles*, mobil_id*));
    GET(mobil_tick, int, (mobil_sim*, unsigned int));
    GET(mobil_hash, int, (mobil_sim*, unsigned int*));
    GET(mobil_destroy, void, (mobil_sim*));
    for (threads = 1; threads <= 4; ++threads) {
      mobil_sim* sim = NULL;
      mobil_defaults_(MOBIL_OPTIONS, &options, sizeof options);
      options.threads = threads;
      for (i = 0; i < 40; ++i) {
        mobil_defaults_(MOBIL_PERSON, &person[i], sizeof person[i]);
        person[i].place[0] = (float)i;
      }
      if (mobil_create_(&options, &sim, NULL, 0) || mobil_spawn_(sim, person, 0, 40, NULL, id)) return 3;
      if (mobil_tick_(sim, 120) || mobil_hash_(sim, hash)) return 4;
      if (threads == 1) first[0] = hash[0], first[1] = hash[1];
      if (hash[0] != first[0] || hash[1] != first[1]) return 5;
      mobil_destroy_(sim);
    }
    printf("hash %08x%08x\n", first[1], first[0]);
  }
  FreeLibrary(library);
  return 0;
}
