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
        if not (BUILD / "bench/path_bench").exists() or not (BUILD / "bench/qp_baselines").exists():
            self.skipTest("no path_bench and qp_baselines in the build folder")
        page = subprocess.run([TOP / "scripts/bench", "--build", BUILD, "--quick", "--no-build"], check=True,
                              capture_output=True, text=True, timeout=300, env=dict(os.environ)).stdout
        rows = [line for line in page.splitlines() if re.search(r"\| (yes|\*\*no\*\*) \|", line)]
        for path in ("166 h in process", "step of the published law", "plant sample", "Gustafson-Kessel", "eight runs"):
            self.assertTrue(any(path in row for row in rows), path)
        for solved, count in re.findall(r"^\| QP .*?\((\d+) of (\d+) solved\)", page, re.MULTILINE):
            self.assertEqual(solved, count)


if __name__ == "__main__":
    unittest.main()
