#!/usr/bin/python3
"""A sample of the random loop files of test_random over topics equals the same files in one process, bit for bit. Each
launch has a master of its own. FMBPC_LONG_TESTS: a hundred of them; FMBPC_RANDOM_SEED=N one alone."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(TOP / "test"), str(TOP / "test" / "ros")]
import equal_test  # noqa: E402
import exchange  # noqa: E402

QUICK, LONG = 4, 100


def write_loops(folder):
    """In the order of the seeds: folder/random_SEED/loop.yaml, with its records beside it."""
    subprocess.run([exchange.program("test_random"), "--gtest_filter=RandomLoops.CanBeWrittenToAFolder"], check=True,
                   stdout=subprocess.DEVNULL, timeout=60, cwd=TOP / "test", env={**os.environ, "FMBPC_RANDOM_DIR": folder})
    return sorted(pathlib.Path(folder).glob("random_*/loop.yaml"), key=lambda loop: int(loop.parent.name.split("_")[1]))


def in_process(loop, folder):
    """What the tool says: a run that fails (the plant could not be moved, every sample was held) is compared like others."""
    return subprocess.run([exchange.program("fmbpc_tool"), "run", str(loop), "--no-plot", "--out", str(folder)],
                          capture_output=True, text=True, timeout=240, check=False)


def is_accepted(loop):
    resolved = subprocess.run([exchange.program("fmbpc_tool"), "resolve", str(loop)], capture_output=True, timeout=60, check=False)
    return resolved.returncode == 0


def kind_of(loop):
    """Type of the controller, and whether an optimizer follows it."""
    text = loop.read_text(encoding="utf-8")
    return re.search(r"^controller:\n  type: (\w+)", text, re.M)[1], "\nclp:" in text


def of_different_kinds(loops, count):
    """The first loop of each kind that no other has, as many as asked; those that a reader refuses are left out."""
    chosen = {}
    for loop in loops:
        if len(chosen) < count and kind_of(loop) not in chosen and is_accepted(loop):
            chosen[kind_of(loop)] = loop
    return list(chosen.values())


class RandomEqual(unittest.TestCase):
    def loops(self, folder):
        written = write_loops(folder)
        if "FMBPC_RANDOM_SEED" in os.environ:
            return written
        if os.environ.get("FMBPC_LONG_TESTS"):
            return [loop for loop in written[:LONG] if is_accepted(loop)]
        return of_different_kinds(written, QUICK)

    def test_over_topics_equals_in_process(self):
        with tempfile.TemporaryDirectory() as folder:
            loops = self.loops(folder)
            self.assertGreaterEqual(len(loops), 1 if "FMBPC_RANDOM_SEED" in os.environ else QUICK)
            for loop in loops:
                with self.subTest(loop=loop.parent.name):
                    self.compare(loop)

    def compare(self, loop):
        topics, process = loop.parent / "over topics", loop.parent / "process"
        said = in_process(loop, process)
        self.assertTrue((process / "trajectory.csv").exists(), said.stderr + loop.read_text(encoding="utf-8"))
        text = equal_test.launch(topics, loop, [], "lockstep", 3600)
        self.assertTrue((topics / "summary.json").exists(), text[-3000:])
        try:
            exchange.assert_same_run(self, topics, process)
        except AssertionError as difference:
            raise AssertionError(f"{difference}\n{loop.read_text(encoding='utf-8')}") from None


if __name__ == "__main__":
    unittest.main()
