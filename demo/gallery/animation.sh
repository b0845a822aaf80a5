#!/usr/bin/env bash
# The README's animation: bulging muscles of a leg next to a crowd. Two strides, 15 pictures a second.
# Usage: demo/gallery/animation.sh PROGRAM [FILE.webp]
set -euo pipefail
program=$(realpath "$1") out=$(realpath -m "${2:-$(dirname "$0")/mobil.webp}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$program" walk --quiet --frames --seconds 2.4 --muscles all --activation moments --out walk >/dev/null
"$program" crowd --quiet --people 2000 --seconds 0.1 --seed 3 --frames 63 --capture crowd >/dev/null
ffmpeg -y -loglevel error -framerate 30 -i walk/frame_%04d.png -framerate 30 -i crowd/frame_%04d.png -filter_complex \
  "[0:v]crop=300:400:420:300,scale=330:440[leg];[1:v]crop=1440:1080:400:0,scale=586:440[crowd];[leg][crowd]hstack,fps=15" \
  -frames:v 31 -c:v libwebp_anim -quality 60 -compression_level 6 -loop 0 "$out"
