"""A person's body: joints, masses and inertias of segments."""

from __future__ import annotations

from typing import Any, Iterable, NamedTuple

import numpy as np
import numpy.typing as npt

from . import names
from ._library import ffi, lib
from .arrays import People, _one
from .values import number_of, refuse, shown
from .world import World


class Body(NamedTuple):
    """Arrays with one row for each of mobil.SEGMENTS, in the frames in which World.poses writes segments, in the world's
    axes and unit. In the anatomical position all rotations are identity. mobil.PARENTS has the parents."""

    offsets: npt.NDArray[np.float32]
    """(48, 3): joint, from the parent's joint; of the pelvis, from the ground below it."""
    tips: npt.NDArray[np.float32]
    """(48, 3): far end, from the joint."""
    masses_kg: npt.NDArray[np.float32]
    """(48,)."""
    centres: npt.NDArray[np.float32]
    """(48, 3): centre of mass, from the joint."""
    inertias_kg_m2: npt.NDArray[np.float32]
    """(48, 3): principal moments about the centre and the axes of the frame."""


def typical_person(
    sex: str | int = "man", age_y: float = 25.0, height_z: float = 0.0, mass_index_z: float = 0.0
) -> dict[str, Any]:
    """Returns the arguments of World.spawn for a typical person, with usual speed and style. Deviations are standard scores
    of stature and body mass index for that sex and age."""
    style = ffi.new("float[]", len(names.STYLE))
    made = ffi.new("mobil_person*")
    lib.mobil_defaults(lib.MOBIL_PERSON, made, ffi.sizeof("mobil_person"))
    number = number_of(sex, names.SEXES, "sex")
    code = lib.mobil_typical_person(number, age_y, height_z, mass_index_z, style, len(style), made)
    if code != lib.MOBIL_OK:
        refuse(
            f"no typical {names.SEXES[number]} of {shown(age_y)} years deviates by {shown(height_z)} and "
            f"{shown(mass_index_z)}; choose 6 to 95 years and smaller deviations"
        )
    return {
        "sex": names.SEXES[number],
        "age_y": age_y,
        "height_m": made.height_m,
        "mass_kg": made.mass_kg,
        "speed_m_s": made.speed_m_s,
        "style": dict(zip(names.STYLE, style)),
    }


def body(world: World, person: People) -> Body:
    """Returns the body of a person."""
    count = len(names.SEGMENTS)
    rows = ffi.new("mobil_segment[]", count)
    rows[0].size = ffi.sizeof("mobil_segment")
    world._do(lib.mobil_get_body(world._sim, _one(person), rows, 0))

    def column(name: str) -> npt.NDArray[np.float32]:
        return np.array([list(getattr(row, name)) for row in rows], np.float32)

    masses = np.array([row.mass_kg for row in rows], np.float32)
    return Body(column("offset"), column("tip"), masses, column("centre"), column("inertia_kg_m2"))


def segments_of(bones: Iterable[str]) -> list[int | None]:
    """Returns the index of the segment of each bone, by its name or the end of it (person_7_head), or None.

    Programs number bones in another order than mobil.SEGMENTS, so bones are found by name."""
    listed = [ffi.new("char[]", str(name).encode()) for name in bones]
    out = ffi.new("int[]", max(len(listed), 1))
    lib.mobil_segments_of(ffi.new("const char*[]", listed), len(listed), out)
    return [number if number >= 0 else None for number in out[0 : len(listed)]]
