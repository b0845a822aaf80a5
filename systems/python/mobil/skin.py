"""Skin, clothes and hair as triangles."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import names
from ._library import Owner, ffi, lib, struct
from .arrays import People, _one, _people
from .surfaces import aim, room
from .values import integers, number_of, numbers, refuse, switch
from .world import World

DETAILS = ("hero", "near", "far", "distant")
PARTS = ("skin", "legs", "lips", "hair", "shirt", "shorts", "shoes")


def _target(target: Any, person: People, out: npt.NDArray[np.float32], flexing: bool) -> None:
    target.size = ffi.sizeof("mobil_skin_target")
    target.id = _one(person)
    target.sex, target.flexing = -1, switch(flexing, "flexing")
    aim(target, out)


class Skin:
    """Triangles of the skin of one sex, and vertices of people after a tick.

    detail: "hero" (about 90000 triangles), "near", "far" or "distant" (1200).
    """

    def __init__(self, world: World, sex: str | int = "man", detail: str | int = "near") -> None:
        self.sex = number_of(sex, names.SEXES, "sex")
        self.detail = number_of(detail, DETAILS, "detail")
        made = lib.mobil_skin_indices(world._sim, self.sex, self.detail, ffi.new("unsigned int*"), 0, ffi.NULL)
        if made != lib.MOBIL_ROOM:  # the mesh is made in a call that hears signals
            world._do(made)
        self.vertex_count: int = lib.mobil_skin_vertex_count(self.sex, self.detail)
        index: npt.NDArray[np.uint32] = np.empty(lib.mobil_skin_index_count(self.sex, self.detail), np.uint32)
        first = ffi.new("unsigned int[]", len(PARTS) + 1)
        world._do(
            lib.mobil_skin_indices(
                world._sim, self.sex, self.detail, ffi.from_buffer("unsigned int[]", index), index.size, first
            )
        )
        self.triangles = index.reshape(-1, 3)
        self.parts = {name: slice(first[i], first[i + 1]) for i, name in enumerate(PARTS)}
        """Triangles of "skin", "legs", "lips", "hair", "shirt", "shorts" and "shoes", as slices."""

    def vertices(
        self, world: World, people: People, out: npt.NDArray[np.float32] | None = None, *, flexing: bool = False
    ) -> npt.NDArray[np.float32]:
        """Returns positions and unit normals after the last tick, (n, vertices, 6), of people of this sex.

        flexing: legs move as if muscles moved under their skin; one second for the first person of a build."""
        people = _people(people)
        out = room(out, people.size, self.vertex_count)
        targets = ffi.new("mobil_skin_target[]", max(people.size, 1))
        for i in range(people.size):
            _target(targets[i], people[i], out[i], flexing)
            targets[i].detail, targets[i].sex = self.detail, self.sex
        world._do(lib.mobil_write_skin(world._sim, targets, 0, people.size))
        return out


class CustomSkin(Owner):
    """A mesh of a right leg, for example from a scan, and its mirror image, which move with the body's skin.

    positions: (vertices, 3) in the world's axes and unit, for a person at the origin in the anatomical position,
    heading ahead. triangles: (n, 3), wound outwards. The mesh is bound to the body of one person and can be used for
    people of the same sex and similar build. shorts_stay: the body's shorts are drawn over it.
    """

    _instead = "send the mesh, and bind it in each process"

    def __init__(
        self,
        world: World,
        like: People,
        positions: npt.ArrayLike,
        triangles: npt.ArrayLike,
        *,
        detail: str | int = "near",
        shorts_stay: bool = False,
    ) -> None:
        at = numbers(positions, "positions")
        corners = integers(triangles, "triangles")
        if at.shape[1:] != (3,) or corners.shape[1:] != (3,):
            shapes = f"{at.shape} and {corners.shape}"
            refuse(f"positions and triangles have the shapes {shapes}; give (vertices, 3) and (n, 3)")
        mesh = struct("leg_mesh")
        mesh.positions, mesh.vertices = ffi.from_buffer("float[]", at), len(at)
        mesh.indices, mesh.index_count = ffi.from_buffer("unsigned int[]", corners), corners.size
        mesh.detail = number_of(detail, DETAILS, "detail")
        mesh.shorts_stay = switch(shorts_stay, "shorts_stay")
        made = ffi.new("mobil_custom_skin**")
        world._do(lib.mobil_bind_custom_skin(world._sim, _one(like), mesh, made))
        self._skin = ffi.gc(made[0], lib.mobil_drop_custom_skin)
        self.vertex_count: int = lib.mobil_custom_skin_vertex_count(self._skin)
        index: npt.NDArray[np.uint32] = np.empty(lib.mobil_custom_skin_index_count(self._skin), np.uint32)
        lib.mobil_custom_skin_indices(self._skin, ffi.from_buffer("unsigned int[]", index), index.size)
        self.triangles = index.reshape(-1, 3)
        count = ffi.new("size_t*")
        lib.mobil_custom_skin_rest(self._skin, ffi.NULL, 0, count)
        rest: npt.NDArray[np.uint32] = np.empty(count[0], np.uint32)
        lib.mobil_custom_skin_rest(self._skin, ffi.from_buffer("unsigned int[]", rest), rest.size, ffi.NULL)
        self.rest = rest.reshape(-1, 3)
        """Triangles of Skin(world, sex, detail) that must be drawn in addition."""

    def vertices(
        self, world: World, people: People, out: npt.NDArray[np.float32] | None = None, *, flexing: bool = False
    ) -> npt.NDArray[np.float32]:
        """Returns positions and unit normals of both legs after the last tick, (n, vertices, 6)."""
        people = _people(people)
        out = room(out, people.size, self.vertex_count)
        targets = ffi.new("mobil_skin_target[]", max(people.size, 1))
        for i in range(people.size):
            _target(targets[i], people[i], out[i], flexing)
        world._do(lib.mobil_write_custom_skin(world._sim, self._skin, targets, 0, people.size))
        return out
