"""Level of detail of muscles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from . import names
from ._library import Owner, ffi, lib, struct, text
from .arrays import People, _all, _one
from .structs import Muscles, _fill, pointer
from .values import number_of

if TYPE_CHECKING:
    from .world import World


class Choice(NamedTuple):
    why: str
    error_m: float
    cost_us: float


class Lod(Owner):
    """Level of detail of a world: World.lod. Each tick chooses the cheapest method that is accurate enough, for each
    muscle of managed people."""

    _instead = "use that of a World"

    def __init__(self, world: World) -> None:
        self._world = world

    def set_options(self, *, muscles: Any = None, **options: Any) -> None:
        """Sets the fields of mobil_lod_options. muscles: mobil.muscles(…) of people who get muscles by manage."""
        of = pointer(muscles, Muscles)
        self._world._do(lib.mobil_lod_set_options(self._world._sim, _fill("lod_options", options), of))

    def set_scene(self, **fields: Any) -> None:
        """Sets the needs of the scene: the fields of mobil_scene, with a camera if `eye` is given."""
        if "eye" in fields:
            fields = {"has_camera": 1, **fields}
        self._world._do(lib.mobil_lod_set_scene(self._world._sim, _fill("scene", fields)))

    def prepare(self) -> None:
        """Makes the shared data that the scene can require, in some seconds, so that no tick waits for it."""
        self._world._do(lib.mobil_lod_prepare(self._world._sim))

    def manage(self, people: People, **needs: Any) -> None:
        """Manages the muscles of people from the next tick on. needs: the fields of mobil_needs."""
        self._world._do(lib.mobil_lod_manage(self._world._sim, *_all(people), _fill("needs", needs)))

    def release(self, people: People) -> None:
        """Stops managing people. Methods stay as they are, and sleepers wake."""
        self._world._do(lib.mobil_lod_release(self._world._sim, *_all(people)))

    def why(self, person: People, muscle: str) -> Choice:
        """Returns the reason for a muscle's method, and its predicted error and cost, for one leg and tick."""
        line = ffi.new("char[512]")
        error, cost = ffi.new("float*"), ffi.new("double*")
        number = number_of(muscle, names.MUSCLES, "muscle")
        self._world._do(lib.mobil_lod_why(self._world._sim, _one(person), number, line, 512, error, cost))
        return Choice(text(line), error[0], cost[0])

    @property
    def report(self) -> dict[str, float]:
        """Counts of all ticks of the last advance or tick: the fields of mobil_lod_counts."""
        did = struct("lod_counts")
        self._world._do(lib.mobil_lod_report(self._world._sim, did))
        return {name: getattr(did, name) for name, _ in ffi.typeof(did).item.fields if name != "size"}
