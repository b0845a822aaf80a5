"""A world of walkers."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple, Sequence

import numpy as np
import numpy.typing as npt

from . import names
from ._library import fail, ffi, lib, struct, text
from .arrays import EVENT, PERSON, ROOT, Floats, People
from .arrays import _all, _floats, _ids, _one, _out, _people, _stride, _style_rows
from .deprecated import OldWorld
from .lod import Lod
from .names import number_of
from .surroundings import Avoidance, Terrain


_STATES = {
    "full": lib.MOBIL_FULL,
    "compact": lib.MOBIL_COMPACT,
    "asleep": lib.MOBIL_ASLEEP,
    "posed": lib.MOBIL_POSED,
}


class Ticks(NamedTuple):
    count: int
    """Ticks that ran."""
    alpha: float
    """How far into the next tick the frame is, 0 to 1."""
    dropped_s: float
    """Of a frame that was too long."""


class SystemCost(NamedTuple):
    name: str
    module: str
    seconds: float
    """In the last tick, of all threads together."""
    entities: int


class PhaseCost(NamedTuple):
    name: str
    module: str
    after: bool
    """The systems; else before them."""
    seconds: float
    """In the last tick, of the thread that ticks."""


class World(OldWorld):
    """People who walk, in fixed ticks.

    tick_s: 1e-5 to 1 s. threads: 0 for all. axes: of places, directions and rotations: "y_up" (x left, y up, z ahead),
    "unity", "unreal", "godot" or "z_up"; units_per_m: of places. Numbers are otherwise SI, angles rad. What people are
    asked for one by one may be given as one value for all. Refusals are exceptions of one line (mobil.Error); what was
    refused has changed nothing.
    """

    def __init__(
        self, *, tick_s: float = 1 / 60, threads: int = 1, axes: str = "y_up", units_per_m: float = 1.0
    ) -> None:
        options = struct("options")
        options.tick_s = tick_s
        options.threads = threads
        options.axes = number_of(axes, names.AXES, "axes")
        options.units_per_m = units_per_m
        made = ffi.new("mobil_sim**")
        line = ffi.new("char[512]")
        code = lib.mobil_create(options, made, line, 512)
        if code != 0:
            fail(code, text(line))
        self._sim = ffi.gc(made[0], lib.mobil_destroy)
        self._heights: Any = None  # of terrain
        self._raised: list[BaseException] = []  # by it

    def _do(self, code: int) -> None:
        if code < 0:
            fail(code, text(lib.mobil_message(self._sim)))

    def _ran(self, code: int) -> None:
        """The end of a call that ticks: what terrain's function raised is raised here."""
        if self._raised:
            raise self._raised.pop()
        self._do(code)

    @property
    def lod(self) -> Lod:
        """How finely whose muscles are computed."""
        return Lod(self)

    @property
    def avoidance(self) -> Avoidance:
        """Who keep out of each other's way."""
        return Avoidance(self)

    @property
    def terrain(self) -> Terrain:
        """Where the ground is."""
        return Terrain(self)

    # People

    def spawn(
        self,
        count: int | None = None,
        *,
        height_m: npt.ArrayLike = 1.75,
        mass_kg: npt.ArrayLike = 75.0,
        somatotype: npt.ArrayLike | None = None,
        constitution: str | Sequence[str] = "average",
        sex: str | Sequence[str] = "man",
        speed_m_s: npt.ArrayLike | None = None,
        step_length_m: npt.ArrayLike | None = None,
        step_frequency_hz: npt.ArrayLike | None = None,
        style: Mapping[str, npt.ArrayLike] | None = None,
        place: npt.ArrayLike = (0.0, 0.0, 0.0),
        heading_rad: npt.ArrayLike = 0.0,
        posed: bool = False,
        muscles: Any = None,
    ) -> People:
        """People come, all or none; an array of handles. As many as `count`, or as the longest of what is given.

        somatotype: endo, meso, ecto. place: (…, 3) in the world's axes. style: by names.STYLE. muscles: mobil.muscles(…).
        posed: their poses are set by set_poses; else they walk, with 5 km/h where nothing is said.
        """
        columns = {
            "height_m": height_m,
            "mass_kg": mass_kg,
            "speed_m_s": speed_m_s,
            "step_length_m": step_length_m,
            "step_frequency_hz": step_frequency_hz,
            "heading_rad": heading_rad,
        }
        given = {name: np.asarray(value, np.float32) for name, value in columns.items() if value is not None}
        places = np.asarray(place, np.float32)
        types = None if somatotype is None else np.asarray(somatotype, np.float32)
        builds = [constitution] if isinstance(constitution, str) else list(constitution)
        sexes = [sex] if isinstance(sex, str) else list(sex)
        styles, style_length = _style_rows(style)
        if count is None:
            lengths = [a.shape[0] for a in given.values() if a.ndim] + [len(builds), len(sexes), styles.shape[0]]
            lengths += [a.shape[0] for a in (places, types) if a is not None and a.ndim == 2]
            count = max(lengths)
        bits = {"speed_m_s": lib.MOBIL_SPEED, "step_length_m": lib.MOBIL_STEP_LENGTH}
        bits["step_frequency_hz"] = lib.MOBIL_STEP_FREQUENCY
        people = ffi.new("mobil_person[]", count)
        usual = struct("person")
        usual.posed = 1 if posed else 0
        usual.given = sum(bit for name, bit in bits.items() if name in given)
        rows = {name: np.broadcast_to(value, (count,)) for name, value in given.items()}
        places = np.broadcast_to(places, (count, 3))
        types = None if types is None else np.broadcast_to(types, (count, 3))
        styles = np.ascontiguousarray(np.broadcast_to(styles, (count, styles.shape[1])))
        for i in range(count):
            person = people[i]
            ffi.memmove(ffi.addressof(people, i), usual, ffi.sizeof("mobil_person"))
            for name, values in rows.items():
                setattr(person, name, float(values[i]))
            person.place = places[i].tolist()
            if types is not None:
                person.endo, person.meso, person.ecto = types[i].tolist()
            person.constitution = number_of(builds[i % len(builds)], names.CONSTITUTIONS, "constitution")
            person.sex = number_of(sexes[i % len(sexes)], names.SEXES, "sex")
            if style_length:
                person.style = ffi.cast("const float*", styles[i].ctypes.data)
                person.style_count = style_length
        ids = np.zeros(count, PERSON)
        muscles = ffi.NULL if muscles is None else muscles
        self._do(lib.mobil_spawn(self._sim, people, 0, count, muscles, _ids(ids)))
        return ids

    def despawn(self, people: People) -> None:
        self._do(lib.mobil_despawn(self._sim, *_all(people)))

    @property
    def people(self) -> People:
        """Everybody who is there, in no particular order."""
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
        speed_m_s: float | None = None,
        step_length_m: float | None = None,
        step_frequency_hz: float | None = None,
        style: Mapping[str, float] | None = None,
        heading_rad: float | None = None,
    ) -> None:
        """From the next step on; what is left out stays. A speed of 0 stops."""
        walk = struct("walk")
        for name, value, bit in (
            ("speed_m_s", speed_m_s, lib.MOBIL_SPEED),
            ("step_length_m", step_length_m, lib.MOBIL_STEP_LENGTH),
            ("step_frequency_hz", step_frequency_hz, lib.MOBIL_STEP_FREQUENCY),
            ("heading_rad", heading_rad, lib.MOBIL_HEADING),
        ):
            if value is not None:
                setattr(walk, name, value)
                walk.given |= bit
        rows, length = _style_rows(style)
        if length:
            walk.given |= lib.MOBIL_STYLE
            walk.style = ffi.cast("const float*", rows[0].ctypes.data)
            walk.style_count = length
        self._do(lib.mobil_change_walk(self._sim, *_all(people), walk))

    def set_poses(self, people: People, poses: npt.ArrayLike, *, jumped: bool = False) -> None:
        """Of posed people, at the end of the next tick: (n, 48, 7), place x y z and quaternion x y z w in the world."""
        people = _people(people)
        rows = np.ascontiguousarray(poses, np.float32).reshape(people.size, len(names.SEGMENTS), 7)
        self._do(lib.mobil_set_poses(self._sim, *_all(people), _floats(rows), 0, int(jumped)))

    def walk(self, person: People) -> dict[str, Any]:
        """What a walker is to do, as change_walk takes it; `style` has all of its numbers."""
        to = struct("walk")
        style = np.empty(len(names.STYLE), np.float32)
        self._do(lib.mobil_get_walk(self._sim, _one(person), to, _floats(style), style.size))
        walk: dict[str, Any] = {"speed_m_s": to.speed_m_s, "heading_rad": to.heading_rad}
        if to.given & lib.MOBIL_STEP_LENGTH:
            walk["step_length_m"] = to.step_length_m
        walk["style"] = dict(zip(names.STYLE, style.tolist()))
        return walk

    def limit_violations(self, person: People) -> list[str]:
        """The limits of ground, joints and pelvis that a walker is beyond now: of nearly everybody none."""
        length = ffi.new("size_t*")
        self._do(lib.mobil_limit_violations(self._sim, _one(person), ffi.NULL, 0, length))
        if length[0] == 0:
            return []
        text = ffi.new("char[]", length[0] + 1)
        self._do(lib.mobil_limit_violations(self._sim, _one(person), text, length[0] + 1, ffi.NULL))
        return ffi.string(text).decode().splitlines()

    @property
    def people_beyond_limits(self) -> int:
        """How many people were beyond such a limit in the last tick."""
        people = ffi.new("size_t*")
        self._do(lib.mobil_limit_violation_counts(self._sim, people, ffi.NULL))
        return people[0]

    def place(self, people: People, place: npt.ArrayLike, heading_rad: npt.ArrayLike) -> None:
        """Puts walkers elsewhere at once, all or none; no inertia is felt. place: (…, 3) in the world's axes."""
        people = _people(people)
        rows = np.empty((people.size, 4), np.float32)
        rows[:, :3] = place
        rows[:, 3] = heading_rad
        self._do(lib.mobil_place_many(self._sim, *_all(people), _floats(rows), 0))

    def shift_origin(self, to: npt.ArrayLike) -> None:
        """The origin moves there: every place becomes so much less."""
        at = np.ascontiguousarray(to, np.float32)
        if at.shape != (3,):
            raise ValueError(f"the origin moves to a place of three numbers, and this has the shape {at.shape}")
        self._do(lib.mobil_shift_origin(self._sim, _floats(at)))

    def enable(self, people: People, feature: str, on: bool = True) -> None:
        """They have a feature from the next tick on, or no more: "step_events" (events() tells of their steps), "fat" that
        wobbles under the skin (Skin), or "forces" (ground reactions and joint moments)."""
        self._do(lib.mobil_enable(self._sim, *_all(people), number_of(feature, names.FEATURES, "feature"), int(on)))

    def set_state(self, people: People, state: str, within_m: float = 0.005) -> int:
        """How many of them are "full", "compact" (nobody looks at them) or "asleep" (nobody sees them) now.

        within_m: of who wakes, control points of muscles are so near to where they would be.
        """
        count = ffi.new("size_t*")
        number_of(state, tuple(_STATES), "state")  # says which there are
        self._do(lib.mobil_set_state(self._sim, *_all(people), _STATES[state], within_m, count))
        return int(count[0])

    def state(self, person: People) -> str:
        """"full", "compact", "asleep" or "posed"."""
        state = ffi.new("int*")
        self._do(lib.mobil_get_state(self._sim, _one(person), state))
        return next(name for name, number in _STATES.items() if number == state[0])

    # Muscles

    def set_muscles(self, people: People, muscles: Any) -> None:
        """mobil.muscles(…), or None: they go."""
        self._do(lib.mobil_set_muscles(self._sim, *_all(people), ffi.NULL if muscles is None else muscles))

    def set_method(self, people: People, muscle: str, method: Any) -> None:
        """mobil.method(…) of one muscle, both sides, without a jump."""
        self._do(lib.mobil_set_method(self._sim, *_all(people), number_of(muscle, names.MUSCLES, "muscle"), method))

    def method(self, person: People, muscle: str) -> str:
        """The name of a muscle's method now."""
        to = struct("method")
        number = number_of(muscle, names.MUSCLES, "muscle")
        self._do(lib.mobil_get_method(self._sim, _one(person), number, to))
        return names.METHODS[to.method]

    def set_excitation(self, people: People, muscle: str, side: str, excitation: npt.ArrayLike) -> None:
        """0.01 to 1 (beyond: the nearer end), of muscles with activation="host"."""
        people = _people(people)
        values = np.ascontiguousarray(np.broadcast_to(np.asarray(excitation, np.float32), people.shape))
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
        """Makes what these muscles share, so that nobody waits for it later."""
        self._do(lib.mobil_prepare(self._sim, muscles))

    def bake(self) -> bytes:
        """All that was made so far."""
        size = ffi.new("size_t*")
        self._do(lib.mobil_bake(self._sim, ffi.NULL, 0, size))
        out = bytearray(size[0])
        self._do(lib.mobil_bake(self._sim, ffi.from_buffer(out), len(out), ffi.NULL))
        return bytes(out)

    def load_baked(self, baked: bytes) -> None:
        data = ffi.from_buffer(baked)  # len() of it is bytes, and of an array rows
        self._do(lib.mobil_load_baked(self._sim, data, len(data)))

    # Time and state

    def tick(self, ticks: int = 1) -> None:
        self._ran(lib.mobil_tick(self._sim, ticks))

    def advance(self, seconds: float) -> Ticks:
        """As many ticks as the time fed so far makes."""
        ticks = ffi.new("mobil_ticks*")
        self._ran(lib.mobil_advance(self._sim, seconds, ticks))
        return Ticks(ticks.count, ticks.alpha, ticks.dropped_s)

    @property
    def time_s(self) -> float:
        return lib.mobil_time_s(self._sim)

    @property
    def tick_s(self) -> float:
        return lib.mobil_tick_s(self._sim)

    def save(self) -> bytes:
        """The whole state."""
        out = bytearray(lib.mobil_snapshot_bytes(self._sim))
        used = ffi.new("size_t*")
        self._do(lib.mobil_save(self._sim, ffi.from_buffer(out), len(out), used))
        return bytes(out[: used[0]])

    def restore(self, state: bytes) -> None:
        data = ffi.from_buffer(state)
        self._do(lib.mobil_restore(self._sim, data, len(data)))

    def hash(self) -> int:
        """Of the whole state, 64 bits: equal states have equal ones, on any machine and threads."""
        half = ffi.new("unsigned int[2]")
        self._do(lib.mobil_hash(self._sim, half))
        return half[0] | half[1] << 32

    def cost(self) -> list[SystemCost]:
        """What each system cost in the last tick, in the order of running."""
        found: list[SystemCost] = []
        one = ffi.new("mobil_system*")
        while lib.mobil_cost(self._sim, len(found), one) == lib.MOBIL_OK:
            found.append(SystemCost(text(one.name), text(one.module), one.seconds, int(one.entities)))
        return found

    def phases(self) -> list[PhaseCost]:
        """What each phase of the last tick cost: lod, avoidance and terrain among them, in the order of running."""
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
        """Poses at an instant after the last tick (ahead_s: 0 to 0.2), exactly.

        (n, segments, 7) place x y z and quaternion x y z w, or (…, 3, 4) of "matrix", (…, 8) of "dual_quaternion".
        """
        layout = struct("pose_layout")
        layout.form = number_of(form, names.FORMS, "form")
        layout.ahead_s = ahead_s
        layout.to_parent = int(to_parent)
        chosen = range(len(names.SEGMENTS)) if segments is None else segments
        numbers = ffi.new("int[]", [number_of(s, names.SEGMENTS, "segment") for s in chosen])
        layout.segments = numbers
        layout.segment_count = len(numbers)
        people = _people(people)
        shape = ((7,), (3, 4), (8,))[layout.form]
        out = _out(out, (people.size, len(numbers), *shape))
        if out.size:
            self._do(lib.mobil_poses(self._sim, *_all(people), layout, _floats(out), _stride(out)))
        return out

    def events(self) -> People:
        """What happened in all ticks of the last advance or tick in the steps of who has "step_events": an array of EVENT."""
        count = ffi.new("size_t*")
        self._do(lib.mobil_events(self._sim, ffi.NULL, 0, count))
        found = np.zeros(count[0], EVENT)
        if found.size:
            self._do(lib.mobil_events(self._sim, ffi.from_buffer("mobil_event[]", found), found.size, ffi.NULL))
        return found

    def roots(self, people: People, ahead_s: float = 0.0) -> People:
        """Where people are on the ground and head, without the sway of the hips: an array of ROOT."""
        people = _people(people)
        found = np.zeros(people.size, ROOT)
        at = ffi.from_buffer("mobil_root[]", found) if found.size else ffi.NULL
        self._do(lib.mobil_roots(self._sim, *_all(people), ahead_s, at))
        return found

    def root_motion(self, people: People, roots: People, ahead_s: float = 0.0) -> Floats:
        """(n, 4): the way from `roots` to where people are now, in the world's axes as if they headed along the axis
        ahead, and by how much they turned, rad, to the left. Where they are now is written over `roots`."""
        people = _people(people)
        out = np.empty((people.size, 4), np.float32)
        fits = isinstance(roots, np.ndarray) and roots.dtype == ROOT and roots.shape == people.shape
        if not fits or not roots.flags.carray:
            raise ValueError("roots must be what roots() gave of as many people")
        if not out.size:
            return out
        at = ffi.from_buffer("mobil_root[]", roots)
        ways = ffi.cast("mobil_motion*", out.ctypes.data)
        self._do(lib.mobil_root_motion(self._sim, *_all(people), ahead_s, at, ways))
        return out

    def _rows(self, what: int, people: People, out: Floats | None) -> Floats:
        people = _people(people)
        out = _out(out, (people.size, lib.mobil_row_floats(what)))
        self._do(lib.mobil_read(self._sim, what, *_all(people), _floats(out), _stride(out)))
        return out

    def joints(self, people: People, out: Floats | None = None) -> Floats:
        """(n, 13) angles in rad, columns as names.JOINTS."""
        return self._rows(lib.MOBIL_JOINTS, people, out)

    def feet(self, people: People) -> tuple[Floats, Floats]:
        """Points of the soles (n, heel toe tip, right left, 3), and phases of the gait cycle (n, right left)."""
        rows = self._rows(lib.MOBIL_FEET, people, None)
        return rows[:, :18].reshape(-1, 3, 2, 3), rows[:, 18:]

    def centre_of_mass(self, people: People, out: Floats | None = None) -> Floats:
        """(n, 3)."""
        return self._rows(lib.MOBIL_CENTRE, people, out)

    def ground(self, people: People) -> tuple[Floats, Floats]:
        """Of who has forces: on each foot (n, right left, 3), N, and centres of pressure (n, right left, 3)."""
        rows = self._rows(lib.MOBIL_GROUND, people, None).reshape(-1, 2, 2, 3)
        return rows[:, 0], rows[:, 1]

    def moments(self, people: People, out: Floats | None = None) -> Floats:
        """Of who has forces: (n, 6) N m, columns as names.MOMENTS."""
        return self._rows(lib.MOBIL_MOMENTS, people, out)

    def muscle_rows(
        self, what: str, people: People, muscle: str, side: str = "right", out: Floats | None = None
    ) -> Floats:
        """(n, columns) of one muscle.

        what: "line" (names.LINE), "line_motion", "report" (names.REPORT), "activation", "tendon" (names.TENDON), or
        "nodes": displacements of control points in the muscle's frame, m, three a node.
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
