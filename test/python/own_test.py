#!/usr/bin/python3
"""Plants and laws that are Python classes: in loops of this process, checked, and ending a run in words when they fail."""
import json
import pathlib
import tempfile
import threading
import unittest

import numpy

import fmbpc


@fmbpc.register
class OwnTank:
    """Tank with a free outflow."""

    time_unit_s = 60.0
    states = {"level": ("m", 1.0, 0.0, 4.0)}
    inputs = {"inflow": ("m3/min", 0.5, 0.0, 2.0)}
    disturbances = {"leak": ("m3/min", 0.0, 0.0, 0.5)}
    parameters = {"area": ("m2", 1.5, 0.1, 10.0), "outlet": ("m2.5/min", 0.5, 0.0, 5.0)}

    def derivatives(self, x, u, d):
        return [(u[0] - d[0] - self.outlet * max(x[0], 0.0) ** 0.5) / self.area]


@fmbpc.register
class OwnCounter:
    """Sum of what came in, by steps."""

    states = {"sum": ("1", 0.0, -1e6, 1e6)}
    inputs = {"add": ("1", 0.0, -1.0, 1.0)}

    def start(self):
        self.total = 0.0

    def step(self, u, d):
        self.total += u[0]
        return [self.total]


@fmbpc.register
class OwnLaw:
    """PI by hand."""

    parameters = {"gain": 2.0, "integral_min": 3.0}

    def reset(self, y, u):
        self.sum = u[0]

    def step(self, y, setpoint):
        error = setpoint[0] - y[0]
        self.sum += self.gain * error * self.sample_time_s / 60.0 / self.integral_min
        return self.sum + self.gain * error


def tank(law="own_law", **more):
    return {"plant": {"type": "own_tank", **more.pop("plant", {})}, "sampling": {"sample_time_s": 15, "duration_h": 1},
            "setpoint": {"initial": [1.0], "schedule": [{"time_h": 0.2, "level": 1.5}]}, "controller": {"type": law, **more}}


def broken(method):
    """A class that fails at its fifth call."""
    def fail(self, *arguments):
        self.calls = getattr(self, "calls", 0) + 1
        if self.calls > 5:
            raise ZeroDivisionError("in a law or plant of one's own")
        return method(self, *arguments)
    return fail


class Own(unittest.TestCase):
    def test_a_loop_of_both_settles_at_its_setpoint(self):
        run = fmbpc.Loop(tank()).run()
        self.assertTrue(run.complete)
        self.assertAlmostEqual(1.5, run.outputs["level"][-1], places=3)
        again = fmbpc.Loop(tank(gain=2.0)).run()
        numpy.testing.assert_array_equal(run.inputs["inflow"], again.inputs["inflow"])
        weak = fmbpc.Loop(tank(gain=0.5)).run()
        self.assertTrue((run.inputs["inflow"][:-1] != weak.inputs["inflow"][:-1]).any())

    def test_limits_hold_for_a_law_that_asks_for_more(self):
        loop = tank(gain=1000.0)
        run = fmbpc.Loop({**loop, "actuator": {"move_upper": 0.1}}).run()
        moves = numpy.diff(run.inputs["inflow"][:-1])
        self.assertLessEqual(abs(moves).max(), 0.1 + 1e-12)
        self.assertTrue(((run.inputs["inflow"][:-1] >= 0.0) & (run.inputs["inflow"][:-1] <= 2.0)).all())

    def test_a_law_of_ours_takes_a_plant_of_ones_own(self):
        loops = {"type": "pi", "loops": [{"output": "level", "input": "inflow", "kp": 2.0, "ki_per_h": 40.0}]}
        run = fmbpc.Loop({**tank(), "controller": loops}).run()
        self.assertAlmostEqual(1.5, run.outputs["level"][-1], places=3)

    def test_parameters_are_those_of_the_loop(self):
        plant = fmbpc.Plant("own_tank", parameters={"outlet": 0.0})
        numpy.testing.assert_allclose(plant.derivatives(u=0.6, d=0.0), 0.6 / 1.5)
        with self.assertRaises(fmbpc.InputError):
            fmbpc.Loop(tank(plant={"parameters": {"volume": 1.0}}))
        with self.assertRaises(fmbpc.InputError):
            fmbpc.Loop(tank(gian=1.0))

    def test_a_plant_by_steps_has_its_own_memory(self):
        plants = [fmbpc.Plant("own_counter") for _ in range(2)]
        for _ in range(3):
            plants[0].step(0.5)
        self.assertEqual(([1.5], [0.0]), (list(plants[0].outputs), list(plants[1].outputs)))
        plants[0].reset()
        self.assertEqual([0.25], list(plants[0].step(0.25)))

    def test_exceptions_end_a_run_in_words_and_the_process_lives(self):
        class BrokenTank(OwnTank):
            name = "broken_tank"
            derivatives = broken(OwnTank.derivatives)

        class BrokenLaw(OwnLaw):
            name = "broken_law"
            step = broken(OwnLaw.step)

        class BrokenCounter(OwnCounter):
            name = "broken_counter"
            step = broken(OwnCounter.step)
        for cls in (BrokenTank, BrokenLaw, BrokenCounter):
            fmbpc.register(cls)
        counter = {**tank(), "plant": {"type": "broken_counter"}, "setpoint": {"initial": [1.0]}}
        for loop in ({**tank(), "plant": {"type": "broken_tank"}}, tank("broken_law"), counter):
            with self.assertRaisesRegex(ZeroDivisionError, "one's own"):
                fmbpc.Loop(loop).run()
        plant = fmbpc.Plant("broken_tank")
        with self.assertRaises(ZeroDivisionError):
            plant.step(0.5)
        numpy.testing.assert_array_equal([1.0], plant.outputs)
        law = fmbpc.Loop(tank("broken_law")).controller()
        for _ in range(5):
            law.step(1.0)
        with self.assertRaises(ZeroDivisionError):
            law.step(1.0)

    def test_exceptions_in_threads_of_a_study_are_words(self):
        """They end a run each, not the study, and never the process: so does a class that fails where it is made."""
        class Failing(OwnLaw):
            name = "failing_law"
            step = broken(OwnLaw.step)
        fmbpc.register(Failing)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "failing.yaml")
            file.write_text(json.dumps({**tank("failing_law"), "noise": {"std": {"level": 0.01}}}), encoding="utf-8")
            found = fmbpc.study(file, seeds=8, threads=4)
            self.assertIn("ZeroDivisionError", json.dumps(found))

        class Unmade(OwnTank):
            name = "unmade_tank"

            def start(self):
                raise ZeroDivisionError("at its start")
        fmbpc.register(Unmade)
        for use in (lambda: fmbpc.Plant("unmade_tank").step(0.5), lambda: fmbpc.Loop({**tank(), "plant": {"type": "unmade_tank"}}).run()):
            with self.assertRaises(ZeroDivisionError):
                use()
        self.assertTrue(fmbpc.Loop(tank()).run().complete)  # of others it is no trouble

    def test_one_call_at_a_time(self):
        entered, go = threading.Event(), threading.Event()

        class Waiting(OwnLaw):
            name = "waiting_law"

            def step(self, y, setpoint):
                entered.set()
                go.wait(100)
                return super().step(y, setpoint)
        fmbpc.register(Waiting)
        law, answers = fmbpc.Loop(tank("waiting_law")).controller(), []
        thread = threading.Thread(target=lambda: answers.append(law.step(1.0)))
        thread.start()
        self.assertTrue(entered.wait(100))
        for call in (lambda: law.step(1.0), lambda: law.reset(1.0), lambda: law.manual(1.0), law.auto, lambda: law.prediction, lambda: law.steps):
            with self.assertRaisesRegex(RuntimeError, "in use"):
                call()
        go.set()
        thread.join()
        self.assertEqual(1, law.steps)
        numpy.testing.assert_array_equal(fmbpc.Loop(tank()).controller().step(1.0), answers[0])

    def test_a_plant_that_steps_itself_is_refused(self):
        class Inward(OwnTank):
            name = "inward_tank"

            def derivatives(self, x, u, d):
                return plant.step(0.5)
        fmbpc.register(Inward)
        plant = fmbpc.Plant("inward_tank")
        with self.assertRaisesRegex(RuntimeError, "in use"):
            plant.step(0.5)
        numpy.testing.assert_array_equal([1.0], plant.outputs)

    def test_results_of_wrong_size_are_named(self):
        class Two(OwnLaw):
            name = "two_inputs"

            def step(self, y, setpoint):
                return [1.0, 2.0]
        fmbpc.register(Two)
        with self.assertRaisesRegex(fmbpc.InputError, "step"):
            fmbpc.Loop(tank("two_inputs")).run()

    def test_descriptions_are_checked(self):
        for change in ({"states": {}}, {"states": {"level": ("m", 5.0, 0.0, 4.0)}}, {"states": {"level": ("m", 5.0)}}, {"states": {"level": ("m", "a", 0.0, 4.0)}}, {"states": {"level": (1, 1.0, 0.0, 4.0)}},
                       {"time_unit_s": "a"}, {"outputs": ["height"]},
                       {"time_unit_s": 0.0}, {"name": "cstr"}, {"inputs": {"level": ("m", 1.0, 0.0, 4.0)}}):
            with self.subTest(change=change), self.assertRaises(fmbpc.InputError):
                fmbpc.register(type("Wrong", (OwnTank,), {"name": "wrong_tank", **change}))
        with self.assertRaises(fmbpc.InputError):
            fmbpc.register(type("pi", (OwnLaw,), {}))
        for wrong in (OwnTank(), "no_such_library", "/no/such/library.so", ""):
            with self.subTest(wrong), self.assertRaises(fmbpc.InputError):
                fmbpc.register(wrong)
        with self.assertRaises(fmbpc.InputError):
            fmbpc.check("two_tanks")

    def test_a_class_takes_the_place_of_the_former(self):
        class Again(OwnTank):
            name = "again_tank"
        fmbpc.register(Again)
        first = fmbpc.Plant("again_tank").derivatives(u=0.6)
        fmbpc.register(type("Again", (Again,), {"derivatives": lambda self, x, u, d: [7.0]}))
        self.assertEqual([7.0], list(fmbpc.Plant("again_tank").derivatives(u=0.6)))
        self.assertNotEqual([7.0], list(first))

    def test_the_contract_finds_what_is_wrong(self):
        self.assertEqual([], fmbpc.check(OwnTank))
        self.assertEqual([], fmbpc.check(OwnCounter))
        self.assertEqual([], fmbpc.check(OwnLaw, loop=tank()))

        class Remembers(OwnTank):
            def derivatives(self, x, u, d):
                self.calls = getattr(self, "calls", 0) + 1
                return [self.calls]

        class Forgets(OwnCounter):
            total = 0.0

            def start(self):
                pass

            def step(self, u, d):
                Forgets.total += u[0]
                return [Forgets.total]

        class Drifts(OwnCounter):
            def step(self, u, d):
                self.total += 0.1
                return [self.total]

        class Infinite(OwnTank):
            def derivatives(self, x, u, d):
                return [1e308 * 10.0 if x[0] > 2.0 else 0.0]

        class Random(OwnLaw):
            def step(self, y, setpoint):
                return numpy.random.default_rng().uniform(0.0, 2.0)
        for cls in (Remembers, Forgets, Drifts):
            self.assertTrue(fmbpc.check(cls), cls)
        with self.assertRaises(fmbpc.InputError):
            fmbpc.check(Infinite)
        self.assertTrue(fmbpc.check(Random, loop=tank()))


if __name__ == "__main__":
    unittest.main()
