"""Run by Blender: blender -b --python read_glb.py -- FILE.glb KEYS FRAME_S. Imports a walk of one person and prints

    rest NAME X Y Z           each bone's origin in the rest pose
    bone KEY NAME X Y Z       and at each key, in the world
    outside KEY COUNT MM      vertices of bones and muscles more than 1 mm outside the skin, and the largest distance
    actions COUNT

in the file's axes (+Y up), m. A vertex is outside if rays in three directions leave the skin as often as they enter it.
"""
import sys

import numpy

if not hasattr(numpy, 'bool'):  # Debian 12: Blender 3.4.1 with numpy 1.24
    numpy.bool = bool

import bpy
from mathutils import Vector
from mathutils.bvhtree import BVHTree

DIRECTIONS = [Vector(d).normalized() for d in ((1, .013, .021), (-.9, .3, -.05), (.1, -1, .07))]


def in_file_axes(p):
    return '%.7f %.7f %.7f' % (p.x, p.z, -p.y)


def world_mesh(shown, graph):
    evaluated = shown.evaluated_get(graph)
    mesh = evaluated.to_mesh()
    place = [evaluated.matrix_world @ v.co for v in mesh.vertices]
    faces = [tuple(p.vertices) for p in mesh.polygons]
    evaluated.to_mesh_clear()
    return place, faces


def winding(tree, point, direction):
    count = 0
    at = point
    for _ in range(100):
        hit, normal, _, _ = tree.ray_cast(at, direction)
        if hit is None:
            break
        count += 1 if normal.dot(direction) > 0 else -1
        at = hit + direction * 1e-5
    return count


def outside(graph):
    skin, faces = world_mesh(bpy.data.objects['figure'], graph)
    tree = BVHTree.FromPolygons(skin, faces)
    count, largest = 0, 0.0
    for shown in bpy.data.objects:
        if shown.type != 'MESH' or shown.name == 'figure' or shown.data.users == 0:
            continue
        for point in world_mesh(shown, graph)[0][::6]:
            distance = tree.find_nearest(point)[3]
            if distance > 0.001 and not any(winding(tree, point, d) for d in DIRECTIONS):
                count, largest = count + 1, max(largest, distance)
    return count, 1000 * largest


def main():
    file, keys, frame_s = sys.argv[sys.argv.index('--') + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = 30
    bpy.ops.import_scene.gltf(filepath=file)
    walker = bpy.data.objects['walker']
    for bone in walker.data.bones:
        print('rest', bone.name, in_file_axes(bone.head_local))
    for key in range(int(keys)):
        at = key * float(frame_s) * scene.render.fps
        scene.frame_set(int(at), subframe=at - int(at))
        graph = bpy.context.evaluated_depsgraph_get()
        for bone in walker.evaluated_get(graph).pose.bones:
            print('bone', key, bone.name, in_file_axes(walker.evaluated_get(graph).matrix_world @ bone.head))
        if key % 8 == 0:
            print('outside', key, *outside(graph))
    print('actions', len(bpy.data.actions))


main()
