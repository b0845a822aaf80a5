"""Names of the library's numbers: segments, muscles, style parameters, columns of rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterable

from ._library import ffi, lib, text
from .values import integer, number_of, one_or_many

SIDES = ("right", "left")
CONSTITUTIONS = ("thin", "average", "athletic", "heavy")
SEXES = ("man", "woman")
METHODS = ("static", "explicit_central", "implicit_central", "newmark", "modal", "none", "finite")
ELEMENTS = ("full", "bbar", "one_point")
MASSES = ("lumped", "consistent")
DRIVES = ("displacement", "force")
ACTIVATIONS = ("none", "phase", "host", "moments")
AXES = ("y_up", "unity", "unreal", "godot", "z_up")
FEATURES = ("step_events", "fat", "forces")
EVENTS = ("heel_strike", "toe_off", "stopped", "started")
"""Kinds of step events: `kind` of mobil.EVENT."""
FORMS = ("quaternion", "matrix", "dual_quaternion")


def _two_sides(names: Iterable[str]) -> tuple[str, ...]:
    return tuple(f"{name}_{side}" for name in names for side in SIDES)


JOINTS = ("pelvis_rotation", "pelvis_list", "pelvis_tilt") + _two_sides(
    ("hip_flexion", "knee_flexion", "ankle_dorsiflexion", "shoulder_flexion", "elbow_flexion")
)
"""Columns of World.joints, rad."""
MOMENTS = _two_sides(("hip", "knee", "ankle"))
"""Columns of World.moments, N m, extensor and plantarflexor positive."""
LINE = ("length_m", "rest_length_m", "stiffness_n_per_m", "force_n")
LINE_MOTION = ("speed_m_s", "hip_arm_m", "knee_arm_m", "ankle_arm_m")
REPORT = ("elongation_m", "reaction_n", "volume_ratio", "kinetic_energy_j", "strain_energy_j")
ACTIVATION = ("excitation", "activation")
TENDON = ("fibre_m", "tendon_m", "pennation_rad", "force_n", "belly_m")


def _listed(name_of: Callable[[int], object]) -> tuple[str, ...]:
    names = []
    while (name := name_of(len(names))) != ffi.NULL:
        names.append(text(name))
    return tuple(names)


SEGMENTS = _listed(lib.mobil_segment_name)
PARENTS = tuple(lib.mobil_segment_parent(i) for i in range(len(SEGMENTS)))
"""Index of each segment's parent; the pelvis is its own parent."""
MUSCLES = _listed(lib.mobil_muscle_name)


@dataclass(frozen=True)
class StyleParameter:
    """A parameter of a walk's style."""

    name: str
    unit: str
    """"1" if dimensionless."""
    meaning: str
    low: float
    high: float
    usual: float


def _style() -> dict[str, StyleParameter]:
    found: dict[str, StyleParameter] = {}
    number = ffi.new("mobil_style_number*")
    while lib.mobil_style(len(found), number) == lib.MOBIL_OK:
        one = StyleParameter(
            text(number.name), text(number.unit), text(number.meaning), number.low, number.high, number.usual
        )
        found[one.name] = one
    return found


STYLE = _style()
"""Parameters of a walk's style by name, in the library's order."""


def muscle_bits(muscles: Iterable[str | int] | str | int) -> int:
    """Returns a set of muscles as bits. A single integer is such bits already."""
    given = one_or_many(muscles, "muscles")
    if isinstance(given, (set, frozenset)):
        given = list(given)
    if isinstance(given, str):
        given = [given]
    if not isinstance(given, list):
        return integer(given, "muscles", 0, (1 << len(MUSCLES)) - 1)
    bits = 0
    for muscle in given:
        bits |= 1 << number_of(muscle, MUSCLES, "muscle")
    return bits
