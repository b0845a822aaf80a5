#!/usr/bin/env bash
# The C interface in C programs: the header is C89 and C++, and a C89 program runs with libmobil.so, which exports
# exactly the functions that the header declares.
# Usage: c_interface_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
warnings=(-Wall -Wextra -Wconversion -Wstrict-prototypes -Werror)
"${CC:-cc}" -std=c89 -pedantic-errors "${warnings[@]}" -I"$2/systems/c/include" "$2/demo/examples/crowd.c" "$1/libmobil.so" \
  -Wl,-rpath,"$1" -o "$scratch/crowd"
"$scratch/crowd"
echo '#include <mobil/mobil.h>' | "${CXX:-c++}" -std=c++98 -pedantic-errors -Wall -Wextra -Werror -I"$2/systems/c/include" -fsyntax-only -x c++ -
nm -D --defined-only "$1/libmobil.so" | awk '$2 ~ /[TDBRVW]/ {print $3}' | sed 's/@.*//' | sort >"$scratch/exported"
cat "$2"/systems/c/include/mobil/mobil.h "$2"/systems/c/include/mobil/c/*.h | tr '\n' ' ' | sed 's/MOBIL_DEPRECATED([^)]*)//g' | grep -oE 'MOBIL_API [^;(]*\(' | grep -oE 'mobil_[a-z_]+\($' | tr -d '(' | sort >"$scratch/declared"
[ "$(wc -l <"$scratch/declared")" -gt 40 ]
diff "$scratch/declared" "$scratch/exported"
# A host can close the library and open it again.
cat >"$scratch/closes.c" <<'C'
#include <dlfcn.h>
#include <stdio.h>
#include <time.h>
#include "mobil/mobil.h"
#define CALL(name, type) type name = (type)dlsym(library, #name)
typedef int (*fills)(int, void*, size_t);
typedef int (*makes)(const mobil_options*, mobil_sim**, char*, size_t);
typedef int (*spawns)(mobil_sim*, const mobil_person*, size_t, size_t, const mobil_muscles*, mobil_id*);
typedef int (*ticks)(mobil_sim*, unsigned);
typedef void (*ends)(mobil_sim*);
int main(int count, char** given) {
  const struct timespec rest = {0, 300000000};
  for (int round = 0; round < 3; ++round) {
    void* library = dlopen(given[count - 1], RTLD_NOW | RTLD_LOCAL);
    if (!library) return puts(dlerror()), 1;
    CALL(mobil_defaults, fills);
    CALL(mobil_create, makes);
    CALL(mobil_spawn, spawns);
    CALL(mobil_tick, ticks);
    CALL(mobil_destroy, ends);
    mobil_options options;
    mobil_person person[400];
    mobil_sim* sim;
    mobil_id id[400];
    mobil_defaults(MOBIL_OPTIONS, &options, sizeof options);
    options.threads = 2;
    for (int i = 0; i < 400; ++i) mobil_defaults(MOBIL_PERSON, &person[i], sizeof person[i]);
    if (mobil_create(&options, &sim, NULL, 0) || mobil_spawn(sim, person, 0, 400, NULL, id) || mobil_tick(sim, 10)) return 1;
    mobil_destroy(sim);
    dlclose(library);
    nanosleep(&rest, NULL);
  }
  return 0;
}
C
"${CC:-cc}" -I"$2/systems/c/include" "$scratch/closes.c" -ldl -o "$scratch/closes"
"$scratch/closes" "$1/libmobil.so"
