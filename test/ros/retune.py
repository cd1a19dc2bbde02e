#!/usr/bin/python3
"""Weights and horizon of a running controller are changed through dynamic_reconfigure: at rest nothing moves, in the middle
of a move the input goes on as the old law would have had it, and afterwards the new settings rule."""
import csv
import os
import sys
import tempfile
import unittest

import dynamic_reconfigure.client
import rospy
import rostest
from fmbpc.msg import ControlAction, Measurement
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

import exchange

REST, MOVE = 290, 304  # samples from which new settings act; the setpoint steps at 300
CALM = {"horizon_steps": 30, "weight_move": "I=300"}
QUICK = {"horizon_steps": 12, "weight_move": "I=0.1"}


def inputs(folder):
    with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
        return [float(row["I[A]"]) for row in csv.DictReader(file) if row["I[A]"]]


class Retune(unittest.TestCase):
    def setUp(self):
        self.measurements = exchange.Listener("measurement", Measurement)
        self.actions = exchange.Listener("control_action", ControlAction)
        self.pause = rospy.ServiceProxy("plant_simulator/pause", SetBool)
        self.step = rospy.ServiceProxy("plant_simulator/step", Trigger)

    def go_to(self, sample):
        """Paused, with `sample` answered."""
        while self.measurements.messages[-1].step < sample:
            before = self.measurements.messages[-1].step
            self.assertTrue(self.step().success)
            self.measurements.wait(lambda m: m.step > before)
        self.actions.wait(lambda a: a.step >= sample)

    def in_process(self, settings):
        with tempfile.TemporaryDirectory() as folder:
            exchange.run_in_process("surge_tank_steps", folder, [f"controller.{k}={v}" for k, v in settings.items()])
            return inputs(folder)

    def test_settings_change_without_a_bump_and_take_effect(self):
        recorded = exchange.Listener("recorded", String)
        rospy.wait_for_service("plant_simulator/pause")
        self.pause(True)
        exchange.begin()  # now the loop may begin
        client = dynamic_reconfigure.client.Client("fmbpc_controller", timeout=exchange.PATIENCE)
        shown = client.get_configuration(timeout=exchange.PATIENCE)
        self.assertEqual((20, 1, "H=1", "I=1"), tuple(shown[key] for key in (
            "horizon_steps", "move_steps", "weight_output", "weight_move")))
        self.measurements.wait()
        self.go_to(REST - 1)
        self.assertEqual("I=300", client.update_configuration(CALM)["weight_move"])
        status = exchange.NodeStatus("fmbpc_controller")
        refused = client.update_configuration({"weight_move": "H=2"})
        counted = exchange.values(status.wait(lambda s: "refused: settings" in exchange.values(s)))
        self.assertEqual("1", counted["refused: settings"])
        self.assertEqual(("I=300", 30), (refused["weight_move"], refused["horizon_steps"]))
        self.go_to(MOVE - 1)
        self.assertEqual(12, client.update_configuration(QUICK)["horizon_steps"])
        self.pause(False)
        folder = recorded.wait().data
        summary = exchange.summary(folder)
        self.assertTrue(summary["complete"])
        self.assertEqual((0, 0), (summary["violations"]["input"], summary["violations"]["move"]))
        run, first = inputs(folder), self.in_process({})
        calm, quick = (self.in_process({"horizon_steps": s["horizon_steps"],
                                        "weight_move": "{I: " + s["weight_move"][2:] + "}"}) for s in (CALM, QUICK))
        self.assertEqual(first[:REST], run[:REST])
        bump = max(abs(u - first[REST - 1]) for u in run[REST:300])
        print(f"at rest the input moves by {bump:.3g} A")
        self.assertLess(bump, 3e-8)  # 1e-6 of the range
        self.assertLess(max(abs(a - b) for a, b in zip(run[300:MOVE + 1], calm[300:MOVE + 1])), 3e-8)
        self.assertGreater(abs(run[300] - first[300]), 1e-4)  # the settings act
        print(f"input at {MOVE}: {run[MOVE]:.6g}, calm law {calm[MOVE]:.6g}; next {run[MOVE + 1]:.6g}, {calm[MOVE + 1]:.6g}")
        self.assertGreater(abs(run[MOVE + 1] - calm[MOVE + 1]), 1e-6)  # and so do the second ones
        late = slice(600, 615)  # the next step of the setpoint is met by the last settings alone
        self.assertLess(max(abs(a - b) for a, b in zip(run[late], quick[late])), 3e-8)


if __name__ == "__main__":
    rospy.init_node("retune")
    rostest.rosrun("fmbpc", "retune", Retune, sys.argv)
