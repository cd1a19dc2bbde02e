#!/usr/bin/python3
"""Models: the same from arrays, frame and CSV; studies, tunings and analyses as the tool prints them."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy
import pandas

import fmbpc

TOP = pathlib.Path(__file__).resolve().parents[2]
RECORD = TOP / "examples/reactor_record.csv"
TOOL = os.environ["FMBPC_TOOL"]
SIGNALS = {"inputs": ["q_c"], "outputs": ["CA"]}
QUICK = {**SIGNALS, "work": 5, "kind": "linear", "blocks": 2}


class Models(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.frame = pandas.read_csv(RECORD)
        cls.model = fmbpc.identify(str(RECORD), **QUICK)
        cls.y, cls.u = (cls.frame[c].to_numpy() for c in ("CA[mol/l]", "q_c[l/min]"))

    def rules(self, model):
        """The text without where the data came from."""
        return [line for line in model._core.text.splitlines() if "source" not in line and "name:" not in line]

    def test_arrays_frame_and_csv_give_the_same_model(self):
        arrays = {c: self.frame[c].to_numpy() for c in self.frame}
        strided = {c: numpy.repeat(v, 2)[::2] for c, v in arrays.items()}
        plain = self.frame.rename(columns=lambda c: c.partition("[")[0])
        plain.attrs["units"] = {"time": "min", "CA": "mol/l", "q_c": "l/min"}
        for data in (self.frame, arrays, strided, plain, pathlib.Path(RECORD)):
            self.assertEqual(self.rules(self.model), self.rules(fmbpc.identify(data, **QUICK)))

    def test_what_a_mask_hides_is_missing(self):
        """In an array with a mask, in a frame and in a CSV alike."""
        hidden = numpy.zeros(len(self.y), dtype=bool)
        hidden[100:103] = True
        gone = self.frame.copy()
        gone.loc[hidden, "CA[mol/l]"] = numpy.nan
        masked = {c: self.frame[c].to_numpy() for c in self.frame}
        masked["CA[mol/l]"] = numpy.ma.masked_array(self.y, hidden)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "gone.csv")
            gone.to_csv(file, index=False)
            found = [self.rules(fmbpc.identify(data, **QUICK)) for data in (gone, masked, file)]
        self.assertEqual(found[:1] * 3, found)
        self.assertNotEqual(self.rules(self.model), found[0])

    def test_the_tool_finds_the_same_model(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "model.yaml")
            subprocess.run([TOOL, "identify", str(RECORD), "--auto", "--inputs", "q_c", "--outputs", "CA", "--work", "5", "--kind", "linear",
                            "--blocks", "2", "--out", file], capture_output=True, check=True)
            self.assertEqual(self.rules(fmbpc.Model(file)), self.rules(self.model))
            self.model.save(file)
            self.assertEqual(fmbpc.Model(file)._core.text, self.model._core.text)

    def test_what_is_wrong_with_a_record_is_named(self):
        good = {"CA": self.y, "q_c": self.u}
        wrong = [({**good, "CA": self.y[:-1]}, "q_c|CA"), ({**good, "q_c": ["a"] * len(self.u)}, "q_c"), ({**good, "q_c": self.u * 1j}, "q_c"),
                 ({**good, "q_c": numpy.full(len(self.u), numpy.inf)}, "q_c"), ({"CA": self.y}, "q_c"), ({}, "columns"),
                 ({**good, "q_c": self.u[:, None]}, "q_c"), (str(RECORD) + ".no", "no"), (None, "frame"), (self.y, "frame"),
                 ({**good, "CA": numpy.full(len(self.y), numpy.nan)}, "CA"), ({n: v[:5] for n, v in good.items()}, "rows")]
        for data, words in wrong:
            with self.subTest(words), self.assertRaisesRegex(fmbpc.InputError, words):
                fmbpc.identify(data, sample_time_s=60.0, **QUICK)
        for options, words in (({"inputs": ["q_c"]}, "outputs"), ({"outputs": ["CA"]}, "inputs"), ({**SIGNALS, "structure": "no_such"}, "no_such"),
                               ({**SIGNALS, "rows": "b:a"}, "b:a"), ({**SIGNALS, "rows": 3}, "rows"), ({**SIGNALS, "work": "a"}, "work"),
                               ({**SIGNALS, "inputs": 3}, "inputs"), ({**SIGNALS, "outputs": [3]}, "outputs")):
            with self.subTest(words), self.assertRaisesRegex(fmbpc.InputError, words):
                fmbpc.identify(self.frame, **options)

    def test_predictions_and_simulations(self):
        one = self.model.predict(self.y, self.u)
        ten = self.model.predict(self.y, self.u, steps=10)
        self.assertEqual((len(self.y), 1), one.shape)
        good = numpy.isfinite(ten[:, 0])
        error = [float(numpy.nanmean((p[good, 0] - self.y[good]) ** 2)) for p in (one, ten)]
        self.assertLess(error[0], error[1])
        free = self.model.simulate(self.u, y0=self.y[0])
        self.assertEqual(self.y[0], free[0, 0])
        self.assertTrue(numpy.isfinite(free).all())
        for y, u in ((self.y[:-1], self.u), (numpy.zeros((9, 2)), self.u[:9]), (["a"], [1.0]), (self.y, None), (None, self.u), (self.y * 1j, self.u)):
            with self.assertRaises(fmbpc.InputError):
                self.model.predict(y, u)
        for u, y0 in (([1.0, numpy.nan], 0.1), ([], 0.1), (["a"], 0.1), ([[1.0, 2.0]], 0.1), ([1.0], None), ([1.0], [numpy.nan]), ([1.0], [0.1, 0.2])):
            with self.assertRaises(fmbpc.InputError):
                self.model.simulate(u, y0=y0)
        for wrong in ({"y": [1.0, 2.0]}, {"u": numpy.nan}, {"u": "a"}, {"d": [1.0]}):
            with self.assertRaises(fmbpc.InputError):
                self.model.linearise(**wrong)
        self.assertEqual(0, len(self.model.predict(self.y[:0], self.u[:0])))
        strided = [numpy.repeat(v, 3)[::3] for v in (self.y, self.u)]
        numpy.testing.assert_array_equal(one, self.model.predict(*strided))
        numpy.testing.assert_array_equal(one, self.model.predict(self.y[:, None], numpy.asfortranarray(self.u[:, None])))

    def test_the_linearisation_moves_as_the_model(self):
        linear = self.model.linearise(y=self.y[0], u=self.u[0])
        self.assertEqual((linear["A"].shape[0], 1), linear["B"].shape)
        with self.assertRaises(fmbpc.InputError):
            self.model.linearise(y={"T": 1.0})

    def test_validation_is_that_of_the_tool(self):
        found = self.model.validate(self.frame, rows="1:300")
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "model.yaml")
            self.model.save(file)
            told = json.loads(subprocess.run([TOOL, "validate", file, str(RECORD), "--rows", "1:300", "--json"], capture_output=True, check=True).stdout)
        self.assertEqual(told["validation"], found["validation"])

    def test_a_model_goes_into_a_controller_or_is_refused(self):
        law = fmbpc.Loop("asp_case1").controller()
        with self.assertRaises(fmbpc.InputError):
            law.set_model(self.model)
        pi = fmbpc.Loop("asp_case1_pi_x").controller()
        with self.assertRaises(fmbpc.InputError):
            pi.set_model(self.model)
        law.set_model(fmbpc.Model(fmbpc.Loop("asp_case1").model_file))

    def test_a_structure_is_identified_as_by_the_tool(self):
        with tempfile.TemporaryDirectory() as folder:
            fmbpc.Loop("asp_d_record" if "asp_d_record" in fmbpc.loops() else "asp_case1", set={"sampling.duration_h": 2000}).run().save(folder)
            record = os.path.join(folder, "trajectory.csv")
            model = fmbpc.identify(record, structure="asp_d")
            told = json.loads(subprocess.run([TOOL, "identify", record, "asp_d", "--json"], capture_output=True, check=True).stdout)
        told.pop("seconds")
        mine = dict(model.report)
        mine.pop("seconds")
        self.assertEqual(told, mine)


class Reports(unittest.TestCase):
    def tool(self, *words):
        done = subprocess.run([TOOL, *words, "--json"], capture_output=True, check=False)
        return json.loads(done.stdout)

    def test_a_study_is_that_of_the_tool(self):
        mine = fmbpc.study("asp_case1", "asp_case1_pi_x", seeds=3, set={"sampling.duration_h": 24})
        told = self.tool("study", "asp_case1", "asp_case1_pi_x", "--seeds", "1:3", "--set", "sampling.duration_h=24")
        self.assertEqual(told, mine)
        for loops in ((), (None,), ("asp_case1", "no_such_loop")):
            with self.assertRaises(fmbpc.InputError):
                fmbpc.study(*loops, seeds=2)

    def test_stability_is_that_of_the_tool(self):
        self.assertEqual(self.tool("stability", "fm_1", "--horizon", "1..9"), fmbpc.stability("fm_1", horizon=range(1, 10)))
        for wrong in ({"at": {"no": 1.0}}, {"horizon": range(1, 9, 2)}, {"horizon": "many"}, {"set": {"a": 1}}, {"points": 101}, {"points": -1}):
            with self.subTest(wrong=wrong), self.assertRaises(fmbpc.InputError):
                fmbpc.stability("fm_1", **wrong)

    def test_objects_are_analysed_as_their_files_are(self):
        self.assertEqual(fmbpc.stability("fm_1", horizon="1..9"), fmbpc.stability(fmbpc.Model("fm_1"), horizon="1..9"))
        changed = {"controller.loops.0.kp": 30}
        told = self.tool("stability", "cstr_tracking_pi", "--points", "2", "--set", "controller.loops.0.kp=30")
        self.assertEqual(told, fmbpc.stability("cstr_tracking_pi", set=changed, points=2))
        self.assertEqual(told, fmbpc.stability(fmbpc.Loop("cstr_tracking_pi", set=changed), points=2))
        self.assertNotEqual(told, fmbpc.stability("cstr_tracking_pi", points=2))

    def test_what_is_wrong_is_named(self):
        seeds = {"seeds": 2}
        wrong = [(fmbpc.study, ("asp_case1",), options, words) for options, words in (
            ({"seeds": 1.5}, "seeds"), ({"seeds": "x"}, "seeds"), ({**seeds, "threads": "a"}, "threads"), ({**seeds, "noise": {"x": "a"}}, "noise.x"),
            ({**seeds, "noise": 3}, "noise"), ({**seeds, "noise_percent": "a"}, "noise_percent"), ({**seeds, "vary": 3}, "vary"),
            ({**seeds, "index": 3}, "index"), ({**seeds, "index": "no"}, "no"), ({**seeds, "against": 3}, "against"), ({**seeds, "progress": "x"}, "progress"))]
        wrong += [(fmbpc.tune, ("asp_case1_pi_x", "pi_x"), options, words) for options, words in (
            ({"method": 3}, "method"), ({"evaluations": 0.5}, "evaluations"), ({"seed": "a"}, "seed"), ({"threads": None}, "threads"))]
        wrong += [(fmbpc.stability, ("fm_1",), options, words) for options, words in (
            ({"at": 3}, "at"), ({"at": {"q_r": "a"}}, "at.q_r"), ({"noise_gain": "a"}, "noise_gain"), ({"settling": 0.5}, "settling"))]
        wrong += [(fmbpc.tune, ("asp_case1", "no_such"), {}, "no_such"), (fmbpc.Model, ("no_such",), {}, "no_such")]
        for call, names, options, words in wrong:
            with self.subTest(call=call, options=options), self.assertRaisesRegex(fmbpc.InputError, words):
                call(*names, **options)

    def test_what_a_progress_raises_ends_the_computation(self):
        def stop(share, words):
            raise ZeroDivisionError(words)
        record = {"u": numpy.random.default_rng(1).normal(size=3000), "y": numpy.random.default_rng(2).normal(size=3000)}
        for call in (lambda: fmbpc.study("asp_case1", seeds=200, progress=stop), lambda: fmbpc.tune("asp_case1_pi_x", "pi_x", evaluations=400, progress=stop),
                     lambda: fmbpc.identify(record, inputs="u", outputs="y", sample_time_s=1.0, work=200, progress=stop)):
            with self.assertRaises(ZeroDivisionError):
                call()

    def test_a_tuning_is_that_of_the_tool(self):
        short = {"sampling.duration_h": 24}
        mine = fmbpc.tune("asp_case1_pi_x", "pi_x", set=short, evaluations=24, seed=2)
        told = self.tool("tune", "asp_case1_pi_x", "pi_x", "--set", "sampling.duration_h=24", "--evaluations", "24", "--seed", "2")
        for result in (mine, told):
            result.pop("seconds")
            result.pop("evaluations_per_s")
        self.assertEqual(told, mine)


if __name__ == "__main__":
    unittest.main()
