#!/usr/bin/env bash
# The site: Doxygen processes every public comment without a warning, every public declaration has one, and every link
# has a target. Also checks the spelling of all committed files if codespell is installed.
# Usage: site_test.sh BUILD_DIR SOURCE_DIR. Exit status 77: skipped.
set -euo pipefail
missing=()
command -v doxygen >/dev/null || missing+=(doxygen)
command -v cmark-gfm >/dev/null || missing+=(cmark-gfm)
if [ ${#missing[@]} -gt 0 ]; then
  echo "${missing[*]} not there (apt-get install ${missing[*]})"
  exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# The packages are installed under some name, because a test installs nothing.
if ! "$2/demo/site/run" --out "$scratch/site" --no-install >"$scratch/said" 2>&1; then
  tail -n 40 "$scratch/said"
  exit 1
fi
cat "$scratch/said"
for page in index.html ARCHITECTURE.html reference/cpp/classmobil_1_1Simulation.html reference/c/mobil_8h.html; do
  [ -s "$scratch/site/$page" ] || { echo "$page was not made"; exit 1; }
done
# A dead link is detected.
sed -i 's|</main>|<a href="nowhere.html#at-all">x</a></main>|' "$scratch/site/index.html"
if "${PYTHON:-/usr/bin/python3}" "$2/demo/site/links.py" "$scratch/site" >"$scratch/said"; then
  echo "a broken link was not found"
  exit 1
fi
grep -q '^index.html: nowhere.html#at-all leads nowhere$' "$scratch/said" || { cat "$scratch/said"; exit 1; }
# A public function without a comment is detected.
mkdir -p "$scratch/bare/mobil"
printf '#pragma once\n// A header.\n\nnamespace mobil {\n\nint bare(int x);\n\n}  // namespace mobil\n' >"$scratch/bare/mobil/bare.h"
cp -r "$2"/systems/c/include/mobil/. "$scratch/bare/mobil/"
if "$2/demo/site/run" --headers "$scratch/bare/mobil" --out "$scratch/bare/site" --no-install >"$scratch/said" 2>&1; then
  echo "a function without a comment was not found"
  exit 1
fi
grep -q 'bare.h:.*bare(int x).*not documented' "$scratch/said" || { cat "$scratch/said"; exit 1; }
if command -v codespell >/dev/null; then
  (cd "$2" && codespell) || { echo "mend these, or name them in .codespellrc"; exit 1; }
else
  echo "codespell is not there: spelling was not looked at"
fi
