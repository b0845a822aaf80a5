"""One person's walk, tick by tick."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from . import names
from .values import number, number_of, refuse
from .world import World

Floats = npt.NDArray[np.float32]


@dataclass
class Walk:
    """A recorded walk, one row for each tick, in SI units and rad. Sides: right, left."""

    mass_kg: float
    time_s: Floats
    phase: Floats
    """Phase of the gait cycle of each side, 0 to 1 from its heel strike: (ticks, 2)."""
    joints: Floats
    """(ticks, 13), columns as names.JOINTS."""
    poses: Floats
    """(ticks, 48, 7)."""
    centre_of_mass: Floats
    ground: Floats
    """Force on each foot, N: (ticks, 2, 3)."""
    moments: Floats
    """(ticks, 6) N m, columns as names.MOMENTS."""
    lines: dict[str, Floats] = field(default_factory=dict)
    """By muscle: (ticks, 2, 4), columns as names.LINE."""
    bellies: dict[str, Floats] = field(default_factory=dict)
    """By muscle with reports: (ticks, 2, 5), columns as names.REPORT."""

    def joint(self, name: str) -> Floats:
        """Returns one column of joints, rad."""
        return self.joints[:, number_of(name, names.JOINTS, "joint")]

    def moment(self, name: str) -> Floats:
        """Returns one column of moments, N m."""
        return self.moments[:, number_of(name, names.MOMENTS, "moment")]


def _ticks(seconds: float, what: str, tick_s: float) -> int:
    value = number(seconds, what)
    if not 0 <= value <= 1e6:
        refuse(f"{what} of {value} s is out of range; choose 0 to 1000000 s")
    return round(value / tick_s)


def walk(*, seconds: float = 2.4, settle_s: float = 2.0, muscles: Any = None, tick_s: float = 1 / 60, **person: Any) -> Walk:
    """Simulates and records a walk of one person. `person`: arguments of World.spawn.

    settle_s: time simulated before, so that bellies vibrate as in a steady walk.
    """
    world = World(tick_s=tick_s)
    who = world.spawn(1, muscles=muscles, **person)
    world.enable(who, "forces")
    world.tick(_ticks(settle_s, "settle_s", tick_s))
    ticks = _ticks(seconds, "seconds", tick_s) + 1
    bits = 0 if muscles is None else muscles.muscles
    chosen = [name for number, name in enumerate(names.MUSCLES) if bits >> number & 1]
    reported = muscles is not None and names.METHODS[muscles.method] != "none" and bool(muscles.reported)
    made = Walk(
        mass_kg=float(np.max(person.get("mass_kg", 75.0))),
        time_s=np.empty(ticks, np.float32),
        phase=np.empty((ticks, 2), np.float32),
        joints=np.empty((ticks, len(names.JOINTS)), np.float32),
        poses=np.empty((ticks, len(names.SEGMENTS), 7), np.float32),
        centre_of_mass=np.empty((ticks, 3), np.float32),
        ground=np.empty((ticks, 2, 3), np.float32),
        moments=np.empty((ticks, len(names.MOMENTS)), np.float32),
        lines={name: np.empty((ticks, 2, len(names.LINE)), np.float32) for name in chosen},
        bellies={name: np.empty((ticks, 2, len(names.REPORT)), np.float32) for name in chosen if reported},
    )
    begin_s = world.time_s
    for row in range(ticks):
        here = slice(row, row + 1)
        made.time_s[row] = world.time_s - begin_s
        world.joints(who, made.joints[here])
        world.poses(who, out=made.poses[here])
        world.centre_of_mass(who, made.centre_of_mass[here])
        world.moments(who, made.moments[here])
        made.phase[row] = world.feet(who)[1][0]
        made.ground[row] = world.ground(who)[0][0]
        for kind, of in (("line", made.lines), ("report", made.bellies)):
            for name, rows in of.items():
                for side, side_name in enumerate(names.SIDES):
                    world.muscle_rows(kind, who, name, side_name, rows[here, side])
        world.tick()
    return made
