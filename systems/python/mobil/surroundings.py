"""Others whose way walkers keep out of, walls, and ground that is not level."""

from __future__ import annotations

from typing import Any, Callable, NamedTuple

import numpy as np
import numpy.typing as npt

from ._library import ffi, lib, struct
from .arrays import PERSON, Floats, People, _all, _floats, _ids, _people
from .world import World


class Steered(NamedTuple):
    """What Avoidance.update did."""

    people: int
    chose: int
    """Who chose a step."""
    kept_claim: int
    """Of these, who had to keep to what others know of them."""
    gave_way: int
    """Of these, who gave way to somebody that chose at the same time."""
    waiting: int
    """Who stands though they want to walk."""


class Avoidance:
    """Walkers who keep out of each other's way: one for a world.

    radius_h: half the breadth that two keep clear of each other, of the height, 0.02 to 0.5. shoulders_h: half of the
    shoulders' breadth, radius_h to 0.5: kept clear of walls, discs and who avoids nobody; who comes nearer to others
    turns the shoulders.
    overlap_m: how far two may overlap who have waited, 0 to 0.2. Call update() before each tick.
    """

    def __init__(self, world: World, *, radius_h: float | None = None, overlap_m: float | None = None,
                 shoulders_h: float | None = None) -> None:
        options = struct("avoidance")
        if radius_h is not None:
            options.radius_h = radius_h
        if overlap_m is not None:
            options.overlap_m = overlap_m
        if shoulders_h is not None:
            options.shoulders_h = shoulders_h
        self._world = world
        world._do(lib.mobil_start_avoidance(world._sim, options))

    def manage(self, people: People) -> None:
        """They avoid others from now on, and want what they were last asked to do."""
        self._world._do(lib.mobil_avoid(self._world._sim, *_all(people), 1))

    def release(self, people: People) -> None:
        """No more; they go on as they now do, and from slopes that slow them as they want."""
        self._world._do(lib.mobil_avoid(self._world._sim, *_all(people), 0))

    def want(self, people: People, speed_m_s: npt.ArrayLike, heading_rad: npt.ArrayLike) -> None:
        """Where they want to go, and how fast (0: to stand)."""
        people = _people(people)
        rows = np.empty((people.size, 2), np.float32)
        rows[:, 0] = speed_m_s
        rows[:, 1] = heading_rad
        self._world._do(lib.mobil_want(self._world._sim, *_all(people), _floats(rows), 0))

    def set_walls(self, walls: npt.ArrayLike) -> None:
        """Straight walls instead of those before: (n, 2, 3), from where to where, in the world's axes."""
        rows = np.ascontiguousarray(walls, np.float32).reshape(-1, 6)
        self._world._do(lib.mobil_set_walls(self._world._sim, _floats(rows), 0, len(rows)))

    def set_discs(self, place: npt.ArrayLike, radius: npt.ArrayLike, velocity: npt.ArrayLike = (0.0, 0.0, 0.0)) -> None:
        """Players, cars, pillars, instead of those before: (n, 3), (n,) and (n, 3), in the world's axes and unit."""
        places = np.asarray(place, np.float32).reshape(-1, 3)
        rows = np.empty((len(places), 7), np.float32)
        rows[:, :3] = places
        rows[:, 3:6] = velocity
        rows[:, 6] = radius
        self._world._do(lib.mobil_set_discs(self._world._sim, _floats(rows), 0, len(rows)))

    def update(self) -> Steered:
        """Chooses the steps of those whose next one begins in the tick to come."""
        did = struct("steered")
        self._world._do(lib.mobil_steer(self._world._sim, did))
        return Steered(*(getattr(did, name) for name in Steered._fields))


Heights = Callable[[Floats], Any]


class Terrain:
    """Ground that is not level: one for a world.

    heights: of places (n, 3) in the world's axes gives their heights (n,), or heights and normals: ((n,), (n, 3)).
    Without normals walkers stand on level patches of that height, as on stairs. Call update() before each tick.
    slows_down: walkers slow down on slopes and stairs, and go on as asked where it is level.
    """

    def __init__(self, world: World, heights: Heights, slows_down: bool = False) -> None:
        self._world = world
        self._heights = heights
        self._world._do(lib.mobil_set_slowing(self._world._sim, slows_down))

    def manage(self, people: People) -> None:
        """They are on that ground from the next update on."""
        self._world._do(lib.mobil_set_on_ground(self._world._sim, *_all(people), 1))

    def release(self, people: People) -> None:
        """They walk on the level plane through the origin again."""
        self._world._do(lib.mobil_set_on_ground(self._world._sim, *_all(people), 0))

    def ask(self) -> tuple[Floats, People]:
        """Where the ground has to be known before the next tick: places (n, 3) and whose they are (n,)."""
        count = ffi.new("size_t*")
        self._world._do(lib.mobil_ask_ground(self._world._sim, ffi.NULL, 0, ffi.NULL, 0, count))
        places, who = np.empty((count[0], 3), np.float32), np.zeros(count[0], PERSON)
        if count[0]:
            at, ids = _floats(places), _ids(who)
            self._world._do(lib.mobil_ask_ground(self._world._sim, at, 0, ids, count[0], ffi.NULL))
        return places, who

    def answer(self, heights: npt.ArrayLike, normals: npt.ArrayLike = (0.0, 0.0, 0.0)) -> int:
        """The ground at the places of the last ask(); how many answers were not numbers, or hung over."""
        values = np.asarray(heights, np.float32).reshape(-1)
        rows = np.empty((len(values), 4), np.float32)
        rows[:, 0] = values
        rows[:, 1:] = normals
        unusable = ffi.new("size_t*")
        self._world._do(lib.mobil_answer_ground(self._world._sim, _floats(rows), 0, len(rows), unusable))
        return int(unusable[0])

    def update(self) -> int:
        """Asks `heights` where the ground has to be known, and takes the answers; how many could not be used."""
        places, _ = self.ask()
        if not len(places):
            return self.answer([])  # who was asked to walk otherwise since is looked at
        answers = self._heights(places)
        return self.answer(*answers) if isinstance(answers, tuple) else self.answer(answers)
