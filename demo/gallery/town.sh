#!/usr/bin/env bash
# Makes demo/gallery/town.jpg: the town from above.
# Usage: demo/gallery/town.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$program" town --seconds 25 --view above --capture "$scratch/town.png" >/dev/null
ffmpeg -y -loglevel error -i "$scratch/town.png" -update 1 -frames:v 1 -q:v 4 town.jpg
