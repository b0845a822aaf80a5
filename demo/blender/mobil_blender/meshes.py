"""Meshes of a person: skin, muscles and bones, with vertex groups, materials and shape keys."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from . import rig, shapes
from .library import PARTS, SEGMENTS, Binding
from .recording import Mesh

# Linear colours of materials, one of each row for a look.
_COLOURS = {
    "skin": ("DEB399", "CC9E80", "9E7054", "734F3B", "E8C2AB"),
    "hair": ("211A17", "473021", "785736", "A88758", "8C8A87"),
    "shirt": ("667A8F", "BDB3A1", "73877A", "B38F6B", "80857A", "D6D4CC", "4A5769", "9E574D", "4D706B"),
    "shorts": ("384257", "615C57", "8C806B", "455E78", "2E2E30"),
    "shoes": ("292626", "574030", "D1CFC9"),
    "muscle": ("8F2B24",),
    "tendon": ("D9CCB3",),
    "bone": ("E0D6BD",),
}
_LIKE = {"legs": "skin", "lips": "skin"}


def _linear(text: str) -> tuple[float, ...]:
    shown = (int(text[i : i + 2], 16) / 255 for i in (0, 2, 4))
    return (*(x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in shown), 1.0)


def material(part: str, look: int) -> bpy.types.Material:
    """Returns the material of a part, which all people with that look share. A changed material stays as it is."""
    of = _LIKE.get(part, part)
    palette = _COLOURS[of]
    # An odd step for each part: looks then differ in more than one part.
    number = (look * (1 + 2 * list(_COLOURS).index(of))) % len(palette)
    name = f"mobil_{part}" + (f"_{number}" if number else "")
    found = bpy.data.materials.get(name)
    if found:
        return found
    made = bpy.data.materials.new(name)
    colour = _linear(palette[number])
    if part == "lips":
        colour = (0.7 * colour[0], 0.4 * colour[1], 0.4 * colour[2], 1.0)
    made.diffuse_color = colour
    made.use_nodes = True
    shader = next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = colour
    shader.inputs["Roughness"].default_value = 0.45 if of in ("muscle", "tendon", "shoes") else 0.7
    return made


def _fill(mesh: bpy.types.Mesh, positions: np.ndarray, triangles: np.ndarray) -> None:
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", positions.astype(np.float32).ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.astype(np.int32).ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(triangles), bool))


def _finish(mesh: bpy.types.Mesh) -> None:
    mesh.update(calc_edges=True)
    mesh.validate()


def _put_materials(mesh: bpy.types.Mesh, names: list[str], look: int, slots: np.ndarray) -> None:
    for name in names:
        mesh.materials.append(material(name, look))
    mesh.polygons.foreach_set("material_index", slots.astype(np.int32))


def skin_mesh(name: str, binding: Binding, look: int) -> bpy.types.Mesh:
    """Makes the skin in the anatomical position, with the library's normals, a UV map and a material for each part."""
    mesh = bpy.data.meshes.new(name)
    _fill(mesh, binding.positions, binding.triangles)
    uv = mesh.uv_layers.new(name="UVMap")
    uv.data.foreach_set("uv", binding.texture.astype(np.float32).ravel())
    _put_materials(mesh, list(PARTS), look, binding.parts)
    _finish(mesh)
    mesh.normals_split_custom_set_from_vertices(binding.normals.tolist())
    if hasattr(mesh, "use_auto_smooth"):  # until Blender 4.0
        mesh.use_auto_smooth = True
    return mesh


def weigh_skin(body: bpy.types.Object, binding: Binding) -> None:
    """Makes a vertex group for each segment with weights."""
    for number in np.unique(binding.joints[binding.weights > 0]):
        group = body.vertex_groups.new(name=SEGMENTS[number])
        vertices, slots = np.nonzero((binding.joints == number) & (binding.weights > 0))
        for vertex, weight in zip(vertices.tolist(), binding.weights[vertices, slots].tolist()):
            group.add((vertex,), weight, "REPLACE")


def surface_mesh(name: str, of: Mesh, muscles: bool) -> bpy.types.Mesh:
    """Makes muscles or bones in the anatomical position."""
    mesh = bpy.data.meshes.new(name)
    _fill(mesh, of.positions, of.triangles)
    names = ["muscle", "tendon"] if muscles else ["bone"]
    slots = np.zeros(len(of.triangles))
    for part, triangles in of.parts:
        slots[triangles] = muscles and ("tendon" in part or "ligament" in part)
    _put_materials(mesh, names, 0, slots)
    _finish(mesh)
    return mesh


def weigh_surface(body: bpy.types.Object, of: Mesh) -> None:
    """Puts each part into the vertex group of the segment that carries it. Muscles have groups by name as well."""
    for number in np.unique(of.segments):
        carried = np.nonzero(of.segments == number)[0].tolist()
        body.vertex_groups.new(name=SEGMENTS[number]).add(carried, 1.0, "REPLACE")
    for part, triangles in of.parts if of.displacements is not None else ():
        body.vertex_groups.new(name=part).add(np.unique(of.triangles[triangles]).tolist(), 1.0, "REPLACE")


def add_shape_keys(body: bpy.types.Object, name: str, of: Mesh, first: int, cycle: bool) -> shapes.Shapes:
    """Adds the recorded shapes of muscles as few keys with an action of their own."""
    made = shapes.reduce(of.displacements)
    body.shape_key_add(name="Basis", from_mix=False)
    for number, displacement in enumerate(made.keys):
        key = body.shape_key_add(name=f"muscles_{number}", from_mix=False)
        key.slider_min, key.slider_max = -1.0, 1.0
        key.data.foreach_set("co", (of.positions + displacement).astype(np.float32).ravel())
    keys = body.data.shape_keys
    action = rig.new_action(keys, f"{name}_muscles")
    frames = np.arange(first, first + len(made.values), dtype=np.float64)
    for number, values in enumerate(made.values.T):
        path = f'key_blocks["muscles_{number}"].value'
        rig.write_curve(action, path, 0, frames, np.clip(values, -1, 1), "REPEAT" if cycle else "")
    rig.set_range(action, frames, cycle)
    return made


def attach(name: str, mesh: bpy.types.Mesh, armature: bpy.types.Object, old: Any, collection: Any) -> bpy.types.Object:
    """Makes an object of a mesh that the armature moves, or gives the mesh to the old object."""
    if old is None:
        made = bpy.data.objects.new(name, mesh)
        collection.objects.link(made)
        made.parent = armature
        made.modifiers.new("mobil", "ARMATURE").object = armature
        return made
    former = old.data
    old.vertex_groups.clear()
    old.data = mesh
    drop_mesh(former)
    return old


def drop_mesh(mesh: bpy.types.Mesh) -> None:
    """Removes a mesh without other users, with the action of its shape keys."""
    if mesh.users:
        return
    keys = mesh.shape_keys
    action = keys.animation_data.action if keys and keys.animation_data else None
    bpy.data.meshes.remove(mesh)
    if action and action.users == 0:
        bpy.data.actions.remove(action)
