#!/usr/bin/python3
"""The quick part of the fault matrix (scripts/faults), and that its own judge sees what is wrong."""
import pathlib
import subprocess
import sys
import types
import unittest

TOP = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(TOP / "faults"), str(TOP / "ros")]
import judge  # noqa: E402
from fault import Outcome  # noqa: E402
from pulse import Pulse  # noqa: E402

LIMITS = types.SimpleNamespace(names=["u"], lower=[0.0], upper=[100.0], range=[100.0], move=[2.5])


def sample(step, value):
    return types.SimpleNamespace(step=step, run_id=1, input_applied=[value])


def problems(before, after, forced=()):
    outcome = Outcome("x")
    judge.judge_move(sample(7, before), sample(8, after), LIMITS, set(forced), outcome)
    return outcome.problems


class Judge(unittest.TestCase):
    def test_a_move_beyond_its_limit_is_a_problem(self):
        self.assertEqual([], problems(10.0, 12.5))
        self.assertEqual(1, len(problems(10.0, 12.6)))

    def test_a_bound_counts_for_forced_valves_too(self):
        self.assertEqual(1, len(problems(10.0, 101.0, {(8, "u")})))

    def test_a_forced_valve_may_jump(self):
        self.assertEqual([], problems(10.0, 90.0, {(8, "u")}))
        self.assertEqual([], problems(90.0, 10.0, {(7, "u")}))
        self.assertEqual(1, len(problems(10.0, 90.0, {(9, "u")})))

    def test_time_without_samples_must_be_explained(self):
        for words, expected in (([(3.0, "/plant_simulator stalled: no action ()")], 0), ([], 1), ([(9.0, "late")], 1)):
            loop = types.SimpleNamespace(words=lambda start, w=words: w, logs={"plant_state": types.SimpleNamespace(
                since=lambda start: [(2.0, None), (7.0, None)])})
            for still, problems_of in ((0.0, expected), (2.9, expected), (3.1, 0)):
                loop.far = None
                loop.pulse = types.SimpleNamespace(within=lambda a, b, s=still: s if b - a > 2.0 else 0.0)
                outcome = Outcome("x")
                judge.judge_stalls(loop, 1.0, 7.5, outcome)
                self.assertEqual(problems_of, len(outcome.problems), words)

    def test_a_machine_that_stands_still_is_seen_by_the_judge_itself(self):
        pulse = types.SimpleNamespace(gaps=[(3.0, 5.0), (8.0, 9.0)])
        within = Pulse.within
        self.assertEqual([2.0, 0.5, 0.0, 3.0], [within(pulse, *span) for span in ((1.0, 6.0), (4.5, 7.0), (5.0, 8.0), (0.0, 9.5))])


class Contacts(unittest.TestCase):
    def test_six_nodes_survive_what_strangers_send_to_their_ports(self):
        done = subprocess.run([sys.executable, str(TOP / "faults" / "contact_fuzz.py"), "4"], capture_output=True, text=True,
                              timeout=100, check=False)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr[-3000:])


class Quick(unittest.TestCase):
    def test_the_loop_survives_the_commonest_faults(self):
        done = subprocess.run([sys.executable, str(TOP / "faults" / "matrix.py"), "--quick"], capture_output=True, text=True,
                              timeout=200, check=False)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr[-3000:])
        self.assertIn("9 faults met, 0 with problems", done.stdout)


if __name__ == "__main__":
    unittest.main()
