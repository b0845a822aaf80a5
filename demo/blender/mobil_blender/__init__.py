"""mobil in Blender: people who walk, as armatures with skins, muscles and actions."""

bl_info = {
    "name": "mobil",
    "description": "People who walk, from sliders for body and gait: armature, skin, muscles, action",
    "author": "The mobil authors",
    "version": (0, 3, 0),
    "blender": (3, 4, 0),
    "location": "3D view, sidebar, mobil",
    "category": "Animation",
}

import bpy

from . import debian, operators, panel, settings

_CLASSES = operators.CLASSES + panel.CLASSES


def register() -> None:
    settings.register()
    for one in _CLASSES:
        bpy.utils.register_class(one)
    debian.register()


def unregister() -> None:
    debian.unregister()
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
    settings.unregister()
