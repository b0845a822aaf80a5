"""Results of a frame and costs of a tick."""

from __future__ import annotations

from typing import NamedTuple


class Ticks(NamedTuple):
    count: int
    """Ticks that ran."""
    alpha: float
    """Position of the frame's end in the next tick, 0 to 1."""
    dropped_s: float
    """Time dropped from a frame that was too long."""


class SystemCost(NamedTuple):
    name: str
    module: str
    seconds: float
    """In the last tick, summed over all threads."""
    entities: int


class PhaseCost(NamedTuple):
    name: str
    module: str
    after: bool
    """True: after the systems; false: before them."""
    seconds: float
    """In the last tick, on the calling thread."""
