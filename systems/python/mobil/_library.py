"""The C interface (mobil.h), and its failures as exceptions."""

from __future__ import annotations

import os
import pathlib
import re

import cffi

_HERE = pathlib.Path(__file__).resolve().parent
_NAME = "libmobil.so"


class Error(Exception):
    """What the library refused: one line that says what, the valid range, and how to mend it."""

    def __init__(self, code: int, line: str) -> None:
        super().__init__(line)
        self.code = code


class StaleError(Error, LookupError):
    """Somebody who is gone, or never was."""


class MissingError(Error, LookupError):
    """Somebody has no such thing."""


class RefusedError(Error, ValueError):
    """A value out of range, or damaged bytes."""


class OutOfMemoryError(Error, MemoryError):
    """There is no memory for it."""


def _declarations(header: pathlib.Path) -> str:
    """What cffi reads of the header and its parts: no comments, no conditions, no macros but numbers."""
    text = re.sub(
        r"#include <mobil/(c/\w+\.h)>",
        lambda part: (header.parent / part[1]).read_text(encoding="utf-8"),
        header.read_text(encoding="utf-8"),
    )
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL)
    begin = text.index("#define MOBIL_INTERFACE")
    lines = text[begin : text.rindex("#ifdef __cplusplus")].splitlines()
    kept = [line for line in lines if not line.startswith("#") or line.startswith("#define MOBIL_INTERFACE")]
    plain = re.sub(r"MOBIL_RENAMED\((\w+), (\w+), \w+\)", r"\1 \2", "\n".join(kept))
    return re.sub(r"MOBIL_API |MOBIL_DEPRECATED\(.*?\)", "", plain)


def _find() -> pathlib.Path | str:
    """MOBIL_LIBRARY where it is set; beside this file, as in a wheel; else what the system has."""
    named = os.environ.get("MOBIL_LIBRARY")
    if named:
        return named
    beside = _HERE / _NAME
    return beside if beside.exists() else _NAME


ffi = cffi.FFI()
ffi.cdef(_declarations(_HERE / "mobil.h"))
try:
    lib = ffi.dlopen(str(_find()))
except OSError as error:
    raise ImportError(
        f"{_NAME} is not found ({error}); build it (cmake --build … --target mobil_c) and set MOBIL_LIBRARY to its path"
    ) from error
if lib.mobil_interface() < lib.MOBIL_INTERFACE:
    raise ImportError(
        f"{_find()} has interface {lib.mobil_interface()}, and this module needs {lib.MOBIL_INTERFACE};"
        " use the library that it was built with"
    )

_ERRORS = {
    lib.MOBIL_STALE: StaleError,
    lib.MOBIL_MISSING: MissingError,
    lib.MOBIL_REFUSED: RefusedError,
    lib.MOBIL_MEMORY: OutOfMemoryError,
}


def text(of: object) -> str:
    """A C string."""
    return ffi.string(of).decode("utf-8")


def fail(code: int, line: str) -> None:
    """Raises the exception of a code below 0."""
    raise _ERRORS.get(code, Error)(code, line)


def struct(name: str):
    """A struct of the C interface with its usual values: struct("person") is a mobil_person*."""
    made = ffi.new(f"mobil_{name}*")
    code = lib.mobil_defaults(getattr(lib, f"MOBIL_{name.upper()}"), made, ffi.sizeof(f"mobil_{name}"))
    if code != 0:
        fail(code, f"mobil_defaults does not know a mobil_{name}")
    return made
