#!/usr/bin/python3
"""Pausing, stepping and resetting the plant in the middle of a run leave no trace in the result of the run that
ends."""
import sys
import tempfile
import unittest

import rospy
import rostest
from fmbpc.msg import Measurement
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

import exchange


class Interrupted(unittest.TestCase):
    def run_and_compare(self, recorded, interrupt):
        recorded.clear()
        interrupt()
        folder = recorded.wait().data
        with tempfile.TemporaryDirectory() as reference:
            exchange.run_in_process("asp_case1_clp", reference, rospy.get_param("~set").split())
            exchange.assert_same_run(self, folder, reference)

    def test_a_run_that_was_paused_stepped_and_reset_is_the_run_of_the_loop_file(self):
        recorded, measurements = exchange.Listener("recorded", String), exchange.Listener("measurement", Measurement)
        pause = rospy.ServiceProxy("plant_simulator/pause", SetBool)
        step = rospy.ServiceProxy("plant_simulator/step", Trigger)
        reset = rospy.ServiceProxy("plant_simulator/reset", Trigger)
        exchange.begin()
        first = measurements.wait(lambda m: m.step == 5).run_id

        def interrupt():
            pause(True)
            reset()
            second = measurements.wait(lambda m: m.run_id > first).run_id
            for k in range(1, 4):
                self.assertTrue(step().success)
                measurements.wait(lambda m, k=k: m.run_id == second and m.step == k)
            pause(False)
            measurements.wait(lambda m: m.run_id == second and m.step >= 6)
            pause(True)  # in the middle, wherever it is by now
            step()
            pause(False)
        self.run_and_compare(recorded, interrupt)
        self.run_and_compare(recorded, reset)  # once more after the final sample


if __name__ == "__main__":
    rospy.init_node("interrupted")
    rostest.rosrun("fmbpc", "interrupted", Interrupted, sys.argv)
