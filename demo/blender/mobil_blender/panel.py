"""The tab mobil in the sidebar of the 3D view (N)."""

from __future__ import annotations

import bpy
from bl_operators.presets import AddPresetBase

from . import person, presets, settings
from .operators import draw_muscles, draw_sections


class MOBIL_MT_presets(bpy.types.Menu):
    """Named walks, and your own"""

    bl_label = "Walks"
    preset_subdir = "mobil"
    preset_operator = "script.execute_preset"

    def draw(self, context: bpy.types.Context) -> None:
        for name in presets.WALKS:
            self.layout.operator("mobil.preset", text=name).name = name
        self.layout.separator()
        bpy.types.Menu.draw_preset(self, context)


class MOBIL_OT_add_preset(AddPresetBase, bpy.types.Operator):
    """Save the settings of the panel under a name, or remove the chosen one"""

    bl_idname = "mobil.add_preset"
    bl_label = "Save settings"
    preset_menu = "MOBIL_MT_presets"
    preset_subdir = "mobil"
    preset_defines = ["of = bpy.context.scene.mobil"]
    preset_values = [f"of.{name}" for name in settings.PERSON]


class MobilPanel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "mobil"


class MOBIL_PT_person(MobilPanel, bpy.types.Panel):
    bl_label = "Person"

    def draw(self, context: bpy.types.Context) -> None:
        layout, of = self.layout, context.scene.mobil
        layout.use_property_split = True
        layout.use_property_decorate = False
        row = layout.row(align=True)
        row.menu("MOBIL_MT_presets", text=MOBIL_MT_presets.bl_label)
        row.operator("mobil.add_preset", text="", icon="ADD")
        row.operator("mobil.add_preset", text="", icon="REMOVE").remove_active = True
        draw_sections(layout, of)
        layout.operator("mobil.walk", icon="ADD")
        active = person.person_of(context.object)
        if active:
            row = layout.row(align=True)
            row.operator("mobil.walk", text=f"Remake {active.name}", icon="FILE_REFRESH").person = active.name
            row.operator("mobil.read", text="", icon="EYEDROPPER")


class MOBIL_PT_muscles(MobilPanel, bpy.types.Panel):
    bl_label = "Muscles"
    bl_parent_id = "MOBIL_PT_person"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        draw_muscles(self.layout, context.scene.mobil)
        self.layout.prop(context.scene.mobil, "contract")


class MOBIL_PT_style(MobilPanel, bpy.types.Panel):
    bl_label = "Style"
    bl_parent_id = "MOBIL_PT_person"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        for name in settings.STYLE:
            column.prop(context.scene.mobil, name, slider=True)


class MOBIL_PT_crowd(MobilPanel, bpy.types.Panel):
    bl_label = "Crowd"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, of = self.layout, context.scene.mobil
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in (*settings.CROWD, "seconds", "skin"):
            layout.prop(of, name)
        layout.operator("mobil.crowd", icon="OUTLINER_OB_ARMATURE")


CLASSES = (MOBIL_MT_presets, MOBIL_OT_add_preset, MOBIL_PT_person, MOBIL_PT_muscles, MOBIL_PT_style, MOBIL_PT_crowd)
