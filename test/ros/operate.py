#!/usr/bin/python3
"""`fmbpc set`, `disturb`, `manual`, `auto`, `release` and the end of `fmbpc watch`: what the loop does is said in the same terminal."""
import os
import re
import subprocess
import sys
import unittest

import rospy
import rostest
from fmbpc.msg import CommandEffect, ControlAction, Measurement, Tracking
from std_msgs.msg import String

import exchange


class Operate(unittest.TestCase):
    def setUp(self):
        self.measurement = exchange.Listener("measurement", Measurement)
        self.measurement.wait(lambda m: m.step >= 3)

    def tool(self, *words, code=0):
        done = exchange.tool(*words, check=False)
        self.assertEqual(code, done.returncode, done.stdout + done.stderr)
        return done.stdout if code == 0 else done.stderr

    def since(self, text):
        return int(re.search(r"since sample (\d+)", text).group(1))

    def test_a_setpoint_is_in_force_since_the_sample_that_is_said(self):
        effects, tracking = exchange.Listener("setpoint_effect", CommandEffect), exchange.Listener("tracking", Tracking)
        text = self.tool("set", "x", "2000")
        self.assertIn("x: setpoint 2000 mg/l since sample", text)
        step = self.since(text)
        self.assertEqual(step, effects.wait(lambda m: list(m.name) == ["x"]).step)
        self.assertEqual((55.0, 2000.0), tracking.wait(lambda t: t.step == step).setpoint)
        self.assertEqual((55.0, 1800.0), tracking.wait(lambda t: t.step == step - 1).setpoint)
        self.assertIn("follows 2500 mg/l", self.tool("set", "x", "3000"))
        self.assertIn("released since sample", self.tool("release", "x"))

    def test_what_is_refused_is_said_and_changes_nothing(self):
        tracking = exchange.Listener("tracking", Tracking)
        for words, reason in ((("set", "x", "20000"), "value of x: expected a number >= 0 and <= 10000"),
                              (("set", "nobody", "1"), "one of s, x"), (("disturb", "q_i", "1e9"), "value of q_i"),
                              (("manual", "nobody", "1"), "one of q_r"), (("set", "x", "many"), "x: expected a number"),
                              (("set", "x"), "NAME VALUE")):
            self.assertIn(reason, self.tool(*words, code=1))
        self.tool("auto")
        last = tracking.messages[-1].step
        self.assertEqual((55.0, 1800.0), tracking.wait(lambda t: t.step > last).setpoint)

    def test_a_disturbance_comes_and_goes(self):
        text = self.tool("disturb", "q_i", "1500")
        self.assertIn("q_i: disturbance 1500 m3/h since sample", text)
        since = self.since(text)
        self.assertEqual(1500.0, self.measurement.wait(lambda m: m.step == since).disturbances[0])
        self.assertIn("+100 m3/h", self.tool("disturb", "q_i", "100", "--offset"))
        words = self.tool("release")
        self.assertIn("every setpoint released", words)
        step = self.since(words.split("every disturbance")[1])
        self.assertEqual(1300.0, self.measurement.wait(lambda m: m.step == step).disturbances[0])

    def test_the_hand_takes_and_gives_back(self):
        action = exchange.Listener("control_action", ControlAction)
        text = self.tool("manual", "q_r", "900")
        step = self.since(text)
        self.assertIn("q_r: 900 m3/h", text)
        self.assertEqual((ControlAction.MANUAL, (900.0,)), (lambda a: (a.source, a.input))(action.wait(lambda a: a.step == step)))
        text = self.tool("manual", "q_r", "5000")
        self.assertIn("and clamped", text)
        self.assertIn("q_r: 1600 m3/h", text)
        step = self.since(self.tool("auto"))
        self.assertNotEqual(ControlAction.MANUAL, action.wait(lambda a: a.step == step).source)

    def test_what_is_wrong_with_a_launch_is_its_last_line(self):
        port = exchange.free_port()
        done = subprocess.run(["roslaunch", "-p", port, "fmbpc", "loop.launch", "loop:=nonsense"], check=False, text=True, timeout=60,
                              env={**os.environ, "ROS_MASTER_URI": f"http://localhost:{port}"}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(1, done.returncode)
        self.assertTrue(done.stdout.splitlines()[-1].startswith("fmbpc: loop 'nonsense'"), done.stdout)
        self.assertEqual(1, done.stdout.count("fmbpc: loop 'nonsense'"))

    def test_watch_ends_with_the_run(self):
        end = rospy.Publisher("run_end", String, queue_size=1, latch=True)
        end.publish("recorded")
        self.assertIn("finished", self.tool("watch").splitlines()[-1])
        end.publish("the disk is full")
        done = exchange.tool("watch", check=False)
        self.assertEqual(1, done.returncode)
        self.assertIn("ended: the disk is full", done.stdout.splitlines()[-1])


if __name__ == "__main__":
    rospy.init_node("operate")
    rostest.rosrun("fmbpc", "operate", Operate, sys.argv)
