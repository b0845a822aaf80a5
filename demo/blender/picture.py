"""Renders a skinned person in mid-stride beside another one's muscles and bones.

demo/blender/run --picture OUT.jpg installs the add-on and runs this: blender --background --python picture.py -- OUT.jpg
"""

import math
import sys

import bpy

GROUPS = {"hamstrings", "quadriceps", "triceps_surae", "tibialis_anterior"}


def main(out: str) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="mobil_blender")
    scene = bpy.context.scene
    walk = dict(height_m=1.8, mass_kg=80, constitution="athletic", speed_m_s=1.5, root="IN_PLACE", heading_rad=-0.5)
    anatomy = dict(skin="NONE", muscles=GROUPS, contract=True, bones=True, surface_detail=1.0)
    for x, meshes in ((0.0, dict(skin="hero")), (1.15, anatomy)):
        scene.cursor.location.x = x
        bpy.ops.mobil.walk(**walk, **meshes)
    scene.frame_set(scene.frame_start + 2)

    bpy.ops.mesh.primitive_plane_add(size=200)
    floor = bpy.data.materials.new("floor")
    floor.use_nodes = True
    floor.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.35, 0.36, 0.38, 1)
    bpy.context.object.data.materials.append(floor)
    bpy.ops.object.light_add(type="SUN", rotation=(math.radians(50), math.radians(-20), math.radians(20)))
    bpy.context.object.data.energy = 2.2
    bpy.context.object.data.angle = 0.1
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.36, 0.39, 0.43, 1)
    bpy.ops.object.camera_add(location=(0.56, -5.6, 1.3), rotation=(math.radians(85.6), 0, 0))
    scene.camera = bpy.context.object
    scene.camera.data.lens = 82

    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 64, False
    scene.render.resolution_x, scene.render.resolution_y = 840, 800
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format, scene.render.image_settings.quality = "JPEG", 85
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)


main(sys.argv[sys.argv.index("--") + 1])
