# Sourced by demo/run and tests/run: the Debian packages each needs, and how they are installed when missing.
# Sets nothing but functions; the caller has set -euo pipefail.

build_packages="g++ cmake ninja-build libeigen3-dev libassimp-dev libhwy-dev libtbb-dev libexpected-dev libfmt-dev
  libmeshoptimizer-dev libcli11-dev nlohmann-json3-dev libtinygltf-dev libpng-dev libegl-dev libgles-dev libegl1
  libgles2 libgl1-mesa-dri ffmpeg libbullet-dev libgl-dev libglfw3-dev libimgui-dev
  librecast-dev"
test_packages="libgtest-dev librapidcheck-dev libspectra-dev libboost-dev calculix-ccx
  python3-numpy python3-cffi python3-setuptools python3-wheel xvfb xauth"
cluster_packages="libopenmpi-dev openmpi-bin"
# Documents as pages and the reference (demo/site/run); spelling, which its test looks at where it is there.
site_packages="python3 doxygen cmark-gfm"
spelling_packages="codespell"

# For browsers (demo/web/run), and to show that other machines compute the same (tests/portable/run).
web_packages="cmake ninja-build clang-19 lld-19 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32
  wasi-libc libeigen3-dev libhwy-dev libexpected-dev libfmt-dev"
arm_packages="g++-aarch64-linux-gnu qemu-user"
windows_packages="g++-mingw-w64-x86-64-posix wine64"

# need PACKAGE…: installs what is missing through apt; a user who is not root gets the line to run instead.
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
  echo "installing ${#missing[@]} packages: ${missing[*]}"
  local log
  log=$(mktemp)
  if ! { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "apt-get install failed (log: $log); mend: check the network and apt sources, then run this again" >&2
    return 1
  fi
  rm -f "$log"
}

# quietly NAME COMMAND…: runs a long step, shows nothing unless it fails, then the end of its log and where the rest is.
quietly() {
  local name=$1 log started=$SECONDS
  shift
  mkdir -p build/log
  log=build/log/${name// /_}.log
  if ! "$@" >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "$name failed; the whole log is in $log" >&2
    return 1
  fi
  echo "$name: $((SECONDS - started)) s"
}
