"""Operators: bpy.ops.mobil.walk, crowd, read and preset."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import EnumProperty, StringProperty

from . import library, person, presets, settings
from .library import Refused


class MobilOperator(bpy.types.Operator):
    """Base of operators whose settings come from the panel, or from a script."""

    bl_options = {"REGISTER", "UNDO", "PRESET"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "OBJECT"

    def invoke(self, context: bpy.types.Context, _event: Any) -> set[str]:
        own = [name for name in self.__annotations__ if hasattr(context.scene.mobil, name)]
        settings.put(self, settings.values(context.scene.mobil, own))
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.work(context)
        except Refused as refused:
            self.report({"ERROR"}, str(refused))
            return {"CANCELLED"}
        return {"FINISHED"}


class MOBIL_OT_walk(MobilOperator):
    """Make a walking person at the 3D cursor, or remake one"""

    bl_idname = "mobil.walk"
    bl_label = "New person"
    __annotations__ = {
        "person": StringProperty(
            name="Person",
            description="Name of the armature of a person to remake; empty for a new one",
            options={"SKIP_SAVE"},
        ),
        **settings.PERSON,
    }

    def work(self, context: bpy.types.Context) -> None:
        old = bpy.data.objects.get(self.person) if self.person else None
        if self.person and not person.is_person(old):
            raise Refused(f"person: '{self.person}' is not an armature that mobil made; choose one, or leave it empty")
        _, lines = person.make(context, self, old)
        for line in lines:
            self.report({"INFO"}, line)

    def draw(self, _context: bpy.types.Context) -> None:
        draw_sections(self.layout, self)
        draw_muscles(self.layout, self)


class MOBIL_OT_crowd(MobilOperator):
    """Make a crowd of people who avoid each other, or remake the one of that name"""

    bl_idname = "mobil.crowd"
    bl_label = "Make crowd"
    __annotations__ = {
        "collection": StringProperty(
            name="Collection", description="Collection of the crowd; an older crowd in it is replaced", default="crowd"
        ),
        **settings.CROWD,
        "seconds": settings.CLIP["seconds"],
        "skin": settings.MESHES["skin"],
    }

    def work(self, context: bpy.types.Context) -> None:
        person.make_crowd(context, self)


class MOBIL_OT_read(bpy.types.Operator):
    """Copy the settings of the active person to the panel"""

    bl_idname = "mobil.read"
    bl_label = "Read settings"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return person.person_of(context.object) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings.put(context.scene.mobil, person.stored(person.person_of(context.object)))
        return {"FINISHED"}


class MOBIL_OT_preset(bpy.types.Operator):
    """Set the walk of the panel to a named one"""

    bl_idname = "mobil.preset"
    bl_label = "Preset"
    bl_options = {"REGISTER", "UNDO"}
    __annotations__ = {
        "name": EnumProperty(name="Walk", items=[(name, name, of.meaning) for name, of in presets.WALKS.items()])
    }

    def execute(self, context: bpy.types.Context) -> set[str]:
        presets.put(context.scene.mobil, self.name)
        return {"FINISHED"}


def draw_sections(layout: bpy.types.UILayout, of: Any) -> None:
    """Draws all settings of a person except the style."""
    hidden = {"muscles", "single_muscles", "contract"} | ({"strides"} if of.length == "SECONDS" else {"seconds", "turn_rad"})
    for title, names in settings.SECTIONS.items():
        box = layout.box().column()
        box.label(text=title)
        for name in names:
            if name not in hidden:
                box.prop(of, name)


def draw_muscles(layout: bpy.types.UILayout, of: Any) -> None:
    """Draws muscles at full width, groups first."""
    for text, field, names in (
        ("Groups", "muscles", library.GROUPS),
        ("Single muscles", "single_muscles", library.SINGLE_MUSCLES),
    ):
        box = layout.column(align=True)
        box.use_property_split = False
        box.label(text=text)
        for name in names:
            box.prop_enum(of, field, name)


CLASSES = (MOBIL_OT_walk, MOBIL_OT_crowd, MOBIL_OT_read, MOBIL_OT_preset)
