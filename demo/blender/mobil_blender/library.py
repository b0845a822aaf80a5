"""libmobil through ctypes: a world of walkers, with arrays in Blender's axes."""

from __future__ import annotations

import ctypes
import os
import pathlib
import sys
from typing import Any, NamedTuple, Sequence

import numpy as np

from . import axes, header

_FOLDER = pathlib.Path(__file__).resolve().parent / "lib"
_FILE = {"win32": "mobil.dll", "darwin": "libmobil.dylib"}.get(sys.platform, "libmobil.so")


class Refused(Exception):
    """A request that the library refuses: one line with the mistake, the valid range and the remedy."""


def _load() -> tuple[header.Header, ctypes.CDLL]:
    read = header.read(_FOLDER / "mobil.h")
    path = os.environ.get("MOBIL_LIBRARY") or str(_FOLDER / _FILE)
    try:
        lib = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"mobil: {path} cannot be loaded ({error}); make a zip for this system with demo/blender/run")
    for name, (result, arguments) in read.functions.items():
        function = getattr(lib, name, None)
        if function is not None:
            function.restype, function.argtypes = result, arguments
    needed = read.constants["MOBIL_INTERFACE"]
    if lib.mobil_interface() < needed:
        found = lib.mobil_interface()
        raise ImportError(f"mobil: {path} has interface {found}, and the add-on needs {needed}; use files of one zip")
    return read, lib


HEADER, lib = _load()
C = HEADER.constants
SEXES = ("man", "woman")
CONSTITUTIONS = ("thin", "average", "athletic", "heavy")
DETAILS = ("hero", "near", "far", "distant")
PARTS = ("skin", "legs", "lips", "hair", "shirt", "shorts", "shoes")
SEGMENTS = tuple(lib.mobil_segment_name(i).decode() for i in range(C["MOBIL_SEGMENTS"]))
PARENTS = tuple(lib.mobil_segment_parent(i) for i in range(len(SEGMENTS)))
"""Index of each segment's parent; the pelvis is its own."""


def _names(function: Any) -> tuple[str, ...]:
    found: list[str] = []
    while (name := function(len(found))) is not None:
        found.append(name.decode())
    return tuple(found)


MUSCLES = _names(lib.mobil_muscle_name)
"""Groups and single muscles, by number."""
GROUPS = MUSCLES[:4] + MUSCLES[C["MOBIL_GLUTEUS_MAXIMUS"] : C["MOBIL_TOE_EXTENSORS"] + 1]
"""The usual four, then those of the hip and the deep ones."""
_DEEP = (
    "adductor_brevis gluteus_minimus obturator_externus obturator_internus piriformis popliteus quadratus_femoris"
    " tibialis_posterior"
).split()
SINGLE_MUSCLES = tuple(name for name in MUSCLES if name not in GROUPS and name not in _DEEP)
"""Single muscles that can be seen."""


class StyleNumber(NamedTuple):
    name: str
    unit: str
    meaning: str
    low: float
    high: float
    usual: float


def _style() -> tuple[StyleNumber, ...]:
    found: list[StyleNumber] = []
    one = HEADER.structs["mobil_style_number"]()
    while lib.mobil_style(len(found), ctypes.byref(one)) == 0:
        words = [text.decode() for text in (one.name, one.unit, one.meaning)]
        found.append(StyleNumber(*words, one.low, one.high, one.usual))
    return tuple(found)


STYLE = _style()


def struct(name: str) -> Any:
    """Returns a struct with the library's defaults: struct("person") is a mobil_person."""
    made = HEADER.structs[f"mobil_{name}"]()
    code = lib.mobil_defaults(C[f"MOBIL_{name.upper()}"], ctypes.byref(made), ctypes.sizeof(made))
    if code != 0:
        raise Refused(f"mobil_defaults refuses a mobil_{name} of {ctypes.sizeof(made)} bytes; use files of one zip")
    return made


class Person(NamedTuple):
    """A request for a person. A `step_length_m` of 0 means the usual one; `style` has values by name."""

    height_m: float = 1.75
    mass_kg: float = 75.0
    sex: str = "man"
    constitution: str = "average"
    speed_m_s: float = 1.4
    step_length_m: float = 0.0
    style: dict[str, float] = {}
    place: tuple[float, float] = (0.0, 0.0)
    """In Blender's axes."""
    heading_rad: float = 0.0


class Muscles(NamedTuple):
    names: frozenset[str]
    contract: bool = False
    """True: muscles pull as in people who walk."""

    @property
    def bits(self) -> int:
        return sum(1 << i for i, name in enumerate(MUSCLES) if name in self.names)

    def put(self, made: Any) -> None:
        made.muscles, made.more_muscles = self.bits & 0xFFFFFFFF, self.bits >> 32

    def struct(self) -> Any:
        made = struct("muscles")
        self.put(made)
        if self.contract:
            made.activation, made.method = C["MOBIL_BY_PHASE"], C["MOBIL_MODAL"]
        return made


class Body(NamedTuple):
    offsets: np.ndarray
    """(48, 3): each segment's joint from its parent's, of the pelvis from the ground, in the anatomical position."""
    tips: np.ndarray
    """(48, 3): far end, from the joint."""

    @property
    def joints(self) -> np.ndarray:
        """(48, 3): places in the anatomical position."""
        at = np.zeros((len(SEGMENTS), 3))
        for i, parent in enumerate(PARENTS):
            at[i] = self.offsets[i] + (at[parent] if parent != i else 0)
        return at


class Binding(NamedTuple):
    """A skin in the anatomical position, without doubled vertices: those of mobil_write_skin."""

    positions: np.ndarray
    """(vertices, 3)."""
    normals: np.ndarray
    """(vertices, 3)."""
    triangles: np.ndarray
    """(n, 3)."""
    texture: np.ndarray
    """(n, 3, 2): right and up from the lower left corner, for each corner of each triangle."""
    joints: np.ndarray
    """(vertices, 4): segments."""
    weights: np.ndarray
    """(vertices, 4)."""
    parts: np.ndarray
    """(n,): part of each triangle, as an index into PARTS."""


class SurfacePart(NamedTuple):
    name: str
    segment: int
    """Segment of a bone, -1 for muscles."""
    vertices: slice
    triangles: slice


def _pointer(array: np.ndarray) -> int:
    assert array.flags.c_contiguous
    return array.ctypes.data


class World:
    """A world of walkers that runs in ticks of `tick_s`."""

    def __init__(self, tick_s: float = 1 / 60) -> None:
        options = struct("options")
        options.tick_s = tick_s
        options.max_frame_s = max(options.max_frame_s, min(tick_s, 1.0))
        options.axes = C["MOBIL_AXES_Y_UP"]
        self._sim = ctypes.c_void_p()
        line = ctypes.create_string_buffer(512)
        if lib.mobil_create(ctypes.byref(options), ctypes.byref(self._sim), line, len(line)) != 0:
            raise Refused(line.value.decode())

    def __del__(self) -> None:
        if getattr(self, "_sim", None):
            lib.mobil_destroy(self._sim)

    def do(self, code: int) -> None:
        if code < 0:
            raise Refused(lib.mobil_message(self._sim).decode())

    def spawn(self, people: Sequence[Person], muscles: Muscles | None = None, posed: bool = False) -> Any:
        """Spawns people, all or none, and returns an array of their ids. Posed ones stay in the anatomical position."""
        requests = (HEADER.structs["mobil_person"] * len(people))()
        kept = []
        for request, person in zip(requests, people):
            filled = struct("person")
            filled.height_m, filled.mass_kg, filled.posed = person.height_m, person.mass_kg, int(posed)
            filled.sex, filled.constitution = SEXES.index(person.sex), CONSTITUTIONS.index(person.constitution)
            filled.given, filled.speed_m_s = C["MOBIL_SPEED"], person.speed_m_s
            if person.step_length_m > 0:
                filled.given |= C["MOBIL_STEP_LENGTH"]
                filled.step_length_m = person.step_length_m
            style = np.array([person.style.get(one.name, one.usual) for one in STYLE], np.float32)
            if not np.array_equal(style, np.array([one.usual for one in STYLE], np.float32)):
                filled.given |= C["MOBIL_STYLE"]
                filled.style, filled.style_count = _pointer(style), style.size
                kept.append(style)
            filled.place[:] = axes.library_places(np.array((*person.place, 0.0)))
            filled.heading_rad = person.heading_rad
            ctypes.memmove(ctypes.byref(request), ctypes.byref(filled), ctypes.sizeof(filled))
        ids = (HEADER.structs["mobil_id"] * len(people))()
        chosen = muscles.struct() if muscles and muscles.bits else None
        self.do(lib.mobil_spawn(self._sim, requests, 0, len(people), chosen and ctypes.byref(chosen), ids))
        return ids

    def tick(self, ticks: int = 1) -> None:
        self.do(lib.mobil_tick(self._sim, ticks))

    def stride_s(self, one: Any) -> float:
        """Returns the duration of two steps, or 0 for a standing person."""
        walk = struct("walk")
        self.do(lib.mobil_get_walk(self._sim, one, ctypes.byref(walk), None, 0))
        return 2 / walk.step_frequency_hz if walk.speed_m_s > 0 and walk.step_frequency_hz > 0 else 0.0

    def style(self, one: Any) -> dict[str, float]:
        """Returns a person's style as corrected to the limits of ground and joints."""
        out = np.empty(len(STYLE), np.float32)
        self.do(lib.mobil_get_style(self._sim, one, _pointer(out), out.size))
        return dict(zip((number.name for number in STYLE), out.tolist()))

    def turn(self, ids: Any, heading_rad: float) -> None:
        """Turns walkers to a heading, from the next step on."""
        walk = struct("walk")
        walk.given, walk.heading_rad = C["MOBIL_HEADING"], heading_rad
        self.do(lib.mobil_change_walk(self._sim, ids, len(ids), ctypes.byref(walk)))

    def avoid(self, ids: Any, walls: np.ndarray) -> None:
        """Makes walkers avoid each other and walls: rows of two places in Blender's axes, (n, 2, 3)."""
        rows = np.ascontiguousarray(axes.library_places(walls), np.float32)
        self.do(lib.mobil_avoidance_set_walls(self._sim, _pointer(rows), 0, len(rows)))
        self.do(lib.mobil_avoidance_manage(self._sim, ids, len(ids), 1))

    def head(self, ids: Any, speeds_m_s: np.ndarray, headings_rad: np.ndarray) -> None:
        """Sets the desired velocities of walkers who avoid each other."""
        rows = np.ascontiguousarray(np.stack((speeds_m_s, headings_rad), -1), np.float32)
        self.do(lib.mobil_avoidance_set_desired_velocity(self._sim, ids, len(ids), _pointer(rows), 0))

    def poses(self, ids: Any, to_parent: bool = True) -> tuple[np.ndarray, np.ndarray]:
        """Returns positions (n, 48, 3) and rotations (n, 48, 4), relative to the parent; the pelvis in the world."""
        layout = struct("pose_layout")
        layout.to_parent = int(to_parent)
        rows = np.empty((len(ids), len(SEGMENTS), 7), np.float32)
        self.do(lib.mobil_poses(self._sim, ids, len(ids), ctypes.byref(layout), _pointer(rows), 0))
        wide = rows.astype(np.float64)
        return axes.places(wide[..., :3]), axes.quaternions(wide[..., 3:])

    def roots(self, ids: Any) -> tuple[np.ndarray, np.ndarray]:
        """Returns places on the ground (n, 3) and headings, rad (n,)."""
        rows = np.empty((len(ids), 4), np.float64)
        self.do(lib.mobil_roots(self._sim, ids, len(ids), 0.0, _pointer(rows)))
        return axes.places(rows[:, :3]), rows[:, 3].copy()

    def body(self, one: Any) -> Body:
        rows = (HEADER.structs["mobil_segment"] * len(SEGMENTS))()
        rows[0].size = ctypes.sizeof(HEADER.structs["mobil_segment"])
        self.do(lib.mobil_get_body(self._sim, one, rows, 0))
        offsets, tips = (np.array([list(getattr(row, name)) for row in rows]) for name in ("offset", "tip"))
        return Body(axes.places(offsets), axes.places(tips))

    def binding(self, one: Any, sex: str, detail: str) -> Binding:
        """Returns the skin of a person, for people of similar build."""
        of = SEXES.index(sex), DETAILS.index(detail)
        first = np.empty(len(PARTS) + 1, np.uint32)
        corners = np.empty(lib.mobil_skin_index_count(*of), np.uint32)
        self.do(lib.mobil_skin_indices(self._sim, *of, _pointer(corners), corners.size, _pointer(first)))
        count = lib.mobil_binding_vertex_count(*of)
        arrays = {
            "positions": np.empty((count, 3), np.float32),
            "normals": np.empty((count, 3), np.float32),
            "texture": np.empty((count, 2), np.float32),
            "joints": np.empty((count, 4), np.uint8),
            "weights": np.empty((count, 4), np.float32),
            "same_as": np.empty(count, np.uint32),
            "indices": np.empty(corners.size, np.uint32),
        }
        to = struct("skin_binding")
        to.sex, to.detail, to.vertices, to.index_room = *of, count, corners.size
        for name, array in arrays.items():
            setattr(to, name, _pointer(array))
        self.do(lib.mobil_get_skin_binding(self._sim, one, ctypes.byref(to)))
        single = np.zeros(lib.mobil_skin_vertex_count(*of), np.intp)
        single[arrays["same_as"]] = np.arange(count)
        triangles = corners.reshape(-1, 3)
        texture = arrays["texture"][arrays["indices"]].reshape(-1, 3, 2)
        return Binding(
            axes.places(arrays["positions"][single]),
            axes.places(arrays["normals"][single]),
            triangles,
            np.stack((texture[..., 0], 1 - texture[..., 1]), -1),
            arrays["joints"][single],
            arrays["weights"][single],
            np.repeat(np.arange(len(PARTS)), np.diff(first)),
        )


class Surfaces:
    """Bones and muscles as triangles, bound to the body of one person."""

    def __init__(self, world: World, like: Any, bones: bool, muscles: Muscles, detail: float) -> None:
        choice = struct("surface_choice")
        choice.bones, choice.side, choice.detail = int(bones), C["MOBIL_BOTH"], detail
        muscles.put(choice)
        self._surfaces = ctypes.c_void_p()
        self._world = world
        world.do(lib.mobil_bind_surfaces(world._sim, like, ctypes.byref(choice), ctypes.byref(self._surfaces)))
        self.count = lib.mobil_vertex_count(self._surfaces)
        corners = np.empty(lib.mobil_index_count(self._surfaces), np.uint32)
        world.do(lib.mobil_indices(self._surfaces, _pointer(corners), corners.size))
        self.triangles = corners.reshape(-1, 3)
        self.parts: list[SurfacePart] = []
        one = HEADER.structs["mobil_part"]()
        while lib.mobil_surface_part(self._surfaces, len(self.parts), ctypes.byref(one)) == 0:
            vertices = slice(one.first_vertex, one.first_vertex + one.vertices)
            triangles = slice(one.first_index // 3, (one.first_index + one.indices) // 3)
            self.parts.append(SurfacePart(one.name.decode(), one.segment, vertices, triangles))

    def __del__(self) -> None:
        if getattr(self, "_surfaces", None):
            lib.mobil_drop_surfaces(self._surfaces)

    def positions(self, one: Any) -> np.ndarray:
        """Returns the vertices of a person, (vertices, 3)."""
        rows = np.empty((self.count, 3), np.float32)
        target = struct("surface_target")
        target.id, target.surfaces = one, self._surfaces
        target.positions, target.position_bytes = _pointer(rows), rows.nbytes
        self._world.do(lib.mobil_write_surfaces(self._world._sim, ctypes.byref(target), 0, 1))
        return axes.places(rows.astype(np.float64))
