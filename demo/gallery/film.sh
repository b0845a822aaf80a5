#!/usr/bin/env bash
# A film of two minutes that shows all of mobil. Making it takes 15 minutes without a graphics card.
# Usage: demo/gallery/film.sh PROGRAM [FILM.mp4]; FILM.mp4 has English subtitles as a track of their own.
set -euo pipefail
program=$(realpath "$1") gallery=$(cd "$(dirname "$0")" && pwd)
film=$(realpath -m "${2:-mobil.mp4}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
parts=() begin_s=0 number=0

# part SECONDS FILE SUBTITLE: appends a part, at 1280 x 720 and 30 pictures a second.
part() {
  local name
  name=$(printf 'part_%02d.mp4' "$number")
  ffmpeg -y -loglevel error -i "$2" -t "$1" -an -r 30 -vf "scale=1280:720:force_original_aspect_ratio=decrease,pad=1280:720:(ow-iw)/2:(oh-ih)/2" \
    -c:v libx264 -preset veryfast -crf 20 -pix_fmt yuv420p "$name"
  parts+=("$name")
  number=$((number + 1))
  printf '%d\n00:%02d:%02d,200 --> 00:%02d:%02d,800\n%s\n\n' "$number" $((begin_s / 60)) $((begin_s % 60)) \
    $(((begin_s + $1 - 1) / 60)) $(((begin_s + $1 - 1) % 60)) "$3" >>film.srt
  begin_s=$((begin_s + $1))
  echo "$begin_s s: $3"
}
# walk SECONDS SUBTITLE OPTIONS…
walk() {
  local seconds=$1 subtitle=$2
  shift 2
  rm -rf walk
  "$program" walk --quiet --video --seconds "$seconds" --out walk "$@" >/dev/null
  part "$seconds" walk/walk.mp4 "$subtitle"
}
# still SECONDS SUBTITLE PICTURE
still() {
  ffmpeg -y -loglevel error -loop 1 -i "$3" -t "$1" -r 30 -pix_fmt yuv420p -vf "scale=trunc(iw/2)*2:trunc(ih/2)*2" still.mp4
  part "$1" still.mp4 "$2"
}

walk 10 "Height, mass and speed go in. A walking skeleton and muscles that deform come out." --height 1.80 --mass 80 --speed 5km/h
walk 8 "A stick figure: 48 segments, and the quadriceps' line of action." --view stick --muscles quadriceps
walk 6 "The muscles under the skin." --view glass --sex woman --height 1.68 --mass 62
walk 6 "Taller, heavier, faster." --view skin --height 1.92 --mass 105 --speed 6.5km/h
walk 7 "Up stairs of 16 and 30 cm." --view skin --ground stairs:16cm/30cm
walk 7 "Down a slope of a fifth." --view skin --sex woman --height 1.66 --mass 60 --ground slope:-20%
"$program" town --quiet --seconds 46 --capture town.mp4 >/dev/null
part 46 town.mp4 "A town: places to go, ways by Recast, avoidance, kerbs, stairs and a ramp."
"$program" town --quiet --people 120 --seconds 17 --view above --seed 4 --capture above.mp4 >/dev/null
part 17 above.mp4 "A hundred and twenty people, from above."
"$program" crowd --quiet --people 2000 --seconds 0.1 --seed 3 --frames 150 --capture crowd >/dev/null
ffmpeg -y -loglevel error -framerate 30 -i crowd/frame_%04d.png -c:v libx264 -preset veryfast -pix_fmt yuv420p crowd.mp4
part 5 crowd.mp4 "Two thousand who are all different; of the nearest the muscles are simulated."
still 4 "Up and down, step by step." "$gallery/ground.jpg"
still 4 "A million alive, ten thousand in view." "$gallery/city.jpg"

printf "file '%s'\n" "${parts[@]}" >parts.txt
ffmpeg -y -loglevel error -f concat -safe 0 -i parts.txt -i film.srt -map 0:v -map 1:s -c:v copy -c:s mov_text \
  -metadata:s:s:0 language=eng -movflags +faststart film.mp4
mv film.mp4 "$film"
echo "written $film: $begin_s s"
