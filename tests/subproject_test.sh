#!/usr/bin/env bash
# Includes the project with add_subdirectory, from a host that has its own target `hello` and its own engine/world.h.
# Only the libraries of mobil::systems appear in the host's build, none of the project's files is installed with it, and
# its sources compile. Usage: subproject_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch/own/engine"
echo 'namespace game { struct World { int cells = 7; }; }' >"$scratch/own/engine/world.h"
cmake -G Ninja -S "$2/tests/consumer" -B "$scratch/build" -DMOBIL_SUBPROJECT="$2" \
  -DHOSTS="$2/demo/hello.cpp;$2/tests/consumer/game_host.cpp" -DOWN_HEADERS="$scratch/own"
ninja -C "$scratch/build" -t targets all >"$scratch/targets"
# Programs and libraries: linked targets, and targets that have only a name.
sed -n 's/: \(CXX_.*_LINKER__.*\)$//p' "$scratch/targets" | sort >"$scratch/linked"
printf '%s\n' game_host hello mobil/libmobil_assets.a mobil/libmobil_engine.a mobil/libmobil_systems.a >"$scratch/expected"
diff "$scratch/expected" "$scratch/linked"
if grep -rq 'file(INSTALL' "$scratch/build/mobil"; then
  echo "a host's installation would install ours too" >&2
  exit 1
fi
ninja -C "$scratch/build" CMakeFiles/game_host.dir/game_host.cpp.o CMakeFiles/hello.dir"$2"/demo/hello.cpp.o
# With shared libraries the host links libmobil_core.so.
cmake -G Ninja -S "$2/tests/consumer" -B "$scratch/shared" -DMOBIL_SUBPROJECT="$2" -DBUILD_SHARED_LIBS=ON \
  -DHOSTS="$2/demo/hello.cpp" -DOWN_HEADERS="$scratch/own"
ninja -C "$scratch/shared" -t query hello >"$scratch/query"
grep -q 'mobil/libmobil_core\.so' "$scratch/query"
# Without a build type the project's libraries are optimised.
grep -q 'FLAGS = .*-O3' "$scratch/build/build.ninja"
