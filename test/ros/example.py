#!/usr/bin/python3
"""The example of a plant of one's own closes its loop: every sample is recorded and the level reaches its setpoints."""
import csv
import os
import sys
import unittest

import rospy
import rostest
from std_msgs.msg import String

import ring


class Example(unittest.TestCase):
    def test_the_tank_follows_its_setpoints_inside_its_limits(self):
        folder = ring.Listener("recorded", String).wait().data
        summary = ring.summary(folder)
        self.assertEqual((240, True), (summary["steps"], summary["complete"]))
        self.assertEqual({"input": 0, "move": 0, "output": 0}, summary["violations"])
        with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
            level = [float(row["level[m]"]) for row in csv.DictReader(file)]
        self.assertAlmostEqual(0.5, level[0], delta=1e-12)
        self.assertAlmostEqual(1.0, level[119], delta=0.02)
        self.assertAlmostEqual(2.0, level[240], delta=0.02)


if __name__ == "__main__":
    rospy.init_node("example")
    rostest.rosrun("fmbpc", "example", Example, sys.argv)
