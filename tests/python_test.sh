#!/usr/bin/env bash
# The Python package with Debian's Python: its tests, the lines of its README with their documented output, and a wheel
# of it, which works in another place.
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
if ! /usr/bin/python3 -c 'import setuptools, wheel' 2>/dev/null; then
  echo "no wheel made: python3-setuptools or python3-wheel is not there"
  exit 0
fi
cp -r "$1/python" "$scratch/package"
(cd "$scratch/package" && /usr/bin/python3 setup.py -q bdist_wheel >"$scratch/wheel.log" 2>&1) || { cat "$scratch/wheel.log"; exit 1; }
wheel=$(echo "$scratch"/package/dist/mobil-*-py3-none-linux_*.whl)
(cd "$scratch" && /usr/bin/python3 -m zipfile -e "$wheel" "$scratch/installed")
(cd / && PYTHONPATH="$scratch/installed" /usr/bin/python3 -m doctest "$scratch/package/README.md")
