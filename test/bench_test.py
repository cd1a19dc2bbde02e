#!/usr/bin/python3
"""The benchmarks run: scripts/bench --quick executes all of them once. Nothing is said about time."""
import os
import pathlib
import re
import subprocess
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("FMBPC_BUILD", TOP / "build"))


class Bench(unittest.TestCase):
    def test_every_benchmark_runs_and_our_qps_are_solved(self):
        programs = ("growth_bench", "model_bench", "path_bench", "qp_baselines")
        if not all((BUILD / "bench" / program).exists() for program in programs):
            self.skipTest("not built: " + ", ".join(programs))
        page = subprocess.run([TOP / "scripts/bench", "--build", BUILD, "--quick", "--no-build"], check=True,
                              capture_output=True, text=True, timeout=300, env=dict(os.environ)).stdout
        rows = [line for line in page.splitlines() if re.search(r"\| (yes|\*\*no\*\*) \|", line)]
        for path in ("166 h in process", "steps of the published law, asp_case1, H 6 ", "steps of the published law, asp_case1, H 180 ", "covariance pass", "fmbpc study", "fmbpc tune", "plant sample", "Gustafson-Kessel", "eight runs", "iterated law", "branch and bound", "fit to free runs"):
            self.assertTrue(any(path in row for row in rows), path)
        for curve in ("law, outputs = inputs", "law, rules", "law, coincidence", "CLP cold", "CLP warm", "plant sample, tanks"):
            self.assertRegex(page, rf"\| {curve}[^|]*\| \d+ to \d+ \| [\d.e+]+ \|")
        self.assertRegex(page, r"CLP step, n_c 42.* 0 unsolved")
        self.assertRegex(page, r"\| record of a run .*\| \d+ \|  \|  \| -?\d+ \|")
        self.assertRegex(page, r"\| identify --auto of it.*\| \d+ \| 2048 \|  \| -?\d+ \|")
        families = re.findall(r"^- QP .*: (\d+) of (\d+) solved by ours", page, re.MULTILINE)
        self.assertGreaterEqual(len(families), 3)
        for solved, count in families:
            self.assertEqual(solved, count)


if __name__ == "__main__":
    unittest.main()
