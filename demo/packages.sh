# Sourced by demo/run and tests/run: lists of the Debian packages that each needs, and functions that install missing
# ones. Expects set -euo pipefail in the caller.

walk_packages="g++ cmake ninja-build libeigen3-dev libhwy-dev libexpected-dev libfmt-dev
  libmeshoptimizer-dev libcli11-dev nlohmann-json3-dev libtinygltf-dev libpng-dev libegl-dev libgles-dev libegl1
  libgles2 libgl1-mesa-dri ffmpeg"
crowd_packages="libgl-dev libglfw3-dev libimgui-dev librecast-dev"  # mobil-lab needs them too
rivals_packages="libbullet-dev"
build_packages="$walk_packages $crowd_packages $rivals_packages"
test_packages="libassimp-dev libgtest-dev librapidcheck-dev libspectra-dev libboost-dev calculix-ccx
  python3-numpy python3-cffi python3-venv python3-yaml xvfb xauth"
cluster_packages="libopenmpi-dev openmpi-bin"
hosts_packages="blender libogre-1.12-dev godot3 xvfb xauth"  # programs of tests/hosts
# Documents as pages and the reference (demo/site/run); the spelling checker, which its test uses if installed.
site_packages="python3 doxygen cmark-gfm"
spelling_packages="codespell"

# For browsers (demo/web/run), and to check that other machines compute the same results (tests/portable/run).
web_packages="cmake ninja-build clang-19 lld-19 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32
  wasi-libc libeigen3-dev libhwy-dev libexpected-dev libfmt-dev"
arm_packages="g++-aarch64-linux-gnu qemu-user"
windows_packages="g++-mingw-w64-x86-64-posix wine64 clang lld llvm googletest"

# need PACKAGE…: installs missing packages through apt; for a user other than root, prints the command to run and fails.
need() {
  local missing=() p
  for p in "$@"; do
    dpkg-query -W -f='${Status}' "$p" 2>/dev/null | grep -q '^install ok installed' || missing+=("$p")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  if [ "$(id -u)" -ne 0 ]; then
    echo "missing packages; as root, run:  apt-get install -y ${missing[*]}" >&2
    return 1
  fi
  if ! quietly "install ${#missing[@]} packages" apt_install "${missing[@]}"; then
    echo "apt-get install failed; check the network and apt sources, then run this again" >&2
    return 1
  fi
}

apt_install() {
  apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
}

# debian_source PACKAGE: prints the folder with a Debian package's sources, which it downloads through apt the first time.
# Call it in an assignment of its own, sources=$(debian_source NAME), so that a failure ends the script.
debian_source() {
  local folder="$PWD/build/sources/$1" part="$PWD/build/sources/$1.part" file apt
  if [ ! -d "$folder" ]; then
    need xz-utils >&2 || return 1
    rm -rf "$part"
    mkdir -p "$part/lists" || return 1
    cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null | grep -v cdrom: |
      sed -n 's/^[[:space:]]*deb[[:space:]]/deb-src /p' >"$part/all.list"
    for file in /etc/apt/sources.list.d/*.sources; do
      [ ! -f "$file" ] || sed 's/^Types:.*/Types: deb-src/' "$file" >"$part/$(basename "$file")" || return 1
    done
    apt=(-q -o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$part" -o "Dir::State::Lists=$part/lists"
      -o "APT::Sandbox::User=$(id -un)")
    quietly "find sources of $1" apt-get "${apt[@]}" update >&2 || return 1
    (cd "$part" && apt-get "${apt[@]}" --download-only source "$1") >&2 || return 1
    tar xf "$part/$1"_*.orig.tar.?z -C "$part" --strip-components=1 || return 1
    mv "$part" "$folder" || return 1
  fi
  echo "$folder"
}

# step_of LOG: prints the progress of ninja, ctest or apt from its log, such as "37 of 112"; empty for other commands.
step_of() {
  awk '/^\[[0-9]+\/[0-9]+\]/ { split($1, n, /[][\/]/); step = n[2] " of " n[3] }
    /^ *[0-9]+\/[0-9]+ Test / { split($1, n, "/"); step = n[1] " of " n[2] }
    / newly installed/ { of = $3 }
    /^Get:/ { step = "download " ++got (of ? " of " of : "") }
    / newly installed/ { got = 0 }
    /^Unpacking / { step = "unpack " ++unpacked " of " of }
    /^Setting up / { step = "set up " ++ready " of " of }
    END { print step }' "$1" 2>/dev/null
}

# progress NAME LOG prints lines such as "build: 37 of 112, 41 s" until it is killed or its parent has ended. On a
# terminal it replaces the line each second; elsewhere it prints one each ten seconds.
progress() {
  local started=$SECONDS step next=1 for_s
  while kill -0 $$ 2>/dev/null; do
    for_s=$((SECONDS - started)) step=$(step_of "$2")
    if [ -t 1 ]; then
      printf '\r\033[K%s: %s%d s' "$1" "${step:+$step, }" "$for_s"
    elif [ "$for_s" -ge "$next" ]; then
      echo "$1: ${step:+$step, }$for_s s"
      next=$((for_s + 10))
    fi
    sleep 1 >/dev/null 2>&1
  done
}

# quietly NAME COMMAND…: runs a long step and shows its progress; on failure, the end of its log and the log's path.
quietly() {
  local name=$1 log started=$SECONDS status=0 watcher
  shift
  mkdir -p build/log
  log=build/log/${name// /_}.log
  : >"$log"
  progress "$name" "$log" &
  watcher=$!
  "$@" >"$log" 2>&1 || status=$?
  kill "$watcher" 2>/dev/null || true
  wait "$watcher" 2>/dev/null || true
  [ ! -t 1 ] || printf '\r\033[K'
  if [ "$status" -ne 0 ]; then
    tail -n 40 "$log" >&2
    echo "$name failed; the whole log is in $log" >&2
    return 1
  fi
  echo "$name: $((SECONDS - started)) s"
}
