#!/usr/bin/env bash
# Makes demo/gallery/builds.png: four builds at one instant of a walk, dressed, side by side.
# Usage: demo/gallery/builds.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
walk() {  # walk NAME OPTIONS…
  local name=$1
  shift
  "$program" walk "$@" --seconds 0.45 --view skin --frames --out "$scratch/$name" >/dev/null
}
walk 1 --height 1.80m --mass 60kg
walk 2 --height 1.70m --mass 58kg --sex woman
walk 3 --height 1.85m --mass 120kg
walk 4 --height 1.62m --mass 88kg --sex woman
inputs=()
for i in 1 2 3 4; do inputs+=(-i "$scratch/$i/frame_0012.png"); done
ffmpeg -y -loglevel error "${inputs[@]}" -filter_complex \
  "[0]crop=380:720:400:0[a];[1]crop=380:720:400:0[b];[2]crop=380:720:400:0[c];[3]crop=380:720:400:0[d];[a][b][c][d]hstack=4" \
  -update 1 -frames:v 1 builds.png
