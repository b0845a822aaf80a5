# Walking people: a Skeleton and a skinned mesh each, which MobilCrowd makes and moves.
extends Spatial

export var people = 12
export var detail = 2  # 0 to 3: about 94000, 20000, 5700, 1300 triangles

const COLOURS = ["cf9e80", "cf9e80", "994d40", "331f12", "335080", "404047", "261a14"]  # of the skin's parts
const SHIRTS = ["335080", "8c2621", "336633", "ccccc7"]
const SHIRT = 4

var mobil = preload("res://mobil_crowd.gdns").new()
var names = mobil.names()
var parents = mobil.parents()
var skeletons = []
var ahead_s = 0.0


func _ready():
	for i in people:
		add_person(i)


func _process(delta):
	ahead_s = mobil.advance(delta)
	for person in skeletons.size():
		mobil.pose(person, skeletons[person], ahead_s)


func add_person(i):
	var height = 1.58 + 0.03 * (i % 10)
	var place = Vector3(1.2 * (i % 4) - 1.8, 0, 1.6 * (i / 4) + 0.3 * (i % 3))
	var person = mobil.spawn(height, 23 * height * height, i % 2 == 0, 1.0 + 0.05 * (i % 7), place, 0)
	if person < 0:  # the reason is printed
		return
	var skeleton = Skeleton.new()
	add_bones(skeleton, 0, mobil.rest(person))
	mobil.bind(person, skeleton)
	var body = MeshInstance.new()
	body.mesh = make_mesh(person, i)
	body.skin = make_skin(skeleton)
	skeleton.add_child(body)
	add_child(skeleton)
	skeletons.append(skeleton)


# Adds a segment's bone and all below it: depth-first, as Godot's importers number bones.
func add_bones(skeleton, segment, rest):
	skeleton.add_bone(names[segment])
	var bone = skeleton.find_bone(names[segment])
	if segment > 0:
		skeleton.set_bone_parent(bone, skeleton.find_bone(names[parents[segment]]))
	skeleton.set_bone_rest(bone, Transform(Basis(), rest[segment]))
	for child in range(segment + 1, names.size()):
		if parents[child] == segment:
			add_bones(skeleton, child, rest)


func make_mesh(person, i):
	var mesh = ArrayMesh.new()
	var surfaces = mobil.skin(person, detail)
	for part in surfaces.size():
		if surfaces[part][Mesh.ARRAY_VERTEX].size() == 0:  # lips of distant skins
			continue
		mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, surfaces[part])
		var material = SpatialMaterial.new()
		material.albedo_color = Color(SHIRTS[i % 4] if part == SHIRT else COLOURS[part])
		material.roughness = 0.8
		material.metallic_specular = 0.2
		mesh.surface_set_material(mesh.get_surface_count() - 1, material)
	return mesh


# Binds the mesh's bones, which are segments, to those of their names.
func make_skin(skeleton):
	var skin = Skin.new()
	for name in names:
		var bone = skeleton.find_bone(name)
		skin.add_bind(bone, skeleton.get_bone_global_pose(bone).affine_inverse())
	return skin
