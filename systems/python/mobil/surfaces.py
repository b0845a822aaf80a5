"""Bones and muscles as triangles."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import names
from ._library import Owner, fail, ffi, lib, text
from .arrays import People, _one, _people
from .structs import _fill
from .values import number, refuse, switch
from .world import World


def room(out: npt.NDArray[np.float32] | None, people: int, vertices: int) -> npt.NDArray[np.float32]:
    """Returns an array (people, vertices, 6) for positions and normals: the caller's or a new one."""
    shape = (people, vertices, 6)
    out = np.empty(shape, np.float32) if out is None else out
    if not isinstance(out, np.ndarray) or out.shape != shape or out.dtype != np.float32 or not out.flags.carray:
        refuse(f"out must be a writable float32 array of shape {shape}, its numbers close together")
    return out


def aim(target: Any, out: npt.NDArray[np.float32]) -> None:
    """Sets a target's streams to one person's array (vertices, 6)."""
    at, row = out.ctypes.data, 6 * 4
    target.positions, target.normals = ffi.cast("void*", at), ffi.cast("void*", at + row // 2)
    target.position_stride = target.normal_stride = row
    target.position_bytes = out.nbytes
    target.normal_bytes = out.nbytes - row // 2


class Part(NamedTuple):
    """A bone, or a muscle or tendon of one side, with contiguous vertices and indices."""

    name: str
    segment: str | None
    """Segment of a bone, or None."""
    muscle: str | None
    """Muscle whose mesh it follows, or None."""
    vertices: slice
    indices: slice


class Surfaces(Owner):
    """Surfaces bound to the body of one person, for people of similar build.

    choice: fields of mobil_surface_choice: bones, side ("right", "left" or "both"), muscles, cells, detail,
    textured. contact: resolves contacts of single muscles with each other and with bones, for close views. It takes
    half a second here, and about 10 ms a person and call.
    """

    _instead = "bind them in each process"

    def __init__(self, world: World, like: People, *, contact: bool = False, **choice: Any) -> None:
        made = ffi.new("mobil_surfaces**")
        world._do(lib.mobil_bind_surfaces(world._sim, _one(like), _fill("surface_choice", choice), made))
        self._surfaces = ffi.gc(made[0], lib.mobil_drop_surfaces)
        self.triangles: npt.NDArray[np.uint32] = np.empty(lib.mobil_index_count(self._surfaces), np.uint32)
        code = lib.mobil_indices(
            self._surfaces, ffi.from_buffer("unsigned int[]", self.triangles), self.triangles.size
        )
        if code != 0:
            fail(code, "the triangles cannot be read")
        self.triangles = self.triangles.reshape(-1, 3)
        self.vertex_count: int = lib.mobil_vertex_count(self._surfaces)
        self.tissue: npt.NDArray[np.uint8] = np.empty((self.vertex_count, 4), np.uint8)
        """(vertices, 4), 0 to 255 for 0 to 1: along and around the surface, tendon, aponeurosis. Bones have zeros."""
        code = lib.mobil_surface_tissue(
            self._surfaces, ffi.from_buffer("unsigned char[]", self.tissue), self.tissue.size
        )
        if code != 0:
            fail(code, "the tissue cannot be read")
        self.parts = tuple(self._parts())
        self._contacts: Any = None
        if switch(contact, "contact"):
            found = ffi.new("mobil_contacts**")
            world._do(lib.mobil_find_contacts(world._sim, _one(like), self._surfaces, found))
            self._contacts = ffi.gc(found[0], lib.mobil_drop_contacts)

    def _parts(self):
        part = ffi.new("mobil_part*")
        number = 0
        while lib.mobil_surface_part(self._surfaces, number, part) == lib.MOBIL_OK:
            yield Part(
                text(part.name),
                names.SEGMENTS[part.segment] if part.segment >= 0 else None,
                names.MUSCLES[part.muscle] if part.muscle >= 0 else None,
                slice(part.first_vertex, part.first_vertex + part.vertices),
                slice(part.first_index // 3, (part.first_index + part.indices) // 3),
            )
            number += 1

    def vertices(
        self,
        world: World,
        people: People,
        out: npt.NDArray[np.float32] | None = None,
        *,
        ahead_s: float = 0.0,
    ) -> npt.NDArray[np.float32]:
        """Returns positions and unit normals, (n, vertices, 6). ahead_s: time after the last tick, 0 to 0.2, for
        example alpha times tick_s."""
        people = _people(people)
        out = room(out, people.size, self.vertex_count)
        targets = ffi.new("mobil_surface_target[]", max(people.size, 1))
        for i in range(people.size):
            target = targets[i]
            target.size = ffi.sizeof("mobil_surface_target")
            target.id = _one(people[i])
            target.surfaces = self._surfaces
            target.ahead_s = number(ahead_s, "ahead_s")
            aim(target, out[i])
        world._do(lib.mobil_write_surfaces(world._sim, targets, 0, people.size))
        if self._contacts is not None:
            world._do(lib.mobil_keep_apart(world._sim, self._contacts, targets, 0, people.size))
        return out
