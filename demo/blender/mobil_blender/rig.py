"""The armature of a person, and its action."""

from __future__ import annotations

from typing import Iterable

import bpy
import numpy as np
from mathutils import Vector

from . import axes
from .library import PARENTS, SEGMENTS, Body
from .recording import Way

ROOT = "root"


def build_armature(armature: bpy.types.Armature, body: Body) -> None:
    """Makes or moves the bones: `root` on the ground, with the axes of the armature, and one for each segment."""
    holder = bpy.data.objects.new("mobil_edit", armature)
    scene, layer = bpy.context.scene, bpy.context.view_layer
    before = layer.objects.active
    scene.collection.objects.link(holder)  # the context's collection can be hidden
    try:
        layer.objects.active = holder
        bpy.ops.object.mode_set(mode="EDIT")
        _edit(armature.edit_bones, body)
        bpy.ops.object.mode_set(mode="OBJECT")
    finally:
        bpy.data.objects.remove(holder)
        layer.objects.active = before


def _edit(bones: bpy.types.ArmatureEditBones, body: Body) -> None:
    def bone(name: str) -> bpy.types.EditBone:
        return bones.get(name) or bones.new(name)

    root = bone(ROOT)
    root.head, root.tail, root.roll = (0, 0, 0), (0, 0.2, 0), 0
    made = [bone(name) for name in SEGMENTS]
    for one, parent, at, tip in zip(made, PARENTS, body.joints, body.tips):
        tip = tip if np.linalg.norm(tip) > 0.005 else np.array((0.0, 0.0, 0.02))
        one.use_connect = False
        one.parent = root if made[parent] is one else made[parent]
        one.head, one.tail = at, at + tip
        ahead = abs(tip[1]) > 0.7 * np.linalg.norm(tip)
        one.align_roll(Vector((0, 0, 1)) if ahead else Vector((0, -1, 0)))  # flexion is then about the bone's x axis


def _bases(armature: bpy.types.Armature) -> np.ndarray:
    """Returns the rest rotations of segments' bones, (48, 4)."""
    rest = [np.array(armature.bones[name].matrix_local, np.float64)[:3, :3] for name in SEGMENTS]
    return axes.of_matrices(np.array(rest))


def channels(
    armature: bpy.types.Armature, body: Body, way: Way, in_place: bool
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Returns locations (keys, 3) and rotations (keys, 4) of each bone, relative to its rest pose.

    A segment's matrix is T(place) R B, where B is the rest rotation of its bone. Relative to the parent, and with the
    rest offset d, this leaves B⁻¹ T(place − d) R B.
    """
    base = _bases(armature)
    back = axes.conjugate(base)
    location = axes.rotate(back, way.places - body.offsets)
    rotation = axes.multiply(axes.multiply(back, way.rotations), base)
    dots = np.sum(rotation[1:] * rotation[:-1], axis=-1)
    rotation[1:] *= np.cumprod(np.where(dots < 0, -1.0, 1.0), axis=0)[..., None]  # the shorter way between keys
    found = {name: (location[:, i], rotation[:, i]) for i, name in enumerate(SEGMENTS)}
    if not in_place:
        found[ROOT] = (way.root_places, axes.about_z(way.root_headings))
    return found


def write_curve(
    action: bpy.types.Action, path: str, index: int, frames: np.ndarray, values: np.ndarray, cycle: str, group: str = ""
) -> None:
    """Writes linear keys; one key for a constant. `cycle`: "" or the mode of the modifier that repeats the curve."""
    if np.ptp(values) < 1e-7:
        frames, values, cycle = frames[:1], values[:1], ""
    made = action.fcurves.new(path, index=index, action_group=group) if group else action.fcurves.new(path, index=index)
    made.keyframe_points.add(len(frames))
    made.keyframe_points.foreach_set("co", np.column_stack((frames, values)).astype(np.float32).ravel())
    linear = bpy.types.Keyframe.bl_rna.properties["interpolation"].enum_items["LINEAR"].value
    made.keyframe_points.foreach_set("interpolation", [linear] * len(frames))
    if cycle:
        repeat = made.modifiers.new("CYCLES")
        repeat.mode_before = repeat.mode_after = cycle
    made.update()


def clear(action: bpy.types.Action) -> None:
    for curve in list(action.fcurves):
        action.fcurves.remove(curve)
    for group in list(action.groups):
        action.groups.remove(group)


def new_action(owner: bpy.types.ID, name: str) -> bpy.types.Action:
    """Returns the owner's action, empty, or a new one."""
    data = owner.animation_data or owner.animation_data_create()
    if data.action is None or not data.action.get("mobil"):
        data.action = bpy.data.actions.new(name)
        data.action["mobil"] = True
    clear(data.action)
    return data.action


def set_range(action: bpy.types.Action, frames: np.ndarray, cycle: bool) -> None:
    action.use_frame_range = True
    action.frame_start, action.frame_end = float(frames[0]), float(frames[-1])
    action.use_cyclic = cycle


def pose_at_rest(rig: bpy.types.Object) -> None:
    if rig.pose is None:
        bpy.context.view_layer.update()  # new objects have no pose before
    for bone in rig.pose.bones:
        bone.rotation_mode = "QUATERNION"
        bone.location, bone.rotation_quaternion, bone.scale = (0, 0, 0), (1, 0, 0, 0), (1, 1, 1)


def animate(
    rig: bpy.types.Object, name: str, body: Body, way: Way, first: int, in_place: bool, cycle: bool
) -> bpy.types.Action:
    """Bakes the walk to the armature's action. Bones that only rotate have no keys of location."""
    pose_at_rest(rig)
    action = new_action(rig, name)
    frames = np.arange(first, first + len(way.places), dtype=np.float64)
    for bone, (location, rotation) in channels(rig.data, body, way, in_place).items():
        path = f'pose.bones["{bone}"].'
        if np.abs(location).max() > 2e-6:
            mode = "REPEAT_OFFSET" if bone == ROOT else "REPEAT"
            _write(action, path + "location", frames, location, bone, cycle, mode)
        _write(action, path + "rotation_quaternion", frames, rotation, bone, cycle, "REPEAT")
    set_range(action, frames, cycle)
    return action


def _write(
    action: bpy.types.Action, path: str, frames: np.ndarray, rows: np.ndarray, group: str, cycle: bool, mode: str
) -> None:
    columns: Iterable[np.ndarray] = rows.T
    for index, values in enumerate(columns):
        write_curve(action, path, index, frames, values, mode if cycle else "", group)
