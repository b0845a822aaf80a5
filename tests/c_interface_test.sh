#!/usr/bin/env bash
# The C interface as C programs have it: the header is C89 and C++, a C89 program runs with libmobil.so, which exports
# what the header declares and nothing else.
# Usage: c_interface_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
warnings=(-Wall -Wextra -Wconversion -Wstrict-prototypes -Werror)
"${CC:-cc}" -std=c89 -pedantic-errors "${warnings[@]}" -I"$1/include" "$2/demo/examples/crowd.c" "$1/libmobil.so" \
  -Wl,-rpath,"$1" -o "$scratch/crowd"
"$scratch/crowd"
echo '#include <mobil/mobil.h>' | "${CXX:-c++}" -std=c++98 -pedantic-errors -Wall -Wextra -Werror -I"$1/include" -fsyntax-only -x c++ -
nm -D --defined-only "$1/libmobil.so" | awk '$2 ~ /[TDBRVW]/ {print $3}' | sed 's/@.*//' | sort >"$scratch/exported"
tr '\n' ' ' <"$2/systems/c/mobil.h" | grep -oE 'MOBIL_API [^;(]*\(' | grep -oE 'mobil_[a-z_]+\($' | tr -d '(' | sort >"$scratch/declared"
[ "$(wc -l <"$scratch/declared")" -gt 40 ]
diff "$scratch/declared" "$scratch/exported"
