"""Skin, clothes and hair as triangles."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import names
from ._library import ffi, lib
from .surfaces import aim, room
from .world import People, World, _one

DETAILS = ("hero", "near", "far", "distant")
PARTS = ("skin", "legs", "lips", "hair", "shirt", "shorts", "shoes")


class Skin:
    """The triangles of all men, or of all women, and their vertices after each tick.

    detail: "hero" (some 90000 triangles), "near", "far" or "distant" (1200).
    """

    def __init__(self, world: World, sex: str | int = "man", detail: str | int = "near") -> None:
        self.sex = names.number_of(sex, names.SEXES, "sex")
        self.detail = names.number_of(detail, DETAILS, "detail")
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
        """Of "skin", "legs", "lips", "hair", "shirt", "shorts" and "shoes": which triangles."""

    def vertices(
        self, world: World, people: People, out: npt.NDArray[np.float32] | None = None, *, flexing: bool = False
    ) -> npt.NDArray[np.float32]:
        """(n, vertices, 6): positions and unit normals after the last tick, of people of this sex. `flexing`: legs
        move as if muscles moved under their skin; a second for the first person of a build."""
        people = np.atleast_1d(people)
        out = room(out, len(people), self.vertex_count)
        targets = ffi.new("mobil_skin_target[]", max(len(people), 1))
        for i in range(len(people)):
            target = targets[i]
            target.size = ffi.sizeof("mobil_skin_target")
            target.id = _one(people[i])
            target.detail, target.sex, target.flexing = self.detail, self.sex, flexing
            aim(target, out[i])
        world._do(lib.mobil_write_skin(world._sim, targets, 0, len(people)))
        return out
