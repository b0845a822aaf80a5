#!/usr/bin/env bash
# The Blender add-on (demo/blender), installed from its zip into Debian's Blender without a window, compared with the
# Python package. Exit status 77: skipped.
# Usage: blender_test.sh BUILD_FOLDER SOURCE_FOLDER; BUILD_FOLDER/python is the Python package (target mobil_python)
set -euo pipefail
command -v blender >/dev/null || { echo "skipped: blender is not installed (apt-get install blender)"; exit 77; }
[ -f "$1/python/mobil/libmobil.so" ] || { echo "skipped: $1/python has no package; build the target mobil_python"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export PYTHONDONTWRITEBYTECODE=1 BLENDER_USER_SCRIPTS="$scratch/scripts" BLENDER_USER_CONFIG="$scratch/config"
/usr/bin/python3 "$2/demo/blender/make_zip.py" "$scratch/mobil.zip" "$1/python/mobil/libmobil.so"
PYTHONPATH="$(realpath "$1")/python" blender --background --factory-startup --python-use-system-env --python-exit-code 1 \
  --python "$2/tests/hosts/blender_test.py" -- "$scratch" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
grep -E '^(ok|skipped|measured)' "$scratch/log"
