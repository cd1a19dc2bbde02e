#!/usr/bin/python3
"""Loops, runs and controllers as a Python user handles them; what is handed over wrongly leaves everything as it was."""
import os
import signal
import subprocess
import sys
import threading
import types
import unittest

import numpy
import pandas

import fmbpc

SHORT = {"sampling.duration_h": 4}


class Loops(unittest.TestCase):
    def test_a_dict_is_a_loop_file(self):
        by_name = fmbpc.Loop("asp_case1", set=SHORT).run()
        by_dict = fmbpc.Loop({"extends": "asp_case1", "sampling": {"duration_h": 4}}).run()
        numpy.testing.assert_array_equal(by_name.inputs["q_r"], by_dict.inputs["q_r"])

    def test_set_takes_what_the_tool_takes(self):
        by_dict = fmbpc.Loop("asp_case1", set={"sampling.duration_h": 4, "setpoint.initial": numpy.array([55.0, 1900.0])})
        by_text = fmbpc.Loop("asp_case1", set=["sampling.duration_h=4", "setpoint.initial=[55, 1900]"])
        numpy.testing.assert_array_equal(by_dict.run().inputs["q_r"], by_text.run().inputs["q_r"])

    def test_errors_are_those_of_the_tool(self):
        for loop, set_, word in (("asp_cse1", None, "asp_case1"), ("asp_case1", {"sampling.duratin_h": 1}, "duratin_h"),
                                 ("asp_case1", {"controller.coincidence_steps": -1}, "coincidence_steps"), ({"plnt": {}}, None, "plnt")):
            with self.subTest(loop=loop, set=set_), self.assertRaises(fmbpc.InputError) as caught:
                fmbpc.Loop(loop, set=set_)
            self.assertIn(word, str(caught.exception))
        for loop, set_, word in ((None, None, "loop"), (3, None, "loop"), ("/bin/ls", None, "YAML"), ("asp_case1", 3, "set"), ("asp_case1", [3], "set"),
                                 ("asp_case1", "abc", "set"), ("asp_case1", ["=1"], "set")):
            with self.subTest(loop=loop, set=set_), self.assertRaisesRegex(fmbpc.InputError, word):
                fmbpc.Loop(loop, set=set_)
        self.assertTrue(issubclass(fmbpc.InputError, ValueError))
        with self.assertRaisesRegex(fmbpc.InputError, "object"):
            fmbpc.Loop({"extends": "asp_case1", "sampling": {"duration_h": object()}})

    def test_a_run_has_arrays_with_unit_and_time(self):
        run = fmbpc.Loop("asp_case1_clp", set=SHORT).run()
        x = run.outputs["x"]
        self.assertEqual(("x", "mg/l"), (x.name, x.unit))
        numpy.testing.assert_array_equal(run.time, x.time)
        self.assertIs(numpy.ndarray, type(x - run["x_setpoint"]))
        self.assertIs(numpy.float64, type(x.sum()))
        self.assertEqual(list(run.summary["inputs"]), list(run.inputs))
        self.assertTrue(run.complete and not run.interrupted)
        self.assertTrue(numpy.isnan(run.inputs["q_r"][-1]))
        with self.assertRaises(KeyError):
            run.outputs["y"]

    def test_a_frame_holds_all_columns(self):
        run = fmbpc.Loop("asp_case1", set=SHORT).run()
        frame = run.to_pandas()
        self.assertEqual(run.names[1:], list(frame.columns))
        numpy.testing.assert_array_equal(run.time, frame.index)
        self.assertEqual("mg/l", frame.attrs["units"]["x"])

    def test_progress_is_told_and_may_end_the_run_by_an_exception(self):
        def stop(share, words):
            raise ZeroDivisionError(f"at {share}")
        with self.assertRaises(ZeroDivisionError):
            fmbpc.Loop("asp_case1", set={"sampling.duration_h": 1e5}).run(progress=stop)

    def test_interrupt_ends_a_run_and_keeps_what_there_is(self):
        loop = fmbpc.Loop("asp_case1", set={"sampling.duration_h": 1e5})
        told = []

        # Who starts the tests in the background has it ignored.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))

        def interrupt(share, words):
            told.append(share)
            if len(told) == 2:
                os.kill(os.getpid(), signal.SIGINT)
        run = loop.run(progress=interrupt)
        self.assertTrue(run.interrupted)
        self.assertFalse(run.complete)
        self.assertGreater(len(run.time), 1)

    def test_a_run_leaves_other_threads_free(self):
        ticks = []

        def tick(share, words):
            ticks.append(share)
        thread = threading.Thread(target=lambda: fmbpc.Loop("asp_case1", set={"sampling.duration_h": 1e4}).run(progress=tick))
        thread.start()
        turns = 0
        while thread.is_alive():
            turns += 1
            thread.join(1e-4)
        self.assertGreater(turns, len(ticks))

    def test_nothing_prints(self):
        code = "import fmbpc; fmbpc.Loop('asp_case1', set={'sampling.duration_h': 4}).run()"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
        self.assertEqual((b"", b""), (done.stdout, done.stderr))


class Controllers(unittest.TestCase):
    def setUp(self):
        self.loop = fmbpc.Loop("asp_case1_clp")
        self.law, self.twin = self.loop.controller(), self.loop.controller()
        self.y = self.loop.simulation().outputs
        self.d = self.loop.simulation().disturbance

    def test_what_is_wrong_is_named_and_changes_nothing(self):
        good = {"y": self.y, "disturbance": self.d}
        wrong = [({"y": None}, "y"), ({"y": [50.0, numpy.nan]}, r"y\[x\]"), ({"y": [1.0]}, "y"), ({"y": ["a", "b"]}, "y"), ({"y": [1j, 1]}, "y"),
                 ({"y": {"z": 1.0}}, r"y\[z\]"), ({"y": [[50.0, 1800.0]]}, "y"), ({"setpoint": {"x": numpy.inf}}, r"setpoint\[x\]"),
                 ({"setpoint": {"x": -1e9}}, "x"), ({"setpoint": 1.0}, "setpoint"), ({"disturbance": [1.0] * 7}, "disturbance"),
                 ({"disturbance": {"q_i": None}}, r"disturbance\[q_i\]"), ({"applied": [numpy.nan]}, r"applied\[q_r\]"),
                 ({"quality": [True]}, "quality"), ({"quality": {"q": True}}, r"quality\[q\]"), ({"quality": 1}, "quality"),
                 ({"quality": numpy.ones((4, 2), dtype=bool)}, "quality"), ({"quality": [pandas.NA] * 4}, "quality"), ({"y": []}, "y"),
                 ({"y": numpy.ma.masked_array(self.y, [False, True])}, r"y\[x\]"), ({"y": pandas.Series([1.0, pandas.NA])}, "y"),
                 ({"y": b"ab"}, "y"), ({"y": [10**400, 1]}, "y"), ({"y": numpy.array([50.0, 1800.0], dtype=object)}, "y"),
                 ({"y": {1: 2.0}}, "y"), ({"y": pandas.Series({"z": 1.0})}, r"y\[z\]"), ({"y": fmbpc}, "y")]
        for k in range(5):
            for change, words in wrong:
                with self.subTest(change=change), self.assertRaisesRegex(fmbpc.InputError, words):
                    self.law.step(**{**good, **change})
            numpy.testing.assert_array_equal(self.twin.step(**good), self.law.step(**good))
        self.assertEqual(5, self.law.steps)

    def test_any_real_array_will_do(self):
        want = self.twin.step(self.y, disturbance=self.d)
        strided = numpy.zeros(4 * len(self.d))[::4]
        strided[:] = self.d
        names = [n for n, *_ in self.loop.outputs]
        for y, d in ((list(self.y), list(self.d)), (dict(zip(names, self.y)), strided), (numpy.column_stack([self.y, self.y])[:, 1], self.d[::-1][::-1]),
                     (tuple(self.y), dict(zip([n for n, *_ in self.loop.disturbances], self.d)))):
            numpy.testing.assert_array_equal(want, self.loop.controller().step(y, disturbance=d))
        whole = self.loop.controller().step(numpy.array([50, 1800]))
        for dtype in (numpy.float16, numpy.float32, numpy.longdouble, ">f8", "<i2", numpy.uint64):
            numpy.testing.assert_array_equal(whole, self.loop.controller().step(numpy.array([50, 1800], dtype=dtype)))

    def test_names_rule_where_there_are_names(self):
        want = self.twin.step(self.y, setpoint={"x": 1850.0})
        turned = pandas.Series(dict(zip(["x", "s"], self.y[::-1])))
        for y, setpoint in ((turned, pandas.Series({"x": 1850.0})), (types.MappingProxyType(dict(turned)), {"x": numpy.float32(1850.0)})):
            numpy.testing.assert_array_equal(want, self.loop.controller().step(y, setpoint=setpoint))
        numpy.testing.assert_array_equal(self.loop.controller().step(self.y), self.loop.controller().step(pandas.Series(self.y)))

    def test_a_bad_reading_is_held_or_bridged_not_refused(self):
        self.law.step(self.y, disturbance=self.d)
        sources = set()
        for _ in range(200):
            u = self.law.step([50.0, numpy.nan], quality={"x": False})
            self.assertTrue(numpy.isfinite(u).all())
            sources.add(self.law.source)
        self.assertTrue(sources & {"held", "fallback"}, sources)
        self.assertTrue(self.law.events)
        self.law.step(self.y, quality=[True] * (2 + len(self.d)))
        self.assertNotIn(self.law.source, ("held", "fallback"))

    def test_a_setpoint_holds_until_the_next_and_goes_back_to_the_schedule(self):
        self.law.step(self.y, setpoint={"x": 1850.0})
        self.law.step(self.y)
        self.assertEqual(1850.0, self.law.setpoint[1])
        self.law.release()
        self.law.step(self.y)
        for _ in range(3):
            self.twin.step(self.y)
        numpy.testing.assert_array_equal(self.twin.setpoint, self.law.setpoint)

    def test_reset_begins_anew(self):
        first = [self.law.step(self.y + k, disturbance=self.d) for k in range(10)]
        again = [self.law.reset(self.y, disturbance=self.d)] + [self.law.step(self.y + k, disturbance=self.d) for k in range(1, 10)]
        numpy.testing.assert_array_equal(first, again)
        with self.assertRaises(fmbpc.InputError):
            self.law.reset([50.0, numpy.nan])
        self.assertEqual(10, self.law.steps)

    def test_manual_and_auto_are_bumpless(self):
        u = self.law.step(self.y, disturbance=self.d)
        self.law.manual(u + 10.0)
        by_hand = self.law.step(self.y)
        self.assertEqual("manual", self.law.source)
        numpy.testing.assert_array_equal(u + 10.0, by_hand)
        for wrong in ([numpy.nan], [1.0, 2.0]):
            with self.assertRaises(fmbpc.InputError):
                self.law.manual(wrong)
        self.law.auto()
        self.assertLess(abs(self.law.step(self.y) - by_hand)[0], 1.0)

    def test_retune_takes_settings_or_changes_nothing(self):
        settings = self.law.settings
        self.assertIn("coincidence_steps", settings)
        self.law.retune(coincidence_steps=int(settings["coincidence_steps"]) + 1)
        changed = self.law.settings
        self.assertNotEqual(settings, changed)
        for wrong in ({"coincidence_steps": -3}, {"no_such": 1}):
            with self.assertRaises(fmbpc.InputError):
                self.law.retune(**wrong)
        self.assertEqual(changed, self.law.settings)

    def test_a_refused_command_leaves_a_controller_as_it_was(self):
        other = fmbpc.Model(fmbpc.Loop("reactor_load").model_file)
        for k in range(3):
            for call in (lambda: self.law.set_model(None), lambda: self.law.set_model("fm_1"), lambda: self.law.set_model(other),
                         lambda: self.law.manual("a"), lambda: self.law.manual([1.0, 2.0]), lambda: self.law.manual({"x": 1.0}),
                         lambda: self.law.retune(coincidence_steps="many"), lambda: self.law.retune(no_such=1), lambda: self.law.adapt(True),
                         lambda: self.law.reset(None), lambda: self.law.reset(self.y[:1]), lambda: self.law.reset(self.y, quality=[True])):
                with self.assertRaises(fmbpc.InputError):
                    call()
            numpy.testing.assert_array_equal(self.twin.step(self.y + k, disturbance=self.d), self.law.step(self.y + k, disturbance=self.d))

    def test_prediction_and_trust_are_there(self):
        self.assertIsNone(self.law.prediction)
        self.law.step(self.y, disturbance=self.d)
        p = self.law.prediction
        self.assertEqual(p["reference"].shape, p["outputs"].shape)
        self.assertEqual(p["feedforward"].shape, p["inputs"].shape)
        numpy.testing.assert_allclose(p["inputs"][0], p["feedforward"][0] - p["K"] @ p["state"])
        self.assertTrue(0.0 <= self.law.trust <= 1.0)
        self.assertIn("status", self.law.report)

    def test_inputs_stay_inside_their_limits_whatever_is_measured(self):
        rng = numpy.random.default_rng(3)
        (_, _, lower, upper), = self.loop.inputs
        for _ in range(200):
            u = self.law.step(10.0 ** rng.uniform(-6, 6, 2), disturbance=self.d * 10.0 ** rng.uniform(-2, 2, len(self.d)))
            self.assertTrue(lower <= u[0] <= upper)


class Plants(unittest.TestCase):
    def test_a_plant_moves_as_its_derivatives_say(self):
        plant = fmbpc.Plant("cstr", sample_time_s=1e-3)
        before, rate = plant.state, plant.derivatives(u=110.0)
        plant.step(110.0)
        numpy.testing.assert_allclose(plant.state - before, rate * 1e-3 / 60.0, rtol=1e-3, atol=1e-8)
        self.assertEqual(1e-3, plant.time_s)

    def test_wrong_arguments_leave_a_plant_as_it_was(self):
        plant, twin = fmbpc.Plant("cstr"), fmbpc.Plant("cstr")
        for u, d in ((numpy.nan, None), ([1.0, 2.0], None), (1e9, None), (100.0, [1.0]), (100.0, {"rate": "x"})):
            with self.assertRaises(fmbpc.InputError):
                plant.step(u, d)
        numpy.testing.assert_array_equal(twin.step(100.0), plant.step(100.0))
        for wrong in ({"name": None}, {"name": "cster"}, {"name": "cstr", "parameters": {"volume": 1}}, {"name": "cstr", "sample_time_s": 0},
                      {"name": "cstr", "sample_time_s": "a"}, {"name": "cstr", "parameters": [1]}, {"name": "cstr", "parameters": {"reactor_volume": "a"}}):
            with self.assertRaises(fmbpc.InputError):
                fmbpc.Plant(**wrong)

    def test_a_step_after_the_end_is_refused(self):
        plant = fmbpc.Loop("asp_case1", set={"sampling.duration_h": 1}).simulation()
        while not plant.done:
            plant.step(plant.applied)
        samples = plant.samples
        with self.assertRaises(fmbpc.InputError):
            plant.step(plant.applied)
        self.assertEqual(samples, plant.samples)
        plant.reset()
        plant.step(plant.applied)

    def test_all_registered_plants_are_listed_and_step(self):
        for name, about in fmbpc.plants().items():
            with self.subTest(name):
                plant = fmbpc.Plant(name)
                y = plant.step()
                self.assertEqual(len(about["outputs"]), len(y))
                self.assertTrue(numpy.isfinite(y).all())


if __name__ == "__main__":
    unittest.main()
