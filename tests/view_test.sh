#!/usr/bin/env bash
# `mobil view` on a virtual display: it opens, walks, and shows its panel in a picture. Without a display it reports
# that.
# Usage: view_test.sh BUILD_FOLDER SOURCE_FOLDER PROGRAM. Exit status 77: skipped.
set -euo pipefail
command -v Xvfb >/dev/null || { echo "Xvfb is not there (apt-get install xvfb xauth)"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
if env -u DISPLAY -u WAYLAND_DISPLAY "$3" view --seconds 1 2>"$scratch/said"; then
  echo "it opened a window without a display"
  exit 1
elif [ $? -ne 2 ] || [ "$(wc -l <"$scratch/said")" -ne 1 ] || ! grep -q '^mobil view: no window: .*display' "$scratch/said"; then
  cat "$scratch/said"
  exit 1
fi
# LeakSanitizer sometimes crashes in Mesa's threads, which end with the window.
export ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0
xvfb-run -a -s "-screen 0 800x600x24" "$3" view --seconds 1 --people 20 --width 760 --height-px 500 \
  --capture "$scratch/view.png"
ffmpeg -v error -i "$scratch/view.png" -f rawvideo -pix_fmt gray "$scratch/grey"
# The panel is dark, the sky above the ground is light, and in the middle a person contrasts with it.
/usr/bin/python3 - "$scratch/grey" <<'P'
import sys
grey = open(sys.argv[1], 'rb').read()
assert len(grey) == 760 * 500, len(grey)
row = lambda y, a, b: grey[760 * y + a:760 * y + b]
mean = lambda b: sum(b) / len(b)
panel = mean(b''.join(row(y, 20, 300) for y in range(300, 480)))
sky = mean(b''.join(row(y, 330, 420) for y in range(5, 40)))
middle = b''.join(row(y, 340, 440) for y in range(150, 420))
assert panel < 90 < sky, (panel, sky)
assert max(middle) - min(middle) > 100, (min(middle), max(middle))
P
