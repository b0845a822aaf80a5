"""Structs of the C interface from fields by name: muscles, methods, options and arrays of requests."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np

from . import names
from ._library import fail, ffi, lib, struct
from .names import muscle_bits
from .values import integer, number, number_of, numbers, one_or_many, refuse_type, shown, switch

_NAMED: dict[str, Sequence[str]] = {
    "method": names.METHODS,
    "element": names.ELEMENTS,
    "mass": names.MASSES,
    "drive": names.DRIVES,
    "activation": names.ACTIVATIONS,
    "side": names.SIDES + ("both",),
}
_SWITCHES = frozenset(
    "moving corrected control_points reported tuned linear_shape inertia line_motion finite_shape bones textured"
    " has_camera compact_unseen looked_at".split()
)
_UNSET = {"finite_shape", "looked_at"}  # switches that can be -1
_RANGES = {"int": (-(2**31), 2**31 - 1), "unsigned int": (0, 2**32 - 1), "size_t": (0, 2**63 - 1)}
_TYPES = {"float": np.float32, "double": np.float64, "int": np.int32, "unsigned int": np.uint32, "size_t": np.uintp}


def _put(made: Any, field: str, value: Any, kind: Any) -> None:
    """Sets a field of a C type."""
    if field == "muscles":
        value = muscle_bits(value)
        made.more_muscles = value >> 32
        value &= 2**32 - 1
    elif field in _NAMED:
        value = number_of(value, _NAMED[field], field)
    elif field in _SWITCHES:
        unset = field in _UNSET and not isinstance(value, (bool, np.bool_)) and np.ndim(value) == 0 and value == -1
        value = -1 if unset else switch(value, field)
    elif kind.kind == "array":
        whole = kind.item.cname not in ("float", "double")
        if whole:
            value = one_or_many(value, field)
            if isinstance(value, list):
                value = [integer(one, field, *_RANGES[kind.item.cname]) for one in value]
        else:
            value = numbers(value, field, np.float64).tolist()
        if not isinstance(value, list) or len(value) != kind.length or any(isinstance(one, list) for one in value):
            refuse_type(f"{field} is {shown(value)}; give {kind.length} numbers")
    elif kind.cname in _RANGES:
        value = integer(value, field, *_RANGES[kind.cname])
    else:
        value = number(value, field)
    setattr(made, field, value)


def _fields(of: Any) -> dict[str, Any]:
    """Returns the types of a struct's fields that can be set by name."""
    every = ffi.typeof(of).item.fields
    hidden = {"size", "more_muscles", "unused", "unused_2"}
    return {name: field.type for name, field in every if name not in hidden and field.type.kind != "pointer"}


def _fill(kind: str, given: Mapping[str, Any]) -> Any:
    """Returns a struct of the C interface with these fields. Names are converted to numbers."""
    made = struct(kind)
    known = _fields(made)
    for field, value in given.items():
        if field not in known:
            refuse_type(f"{kind} has no {shown(field)}; it has {', '.join(known)}")
        _put(made, field, value, known[field])
    return made


def _read(made: Any, field: str, kind: Any) -> Any:
    value = getattr(made, field)
    if field == "muscles":
        value |= made.more_muscles << 32
    return tuple(value) if kind.kind == "array" else value


class _Value:
    """A struct of the C interface as a value: its fields are attributes, and it can be compared, copied and pickled."""

    _kind = ""
    _made: Any

    def __init__(self, **fields: Any) -> None:
        object.__setattr__(self, "_made", _fill(self._kind, fields))

    def __getattr__(self, name: str) -> Any:
        kind = None if name.startswith("_") else _fields(self._made).get(name)
        if kind is None:
            raise AttributeError(f"mobil.{self._kind} has no '{name}'")
        return _read(self._made, name, kind)

    def __setattr__(self, name: str, value: Any) -> None:
        object.__setattr__(self, "_made", _fill(self._kind, {**self._given(), name: value}))

    def _given(self) -> dict[str, Any]:
        """Returns the fields that differ from the defaults."""
        usual = struct(self._kind)
        every = {name: (_read(self._made, name, kind), _read(usual, name, kind)) for name, kind in _fields(usual).items()}
        return {name: value for name, (value, default) in every.items() if value != default}

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and other._given() == self._given()

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        def of(name: str, value: Any) -> str:
            return repr(_NAMED[name][value] if name in _NAMED else value)

        return f"mobil.{self._kind}({', '.join(f'{name}={of(name, value)}' for name, value in self._given().items())})"

    def __reduce__(self) -> Any:
        return _remade, (type(self), self._given())


class Muscles(_Value):
    """A choice of leg muscles: see muscles()."""

    _kind = "muscles"


class Method(_Value):
    """A method of one muscle: see method()."""

    _kind = "method"


def _remade(kind: type[_Value], given: dict[str, Any]) -> _Value:
    return kind(**given)


def muscles(**fields: Any) -> Muscles:
    """Returns a choice of leg muscles: muscles(method="modal", modes=8, activation="phase").

    `muscles`: names (names.MUSCLES), by default the first four groups. `method`: "static", "explicit_central",
    "implicit_central", "newmark", "modal", "none" or "finite". Other fields are those of mobil_muscles, in SI units.
    """
    return Muscles(**fields)


def method(name: str, **fields: Any) -> Method:
    """Returns the method of one muscle: method("modal", modes=4, control_points=0)."""
    return Method(method=name, **fields)


def pointer(value: _Value | None, kind: type[_Value], none: bool = True) -> Any:
    """Returns a value's struct for a call; null for None."""
    if value is None and none:
        return ffi.NULL
    if not isinstance(value, kind):
        refuse_type(f"{kind._kind} is {shown(value)}; give mobil.{kind._kind}(…)")
    return value._made


def _row_type(kind: str) -> np.dtype[Any]:
    """Returns the type of numpy's rows that lie like an array of a struct."""
    fields = dict(ffi.typeof(f"mobil_{kind}").fields)

    def of(field: Any) -> Any:
        if field.type.kind == "array":
            return (_TYPES[field.type.item.cname], (field.type.length,))
        return np.uintp if field.type.kind == "pointer" else _TYPES[field.type.cname]

    return np.dtype(
        {
            "names": list(fields),
            "formats": [of(field) for field in fields.values()],
            "offsets": [field.offset for field in fields.values()],
            "itemsize": ffi.sizeof(f"mobil_{kind}"),
        }
    )


def struct_rows(kind: str, count: int) -> Any:
    """Returns structs with their defaults as rows of numpy, and a pointer to them that is valid as long as they are."""
    try:
        rows = np.zeros(count, _row_type(kind))
    except MemoryError:
        fail(lib.MOBIL_MEMORY, f"there is no memory for {count} requests; give fewer at a time")
    rows[:] = np.frombuffer(ffi.buffer(struct(kind)), rows.dtype)
    return rows, ffi.cast(f"mobil_{kind}*", rows.ctypes.data)
