"""Others whose way walkers keep out of, walls, and ground that is not level."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, NamedTuple

import numpy as np
import numpy.typing as npt

from ._library import ffi, lib, struct
from .arrays import PERSON, Floats, People, _all, _floats, _ids, _people
from .structs import _fill

if TYPE_CHECKING:
    from .world import World


class AvoidanceReport(NamedTuple):
    """What was chosen in all ticks of the last advance or tick."""

    people: int
    chose: int
    """How often a step was chosen."""
    kept_reservation: int
    """Of these, by who had to keep to what others know of them."""
    yielded: int
    """Of these, by who gave way to somebody that chose at the same time."""
    waiting: int
    """Who stood though they want to walk."""


class Avoidance:
    """Walkers of a world who keep out of each other's way: World.avoidance."""

    def __init__(self, world: World) -> None:
        self._world = world

    def set_options(self, **options: float) -> None:
        """How much room people keep who are managed from now on.

        radius_h: half the breadth that two keep clear of each other, of the height, 0.02 to 0.5. shoulders_h: half of the
        shoulders' breadth, radius_h to 0.5: kept clear of walls, discs and who avoids nobody; who comes nearer to others
        turns the shoulders. overlap_m: how far two may overlap who have waited, 0 to 0.2.
        """
        self._world._do(lib.mobil_avoidance_set_options(self._world._sim, _fill("avoidance_options", options)))

    def manage(self, people: People) -> None:
        """They avoid others from now on, and want what they were last asked to do."""
        self._world._do(lib.mobil_avoidance_manage(self._world._sim, *_all(people), 1))

    def release(self, people: People) -> None:
        """No more; they go on as they now do, and from slopes that slow them as they want."""
        self._world._do(lib.mobil_avoidance_manage(self._world._sim, *_all(people), 0))

    def set_desired_velocity(self, people: People, speed_m_s: npt.ArrayLike, heading_rad: npt.ArrayLike) -> None:
        """Where they want to go, and how fast (0: to stand)."""
        people = _people(people)
        rows = np.empty((people.size, 2), np.float32)
        rows[:, 0] = speed_m_s
        rows[:, 1] = heading_rad
        self._world._do(lib.mobil_avoidance_set_desired_velocity(self._world._sim, *_all(people), _floats(rows), 0))

    def set_walls(self, walls: npt.ArrayLike) -> None:
        """Straight walls instead of those before: (n, 2, 3), from where to where, in the world's axes."""
        rows = np.ascontiguousarray(walls, np.float32).reshape(-1, 6)
        self._world._do(lib.mobil_avoidance_set_walls(self._world._sim, _floats(rows), 0, len(rows)))

    def set_discs(self, place: npt.ArrayLike, radius: npt.ArrayLike, velocity: npt.ArrayLike = (0.0, 0.0, 0.0)) -> None:
        """Players, cars, pillars, instead of those before: (n, 3), (n,) and (n, 3), in the world's axes and unit."""
        places = np.asarray(place, np.float32).reshape(-1, 3)
        rows = np.empty((len(places), 7), np.float32)
        rows[:, :3] = places
        rows[:, 3:6] = velocity
        rows[:, 6] = radius
        self._world._do(lib.mobil_avoidance_set_discs(self._world._sim, _floats(rows), 0, len(rows)))

    @property
    def report(self) -> AvoidanceReport:
        """What was chosen in all ticks of the last advance or tick."""
        did = struct("avoidance_counts")
        self._world._do(lib.mobil_avoidance_report(self._world._sim, did))
        return AvoidanceReport(*(getattr(did, name) for name in AvoidanceReport._fields))


Heights = Callable[[Floats], Any]


class TerrainReport(NamedTuple):
    """What the ground was asked in all ticks of the last advance or tick."""

    people: int
    asked: int
    """How often somebody's ground was asked for."""
    places: int
    unusable: int
    """Answers that were not numbers, or hung over."""


class Terrain:
    """Ground of a world that is not level: World.terrain."""

    def __init__(self, world: World) -> None:
        self._world = world

    def set_heights(self, heights: Heights | None) -> None:
        """Every tick asks this function from now on, or none.

        heights: of places (n, 3) in the world's axes gives their heights (n,), or heights and normals: ((n,), (n, 3)).
        Without normals walkers stand on level patches of that height, as on stairs. What it raises ends the tick before
        anybody moves, and comes out of advance or tick. It must not use the world.
        """
        raised = self._world._raised

        def answer(_: Any, places: Any, __: Any, count: int, ground: Any) -> int:
            try:
                at = np.frombuffer(ffi.buffer(places, 12 * count), np.float32).reshape(-1, 3).copy()
                rows = np.frombuffer(ffi.buffer(ground, 16 * count), np.float32).reshape(-1, 4)
                answers = heights(at)
                values, normals = answers if isinstance(answers, tuple) else (answers, 0.0)
                rows[:, 0] = np.asarray(values, np.float32).reshape(-1)
                rows[:, 1:] = normals
            except BaseException as error:  # World._ran raises it
                raised.append(error)
                return 1
            return 0

        call = ffi.NULL if heights is None else ffi.callback("mobil_heights", answer)
        self._world._do(lib.mobil_terrain_set_heights(self._world._sim, call, ffi.NULL))
        self._world._heights = call  # lives as long as it may be called

    def set_speed_scaling(self, on: bool = True) -> None:
        """Walkers slow down on slopes and stairs, and go on as asked where it is level; or no more."""
        self._world._do(lib.mobil_terrain_set_speed_scaling(self._world._sim, on))

    def manage(self, people: People) -> None:
        """They are on that ground from the next tick on."""
        self._world._do(lib.mobil_terrain_manage(self._world._sim, *_all(people), 1))

    def release(self, people: People) -> None:
        """They walk on the level plane through the origin again."""
        self._world._do(lib.mobil_terrain_manage(self._world._sim, *_all(people), 0))

    def query(self) -> tuple[Floats, People]:
        """Without set_heights: where the ground has to be known before the next tick, places (n, 3), and whose they are
        (n,)."""
        count = ffi.new("size_t*")
        self._world._do(lib.mobil_terrain_query(self._world._sim, ffi.NULL, 0, ffi.NULL, 0, count))
        places, who = np.empty((count[0], 3), np.float32), np.zeros(count[0], PERSON)
        if count[0]:
            at, ids = _floats(places), _ids(who)
            self._world._do(lib.mobil_terrain_query(self._world._sim, at, 0, ids, count[0], ffi.NULL))
        return places, who

    def resolve(self, heights: npt.ArrayLike, normals: npt.ArrayLike = (0.0, 0.0, 0.0)) -> int:
        """The ground at the places of the last query(); how many answers were not numbers, or hung over."""
        values = np.asarray(heights, np.float32).reshape(-1)
        rows = np.empty((len(values), 4), np.float32)
        rows[:, 0] = values
        rows[:, 1:] = normals
        unusable = ffi.new("size_t*")
        self._world._do(lib.mobil_terrain_resolve(self._world._sim, _floats(rows), 0, len(rows), unusable))
        return int(unusable[0])

    @property
    def report(self) -> TerrainReport:
        """What the ground was asked in all ticks of the last advance or tick."""
        did = struct("terrain_counts")
        self._world._do(lib.mobil_terrain_report(self._world._sim, did))
        return TerrainReport(*(getattr(did, name) for name in TerrainReport._fields))
