#!/usr/bin/env python3
"""Writes the zip of the Blender add-on.

Usage: make_zip.py OUT.zip LIBRARY...    libraries: libmobil.so, mobil.dll, libmobil.dylib
"""

import pathlib
import sys
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
HEADER = ROOT / "systems/c/include/mobil"
NAMES = {".so": "libmobil.so", ".dll": "mobil.dll", ".dylib": "libmobil.dylib"}


def main(out: pathlib.Path, libraries: list[pathlib.Path]) -> None:
    files = {path.name: path for path in sorted((HERE / "mobil_blender").glob("*.py"))}
    files |= {"README.md": HERE / "README.md", "LICENSE": ROOT / "LICENSE", "lib/mobil.h": HEADER / "mobil.h"}
    files |= {f"lib/c/{path.name}": path for path in sorted((HEADER / "c").glob("*.h"))}
    for name in ("fmt", "hwy", "eigen3", "expected", "meshoptimizer"):  # compiled into the library
        terms = pathlib.Path(f"/usr/share/doc/lib{name}-dev/copyright")
        if terms.is_file():
            files[f"licenses/{name}.txt"] = terms
    for path in libraries:
        kind = next((name for suffix, name in NAMES.items() if suffix in path.suffixes), None)
        if kind is None or not path.is_file():
            sys.exit(f"make_zip.py: {path} is not a library; give files that end with .so, .dll or .dylib")
        files[f"lib/{kind}"] = path
    unfinished = out.with_name(out.name + ".part")
    with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as made:
        for name, path in files.items():
            entry = zipfile.ZipInfo(f"mobil_blender/{name}")  # of 1980: equal files give an equal zip
            made.writestr(entry, path.read_bytes(), zipfile.ZIP_DEFLATED)
    unfinished.replace(out)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), [pathlib.Path(name).resolve() for name in sys.argv[2:]])
