"""mobil: crowds of walking people with deforming leg muscles.

    import mobil
    world = mobil.World()
    people = world.spawn(height_m=[1.6, 1.7, 1.8], mass_kg=70, speed_m_s=1.4, place=[[0, 0, 0], [1, 0, 0], [2, 0, 0]],
                         muscles=mobil.muscles(method="modal"))
    world.tick(60)
    world.poses(people)                                       # (3, 48, 7): place and quaternion of each segment
    world.joints(people)[:, mobil.JOINTS.index("knee_flexion_right")]
    world.muscle_rows("report", people, "quadriceps")         # elongation, reaction, volume, energies

    mobil.plot_walk(mobil.walk(height_m=1.8, mass_kg=80, speed_m_s=1.39))

SI units, radians. People are numpy arrays of handles. Results are numpy arrays, or are written to `out` if given.
"""

from ._library import (
    BusyError,
    Error,
    MissingError,
    OutOfMemoryError,
    RefusedError,
    StaleError,
    WrongTypeError,
    lib,
    text,
)
from .arrays import EVENT, PERSON, ROOT
from .bodies import Body, body, segments_of, typical_person
from .deprecated import Avoidance, Terrain
from .lod import Choice, Lod
from .names import (
    ACTIVATION,
    EVENTS,
    JOINTS,
    LINE,
    LINE_MOTION,
    MOMENTS,
    MUSCLES,
    PARENTS,
    REPORT,
    SEGMENTS,
    STYLE,
    TENDON,
    StyleParameter,
)
from .plots import plot_walk
from .reports import PhaseCost, SystemCost, Ticks
from .skin import Binding, CustomSkin, Skin, bake_skins, load_skins
from .structs import Method, Muscles, method, muscles
from .surfaces import Part, Surfaces
from .surroundings import AvoidanceReport, TerrainReport
from .walks import Walk, walk
from .world import World

__version__ = text(lib.mobil_library_version())
__all__ = [
    "ACTIVATION",
    "Avoidance",
    "AvoidanceReport",
    "Binding",
    "Body",
    "BusyError",
    "Choice",
    "EVENT",
    "EVENTS",
    "Error",
    "JOINTS",
    "LINE",
    "LINE_MOTION",
    "Lod",
    "MOMENTS",
    "MUSCLES",
    "Method",
    "Muscles",
    "MissingError",
    "OutOfMemoryError",
    "CustomSkin",
    "PARENTS",
    "PERSON",
    "PhaseCost",
    "Part",
    "REPORT",
    "ROOT",
    "RefusedError",
    "SEGMENTS",
    "STYLE",
    "Skin",
    "StaleError",
    "StyleParameter",
    "Surfaces",
    "SystemCost",
    "TENDON",
    "Terrain",
    "TerrainReport",
    "Ticks",
    "Walk",
    "World",
    "WrongTypeError",
    "bake_skins",
    "body",
    "load_skins",
    "method",
    "muscles",
    "plot_walk",
    "segments_of",
    "typical_person",
    "walk",
]
