#!/usr/bin/env bash
# Common mistakes of hosts are refused by the compiler in few lines, one of which names the remedy.
# Usage: mistakes_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
log=$(mktemp)
trap 'rm -f "$log"' EXIT
headers=("$2"/{components,engine,assets,systems}/include)
for mistake in "$2"/tests/consumer/mistakes/*.cpp; do
  says=$(sed -n '1s,^// SAYS: ,,p' "$mistake")
  [ -n "$says" ] || { echo "$mistake does not begin with // SAYS:" >&2; exit 1; }
  if "${CXX:-c++}" -std=c++20 -fsyntax-only "${headers[@]/#/-I}" "$mistake" >"$log" 2>&1; then
    echo "$mistake compiles" >&2
    exit 1
  fi
  if ! grep -qF "$says" "$log" || [ "$(wc -l <"$log")" -gt 40 ]; then
    cat "$log" >&2
    echo "$mistake: no line says '$says', or there are more than 40" >&2
    exit 1
  fi
done
