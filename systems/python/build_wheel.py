"""Builds the wheel (PEP 517, named in pyproject.toml) with CMake and the standard library alone.

The wheel holds libmobil.so without other libraries (MOBIL_SELF_CONTAINED). Its tag states the oldest glibc that has all
symbols of the library. MOBIL_LIBRARY names a library that is built already, and CMAKE_ARGS has options for CMake:
-DMOBIL_MESHOPTIMIZER=FOLDER for skins and surfaces at medium distance.
"""

from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import platform
import re
import shlex
import subprocess
import sys
import tarfile
import zipfile
from typing import Any, Iterator

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "wheel"

# Libraries that each Linux system has (PEP 600), and the first glibc of systems with each libstdc++.
ALLOWED = re.compile(r"lib(c|m|pthread|dl|rt|stdc\+\+|gcc_s)\.so\.\d+|ld-linux.*\.so\.\d+")
GLIBC_OF_GLIBCXX = [(19, 17), (22, 24), (24, 28), (28, 31), (29, 34), (30, 35), (32, 38), (33, 39)]

# Packages that are compiled into the library; meshoptimizer is, if MOBIL_MESHOPTIMIZER is given.
COMPILED_IN = {
    "fmt": "libfmt-dev",
    "highway": "libhwy-dev",
    "eigen": "libeigen3-dev",
    "expected": "libexpected-dev",
    "meshoptimizer": "libmeshoptimizer-dev",
}


def version() -> str:
    """Returns the version of CMakeLists.txt."""
    return re.search(r"project\(mobil VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


def output(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def build_library() -> pathlib.Path:
    """Returns the library, which it builds unless MOBIL_LIBRARY names one."""
    if "MOBIL_LIBRARY" in os.environ:
        return pathlib.Path(os.environ["MOBIL_LIBRARY"]).resolve()
    off = [f"-DMOBIL_{part}=OFF" for part in ("IMPORT", "EXPORT", "RENDER", "CLUSTER", "PROGRAM", "TESTS", "INSTALL")]
    given = shlex.split(os.environ.get("CMAKE_ARGS", ""))
    configure = ["cmake", "-S", str(ROOT), "-B", str(BUILD), "-DCMAKE_BUILD_TYPE=Release", "-DMOBIL_SELF_CONTAINED=ON"]
    configure.append("-DMOBIL_MESHOPTIMIZER=")  # not that of an earlier build
    subprocess.run([*configure, "-DMOBIL_C=ON", *off, *given], check=True, stdout=sys.stderr)
    build = ["cmake", "--build", str(BUILD), "--target", "mobil_c", "--parallel", str(os.cpu_count() or 1)]
    subprocess.run(build, check=True, stdout=sys.stderr)
    return BUILD / "libmobil.so"


def platform_tag(library: pathlib.Path) -> str:
    """Returns manylinux_2_N_MACHINE, where glibc 2.N has all symbols, or linux_MACHINE if other libraries are needed."""
    machine = platform.machine()
    needed = re.findall(r"\(NEEDED\).*\[(.*)\]", output("readelf", "-d", "-W", str(library)))
    others = [name for name in needed if not ALLOWED.fullmatch(name)]
    if others:
        print(f"mobil: the wheel is for this system alone, because it needs {', '.join(others)}", file=sys.stderr)
        return f"linux_{machine}"
    symbols = output("readelf", "-V", "-W", str(library))
    least = max([17] + [int(minor) for minor in re.findall(r"Name: GLIBC_2\.(\d+)", symbols)])
    for minor in map(int, re.findall(r"Name: GLIBCXX_3\.4\.(\d+)", symbols)):
        least = max(least, next((glibc for glibcxx, glibc in GLIBC_OF_GLIBCXX if minor <= glibcxx), 0))
        if minor > GLIBC_OF_GLIBCXX[-1][0]:
            return f"linux_{machine}"
    return f"manylinux_2_{least}_{machine}"


def metadata() -> str:
    """Returns METADATA from the [project] table of pyproject.toml (few lines of a fixed form)."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")

    def value(name: str) -> str:
        return re.search(rf'^{name} = "(.*)"$', text, re.MULTILINE)[1]

    def names(name: str) -> list[str]:
        return re.findall(r'"(.*?)"', re.search(rf"^{name} = \[(.*)\]$", text, re.MULTILINE)[1])

    lines = ["Metadata-Version: 2.1", f"Name: {value('name')}", f"Version: {version()}"]
    lines += [f"Summary: {value('description')}", "License: MIT", f"Requires-Python: {value('requires-python')}"]
    lines += [f"Requires-Dist: {package}" for package in names("dependencies")]
    lines += ["Provides-Extra: plots"] + [f'Requires-Dist: {package} ; extra == "plots"' for package in names("plots")]
    readme = (ROOT / value("readme")).read_text(encoding="utf-8")
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme])


def contents(library: pathlib.Path, info: str) -> Iterator[tuple[str, bytes]]:
    """Yields names and bytes of the wheel's files, without RECORD."""
    for source in sorted((ROOT / "systems/python/mobil").glob("*.py*")):
        yield f"mobil/{source.name}", source.read_bytes()
    headers = ROOT / "systems/c/include/mobil"
    for header in sorted(headers.rglob("*.h")):
        yield f"mobil/{header.relative_to(headers).as_posix()}", header.read_bytes()
    yield "mobil/libmobil.so", library.read_bytes()
    yield f"{info}/licenses/LICENSE", (ROOT / "LICENSE").read_bytes()
    for name, package in COMPILED_IN.items():
        terms = pathlib.Path("/usr/share/doc", package, "copyright")
        if terms.exists():
            yield f"{info}/licenses/{name}", terms.read_bytes()
        elif name != "meshoptimizer" or "MOBIL_MESHOPTIMIZER" in os.environ.get("CMAKE_ARGS", ""):
            print(f"mobil: {terms} is not there; add the licence of {name} before you distribute", file=sys.stderr)
    yield f"{info}/METADATA", metadata().encode()


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: Any = None) -> str:
    """Writes the wheel and returns its name."""
    library = build_library()
    tag = f"py3-none-{platform_tag(library)}"
    info = f"mobil-{version()}.dist-info"
    name = f"mobil-{version()}-{tag}.whl"
    record = ""
    with zipfile.ZipFile(pathlib.Path(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        about = f"Wheel-Version: 1.0\nGenerator: mobil\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
        for path, data in [*contents(library, info), (f"{info}/WHEEL", about)]:
            wheel.writestr(zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0)), data, zipfile.ZIP_DEFLATED)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record += f"{path},sha256={digest},{len(data)}\n"
        wheel.writestr(f"{info}/RECORD", f"{record}{info}/RECORD,,\n")
    return name


def build_sdist(sdist_directory: str, config_settings: Any = None) -> str:
    """Writes the tracked files of a checkout as an archive, and returns its name."""
    name = f"mobil-{version()}"
    with tarfile.open(pathlib.Path(sdist_directory, f"{name}.tar.gz"), "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for path in output("git", "-C", str(ROOT), "ls-files", "-z").split("\0"):
            if path:
                archive.add(ROOT / path, f"{name}/{path}")
        info = pathlib.Path(sdist_directory, "PKG-INFO")
        info.write_text(metadata(), encoding="utf-8")
        archive.add(info, f"{name}/PKG-INFO")
        info.unlink()
    return f"{name}.tar.gz"
