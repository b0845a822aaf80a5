"""How finely whose muscles are computed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from . import names
from ._library import ffi, lib, struct, text
from .arrays import People, _all, _one
from .names import number_of
from .structs import _fill

if TYPE_CHECKING:
    from .world import World


class Choice(NamedTuple):
    why: str
    error_m: float
    cost_us: float


class Lod:
    """Level of detail of a world: World.lod. Each tick gives muscles of managed people the cheapest method that is good
    enough for the scene."""

    def __init__(self, world: World) -> None:
        self._world = world

    def set_options(self, *, muscles: Any = None, **options: Any) -> None:
        """The fields of mobil_lod_options; muscles: mobil.muscles(…) of those whom managing gives some."""
        muscles = ffi.NULL if muscles is None else muscles
        self._world._do(lib.mobil_lod_set_options(self._world._sim, _fill("lod_options", options), muscles))

    def set_scene(self, **fields: Any) -> None:
        """What is good enough: the fields of mobil_scene; a camera where `eye` and `gaze` are given."""
        if "eye" in fields:
            fields = {"has_camera": 1, **fields}
        self._world._do(lib.mobil_lod_set_scene(self._world._sim, _fill("scene", fields)))

    def prepare(self) -> None:
        """Makes what the scene may call for: some seconds, and no tick waits later."""
        self._world._do(lib.mobil_lod_prepare(self._world._sim))

    def manage(self, people: People, **needs: Any) -> None:
        """Their muscles are chosen from the next tick on; needs of their own: the fields of mobil_needs."""
        self._world._do(lib.mobil_lod_manage(self._world._sim, *_all(people), _fill("needs", needs)))

    def release(self, people: People) -> None:
        """Methods stay as they are and are no longer chosen. Who sleeps wakes."""
        self._world._do(lib.mobil_lod_release(self._world._sim, *_all(people)))

    def why(self, person: People, muscle: str) -> Choice:
        """Why a muscle has its method; its predicted error and cost, of one leg and tick."""
        line = ffi.new("char[512]")
        error, cost = ffi.new("float*"), ffi.new("double*")
        number = number_of(muscle, names.MUSCLES, "muscle")
        self._world._do(lib.mobil_lod_why(self._world._sim, _one(person), number, line, 512, error, cost))
        return Choice(text(line), error[0], cost[0])

    @property
    def report(self) -> dict[str, float]:
        """What was chosen in all ticks of the last advance or tick: the fields of mobil_lod_counts."""
        did = struct("lod_counts")
        self._world._do(lib.mobil_lod_report(self._world._sim, did))
        return {name: getattr(did, name) for name, _ in ffi.typeof(did).item.fields if name != "size"}
