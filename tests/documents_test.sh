#!/usr/bin/env bash
# Checks documents: every ```cpp block with a main compiles against the installed package and exits with 0, every
# `mobil …` line of an ```sh block exits with 0, and every link and #anchor has a target.
# A comment <!-- not run: why --> directly before a block excludes it.
# Usage: documents_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$(realpath "$1") source=$(realpath "$2")
command -v python3 >/dev/null || { echo "python3 is not here; skipped"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Checks links, and writes blocks to $scratch/cpp/NAME.cpp and $scratch/sh/NAME.
python3 - "$source" "$scratch" <<'PYTHON'
import os, pathlib, re, sys

source, scratch = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
(scratch / "cpp").mkdir()
(scratch / "sh").mkdir()
rooms = ["assets", "components", "demo", "engine", "systems", "tests"]
files = sorted(source.glob("*.md")) + sorted(
    file for room in rooms for file in (source / room).rglob("*.md") if "node_modules" not in file.parts)
faults, links = [], 0


def blocks(text):
    """Fenced blocks: language, lines, whether they are to be run; and the text without them."""
    found, outside, fence, comment = [], [], None, ""
    for line in text.split("\n"):
        if fence is None and line.startswith("```"):
            fence = (line[3:].strip(), [], not comment.startswith("<!-- not run: "))
        elif fence is not None and line.startswith("```"):
            found.append(fence)
            fence = None
            comment = ""
        elif fence is not None:
            fence[1].append(line)
        else:
            outside.append(line)
            if line.strip():
                comment = line.strip()
    return found, outside, fence is not None


def anchors(file):
    """As GitHub makes them of headings."""
    seen, names = {}, set()
    for line in blocks(file.read_text(encoding="utf-8"))[1]:
        heading = re.match(r"#{1,6} +(.*?)\s*#*$", line)
        if not heading:
            continue
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1])
        name = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
        count = seen.get(name, 0)
        seen[name] = count + 1
        names.add(name if count == 0 else f"{name}-{count}")
    return names


for file in files:
    name = file.relative_to(source)
    fenced, outside, is_open = blocks(file.read_text(encoding="utf-8"))
    if is_open:
        faults.append(f"{name}: a ``` block has no end")
    prose = re.sub(r"`[^`\n]*`", "", "\n".join(line for line in outside if not line.startswith("    ")))
    for target in re.findall(r"\]\(([^()\s]+)\)", prose):
        if re.match(r"[a-z][a-z+.-]*:", target):
            continue
        links += 1
        path, _, anchor = target.partition("#")
        to = file if not path else pathlib.Path(os.path.normpath(file.parent / path))
        if not to.exists():
            faults.append(f"{name}: {target} is not there")
        elif not to.is_relative_to(source):
            faults.append(f"{name}: {target} lies outside of the project")
        elif anchor and (to.suffix != ".md" or anchor not in anchors(to)):
            faults.append(f"{name}: {target} has no such heading")
    stem = re.sub(r"\W+", "_", str(name.with_suffix("")))
    programs = [lines for language, lines, run in fenced if language == "cpp" and run and any("int main" in l for l in lines)]
    for number, lines in enumerate(programs):
        (scratch / "cpp" / f"{stem}_{number}.cpp").write_text("\n".join(lines) + "\n", encoding="utf-8")
    commands = []
    for language, lines, run in fenced:
        if language == "sh" and run:
            commands += [l for l in "\n".join(lines).replace("\\\n", " ").split("\n") if l.startswith("mobil ")]
    if commands:
        (scratch / "sh" / stem).write_text("\n".join(commands) + "\n", encoding="utf-8")

for fault in faults:
    print(fault, file=sys.stderr)
print(f"{len(files)} documents, {links} links")
sys.exit(1 if faults else 0)
PYTHON

# Programs: one host project that uses the installed package.
cmake --install "$build" --prefix "$scratch/prefix" >/dev/null
cat >"$scratch/cpp/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(documents LANGUAGES CXX)
find_package(mobil CONFIG REQUIRED COMPONENTS systems OPTIONAL_COMPONENTS import)
file(GLOB sources *.cpp)
foreach(source ${sources})
  get_filename_component(name ${source} NAME_WE)
  file(STRINGS ${source} imports REGEX "^#include <mobil/(fit_anatomy|mesh_file)\\.h>")
  if(imports AND NOT TARGET mobil::import)
    message(STATUS "${name} left out: this build has no mobil::import")
    continue()
  endif()
  add_executable(${name} ${source})
  target_link_libraries(${name} PRIVATE mobil::systems)
  if(imports)
    target_link_libraries(${name} PRIVATE mobil::import)
  endif()
endforeach()
CMAKE
cmake -G Ninja -S "$scratch/cpp" -B "$scratch/cpp/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" >/dev/null
cmake --build "$scratch/cpp/build"
mkdir "$scratch/run"
cd "$scratch/run"
for program in "$scratch"/cpp/*.cpp; do
  program=${program##*/} program=${program%.cpp}
  [ -x "$scratch/cpp/build/$program" ] || continue
  echo "$program"
  timeout 60 "$scratch/cpp/build/$program" || { echo "$program: exit status $?" >&2; exit 1; }
done

# Commands: those of a document in order, in a folder of their own; two documents in parallel.
if [ ! -x "$build/mobil" ]; then
  echo "this build has no program; its commands are left out"
  exit 0
fi
mkdir "$scratch/bin"
ln -s "$build/mobil" "$scratch/bin/mobil"
export PATH="$scratch/bin:$PATH" XDG_CACHE_HOME="$scratch/cache"  # keeps the user's cache unchanged
commands_of() {  # commands_of DOCUMENT FOLDER
  mkdir "$2"
  cd "$2"
  local command started
  while IFS= read -r command; do
    started=$EPOCHREALTIME
    if ! timeout 100 bash -c "$command" </dev/null >said 2>&1; then
      echo "${1##*/}: does not end with 0: $command" >&2
      tail -20 said >&2
      exit 1
    fi
    awk -v a="$started" -v b="$EPOCHREALTIME" -v c="$command" 'BEGIN { printf "%5.1f s  %s\n", b - a, c }'
  done <"$1"
}
export -f commands_of
for document in "$scratch"/sh/*; do echo "$document $scratch/run/${document##*/}"; done |
  xargs -P 2 -L 1 bash -c 'set -euo pipefail; commands_of "$0" "$1"'
