#!/usr/bin/python3
"""A recipe is held and resumed by service, a person's input that is not allowed is refused, and whatever happens only
allowed input vectors are sent."""
import csv
import os
import sys
import tempfile
import unittest

import rospy
import rostest
from fmbpc.msg import ControlAction, Measurement
from fmbpc.srv import ManualInput
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

import exchange

ALLOWED = {(0.0, 0.0, 1.0), (0.01, 0.0, 1.0), (0.02, 0.0, 1.0), (0.05, 0.0, 1.0), (0.1, 0.0, 1.0), (1.0, 0.0, 1.0),
           (1.0, 1.0, 0.0)}


def column(folder, name):
    with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    key = next(k for k in rows[0] if k.partition("[")[0] == name)
    return [float(row[key]) for row in rows if row[key]]


def service(name, kind, node="fmbpc_controller"):
    rospy.wait_for_service(f"/{node}/{name}", exchange.PATIENCE)
    return rospy.ServiceProxy(f"/{node}/{name}", kind)


class HybridHold(unittest.TestCase):
    def test_hold_resume_and_manual(self):
        recorded, actions = exchange.Listener("recorded", String), exchange.Listener("control_action", ControlAction)
        hold, manual, manual_input = service("hold", SetBool), service("manual", SetBool), service("manual_input",
                                                                                                   ManualInput)
        pause, step = service("pause", SetBool, "plant_simulator"), service("step", Trigger, "plant_simulator")
        measurements = exchange.Listener("measurement", Measurement)
        pause(True)
        self.assertEqual("recipe held", hold(True).message)
        exchange.begin()
        measurements.wait()
        for k in range(30):  # one by one, so that the recipe is held for 30 samples on any machine
            actions.wait(lambda a, k=k: a.step == k)
            self.assertTrue(step().success)
            measurements.wait(lambda m, k=k: m.step == k + 1)
        actions.wait(lambda a: a.step == 30)
        self.assertEqual("recipe running", hold(False).message)
        pause(False)
        actions.wait(lambda a: a.step >= 60)
        manual(True)
        for refused in ([0.5, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]):
            self.assertFalse(manual_input(refused).success)
        self.assertTrue(manual_input([0.1, 0.0, 1.0]).success)
        by_hand = actions.wait(lambda a: a.source == ControlAction.MANUAL and list(a.input) == [0.1, 0.0, 1.0]).step
        actions.wait(lambda a: a.step >= by_hand + 5)
        manual(False)

        folder = recorded.wait().data
        self.assertTrue(exchange.summary(folder)["complete"])
        self.assertLessEqual({tuple(a.input) for a in actions.messages}, ALLOWED)
        with tempfile.TemporaryDirectory() as reference:
            exchange.run_in_process(rospy.get_param("~loop"), reference, [])
            planned = column(reference, "T_setpoint")
        followed = column(folder, "T_setpoint")
        self.assertEqual(361, len(followed))
        self.assertEqual((30.0, 40.0), (planned[0], planned[-1]))
        late = next(k for k, value in enumerate(followed) if value != 30.0) - \
            next(k for k, value in enumerate(planned) if value != 30.0)
        self.assertEqual(31, late)  # samples 0 to 30 were answered while it was held
        self.assertEqual(planned[:361 - late], followed[late:])


if __name__ == "__main__":
    rospy.init_node("hybrid_hold")
    rostest.rosrun("fmbpc", "hybrid_hold", HybridHold, sys.argv)
