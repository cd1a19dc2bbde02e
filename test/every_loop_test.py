#!/usr/bin/python3
"""Every shipped loop over topics, by the tool and from Python: three runs, the same bytes. Long: scripts/test --long.

One test a loop; some of them: FMBPC_LONG_TESTS=1 test/every_loop_test.py -k asp_b -k cstr (after . scripts/env.sh)
"""
import filecmp
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import yaml

import fmbpc

TOP = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "test" / "ros"))
import exchange  # noqa: E402

LONG = os.environ.get("FMBPC_LONG_TESTS")
SAMPLES = 480  # more where a loop identifies a model: until it has one
ENVIRONMENT = f". {TOP}/scripts/env.sh; exec "


def run(command, **variables):
    return subprocess.run(["bash", "-c", ENVIRONMENT + command], env={**os.environ, **variables},
                          capture_output=True, text=True, timeout=600, check=False)


@unittest.skipUnless(LONG, "long run: scripts/test --long")
class EveryLoop(unittest.TestCase):
    def test_the_loops_are_there(self):
        self.assertGreater(len(fmbpc.loops()), 100)

    def compare(self, name, folder):
        try:
            loop = fmbpc.Loop(name)
        except fmbpc.InputError as error:
            if "FMBPC_DATA" not in str(error):
                raise
            self.skipTest("its record is not there: FMBPC_DATA")
        if loop._core.external:
            self.skipTest("its plant is not ours")
        identify = (yaml.safe_load(loop.resolved).get("model") or {}).get("identify") or {}
        samples = max(SAMPLES, identify.get("after", 0) + 40)
        sets = [f"sampling.duration_h={samples * loop.sample_time_s / 3600.0!r}", "report.record_from_h=0"]
        port = exchange.free_port()
        topics = run(f"roslaunch -p {port} fmbpc loop.launch loop:={name} pace:=lockstep draw:=false "
                     f"set:='{' '.join(sets)}' out:={folder}/topics", ROS_MASTER_URI=f"http://localhost:{port}")
        process = run(f"rosrun fmbpc fmbpc run {name} --set {' --set '.join(sets)} --no-plot --out {folder}/process")
        self.assertEqual(process.returncode, 0, process.stderr)
        code = "import fmbpc, sys; fmbpc.Loop(sys.argv[1], set=sys.argv[3:]).run(progress=False).save(sys.argv[2])"
        python = run(f"/usr/bin/python3 -c '{code}' {name} {folder}/python {' '.join(sets)}")
        self.assertEqual(python.returncode, 0, python.stderr)
        over_topics, in_process, from_python = (pathlib.Path(folder, kind, "trajectory.csv") for kind in ("topics", "process", "python"))
        self.assertTrue(over_topics.exists(), topics.stdout[-2000:])
        self.assertEqual(samples + 2, len(in_process.read_text().splitlines()))  # a head, and the final sample
        self.assertTrue(filecmp.cmp(over_topics, in_process, shallow=False), "over topics it differs from the tool")
        self.assertTrue(filecmp.cmp(from_python, in_process, shallow=False), "from Python it differs from the tool")


def comparison(loop):
    def test(self):
        with tempfile.TemporaryDirectory() as folder:
            self.compare(loop, folder)
    return test


for loop_name in fmbpc.loops() if LONG else ():
    setattr(EveryLoop, f"test_{loop_name}", comparison(loop_name))

if __name__ == "__main__":
    unittest.main()
