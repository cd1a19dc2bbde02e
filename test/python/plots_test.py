#!/usr/bin/python3
"""Pictures of runs: from a folder as the tool draws them, and of runs in this process."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import matplotlib
import numpy

matplotlib.use("Agg")

import fmbpc  # noqa: E402
from fmbpc import plots  # noqa: E402


class Plots(unittest.TestCase):
    def test_a_run_is_drawn_with_a_panel_of_each_signal(self):
        run = fmbpc.Loop("asp_case1", set={"sampling.duration_h": 4}).run()
        axes = run.plot().axes
        self.assertGreaterEqual(len(axes), len(run.outputs) + len(run.inputs))
        self.assertEqual(len(run.time), len(axes[0].lines[-1].get_xdata()))
        with tempfile.TemporaryDirectory() as folder:
            run.save(folder)
            self.assertEqual(len(axes), len(plots.run_picture([folder]).axes))

    def test_what_cannot_be_drawn_is_said(self):
        with tempfile.TemporaryDirectory() as folder:
            for words, code in (([], 2), (["cake", folder], 2), (["run", folder], 1), (["model", folder], 1), (["reproduce", folder], 1)):
                done = subprocess.run([sys.executable, "-m", "fmbpc.plots", *words], capture_output=True, check=False)
                self.assertEqual((code, True), (done.returncode, bool(done.stderr)), words)

    def test_a_table_is_read_or_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "trajectory.csv")
            for text, rows in (("time[h],x\n0,1\n1,", 2), ("", 0), ("time[h],x\n0,1\n1\n", None), ("time[h],x\n0,a\n", None)):
                file.write_text(text)
                if rows is None:
                    with self.assertRaises(ValueError):
                        plots.read_table(file)
                else:
                    self.assertEqual(rows, len(plots.read_table(file)[0].get("time", ())), text)

    def test_the_tool_draws_by_it(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.environ["FMBPC_TOOL"], "run", "asp_case1", "--set", "sampling.duration_h=4", "--out", folder], check=True, capture_output=True)
            self.assertTrue(pathlib.Path(folder, "plot.png").exists())

    def test_a_commissioning_is_drawn_as_far_as_it_is(self):
        with tempfile.TemporaryDirectory() as folder:
            brief = pathlib.Path(__file__).resolve().parents[2].joinpath("examples", "commission", "reactor.yaml")
            subprocess.run([os.environ["FMBPC_TOOL"], "commission", brief, "--until", "watch", "--folder", folder], check=True, capture_output=True)
            self.assertTrue(pathlib.Path(folder, "test.png").exists())
            self.assertFalse(pathlib.Path(folder, "model.png").exists())

    def test_responses_of_elements_begin_and_end_as_on_paper(self):
        from fmbpc.plots import commissioning
        for tau, second, damping, lead in ((8, 8, 0.4, -3), (8, 3, 1, 5), (8, 8, 1, 2), (8, 0, 1, 0)):
            element = {"gain": 2, "time_constant_s": tau, "second_s": second, "damping": damping, "lead_s": lead, "dead_time_s": 4, "integrating": False}
            early, last = commissioning.step(element, numpy.array([4.0, 4.0 + 1e-5, 400.0]))[[1, 2]]
            self.assertAlmostEqual(0, commissioning.step(element, numpy.array([3.9]))[0], 12)
            self.assertAlmostEqual(2 * (lead / (tau * second) if second else 1 / tau), early / 1e-5, 4)
            self.assertAlmostEqual(2, last, 6)


if __name__ == "__main__":
    unittest.main()
