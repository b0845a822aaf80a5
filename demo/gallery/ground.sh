#!/usr/bin/env bash
# Makes demo/gallery/ground.jpg: up and down stairs, up and down a slope, dressed.
# Usage: demo/gallery/ground.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
inputs=() filter="" row=0
for ground in stairs:16cm/30cm stairs:-16cm/30cm slope:20% slope:-20%; do
  "$program" walk --ground "$ground" --seconds 3 --view skin --frames --muscles quadriceps --method static \
    --out "$scratch/$row" >/dev/null
  line=""
  for k in 0 1 2 3; do
    inputs+=(-i "$scratch/$row/frame_00$((66 + 5 * k)).png")
    filter+="[$((4 * row + k))]crop=440:720:400:0,scale=220:360[p$row$k];"
    line+="[p$row$k]"
  done
  filter+="${line}hstack=4[r$row];"
  row=$((row + 1))
done
filter+="[r0][r1]hstack=2[a];[r2][r3]hstack=2[b];[a][b]vstack=2"
ffmpeg -y -loglevel error "${inputs[@]}" -filter_complex "$filter" -update 1 -frames:v 1 -q:v 4 ground.jpg
