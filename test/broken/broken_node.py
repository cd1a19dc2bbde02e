#!/usr/bin/python3
"""A node whose assertion does not hold: test/counting_test.py runs it through rostest to see that the count notices."""
import sys
import unittest

import rospy
import rostest


class Broken(unittest.TestCase):
    def test_assertion_that_does_not_hold(self):
        self.assertEqual(1, 2)


if __name__ == "__main__":
    rospy.init_node("broken")
    rostest.rosrun("fmbpc", "broken", Broken, sys.argv)
