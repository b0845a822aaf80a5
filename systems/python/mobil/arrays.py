"""Arrays passed to and returned by the C interface: their types and shapes."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._library import ffi
from .values import refuse, refuse_type

PERSON = np.dtype([("index", np.uint32), ("generation", np.uint32)])
"""Handle of a person. People are one-dimensional arrays of handles."""

EVENT = np.dtype(
    [
        ("person", PERSON),
        ("kind", np.int32),
        ("side", np.int32),
        ("tick", np.uint32),
        ("part", np.float32),
        ("place", np.float32, 3),
        ("heading_rad", np.float32),
    ]
)
"""Step event: kind (names.EVENTS), side (names.SIDES), tick from 1 and fraction of it, position of the foot or of the
walking line, and its heading."""

ROOT = np.dtype([("place", np.float64, 3), ("heading_rad", np.float64)])
"""Position of a person on the ground, and heading, rad."""

People = npt.NDArray[np.void]
Floats = npt.NDArray[np.float32]


def _people(people: People) -> People:
    """Returns handles for a call: one-dimensional and contiguous; one person becomes an array of one. Calls read and
    write one row for each handle."""
    handles = np.atleast_1d(people)
    if handles.dtype != PERSON:
        refuse_type("people are arrays of mobil.PERSON, as spawn returns them")
    if handles.ndim != 1:
        refuse(f"people are arrays of one dimension, and this has the shape {handles.shape}; give its ravel()")
    return np.require(handles, requirements=["C", "A"])


def _ids(people: People) -> Any:
    return ffi.from_buffer("mobil_id[]", people)


def _all(people: People) -> tuple[Any, int]:
    """Returns handles and their number for a call. The array is valid as long as the expression that uses it."""
    people = _people(people)
    return (_ids(people) if people.size else ffi.NULL), people.size


def _one(person: People) -> Any:
    if np.size(person) != 1:
        refuse_type("one person is wanted: an element of what spawn returns")
    people = _people(person)
    return {"index": int(people["index"][0]), "generation": int(people["generation"][0])}


def _floats(values: Floats) -> Any:
    return ffi.cast("float*", values.ctypes.data)


def _out(out: Floats | None, shape: tuple[int, ...]) -> Floats:
    """Returns the caller's array if it fits, with any stride of rows, or a new one if there is none."""
    if out is None:
        return np.empty(shape, np.float32)
    fits = isinstance(out, np.ndarray) and out.dtype == np.float32 and out.shape == shape
    if fits and out.size:
        fits = out[0].flags.c_contiguous and (len(out) == 1 or out.strides[0] >= out[0].nbytes)
    if not fits or not out.flags.writeable or not out.flags.aligned:
        refuse(f"out must be a writable float32 array of shape {shape} whose rows lie together")
    return out


def _stride(rows: Floats) -> int:
    """Returns the stride of rows in bytes, for a call; 0: contiguous. numpy gives a single row any stride."""
    return rows.strides[0] if rows.size and len(rows) > 1 else 0
