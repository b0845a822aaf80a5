#!/usr/bin/env bash
# Packages for other build systems (demo/packaging) and workflows of GitHub: each file is valid, the commands of
# workflows exist, and the vcpkg port and the Conan recipe have the version and options of this project.
# Usage: packages_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$2"
version=$(sed -n 's/^project(mobil VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
python3 - "$version" <<'PY'
import ast, json, pathlib, re, sys
port = json.loads(pathlib.Path("demo/packaging/vcpkg/mobil/vcpkg.json").read_text())
assert port["version"] == sys.argv[1], port["version"]
recipe = pathlib.Path("demo/packaging/conan/conanfile.py").read_text()
names = {node.name for node in ast.walk(ast.parse(recipe)) if isinstance(node, ast.FunctionDef)}
assert {"set_version", "export_sources", "layout", "generate", "build", "package", "package_info"} <= names, names
options = set(re.findall(r"option\(MOBIL_(\w+)", pathlib.Path("CMakeLists.txt").read_text()))
used = set(re.findall(r"MOBIL_([A-Z]+)=", pathlib.Path("demo/packaging/vcpkg/mobil/portfile.cmake").read_text()))
used |= set(ast.literal_eval("(" + re.search(r'for part in \(("IMPORT".*)\)', recipe)[1] + ")"))
assert used and used <= options, used - options
try:
    import yaml
except ImportError:
    print("workflows not read: python3-yaml is not there")
    sys.exit()
presets = {p["name"] for p in json.loads(pathlib.Path("CMakePresets.json").read_text())["configurePresets"]}
stages = re.search(r'all_stages="(.*)"', pathlib.Path("tests/run").read_text())[1].split()
commands = 0
for path in sorted(pathlib.Path(".github/workflows").glob("*.yml")):
    for name, job in yaml.safe_load(path.read_text())["jobs"].items():
        assert job["runs-on"] and job["timeout-minutes"], (path, name)
        for step in job["steps"]:
            command = step.get("run", "")
            commands += command != ""
            for script in re.findall(r"(?:^|\s)((?:\.ci|tests|demo)/[\w/]+)(?![\w.])", command):
                assert pathlib.Path(script).stat().st_mode & 0o111, (path, script)
            for stage in re.findall(r"tests/run (\w+)", command):
                assert stage in stages, (path, stage)
            for preset in re.findall(r"--preset (\w+)", command):
                assert preset in presets, (path, preset)
assert commands > 8, commands
PY
# The port, with stand-ins for vcpkg's functions: it configures this project with options that it has.
cat >"$scratch/port.cmake" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
set(CURRENT_PACKAGES_DIR "${SCRATCH}/packages")
function(vcpkg_cmake_configure)
  cmake_parse_arguments(PORT "" "SOURCE_PATH" "OPTIONS" ${ARGN})
  if(NOT EXISTS "${PORT_SOURCE_PATH}/CMakePresets.json" OR NOT "-DMOBIL_C=ON" IN_LIST PORT_OPTIONS)
    message(FATAL_ERROR "the port configures ${PORT_SOURCE_PATH} with ${PORT_OPTIONS}")
  endif()
endfunction()
function(vcpkg_cmake_install)
endfunction()
function(vcpkg_cmake_config_fixup)
endfunction()
function(vcpkg_fixup_pkgconfig)
endfunction()
function(vcpkg_install_copyright)
  cmake_parse_arguments(PORT "" "" "FILE_LIST" ${ARGN})
  file(SIZE "${PORT_FILE_LIST}" size)
endfunction()
include("${PORT}")
CMAKE
cmake -DSCRATCH="$scratch" -DPORT="$2/demo/packaging/vcpkg/mobil/portfile.cmake" -P "$scratch/port.cmake"
