"""The C interface (mobil.h), with errors as exceptions."""

from __future__ import annotations

import os
import pathlib
import re
import sys
import threading
from typing import Any

import cffi

_HERE = pathlib.Path(__file__).resolve().parent
_NAME = "libmobil.so"


class Error(Exception):
    """A refused call: one line with the mistake, the valid range and the remedy."""

    def __init__(self, code: int, line: str) -> None:
        super().__init__(line)
        self.code = code

    def __reduce__(self) -> Any:  # pools pickle what their workers raise
        return _remade, (type(self), self.args), self.__dict__


def _remade(kind: type[Error], args: tuple[Any, ...]) -> Error:
    return Exception.__new__(kind, *args)  # without __init__, whose arguments are others in a subclass


class StaleError(Error, LookupError):
    """A stale or invalid handle."""


class MissingError(Error, LookupError):
    """The person does not have it."""


class RefusedError(Error, ValueError):
    """A value out of range, or damaged bytes."""


class WrongTypeError(RefusedError, TypeError):
    """A value of a type that is not accepted."""


class BusyError(Error, RuntimeError):
    """A world in use: by a call of another thread, or by the call around this one."""


class OutOfMemoryError(Error, MemoryError):
    """Out of memory."""


class Owner:
    """Base class of objects with memory of the C library, which are neither copied nor pickled."""

    _instead = ""

    def __reduce_ex__(self, protocol: Any) -> Any:
        name = type(self).__name__
        raise TypeError(f"a {name} has memory of the C library and is not copied or pickled; {self._instead}")


def _declarations(header: pathlib.Path) -> str:
    """Returns the header and its parts for cffi, without comments, conditions and macros other than numbers."""
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
    """Returns MOBIL_LIBRARY if set, or the library next to this file, as in a wheel, or the system's."""
    named = os.environ.get("MOBIL_LIBRARY")
    if named:
        return named
    beside = _HERE / _NAME
    return beside if beside.exists() else _NAME


if sys.flags.optimize > 1:
    raise ImportError("mobil: python -OO removes docstrings, which cffi's parser needs; use -O")
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
    lib.MOBIL_BUSY: BusyError,
}


def text(of: object) -> str:
    """Converts a C string."""
    return ffi.string(of).decode("utf-8")


_kept = threading.local()  # what a callback raised in the present call of this thread


def keep(error: BaseException) -> None:
    """Keeps what a callback raised for fail(): an exception must not cross the library."""
    _kept.error = error


def fail(code: int, line: str) -> None:
    """Raises the exception of a negative code, or what a callback has raised."""
    raised, _kept.error = getattr(_kept, "error", None), None
    if raised is not None:
        raise raised
    if code == lib.MOBIL_BUSY:
        line = "this world is in use by another thread or by the call around this one; wait for the end of that call"
    raise _ERRORS.get(code, Error)(code, line)


@ffi.callback("mobil_interrupt", error=1, onerror=lambda kind, error, trace: keep(error))
def interrupt(_: Any) -> int:
    """Does nothing: Python runs the handlers of signals, such as Ctrl-C, when a function begins."""
    return 0


def struct(name: str):
    """Returns a struct of the C interface with its defaults: struct("person") is a mobil_person*."""
    made = ffi.new(f"mobil_{name}*")
    code = lib.mobil_defaults(getattr(lib, f"MOBIL_{name.upper()}"), made, ffi.sizeof(f"mobil_{name}"))
    if code != 0:
        fail(code, f"mobil_defaults does not know a mobil_{name}")
    return made
