"""Collision avoidance, obstacles and uneven ground."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, NamedTuple

import numpy as np
import numpy.typing as npt

from ._library import Owner, ffi, keep, lib, struct
from .arrays import PERSON, Floats, People, _all, _floats, _ids, _people
from .structs import _fill
from .values import column, numbers, refuse, refuse_type, shown, spread, switch

if TYPE_CHECKING:
    from .world import World


class AvoidanceReport(NamedTuple):
    """Counts of all ticks of the last advance or tick."""

    people: int
    chose: int
    """Chosen steps."""
    kept_reservation: int
    """Steps that kept to the reservation."""
    yielded: int
    """Steps that yielded to a step chosen in the same tick."""
    waiting: int
    """Steps on which a walker stands but wants to walk."""


class Avoidance(Owner):
    """Collision avoidance between walkers of a world: World.avoidance."""

    _instead = "use that of a World"

    def __init__(self, world: World) -> None:
        self._world = world

    def set_options(self, **options: float) -> None:
        """Sets the distances of people managed from now on.

        radius_h: half the breadth that two walkers keep clear, over height, 0.02 to 0.5. shoulders_h: half the breadth
        of the shoulders, over height, radius_h to 0.5, kept clear of walls, discs and unmanaged people. Walkers closer
        to others turn the shoulders. overlap_m: maximum overlap of two walkers after waiting, 0 to 0.2.
        """
        self._world._do(lib.mobil_avoidance_set_options(self._world._sim, _fill("avoidance_options", options)))

    def manage(self, people: People) -> None:
        """Manages walkers from now on. Their desired velocity is the last requested one."""
        self._world._do(lib.mobil_avoidance_manage(self._world._sim, *_all(people), 1))

    def release(self, people: People) -> None:
        """Stops managing walkers. They keep their gait, and after a slope that slows them take the desired one."""
        self._world._do(lib.mobil_avoidance_manage(self._world._sim, *_all(people), 0))

    def set_desired_velocity(self, people: People, speed_m_s: npt.ArrayLike, heading_rad: npt.ArrayLike) -> None:
        """Sets the desired velocities of walkers; speed 0: stand."""
        people = _people(people)
        rows = np.empty((people.size, 2), np.float32)
        rows[:, 0] = column(speed_m_s, people.size, "speed_m_s")
        rows[:, 1] = column(heading_rad, people.size, "heading_rad")
        self._world._do(lib.mobil_avoidance_set_desired_velocity(self._world._sim, *_all(people), _floats(rows), 0))

    def set_walls(self, walls: npt.ArrayLike, heights: npt.ArrayLike | None = None) -> None:
        """Replaces all straight walls: (n, 2, 3), both ends, in the world's axes.

        heights: (n, 2), bottom and top of each, if floors lie above each other. Walkers whose ground is at or above the
        top, or more than 2 m below the bottom, do not see it. By default a wall has all heights.
        """
        rows = numbers(walls, "walls")
        if rows.size and rows.shape[1:] != (2, 3):
            refuse(f"walls have the shape {rows.shape}; give (n, 2, 3), both ends of each")
        rows = rows.reshape(-1, 6)
        self._set_obstacles(lib.mobil_avoidance_set_walls_between, rows, heights, "wall")

    def set_discs(
        self,
        place: npt.ArrayLike,
        radius: npt.ArrayLike,
        velocity: npt.ArrayLike = (0.0, 0.0, 0.0),
        heights: npt.ArrayLike | None = None,
    ) -> None:
        """Replaces all discs (players, cars, pillars): (n, 3), (n,) and (n, 3), in the world's axes and unit.

        heights: as for walls.
        """
        places = numbers(place, "place")
        places = places.reshape(-1, 3) if places.shape in ((0,), (3,)) else places
        rows = np.empty((len(places) if places.ndim else 1, 7), np.float32)
        rows[:, :3] = column(places, len(rows), "place", 3, "disc")
        rows[:, 3:6] = column(velocity, len(rows), "velocity", 3, "disc")
        rows[:, 6] = column(radius, len(rows), "radius", of="disc")
        self._set_obstacles(lib.mobil_avoidance_set_discs_between, rows, heights, "disc")

    def _set_obstacles(self, call: Any, rows: Floats, heights: npt.ArrayLike | None, of: str) -> None:
        ranges = np.empty((len(rows), 2), np.float32)
        if heights is not None:
            ranges[:] = column(heights, len(rows), "heights", 2, of, finite=False)
        between = ffi.NULL if heights is None else _floats(ranges)
        self._world._do(call(self._world._sim, _floats(rows), 0, between, 0, len(rows)))

    @property
    def report(self) -> AvoidanceReport:
        """Counts of all ticks of the last advance or tick."""
        did = struct("avoidance_counts")
        self._world._do(lib.mobil_avoidance_report(self._world._sim, did))
        return AvoidanceReport(*(getattr(did, name) for name in AvoidanceReport._fields))


Heights = Callable[[Floats], Any]


def _ground(heights: npt.ArrayLike, normals: npt.ArrayLike = (0.0, 0.0, 0.0), *, count: int | None = None) -> Floats:
    """Returns rows of height and normal; numbers that are not finite are those of unusable places."""
    values = numbers(heights, "heights", finite=False)
    rows = np.empty((np.size(values) if count is None else count, 4), np.float32)
    rows[:, 0] = spread(values, len(rows), "heights", of="place")
    rows[:, 1:] = column(normals, len(rows), "normals", 3, "place", finite=False)
    return rows


class TerrainReport(NamedTuple):
    """Counts of all ticks of the last advance or tick."""

    people: int
    asked: int
    """Queried steps."""
    places: int
    unusable: int
    """Results that were not finite, or whose normal did not point up."""


class Terrain(Owner):
    """Uneven ground of a world: World.terrain."""

    _instead = "use that of a World"

    def __init__(self, world: World) -> None:
        self._world = world

    def set_heights(self, heights: Heights | None) -> None:
        """Sets the function that ticks call from now on, or none.

        heights: takes positions (n, 3) in the world's axes. Returns heights (n,), or with normals ((n,), (n, 3)).
        Without normals walkers stand on level patches of that height, as on stairs. An exception ends the tick before
        any person moves, and is raised by advance or tick. The function must not use the world.
        """
        def answer(_: Any, places: Any, __: Any, count: int, ground: Any) -> int:
            try:
                at = np.frombuffer(ffi.buffer(places, 12 * count), np.float32).reshape(-1, 3).copy()
                rows = np.frombuffer(ffi.buffer(ground, 16 * count), np.float32).reshape(-1, 4)
                answers = heights(at)
                rows[:] = _ground(*(answers if isinstance(answers, tuple) else (answers,)), count=count)
            except BaseException as error:
                keep(error)
                return 1
            return 0

        def interrupted(_: Any, error: BaseException, __: Any) -> None:
            keep(error)

        if heights is not None and not callable(heights):
            refuse_type(f"heights is {shown(heights)}; give a function of positions, or None")
        call = ffi.NULL if heights is None else ffi.callback("mobil_heights", answer, error=1, onerror=interrupted)
        self._world._do(lib.mobil_terrain_set_heights(self._world._sim, call, ffi.NULL))
        self._world._heights = call  # must live as long as it can be called

    def set_speed_scaling(self, on: bool = True) -> None:
        """Switches speed scaling: walkers slow down on slopes and stairs, but not on level ground."""
        self._world._do(lib.mobil_terrain_set_speed_scaling(self._world._sim, switch(on, "on")))

    def manage(self, people: People) -> None:
        """Puts walkers on that ground from the next tick on."""
        self._world._do(lib.mobil_terrain_manage(self._world._sim, *_all(people), 1))

    def release(self, people: People) -> None:
        """Returns walkers to the level plane through the origin."""
        self._world._do(lib.mobil_terrain_manage(self._world._sim, *_all(people), 0))

    def query(self) -> tuple[Floats, People]:
        """Returns the queries of the next tick, for use without set_heights: positions (n, 3) and people (n,)."""
        count = ffi.new("size_t*")
        self._world._do(lib.mobil_terrain_query(self._world._sim, ffi.NULL, 0, ffi.NULL, 0, count))
        places, who = np.empty((count[0], 3), np.float32), np.zeros(count[0], PERSON)
        if count[0]:
            at, ids = _floats(places), _ids(who)
            self._world._do(lib.mobil_terrain_query(self._world._sim, at, 0, ids, count[0], ffi.NULL))
        return places, who

    def resolve(self, heights: npt.ArrayLike, normals: npt.ArrayLike = (0.0, 0.0, 0.0)) -> int:
        """Sets the ground at the positions of the last query(). Returns the number of unusable results."""
        rows = _ground(heights, normals)
        unusable = ffi.new("size_t*")
        self._world._do(lib.mobil_terrain_resolve(self._world._sim, _floats(rows), 0, len(rows), unusable))
        return int(unusable[0])

    @property
    def report(self) -> TerrainReport:
        """Counts of all ticks of the last advance or tick."""
        did = struct("terrain_counts")
        self._world._do(lib.mobil_terrain_report(self._world._sim, did))
        return TerrainReport(*(getattr(did, name) for name in TerrainReport._fields))
