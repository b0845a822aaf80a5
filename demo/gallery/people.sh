#!/usr/bin/env bash
# Makes demo/gallery/people.jpg: eight people of 6 to 85 years, walking from ahead and from the side, and standing.
# All are drawn equally tall, so that proportions can be compared.
# Usage: demo/gallery/people.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
people=("--sex man --age 6 --typical" "--sex woman --age 10 --typical" "--sex man --age 14 --typical"
  "--sex woman --age 25 --height 1.66m --mass 49kg" "--sex man --age 25" "--sex woman --age 45 --height 1.62m --mass 88kg"
  "--sex man --age 70 --typical" "--sex woman --age 85 --typical")
printf 'time_s,parameter,value\n0,stop,\n' >"$scratch/stand.csv"
# view NAME FRAME OPTIONS…: one row
rows=()
view() {
  local name=$1 frame=$2 inputs=() crops="" joined=""
  shift 2
  for i in "${!people[@]}"; do
    # shellcheck disable=SC2086
    "$program" walk ${people[i]} "$@" --quiet --view skin --frames --out "$scratch/$name$i" >/dev/null
    inputs+=(-i "$scratch/$name$i/frame_$frame.png")
    crops+="[$i]crop=360:700:460:20[c$i];"
    joined+="[c$i]"
  done
  ffmpeg -y -loglevel error "${inputs[@]}" -filter_complex "$crops${joined}hstack=8" -update 1 -frames:v 1 "$scratch/$name.png"
  rows+=(-i "$scratch/$name.png")
}
view front 0012 --seconds 0.45 --camera front
view side 0012 --seconds 0.45 --camera right
view stand 0059 --seconds 2 --script "$scratch/stand.csv" --camera front-right
ffmpeg -y -loglevel error "${rows[@]}" -filter_complex "vstack=3,scale=1920:-2" -q:v 4 -update 1 -frames:v 1 people.jpg
