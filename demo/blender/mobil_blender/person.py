"""Persons and crowds in the scene: an armature with its action, and meshes that it moves."""

from __future__ import annotations

import json
import math
from typing import Any

import bpy
import numpy as np

from . import meshes, rig, settings
from .library import Muscles, Person, Refused, World
from .recording import record, record_crowd

KEY = "mobil"  # custom property of what this add-on has made


def is_person(of: Any) -> bool:
    return of is not None and of.type == "ARMATURE" and KEY in of


def person_of(of: Any) -> Any:
    """Returns the person to which an object belongs, or None."""
    return of if is_person(of) else of.parent if of is not None and is_person(of.parent) else None


def stored(of: bpy.types.Object) -> dict[str, Any]:
    """Returns the settings that a person was made with."""
    given = json.loads(of[KEY])
    return {name: set(value) if isinstance(value, list) else value for name, value in given.items()}


def _store(of: bpy.types.Object, given: dict[str, Any]) -> None:
    plain = {name: sorted(value) if isinstance(value, set) else value for name, value in given.items()}
    of[KEY] = json.dumps(plain)


def part(of: bpy.types.Object, name: str) -> Any:
    """Returns a person's object skin, muscles or bones, or None."""
    return next((child for child in of.children if child.get(f"{KEY}_part") == name), None)


def make(context: bpy.types.Context, asked: Any, old: Any = None) -> tuple[bpy.types.Object, list[str]]:
    """Makes a person at the 3D cursor, or remakes `old` where it is. Returns it with lines about corrections.

    Everything that the library can refuse is done before the scene changes."""
    request, clip, muscles = settings.person(asked), settings.clip(asked, context.scene), settings.muscles(asked)
    walk = record(request, clip, muscles, asked.bones, asked.surface_detail)
    binding = None
    if asked.skin != "NONE":
        world = World()
        binding = world.binding(world.spawn([request])[0], asked.sex, asked.skin)
    first, cycle = context.scene.frame_start, clip.strides > 0
    if old is None:
        armature = bpy.data.armatures.new("person")
        armature.display_type = "STICK"
        of = bpy.data.objects.new("person", armature)
        of.show_in_front = True
        context.collection.objects.link(of)
        of.location = context.scene.cursor.location
        of.rotation_euler.z = asked.heading_rad
    else:
        of = old
        if of.data.users > 1:
            of.data = of.data.copy()
        if stored(of).get("heading_rad") != asked.heading_rad:
            of.rotation_euler.z = asked.heading_rad
    rig.build_armature(of.data, walk.body)
    rig.animate(of, f"{of.name}_walk", walk.body, walk.way, first, asked.root == "IN_PLACE", cycle)
    _store(of, settings.values(asked))
    for name in ("tick_s", "ticks", "settle"):
        of[f"{KEY}_{name}"] = getattr(walk.timing, name)
    lines = _corrections(request, walk.style)
    _put(context, of, "skin", binding and meshes.skin_mesh(f"{of.name}_skin", binding, 0))
    if binding:
        meshes.weigh_skin(part(of, "skin"), binding)
    _put(context, of, "bones", walk.bones and meshes.surface_mesh(f"{of.name}_bones", walk.bones, False))
    if walk.bones:
        meshes.weigh_surface(part(of, "bones"), walk.bones)
    _put(context, of, "muscles", walk.muscles and meshes.surface_mesh(f"{of.name}_muscles", walk.muscles, True))
    if walk.muscles:
        body = part(of, "muscles")
        meshes.weigh_surface(body, walk.muscles)
        made = meshes.add_shape_keys(body, of.name, walk.muscles, first, cycle)
        lines.append(f"muscles: {len(made.keys)} shape keys, {1e3 * made.rms_m:.2f} mm rms")
    for one in context.view_layer.objects.selected:
        one.select_set(False)
    of.select_set(True)
    context.view_layer.objects.active = of
    return of, lines


def _corrections(request: Person, style: dict[str, float]) -> list[str]:
    return [
        f"{name} was corrected from {request.style[name]:.3g} to {value:.3g}, by a limit of ground or joints"
        for name, value in style.items()
        if abs(value - request.style[name]) > 1e-3 * max(abs(value), 1e-3)
    ]


def _put(context: bpy.types.Context, of: bpy.types.Object, name: str, mesh: Any) -> None:
    """Gives a person a mesh as skin, muscles or bones, or takes it away."""
    old = part(of, name)
    if mesh is None:
        if old:
            remove(old)
        return
    home = of.users_collection[0] if of.users_collection else context.collection
    meshes.attach(mesh.name, mesh, of, old, home)[f"{KEY}_part"] = name


def remove(of: bpy.types.Object) -> None:
    """Removes an object with its children, and data that nothing else uses."""
    for child in list(of.children):
        if f"{KEY}_part" in child:
            remove(child)
    data, action = of.data, of.animation_data.action if of.animation_data else None
    bpy.data.objects.remove(of)
    if action and action.users == 0:
        bpy.data.actions.remove(action)
    if isinstance(data, bpy.types.Mesh):
        meshes.drop_mesh(data)
    elif data.users == 0:
        bpy.data.armatures.remove(data)


def _random_people(asked: Any) -> tuple[list[Person], np.ndarray]:
    """Returns people on a jittered grid, and the build of each."""
    draw = np.random.default_rng(asked.seed)
    across = math.ceil(math.sqrt(asked.count))
    cell = asked.side_m / across
    if cell < 0.8:
        raise Refused(
            f"crowd: {asked.count} people do not fit into a square of {asked.side_m:g} m;"
            f" choose a side of at least {0.8 * across:.1f} m, or at most {int(asked.side_m / 0.8) ** 2} people"
        )
    builds = []
    for _ in range(asked.builds):
        sex = str(draw.choice(("man", "woman")))
        height = float(np.clip(draw.normal(1.77 if sex == "man" else 1.64, 0.07), 1.5, 2.0))
        index = float(np.clip(draw.normal(24, 3), 19.5, 31))
        speed = float(np.clip(draw.normal(1.35, 0.15), 0.9, 1.7))
        builds.append(Person(height, index * height**2, sex, speed_m_s=speed))
    chosen = draw.integers(0, asked.builds, asked.count)
    cells = draw.permutation(across * across)[: asked.count]
    free = max(cell - 0.7, 0) / 2
    people = []
    for number, build in zip(cells, chosen):
        at = (np.array(divmod(int(number), across)) + 0.5) * cell - asked.side_m / 2 + draw.uniform(-free, free, 2)
        heading = float(draw.uniform(-math.pi, math.pi))
        people.append(builds[build]._replace(place=(float(at[0]), float(at[1])), heading_rad=heading))
    return people, chosen


def make_crowd(context: bpy.types.Context, asked: Any) -> bpy.types.Collection:
    """Makes people who avoid each other, or remakes the collection of that name. People of one build share meshes."""
    people, chosen = _random_people(asked)
    clip = settings.Clip(context.scene.render.fps / context.scene.render.fps_base, asked.seconds)
    crowd = record_crowd(people, clip, asked.side_m, asked.seed)
    world = World()
    first_of = {int(build): int(np.argmax(chosen == build)) for build in np.unique(chosen)}
    bindings = {}
    if asked.skin != "NONE":
        for build, number in first_of.items():
            like = people[number]
            bindings[build] = world.binding(world.spawn([like])[0], like.sex, asked.skin)
    home = bpy.data.collections.get(asked.collection)
    if home is not None and home.get(KEY):
        for one in [one for one in home.objects if is_person(one)]:
            remove(one)
    elif home is None or not home.get(KEY):
        home = bpy.data.collections.new(asked.collection)
        home[KEY] = True
        context.scene.collection.children.link(home)
    armatures: dict[int, bpy.types.Armature] = {}
    skins: dict[int, bpy.types.Mesh] = {}
    rigs = []
    centre = np.array((*context.scene.cursor.location[:2], 0.0))
    for number, (build, body) in enumerate(zip(chosen.tolist(), crowd.bodies)):
        if build not in armatures:
            armatures[build] = bpy.data.armatures.new(f"{home.name}_build_{build}")
            rig.build_armature(armatures[build], body)
        of = bpy.data.objects.new(f"{home.name}_{number}", armatures[build])
        home.objects.link(of)
        of.location = centre + crowd.places[number]
        of.rotation_euler.z = crowd.headings[number]
        rigs.append(of)
        names = ("height_m", "mass_kg", "sex", "constitution", "speed_m_s")
        _store(of, {name: getattr(people[number], name) for name in names})
        if build not in bindings:
            continue
        fresh = build not in skins
        if fresh:
            skins[build] = meshes.skin_mesh(f"{home.name}_skin_{build}", bindings[build], build)
        skin = meshes.attach(f"{of.name}_skin", skins[build], of, None, home)
        skin[f"{KEY}_part"] = "skin"
        if fresh:
            meshes.weigh_skin(skin, bindings[build])
    for of, body, way in zip(rigs, crowd.bodies, crowd.ways):
        rig.animate(of, f"{of.name}_walk", body, way, context.scene.frame_start, False, False)
    return home
