#!/usr/bin/env bash
# The project's symbols. libmobil_core.so exports only its namespace, and a host runs with it. A host's own shared
# library that links the archives exports none of their symbols. Two versions can be used in one program.
# Usage: linking_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
compile=("${CXX:-c++}" -std=c++20 -O1)
archives=("$1"/libmobil_systems.a "$1"/libmobil_assets.a "$1"/libmobil_engine.a)
others=(-lfmt -lhwy -lmeshoptimizer)

nm -D --defined-only -C "$1/libmobil_core.so" | cut -d' ' -f3- >"$scratch/exported"
grep -q '^mobil::.*::Simulation::tick' "$scratch/exported"
if grep -vE '^(mobil::|mobil_v[0-9_]+$|(vtable|typeinfo|typeinfo name) for mobil::)' "$scratch/exported" | sed 's/@.*//' |
  grep -vE '^mobil_v[0-9_]+$' | grep .; then
  echo "libmobil_core.so exports these, which are not ours" >&2
  exit 1
fi
cmake --install "$1" --prefix "$scratch/prefix" >/dev/null
"${compile[@]}" -I"$scratch/prefix/include" "$2/demo/hello.cpp" "$1/libmobil_core.so" -Wl,-rpath,"$1" -o "$scratch/hello"
"$scratch/hello" >"$scratch/hello.txt"
ldd "$scratch/hello" >"$scratch/libraries"
grep -q libmobil_core.so "$scratch/libraries"

cat >"$scratch/plugin.cpp" <<'CPP'
#include <mobil/simulation.h>
extern "C" unsigned long long hash_of_a_step() {
  mobil::Simulation simulation;
  const auto person = simulation.spawn({.height_m = 1.7F, .mass_kg = 70});
  (void)simulation.set_muscles(*person);
  for (int i = 0; i < 30; ++i) simulation.tick();
  return simulation.state_hash();
}
CPP
cmake -G Ninja -S "$2/tests/consumer" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" -DHOSTS= \
  -DPLUGIN="$scratch/plugin.cpp" >/dev/null
cmake --build "$scratch/build" >/dev/null
# (Template instances made by its own source are weak, and its own.)
nm -D --defined-only -C "$scratch/build/libplugin.so" >"$scratch/of_plugin"
grep -q ' T hash_of_a_step' "$scratch/of_plugin"
if grep ' [A-U] .*mobil::' "$scratch/of_plugin"; then
  echo "a host's shared library exports these of ours" >&2
  exit 1
fi

# A host whose standard containers differ fails to link, and the linker says why.
printf '#include <mobil/simulation.h>\nint main() { return mobil::Simulation().ticks(); }\n' >"$scratch/containers.cpp"
if "${compile[@]}" -D_GLIBCXX_DEBUG -I"$scratch/prefix/include" "$scratch/containers.cpp" "${archives[@]}" "${others[@]}" \
  -o "$scratch/containers" 2>"$scratch/refused"; then
  echo "a host with _GLIBCXX_DEBUG links" >&2
  exit 1
fi
grep -q "library_is_built_with_GLIBCXX_DEBUG" "$scratch/refused"
"${compile[@]}" -I"$scratch/prefix/include" "$scratch/containers.cpp" "${archives[@]}" "${others[@]}" -o "$scratch/containers"
"$scratch/containers"

# A host with -ffast-math, whose own arithmetic cannot find NaN, has invalid times refused.
cat >"$scratch/fast.cpp" <<'CPP'
#include <cstdlib>
#include <mobil/simulation.h>
int main() {
  mobil::Simulation simulation;
  for (const char* text : {"nan", "-1", "inf"})
    if (simulation.advance(std::strtod(text, nullptr)).valid) return 1;
  return simulation.advance(0.1).count == 6 ? 0 : 2;
}
CPP
"${compile[@]}" -ffast-math -I"$scratch/prefix/include" "$scratch/fast.cpp" "${archives[@]}" "${others[@]}" -o "$scratch/fast"
"$scratch/fast"

# Another version: the same archives and headers under another name.
mkdir "$scratch/other"
cp -r "$scratch/prefix/include" "$scratch/other/include"
version=$(sed -n 's/^namespace mobil::inline \(v[0-9_]*\) .*/\1/p' "$scratch/prefix/include/mobil/simulation.h")
other=$(echo "$version" | tr '0-9' '9')
find "$scratch/other/include" -name '*.h' -exec sed -i "s/namespace mobil::inline $version/namespace mobil::inline $other/" {} +
nm "${archives[@]}" | sed -n "s/.* \([^ ]*5mobil${#version}$version[^ ]*\)$/\1/p" | sort -u |
  awk -v a="5mobil${#version}$version" -v b="5mobil${#other}$other" \
  '{renamed = $1; gsub(a, b, renamed); print $1, renamed}' >"$scratch/renamed"
for archive in "${archives[@]}"; do objcopy --redefine-syms="$scratch/renamed" "$archive" "$scratch/other/${archive##*/}"; done
sed 's/hash_of_a_step/hash_of_another_step/' "$scratch/plugin.cpp" >"$scratch/another.cpp"
"${compile[@]}" -c -I"$scratch/prefix/include" "$scratch/plugin.cpp" -o "$scratch/one.o"
"${compile[@]}" -c -I"$scratch/other/include" "$scratch/another.cpp" -o "$scratch/another.o"
cat >"$scratch/both.cpp" <<'CPP'
extern "C" unsigned long long hash_of_a_step();
extern "C" unsigned long long hash_of_another_step();
int main() { return hash_of_a_step() == hash_of_another_step() ? 0 : 1; }
CPP
"${compile[@]}" "$scratch/both.cpp" "$scratch/one.o" "$scratch/another.o" "${archives[@]}" \
  "${archives[@]/#$1/$scratch/other}" "${others[@]}" -o "$scratch/both"
nm -C "$scratch/both" >"$scratch/symbols"
for name in "$version" "$other"; do grep -q "mobil::$name::Simulation::tick" "$scratch/symbols"; done
"$scratch/both"
