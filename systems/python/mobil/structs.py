"""Structs of the C interface from fields by name: how muscles deform, and what else calls take as options."""

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
    """A struct of the C interface with these fields; names for numbers where there are names."""
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
    """How leg muscles deform: muscles(method="modal", modes=8, activation="phase").

    `muscles`: names (names.MUSCLES), usual the four groups; `method`: "static", "explicit_central", "implicit_central", "newmark", "modal",
    "none" or "finite"; all other fields are those of mobil_muscles in mobil.h, in SI units.
    """
    return _fill("muscles", fields)


def method(name: str, **fields: Any) -> Any:
    """How one muscle is simulated: method("modal", modes=4, control_points=0)."""
    return _fill("method", {"method": name, **fields})
