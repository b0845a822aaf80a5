#!/usr/bin/env bash
# Installs the build tree to a fresh prefix; builds and runs hosts against it with find_package(mobil): hello, and one
# that adds a system of its own. Internal headers are not installed.
# Usage: install_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cmake --install "$1" --prefix "$scratch/prefix" >/dev/null
cmake -G Ninja -S "$2/tests/consumer" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" -DHOSTS="$2/demo/hello.cpp;$2/demo/examples/fatigue.cpp"
cmake --build "$scratch/build"
"$scratch/build/hello"
"$scratch/build/fatigue"
for internal in engine/row_hash.h systems/muscles/change_muscles.h systems/gait/balance-inl.h assets/reduction/reduced_training.h; do
  [ -f "$2/$internal" ] || { echo "$internal is gone; name another internal header here" >&2; exit 1; }
  [ ! -e "$scratch/prefix/include/mobil/$internal" ] || { echo "$internal is internal and installed" >&2; exit 1; }
done
