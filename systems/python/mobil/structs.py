"""Structs of the C interface from fields by name: muscles, methods and options of calls."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from . import names
from ._library import ffi, struct
from .names import muscle_bits, number_of

_NAMED = {
    "method": names.METHODS,
    "element": names.ELEMENTS,
    "mass": names.MASSES,
    "drive": names.DRIVES,
    "activation": names.ACTIVATIONS,
}


def _fill(kind: str, given: Mapping[str, Any]) -> Any:
    """Returns a struct of the C interface with these fields. Names are converted to numbers."""
    made = struct(kind)
    for field, value in given.items():
        if field == "size" or not hasattr(made, field):
            known = [name for name, _ in ffi.typeof(made).item.fields if name != "size"]
            raise TypeError(f"{kind} has no '{field}'; it has {', '.join(known)}")
        if field == "muscles":
            value = muscle_bits(value)
        elif field in _NAMED:
            value = number_of(value, _NAMED[field], field)
        setattr(made, field, list(value) if isinstance(value, (tuple, np.ndarray)) else value)
    return made


def muscles(**fields: Any) -> Any:
    """Returns a choice of leg muscles: muscles(method="modal", modes=8, activation="phase").

    `muscles`: names (names.MUSCLES), by default the four groups. `method`: "static", "explicit_central",
    "implicit_central", "newmark", "modal", "none" or "finite". Other fields are those of mobil_muscles, in SI units.
    """
    return _fill("muscles", fields)


def method(name: str, **fields: Any) -> Any:
    """Returns the method of one muscle: method("modal", modes=4, control_points=0)."""
    return _fill("method", {"method": name, **fields})
