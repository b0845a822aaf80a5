#!/usr/bin/env bash
# The Python package with Debian's Python: its tests, the lines of its README with their documented output, and a wheel
# of it, which pip installs without a network and which works in another place.
# Usage: python_test.sh BUILD_FOLDER SOURCE_FOLDER PROGRAM. Exit status 77: skipped.
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export PYTHONDONTWRITEBYTECODE=1
PYTHONPATH="$1/python" /usr/bin/python3 "$2/tests/c/python_test.py" "$3"
for tested in values objects; do
  PYTHONPATH="$1/python" /usr/bin/python3 "$2/tests/c/python_${tested}_test.py"
done
PYTHONPATH="$1/python" /usr/bin/python3 -m doctest "$2/systems/python/README.md"
if ! /usr/bin/python3 -c 'import venv, ensurepip' 2>/dev/null; then
  echo "no wheel made: python3-venv is not there"
  exit 0
fi
/usr/bin/python3 -m venv --system-site-packages "$scratch/venv"
library=$1/libmobil.so
MOBIL_LIBRARY=$library PIP_NO_INDEX=1 "$scratch/venv/bin/pip" -q --disable-pip-version-check install --no-build-isolation "$2"
(cd / && "$scratch/venv/bin/python" -m doctest "$2/systems/python/README.md")
files=$("$scratch/venv/bin/pip" --disable-pip-version-check show -f mobil)
for file in licenses/LICENSE licenses/fmt licenses/highway mobil/libmobil.so mobil/c/lod.h; do
  grep -q "$file" <<<"$files" || { echo "the wheel has no $file" >&2; exit 1; }
done
# Its tag is linux_… if it needs other libraries than each system has, and else names the newest glibc of its symbols.
wheel=$(cd "$scratch" && MOBIL_LIBRARY=$library PYTHONPATH="$2/systems/python" /usr/bin/python3 -B -c \
  'import build_wheel; print(build_wheel.build_wheel("."))' 2>/dev/null)
if readelf -d "$library" | grep NEEDED | grep -qvE '\[(lib(c|m|stdc\+\+|gcc_s|pthread)\.so|ld-linux)'; then
  [[ $wheel == *-linux_*.whl ]]
else
  glibc=$(readelf -V "$library" | grep -oE 'Name: GLIBC_2\.[0-9]+' | sort -t. -k2 -n | tail -1 | cut -d. -f2)
  [[ $wheel =~ manylinux_2_([0-9]+)_ ]] && [ "${BASH_REMATCH[1]}" -ge "$glibc" ]
fi
