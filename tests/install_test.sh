#!/usr/bin/env bash
# Installs the build tree to a fresh prefix and builds and runs demo/hello.cpp against it with find_package(mobil).
# Usage: install_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cmake --install "$1" --prefix "$scratch/prefix" >/dev/null
cmake -G Ninja -S "$2/tests/consumer" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" -DHELLO_SOURCE="$2/demo/hello.cpp"
cmake --build "$scratch/build"
"$scratch/build/hello"
