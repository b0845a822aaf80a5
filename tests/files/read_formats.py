#!/usr/bin/env python3
"""Reads the exporters' files, without any of their code, and prints positions.

    read_formats.py joints FILE.usda|.x3d|.wrl FRAME     NAME X Y Z: each joint in the world
    read_formats.py bones  FILE.usda|.x3d|.wrl FRAME     X Y Z: each vertex of the skinned or nested surfaces
    read_formats.py muscle FILE.usda|.x3d|.wrl FRAME NAME    X Y Z: each vertex of that muscle
    read_formats.py gl     FILE.gl FRAME                 the header's numbers, then X Y Z NX NY NZ of each vertex
    read_formats.py pxr    FILE.usda FRAME               as joints, by the USD library; status 77 without it

With several frames FRAME,FRAME or several names, a line "." separates their outputs.
"""
import functools
import math
import re
import struct
import sys
import xml.etree.ElementTree as xml

# --- linear algebra: column vectors, 4x4 as lists of rows


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def moved(m, p):
    return [sum(m[i][k] * p[k] for k in range(3)) + m[i][3] for i in range(3)]


def placed(translation, w, x, y, z):
    n = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / n, x / n, y / n, z / n
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), translation[0]],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), translation[1]],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), translation[2]], [0, 0, 0, 1]]


def inverse_of_scale_and_place(m):
    """Inverts a matrix of rows (s 0 0 0) … (x y z 1), as USD writes it, into column-vector form."""
    return [[1 / m[i][i] if i == j else 0 for j in range(3)] + [-m[3][i] / m[i][i]] for i in range(3)] + [[0, 0, 0, 1]]


def threes(values):
    return [values[i:i + 3] for i in range(0, len(values), 3)]


# --- USD


class Prim:
    def __init__(self, kind, name, metadata):
        self.kind, self.name, self.metadata, self.children, self.value = kind, name, metadata, [], {}

    def all(self):
        yield self
        for child in self.children:
            yield from child.all()


@functools.cache
def read_usda(path):
    """Reads prims with their attributes, as far as the exporter uses the format."""
    lines = open(path, encoding='utf-8').read().split('\n')
    assert lines[0] == '#usda 1.0'
    header = '\n'.join(lines[:lines.index(')') + 1])
    for needed in ('upAxis = "Y"', 'metersPerUnit = 1', 'defaultPrim = "walk"'):
        assert needed in header, needed
    top, stack, samples = Prim('', '', ''), [], None
    stack.append(top)
    for line in lines[lines.index(')') + 1:]:
        line = line.strip()
        begins = re.match(r'(def|class) (\w+) "(\w+)"(?: \((.*)\))?$', line)
        if samples is not None:
            if line == '}':
                samples = None
            else:
                time, value = line.rstrip(',').split(': ', 1)
                samples[int(time)] = value
        elif begins:
            made = Prim(begins[2], begins[3], begins[4] or '')
            assert made.name not in [c.name for c in stack[-1].children], made.name
            stack[-1].children.append(made)
            stack.append(made)
        elif line == '}':
            stack.pop()
        elif line.endswith('.timeSamples = {'):
            samples = stack[-1].value.setdefault(line.split(' ')[1].split('.')[0], {})
        elif ' = ' in line:
            name, value = line.split(' = ', 1)
            stack[-1].value[name.split(' ')[-1]] = value
    assert stack == [top]
    return top


def numbers(text):
    return [float(n) for n in re.findall(r'-?\d+\.?\d*(?:e-?\d+)?', text.split('] (')[0])]


def usd_people(path, frame):
    top = read_usda(path)
    shared = {}
    for scope in [c for c in top.children if c.name == 'figures']:
        for figure in scope.children:
            for cloth in figure.children:
                shared[f'</figures/{figure.name}/{cloth.name}>'] = cloth
    walk = [c for c in top.children if c.name == 'walk'][0]
    for person in walk.children:
        body = [c for c in person.children if c.kind == 'SkelRoot'][0]
        skeleton = [c for c in body.children if c.kind == 'Skeleton'][0]
        animation = [c for c in body.children if c.kind == 'SkelAnimation'][0]
        joints = re.findall('"([^"]+)"', skeleton.value['joints'])
        assert joints == re.findall('"([^"]+)"', animation.value['joints'])
        place = threes(numbers(animation.value['translations'][frame]))
        turn = numbers(animation.value['rotations'][frame])
        world = {}
        for i, joint in enumerate(joints):
            own = placed(place[i], *turn[4 * i:4 * i + 4])
            above = joint.rpartition('/')[0]
            world[joint] = times(world[above], own) if above else own
        bind = numbers(skeleton.value['bindTransforms'])
        skinning = []
        for i, joint in enumerate(joints):
            rows = [bind[16 * i + 4 * r:16 * i + 4 * r + 4] for r in range(4)]
            skinning.append(times(world[joint], inverse_of_scale_and_place(rows)))
        meshes = []
        for mesh in [c for c in body.children if c.kind == 'Mesh']:
            reference = re.search('references = (<[^>]+>)', mesh.metadata)
            meshes.append({**(shared[reference[1]].value if reference else {}), **mesh.value})
        yield person, joints, world, skinning, meshes


def usd_joints(path, frame):
    for person, joints, world, _, _ in usd_people(path, frame):
        for joint in joints:
            yield joint.split('/')[-1], [world[joint][i][3] for i in range(3)]


def usd_bones(path, frame):
    for _, _, _, skinning, meshes in usd_people(path, frame):
        for mesh in meshes:
            joint = [int(n) for n in numbers(mesh['primvars:skel:jointIndices'])]
            weight = numbers(mesh['primvars:skel:jointWeights'])
            points = threes(numbers(mesh['points']))
            each = len(joint) // len(points)  # joints of a point
            assert len(joint) == len(weight) == each * len(points) and len(points) == len(numbers(mesh['primvars:st'])) // 2 == len(numbers(mesh['normals'])) // 3
            assert len(numbers(mesh['faceVertexIndices'])) == 3 * len(numbers(mesh['faceVertexCounts']))
            for v, p in enumerate(points):
                share = weight[each * v:each * v + each]
                assert abs(sum(share) - 1) < 1e-3
                ends = [moved(skinning[j], p) for j in joint[each * v:each * v + each]]
                yield [sum(w * end[i] for w, end in zip(share, ends)) for i in range(3)]


def usd_muscle(path, frame, name):
    for prim in read_usda(path).all():
        if prim.kind == 'Mesh' and prim.name == name:
            assert len(numbers(prim.value['normals'][frame])) == len(numbers(prim.value['points'][frame]))
            vertices = len(numbers(prim.value['points'][frame])) // 3
            if 'primvars:tissue' in prim.value:
                assert len(numbers(prim.value['primvars:tissue'])) == 4 * vertices
                assert len(numbers(prim.value['primvars:displayColor'])) == 3 * vertices
                assert all(0 <= share <= 1 for share in numbers(prim.value['primvars:tissue']))
            yield from threes(numbers(prim.value['points'][frame]))


# --- X3D and VRML: the same tree of nodes (type, name, fields, children), and routes


class Node:
    def __init__(self, kind, name=''):
        self.kind, self.name, self.field, self.children = kind, name, {}, []

    def all(self):
        yield self
        for child in self.children:
            yield from child.all()


@functools.cache
def read_x3d(path):
    document = xml.parse(path).getroot()
    assert document.attrib['profile'] == 'Immersive'
    routes = []

    def node_of(element):
        node = Node(element.tag, element.attrib.get('DEF', ''))
        node.field = {k: v for k, v in element.attrib.items() if k != 'DEF'}
        node.children = [node_of(child) for child in element if child.tag != 'ROUTE']
        return node

    for r in document.iter('ROUTE'):
        routes.append((r.attrib['fromNode'], r.attrib['fromField'], r.attrib['toNode'], r.attrib['toField']))
    return node_of(document.find('Scene')), routes


@functools.cache
def read_wrl(path):
    text = open(path, encoding='utf-8').read()
    assert text.startswith('#VRML V2.0 utf8\n')
    token = re.findall(r'"[^"]*"|[\[\]{}]|[^\s\[\]{},]+', text[len('#VRML V2.0 utf8\n'):])
    at, routes = 0, []

    def node():
        nonlocal at
        name = ''
        if token[at] == 'DEF':
            name, at = token[at + 1], at + 2
        made, at = Node(token[at], name), at + 2
        assert token[at - 1] == '{', token[at - 2:at]
        while token[at] != '}':
            field, at = token[at], at + 1
            if field == 'children':
                assert token[at] == '['
                at += 1
                while token[at] != ']':
                    made.children.append(node())
                at += 1
            elif token[at] == '[':
                end = token.index(']', at)
                made.field[field], at = ' '.join(token[at + 1:end]), end + 1
            elif token[at] == 'DEF' or token[at + 1] == '{':
                made.children.append(node())
            else:
                first = at
                while re.fullmatch(r'-?[\d.]+|TRUE|FALSE|".*"', token[at]):
                    at += 1
                made.field[field] = ' '.join(token[first:at])
        at += 1
        return made

    scene = Node('Scene')
    while at < len(token):
        if token[at] == 'ROUTE':
            routes.append((*token[at + 1].split('.'), *token[at + 3].split('.')))
            at += 4
        else:
            scene.children.append(node())
    return scene, routes


def scene_at(path, frame):
    """Returns the scene with each interpolator's value of that frame inserted."""
    scene, routes = read_wrl(path) if path.endswith('.wrl') else read_x3d(path)
    by_name = {}
    for node in scene.all():
        if node.name:
            assert node.name not in by_name, f'{node.name} twice'
            by_name[node.name] = node
    clocks = [n.name for n in scene.all() if n.kind == 'TimeSensor']
    driven = {b for a, out, b, into in routes if a in clocks and (out, into) == ('fraction_changed', 'set_fraction')}
    for source, out, target, into in routes:
        if source in clocks:
            continue
        interpolator = by_name[source]
        assert out == 'value_changed' and source in driven and into.startswith('set_')
        width = {'PositionInterpolator': 3, 'OrientationInterpolator': 4}.get(interpolator.kind)
        value, keys = interpolator.field['keyValue'].split(), len(interpolator.field['key'].split())
        width = width or len(value) // keys
        assert len(value) == width * keys
        by_name[target].field[into[4:]] = ' '.join(value[width * frame:width * (frame + 1)])
    return scene


def walk_scene(path, frame):
    def visit(node, above):
        world = above
        if node.kind == 'Transform':
            t = [float(n) for n in node.field.get('translation', '0 0 0').split()]
            x, y, z, angle = [float(n) for n in node.field.get('rotation', '0 0 1 0').split()]
            s = math.sin(angle / 2)
            world = times(above, placed(t, math.cos(angle / 2), x * s, y * s, z * s))
        yield node, world
        for child in node.children:
            yield from visit(child, world)

    yield from visit(scene_at(path, frame), placed([0, 0, 0], 1, 0, 0, 0))


def points_of(node, world):
    for shape in node.all():
        if shape.kind == 'Coordinate':
            for p in threes([float(n) for n in shape.field['point'].split()]):
                yield moved(world, p)


def scene_joints(path, frame):
    for node, world in walk_scene(path, frame):
        if node.kind == 'Transform':
            yield node.name, [world[i][3] for i in range(3)]


def scene_bones(path, frame):
    for node, world in walk_scene(path, frame):
        if node.kind == 'Coordinate' and not node.name:
            yield from points_of(node, world)


def scene_muscle(path, frame, name):
    for node, world in walk_scene(path, frame):
        if node.kind == 'Transform' and node.name == name:
            yield from points_of(node, world)


# --- GL


def read_gl(path, frame):
    data = open(path, 'rb').read()
    assert data[:8] == b'MOBILGL1'
    frames, parts, vertices, indices = struct.unpack_from('<4I', data, 8)
    frame_s, = struct.unpack_from('<f', data, 24)
    yield [frames, parts, vertices, indices, frame_s]
    at = 28
    for _ in range(parts):
        name, first, count, first_index, index_count, *colour = struct.unpack_from('<64s4I3f', data, at)
        at += 92
        assert first + count <= vertices and first_index + index_count <= indices and max(colour) <= 1
        assert name.rstrip(b'\0').decode()
    index = struct.unpack_from(f'<{indices}I', data, at)
    assert max(index) < vertices
    at += 4 * indices
    assert len(data) == at + 24 * vertices * frames
    at += 24 * vertices * frame
    for v in range(vertices):
        yield list(struct.unpack_from('<6f', data, at + 24 * v))


def pxr_joints(path, frame):
    try:
        from pxr import Usd, UsdGeom, UsdSkel
    except ImportError:
        print('python has no pxr')
        sys.exit(77)
    stage = Usd.Stage.Open(path)
    assert UsdGeom.GetStageUpAxis(stage) == 'Y' and UsdGeom.GetStageMetersPerUnit(stage) == 1
    cache = UsdSkel.Cache()
    for prim in stage.Traverse():
        if not prim.IsA(UsdSkel.Root):
            continue
        root = UsdSkel.Root(prim)
        cache.Populate(root, Usd.TraverseInstanceProxies())
        bindings = cache.ComputeSkelBindings(root, Usd.TraverseInstanceProxies())
        assert bindings
        query = cache.GetSkelQuery(bindings[0].GetSkeleton())
        for joint, m in zip(query.GetJointOrder(), query.ComputeJointSkelTransforms(Usd.TimeCode(frame))):
            yield str(joint).split('/')[-1], list(m.ExtractTranslation())


def main():
    what, path, frames, *names = sys.argv[1:]
    kind = 'usd' if path.endswith('.usda') else 'scene'
    read = {'gl': read_gl, 'pxr': pxr_joints}.get(what) or globals()[f'{kind}_{what}']
    for i, asked in enumerate([(int(f), *n) for f in frames.split(',') for n in [[n] for n in names] or [[]]]):
        print(end='.\n' if i > 0 else '')
        for line in read(path, *asked):
            print(*(line if isinstance(line, list) else [line[0], *line[1]]))


main()
