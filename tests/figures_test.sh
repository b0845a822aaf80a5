#!/usr/bin/env bash
# Speed tables in documents are those that demo/lab/bench/make_tables.py writes from committed files. A figure changed
# by hand, or a file whose table was not updated, is detected.
# Usage: figures_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
make_tables=$2/demo/lab/bench/make_tables.py
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
python3 "$make_tables" --check

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch/demo/lab/bench"
cp -r "$2/demo/lab/bench/figures" "$2/demo/lab/bench/README.md" "$scratch/demo/lab/bench/"
check() { python3 "$make_tables" --root "$scratch" --check >"$scratch/said" 2>&1; }
check
document=$scratch/demo/lab/bench/README.md

# a figure is changed by hand
sed -i '/^<!-- figures: people/,/^<!-- end/ s/\([0-9]\) µs/\17 µs/' "$document"
if check; then echo "a changed figure is not found" >&2; exit 1; fi
grep -q '^-| .* µs' "$scratch/said"

# after an update, it is as before
python3 "$make_tables" --root "$scratch" >/dev/null
cmp "$document" "$2/demo/lab/bench/README.md"

# a file changes without its document
sed -i 's/"value": \([0-9]\)/"value": 9\1/' "$scratch"/demo/lab/bench/figures/*.json
if check; then echo "a changed file is not found" >&2; exit 1; fi

# an unknown table
cp "$2"/demo/lab/bench/figures/*.json "$scratch/demo/lab/bench/figures/"
printf '<!-- figures: nothing -->\n<!-- end -->\n' >"$scratch/other.md"
if check; then echo "an unknown table is not refused" >&2; exit 1; fi
grep -q "other.md: there is no table 'nothing'" "$scratch/said"
