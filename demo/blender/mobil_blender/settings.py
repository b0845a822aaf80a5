"""Settings of a person, as properties of the scene and of the operators, and requests made from them."""

from __future__ import annotations

import math
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from . import library
from .library import Muscles, Person
from .recording import Clip


def _label(name: str) -> str:
    return name.replace("_", " ").capitalize()


def _choice(names: tuple[str, ...], meanings: tuple[str, ...] | None = None) -> list[tuple[str, str, str]]:
    return [(name, _label(name), text) for name, text in zip(names, meanings or ("",) * len(names))]


def _style_property(one: library.StyleNumber) -> Any:
    suffix = f"_{one.unit.replace('/', '_per_').lower()}"
    unit = {"1": "", "height": " × height", "cycle": " × cycle"}.get(one.unit, f" ({one.unit})")
    name = one.name.removesuffix(suffix).removesuffix("_h")
    return FloatProperty(
        name=_label(name) + unit,
        description=f"{one.meaning}; {one.low:g} to {one.high:g}, usually {one.usual:g}",
        default=one.usual,
        min=one.low,
        max=one.high,
        precision=3 if one.high - one.low < 2 else 1,
        step=1 if one.high - one.low < 2 else 100,
    )


STYLE = {one.name: _style_property(one) for one in library.STYLE}

BODY = {
    "height_m": FloatProperty(
        name="Height", description="Height without shoes", default=1.75, min=1.2, max=2.2, precision=3, unit="LENGTH"
    ),
    "mass_kg": FloatProperty(
        name="Mass (kg)",
        description="Mass in kg, within the range of real bodies of that height",
        default=75,
        min=30,
        max=200,
    ),
    "sex": EnumProperty(name="Sex", description="Girths of the skin", items=_choice(library.SEXES)),
    "constitution": EnumProperty(
        name="Build", description="Share of muscle and fat", items=_choice(library.CONSTITUTIONS), default="average"
    ),
}
WALK = {
    "speed_m_s": FloatProperty(
        name="Speed",
        description="Speed of the walk; 0 stands",
        default=1.4,
        min=0.0,
        max=4.0,
        precision=2,
        unit="VELOCITY",
    ),
    "step_length_m": FloatProperty(
        name="Step length",
        description="Length of a step; 0 is the usual length for this speed and leg",
        default=0.0,
        min=0.0,
        max=2.0,
        precision=3,
        unit="LENGTH",
    ),
    "heading_rad": FloatProperty(
        name="Heading",
        description="Rotation of a new person about Z; 0 faces -Y, and positive angles are to the person's left",
        subtype="ANGLE",
        soft_min=-math.pi,
        soft_max=math.pi,
    ),
    "turn_rad": FloatProperty(
        name="Turn",
        description="Turns to the left by this angle during the walk; not with whole strides",
        subtype="ANGLE",
        min=-math.pi,
        max=math.pi,
    ),
}
CLIP = {
    "length": EnumProperty(
        name="Length",
        description="Length of the action",
        items=(
            ("STRIDES", "Strides", "Whole strides: the last key equals the first one, except for the way"),
            ("SECONDS", "Seconds", "A time"),
        ),
    ),
    "strides": IntProperty(name="Strides", description="Number of strides, two steps each", default=2, min=1, max=20),
    "seconds": FloatProperty(
        name="Seconds", description="Duration", default=2.0, min=0.1, max=60.0, subtype="TIME_ABSOLUTE"
    ),
    "root": EnumProperty(
        name="Way",
        description="Where the way is stored",
        items=(
            ("MOTION", "Root motion", "The bone root carries the way, as Unreal, Unity and Godot expect it"),
            ("IN_PLACE", "In place", "The person walks on the spot, and the game moves them"),
        ),
    ),
}
MESHES = {
    "skin": EnumProperty(
        name="Skin",
        description="Skin and clothes",
        items=[
            ("NONE", "None", "No skin"),
            ("distant", "Distant", "About 1,200 triangles"),
            ("far", "Far", "About 5,000 triangles"),
            ("near", "Near", "About 20,000 triangles"),
            ("hero", "Hero", "About 90,000 triangles"),
        ],
        default="near",
    ),
    "muscles": EnumProperty(
        name="Muscles",
        description="Groups of leg muscles as shape keys",
        items=[(name, _label(name), "", 1 << i) for i, name in enumerate(library.GROUPS)],
        options={"ENUM_FLAG"},
        default=set(),
    ),
    "single_muscles": EnumProperty(
        name="Single muscles",
        description="Single leg muscles as shape keys, those that can be seen",
        items=[(name, _label(name), "", 1 << i) for i, name in enumerate(library.SINGLE_MUSCLES)],
        options={"ENUM_FLAG"},
        default=set(),
    ),
    "contract": BoolProperty(name="Contract", description="Muscles pull and thicken as in people who walk"),
    "bones": BoolProperty(name="Bones", description="The anatomical skeleton as a mesh", default=False),
    "surface_detail": FloatProperty(
        name="Detail", description="Share of the triangles of muscles and bones", default=0.5, min=0.05, max=1.0
    ),
}
CROWD = {
    "count": IntProperty(name="People", description="Number of people", default=20, min=1, max=1000),
    "side_m": FloatProperty(
        name="Side",
        description="Side of the square in which they walk",
        default=12.0,
        min=2.0,
        max=500.0,
        unit="LENGTH",
    ),
    "builds": IntProperty(
        name="Builds", description="Different bodies; people of one build share meshes", default=6, min=1, max=100
    ),
    "seed": IntProperty(name="Seed", description="Seed of bodies, places and goals", default=1, min=0),
}
PERSON = {**BODY, **WALK, **CLIP, **MESHES, **STYLE}
SECTIONS = {"Person": BODY, "Walk": WALK, "Clip": CLIP, "Meshes": MESHES}

MobilSettings = type("MobilSettings", (bpy.types.PropertyGroup,), {"__annotations__": {**PERSON, **CROWD}})
MobilSettings.__doc__ = "Settings of the panel"


def values(of: Any, names: Any = PERSON) -> dict[str, Any]:
    """Returns settings as plain values."""
    return {name: set(value) if isinstance(value := getattr(of, name), set) else value for name in names}


def put(of: Any, given: dict[str, Any]) -> None:
    """Sets the settings that `given` has."""
    for name, value in given.items():
        if hasattr(of, name):
            setattr(of, name, value)


def person(of: Any) -> Person:
    return Person(
        of.height_m,
        of.mass_kg,
        of.sex,
        of.constitution,
        of.speed_m_s,
        of.step_length_m,
        {name: getattr(of, name) for name in STYLE},
    )


def clip(of: Any, scene: bpy.types.Scene) -> Clip:
    fps = scene.render.fps / scene.render.fps_base
    return Clip(fps, of.seconds, of.strides if of.length == "STRIDES" else 0, of.turn_rad)


def muscles(of: Any) -> Muscles:
    return Muscles(frozenset(of.muscles) | frozenset(of.single_muscles), of.contract)


def register() -> None:
    bpy.utils.register_class(MobilSettings)
    bpy.types.Scene.mobil = PointerProperty(type=MobilSettings)


def unregister() -> None:
    del bpy.types.Scene.mobil
    bpy.utils.unregister_class(MobilSettings)
