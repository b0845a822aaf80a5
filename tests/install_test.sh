#!/usr/bin/env bash
# Installs the build tree to a fresh prefix; builds and runs hosts against it with find_package(mobil): hello, one that
# adds its own system, a game with its own Eigen and engine/world.h, and one that only writes pictures. Internal headers
# are not installed; completions and manual pages are.
# Usage: install_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cmake --install "$1" --prefix "$scratch/prefix" >/dev/null
mkdir -p "$scratch/own/engine"
echo 'namespace game { struct World { int cells = 7; }; }' >"$scratch/own/engine/world.h"
cmake -G Ninja -S "$2/tests/consumer" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
  -DHOSTS="$2/demo/hello.cpp;$2/demo/examples/fatigue.cpp;$2/tests/consumer/game_host.cpp" -DOWN_HEADERS="$scratch/own" \
  -DPICTURE_HOST="$2/tests/consumer/picture_host.cpp"
cmake --build "$scratch/build"
"$scratch/build/hello"
"$scratch/build/fatigue"
"$scratch/build/picture_host" "$scratch/grey.png"
if grep -q '^flags.* avx2' /proc/cpuinfo; then
  "$scratch/build/game_host"
else
  echo "game_host not run: this processor has no AVX2"
fi
# A C host needs the C interface alone, also from a prefix that was moved: by find_package, and by pkg-config.
if [ -e "$scratch/prefix/include/mobil/mobil.h" ]; then
  cp -r "$scratch/prefix" "$scratch/moved"
  cmake -G Ninja -S "$2/tests/consumer/c" -B "$scratch/c" -DCMAKE_PREFIX_PATH="$scratch/moved" \
    -DSOURCE="$2/demo/examples/crowd.c" >/dev/null
  cmake --build "$scratch/c" >/dev/null
  "$scratch/c/c_host" >"$scratch/c.txt"
  if command -v pkg-config >/dev/null; then
    PKG_CONFIG_PATH=$(dirname "$(find "$scratch/moved" -name mobil.pc)")
    export PKG_CONFIG_PATH
    grep -q " VERSION $(pkg-config --modversion mobil) " "$2/CMakeLists.txt"
    # shellcheck disable=SC2046
    "${CC:-cc}" "$2/demo/examples/crowd.c" $(pkg-config --cflags --libs mobil) -o "$scratch/pc_host"
    LD_LIBRARY_PATH=$(pkg-config --variable=libdir mobil) "$scratch/pc_host" | diff "$scratch/c.txt" -
  else
    echo "mobil.pc not tried: pkg-config is not there"
  fi
fi
# The version is stored in few places, which agree.
version=$(sed -n 's/^#define MOBIL_VERSION "\(.*\)"/\1/p' "$scratch/prefix/include/mobil/version.h")
grep -q "\"version\": \"$version\"" "$2/systems/javascript/package.json"
grep -q "mobil_library_version(void); /\* \"$version\" \*/" "$2/systems/c/include/mobil/mobil.h"
grep -q "^## \[$version\]" "$2/CHANGELOG.md"
# If the program was built, its completions and manual pages are installed.
if [ -x "$scratch/prefix/bin/mobil" ]; then
  share="$scratch/prefix/share"
  for file in bash-completion/completions/mobil zsh/site-functions/_mobil fish/vendor_completions.d/mobil.fish \
    man/man1/mobil.1 man/man1/mobil-walk.1; do
    [ -s "$share/$file" ] || { echo "share/$file is not installed" >&2; exit 1; }
  done
  diff <("$scratch/prefix/bin/mobil" completion bash) "$share/bash-completion/completions/mobil"
  diff <("$scratch/prefix/bin/mobil" man walk) "$share/man/man1/mobil-walk.1"
fi
# Every header compiles with any flags of a host, and with macros of windows.h. (Its near and far must be undefined.)
for header in "$scratch"/prefix/include/mobil/*.h; do echo "#include <mobil/${header##*/}>"; done >"$scratch/all.cpp"
grep -rh '^#include <' "$scratch/prefix/include/mobil" --include='*.h' | grep -vE '<(mobil|hwy|EGL|GLES)' | sort -u \
  >"$scratch/macros.cpp"
printf '#define %s\n' 'min(a, b) ((a) < (b) ? (a) : (b))' 'max(a, b) ((a) > (b) ? (a) : (b))' IN OUT 'ERROR 0' \
  >>"$scratch/macros.cpp"
cat "$scratch/all.cpp" >>"$scratch/macros.cpp"
"${CXX:-c++}" -std=c++20 -fsyntax-only -I"$scratch/prefix/include" "$scratch/macros.cpp"
"${CXX:-c++}" -std=c++20 -fno-exceptions -fno-rtti -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror \
  -fsyntax-only -I"$scratch/prefix/include" "$scratch/all.cpp"
if grep -rl Eigen "$scratch/prefix/include"; then
  echo "installed headers speak of Eigen, which a host need not have" >&2
  exit 1
fi
find "$scratch/prefix" -name 'libmobil_*.a' -exec nm -C {} + >"$scratch/symbols"
grep -q 'mobil::v[0-9_]*::Simulation::tick' "$scratch/symbols"
[ -s "$scratch/prefix/share/doc/mobil/LICENSE" ]
if grep -q ' Eigen::' "$scratch/symbols"; then
  echo "our libraries have functions of Eigen under its own name, which a host's could stand in for" >&2
  exit 1
fi
if grep -E ' [VW] .*\bfmt::' "$scratch/symbols"; then
  echo "our libraries have these of fmt, which a host's fmt of other flags could stand in for" >&2
  exit 1
fi
for internal in engine/row_hash.h systems/muscles/change_muscles.h systems/gait/balance-inl.h assets/reduction/modal_training.h; do
  [ -f "$2/$internal" ] || { echo "$internal is gone; name another internal header here" >&2; exit 1; }
  [ ! -e "$scratch/prefix/include/mobil/$internal" ] || { echo "$internal is internal and installed" >&2; exit 1; }
done
