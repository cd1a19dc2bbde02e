#!/usr/bin/python3
"""A run over topics writes the files of the same run in one process, bit for bit."""
import sys
import tempfile
import unittest

import rospy
import rostest
from std_msgs.msg import String

import ring


class EqualToInProcess(unittest.TestCase):
    def test_trajectory_and_summary_are_those_of_the_run_in_one_process(self):
        loop, sets = rospy.get_param("~loop"), rospy.get_param("~set", "").split()
        folder = ring.Listener("recorded", String).wait(patience=150).data
        with tempfile.TemporaryDirectory() as reference:
            ring.run_in_process(loop, reference, sets)
            ring.assert_same_run(self, folder, reference)
        self.assertEqual(rospy.get_param("~steps"), ring.summary(folder)["steps"])


if __name__ == "__main__":
    rospy.init_node("equal_to_in_process")
    rostest.rosrun("fmbpc", "equal_to_in_process", EqualToInProcess, sys.argv)
