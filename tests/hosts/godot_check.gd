# Runs demo/examples/godot, and prints what tests/hosts/godot_test.cpp checks. Writes picture.png beside the project.
extends Node

const FRAMES = [8, 20, 33]
const WATCHED = ["pelvis", "head", "hand_left", "foot_left", "foot_right", "toes_left", "toes_right"]
var crowd
var frame = 0
var worst_m = 0.0
var compared = 0
var start = []
var posing_us = 0


func _ready():
	var begin = OS.get_ticks_msec()
	crowd = load("res://crowd.tscn").instance()
	add_child(crowd)
	print("people ", crowd.skeletons.size(), " ms ", OS.get_ticks_msec() - begin)
	var moved = 0
	for segment in crowd.names.size():
		if crowd.skeletons[0].find_bone(crowd.names[segment]) != segment:
			moved += 1
	print("renumbered ", moved, " of ", crowd.names.size())
	var mobil = crowd.mobil
	var other = Skeleton.new()
	# Seven mistakes, each with one line of error. This node has a method of Skeleton's name.
	print("refused ", mobil.spawn(3.0, 80, false, 1.4, Vector3(), 0), " ", mobil.place(999, 0, 0.0), " ", mobil.advance(),
			" ", mobil.skin(0, 9), " ", mobil.bind(0, self), " ", mobil.bind(0, null), " ", mobil.pose(0, other, 0.0))
	other.free()


func set_bone_pose(_bone, _pose):
	pass


func at(person, name):
	var skeleton = crowd.skeletons[person]
	return skeleton.global_transform * skeleton.get_bone_global_pose(skeleton.find_bone(name)).origin


func _process(_delta):
	frame += 1
	if frame in FRAMES:  # bones and ahead_s are those of the crowd's last frame
		for person in crowd.skeletons.size():
			for name in WATCHED:
				var own = crowd.mobil.place(person, Array(crowd.names).find(name), crowd.ahead_s)
				worst_m = max(worst_m, own.distance_to(at(person, name)))
				compared += 1
	if frame == FRAMES[0]:
		var begin = OS.get_ticks_usec()
		crowd._process(0)
		posing_us = OS.get_ticks_usec() - begin
		for person in crowd.skeletons.size():
			start.append(at(person, "pelvis"))
	if frame < FRAMES[-1]:
		return
	set_process(false)
	print("bones_mm ", 1000 * worst_m, " of ", compared)
	print("posing_us ", posing_us / crowd.skeletons.size(), " a person")
	for person in crowd.skeletons.size():
		var way = at(person, "pelvis") - start[person]
		var toes = at(person, "toes_left") - at(person, "foot_left") + at(person, "toes_right") - at(person, "foot_right")
		var up = at(person, "head") - at(person, "pelvis")
		print("person ", person, " ", way.x, " ", way.z, " ", toes.z, " ", up.y)
	yield(VisualServer, "frame_post_draw")
	var picture = get_viewport().get_texture().get_data()
	picture.flip_y()
	picture.save_png("res://picture.png")
	picture.lock()
	for person in 4:  # the first row
		for name in ["T8", "toes_left", "hand_left"]:  # inside shirt, shoe, hand
			var seen = picture.get_pixelv(crowd.get_node("camera").unproject_position(at(person, name)))
			print("seen ", person, " ", name, " ", seen.r8, " ", seen.g8, " ", seen.b8)
	get_tree().quit()
