#!/usr/bin/python3
"""Runs and steps from Python give the bits of the tool, over all shipped loops that run in process."""
import collections
import concurrent.futures
import json
import os
import pathlib
import subprocess
import tempfile
import threading
import unittest

import numpy

import fmbpc

TOOL = os.environ["FMBPC_TOOL"]
SAMPLES = 12


def short(name):
    """The loop, a few samples of it; None: it does not run here (an external plant, a record that is not there)."""
    try:
        loop = fmbpc.Loop(name)
    except fmbpc.InputError as error:
        if "FMBPC_DATA" in str(error):
            return None
        raise
    if loop._core.external:
        return None
    return fmbpc.Loop(name, set={"sampling.duration_h": SAMPLES * loop.sample_time_s / 3600.0, "report.record_from_h": 0})


class EveryLoop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            cls.loops = [loop for loop in pool.map(short, fmbpc.loops()) if loop]
            cls.runs = dict(zip([loop.name for loop in cls.loops], pool.map(lambda loop: loop.run(progress=False), cls.loops)))

    def test_a_run_gives_the_files_of_the_tool(self):
        self.assertGreater(len(self.loops), 100)
        by_duration = collections.defaultdict(list)
        for loop in self.loops:
            by_duration[SAMPLES * loop.sample_time_s / 3600.0].append(loop.name)

        def tool(item):
            duration, names = item
            folder = os.path.join(self.folder.name, repr(duration))
            words = [TOOL, "run", *names, "--set", f"sampling.duration_h={duration!r}", "--set", "report.record_from_h=0", "--out", folder, "--no-plot"]
            subprocess.run(words, capture_output=True, check=False)  # a run that says it was not as asked is one
            return [(name, os.path.join(folder, name) if len(names) > 1 else folder) for name in names]

        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            folders = [pair for pairs in pool.map(tool, by_duration.items()) for pair in pairs]
        self.assertEqual(len(self.loops), len(folders))
        for name, folder in folders:
            with self.subTest(name), tempfile.TemporaryDirectory() as mine:
                self.runs[name].save(mine)
                ours, theirs = (pathlib.Path(f, "trajectory.csv").read_bytes() for f in (mine, folder))
                self.assertEqual(theirs, ours)
                ours, theirs = (json.loads(pathlib.Path(f, "summary.json").read_text()) for f in (mine, folder))
                for summary in (ours, theirs):
                    summary.pop("wall_s")
                    summary.get("clp", {}).pop("median_us", None)
                    summary.get("clp", {}).pop("p99_us", None)
                self.assertEqual(theirs, ours)

    def test_a_controller_before_the_same_plant_gives_the_inputs_of_the_run(self):
        def stepped(loop):
            law, plant, inputs = loop.controller(), loop.simulation(), []
            self.assertEqual(0, plant.samples)
            while not plant.done:
                measured = numpy.concatenate([plant.outputs, plant.disturbance])
                inputs.append(law.step(plant.outputs, disturbance=plant.disturbance, applied=plant.applied,
                                       quality=None if numpy.isfinite(measured).all() else numpy.isfinite(measured)))
                plant.step(inputs[-1])
            return numpy.array(inputs)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for loop, inputs in zip(self.loops, pool.map(stepped, self.loops)):
                with self.subTest(loop.name):
                    run = self.runs[loop.name]
                    asked = [run[n + "_commanded" if n + "_commanded" in run.names else n] for n, *_ in loop.inputs]
                    self.assertEqual(SAMPLES, len(inputs))
                    numpy.testing.assert_array_equal(numpy.column_stack(asked)[:-1], inputs)

    def test_a_hundred_controllers_in_threads_share_nothing(self):
        """Of a hundred loops, all there at once, each in a thread of its own."""
        loops = self.loops[:100]
        first = [numpy.nan_to_num(loop.simulation().outputs) for loop in loops]
        start = threading.Barrier(len(loops))

        def stepped(law, y):
            return [law.step(y * (1.0 + 1e-3 * k)) for k in range(SAMPLES)]

        def together(law, y):
            start.wait()
            return stepped(law, y)
        alone = [stepped(loop.controller(), y) for loop, y in zip(loops, first)]
        with concurrent.futures.ThreadPoolExecutor(len(loops)) as pool:
            found = list(pool.map(together, [loop.controller() for loop in loops], first))
        self.assertEqual(100, len(found))
        for loop, one, of_all in zip(loops, alone, found):
            with self.subTest(loop.name):
                numpy.testing.assert_array_equal(one, of_all)


if __name__ == "__main__":
    unittest.main()
