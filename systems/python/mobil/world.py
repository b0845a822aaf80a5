"""A world of walkers."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import names
from ._library import Owner, fail, ffi, interrupt, lib, struct, text
from .arrays import EVENT, PERSON, ROOT, Floats, People
from .arrays import _all, _floats, _ids, _one, _out, _people, _stride
from .deprecated import OldWorld
from .lod import Lod
from .reports import PhaseCost, SystemCost, Ticks
from .requests import person_requests, walk_requests
from .structs import Method, Muscles, pointer
from .surroundings import Avoidance, Terrain
from .values import (
    column,
    contents,
    integer,
    number,
    number_of,
    numbers,
    one_or_many,
    refuse,
    refuse_type,
    shown,
    switch,
)


_STATES = {
    "full": lib.MOBIL_FULL,
    "compact": lib.MOBIL_COMPACT,
    "asleep": lib.MOBIL_ASLEEP,
    "posed": lib.MOBIL_POSED,
}


class World(Owner, OldWorld):
    """A world of walkers that runs in fixed ticks.

    tick_s: 1e-5 to 1 s; above 0.25 s fast walkers lose distance, because one step begins in a tick at most.
    max_frame_s: longest frame of advance(), tick_s to 60 s, by default 0.25 s or one tick if that is longer. threads: 0
    for all. axes: of positions, directions and rotations: "y_up" (x left, y up, z ahead),
    "unity", "unreal", "godot" or "z_up". units_per_m: unit of positions. Other numbers are SI, angles in rad. An
    argument for several people is one value for all, or an array with one for each person. A refused call raises
    mobil.Error with a message of one line and changes nothing.
    """

    _instead = "send the bytes of world.save(), and restore() them in a World with the same options"

    def __init__(
        self,
        *,
        tick_s: float = 1 / 60,
        max_frame_s: float | None = None,
        threads: int = 1,
        axes: str = "y_up",
        units_per_m: float = 1.0,
    ) -> None:
        options = struct("options")
        options.tick_s = number(tick_s, "tick_s")
        usual_s = max(options.max_frame_s, min(options.tick_s, 1.0))
        options.max_frame_s = usual_s if max_frame_s is None else number(max_frame_s, "max_frame_s")
        options.threads = integer(threads, "threads", 0, 2**31 - 1)
        options.axes = number_of(axes, names.AXES, "axes")
        options.units_per_m = number(units_per_m, "units_per_m")
        made = ffi.new("mobil_sim**")
        line = ffi.new("char[512]")
        code = lib.mobil_create(options, made, line, 512)
        if code != 0:
            fail(code, text(line))
        self._sim = ffi.gc(made[0], lib.mobil_destroy)
        self._heights: Any = None  # callback of terrain
        self._do(lib.mobil_set_interrupt(self._sim, interrupt, ffi.NULL))

    def _do(self, code: int) -> None:
        if code < 0:
            fail(code, text(lib.mobil_message(self._sim)))

    @property
    def lod(self) -> Lod:
        """Level of detail of muscles."""
        return Lod(self)

    @property
    def avoidance(self) -> Avoidance:
        """Collision avoidance."""
        return Avoidance(self)

    @property
    def terrain(self) -> Terrain:
        """Uneven ground."""
        return Terrain(self)

    # People

    def spawn(
        self,
        count: int | None = None,
        *,
        height_m: npt.ArrayLike = 1.75,
        mass_kg: npt.ArrayLike = 75.0,
        somatotype: npt.ArrayLike | None = None,
        constitution: str | int | Sequence[str | int] = "average",
        sex: str | int | Sequence[str | int] = "man",
        age_y: npt.ArrayLike | None = None,
        speed_m_s: npt.ArrayLike | None = None,
        step_length_m: npt.ArrayLike | None = None,
        step_frequency_hz: npt.ArrayLike | None = None,
        style: Mapping[str, npt.ArrayLike] | None = None,
        place: npt.ArrayLike = (0.0, 0.0, 0.0),
        heading_rad: npt.ArrayLike = 0.0,
        posed: bool = False,
        muscles: Any = None,
    ) -> People:
        """Spawns people, all or none, and returns their handles: `count`, or as many as the columns have. Empty columns
        spawn nobody.

        age_y: 6 to 95 years; adults of 25 by default. somatotype: endo, meso, ecto. place: (…, 3) in the world's axes. style: by names.STYLE. muscles:
        mobil.muscles(…). posed: True if set_poses sets their poses; walkers have a speed of 5 km/h by default.
        """
        asked = person_requests(
            count,
            style,
            constitution,
            sex,
            posed,
            height_m=height_m,
            mass_kg=mass_kg,
            age_y=age_y,
            somatotype=somatotype,
            speed_m_s=speed_m_s,
            step_length_m=step_length_m,
            step_frequency_hz=step_frequency_hz,
            place=place,
            heading_rad=heading_rad,
        )
        chosen = pointer(muscles, Muscles)
        ids = np.zeros(asked.count, PERSON)
        if ids.size:
            self._do(lib.mobil_spawn(self._sim, asked.structs, 0, ids.size, chosen, _ids(ids)))
        return ids

    def despawn(self, people: People) -> None:
        self._do(lib.mobil_despawn(self._sim, *_all(people)))

    @property
    def people(self) -> People:
        """All people, in no particular order."""
        count = ffi.new("size_t*")
        self._do(lib.mobil_people(self._sim, ffi.NULL, 0, count))
        ids = np.zeros(count[0], PERSON)
        if ids.size:
            self._do(lib.mobil_people(self._sim, _ids(ids), ids.size, ffi.NULL))
        return ids

    def change_walk(
        self,
        people: People,
        *,
        speed_m_s: npt.ArrayLike | None = None,
        step_length_m: npt.ArrayLike | None = None,
        step_frequency_hz: npt.ArrayLike | None = None,
        style: Mapping[str, npt.ArrayLike] | None = None,
        heading_rad: npt.ArrayLike | None = None,
    ) -> None:
        """Changes walks from the next step on. Arguments that are not given stay. A speed of 0 stops. Parameters that a
        given style does not name become usual."""
        people = _people(people)
        asked = walk_requests(
            people.size,
            style,
            speed_m_s=speed_m_s,
            step_length_m=step_length_m,
            step_frequency_hz=step_frequency_hz,
            heading_rad=heading_rad,
        )
        self._do(lib.mobil_change_walks(self._sim, *_all(people), asked.structs, 0))

    def set_poses(self, people: People, poses: npt.ArrayLike, *, jumped: bool = False) -> None:
        """Sets posed people's poses for the end of the next tick: (n, 48, 7), world position and quaternion x y z w."""
        people = _people(people)
        rows = numbers(poses, "poses")
        shape = (people.size, len(names.SEGMENTS), 7)
        if people.size == 0 and rows.size == 0:
            return
        if rows.shape not in (shape, shape[1:]) or rows.shape == shape[1:] and people.size != 1:
            refuse(f"poses have the shape {rows.shape}; give {shape}")
        self._do(lib.mobil_set_poses(self._sim, *_all(people), _floats(rows), 0, switch(jumped, "jumped")))

    def walk(self, person: People) -> dict[str, Any]:
        """Returns a walker's requested walk, as change_walk takes it; `style` has all parameters."""
        to = struct("walk")
        style = np.empty(len(names.STYLE), np.float32)
        self._do(lib.mobil_get_walk(self._sim, _one(person), to, _floats(style), style.size))
        walk: dict[str, Any] = {"speed_m_s": to.speed_m_s, "heading_rad": to.heading_rad}
        if to.given & lib.MOBIL_STEP_LENGTH:
            walk["step_length_m"] = to.step_length_m
        walk["style"] = dict(zip(names.STYLE, style.tolist()))
        return walk

    def limit_violations(self, person: People) -> list[str]:
        """Returns the limits of ground, joints and pelvis that a walker violates now; empty for nearly all walkers."""
        length = ffi.new("size_t*")
        self._do(lib.mobil_limit_violations(self._sim, _one(person), ffi.NULL, 0, length))
        if length[0] == 0:
            return []
        text = ffi.new("char[]", length[0] + 1)
        self._do(lib.mobil_limit_violations(self._sim, _one(person), text, length[0] + 1, ffi.NULL))
        return ffi.string(text).decode().splitlines()

    @property
    def people_beyond_limits(self) -> int:
        """Number of people beyond such a limit in the last tick."""
        people = ffi.new("size_t*")
        self._do(lib.mobil_limit_violation_counts(self._sim, people, ffi.NULL))
        return people[0]

    def place(self, people: People, place: npt.ArrayLike, heading_rad: npt.ArrayLike) -> None:
        """Moves walkers at once, all or none, without inertia. place: (…, 3) in the world's axes."""
        people = _people(people)
        rows = np.empty((people.size, 4), np.float32)
        rows[:, :3] = column(place, people.size, "place", 3)
        rows[:, 3] = column(heading_rad, people.size, "heading_rad")
        self._do(lib.mobil_place_many(self._sim, *_all(people), _floats(rows), 0))

    def shift_origin(self, to: npt.ArrayLike) -> None:
        """Moves the world's origin: subtracts `to` from all positions."""
        at = numbers(to, "to")
        if at.shape != (3,):
            refuse(f"the origin moves to a place of three numbers, and this has the shape {at.shape}")
        self._do(lib.mobil_shift_origin(self._sim, _floats(at)))

    def enable(self, people: People, feature: str, on: bool = True) -> None:
        """Switches a feature from the next tick on: "step_events" (see events()), "fat" (wobbling, shown by Skin) or
        "forces" (ground reactions and joint moments)."""
        self._do(lib.mobil_enable(self._sim, *_all(people), number_of(feature, names.FEATURES, "feature"), switch(on, "on")))

    def set_state(self, people: People, state: str, within_m: float = 0.005) -> int:
        """Changes people to "full", "compact" or "asleep" where possible. Returns how many are in that state now.

        within_m: maximum error of control points of muscles that begin on waking.
        """
        count = ffi.new("size_t*")
        if not isinstance(state, str):  # indices are not the numbers of C
            refuse_type(f"state is {shown(state)}; give one of {', '.join(_STATES)}")
        to = tuple(_STATES.values())[number_of(state, tuple(_STATES), "state")]
        self._do(lib.mobil_set_state(self._sim, *_all(people), to, number(within_m, "within_m"), count))
        return int(count[0])

    def state(self, person: People) -> str:
        """Returns "full", "compact", "asleep" or "posed"."""
        state = ffi.new("int*")
        self._do(lib.mobil_get_state(self._sim, _one(person), state))
        return next(name for name, number in _STATES.items() if number == state[0])

    # Muscles

    def set_muscles(self, people: People, muscles: Any) -> None:
        """Sets mobil.muscles(…), or removes all muscles if None."""
        self._do(lib.mobil_set_muscles(self._sim, *_all(people), pointer(muscles, Muscles)))

    def set_method(self, people: People, muscle: str, method: Any) -> None:
        """Sets mobil.method(…) of one muscle, both sides, without a jump."""
        of, to = number_of(muscle, names.MUSCLES, "muscle"), pointer(method, Method, none=False)
        self._do(lib.mobil_set_method(self._sim, *_all(people), of, to))

    def method(self, person: People, muscle: str) -> str:
        """Returns the name of a muscle's present method."""
        to = struct("method")
        number = number_of(muscle, names.MUSCLES, "muscle")
        self._do(lib.mobil_get_method(self._sim, _one(person), number, to))
        return names.METHODS[to.method]

    def set_excitation(self, people: People, muscle: str, side: str, excitation: npt.ArrayLike) -> None:
        """Sets the excitation of muscles with activation="host", clamped to 0.01 to 1."""
        people = _people(people)
        values = column(excitation, people.size, "excitation")
        self._do(
            lib.mobil_set_excitation(
                self._sim,
                *_all(people),
                number_of(muscle, names.MUSCLES, "muscle"),
                number_of(side, names.SIDES, "side"),
                _floats(values),
                0,
            )
        )

    def prepare(self, muscles: Any) -> None:
        """Makes the shared data of these muscles, so that no later call waits for it."""
        self._do(lib.mobil_prepare(self._sim, pointer(muscles, Muscles, none=False)))

    def bake(self) -> bytes:
        """Returns all shared data made so far."""
        size = ffi.new("size_t*")
        self._do(lib.mobil_bake(self._sim, ffi.NULL, 0, size))
        out = bytearray(size[0])
        self._do(lib.mobil_bake(self._sim, ffi.from_buffer(out), len(out), ffi.NULL))
        return bytes(out)

    def load_baked(self, baked: bytes) -> None:
        data = contents(baked, "baked")
        self._do(lib.mobil_load_baked(self._sim, data, len(data)))

    # Time and state

    def tick(self, ticks: int = 1) -> None:
        self._do(lib.mobil_tick(self._sim, integer(ticks, "ticks", 0, 2**32 - 1)))

    def advance(self, seconds: float) -> Ticks:
        """Adds the time of a frame, and runs as many ticks as fit into the accumulated time."""
        ticks = ffi.new("mobil_ticks*")
        self._do(lib.mobil_advance(self._sim, number(seconds, "seconds"), ticks))
        return Ticks(ticks.count, ticks.alpha, ticks.dropped_s)

    @property
    def time_s(self) -> float:
        return lib.mobil_time_s(self._sim)

    @property
    def tick_s(self) -> float:
        return lib.mobil_tick_s(self._sim)

    def save(self) -> bytes:
        """Returns a snapshot of the whole state."""
        out = bytearray(lib.mobil_snapshot_bytes(self._sim))
        used = ffi.new("size_t*")
        self._do(lib.mobil_save(self._sim, ffi.from_buffer(out), len(out), used))
        return bytes(memoryview(out)[: used[0]])

    def restore(self, state: bytes) -> None:
        data = contents(state, "state")
        self._do(lib.mobil_restore(self._sim, data, len(data)))

    def hash(self) -> int:
        """Returns a 64-bit hash of the whole state, equal for equal states on any machine and number of threads."""
        half = ffi.new("unsigned int[2]")
        self._do(lib.mobil_hash(self._sim, half))
        return half[0] | half[1] << 32

    def cost(self) -> list[SystemCost]:
        """Returns the cost of each system in the last tick, in the order of execution."""
        found: list[SystemCost] = []
        one = ffi.new("mobil_system*")
        while lib.mobil_cost(self._sim, len(found), one) == lib.MOBIL_OK:
            found.append(SystemCost(text(one.name), text(one.module), one.seconds, int(one.entities)))
        return found

    def phases(self) -> list[PhaseCost]:
        """Returns the cost of each phase in the last tick (lod, avoidance, terrain …), in the order of execution."""
        found: list[PhaseCost] = []
        one = ffi.new("mobil_phase*")
        while lib.mobil_phase_cost(self._sim, len(found), one) == lib.MOBIL_OK:
            found.append(PhaseCost(text(one.name), text(one.module), bool(one.after), one.seconds))
        return found

    # Reading

    def poses(
        self,
        people: People,
        *,
        form: str = "quaternion",
        ahead_s: float = 0.0,
        to_parent: bool = False,
        segments: Sequence[str | int] | None = None,
        out: Floats | None = None,
    ) -> Floats:
        """Returns the exact poses at an instant after the last tick (ahead_s: 0 to 0.2).

        (n, segments, 7) position and quaternion x y z w, or (…, 3, 4) for "matrix", (…, 8) for "dual_quaternion".
        """
        layout = struct("pose_layout")
        layout.form = number_of(form, names.FORMS, "form")
        layout.ahead_s = number(ahead_s, "ahead_s")
        layout.to_parent = switch(to_parent, "to_parent")
        chosen = one_or_many(range(len(names.SEGMENTS)) if segments is None else segments, "segments")
        if not isinstance(chosen, list):
            refuse_type("segments is a list of segments; give one of names or indices")
        indices = ffi.new("int[]", [number_of(s, names.SEGMENTS, "segment") for s in chosen])
        layout.segments = indices
        layout.segment_count = len(indices)
        people = _people(people)
        shape = ((7,), (3, 4), (8,))[layout.form]
        out = _out(out, (people.size, len(indices), *shape))
        if out.size:
            self._do(lib.mobil_poses(self._sim, *_all(people), layout, _floats(out), _stride(out)))
        return out

    def events(self) -> People:
        """Returns an array of EVENT: all ticks of the last advance or tick, for people with "step_events"."""
        count = ffi.new("size_t*")
        self._do(lib.mobil_events(self._sim, ffi.NULL, 0, count))
        found = np.zeros(count[0], EVENT)
        if found.size:
            self._do(lib.mobil_events(self._sim, ffi.from_buffer("mobil_event[]", found), found.size, ffi.NULL))
        return found

    def roots(self, people: People, ahead_s: float = 0.0) -> People:
        """Returns an array of ROOT: positions and headings on the ground, without the sway of the hips."""
        people = _people(people)
        found = np.zeros(people.size, ROOT)
        at = ffi.from_buffer("mobil_root[]", found) if found.size else ffi.NULL
        self._do(lib.mobil_roots(self._sim, *_all(people), number(ahead_s, "ahead_s"), at))
        return found

    def root_motion(self, people: People, roots: People, ahead_s: float = 0.0) -> Floats:
        """Returns the motions from `roots` to the present roots, (n, 4): in the world's axes with the first heading
        along the axis ahead, and the turn to the left, rad. Stores the present roots in `roots`."""
        people = _people(people)
        out = np.empty((people.size, 4), np.float32)
        fits = isinstance(roots, np.ndarray) and roots.dtype == ROOT and roots.shape == people.shape
        if not fits or not roots.flags.carray:
            refuse("roots must be what roots() gave of as many people")
        if not out.size:
            return out
        at = ffi.from_buffer("mobil_root[]", roots)
        ways = ffi.cast("mobil_motion*", out.ctypes.data)
        self._do(lib.mobil_root_motion(self._sim, *_all(people), number(ahead_s, "ahead_s"), at, ways))
        return out

    def _rows(self, what: int, people: People, out: Floats | None) -> Floats:
        people = _people(people)
        out = _out(out, (people.size, lib.mobil_row_floats(what)))
        self._do(lib.mobil_read(self._sim, what, *_all(people), _floats(out), _stride(out)))
        return out

    def joints(self, people: People, out: Floats | None = None) -> Floats:
        """Returns (n, 13) angles in rad, columns as names.JOINTS."""
        return self._rows(lib.MOBIL_JOINTS, people, out)

    def feet(self, people: People) -> tuple[Floats, Floats]:
        """Returns points of the soles (n, heel toe tip, right left, 3) and phases of the gait cycle (n, right left)."""
        rows = self._rows(lib.MOBIL_FEET, people, None)
        return rows[:, :18].reshape(-1, 3, 2, 3), rows[:, 18:]

    def centre_of_mass(self, people: People, out: Floats | None = None) -> Floats:
        """Returns (n, 3)."""
        return self._rows(lib.MOBIL_CENTRE, people, out)

    def ground(self, people: People) -> tuple[Floats, Floats]:
        """Returns forces on the feet, N, and centres of pressure, each (n, right left, 3); needs "forces"."""
        rows = self._rows(lib.MOBIL_GROUND, people, None).reshape(-1, 2, 2, 3)
        return rows[:, 0], rows[:, 1]

    def moments(self, people: People, out: Floats | None = None) -> Floats:
        """Returns (n, 6) N m, columns as names.MOMENTS; needs "forces"."""
        return self._rows(lib.MOBIL_MOMENTS, people, out)

    def hip_moments(self, people: People, out: Floats | None = None) -> Floats:
        """Returns frontal and transverse moments of the hips, N m, abductor and inward rotator positive: (n, 4), right
        before left; needs "forces"."""
        return self._rows(lib.MOBIL_HIP, people, out)

    def free_moments(self, people: People, out: Floats | None = None) -> Floats:
        """Returns the moments of the ground about the vertical under each foot, N m, (n, 2); needs "forces"."""
        return self._rows(lib.MOBIL_FREE_MOMENTS, people, out)

    def muscle_rows(
        self, what: str, people: People, muscle: str, side: str = "right", out: Floats | None = None
    ) -> Floats:
        """Returns rows of one muscle, (n, columns).

        what: "line" (names.LINE), "line_motion", "report" (names.REPORT), "activation", "tendon" (names.TENDON), or
        "nodes": displacements of control points in the muscle's frame, m, three for each node.
        """
        kinds = ("line", "line_motion", "report", "activation", "tendon", "nodes")
        number, of = number_of(what, kinds, "row"), number_of(muscle, names.MUSCLES, "muscle")
        on = number_of(side, names.SIDES, "side")
        people = _people(people)
        floats = lib.mobil_muscle_row_floats(self._sim, number, _one(people[0]), of, on) if people.size else 0
        self._do(min(floats, 0))
        out = _out(out, (people.size, floats))
        self._do(lib.mobil_read_muscles(self._sim, number, *_all(people), of, on, _floats(out), _stride(out)))
        return out
