#!/usr/bin/python3
"""A controller that is killed in the middle of a run comes back, finds what the operator asked, and no sample is
lost."""
import csv
import os
import signal
import sys
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from fmbpc.msg import CommandEffect, ControlAction, Measurement, Setpoint
from rosgraph_msgs.msg import Log
from std_msgs.msg import String

import ring

NODE = "/fmbpc_controller"


def pid():
    """Process of the controller; 0 while it is not there."""
    try:
        uri = rosgraph.Master(rospy.get_name()).lookupNode(NODE)
        return xmlrpc.client.ServerProxy(uri).getPid(rospy.get_name())[2]
    except (OSError, rosgraph.MasterException):
        return 0


class Respawn(unittest.TestCase):
    def test_a_killed_controller_comes_back_and_no_sample_is_lost(self):
        recorded, log = ring.Listener("recorded", String), ring.Listener("/rosout", Log)
        measurements, actions = ring.Listener("measurement", Measurement), ring.Listener("control_action", ControlAction)
        effects, active = ring.Listener("setpoint_effect", CommandEffect), ring.Listener("setpoint_active", Setpoint)
        effects.wait_for_publisher()
        actions.wait(lambda a: a.step == 5)
        setpoint = ring.publisher("setpoint", Setpoint, listeners=2)
        setpoint.publish(name=["x"], value=[1900.0], mode=Setpoint.OVERRIDE)
        asked = effects.wait().step
        active.wait(lambda m: m.name == ["x"] and list(m.value) == [1900.0])
        first = pid()
        os.kill(first, signal.SIGKILL)
        ring.wait_until(lambda: pid() not in (0, first), "another controller")
        log.wait(lambda m: m.name == NODE and "reset: first sample is" in m.msg and "first sample is 0" not in m.msg)
        log.wait(lambda m: m.name == NODE and "setpoint of x restored" in m.msg)

        folder = recorded.wait().data
        self.assertEqual(100, ring.summary(folder)["steps"])
        self.assertTrue(ring.summary(folder)["complete"])
        steps = sorted({m.step for m in measurements.messages})
        self.assertEqual(100, steps[-1])
        with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        column = next(name for name in rows[0] if name.startswith("x_setpoint"))
        self.assertEqual({"1900"}, {row[column] for row in rows[asked:]})
        self.assertEqual({"1800"}, {row[column] for row in rows[:asked]})


if __name__ == "__main__":
    rospy.init_node("respawn")
    rostest.rosrun("fmbpc", "respawn", Respawn, sys.argv)
