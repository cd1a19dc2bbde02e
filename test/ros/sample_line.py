#!/usr/bin/python3
"""The delay of a measurement is that of the tf tree: the run over topics is the run in one process with the frames there."""
import sys
import tempfile
import unittest

import rospy
import rostest
from std_msgs.msg import String

import exchange


class SampleLine(unittest.TestCase):
    def test_the_run_is_that_of_the_same_line_in_one_process(self):
        loop, sets = rospy.get_param("~loop"), rospy.get_param("~set", "").split()
        folder = exchange.Listener("recorded", String).wait(patience=150).data
        with tempfile.TemporaryDirectory() as reference:
            exchange.run_in_process(loop, reference, sets)
            exchange.assert_same_run(self, folder, reference)
        self.assertEqual(rospy.get_param("~steps"), exchange.summary(folder)["steps"])
        column = [row.split(",")[1] for row in exchange.trajectory(folder)[1:]]
        first_move = next(k for k, value in enumerate(column) if value != column[0])
        # u(0) moves the reactor by sample 1; the sample line shows it so many samples later
        self.assertEqual(rospy.get_param("~delay"), first_move - 1)


if __name__ == "__main__":
    rospy.init_node("sample_line")
    rostest.rosrun("fmbpc", "sample_line", SampleLine, sys.argv)
