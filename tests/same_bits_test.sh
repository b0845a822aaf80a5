#!/usr/bin/env bash
# Compares this machine with the hashes of tests/portable: hashes.txt, which ARM and browsers share, and skins.txt, which
# Windows shares (tests/portable/run). Skins are those of meshoptimizer 0.18 on x86-64.
# Usage: same_bits_test.sh BUILD_FOLDER SOURCE_FOLDER. Exit status 77: skipped.
set -euo pipefail
if [ -r /proc/cpuinfo ] && [ "$(uname -m)" = x86_64 ] && ! grep -qw fma /proc/cpuinfo; then
  echo "this processor does not fuse multiply-adds: its bits are others"
  exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
of_skins=
[ "$(uname -m)" != x86_64 ] || ! grep -qs 'MESHOPTIMIZER_VERSION 180' /usr/include/meshoptimizer.h || of_skins=skins
for of in hashes $of_skins; do
  cc -std=c89 -Wall -Wextra -pedantic -Werror -ffp-contract=off -I"$2/systems/c/include" "$2/tests/portable/$of.c" -o "$scratch/$of" \
    -L"$1" -lmobil -Wl,-rpath,"$1"
  "$scratch/$of" | diff "$2/tests/portable/$of.txt" -
done
