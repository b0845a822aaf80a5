"""The Python package, compared with the C++ program. Run by ctest with the package in PYTHONPATH; argument: the mobil
program. Exit status 77, skipped, if numpy or cffi is missing."""

import csv
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

try:
    import cffi  # noqa: F401
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}; Debian has python3-numpy and python3-cffi")
    sys.exit(77)

import mobil

PROGRAM = sys.argv.pop(1)


def crowd(world, count=12, **more):
    return world.spawn(
        count,
        height_m=np.linspace(1.6, 1.9, count),
        mass_kg=70,
        speed_m_s=np.linspace(0.9, 1.6, count),
        place=np.stack([np.arange(count), np.zeros(count), np.zeros(count)], axis=1),
        **more,
    )


class Walks(unittest.TestCase):
    def test_a_walk_is_that_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(
                [PROGRAM, *"walk --height 1.8 --mass 80 --speed 1.39 --seconds 2 --set pelvis_list_deg=4".split(), "--out", folder],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            with open(pathlib.Path(folder, "motion.csv"), newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
        walk = mobil.walk(height_m=1.8, mass_kg=80, speed_m_s=1.39, seconds=2, settle_s=0)
        theirs = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
        self.assertEqual(len(rows), len(walk.time_s) - 1)  # a table's first row is after the first tick

        def compare(mine, name, within):
            np.testing.assert_allclose(mine[1:], theirs[name], rtol=0, atol=within, err_msg=name)

        compare(walk.time_s, "time_s", 1e-4)
        for joint in ("hip_flexion", "knee_flexion", "ankle_dorsiflexion", "shoulder_flexion", "elbow_flexion"):
            for side in ("right", "left"):
                compare(np.degrees(walk.joint(f"{joint}_{side}")), f"{joint}_{side}_deg", 2e-3)
        compare(walk.ground[:, 0, 1], "grf_vertical_right_n", 0.05)
        compare(walk.moment("ankle_left"), "ankle_moment_left_nm", 0.02)
        compare(walk.centre_of_mass[:, 1], "com_y_m", 1e-4)


class Worlds(unittest.TestCase):
    def test_states_come_back_to_the_bit_and_equal_worlds_have_equal_hashes(self):
        muscles = mobil.muscles(method="modal", modes=4, muscles=["hamstrings", "soleus"])
        one, other = mobil.World(), mobil.World(threads=2)
        people = crowd(one, muscles=muscles)
        crowd(other, muscles=muscles)
        one.tick(30)
        other.tick(30)
        self.assertEqual(one.hash(), other.hash())
        state, before = one.save(), one.hash()
        one.change_walk(people, speed_m_s=1.2, heading_rad=1, style={"pelvis_list_deg": 6})
        one.tick(20)
        self.assertNotEqual(one.hash(), before)
        one.restore(state)
        self.assertEqual(one.hash(), before)
        with self.assertRaises(mobil.RefusedError):
            one.restore(state[:-1])
        baked = one.bake()
        mobil.World().load_baked(baked)

    def test_rows_go_into_the_callers_array(self):
        world = mobil.World()
        people = crowd(world)
        world.tick(10)
        table = np.full((len(people), 20), 7, np.float32)
        joints = world.joints(people, out=table[:, 2:15])
        self.assertTrue(np.shares_memory(joints, table))
        np.testing.assert_array_equal(table[:, 2:15], world.joints(people))
        np.testing.assert_array_equal(table[:, :2], 7)
        np.testing.assert_array_equal(table[:, 15:], 7)
        every_second = np.zeros((2 * len(people), 48, 7), np.float32)
        world.poses(people, out=every_second[::2])
        np.testing.assert_array_equal(every_second[::2], world.poses(people))
        np.testing.assert_array_equal(every_second[1::2], 0)
        for bad in (np.zeros((12, 13)), np.zeros((13, 12), np.float32).T, np.zeros((11, 13), np.float32)):
            with self.assertRaises(ValueError):
                world.joints(people, out=bad)

    def test_forms_and_instants_of_poses(self):
        world = mobil.World()
        people = crowd(world)
        world.tick(10)
        plain, matrix = world.poses(people), world.poses(people, form="matrix")
        self.assertEqual(matrix.shape, (12, 48, 3, 4))
        np.testing.assert_allclose(matrix[..., 3], plain[..., :3], atol=1e-6)
        np.testing.assert_allclose(matrix[..., :3] @ matrix[..., :3].swapaxes(-1, -2), np.broadcast_to(np.eye(3), (12, 48, 3, 3)), atol=1e-5)
        later = world.poses(people, ahead_s=world.tick_s, segments=["head", "foot_left"])
        world.tick()
        head = mobil.SEGMENTS.index("head")
        np.testing.assert_allclose(later[:, 0], world.poses(people)[:, head], atol=1e-4)

    def test_refusals_are_exceptions_of_one_line(self):
        world = mobil.World()
        people = crowd(world)
        before = world.hash()
        for kind, refused in (
            (mobil.RefusedError, lambda: world.spawn(mass_kg=31, height_m=2.1)),
            (mobil.RefusedError, lambda: world.change_walk(people, speed_m_s=90)),
            (mobil.MissingError, lambda: world.moments(people)),
            (mobil.MissingError, lambda: world.muscle_rows("line", people, "soleus")),
            (ValueError, lambda: world.muscle_rows("line", people, "biceps")),
            (ValueError, lambda: world.spawn(constitution="round")),
            (TypeError, lambda: mobil.muscles(methods="explicit_central")),
            (TypeError, lambda: world.joints(np.arange(3))),
            (ValueError, lambda: mobil.World(axes="sideways")),
            (mobil.RefusedError, lambda: mobil.World(tick_s=0)),
        ):
            with self.assertRaises(kind) as caught:
                refused()
            self.assertNotIn("\n", str(caught.exception))
            self.assertEqual(world.hash(), before)
        gone = people[3:4].copy()
        world.despawn(gone)
        with self.assertRaises(mobil.StaleError):
            world.joints(gone)
        self.assertEqual(len(world.people), 11)

    def test_events_say_when_and_where_feet_strike(self):
        world = mobil.World(axes="unity")
        people = world.spawn(3, place=[[i, 0, 0] for i in range(3)], speed_m_s=1.4)
        world.tick(10)
        self.assertEqual(len(world.events()), 0)
        world.enable(people, "step_events")
        told = []
        for _ in range(120):
            world.tick()
            told += list(world.events())
        strikes = [e for e in told if mobil.EVENTS[e["kind"]] == "heel_strike"]
        first = [e for e in strikes if e["person"]["index"] == people[1]["index"]]
        self.assertGreaterEqual(len(first), 3)
        times = [(e["tick"] - 1 + float(e["part"])) * world.tick_s for e in first]
        request = world.walk(people[1])
        np.testing.assert_allclose(np.diff(times), request["step_length_m"] / request["speed_m_s"], atol=2e-6)
        places = np.array([e["place"] for e in first])
        np.testing.assert_allclose(np.diff(places[:, 2]), request["step_length_m"], atol=1e-4)
        self.assertEqual({e["side"] for e in first}, {0, 1})
        for e in first:  # x is to the right
            self.assertEqual(float(e["place"][0]) > 1, e["side"] == 0)
        world.enable(people, "step_events", on=False)
        world.tick(60)
        self.assertEqual(len(world.events()), 0)

    def test_root_motion_adds_up(self):
        world = mobil.World(axes="z_up", units_per_m=100)
        people = crowd(world)
        roots = world.roots(people)
        first = roots.copy()
        ahead = np.zeros(len(people))
        for _ in range(60):
            world.tick()
            ahead += world.root_motion(people, roots)[:, 0]
        np.testing.assert_allclose(np.linalg.norm(roots["place"] - first["place"], axis=1), ahead, atol=1e-2)
        np.testing.assert_array_equal(world.roots(people)["place"], roots["place"])
        with self.assertRaises(ValueError):
            world.root_motion(people, roots[:1])

    def test_walks_are_read_back_and_changed_in_part(self):
        world = mobil.World()
        people = world.spawn(2, speed_m_s=1.2, style={"toe_out_deg": 12})
        world.change_walk(people, heading_rad=0.5)
        before = world.walk(people[0])
        world.change_walk(people[0], speed_m_s=1.5)
        after = world.walk(people[0])
        self.assertAlmostEqual(after["speed_m_s"], 1.5)
        self.assertEqual((after["heading_rad"], after["style"]), (0.5, before["style"]))
        self.assertAlmostEqual(after["style"]["toe_out_deg"], 12)
        world.change_walk(people[0], **after)
        self.assertEqual(world.walk(people[0]), after)
        far, broken = {"step_asymmetry": -0.4}, []
        odd = world.spawn(height_m=1.278257, mass_kg=35.655258, speed_m_s=1.223403, style=far)
        for ticks, heading in ((43, 2.27692), (157, 1.99182), (51, -1.26278), (109, 0)):
            broken += [line for _ in range(ticks) for line in world.tick() or world.limit_violations(odd)]
            world.change_walk(odd, heading_rad=heading)
        self.assertTrue(all("the limit is" in line for line in broken) and broken and world.people_beyond_limits == 0)

    def test_many_are_placed_or_nobody(self):
        world = mobil.World()
        people = world.spawn(3)
        world.place(people, [[1, 0, 2], [3, 0, 4], [5, 0, 6]], [0, 1, 2])
        np.testing.assert_allclose(world.roots(people)["heading_rad"], [0, 1, 2], atol=1e-3)
        before = world.hash()
        with self.assertRaises(mobil.RefusedError):
            world.place(people, [[1, 0, 2], [3, 0, 4], [np.inf, 0, 6]], 0)
        self.assertEqual(world.hash(), before)
        world.shift_origin([64, 0, 0])
        self.assertLess(world.roots(people)["place"][0, 0], -60)

    def test_who_avoids_others_does_not_walk_through_them(self):
        def nearest(avoids):
            world = mobil.World()
            people = world.spawn(speed_m_s=1.3, place=[[0, 0, 0], [0.05, 0, 7]], heading_rad=[0, np.pi])
            avoidance = world.avoidance
            avoidance.set_options(overlap_m=0.02)
            if avoids:
                avoidance.manage(people)
                avoidance.set_desired_velocity(people, 1.3, [0, np.pi])
            avoidance.set_walls([[[-2, 0, -9], [-2, 0, 20]]])
            avoidance.set_discs([[0, 0, 12]], 0.3)
            apart = np.inf
            for _ in range(300):
                world.advance(world.tick_s)
                self.assertEqual(avoidance.report.people, 2 if avoids else 0)
                place = world.roots(people)["place"]
                apart = min(apart, float(np.hypot(*(place[1] - place[0])[[0, 2]])))
            if avoids:
                avoidance.release(people)
                with self.assertRaises(mobil.MissingError):
                    avoidance.release(people)
            return apart

        self.assertLess(nearest(False), 0.2)
        self.assertGreater(nearest(True), 0.4)

    def test_obstacles_of_other_floors_do_not_stop_walkers(self):
        def goes_past(heights):
            world = mobil.World()
            person = world.spawn(speed_m_s=1.3)
            world.avoidance.manage(person)
            world.avoidance.set_walls([[[-9, 0, 2], [9, 0, 2]]], heights=heights)
            world.avoidance.set_discs([0, 0, 2], 0.5, heights=heights)
            world.tick(300)
            return world.roots(person)["place"][0, 2] > 4

        self.assertFalse(goes_past(None))
        self.assertFalse(goes_past([0, 3]))
        self.assertTrue(goes_past([2.5, 4]))
        self.assertTrue(goes_past([[-np.inf, 0]]))
        with self.assertRaisesRegex(mobil.Error, "top must be above"):
            goes_past([3, 2])
        with self.assertRaisesRegex(mobil.Error, "heights"):
            goes_past([[1, 2], [3, 4]])

    def test_walkers_stand_on_the_ground_that_python_tells_of(self):
        world = mobil.World(axes="unreal", units_per_m=100)
        people = crowd(world, 4)
        slope = 0.1
        terrain = world.terrain
        terrain.manage(people)
        places, who = terrain.query()
        self.assertEqual(places.shape, (132, 3))
        self.assertEqual(set(who["index"]), set(people["index"]))
        with self.assertRaises(mobil.RefusedError):
            terrain.resolve([0.0])
        terrain.set_heights(lambda at: (slope * at[:, 0], [-slope, 0, 1]))
        for _ in range(50):
            world.tick(4)
            self.assertEqual((terrain.report.people, terrain.report.unusable), (4, 0))
        soles, _ = world.feet(people)
        over = soles[..., 2] - slope * soles[..., 0]  # (n, points, sides)
        self.assertGreater(over.min(), -0.5)  # cm
        self.assertLess(over.min(axis=(1, 2)).max(), 0.5)
        terrain.release(people)

    def test_walkers_slow_down_uphill_where_they_are_asked_to(self):
        def speed_after(slows_down):
            world = mobil.World()
            people = crowd(world, 1)
            world.terrain.set_heights(lambda at: (0.2 * at[:, 2], [0, 1, -0.2]))
            world.terrain.set_speed_scaling(slows_down)
            world.terrain.manage(people)
            world.tick(240)
            return world.walk(people[0])["speed_m_s"]

        self.assertLess(speed_after(True), 0.7 * speed_after(False))

    def test_what_the_ground_raises_comes_out_of_advance(self):
        world = mobil.World()
        people = crowd(world, 2)
        world.terrain.manage(people)

        class Away(Exception):
            pass

        def away(_):
            raise Away

        before = world.hash()
        for heights, kind in ((away, Away), (lambda at: np.zeros(3), ValueError), (lambda at: "up", ValueError)):
            world.terrain.set_heights(heights)
            for go_on in (world.tick, lambda: world.advance(0.1)):
                with self.assertRaises(kind):
                    go_on()
                self.assertEqual(world.hash(), before)
        world.terrain.set_heights(lambda at: np.zeros(len(at)))
        world.tick(30)
        self.assertGreater(world.terrain.report.places, 0)
        self.assertEqual(world.time_s, 30 * world.tick_s)

    def test_a_frame_has_all_of_its_phases(self):
        world = mobil.World()
        people = crowd(world)
        world.lod.set_options(machine_factor=1)
        world.lod.set_scene(tolerance_m=0.001)
        world.lod.manage(people)
        world.avoidance.manage(people)
        world.terrain.set_heights(lambda at: 0.05 * np.sin(at[:, 2]))
        world.terrain.manage(people)
        looked_at = chose = places = 0
        for _ in range(40):
            self.assertIn(world.advance(0.04).count, (2, 3))
            looked_at += world.lod.report["looked_at"]
            chose += world.avoidance.report.chose
            places += world.terrain.report.places
        self.assertTrue(looked_at and chose and places)
        self.assertLessEqual({"level of detail", "avoidance", "ground"}, {phase.name for phase in world.phases() if not phase.after})
        self.assertTrue(any(phase.after for phase in world.phases()))

    def test_states(self):
        world = mobil.World()
        people, posed = crowd(world, 4), world.spawn(1, posed=True)
        world.tick(120)
        self.assertEqual(world.set_state(people[:2], "asleep"), 2)
        self.assertEqual(world.set_state(people[2:], "compact"), 2)
        self.assertEqual([world.state(one) for one in (people[0], people[3], posed)], ["asleep", "compact", "posed"])
        self.assertEqual(world.set_state(people, "full"), 4)
        self.assertEqual(world.state(people[0]), "full")
        with self.assertRaises(ValueError):
            world.set_state(people, "tired")

    def test_deprecated_names_warn_and_do_their_work(self):
        world, other = mobil.World(), mobil.World()
        people, others = crowd(world), crowd(other)
        slope = lambda at: (0.1 * at[:, 2], [0, 1, -0.1])  # noqa: E731
        with self.assertWarns(DeprecationWarning):
            avoidance = mobil.Avoidance(world, overlap_m=0.02)
        with self.assertWarns(DeprecationWarning):
            terrain = mobil.Terrain(world, slope, slows_down=True)
        for call in (
            lambda: world.start_choosing(machine_factor=1),
            lambda: world.set_scene(tolerance_m=0.001),
            lambda: world.manage(people[:3]),
            lambda: world.set_forces(people[3:5]),
            lambda: world.set_fat_wobble(people[3:5]),
            lambda: world.watch(people),
        ):
            with self.assertWarns(DeprecationWarning):
                call()
        avoidance.manage(people)
        terrain.manage(people)
        other.lod.set_options(machine_factor=1)
        other.lod.set_scene(tolerance_m=0.001)
        other.lod.manage(others[:3])
        for feature, some in (("forces", others[3:5]), ("fat", others[3:5]), ("step_events", others)):
            other.enable(some, feature)
        other.avoidance.set_options(overlap_m=0.02)
        other.avoidance.manage(others)
        other.terrain.set_heights(slope)
        other.terrain.set_speed_scaling()
        other.terrain.manage(others)
        for _ in range(90):
            with self.assertWarns(DeprecationWarning):
                did, steered, unusable = world.choose(), avoidance.update(), terrain.update()
            self.assertEqual((steered, unusable), (other.avoidance.report, 0))
            self.assertEqual(did["looked_at"], other.lod.report["looked_at"])
            world.tick()
            other.tick()
        self.assertEqual(world.hash(), other.hash())
        world = mobil.World()
        people = crowd(world)
        world.tick(120)
        with self.assertWarns(DeprecationWarning):
            self.assertEqual(world.sleep(people[8:]) + world.compact(people[6:8]), 6)
        with self.assertWarns(DeprecationWarning):
            world.wake(people)
        self.assertEqual([world.state(one) for one in people[[7, 8]]], ["compact", "full"])
        with self.assertWarns(DeprecationWarning):
            world.expand(people)
        self.assertEqual(world.state(people[7]), "full")

    def test_level_of_detail_follows_the_camera(self):
        world = mobil.World()
        people = crowd(world)
        world.lod.set_options(machine_factor=1)
        world.lod.set_scene(eye=(6, 1.7, -8), gaze=(0, 0, 1), half_angle_rad=0.9)
        world.lod.manage(people)
        world.tick(40)
        self.assertGreater(world.lod.report["looked_at"], 0)
        self.assertIn(world.method(people[0], "quadriceps"), ("modal", "explicit_central", "static"))
        why = world.lod.why(people[0], "quadriceps")
        self.assertGreater(why.cost_us, 0)
        self.assertTrue(why.why)
        self.assertTrue(any(cost.entities for cost in world.cost()))

    def test_surfaces_of_the_other_handedness_are_refused(self):
        left, right = mobil.World(axes="unity"), mobil.World()
        people = [world.spawn(muscles=mobil.muscles(method="static")) for world in (left, right)]
        surfaces = mobil.Surfaces(right, people[1], detail=0.3)
        surfaces.vertices(right, people[1])
        with self.assertRaisesRegex(mobil.Error, "other handedness"):
            surfaces.vertices(left, people[0])

    def test_a_python_without_docstrings_is_refused_in_one_line(self):
        ran = subprocess.run([sys.executable, "-OO", "-c", "import mobil"], capture_output=True, text=True)
        self.assertEqual(ran.stderr.splitlines()[-1], "ImportError: mobil: python -OO removes docstrings, which cffi's "
                         "parser needs; use -O")

    def test_surfaces_are_as_tall_as_the_person(self):
        world = mobil.World()
        people = world.spawn(2, height_m=1.7, mass_kg=65, muscles=mobil.muscles(method="modal"))
        surfaces = mobil.Surfaces(world, people[0], detail=0.3)
        vertices = surfaces.vertices(world, people)
        self.assertEqual(vertices.shape, (2, surfaces.vertex_count, 6))
        self.assertAlmostEqual(float(vertices[..., 1].max()), 1.67, delta=0.06)
        self.assertLess(surfaces.triangles.max(), surfaces.vertex_count)
        self.assertIn("soleus_left", [part.name for part in surfaces.parts])
        self.assertEqual(surfaces.tissue.shape, (surfaces.vertex_count, 4))
        for part in surfaces.parts:
            tendon = surfaces.tissue[part.vertices, 2]
            self.assertEqual(tendon.max(), 0 if part.muscle is None else 255, part.name)
            if part.name == "soleus_left":
                self.assertEqual(tendon.min(), 0)
        np.testing.assert_allclose(np.linalg.norm(vertices[..., 3:], axis=-1), 1, atol=1e-3)

    def test_skin_is_as_tall_as_the_person_and_sorted_by_parts(self):
        world = mobil.World()
        people = world.spawn(2, height_m=1.7, mass_kg=65, sex="woman")
        skin = mobil.Skin(world, "woman", "far")
        vertices = skin.vertices(world, people)
        self.assertEqual(vertices.shape, (2, skin.vertex_count, 6))
        self.assertAlmostEqual(float(vertices[..., 1].max()), 1.68, delta=0.06)
        self.assertLess(skin.triangles.max(), skin.vertex_count)
        self.assertEqual(skin.parts["shoes"].stop, len(skin.triangles))
        shoes = vertices[:, skin.triangles[skin.parts["shoes"]].ravel(), 1]
        self.assertLess(float(shoes.max()), 0.35)
        flexing = skin.vertices(world, people, flexing=True)
        moved = abs(flexing - vertices)[..., :3].max()
        self.assertTrue(0.001 < moved < 0.05)
        with self.assertRaises(ValueError):
            mobil.Skin(world, "woman", "huge")

    def test_a_mesh_of_ones_own_moves_with_the_skin(self):
        world = mobil.World()
        person = world.spawn(1, posed=1)
        standing = mobil.Skin(world, "man", "far")
        rest = standing.vertices(world, person)[0, :, :3]
        right_leg = (rest[:, 0] < -0.02) & (rest[:, 0] > -0.3) & (rest[:, 1] < 0.7)
        corners = standing.triangles[right_leg[standing.triangles].all(axis=1)]
        used, triangles = np.unique(corners, return_inverse=True)
        own = mobil.CustomSkin(world, person, rest[used], triangles.reshape(-1, 3), detail="far")
        walkers = world.spawn(2)
        world.tick(30)
        vertices = own.vertices(world, walkers)
        self.assertEqual(vertices.shape, (2, own.vertex_count, 6))
        body = standing.vertices(world, walkers)[0, :, :3]
        bare = vertices[0, (vertices[0, :, 1] > 0.15) & (vertices[0, :, 1] < 0.55), :3]
        off = np.linalg.norm(bare[:, None] - body[None], axis=2).min(axis=1)
        self.assertLess(float(off.max()), 0.04)
        self.assertLess(len(own.rest), len(standing.triangles))
        with self.assertRaises(ValueError):
            mobil.CustomSkin(world, person, rest[used].ravel(), triangles)
        with self.assertRaises(mobil.RefusedError):
            mobil.CustomSkin(world, person, rest[:3], [[0, 1, 3]])

    def test_muscles_are_kept_apart_on_request(self):
        world = mobil.World()
        members = sum(
            1 << mobil.MUSCLES.index(name) for name in ("vastus_lateralis", "vastus_medialis", "rectus_femoris")
        )
        chosen = mobil.muscles(method="static", muscles=members)
        people = world.spawn(1, muscles=chosen)
        world.tick(40)
        free = mobil.Surfaces(world, people[0], muscles=members)
        apart = mobil.Surfaces(world, people[0], muscles=members, contact=True)
        moved = np.abs(apart.vertices(world, people) - free.vertices(world, people))[..., :3].max()
        self.assertTrue(1e-4 < moved < 0.05, moved)

    def test_worlds_live_side_by_side_in_threads(self):
        hashes = [0] * 4

        def run(number):
            world = mobil.World()
            crowd(world)
            world.tick(50)
            hashes[number] = world.hash()

        threads = [threading.Thread(target=run, args=(i,)) for i in range(len(hashes))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(hashes)), 1)

    def test_plots(self):
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            self.skipTest("matplotlib is not there")
        figure = mobil.plot_walk(mobil.walk(seconds=1.3, muscles=mobil.muscles()))
        angle, ground, *_, bellies, _ = figure.axes
        self.assertEqual(len(angle.lines), 3)
        self.assertEqual(len(bellies.lines), 4)
        self.assertGreater(ground.lines[0].get_ydata().max(), 9)
        with tempfile.TemporaryDirectory() as folder:
            figure.savefig(pathlib.Path(folder, "walk.svg"))


class Arrays(unittest.TestCase):
    def test_people_of_more_than_one_dimension_are_refused_everywhere(self):
        world = mobil.World()
        muscles = mobil.muscles(method="modal", activation="host")
        people = crowd(world, 6, muscles=muscles)
        posed = world.spawn(6, posed=True)
        world.tick()
        surfaces, skin = mobil.Surfaces(world, people[0], detail=0.3), mobil.Skin(world, "man", "distant")
        avoidance, terrain = world.avoidance, world.terrain
        before = world.hash()
        roots = world.roots(people)
        still = world.poses(posed)
        for shape in ((2, 3), (6, 1), (1, 6), (1, 2, 3)):
            grid, posed_grid = people.reshape(shape), posed.reshape(shape)
            for call in (
                lambda: world.poses(grid),
                lambda: world.poses(grid, segments=[]),
                lambda: world.joints(grid),
                lambda: world.feet(grid),
                lambda: world.centre_of_mass(grid),
                lambda: world.muscle_rows("line", grid, "quadriceps"),
                lambda: world.roots(grid),
                lambda: world.root_motion(grid, roots),
                lambda: world.root_motion(grid, roots.reshape(shape)),
                lambda: world.place(grid, (1, 0, 1), 0),
                lambda: world.set_poses(posed_grid, still),
                lambda: world.set_excitation(grid, "quadriceps", "right", 0.5),
                lambda: world.change_walk(grid, speed_m_s=1.2),
                lambda: world.set_muscles(grid, None),
                lambda: world.enable(grid, "fat"),
                lambda: world.set_state(grid, "asleep"),
                lambda: world.lod.manage(grid),
                lambda: world.despawn(grid),
                lambda: avoidance.manage(grid),
                lambda: avoidance.set_desired_velocity(grid, 1.0, 0.0),
                lambda: terrain.manage(grid),
                lambda: surfaces.vertices(world, grid),
                lambda: skin.vertices(world, grid),
            ):
                with self.assertRaises(ValueError) as caught:
                    call()
                self.assertRegex(str(caught.exception), "^people are arrays of one dimension.*shape")
                self.assertNotIn("\n", str(caught.exception))
        self.assertEqual(world.hash(), before)
        np.testing.assert_array_equal(world.joints(people.reshape(2, 3).ravel()), world.joints(people))

    def test_people_may_lie_anywhere_and_be_one_or_nobody(self):
        world = mobil.World()
        people = crowd(world, 6)
        world.tick(5)
        all_rows = world.joints(people)
        table = np.zeros(6, [("name", np.uint8), ("person", mobil.PERSON)])  # packed: handles are not aligned
        table["person"] = people
        for some, rows in (
            (people[::-2], all_rows[::-2]),
            (table["person"], all_rows),
            (people[3], all_rows[3:4]),
            ([people[4], people[1]], all_rows[[4, 1]]),
            (people[:0], all_rows[:0]),
        ):
            np.testing.assert_array_equal(world.joints(some), rows)
        for other in (np.arange(3), [], people.view(np.uint32), "people"):
            for call in (world.joints, world.poses, world.roots, world.lod.manage):
                with self.assertRaises(TypeError):
                    call(other)

    def test_no_segments_are_no_floats(self):
        world = mobil.World()
        people = crowd(world, 3)
        world.tick()
        for form, shape in (("quaternion", (7,)), ("matrix", (3, 4)), ("dual_quaternion", (8,))):
            self.assertEqual(world.poses(people, form=form, segments=[]).shape, (3, 0, *shape))
        room = np.zeros((3, 48, 7), np.float32)
        out = room[:, :0]
        self.assertIs(world.poses(people, segments=[], out=out), out)
        np.testing.assert_array_equal(room, 0)  # all segments would have fit

    def test_what_is_too_short_for_a_call_is_refused_before_it(self):
        world = mobil.World()
        people = crowd(world, 3, muscles=mobil.muscles(method="modal", activation="host"))
        posed = world.spawn(3, posed=True)
        world.tick()
        before = world.hash()
        roots = world.roots(people)
        skin = mobil.Skin(world, "man", "distant")
        joints = np.zeros((3, 14), np.float32)
        for call in (
            lambda: world.shift_origin([1, 2]),
            lambda: world.shift_origin([[1, 2, 3]]),
            lambda: world.shift_origin([1, 2, 3, 4]),
            lambda: world.set_poses(posed, np.zeros((2, 48, 7))),
            lambda: world.set_poses(posed, np.zeros((3, 47, 7))),
            lambda: world.set_excitation(people, "quadriceps", "right", [0.5, 0.5]),
            lambda: world.set_excitation(people, "quadriceps", "right", [[0.5], [0.5], [0.5]]),
            lambda: world.place(people, [[0, 0, 0], [1, 0, 0]], 0),
            lambda: world.root_motion(people, roots[:2]),
            lambda: world.root_motion(people, roots[::-1]),
            lambda: world.root_motion(people, list(roots)),
            lambda: world.joints(people, out=[0.0] * 39),
            lambda: world.joints(people, out=joints[:, 1:].tolist()),
            lambda: world.joints(people, out=np.zeros(3 * 52 + 1, np.uint8)[1:].view(np.float32).reshape(3, 13)),
            lambda: skin.vertices(world, people, out=np.zeros((2, skin.vertex_count, 6), np.float32)),
            lambda: skin.vertices(world, people, out=[0.0]),
        ):
            with self.assertRaises(ValueError):
                call()
        self.assertEqual(world.hash(), before)
        one_backwards = np.zeros((2, 13), np.float32)[::-1][:1]
        np.testing.assert_array_equal(world.joints(people[0], out=one_backwards), world.joints(people[0]))

    def test_bytes_may_be_an_array_of_any_shape(self):
        world = mobil.World()
        people = crowd(world, 3)
        state, before = world.save(), world.hash()
        for given in (bytearray(state), memoryview(state), np.frombuffer(state, np.uint8).reshape(1, -1)):
            world.change_walk(people, heading_rad=1.0)
            world.restore(given)
            self.assertEqual(world.hash(), before)
        mobil.World().load_baked(np.frombuffer(world.bake(), np.uint8).reshape(1, -1))


if __name__ == "__main__":
    unittest.main()
