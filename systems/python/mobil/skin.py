"""Skin, clothes and hair as triangles."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import names
from ._library import Owner, ffi, lib, struct
from .arrays import People, _one, _people
from .surfaces import aim, room
from .values import contents, integers, number, number_of, numbers, refuse, switch
from .world import World

DETAILS = ("hero", "near", "far", "distant")
PARTS = ("skin", "legs", "lips", "hair", "shirt", "shorts", "shoes")


def _target(target: Any, person: People, out: npt.NDArray[np.float32], flexing: bool, ahead_s: float) -> None:
    target.size = ffi.sizeof("mobil_skin_target")
    target.id = _one(person)
    target.sex, target.flexing = -1, switch(flexing, "flexing")
    target.ahead_s = number(ahead_s, "ahead_s")
    aim(target, out)


def bake_skins(world: World) -> bytes:
    """Returns the skins of usual builds as bytes for load_skins, made in some 10 s."""
    size = ffi.new("size_t*")
    world._do(lib.mobil_bake_skins(world._sim, ffi.NULL, 0, size))
    out = bytearray(size[0])
    world._do(lib.mobil_bake_skins(world._sim, ffi.from_buffer(out), len(out), ffi.NULL))
    return bytes(out)


def load_skins(world: World, baked: bytes) -> None:
    """Loads the bytes of bake_skins, so that a world's first skins take no time."""
    data = contents(baked, "baked")
    world._do(lib.mobil_load_skins(world._sim, data, len(data)))


class Binding(NamedTuple):
    """A skin for linear blend skinning: the body in the anatomical position over the origin, in the world's axes and
    unit. A vertex is at the sum of weight * pose * inverse bind * position over its joints."""

    positions: npt.NDArray[np.float32]
    """(vertices, 3). Vertices are doubled on seams of the texture."""
    normals: npt.NDArray[np.float32]
    """(vertices, 3)."""
    tangents: npt.NDArray[np.float32]
    """(vertices, 4), as in glTF."""
    texture: npt.NDArray[np.float32]
    """(vertices, 2): right and down from the upper left corner, 0 to 1."""
    joints: npt.NDArray[np.uint8]
    """(vertices, 4): indices into mobil.SEGMENTS, heaviest first."""
    weights: npt.NDArray[np.float32]
    """(vertices, 4), which add up to 1."""
    same_as: npt.NDArray[np.uint32]
    """(vertices,): numbers in Skin.vertices."""
    triangles: npt.NDArray[np.uint32]
    """(n, 3), in the order of Skin.triangles."""
    inverse_binds: npt.NDArray[np.float32]
    """(48, 4, 4)."""


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
        self,
        world: World,
        people: People,
        out: npt.NDArray[np.float32] | None = None,
        *,
        flexing: bool = False,
        ahead_s: float = 0.0,
    ) -> npt.NDArray[np.float32]:
        """Returns positions and unit normals, (n, vertices, 6), of people of this sex.

        flexing: legs move as if muscles moved under their skin; one second for the first person of a build. ahead_s:
        time after the last tick, 0 to 0.2, for example alpha times tick_s."""
        people = _people(people)
        out = room(out, people.size, self.vertex_count)
        targets = ffi.new("mobil_skin_target[]", max(people.size, 1))
        for i in range(people.size):
            _target(targets[i], people[i], out[i], flexing, ahead_s)
            targets[i].detail, targets[i].sex = self.detail, self.sex
        world._do(lib.mobil_write_skin(world._sim, targets, 0, people.size))
        return out

    def binding(self, world: World, person: People) -> Binding:
        """Returns the skin of a person of this sex as joints and weights, for people of similar build."""
        count: int = lib.mobil_binding_vertex_count(self.sex, self.detail)
        made = Binding(
            *(np.empty((count, width), np.float32) for width in (3, 3, 4, 2)),
            joints=np.empty((count, 4), np.uint8),
            weights=np.empty((count, 4), np.float32),
            same_as=np.empty(count, np.uint32),
            triangles=np.empty(self.triangles.shape, np.uint32),
            inverse_binds=np.tile(np.eye(4, dtype=np.float32), (len(names.SEGMENTS), 1, 1)),
        )
        rows = np.empty((len(names.SEGMENTS), 3, 4), np.float32)
        to = struct("skin_binding")
        to.detail, to.sex, to.vertices, to.index_room = self.detail, self.sex, count, made.triangles.size
        for name in ("positions", "normals", "tangents", "texture", "weights"):
            setattr(to, name, ffi.from_buffer("float[]", getattr(made, name)))
        to.joints = ffi.from_buffer("unsigned char[]", made.joints)
        to.same_as = ffi.from_buffer("unsigned int[]", made.same_as)
        to.indices = ffi.from_buffer("unsigned int[]", made.triangles)
        to.inverse_binds = ffi.from_buffer("float[]", rows)
        world._do(lib.mobil_get_skin_binding(world._sim, _one(person), to))
        made.inverse_binds[:, :3] = rows
        return made


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
        self,
        world: World,
        people: People,
        out: npt.NDArray[np.float32] | None = None,
        *,
        flexing: bool = False,
        ahead_s: float = 0.0,
    ) -> npt.NDArray[np.float32]:
        """Returns positions and unit normals of both legs, (n, vertices, 6). ahead_s: time after the last tick, 0 to
        0.2."""
        people = _people(people)
        out = room(out, people.size, self.vertex_count)
        targets = ffi.new("mobil_skin_target[]", max(people.size, 1))
        for i in range(people.size):
            _target(targets[i], people[i], out[i], flexing, ahead_s)
        world._do(lib.mobil_write_custom_skin(world._sim, self._skin, targets, 0, people.size))
        return out
