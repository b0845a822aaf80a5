"""Deprecated names, removed in 0.5. Each warns with its replacement."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from . import surroundings
from ._library import lib
from .arrays import People, _all
from .lod import Choice
from .surroundings import AvoidanceReport, Heights
from .values import number, switch

if TYPE_CHECKING:
    from .world import World


def _old(name: str, instead: str) -> None:
    warnings.warn(f"{name} goes in mobil 0.5; use {instead}", DeprecationWarning, stacklevel=3)


class OldWorld:
    """Deprecated members of World."""

    def set_forces(self: Any, people: People, on: bool = True) -> None:
        _old("World.set_forces", 'enable(people, "forces", on)')
        self._do(lib.mobil_set_forces(self._sim, *_all(people), switch(on, "on")))

    def set_fat_wobble(self: Any, people: People, on: bool = True) -> None:
        _old("World.set_fat_wobble", 'enable(people, "fat", on)')
        self.enable(people, "fat", on)

    def watch(self: Any, people: People, on: bool = True) -> None:
        _old("World.watch", 'enable(people, "step_events", on)')
        self.enable(people, "step_events", on)

    def sleep(self: Any, people: People) -> int:
        _old("World.sleep", 'set_state(people, "asleep")')
        return self.set_state(people, "asleep")

    def wake(self: Any, people: People, within_m: float = 0.005) -> None:
        _old("World.wake", 'set_state(people, "full")')
        self._do(lib.mobil_wake(self._sim, *_all(people), number(within_m, "within_m")))

    def compact(self: Any, people: People) -> int:
        _old("World.compact", 'set_state(people, "compact")')
        return self.set_state(people, "compact")

    def expand(self: Any, people: People) -> None:
        _old("World.expand", 'set_state(people, "full")')
        self._do(lib.mobil_expand(self._sim, *_all(people)))

    def start_choosing(self: Any, *, muscles: Any = None, **options: Any) -> None:
        _old("World.start_choosing", "lod.set_options")
        self.lod.set_options(muscles=muscles, **options)

    def set_scene(self: Any, **fields: Any) -> None:
        _old("World.set_scene", "lod.set_scene")
        self.lod.set_scene(**fields)

    def prepare_scene(self: Any) -> None:
        _old("World.prepare_scene", "lod.prepare")
        self.lod.prepare()

    def manage(self: Any, people: People, **needs: Any) -> None:
        _old("World.manage", "lod.manage")
        self.lod.manage(people, **needs)

    def release(self: Any, people: People) -> None:
        _old("World.release", "lod.release")
        self.lod.release(people)

    def choose(self: Any) -> dict[str, float]:
        _old("World.choose", "lod.report: ticks choose")
        return self.lod.report

    def why(self: Any, person: People, muscle: str) -> Choice:
        _old("World.why", "lod.why")
        return self.lod.why(person, muscle)


class Avoidance(surroundings.Avoidance):
    """Deprecated: World.avoidance."""

    def __init__(self, world: World, **options: float | None) -> None:
        _old("mobil.Avoidance", "World.avoidance")
        super().__init__(world)
        self.set_options(**{name: value for name, value in options.items() if value is not None})
        self.set_walls([])
        world._do(lib.mobil_avoidance_set_discs(world._sim, surroundings.ffi.NULL, 0, 0))

    def update(self) -> AvoidanceReport:
        _old("Avoidance.update", "Avoidance.report: ticks choose")
        return self.report


class Terrain(surroundings.Terrain):
    """Deprecated: World.terrain."""

    def __init__(self, world: World, heights: Heights, slows_down: bool = False) -> None:
        _old("mobil.Terrain", "World.terrain")
        super().__init__(world)
        world.terrain.set_heights(heights)
        self.set_speed_scaling(slows_down)

    def update(self) -> int:
        _old("Terrain.update", "Terrain.report: ticks ask")
        return self.report.unusable
