#!/usr/bin/env bash
# Draws all muscles of both legs from four sides. Usage: demo/gallery/muscles.sh; needs ffmpeg. Writes
# demo/gallery/muscles.jpg.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=${MOBIL_PROGRAM:-build/release/mobil}
here=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
inputs=()
for side in front back left right; do
  "$here/$program" walk --height 1.80 --mass 80 --muscles all --method modal --activation phase --seconds 1 --frames \
    --camera "$side:legs" --quiet --out "$work/$side"
  inputs+=(-i "$work/$side/frame_0020.png")
done
ffmpeg -y -loglevel error "${inputs[@]}" -filter_complex \
  "[0]crop=440:720:420:0[a];[1]crop=440:720:420:0[b];[2]crop=440:720:420:0[c];[3]crop=440:720:420:0[d];[a][b][c][d]hstack=4" \
  -q:v 3 "$here/demo/gallery/muscles.jpg"
