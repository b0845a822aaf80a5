"""Values of calls of the Python package: columns, integers, numbers, switches and names, each by one rule.
Run by python_test.sh with the package in PYTHONPATH."""

import enum
import fractions
import unittest
import warnings

import numpy as np

import mobil


class Series:
    """A column of another library, as pandas' are."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.values, dtype)

    def __len__(self):
        return len(self.values)

    def __iter__(self):
        return iter(self.values)


class Side(enum.IntEnum):
    RIGHT = 0
    LEFT = 1


def layouts(values):
    """Yields the same numbers in other types and layouts."""
    plain = np.asarray(values, np.float64)
    yield list(values)
    yield tuple(values)
    yield plain
    yield plain.astype(">f4")
    yield np.repeat(plain, 2)[::2]
    yield plain[::-1].copy()[::-1]
    yield plain.astype(object)
    yield Series(plain)
    yield np.ma.array(plain)
    fixed = plain.astype(np.float32)
    fixed.flags.writeable = False
    yield fixed


class Cases(unittest.TestCase):
    def refused(self, call, *words, kind=mobil.RefusedError):
        """Checks that a call is refused in one line with these words."""
        with self.assertRaises(kind) as caught:
            call()
        line = str(caught.exception)
        self.assertNotIn("\n", line)
        for word in words:
            self.assertIn(word, line)


class Columns(Cases):
    def setUp(self):
        self.world = mobil.World()
        self.people = self.world.spawn(4, place=[[2.0 * i, 0, 0] for i in range(4)])
        self.posed = self.world.spawn(4, posed=True, muscles=mobil.muscles(method="none", activation="host", muscles="quadriceps"))
        self.world.avoidance.manage(self.people)

    def calls(self):
        """Returns calls that take one column for four people: name, a sound value, call."""
        world, people = self.world, self.people
        yield "height_m", 1.7, lambda c: world.spawn(4, height_m=c)
        yield "mass_kg", 70, lambda c: world.spawn(4, mass_kg=c)
        yield "speed_m_s", 1.2, lambda c: world.spawn(4, speed_m_s=c)
        yield "step_length_m", 0.7, lambda c: world.spawn(4, speed_m_s=1.2, step_length_m=c)
        yield "step_frequency_hz", 1.8, lambda c: world.spawn(4, step_frequency_hz=c)
        yield "heading_rad", 0.5, lambda c: world.spawn(4, heading_rad=c)
        yield "toe_out_deg", 8, lambda c: world.spawn(4, style={"toe_out_deg": c})
        yield "speed_m_s", 1.2, lambda c: world.change_walk(people, speed_m_s=c)
        yield "step_length_m", 0.7, lambda c: world.change_walk(people, step_length_m=c)
        yield "step_frequency_hz", 1.8, lambda c: world.change_walk(people, step_frequency_hz=c)
        yield "heading_rad", 0.5, lambda c: world.change_walk(people, heading_rad=c)
        yield "toe_out_deg", 8, lambda c: world.change_walk(people, style={"toe_out_deg": c})
        yield "heading_rad", 0.5, lambda c: world.place(people, [0, 0, 0], c)
        yield "excitation", 0.5, lambda c: world.set_excitation(self.posed, "quadriceps", "right", c)
        yield "speed_m_s", 1.1, lambda c: world.avoidance.set_desired_velocity(people, c, 0.0)
        yield "heading_rad", 0.5, lambda c: world.avoidance.set_desired_velocity(people, 1.1, c)

    def test_a_column_has_one_value_for_all_or_one_for_each_person(self):
        for name, value, call in self.calls():
            with self.subTest(column=name):
                call(value)
                call(np.float64(value))
                call(np.array(value))
                for column in layouts([value] * 4):
                    call(column)
                state = self.world.hash()
                for wrong in ([], [value], [value] * 3, [value] * 5, np.full((4, 1), value), np.full((1, 4), value)):
                    self.refused(lambda: call(wrong), name, "give one value for all, or 4")
                self.refused(lambda: call([value] * 3), "has 3 values")
                self.assertEqual(self.world.hash(), state)

    def test_a_column_has_real_numbers(self):
        for name, value, call in self.calls():
            with self.subTest(column=name):
                self.refused(lambda: call(np.nan), name, "nan")
                self.refused(lambda: call([value, value, np.nan, value]), f"{name}[2] is nan")
                self.refused(lambda: call([value, None, value, value]), name)
                self.refused(lambda: call(np.ma.array([value] * 4, mask=[0, 1, 0, 0])), name, "masked")
                for wrong in (str(value), [str(value)] * 4, True, [True] * 4, [value, value, value, True], 1j, {value}, {"a": value}, b"1", [[1], [1, 2]]):
                    self.refused(lambda: call(wrong), name, "give numbers", kind=TypeError)

    def test_huge_numbers_are_refused_without_a_warning(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for call in (
                lambda: self.world.spawn(height_m=1e300),
                lambda: self.world.spawn(height_m=10**400),
                lambda: self.world.change_walk(self.people, speed_m_s=[1, 1, 1, 1e39]),
            ):
                self.refused(call)

    def test_each_person_gets_the_value_of_its_own(self):
        degrees = [2.0, 6.0, 10.0, 14.0]
        for column in layouts(degrees):
            self.world.change_walk(self.people, style={"toe_out_deg": 4.0})
            self.world.change_walk(self.people, speed_m_s=[1.0, 1.1, 1.2, 1.3], style={"toe_out_deg": column})
            walks = [self.world.walk(one) for one in self.people]
            np.testing.assert_allclose([walk["style"]["toe_out_deg"] for walk in walks], degrees, atol=1e-5)
            np.testing.assert_allclose([walk["speed_m_s"] for walk in walks], [1.0, 1.1, 1.2, 1.3], atol=1e-6)
        spawned = self.world.spawn(style={"toe_out_deg": degrees, "pelvis_list_deg": 5}, height_m=[1.6, 1.7, 1.8, 1.9])
        styles = [self.world.walk(one)["style"] for one in spawned]
        np.testing.assert_allclose([style["toe_out_deg"] for style in styles], degrees, atol=1e-5)
        np.testing.assert_allclose([style["pelvis_list_deg"] for style in styles], 5, atol=1e-5)

    def test_places_are_rows_of_three(self):
        world, people = self.world, self.people
        for call in (
            lambda at: world.place(people, at, 0),
            lambda at: world.spawn(4, place=at),
            lambda at: world.spawn(4, somatotype=np.asarray(at) + 3),
        ):
            call([1, 0, 2])
            call(np.ones((4, 3), ">f8"))
            call(np.ones((3, 4)).T)
            for wrong in (1.0, np.ones(4), np.ones((1, 3)), np.ones((3, 3)), np.ones((4, 2)), np.ones((4, 3, 1))):
                self.refused(lambda: call(wrong), "has the shape", "(4, 3)")
        self.refused(lambda: world.set_poses(self.posed, np.zeros((4, 336))), "(4, 48, 7)")
        self.refused(lambda: world.avoidance.set_walls(np.zeros((2, 6))), "(n, 2, 3)")
        self.refused(lambda: world.avoidance.set_discs(np.zeros((2, 3)), [0.1] * 3), "radius has 3 values", "2")
        self.refused(lambda: world.avoidance.set_discs(np.zeros((2, 3)), 0.1, np.zeros((1, 3))), "velocity")

    def test_names_are_a_column(self):
        world = self.world
        for sexes in ("woman", ["man", "woman", "man"], np.array(["man", "woman", "man"]), Series(["man", "woman", "man"])):
            world.spawn(3, sex=sexes, constitution=["thin", "heavy", "average"])
        for sexes in (1, np.int8(1), np.array(1), [0, 1, 0], np.array([0, 1, 0]), [Side.RIGHT, 1, "man"]):
            world.spawn(3, sex=sexes)
        drawn = world.spawn(3, sex=(name for name in ["woman", "man", "woman"]))
        mobil.Skin(world, "woman", "distant").vertices(world, drawn[::2])
        world.spawn(height_m=[1.28, 1.7], mass_kg=[26, 70], age_y=[8.5, 40])
        world.spawn(2, **mobil.typical_person("woman", 8, height_z=1))
        state = world.hash()
        self.refused(lambda: mobil.typical_person("woman", 3), "6 to 95 years")
        self.refused(lambda: world.spawn(3, constitution=["thin", "heavy"]), "constitution has 2 values", "3")
        self.refused(lambda: world.spawn(3, sex=["man"]), "sex has 1 values", "3")
        self.refused(lambda: world.spawn(age_y=[30, 5]), "age", "6–95 years")
        self.refused(lambda: world.spawn(sex=["man", "woman"], constitution=["thin"]), "2 of sex", "1 of constitution")
        self.refused(lambda: world.spawn(height_m=[1.6, 1.7], mass_kg=[60, 70, 80]), "2 of height_m", "3 of mass_kg")
        self.refused(lambda: world.spawn(2, sex={"man", "woman"}), "sex", kind=TypeError)
        self.refused(lambda: world.spawn(style={"toe_out": 1}), "'toe_out'", "toe_out_deg")
        self.refused(lambda: world.spawn(style=[1, 2]), "style", kind=TypeError)
        self.refused(lambda: world.spawn(2, posed=[True, False]), "posed", kind=TypeError)
        self.assertEqual(world.hash(), state)

    def test_columns_of_nobody_are_empty_and_change_nothing(self):
        world, nobody = self.world, self.people[:0]
        state = world.hash()
        for spawned in (
            world.spawn(0),
            world.spawn(height_m=[]),
            world.spawn(0, height_m=1.7, place=np.zeros((0, 3)), sex=[], constitution=[], style={"toe_out_deg": []}),
            world.spawn(mass_kg=np.array([]), speed_m_s=[], posed=True),
        ):
            self.assertEqual((spawned.shape, spawned.dtype), ((0,), mobil.PERSON))
        self.refused(lambda: world.spawn(0, height_m=[1.7]), "height_m has 1 values")
        world.change_walk(nobody, speed_m_s=[], style={"toe_out_deg": 3})
        world.place(nobody, np.zeros((0, 3)), [])
        world.set_poses(nobody, np.zeros((0, 48, 7)))
        world.set_excitation(nobody, "quadriceps", "left", [])
        world.set_muscles(nobody, mobil.muscles())
        world.set_method(nobody, "quadriceps", mobil.method("modal"))
        world.enable(nobody, "forces")
        self.assertEqual(world.set_state(nobody, "asleep"), 0)
        world.avoidance.manage(nobody)
        world.avoidance.set_desired_velocity(nobody, [], 1.0)
        world.avoidance.release(nobody)
        world.avoidance.set_walls([])
        world.avoidance.set_discs([], [])
        world.terrain.manage(nobody)
        world.terrain.release(nobody)
        world.lod.manage(nobody)
        world.lod.release(nobody)
        world.despawn(nobody)
        self.assertEqual(world.hash(), state)
        self.assertEqual(world.poses(nobody).shape, (0, 48, 7))
        self.assertEqual(world.joints(nobody).shape, (0, 13))
        self.assertEqual(world.roots(nobody).shape, (0,))

    def test_the_ground_is_one_height_or_one_for_each_place(self):
        world = self.world
        world.terrain.manage(self.people)
        places, _ = world.terrain.query()
        self.refused(lambda: world.terrain.resolve(np.zeros((len(places), 1))), "heights")
        self.refused(lambda: world.terrain.resolve(np.zeros(len(places)), np.zeros((2, 3))), "normals")
        self.assertEqual(world.terrain.resolve(np.full(len(places), np.nan)), len(places))
        world = mobil.World()
        world.terrain.manage(world.spawn(2))
        for heights, words in (
            (lambda at: np.zeros((len(at), 1)), "heights"),
            (lambda at: np.zeros(2), "heights has 2 values"),
            (lambda at: (at[:, 0], np.zeros((1, 3))), "normals"),
            (lambda at: "up", "heights"),
            (lambda at: None, "heights"),
            (lambda at: (0.0, 0.0, 0.0), ""),
        ):
            world.terrain.set_heights(heights)
            with self.assertRaises((mobil.RefusedError, TypeError)) as caught:
                world.tick()
            self.assertIn(words, str(caught.exception))
        world.terrain.set_heights(lambda at: (0.1, [0, 1, 0]))
        world.tick()
        self.refused(lambda: world.terrain.set_heights(0.1), "heights", kind=TypeError)


class Scalars(Cases):
    def calls(self):
        """Returns calls that take an integer: its sound values, values out of range, call."""
        world = mobil.World()
        people = world.spawn(2, muscles=mobil.muscles(method="modal", activation="host"))
        world.tick()
        yield (0, 1, 3), (-1, 10**7 + 1, 2**40), lambda n: world.spawn(n)
        yield (0, 1), (-1, 2**32, 2**40), lambda n: world.tick(n)
        yield (1, 2), (-1, 2**31), lambda n: mobil.World(threads=n)
        yield (0, 4), (-1, 5, 2**40), lambda n: mobil.World(axes=n)
        yield (0, 47), (-1, 48, 2**40), lambda n: world.poses(people, segments=[n])
        yield (0, 2), (-1, 3), lambda n: world.poses(people, form=n)
        yield (0, 3), (-1, 99), lambda n: world.method(people[0], n)
        yield (0, 1), (-1, 2), lambda n: world.muscle_rows("line", people, "quadriceps", side=n)
        yield (0, 1), (-1, 2), lambda n: world.set_excitation(people, "quadriceps", n, 0.5)
        yield (0, 4), (-1, 6), lambda n: world.muscle_rows(n, people, "quadriceps")
        yield (0, 1), (-1, 2), lambda n: world.spawn(1, sex=n)
        yield (0, 3), (-1, 4), lambda n: world.spawn(1, constitution=n)
        yield (0, 2), (-1, 3), lambda n: world.enable(people, n)
        yield (0, 3), (-1, 4, 2**40), lambda n: mobil.Skin(world, "woman", n)
        yield (1,), (-1, 2, 2**40), lambda n: mobil.Skin(world, n, "distant")
        yield (1, 8, 32), (2**31, -(2**31) - 1, 2**40), lambda n: mobil.muscles(modes=n)
        yield (0, 6), (-1, 7), lambda n: mobil.muscles(method=n)
        yield (0, 2), (-1, 3), lambda n: mobil.muscles(element=n)
        yield (1, 15), (-1, 2**47), lambda n: mobil.muscles(muscles=n)
        yield (0, 3), (-1, 47), lambda n: mobil.muscles(muscles=[n])
        yield (2,), (-1, 2**32, 2**40), lambda n: mobil.muscles(cells=[2, n, 4])
        yield (0, 2), (-1, 3), lambda n: mobil.Surfaces(world, people[0], side=n, detail=0.1)

    def test_integers_are_whatever_has_an_index(self):
        for number, (sound, out, call) in enumerate(self.calls()):
            with self.subTest(call=number):
                for value in sound:
                    for same in (value, np.int64(value), np.uint8(value), np.array(value)):
                        call(same)
                for value in out:
                    self.refused(lambda: call(value), "out of range", str(value))
                for wrong in (True, np.True_, None, 1.0, np.float32(1), np.nan, "1.0", fractions.Fraction(1), [[1]], b"1", 1j):
                    if wrong is None and number == 0:
                        continue  # as many as the columns have
                    with self.assertRaises((mobil.RefusedError, TypeError)) as caught:
                        call(wrong)
                    self.assertIsInstance(caught.exception, mobil.Error)
                    self.assertNotIn("\n", str(caught.exception))

    def test_arrays_of_indices_select_segments_and_muscles(self):
        world = mobil.World()
        people = world.spawn(2)
        world.tick()
        all_of = world.poses(people)
        for chosen in (np.arange(3), np.arange(3, dtype=">i2"), range(3), list(mobil.SEGMENTS[:3]), Series([0, 1, 2])):
            np.testing.assert_array_equal(world.poses(people, segments=chosen), all_of[:, :3])
        self.refused(lambda: world.poses(people, segments="head"), "segments", kind=TypeError)
        self.refused(lambda: world.poses(people, segments=np.arange(3.0)), "segment", kind=TypeError)
        self.refused(lambda: world.poses(people, segments=[True]), "segment", kind=TypeError)
        self.assertEqual(mobil.muscles(muscles=np.array([0, 2])).muscles, 5)
        self.assertEqual(mobil.muscles(muscles={"hamstrings"}).muscles, 1)

    def test_numbers_are_real(self):
        world = mobil.World()
        people = world.spawn(2)
        for name, sound, call in (
            ("tick_s", 0.02, lambda n: mobil.World(tick_s=n)),
            ("max_frame_s", 0.5, lambda n: mobil.World(max_frame_s=n)),
            ("units_per_m", 100, lambda n: mobil.World(units_per_m=n)),
            ("seconds", 0.02, lambda n: world.advance(n)),
            ("ahead_s", 0.01, lambda n: world.poses(people, ahead_s=n)),
            ("ahead_s", 0.01, lambda n: world.roots(people, n)),
            ("within_m", 0.01, lambda n: world.set_state(people, "full", n)),
            ("young_pa", 1e5, lambda n: mobil.muscles(young_pa=n)),
            ("tolerance_m", 0.001, lambda n: world.lod.set_scene(tolerance_m=n)),
            ("radius_h", 0.1, lambda n: world.avoidance.set_options(radius_h=n)),
            ("detail", 0.5, lambda n: mobil.Surfaces(world, people[0], detail=n)),
            ("seconds", 0.02, lambda n: mobil.walk(seconds=n, settle_s=0)),
        ):
            with self.subTest(number=name):
                for same in (sound, np.float32(sound), np.array(sound), fractions.Fraction(sound)):
                    call(same)
                self.refused(lambda: call(np.nan), name, "nan")
                for wrong in ("0.02", True, [sound], np.array([sound, sound]), 1j, None if name != "max_frame_s" else "x"):
                    self.refused(lambda: call(wrong), name, kind=TypeError)
        for wrong in (-1, np.inf, 1e9):
            self.refused(lambda: mobil.walk(seconds=wrong), "seconds")

    def test_switches_are_true_or_false(self):
        world = mobil.World()
        people = world.spawn(2)
        posed = world.spawn(1, posed=True)
        for name, call in (
            ("on", lambda on: world.enable(people, "fat", on)),
            ("on", lambda on: world.terrain.set_speed_scaling(on)),
            ("to_parent", lambda on: world.poses(people, to_parent=on)),
            ("jumped", lambda on: world.set_poses(posed, world.poses(posed), jumped=on)),
            ("posed", lambda on: world.spawn(1, posed=on)),
            ("reported", lambda on: mobil.muscles(reported=on)),
            ("inertia", lambda on: mobil.muscles(inertia=on)),
            ("contact", lambda on: mobil.Surfaces(world, people[0], contact=on, detail=0.1) if on in (0, "off") else None),
        ):
            with self.subTest(switch=name):
                for on in (True, False, np.True_, 1, 0, np.int8(1), np.array(False)):
                    call(on)
                for wrong in ("off", 2 if name != "contact" else "on", -1 if name != "contact" else "on"):
                    if name == "contact" and wrong == "on":
                        continue
                    self.refused(lambda: call(wrong), name, kind=TypeError)

    def test_ticks_of_a_second_can_be_had(self):
        for tick_s in (1e-5, 0.2, 0.25, 0.5, 1.0):
            world = mobil.World(tick_s=tick_s)
            world.spawn(1)
            self.assertAlmostEqual(world.tick_s, tick_s, places=12)
            self.assertEqual(world.advance(tick_s).count, 1)
        for tick_s in (0, 0.9e-5, 1.1, -1, np.inf):
            self.refused(lambda: mobil.World(tick_s=tick_s), "choose 0.00001 to 1 s")
        self.assertEqual(mobil.World(tick_s=0.1).advance(9).count, 2)
        self.assertEqual(mobil.World(tick_s=0.1, max_frame_s=2).advance(9).count, 20)
        self.refused(lambda: mobil.World(tick_s=0.5, max_frame_s=0.4), "longest frame")
        self.assertEqual(len(mobil.walk(seconds=2, settle_s=0, tick_s=0.5).time_s), 5)

    def test_fields_that_do_not_exist_are_named(self):
        world = mobil.World()
        self.refused(lambda: mobil.muscles(modez=3), "'modez'", "modes", kind=TypeError)
        self.refused(lambda: mobil.muscles(size=3), "'size'", kind=TypeError)
        self.refused(lambda: mobil.muscles(cells=[2, 2]), "cells", "3 numbers")
        self.refused(lambda: mobil.muscles(cells=[[2], [2], [4]]), "cells", kind=TypeError)
        self.refused(lambda: mobil.muscles(cells=2), "cells", "3 numbers")
        self.refused(lambda: mobil.muscles(cells=[2.5, 2, 4]), "cells", kind=TypeError)
        self.refused(lambda: world.spawn(1, muscles="modal"), "mobil.muscles(…)", kind=TypeError)
        self.refused(lambda: world.spawn(1, muscles=mobil.method("modal")), "mobil.muscles(…)", kind=TypeError)
        self.refused(lambda: world.prepare(None), "mobil.muscles(…)", kind=TypeError)
        self.refused(lambda: world.set_method(world.spawn(1), "quadriceps", "modal"), "mobil.method(…)", kind=TypeError)
        self.refused(lambda: world.enable(world.spawn(1), "wings"), "'wings'", "forces")
        self.refused(lambda: world.joints([1, 2]), "people", kind=TypeError)
        self.refused(lambda: world.set_state(world.people, 1), "state", "asleep", kind=TypeError)
        self.refused(lambda: world.method(world.people[0], b"soleus"), "a name, or an integer from 0", kind=TypeError)
        self.refused(lambda: world.restore("abc"), "state", "give bytes", kind=TypeError)
        self.refused(lambda: world.load_baked(np.zeros(64, np.uint8)[::2]), "baked is not contiguous")


if __name__ == "__main__":
    unittest.main()
