"""Tests of the Blender add-on. Usage: blender -b --python blender_test.py -- FOLDER, which has mobil.zip."""

import ctypes
import math
import pathlib
import sys
import time

import bpy
import numpy as np
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree

import mobil  # the Python package: another reader of the same header
from mobil._library import ffi

FOLDER = pathlib.Path(sys.argv[sys.argv.index("--") + 1])
GROUPS = {"hamstrings", "quadriceps", "triceps_surae", "tibialis_anterior"}
PEOPLE = (
    dict(height_m=1.8, mass_kg=80.0, speed_m_s=1.4),
    dict(height_m=1.62, mass_kg=70.0, sex="woman", constitution="heavy", speed_m_s=1.1, toe_out_deg=14.0),
    dict(height_m=1.95, mass_kg=90.0, constitution="athletic", speed_m_s=1.9, step_length_m=0.9),
)
tests = []


def test(of):
    tests.append(of)
    return of


def expect(holds, text):
    if not holds:
        raise AssertionError(text)


def blender_axes(rows):
    return np.stack((rows[..., 0], -rows[..., 2], rows[..., 1]), axis=-1)


def fresh():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="mobil_blender")
    bpy.context.scene.render.fps = 30


def counts():
    kinds = ("objects", "meshes", "armatures", "actions", "shape_keys", "collections")
    return {kind: len(getattr(bpy.data, kind)) for kind in kinds}


def made(**asked):
    before = set(bpy.data.objects)
    bpy.ops.mobil.walk(**asked)
    return next(one for one in bpy.data.objects if one not in before and one.type == "ARMATURE")


def part(of, name):
    return next((one for one in of.children if one.get("mobil_part") == name), None)


class Reference:
    """The same walk by the Python package."""

    def __init__(self, of, asked, muscles=None):
        self.ticks = of["mobil_ticks"]
        self.world = mobil.World(tick_s=of["mobil_tick_s"])
        names = ("height_m", "mass_kg", "sex", "constitution", "speed_m_s", "step_length_m")
        own = {name: asked[name] for name in asked if name in names}
        style = {name: asked[name] for name in asked if name in mobil.STYLE}
        self.who = self.world.spawn(1, style=style or None, muscles=muscles, **own)
        self.world.tick(of["mobil_settle"])
        self.first = self.world.roots(self.who)[0]["place"].copy()

    def step(self):
        self.world.tick(self.ticks)

    def away(self, rows):
        """Turns places of the library into the armature's, which begins at the first root."""
        return blender_axes(np.asarray(rows, np.float64) - self.first)


def evaluated(of):
    graph = bpy.context.evaluated_depsgraph_get()
    shown = of.evaluated_get(graph)
    mesh = shown.to_mesh()
    at = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", at)
    shown.to_mesh_clear()
    turn = np.array(of.matrix_world)
    return at.reshape(-1, 3) @ turn[:3, :3].T + turn[:3, 3]


@test
def structs_have_the_librarys_sizes():
    fresh()
    from mobil_blender import library

    for name, struct in library.HEADER.structs.items():
        size = ctypes.sizeof(struct)
        expect(size == ffi.sizeof(name), f"{name} has {size} bytes, not {ffi.sizeof(name)}")
        for field, _ in struct._fields_:
            expect(getattr(struct, field).offset == ffi.offsetof(name, field), f"{name}.{field} has another place")
        kind = library.C.get(f"MOBIL_{name.removeprefix('mobil_').upper()}")
        if kind is not None and struct._fields_[0][0] == "size":
            expect(library.struct(name.removeprefix("mobil_")).size == ctypes.sizeof(struct), f"{name} is refused")
    expect(len(library.HEADER.structs) >= 32, "structs are missing")
    expect(len(library.HEADER.functions) > 140, "functions are missing")
    expect([one.name for one in library.STYLE] == list(mobil.STYLE), "style")
    expect(library.MUSCLES == tuple(mobil.MUSCLES) and library.SEGMENTS == tuple(mobil.SEGMENTS), "names")


@test
def bones_skin_and_root_are_the_librarys():
    bones_mm, median_mm, far_mm, root_mm = 0.0, 0.0, 0.0, 0.0
    for asked in PEOPLE:
        fresh()
        of = made(**asked, strides=1)
        body = part(of, "skin")
        expect(tuple(of.location) == (0, 0, 0), "a new person is at the cursor")
        skin = mobil.Skin(mobil.World(), asked.get("sex", "man"), "near")
        expect(len(body.data.vertices) == skin.vertex_count, "vertices are doubled")
        _, times = np.unique(np.sort(skin.triangles, axis=1), axis=0, return_counts=True)
        expect(len(body.data.polygons) == (times == 1).sum(), "triangles are missing")  # without opposite pairs
        expect(len(body.data.materials) == 7 and len(body.data.uv_layers) == 1, "materials or UV map")
        expect(set(mobil.SEGMENTS) == set(of.data.bones.keys()) - {"root"}, "bones")
        reference = Reference(of, asked)
        first, last = (int(frame) for frame in of.animation_data.action.frame_range)
        for frame in range(first, last + 1):
            bpy.context.scene.frame_set(frame)
            poses = reference.world.poses(reference.who, form="matrix")[0]
            places = reference.away(poses[:, :, 3])
            for name, at in zip(mobil.SEGMENTS, places):
                bones_mm = max(bones_mm, 1e3 * (of.matrix_world @ of.pose.bones[name].head - Vector(at)).length)
            root = reference.world.roots(reference.who)[0]
            root_mm = max(root_mm, 1e3 * (of.pose.bones["root"].head - Vector(reference.away(root["place"]))).length)
            if (frame - first) % 4 == 0:
                own = reference.away(skin.vertices(reference.world, reference.who)[0][:, :3])
                shown = evaluated(body)
                tree = BVHTree.FromPolygons(own.tolist(), skin.triangles.tolist())
                median_mm = max(median_mm, 1e3 * float(np.median(np.linalg.norm(own - shown, axis=1))))
                far_mm = max(far_mm, 1e3 * max(tree.find_nearest(Vector(at))[3] for at in shown))
            reference.step()
    expect(bones_mm < 0.01 and root_mm < 0.01, f"bones are {bones_mm:.4f} mm off, roots {root_mm:.4f} mm")
    expect(median_mm < 1 and far_mm < 20, f"skin: median {median_mm:.2f} mm, at most {far_mm:.1f} mm")
    print(f"measured bones {bones_mm:.4f} mm, root {root_mm:.4f} mm, skin {median_mm:.2f} mm median, at most {far_mm:.1f} mm")


@test
def bones_turn_as_segments():
    fresh()
    asked = PEOPLE[0]
    of = made(**asked, length="SECONDS", seconds=0.5, skin="NONE")
    reference = Reference(of, asked)
    rest = {name: of.data.bones[name].matrix_local.to_quaternion() for name in mobil.SEGMENTS}
    worst = 0.0
    for frame in range(1, 17):
        bpy.context.scene.frame_set(frame)
        for name, row in zip(mobil.SEGMENTS, reference.world.poses(reference.who)[0]):
            turned = of.pose.bones[name].matrix.to_quaternion() @ rest[name].inverted()
            expected = np.array((row[6], row[3], -row[5], row[4]))
            worst = max(worst, 1 - abs(float(np.dot(expected, turned))))
        reference.step()
    expect(worst < 1e-6, f"rotations differ by {worst}")


@test
def cycles_close_and_go_on():
    fresh()
    of = made(**PEOPLE[0], skin="NONE", strides=2, muscles={"quadriceps"})
    for action in (of.animation_data.action, part(of, "muscles").data.shape_keys.animation_data.action):
        first, last = action.frame_range
        expect(action.use_cyclic and action.frame_start == first and action.frame_end == last, "range of the action")
        for curve in action.fcurves:
            way = '"root"' in curve.data_path and curve.data_path.endswith("location")
            gap = abs(curve.evaluate(first) - curve.evaluate(last))
            expect(way or gap < 1e-5, f"{curve.data_path} does not close by {gap}")
            begin, seam = (curve.evaluate(at + 0.5) - curve.evaluate(at) for at in (first, last))
            seam = abs(seam - begin)
            expect(seam < 1e-4, f"{curve.data_path} jumps by {seam} after the cycle")
    frames = last - first
    bpy.context.scene.frame_set(int(last + 3 * frames))
    speed = -of.pose.bones["root"].head.y / (4 * frames * of["mobil_tick_s"] * of["mobil_ticks"])
    expect(abs(speed - PEOPLE[0]["speed_m_s"]) < 1e-4, f"four cycles at {speed} m/s")


@test
def roots_turn_and_stay():
    fresh()
    asked = PEOPLE[0]
    of = made(**asked, length="SECONDS", seconds=3, turn_rad=1.2, heading_rad=0.7, skin="NONE")
    world = mobil.World(tick_s=of["mobil_tick_s"])
    who = world.spawn(1, **asked)
    world.tick(of["mobil_settle"])
    start = world.roots(who)[0]
    world.change_walk(who, heading_rad=1.2)
    for frame in range(1, 92):
        bpy.context.scene.frame_set(frame)
        root = world.roots(who)[0]
        bone = of.matrix_world @ of.pose.bones["root"].matrix
        way = blender_axes(root["place"] - start["place"])
        turned = Matrix.Rotation(0.7, 3, "Z") @ Vector(way)
        expect((bone.to_translation() - turned).length < 1e-5, f"frame {frame}: the root is elsewhere")
        turn = bone.to_euler().z - 0.7 - float(root["heading_rad"] - start["heading_rad"])
        expect(abs(math.remainder(turn, 2 * math.pi)) < 1e-5, f"frame {frame}: the root's heading differs by {turn}")
        world.tick(of["mobil_ticks"])
    expect(abs(root["heading_rad"] - 1.2) < 0.02, "the walker has not turned")
    still = made(**asked, root="IN_PLACE", skin="NONE")
    for frame in (1, 7, 30):
        bpy.context.scene.frame_set(frame)
        expect(still.pose.bones["root"].head.length < 1e-9, "in place, but the root moves")
        expect(Vector(still.pose.bones["pelvis"].head[:2]).length < 0.1, "in place, but the pelvis goes")


@test
def bones_and_skins_again_and_again():
    fresh()  # Blender's heap is jemalloc, which takes sizes of freed memory at their word
    for asked in PEOPLE[:2] * 3:
        of = made(**asked, length="SECONDS", seconds=0.3, bones=True, surface_detail=0.3)
        expect(part(of, "bones") and part(of, "skin"), "bones or skin is missing")


@test
def muscles_are_the_librarys():
    fresh()
    asked = PEOPLE[0]
    singles = {"soleus", "rectus_femoris", "sartorius", "gluteus_medius"}
    for muscles, contract in ((GROUPS, False), (singles, False), ({"triceps_surae", "gluteus_maximus"}, True)):
        grouped = dict(muscles=muscles & set(library.GROUPS), single_muscles=muscles - set(library.GROUPS))
        of = made(**asked, skin="NONE", strides=1, **grouped, contract=contract, bones=True, surface_detail=0.25)
        active = dict(activation="phase", method="modal") if contract else {}
        chosen = mobil.muscles(muscles=sorted(muscles), **active)
        reference = Reference(of, asked, chosen)
        surfaces = mobil.Surfaces(reference.world, reference.who, bones=True, muscles=sorted(muscles), detail=0.25)
        hard = np.zeros(surfaces.vertex_count, bool)
        for one in surfaces.parts:
            hard[one.vertices] = one.muscle is None
        squares, bones_mm = [], 0.0
        first, last = (int(frame) for frame in of.animation_data.action.frame_range)
        for frame in range(first, last + 1):
            bpy.context.scene.frame_set(frame)
            own = reference.away(surfaces.vertices(reference.world, reference.who)[0][:, :3])
            squares.append(((evaluated(part(of, "muscles")) - own[~hard]) ** 2).sum(axis=1))
            off = np.linalg.norm(evaluated(part(of, "bones")) - own[hard], axis=1)
            bones_mm = max(bones_mm, 1e3 * float(off.max()))
            reference.step()
        rms_mm, most_mm = 1e3 * math.sqrt(np.mean(squares)), 1e3 * math.sqrt(np.max(squares))
        keys = len(part(of, "muscles").data.shape_keys.key_blocks) - 1
        expect(rms_mm < 1 and keys <= 32, f"muscles: {rms_mm:.2f} mm rms with {keys} keys")
        expect(bones_mm < 0.05, f"bones: {bones_mm:.3f} mm")
        text = f"{keys} keys, {rms_mm:.2f} mm rms, {most_mm:.1f} mm at most; bones {bones_mm:.3f} mm"
        print(f"measured {', '.join(sorted(muscles))}: {text}")


@test
def refusals_make_nothing():
    fresh()
    of = made(**PEOPLE[0], skin="far")
    for _ in range(2):
        before, keys = counts(), len(of.animation_data.action.fcurves)
        for asked, word in (
            (dict(height_m=2.1, mass_kg=40.0), "choose a mass of"),
            (dict(speed_m_s=0.0), "strides"),
            (dict(turn_rad=1.0), "turn"),
            (dict(person="nobody"), "nobody"),
            (dict(person=of.name, height_m=2.1, mass_kg=40.0, muscles=GROUPS), "choose a mass of"),
        ):
            try:
                bpy.ops.mobil.walk(**asked)
            except RuntimeError as refused:
                expect(word in str(refused) and len(str(refused).strip().splitlines()) == 1, f"message: {refused}")
            else:
                raise AssertionError(f"{asked} was accepted")
            expect(counts() == before and len(of.animation_data.action.fcurves) == keys, f"{asked} left something")
        try:
            bpy.ops.mobil.crowd(count=500, side_m=4.0)
        except RuntimeError as refused:
            expect("choose a side" in str(refused), f"message: {refused}")
        expect(counts() == before, "a refused crowd left something")


@test
def people_are_remade_without_leftovers():
    fresh()
    of = made(**PEOPLE[0], skin="far", muscles={"soleus"}, bones=True)
    of.location = (1, 2, 0)
    of.pose.bones["head"].constraints.new("DAMPED_TRACK")
    first = counts()
    for _ in range(2):
        bpy.ops.mobil.walk(person=of.name, **PEOPLE[1], skin="far", muscles={"soleus"}, bones=True)
        expect(counts() == first, f"{first} became {counts()}")
    expect(tuple(of.location) == (1, 2, 0) and len(of.pose.bones["head"].constraints) == 1, "the artist's work is lost")
    reference = Reference(of, PEOPLE[1])
    bpy.context.scene.frame_set(1)
    at = reference.away(reference.world.poses(reference.who)[0][:, :3]) + (1, 2, 0)
    heads = [of.matrix_world @ of.pose.bones[name].head for name in mobil.SEGMENTS]
    off = max((head - Vector(row)).length for head, row in zip(heads, at))
    expect(off < 1e-5, f"remade bones are {off} m off")
    bpy.ops.mobil.walk(person=of.name, **PEOPLE[1], skin="NONE")
    left = counts()
    alone = {"objects": 1, "armatures": 1, "actions": 1, "meshes": 0, "shape_keys": 0}
    expect({kind: left[kind] for kind in alone} == alone, f"left: {left}")
    bpy.ops.mobil.read()
    read = bpy.context.scene.mobil
    expect(read.sex == "woman" and abs(read.toe_out_deg - 14) < 1e-5, "settings were not read")


@test
def crowds_share_meshes_and_keep_apart():
    fresh()
    for _ in range(2):
        bpy.ops.mobil.crowd(count=20, side_m=8.0, builds=4, seconds=2.0, skin="distant", seed=3)
        people = [one for one in bpy.data.collections["crowd"].objects if one.type == "ARMATURE"]
        expect(len(people) == 20 and len(bpy.data.objects) == 40 and len(bpy.data.actions) == 20, f"{counts()}")
        expect(len(bpy.data.meshes) <= 4 and len(bpy.data.armatures) <= 4, "meshes are not shared")
    nearest = 9.0
    for frame in range(1, 61, 10):
        bpy.context.scene.frame_set(frame)
        at = np.array([(one.matrix_world @ one.pose.bones["root"].head)[:2] for one in people])
        apart = np.linalg.norm(at[:, None] - at[None], axis=-1) + 9 * np.eye(20)
        nearest = min(nearest, float(apart.min()))
        toes = ("toes_left", "toes_right")
        feet = [min((one.matrix_world @ one.pose.bones[name].head).z for name in toes) for one in people]
        expect(0 < min(feet) and max(feet) < 0.12, "people are not on the ground")
    expect(nearest > 0.3, f"two people are {nearest:.2f} m apart")


@test
def presets_are_accepted():
    from mobil_blender import presets

    fresh()
    for name in presets.WALKS:
        bpy.ops.mobil.preset(name=name)
        asked = presets.values(name)
        values = {key: getattr(bpy.context.scene.mobil, key) for key in asked}
        expect(all(abs(values[key] - asked[key]) < 1e-4 for key in asked), f"{name} is clamped")
        bpy.ops.mobil.walk(skin="NONE", strides=1, **values)


@test
def files_pass_through_blender():
    fresh()
    of = made(**PEOPLE[0], skin="far", muscles={"quadriceps"}, strides=1)
    scene = bpy.context.scene
    frames = [int(frame) for frame in of.animation_data.action.frame_range]
    scene.frame_end, middle = frames[1], frames[0] + 10
    scene.frame_set(middle)
    names = ("root", "pelvis", "head", "hand_left", "toes_right", "patella_left")
    own = {name: of.matrix_world @ of.pose.bones[name].head for name in names}
    skin = evaluated(part(of, "skin"))
    glb, fbx, bvh = (str(FOLDER / f"walk.{kind}") for kind in ("glb", "fbx", "bvh"))
    bpy.ops.export_scene.gltf(filepath=glb, export_nla_strips=False)
    alone = dict(bake_anim_use_nla_strips=False, bake_anim_use_all_actions=False, bake_anim_simplify_factor=0.0)
    bpy.ops.export_scene.fbx(filepath=fbx, add_leaf_bones=False, **alone)
    bpy.ops.export_anim.bvh(filepath=bvh, frame_start=frames[0], frame_end=frames[1])
    for load in (
        lambda: bpy.ops.import_scene.gltf(filepath=glb),
        lambda: bpy.ops.import_scene.fbx(filepath=fbx, anim_offset=0),
        lambda: bpy.ops.import_anim.bvh(filepath=bvh, axis_forward="Y", axis_up="Z"),
    ):
        fresh()
        load()
        of = next(one for one in bpy.data.objects if one.type == "ARMATURE")
        bpy.context.scene.frame_set(middle)
        off = {name: 1e3 * (of.matrix_world @ of.pose.bones[name].head - own[name]).length for name in names}
        expect(max(off.values()) < 0.2, f"bones are off by {off} mm")
        soft = [one for one in bpy.data.objects if one.type == "MESH"]
        if not soft:
            continue  # BVH has bones alone
        body = evaluated(next(one for one in soft if "skin" in one.name))
        gap = max(np.abs(body.min(axis=0) - skin.min(axis=0)).max(), np.abs(body.max(axis=0) - skin.max(axis=0)).max())
        expect(gap < 1e-3, f"the skin is {gap} m elsewhere")
        keys = next(one.data.shape_keys for one in soft if one.data.shape_keys)
        expect(keys.animation_data is not None and keys.animation_data.action is not None, "muscles do not move")


@test
def undo_takes_a_person_back():
    fresh()
    if not bpy.ops.ed.undo_push.poll():
        print("skipped undo: this Blender has none without a window")
        return
    bpy.ops.ed.undo_push(message="empty")
    bpy.data.objects.new("earlier", None)
    bpy.ops.ed.undo_push(message="earlier")
    before = counts()
    bpy.ops.mobil.walk("EXEC_DEFAULT", True, skin="far", muscles={"soleus"})  # True: with a step of undo
    expect(counts()["objects"] == before["objects"] + 3, "nobody was made")
    bpy.ops.ed.undo()
    expect(counts() == before and "earlier" in bpy.data.objects, f"{before} became {counts()}")


@test
def unregistering_leaves_nothing():
    fresh()
    import numpy

    bpy.ops.preferences.addon_disable(module="mobil_blender")
    left = [name for name in dir(bpy.types) if "mobil" in name.lower()] + dir(bpy.ops.mobil)
    expect(not left, f"left: {left}")
    expect(not hasattr(bpy.types.Scene, "mobil") and "bool" not in vars(numpy), "properties or mended faults are left")
    bpy.ops.preferences.addon_enable(module="mobil_blender")
    bpy.ops.mobil.walk(skin="NONE")


@test
def costs_are_printed():
    fresh()
    for text, call in (
        ("a person of 2 s, near skin", lambda: bpy.ops.mobil.walk(length="SECONDS", seconds=2)),
        ("again", lambda: bpy.ops.mobil.walk(length="SECONDS", seconds=2)),
        ("with four groups of muscles", lambda: bpy.ops.mobil.walk(length="SECONDS", seconds=2, muscles=GROUPS)),
        ("a crowd of 50 for 2 s, far skins of 6 builds", lambda: bpy.ops.mobil.crowd(count=50, seconds=2, skin="far")),
    ):
        begin, busy = time.perf_counter(), time.process_time()
        call()
        print(f"measured {text}: {time.perf_counter() - begin:.2f} s, {time.process_time() - busy:.2f} s of processors")


def main():
    bpy.ops.preferences.addon_install(filepath=str(FOLDER / "mobil.zip"))
    for one in tests:
        one()
        print("ok", one.__name__, flush=True)


main()
