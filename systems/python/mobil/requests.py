"""Requests for people and walks as rows of structs, from columns."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np
import numpy.typing as npt

from . import names
from ._library import lib
from .arrays import Floats
from .structs import struct_rows
from .values import choices, column, integer, number_of, numbers, one_or_many, refuse, refuse_type, spread, switch

_PACE = {
    "speed_m_s": lib.MOBIL_SPEED,
    "step_length_m": lib.MOBIL_STEP_LENGTH,
    "step_frequency_hz": lib.MOBIL_STEP_FREQUENCY,
}
_WIDTHS = {"place": 3, "somatotype": 3}
"""Columns with several numbers for each person."""


class Requests:
    """Structs for a call, and what they point to."""

    def __init__(self, kind: str, count: int, styles: Mapping[str, Floats]) -> None:
        self.count = count
        self.rows, self.structs = struct_rows(kind, count)
        self._table = np.tile(np.array([p.usual for p in names.STYLE.values()], np.float32), (count, 1))
        for at, name in enumerate(names.STYLE):
            if name in styles:
                self._table[:, at] = spread(styles[name], count, f"style {name}")
        if styles and count:  # parameters that are not given have their usual values
            step = np.uintp(self._table.strides[0])
            self.rows["style"] = np.uintp(self._table.ctypes.data) + step * np.arange(count, dtype=np.uintp)
            self.rows["style_count"] = len(names.STYLE)


def _styles(style: Mapping[str, npt.ArrayLike] | None) -> dict[str, Floats]:
    """Returns the columns of a style by name."""
    if style is None:
        return {}
    if not isinstance(style, Mapping):
        refuse_type("style is no dict; give one of parameters (mobil.STYLE)")
    known = tuple(names.STYLE)
    by_name = {known[number_of(name, known, "style parameter")]: value for name, value in style.items()}
    return {name: numbers(value, f"style {name}") for name, value in by_name.items()}


def person_requests(
    count: int | None,
    style: Mapping[str, npt.ArrayLike] | None,
    constitution: Any,
    sex: Any,
    posed: bool,
    **columns: Any,
) -> Requests:
    """Returns requests for people: `count`, or as many as the columns have."""
    given = {name: numbers(value, name) for name, value in columns.items() if value is not None}
    listed = {"constitution": one_or_many(constitution, "constitution"), "sex": one_or_many(sex, "sex")}
    styles = _styles(style)
    if count is None:
        lengths = {name: len(one) for name, one in given.items() if one.ndim > (name in _WIDTHS)}
        lengths.update((name, len(one)) for name, one in listed.items() if isinstance(one, list))
        lengths.update((f"style {name}", len(one)) for name, one in styles.items() if one.ndim)
        count = next(iter(lengths.values()), 1)
        if len(set(lengths.values())) > 1:
            has = ", ".join(f"{length} of {name}" for name, length in lengths.items())
            refuse(f"columns have different lengths: {has}; give one value for all, or one for each person")
    asked = Requests("person", integer(count, "count", 0, 10**7), styles)
    for name, one in given.items():
        values = spread(one, asked.count, name, _WIDTHS.get(name, 0))
        if name == "somatotype":
            asked.rows["endo"], asked.rows["meso"], asked.rows["ecto"] = values.T
        else:
            asked.rows[name] = values
    asked.rows["constitution"] = choices(listed["constitution"], asked.count, names.CONSTITUTIONS, "constitution")
    asked.rows["sex"] = choices(listed["sex"], asked.count, names.SEXES, "sex")
    asked.rows["given"] = sum(bit for name, bit in _PACE.items() if name in given)
    asked.rows["posed"] = switch(posed, "posed")
    return asked


def walk_requests(count: int, style: Mapping[str, npt.ArrayLike] | None, **columns: Any) -> Requests:
    """Returns changes of walks for `count` people."""
    styles = _styles(style)
    asked = Requests("walk", count, styles)
    asked.rows["given"] = lib.MOBIL_STYLE if styles else 0
    for name, value in columns.items():
        if value is not None:
            asked.rows[name] = column(value, count, name)
            asked.rows["given"] |= {**_PACE, "heading_rad": lib.MOBIL_HEADING}[name]
    return asked
