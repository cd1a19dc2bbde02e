#!/usr/bin/python3
"""A controller and an optimizer that come back between two samples that are far apart (realtime, twelve minutes): what an
operator asks of the new controller is done and stays, and as long as one is still starting nobody says that the loop runs."""
import os
import signal
import sys
import unittest

import rospy
import rostest
from fmbpc.msg import LoopState, OperatorState, Tracking
from std_srvs.srv import SetBool

import exchange

PLANT, CONTROLLER, OPTIMIZER = "/plant_simulator", "/fmbpc_controller", "/clp_optimizer"


class Comeback(unittest.TestCase):
    def setUp(self):
        self.states = exchange.Listener("loop_state", LoopState, PLANT)
        self.summary(LoopState.AUTOMATIC)

    def summary(self, mode, words=""):
        self.states.clear()
        return self.states.wait(lambda s: s.summary and s.mode == mode and words in s.reason)

    def kill(self, node):
        os.kill(exchange.pid(node), signal.SIGKILL)

    def test_1_manual_asked_of_a_controller_that_came_back_stays(self):
        manual, kept = rospy.ServiceProxy("fmbpc_controller/manual", SetBool), exchange.Listener("operator_kept", OperatorState)
        tracking = exchange.Listener("tracking", Tracking, CONTROLLER)
        tracking.clear()
        self.kill(CONTROLLER)

        def asked():
            try:
                manual.wait_for_service(exchange.PATIENCE)
                return manual(True).success
            except rospy.ServiceException:  # the one that was killed is still registered
                return False
        exchange.wait_until(asked, "manual")
        again = tracking.wait()  # the sample that the one before it had answered
        self.assertEqual(0, again.step)
        kept.wait(lambda m: m.manual and m.node == CONTROLLER)
        self.summary(LoopState.MANUAL)
        self.assertTrue(manual(False).success)
        self.summary(LoopState.AUTOMATIC)

    def test_2_who_is_starting_is_named_in_the_summary(self):
        self.kill(OPTIMIZER)
        self.summary(LoopState.DEGRADED, OPTIMIZER + ": starting: waiting for the first base action")


if __name__ == "__main__":
    rospy.init_node("comeback")
    rostest.rosrun("fmbpc", "comeback", Comeback, sys.argv)
