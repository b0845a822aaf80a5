"""Values of calls, by one rule each.

integer: whatever operator.index takes, in the stated range. A bool is no integer, and a float never is.
number: a real number, also as an array without dimensions. NaN, bools and text are refused.
switch: True or False, or 0 or 1.
column: one value for all, or exactly one for each person. The columns of nobody are empty.
"""

from __future__ import annotations

import operator
from typing import Any, Iterable, NoReturn, Sequence

import numpy as np
import numpy.typing as npt

from ._library import RefusedError, WrongTypeError, ffi, lib


def refuse(line: str) -> NoReturn:
    raise RefusedError(lib.MOBIL_REFUSED, line)


def refuse_type(line: str) -> NoReturn:
    raise WrongTypeError(lib.MOBIL_REFUSED, line)


def shown(value: object) -> str:
    """Returns a short representation on one line."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "…"


def _is_bool(value: object) -> bool:
    return isinstance(value, (bool, np.bool_)) or (isinstance(value, np.ndarray) and value.dtype == np.bool_)


def integer(value: Any, what: str, low: int, high: int, accepted: str = "an integer") -> int:
    """Returns an integer from low to high."""
    try:
        number = None if _is_bool(value) else operator.index(value)
    except TypeError:
        number = None
    if number is None:
        refuse_type(f"{what} is {shown(value)}; give {accepted} from {low} to {high}")
    if not low <= number <= high:
        refuse(f"{what} {number} is out of range; choose {low} to {high}")
    return number


def switch(value: Any, what: str) -> int:
    """Returns 1 or 0."""
    if _is_bool(value) and np.ndim(value) == 0:
        return int(bool(value))
    try:
        number = operator.index(value)
    except TypeError:
        number = -1
    if number not in (0, 1):
        refuse_type(f"{what} is {shown(value)}; give True or False, once for the whole call")
    return number


def numbers(value: Any, what: str, dtype: Any = np.float32, finite: bool = True) -> npt.NDArray[Any]:
    """Returns an array of numbers of any shape, contiguous and aligned. `finite`: refuses NaN."""
    if np.ma.is_masked(value):
        refuse(f"{what} has masked values; fill them first")
    try:
        array = np.asarray(value)
        if array.dtype == object or isinstance(value, (list, tuple)):
            each = np.asarray(value, object).flat  # numpy converts mixed lists
            if any(isinstance(one, (str, bytes, bool, np.bool_, type(None))) for one in each):
                raise TypeError
            array = array.astype(np.float64) if array.dtype == object else array
    except (OverflowError, TypeError, ValueError):
        refuse_type(f"{what} is {shown(value)}; give numbers, in rows of equal length")
    if array.dtype.kind not in "iuf":
        refuse_type(f"{what} is {shown(value)}; give numbers")
    if finite and array.dtype.kind == "f" and np.isnan(array).any():
        at = np.argwhere(np.isnan(array))[0].tolist()
        refuse(f"{what}{at if at else ''} is nan; give a number")
    with np.errstate(over="ignore"):  # a number beyond the range becomes infinite, which the call refuses
        return np.ascontiguousarray(array, dtype) if array.ndim else array.astype(dtype)


def number(value: Any, what: str) -> float:
    """Returns one number."""
    array = numbers(value, what, np.float64)
    if array.ndim:
        refuse_type(f"{what} has the shape {array.shape}; give one number")
    return float(array)


def column(
    value: Any, count: int, what: str, width: int = 0, of: str = "person", finite: bool = True
) -> npt.NDArray[np.float32]:
    """Returns (count,) or, with a width, (count, width) floats: one value or row for all, or one for each person."""
    return spread(numbers(value, what, finite=finite), count, what, width, of)


def spread(array: npt.NDArray[Any], count: int, what: str, width: int = 0, of: str = "person") -> npt.NDArray[Any]:
    """Returns a column of `count` values or rows from an array of one, or of as many."""
    shape = (count, width) if width else (count,)
    if count == 0 and array.size == 0:
        return np.empty(shape, array.dtype)
    if array.shape not in (shape[1:], shape):
        wanted = f"the shape {shape}" if width else f"{count}"
        has = f"the shape {array.shape}" if width or array.ndim != 1 else f"{len(array)} values"
        refuse(f"{what} has {has}; give {'one row' if width else 'one value'} for all, or {wanted}, one for each {of}")
    return np.ascontiguousarray(np.broadcast_to(array, shape))


def integers(values: Any, what: str, high: int = 2**32 - 1) -> npt.NDArray[np.uint32]:
    """Returns an array of integers from 0 to `high`, of any shape."""
    array = np.asarray(values)
    if array.dtype.kind not in "iu" and array.size:
        refuse_type(f"{what} is {shown(values)}; give integers from 0 to {high}")
    if array.size and not (0 <= array.min() and array.max() <= high):
        worst = array.min() if array.min() < 0 else array.max()
        refuse(f"{what} has {worst}, which is out of range; choose 0 to {high}")
    return np.ascontiguousarray(array, np.uint32)


def contents(data: Any, what: str) -> Any:
    """Returns the bytes of a buffer for a call; its len() counts bytes."""
    try:
        view = memoryview(data)
    except TypeError:
        refuse_type(f"{what} is {shown(data)}; give bytes")
    if not view.c_contiguous:
        refuse(f"{what} is not contiguous; give its tobytes()")
    return ffi.from_buffer(data)


def number_of(name: Any, names: Sequence[str], what: str) -> int:
    """Returns the index of a name, or an index unchanged."""
    if not isinstance(name, str):
        return integer(name, what, 0, len(names) - 1, "a name, or an integer")
    if name not in names:
        refuse(f"there is no {what} {shown(name)}; choose one of {', '.join(names)}")
    return list(names).index(name)


def one_or_many(value: Any, what: str) -> Any:
    """Returns a name or integer unchanged, and several of them as a list."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        return value.item()
    if isinstance(value, (str, bytes, dict, set, frozenset)) or not isinstance(value, Iterable):
        return value
    if np.ma.is_masked(value):
        refuse(f"{what} has masked values; fill them first")
    return list(value)


def choices(value: Any, count: int, names: Sequence[str], what: str) -> npt.NDArray[np.int32]:
    """Returns a column of indices of names."""
    given = one_or_many(value, what)
    found = (
        np.array([number_of(one, names, what) for one in given], np.int32)
        if isinstance(given, list)
        else np.int32(number_of(given, names, what))
    )
    return spread(np.asarray(found), count, what)
