"""Objects and long calls of the Python package: pickles and copies, pools, forks, threads and Ctrl-C.
Run by python_test.sh with the package in PYTHONPATH."""

import concurrent.futures
import copy
import multiprocessing
import os
import pickle
import queue
import signal
import threading
import time
import traceback
import unittest

import numpy as np

import mobil

PROTOCOLS = range(pickle.HIGHEST_PROTOCOL + 1)


def spawn(height_m):
    return mobil.World().spawn(height_m=height_m, mass_kg=70).size


def wrong_type(_):
    mobil.World().tick("ten")


def hash_of(state):
    world = mobil.World()
    world.restore(state)
    world.tick(5)
    return world.hash()


def muscles_of(chosen):
    world = mobil.World()
    world.spawn(1, muscles=chosen)
    world.tick(2)
    return chosen, world.hash()


def copies(value):
    """Yields copies of a value."""
    yield copy.copy(value)
    yield copy.deepcopy(value)
    for protocol in PROTOCOLS:
        yield pickle.loads(pickle.dumps(value, protocol))


def caught(call):
    try:
        call()
    except Exception as error:  # noqa: BLE001
        return error
    raise AssertionError("nothing was raised")


class Exceptions(unittest.TestCase):
    def test_exceptions_are_copied_and_pickled_as_they_were(self):
        world = mobil.World()
        person = world.spawn(1)
        gone = world.spawn(1)
        world.despawn(gone)
        raised = [
            caught(lambda: world.spawn(height_m=9)),
            caught(lambda: world.joints(gone)),
            caught(lambda: world.moments(person)),
            caught(lambda: world.tick(1.5)),
            mobil.Error(-8, "an internal error"),
            mobil.OutOfMemoryError(-6, "out of memory"),
            mobil.BusyError(-10, "busy"),
        ]
        self.assertEqual(
            {type(error) for error in raised},
            {mobil.Error, mobil.RefusedError, mobil.StaleError, mobil.MissingError, mobil.WrongTypeError}
            | {mobil.OutOfMemoryError, mobil.BusyError},
        )
        for error in raised:
            error.seen_by = "a test"
            for other in copies(error):
                self.assertIs(type(other), type(error))
                self.assertEqual((str(other), other.args, other.code), (str(error), error.args, error.code))
                self.assertEqual((repr(other), other.seen_by), (repr(error), "a test"))
        self.assertIsInstance(raised[0], ValueError)
        self.assertIsInstance(raised[3], TypeError)
        self.assertRegex(str(raised[0]), "^mobil_spawn: ")

    def test_exceptions_of_subclasses_keep_their_attributes(self):
        for other in copies(Named("a name")):
            self.assertEqual((type(other), str(other), other.code, other.name), (Named, "refused: a name", -4, "a name"))

    def test_exceptions_have_tracebacks_and_causes(self):
        try:
            try:
                spawn(9)
            except mobil.Error as error:
                raise RuntimeError("no crowd") from error
        except RuntimeError as error:
            text = "".join(traceback.format_exception(type(error), error, error.__traceback__))
        self.assertIn("in spawn", text)
        self.assertIn("mobil._library.RefusedError: mobil_spawn:", text)
        self.assertIn("direct cause", text)

    def test_the_error_of_a_worker_arrives(self):
        for method in multiprocessing.get_all_start_methods():
            with multiprocessing.get_context(method).Pool(1) as pool:
                running = pool.map_async(spawn, [1.7, 9.0])
                with self.assertRaises(mobil.RefusedError) as error:
                    running.get(60)
                self.assertIn("9 m", str(error.exception))
                with self.assertRaises(mobil.WrongTypeError):
                    pool.map_async(wrong_type, [0]).get(60)
        with concurrent.futures.ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
            with self.assertRaises(mobil.RefusedError) as error:
                pool.submit(spawn, 9.0).result(60)
            self.assertEqual(error.exception.code, -4)
            self.assertEqual(pool.submit(spawn, 1.7).result(60), 1)


class Named(mobil.RefusedError):
    def __init__(self, name):
        super().__init__(-4, f"refused: {name}")
        self.name = name


class Objects(unittest.TestCase):
    def test_values_are_copied_and_pickled(self):
        world = mobil.World()
        muscles = mobil.muscles(method="modal", modes=4, cells=[2, 2, 4], muscles=["soleus"])
        people = world.spawn(2, muscles=muscles)
        world.enable(people, "step_events")
        ticks = world.advance(0.1)
        world.lod.manage(people)
        world.tick(60)
        skin = mobil.Skin(world, "man", "distant")
        surfaces = mobil.Surfaces(world, people[0], detail=0.1)
        for value in (
            muscles,
            mobil.method("modal", modes=3),
            people,
            people[0],
            world.events(),
            world.roots(people),
            ticks,
            world.cost(),
            world.phases(),
            world.lod.why(people[0], "soleus"),
            world.lod.report,
            world.avoidance.report,
            world.terrain.report,
            world.walk(people[0]),
            mobil.STYLE,
            surfaces.parts,
            skin.parts,
            mobil.PERSON,
        ):
            for other in copies(value):
                self.assertEqual(type(other), type(value))
                self.assertTrue(np.array_equal(other, value) if isinstance(value, np.ndarray) else other == value)
        walk = mobil.walk(seconds=0.1, settle_s=0, muscles=muscles)
        for other in copies(walk):
            np.testing.assert_array_equal(other.bellies["soleus"], walk.bellies["soleus"])
        for other in copies(skin):
            np.testing.assert_array_equal(other.vertices(world, people), skin.vertices(world, people))

    def test_muscles_are_values(self):
        muscles = mobil.muscles(method="modal", modes=4)
        self.assertEqual(muscles, mobil.muscles(method="modal", modes=4))
        self.assertNotEqual(muscles, mobil.muscles(method="modal", modes=5))
        self.assertEqual((muscles.modes, mobil.names.METHODS[muscles.method], muscles.cells[2]), (4, "modal", 8))
        self.assertEqual(eval(repr(muscles)), muscles)
        other = copy.copy(muscles)
        other.modes = 7
        self.assertEqual((muscles.modes, other.modes), (4, 7))
        with self.assertRaises(mobil.WrongTypeError):
            other.modes = 7.5
        with self.assertRaises(mobil.WrongTypeError):
            other.modez = 7
        with self.assertRaises(AttributeError):
            other.modez
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            self.assertEqual(pool.apply_async(muscles_of, [muscles]).get(60), muscles_of(muscles))

    def test_whatever_owns_memory_of_the_library_says_what_to_do_instead(self):
        world = mobil.World()
        person = world.spawn(1, posed=True)
        skin = mobil.Skin(world, "man", "distant")
        leg = skin.vertices(world, person)[0, :, :3]
        right = (leg[:, 0] < -0.02) & (leg[:, 0] > -0.3) & (leg[:, 1] < 0.7)
        corners = skin.triangles[right[skin.triangles].all(axis=1)]
        used, corners = np.unique(corners, return_inverse=True)
        owners = {
            world: "restore",
            world.lod: "World",
            world.avoidance: "World",
            world.terrain: "World",
            mobil.Surfaces(world, person, detail=0.1): "each process",
            mobil.CustomSkin(world, person, leg[used], corners.reshape(-1, 3), detail="distant"): "each process",
        }
        for owner, words in owners.items():
            calls = [copy.copy, copy.deepcopy] + [lambda it, p=protocol: pickle.dumps(it, p) for protocol in PROTOCOLS]
            for call in calls:
                with self.assertRaises(TypeError) as error:
                    call(owner)
                self.assertRegex(str(error.exception), f"^a {type(owner).__name__} has memory .*{words}")
                self.assertNotIn("\n", str(error.exception))
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            with self.assertRaises(TypeError):
                pool.map(type, [world])
            world.tick(3)
            state = world.save()
            self.assertEqual(pool.apply_async(hash_of, [state]).get(60), hash_of(state))


class Sharing(unittest.TestCase):
    def test_a_second_thread_is_refused_and_nothing_breaks(self):
        world, plain = mobil.World(), mobil.World()
        for each in (world, plain):
            each.spawn(50)
        refused = queue.Queue()
        done = threading.Event()

        def intrude():
            while not done.is_set():
                try:
                    world.hash()
                    world.people
                except mobil.BusyError as error:
                    refused.put(str(error))

        thread = threading.Thread(target=intrude)
        thread.start()
        ran = 0
        while ran < 200 or refused.empty():
            try:
                world.tick(20)
                ran += 20
            except mobil.BusyError:
                pass
        done.set()
        thread.join()
        self.assertRegex(refused.get(), "another thread.*wait")
        plain.tick(ran)
        self.assertEqual(world.hash(), plain.hash())

    def test_the_function_of_heights_cannot_use_the_world(self):
        world = mobil.World()
        world.terrain.manage(world.spawn(1))
        world.terrain.set_heights(lambda at: world.time_s + world.hash())
        with self.assertRaises(mobil.BusyError):
            world.tick()

    @unittest.skipUnless(hasattr(os, "fork"), "needs fork")
    def test_a_forked_child_continues_its_copy(self):
        for threads in (1, 2):
            world = mobil.World(threads=threads)
            world.spawn(200)
            world.tick(20)
            context = multiprocessing.get_context("fork")
            answer = context.SimpleQueue()

            def child():
                world.tick(20)
                answer.put(world.hash())

            process = context.Process(target=child)
            process.start()
            process.join(60)
            self.assertEqual(process.exitcode, 0)
            world.tick(20)
            self.assertEqual(answer.get(), world.hash())


class Interruptions(unittest.TestCase):
    within_s = 0.2
    slow = 3  # times longer on a busy machine

    def interrupted(self, call, after_s=0.15):
        """Sends SIGINT during a call. Returns the time from the signal to KeyboardInterrupt."""
        sent = []

        def send():
            time.sleep(after_s)
            sent.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=send)
        thread.start()
        ended = False
        try:
            with self.assertRaises(KeyboardInterrupt):
                call()
                ended = True
                thread.join()
                time.sleep(1)
            heard = time.perf_counter()
        finally:
            thread.join()
        self.assertFalse(ended, "the call ended before the signal")
        return heard - sent[0]

    def test_long_calls_hear_ctrl_c(self):
        fine = mobil.muscles(method="modal", modal_cells=[8, 8, 32], muscles=["soleus"])
        styles = {"pelvis_tilt_deg": np.linspace(0, 12, 20000)}
        crowd, lod = mobil.World(), mobil.World()
        crowd.spawn(500)
        lod.lod.set_scene(tolerance_m=0.0005)
        sleeping = mobil.World()
        people = sleeping.spawn(2000, muscles=mobil.muscles(method="static"))
        for name, world, call in (
            ("tick", crowd, lambda w: w.tick(10**7)),
            ("advance", mobil.World(tick_s=1e-5, max_frame_s=60), lambda w: (w.spawn(500), w.advance(60))),
            ("spawn", mobil.World(), lambda w: w.spawn(20000, style=styles)),
            ("prepare", mobil.World(), lambda w: w.prepare(fine)),
            ("spawn with muscles", mobil.World(), lambda w: w.spawn(1, muscles=fine)),
            ("level of detail", lod, lambda w: w.lod.prepare()),
            ("set_muscles", sleeping, lambda w: w.set_muscles(people, mobil.muscles(method="newmark", inertia=True))),
            ("skin", mobil.World(), lambda w: mobil.Skin(w, "woman", "hero")),
        ):
            with self.subTest(call=name):
                self.assertLess(self.interrupted(lambda: call(world)), self.slow * self.within_s)
                world.tick(2)

    def test_an_interrupted_world_is_whole(self):
        world, plain = mobil.World(), mobil.World()
        for each in (world, plain):
            people = each.spawn(100, muscles=mobil.muscles(method="static"))
            each.enable(people, "forces")
        for call in (lambda: world.tick(10**7), lambda: [world.advance(0.25) for _ in range(10**7)]):
            self.interrupted(call)
            ticks = round((world.time_s - plain.time_s) / world.tick_s)
            self.assertGreater(ticks, 0)
            plain.tick(ticks)
            self.assertEqual(world.joints(people).tobytes(), plain.joints(people).tobytes())
        world.tick(20)
        plain.tick(20)
        self.assertEqual(world.hash(), plain.hash())

    def test_a_call_that_was_interrupted_changes_nobody(self):
        world = mobil.World()
        world.spawn(3)
        before = world.hash()
        self.interrupted(lambda: world.spawn(20000, style={"pelvis_tilt_deg": np.linspace(0, 12, 20000)}))
        self.assertEqual((world.hash(), len(world.people)), (before, 3))
        fine = mobil.muscles(method="modal", modal_cells=[8, 8, 32], muscles=["soleus"])
        self.interrupted(lambda: world.set_muscles(world.people, fine))
        self.assertEqual(world.hash(), before)

    def test_handlers_of_signals_run_within_a_call_and_can_end_it(self):
        class Late(Exception):
            pass

        def late(*_):
            raise Late("too late")

        heard = []
        world = mobil.World()
        world.spawn(50)
        before = {number: signal.getsignal(number) for number in (signal.SIGALRM, signal.SIGUSR1)}
        try:
            signal.signal(signal.SIGUSR1, lambda *_: heard.append(caught(world.hash)))
            signal.signal(signal.SIGALRM, late)
            threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGUSR1)).start()
            signal.setitimer(signal.ITIMER_REAL, 0.4)
            with self.assertRaises(Late):
                world.tick(10**7)
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
        self.assertEqual([type(error) for error in heard], [mobil.BusyError])
        world.tick(1)

    def test_ctrl_c_in_the_function_of_heights_ends_the_call(self):
        world = mobil.World()
        world.terrain.manage(world.spawn(20))
        world.terrain.set_heights(lambda at: np.zeros(len(at)))
        self.assertLess(self.interrupted(lambda: world.tick(10**7)), self.slow * self.within_s)
        world.tick(1)


if __name__ == "__main__":
    unittest.main()
