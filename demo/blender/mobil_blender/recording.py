"""Recordings of walks as arrays in Blender's axes, one row for each frame."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from . import axes
from .library import PARENTS, SEGMENTS, Body, Muscles, Person, Refused, Surfaces, World

_TICK_S = 1 / 60  # longest tick; frames have a whole number of ticks
_SETTLE_STRIDES = 4  # until muscles move steadily


class Clip(NamedTuple):
    """Length of a recording: `strides` whole strides if it is not 0, else `seconds`."""

    fps: float = 24.0
    seconds: float = 2.0
    strides: int = 0
    turn_rad: float = 0.0
    """Turn to the left from the first frame on, with `seconds`."""


class Timing(NamedTuple):
    tick_s: float
    ticks: int
    """In a frame."""
    settle: int
    """Ticks before the first frame."""
    frames: int
    """Intervals; there is one key more."""


class Way(NamedTuple):
    """Motion of one person: the root bone in the armature's space, and segments to their parents."""

    root_places: np.ndarray
    """(keys, 3): from the first key's root, which is at 0 and faces -Y."""
    root_headings: np.ndarray
    """(keys,): rad, to the left."""
    places: np.ndarray
    """(keys, 48, 3): joints in the parent's frame, of the pelvis in the root's."""
    rotations: np.ndarray
    """(keys, 48, 4): w x y z."""


class Mesh(NamedTuple):
    """Bones or muscles of one person: positions in the anatomical position, and displacements of vertices in the frame
    of the segment that carries them."""

    parts: tuple[tuple[str, slice], ...]
    """Name and triangles of each."""
    triangles: np.ndarray
    positions: np.ndarray
    """(vertices, 3)."""
    segments: np.ndarray
    """(vertices,)."""
    displacements: np.ndarray | None
    """(keys, vertices, 3), or None for bones."""


class Walk(NamedTuple):
    timing: Timing
    body: Body
    way: Way
    style: dict[str, float]
    """As corrected to limits of ground and joints."""
    bones: Mesh | None
    muscles: Mesh | None


def timing(person: Person, clip: Clip) -> Timing:
    """Returns ticks and frames. Whole strides get a whole number of frames, so a cycle in the scene is up to half a
    frame longer or shorter than in the library."""
    if clip.strides and clip.turn_rad:
        raise Refused("turn: whole strides go straight ahead; set the turn to 0, or the length to seconds")
    world = World()
    stride_s = world.stride_s(world.spawn([person])[0])
    if clip.strides:
        if not stride_s:
            raise Refused("strides: a standing person has none; set a speed above 0, or the length to seconds")
        frames = max(round(clip.strides * stride_s * clip.fps), 4 * clip.strides)
        frame_s = clip.strides * stride_s / frames
    else:
        frames = max(round(clip.seconds * clip.fps), 1)
        frame_s = 1 / clip.fps
    ticks = math.ceil(frame_s / _TICK_S - 1e-9)
    tick_s = frame_s / ticks
    settle = round(_SETTLE_STRIDES * (stride_s or 0.5) / tick_s)
    return Timing(tick_s, ticks, max(settle, 1), frames)


def _way(roots: Any, headings: Any, places: Any, rotations: Any) -> Way:
    """Makes places and rotations of the pelvis relative to the roots, and roots relative to the first one."""
    roots, headings, places, rotations = (np.array(rows, np.float64) for rows in (roots, headings, places, rotations))
    back = axes.about_z(-headings)
    places[:, 0] = axes.rotate(back, places[:, 0] - roots)
    rotations[:, 0] = axes.multiply(back, rotations[:, 0])
    first = axes.about_z(-headings[:1])
    return Way(axes.rotate(first, roots - roots[0]), np.unwrap(headings) - headings[0], places, rotations)


def _rest(world: World, person: Person, muscles: Muscles) -> Any:
    return world.spawn([person._replace(place=(0.0, 0.0), heading_rad=0.0)], muscles, posed=True)


def record(person: Person, clip: Clip, muscles: Muscles, bones: bool, detail: float) -> Walk:
    """Records one person. `detail`: share of the triangles of bones and muscles, 0.05 to 1."""
    time = timing(person, clip)
    world = World(time.tick_s)
    ids = world.spawn([person], muscles)
    one = ids[0]
    style = world.style(one)
    surfaces = rest = None
    if bones or muscles.bits:
        rest = _rest(world, person, muscles)[0]
        surfaces = Surfaces(world, one, bones, muscles, detail)
    world.tick(time.settle)
    if clip.turn_rad:
        world.turn(ids, person.heading_rad + clip.turn_rad)
    rows: tuple[list[Any], ...] = ([], [], [], [])
    segments, vertices = [], []
    for frame in range(time.frames + 1):
        for column, values in zip(rows, (*world.roots(ids), *world.poses(ids))):
            column.append(values[0])
        if muscles.bits:
            segments.append([of[0] for of in world.poses(ids, to_parent=False)])
            vertices.append(surfaces.positions(one))
        if frame < time.frames:
            world.tick(time.ticks)
    way = _way(*rows)
    if clip.strides:  # equal to some micrometres; exact for programs that compare keys
        way.places[-1], way.rotations[-1] = way.places[0], way.rotations[0]
    body = world.body(one)
    made_bones = made_muscles = None
    if surfaces:
        at = surfaces.positions(rest)
        if bones:
            made_bones = _mesh(surfaces, at, True, body, None, None)
        if muscles.bits:
            made_muscles = _mesh(surfaces, at, False, body, segments, np.array(vertices))
            if clip.strides:
                made_muscles.displacements[-1] = made_muscles.displacements[0]
    return Walk(time, body, way, style, made_bones, made_muscles)


def _mesh(surfaces: Surfaces, rest: np.ndarray, bones: bool, body: Body, segments: Any, vertices: Any) -> Mesh:
    """Takes bones or muscles out of the surfaces."""
    chosen = [part for part in surfaces.parts if (part.segment >= 0) == bones]
    kept = np.concatenate([np.arange(part.vertices.start, part.vertices.stop) for part in chosen])
    number = np.full(surfaces.count, -1)
    number[kept] = np.arange(kept.size)
    parts, triangles, of, moved = [], [], [], []
    begin = 0
    for part in chosen:
        corners = number[surfaces.triangles[part.triangles]]
        parts.append((part.name, slice(begin, begin + len(corners))))
        begin += len(corners)
        triangles.append(corners)
        segment = part.segment
        if not bones:
            here = part.vertices
            segment, displacements = _carrier(part.name, rest[here], body, segments, vertices[:, here])
            moved.append(displacements)
        of.append(np.full(part.vertices.stop - part.vertices.start, segment))
    return Mesh(
        tuple(parts),
        np.concatenate(triangles),
        rest[kept],
        np.concatenate(of),
        np.concatenate(moved, axis=1) if moved else None,
    )


def _carrier(name: str, rest: np.ndarray, body: Body, segments: Any, vertices: np.ndarray) -> tuple[int, np.ndarray]:
    """Returns the segment in whose frame a muscle changes least, and its displacements there."""
    side = name.rsplit("_", 1)[1]
    joints = body.joints
    best = None
    for number, segment in enumerate(SEGMENTS):
        if segment != "pelvis" and segment not in (f"{limb}_{side}" for limb in ("thigh", "shank", "foot", "patella")):
            continue
        places = np.array([row[0][number] for row in segments])[:, None]
        rotations = np.array([row[1][number] for row in segments])[:, None]
        carried = axes.rotate(axes.conjugate(rotations), vertices - places)
        displacements = carried - (rest - joints[number])
        spread = float(displacements.var(axis=0).sum())
        if best is None or spread < best[0]:
            best = spread, number, displacements
    return best[1], best[2]


class Crowd(NamedTuple):
    timing: Timing
    bodies: list[Body]
    ways: list[Way]
    places: np.ndarray
    """(people, 3): first roots."""
    headings: np.ndarray
    """(people,): first headings."""


def record_crowd(people: list[Person], clip: Clip, side_m: float, seed: int) -> Crowd:
    """Records people who avoid each other in a square with walls, and turn toward new goals in it."""
    time = timing(people[0], clip._replace(strides=0, turn_rad=0.0))
    world = World(time.tick_s)
    ids = world.spawn(people)
    half = side_m / 2 + 0.5
    corner = np.array([(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], np.float64)
    world.avoid(ids, np.stack((corner, np.roll(corner, -1, axis=0)), axis=1))
    draw = np.random.default_rng(seed)
    speeds = np.array([person.speed_m_s for person in people])
    goals = draw.uniform(-side_m / 2, side_m / 2, (len(people), 2))
    rows: tuple[list[Any], ...] = ([], [], [], [])

    def run(ticks: int) -> None:
        at = world.roots(ids)[0][:, :2]
        reached = np.linalg.norm(goals - at, axis=1) < 1.0
        goals[reached] = draw.uniform(-side_m / 2, side_m / 2, (int(reached.sum()), 2))
        to = goals - at
        world.head(ids, speeds, np.arctan2(to[:, 0], -to[:, 1]))
        world.tick(ticks)

    for _ in range(round(2 / time.tick_s / time.ticks)):
        run(time.ticks)
    for frame in range(time.frames + 1):
        for column, values in zip(rows, (*world.roots(ids), *world.poses(ids))):
            column.append(values)
        if frame < time.frames:
            run(time.ticks)
    columns = [np.array(column) for column in rows]
    ways = [_way(*(column[:, i] for column in columns)) for i in range(len(people))]
    return Crowd(time, [world.body(one) for one in ids], ways, columns[0][0], columns[1][0])
