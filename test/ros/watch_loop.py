#!/usr/bin/python3
"""`fmbpc watch` shows a running loop in a terminal and in a picture; plot:=true writes settings that rqt_plot restores."""
import ast
import os
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock as mock

import roslib.packages
import rospy
import rostest
from fmbpc.msg import Measurement

import exchange

SCRIPTS = os.path.join(roslib.packages.get_pkg_dir("fmbpc"), "scripts")
sys.path.insert(0, SCRIPTS)
import live_view  # noqa: E402
import plot_live  # noqa: E402


def watch(*arguments, check=True):
    """As a person calls it: through the tool."""
    return subprocess.run([os.path.join(SCRIPTS, "fmbpc"), "watch", *arguments], check=check, capture_output=True, text=True, timeout=60)


class Watch(unittest.TestCase):
    def setUp(self):
        exchange.Listener("measurement", Measurement).wait(lambda m: m.step >= 5)

    def test_the_terminal_shows_state_and_signals(self):
        text = watch("--seconds", "3").stdout
        line = text.strip().splitlines()[-1]
        for words in ("activated_sludge", "sample ", " h   ", "automatic: running", "s ", "x ", "q_r ", "mg/l", "-> 1800"):
            self.assertIn(words, line)
        first, last = (int(line.split("sample ")[1].split()[0]) for line in (
            next(row for row in text.splitlines() if "sample " in row), line))
        self.assertGreater(last, first)

    def test_a_picture_is_drawn_again_and_again(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "loop.png")
            watch("--picture", file, "--seconds", "4")
            with open(file, "rb") as stream:
                self.assertEqual(b"\x89PNG", stream.read(4))
            self.assertGreater(os.path.getsize(file), 10000)

    def test_a_wrong_option_is_refused(self):
        done = watch("--rate", "0", check=False)
        self.assertNotEqual(0, done.returncode)
        self.assertIn("--rate", done.stderr)

    def test_signals_of_one_unit_share_a_plot_unless_their_sizes_are_far_apart(self):
        view = live_view.LiveView()
        exchange.wait_until(lambda: view.sample() and view.complete() and "x_setpoint" in view.values, "all signals, also what is tracked")
        self.assertEqual([["s", "s_setpoint", "s_reference"], ["x", "x_setpoint", "x_reference"], ["q_r"]],
                         [panel.names for panel in view.panels()])
        self.assertEqual(("h", 40.0, True), (view.axis.unit, view.axis.length, view.axis.endless))  # 200 samples
        for sample_time, samples, unit in ((720.0, 100, "h"), (60.0, 10, "min"), (0.5, 100, "s")):
            self.assertEqual(unit, live_view.Axis(sample_time, samples).unit)

    def test_the_window_of_a_run_that_went_well_outlives_the_launch(self):
        over, start, windows = types.SimpleNamespace(is_shutdown=lambda: True), subprocess.Popen, []
        for outcome, stays in (((True, "finished"), True), ((False, "ended: the disk is full"), False), (None, False)):
            view = types.SimpleNamespace(outcome=lambda o=outcome: o)
            with mock.patch.object(plot_live, "rospy", over), mock.patch.object(
                    plot_live.subprocess, "Popen", lambda *a, **k: windows.append(start(*a, **k)) or windows[-1]):
                plot_live.follow(["sleep", "60"], view)
            self.assertEqual(stays, windows[-1].poll() is None)
            windows[-1].kill()
            windows[-1].wait()

    def test_the_settings_for_rqt_plot_name_every_signal_once(self):
        axis = types.SimpleNamespace(endless=False, length=60.0)
        panels = [live_view.Panel("mg/l", ["x", "x_setpoint"]), live_view.Panel("m3/h", ["q_r"])]
        names = {"x": "/a/view/x", "x_setpoint": "/a/view/x_setpoint", "q_r": "/a/view/q_r"}
        groups = plot_live.perspective(panels, names, axis, {"x": 1900.0, "x_setpoint": 1800.0, "q_r": 0.0})["groups"]
        manager = groups["pluginmanager"]
        self.assertEqual({"rqt_plot/Plot": [1, 2]}, ast.literal_eval(manager["keys"]["running-plugins"]["repr"]))
        keys = [manager["groups"][f"plugin__rqt_plot__Plot__{n}"]["groups"]["plugin"]["keys"] for n in (1, 2)]
        self.assertEqual([["/a/view/x/data", "/a/view/x_setpoint/data"], ["/a/view/q_r/data"]],
                         [ast.literal_eval(k["topics"]["repr"]) for k in keys])
        self.assertEqual([0.0, 60.0], ast.literal_eval(keys[0]["x_limits"]["repr"]))
        self.assertEqual([1790.0, 1910.0], ast.literal_eval(keys[0]["y_limits"]["repr"]))
        low, high = ast.literal_eval(keys[1]["y_limits"]["repr"])
        self.assertLess(low, high)


if __name__ == "__main__":
    rospy.init_node("watch_loop")
    rostest.rosrun("fmbpc", "watch_loop", Watch, sys.argv)
