#!/usr/bin/python3
"""Every shipped loop over topics, by the tool and from Python: three runs, the same bytes. Long: scripts/test --long."""
import filecmp
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "test" / "ros"))
import ring  # noqa: E402

LOOPS = {path.stem: path for path in sorted((TOP / "config" / "loop").rglob("*.yaml"))}
ENVIRONMENT = f". {TOP}/scripts/env.sh; exec "


def run(command, **variables):
    return subprocess.run(["bash", "-c", ENVIRONMENT + command], env={**os.environ, **variables},
                          capture_output=True, text=True, timeout=600, check=False)


@unittest.skipUnless(os.environ.get("FMBPC_LONG_TESTS"), "long run: scripts/test --long")
class EveryLoop(unittest.TestCase):
    def test_over_topics_equals_in_process_equals_python(self):
        self.assertGreater(len(LOOPS), 100)
        for loop, path in LOOPS.items():
            text = path.read_text()
            external = "type: external" in text
            no_data = loop.startswith(("asp_bsm1", "asp_uci", "bsm1_")) and not os.environ.get("FMBPC_DATA")
            if external or no_data:
                continue
            with self.subTest(loop=loop), tempfile.TemporaryDirectory() as folder:
                self.compare(loop, folder)

    def compare(self, loop, folder):
        sample_times = {"cstr": 6, "batch": 10, "surge_tank": 0.1, "mimo_cstr": 0.6, "linear_2x2": 1, "column": 60,
                        "heated_tank": 30, "bsm1_": 900}
        seconds = next((s for name, s in sample_times.items() if loop.startswith(name)), 720)
        sets = [f"sampling.duration_h={480 * seconds / 3600}", "report.record_from_h=0"]
        port = ring.free_port()
        topics = run(f"roslaunch -p {port} fmbpc loop.launch loop:={loop} pace:=lockstep draw:=false "
                     f"set:='{' '.join(sets)}' out:={folder}/topics", ROS_MASTER_URI=f"http://localhost:{port}")
        process = run(f"rosrun fmbpc fmbpc run {loop} --set {' --set '.join(sets)} --no-plot --out {folder}/process")
        self.assertEqual(process.returncode, 0, process.stderr)
        code = "import fmbpc, sys; fmbpc.Loop(sys.argv[1], set=sys.argv[3:]).run(progress=False).save(sys.argv[2])"
        python = run(f"/usr/bin/python3 -c '{code}' {loop} {folder}/python {' '.join(sets)}")
        self.assertEqual(python.returncode, 0, python.stderr)
        over_topics, in_process, from_python = (f"{folder}/{kind}/trajectory.csv" for kind in ("topics", "process", "python"))
        self.assertTrue(os.path.exists(over_topics), topics.stdout[-2000:])
        self.assertTrue(filecmp.cmp(over_topics, in_process, shallow=False), f"{loop}: over topics it differs from the tool")
        self.assertTrue(filecmp.cmp(from_python, in_process, shallow=False), f"{loop}: from Python it differs from the tool")


if __name__ == "__main__":
    unittest.main()
