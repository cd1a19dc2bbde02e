#!/usr/bin/python3
"""A node that is killed in the middle of a run comes back, finds what the operator asked, and no sample is lost."""
import csv
import os
import signal
import sys
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from fmbpc.msg import CommandEffect, ControlAction, Measurement, PlantState, Setpoint, Tracking
from std_msgs.msg import String

import exchange


def pid(node):
    """Process of a node; 0 while it is not there."""
    try:
        uri = rosgraph.Master(rospy.get_name()).lookupNode(node)
        return xmlrpc.client.ServerProxy(uri).getPid(rospy.get_name())[2]
    except (OSError, rosgraph.MasterException):
        return 0


class Respawn(unittest.TestCase):
    def kill_in_the_middle(self, victim):
        """Asks for x = 1900, kills the victim once that acts; returns the step from which it acts."""
        effects, active = exchange.Listener("setpoint_effect", CommandEffect), exchange.Listener("setpoint_active", Setpoint)
        actions = exchange.Listener("control_action", ControlAction)
        exchange.begin()
        actions.wait(lambda a: a.step >= 5)
        setpoint = exchange.publisher("setpoint", Setpoint, "/fmbpc_controller")
        setpoint.publish(name=["x"], value=[1900.0], mode=Setpoint.OVERRIDE)
        asked = effects.wait().step
        active.wait(lambda m: m.name == ["x"] and list(m.value) == [1900.0])
        first = pid(victim)
        if rospy.get_param("~realtime", False):
            self.miss_two_samples(first)
        os.kill(first, signal.SIGKILL)
        exchange.wait_until(lambda: pid(victim) not in (0, first), f"another {victim}")
        return asked

    def miss_two_samples(self, process):
        """However fast it comes back: it is held first until the plant has gone on without it."""
        os.kill(process, signal.SIGSTOP)
        steps = exchange.Listener("measurement", Measurement)
        stopped_at = steps.wait().step
        steps.wait(lambda m: m.step >= stopped_at + 2)

    def test_a_killed_node_comes_back_and_no_sample_is_lost(self):
        victim = rospy.get_param("~victim")
        recorded = exchange.Listener("recorded", String)
        measurements = exchange.Listener("measurement", Measurement)
        self.states, self.tracking = exchange.Listener("plant_state", PlantState), exchange.Listener("tracking", Tracking)
        asked = self.kill_in_the_middle(victim)
        if rospy.get_param("~realtime", False):
            return self.check_realtime(measurements, asked)
        folder = recorded.wait().data
        summary = exchange.summary(folder)
        self.assertEqual((100, True), (summary["steps"], summary["complete"]))
        self.assertTrue(measurements.wait(lambda m: m.step == 100).final)
        with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        column = next(name for name in rows[0] if name.startswith("x_setpoint"))
        self.assertEqual({"1900"}, {row[column] for row in rows[asked:]})
        self.assertEqual({"1800"}, {row[column] for row in rows[:asked]})


    def check_realtime(self, measurements, asked):
        """The plant does not wait: every sample is there, those without an action in time are one gap, which is marked, and
        from the return of the controller on everything is as the operator asked."""
        measurements.wait(lambda m: m.final)
        self.states.wait(lambda s: s.step == 100)
        self.tracking.wait(lambda t: t.step == 100)
        states, tracking = self.states.messages, {t.step: t for t in self.tracking.messages}
        first = min(m.step for m in measurements.messages)
        self.assertEqual(list(range(first, 101)), sorted({m.step for m in measurements.messages}))
        missing = sorted({s.step for s in states if s.input_missing and s.step > asked})
        self.assertTrue(missing)
        self.assertEqual(list(range(missing[0], missing[-1] + 1)), missing)
        self.assertLess(missing[-1], 100)
        for step in range(asked, 101):
            if step in tracking:
                self.assertEqual(1900.0, tracking[step].setpoint[1], step)
        inputs = {m.step: m.input_applied[0] for m in measurements.messages}
        self.assertTrue(all(inputs[k] == inputs[missing[0] - 1] for k in missing))  # held


if __name__ == "__main__":
    rospy.init_node("respawn")
    rostest.rosrun("fmbpc", "respawn", Respawn, sys.argv)
