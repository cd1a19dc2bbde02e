#!/usr/bin/python3
"""Excite a plant, record it, identify by action, and hand the model over to a loop that runs: the input goes on without
a bump, limits hold, and the biomass follows its setpoint better than under FM_1 on the same disturbances."""
import csv
import os
import sys
import tempfile
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from fmbpc.msg import FuzzyModel, IdentifyModelAction, IdentifyModelActionFeedback, IdentifyModelGoal, Measurement
from rosgraph_msgs.msg import Log
from std_msgs.msg import String
from std_srvs.srv import SetBool

import exchange


def rows(folder):
    with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
        return [{name.split("[")[0]: float(value) for name, value in row.items() if value and name.split("[")[0] in
                 ("x", "x_setpoint", "x_reference", "q_r")} for row in csv.DictReader(file)]


def ise(run, first, path):
    return sum((row["x"] - row[path]) ** 2 for row in run[first:])


class HotSwap(unittest.TestCase):
    def identified(self):
        """The model of the experiment, which has run to its end."""
        exchange.Listener("experiment/measurement", Measurement).wait(lambda m: m.final)
        client = actionlib.SimpleActionClient("experiment/fuzzy_identifier/identify", IdentifyModelAction)
        client.wait_for_server()
        models = exchange.Listener("experiment/fuzzy_model", FuzzyModel)
        progress = exchange.Listener("experiment/fuzzy_identifier/identify/feedback", IdentifyModelActionFeedback)
        client.send_goal(IdentifyModelGoal(publish=True))
        state, result = exchange.action_end(client, patience=180)
        self.assertEqual((GoalStatus.SUCCEEDED, True), (state, result.ok), result.message)
        progress.wait(lambda m: m.feedback.stage == "done")
        print("held out, free run:", dict(zip(result.outputs, result.free_run_vaf)), "linear", result.linear_free_run_vaf)
        return models.wait()

    def test_the_own_model_takes_over_and_tracks_better(self):
        recorded, log = exchange.Listener("recorded", String), exchange.Listener("/rosout", Log, "/fmbpc_controller")
        measurements = exchange.Listener("measurement", Measurement)
        model = self.identified()
        pause = rospy.ServiceProxy("plant_simulator/pause", SetBool)
        publisher = exchange.publisher("fuzzy_model", FuzzyModel, "/fmbpc_controller")
        exchange.begin()  # now the loop may begin
        measurements.wait(lambda m: m.step >= 60)
        pause(True)
        publisher.publish(model)
        log.wait(lambda m: m.name == "/fmbpc_controller" and f"model {model.name} from the next sample on" in m.msg)
        swap = measurements.messages[-1].step
        pause(False)
        folder = recorded.wait().data
        summary = exchange.summary(folder)
        self.assertTrue(summary["complete"])
        self.assertEqual((0, 0), (summary["violations"]["input"], summary["violations"]["move"]))
        own = rows(folder)
        with tempfile.TemporaryDirectory() as reference:
            exchange.run_in_process(rospy.get_param("~loop"), reference, [])
            fm_1 = rows(reference)
        self.assertEqual(fm_1[:swap], own[:swap])  # the same run until then
        at = next(k for k, (a, b) in enumerate(zip(fm_1, own)) if a != b)
        self.assertAlmostEqual(fm_1[at - 1]["q_r"], own[at - 1]["q_r"], delta=1e-9)
        for path, share in (("x_setpoint", 1.0), ("x_reference", 0.8)):  # the law follows the reference
            there, here = ise(fm_1, swap, path), ise(own, swap, path)
            print(f"from sample {swap} on, squared errors to {path}: FM_1 {there:.4g}, own model {here:.4g}")
            self.assertLess(here, share * there, path)


if __name__ == "__main__":
    rospy.init_node("hot_swap")
    rostest.rosrun("fmbpc", "hot_swap", HotSwap, sys.argv)
