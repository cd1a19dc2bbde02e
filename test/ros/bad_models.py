#!/usr/bin/python3
"""Models that must not take over are published into a running loop: each is refused with the reason, and the run stays
the same, bit for bit, as if nothing had come."""
import copy
import math
import sys
import tempfile
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from fmbpc.msg import FuzzyModel, Measurement
from std_msgs.msg import String

import exchange


def spoiled(good):
    """(model, words of its refusal)"""
    def variant(name):
        model = copy.deepcopy(good)
        model.name = name
        return model
    model = variant("nan")
    model.submodels[1].rules[0].coefficients = [math.nan] * len(model.submodels[1].rules[0].coefficients)
    yield model, "finite"
    model = variant("names")
    model.inputs[0].name = "pump"
    yield model, "pump"
    model = variant("units")
    model.outputs[0].unit = "g/l"
    yield model, "g/l"
    model = variant("sizes")
    model.submodels[0].rules[0].coefficients = [1.0]
    yield model, "coefficients"
    model = variant("slow")
    model.sample_time_s = 60.0
    yield model, "sample_time_s"
    model = variant("unstable")
    for submodel in model.submodels:
        for rule in submodel.rules:
            rule.coefficients = [3.0] * len(rule.coefficients)
    yield model, "model.max_pole"
    yield FuzzyModel(name="empty"), ""


class BadModels(unittest.TestCase):
    def test_each_is_refused_and_the_loop_goes_on_with_the_old_one(self):
        loop, sets = rospy.get_param("~loop"), rospy.get_param("~set").split()
        recorded, status = exchange.Listener("recorded", String), exchange.NodeStatus("fmbpc_controller")
        good = exchange.Listener("fuzzy_model", FuzzyModel, "/fuzzy_identifier").wait(lambda m: m.name == "FM_1")
        publisher = exchange.publisher("fuzzy_model", FuzzyModel, "/fmbpc_controller")
        exchange.Listener("measurement", Measurement).wait(lambda m: m.step >= 5)
        for count, (model, words) in enumerate(spoiled(good), 1):
            publisher.publish(model)
            # Counters are of now, the words change with hysteresis: both must come to this model.
            said = status.wait(lambda s, n=count, w=words: exchange.values(s).get("refused: fuzzy_model") == str(n) and
                               exchange.values(s)["code"] == "model_refused" and w in s.message)
            self.assertEqual(DiagnosticStatus.WARN, said.level)
            self.assertEqual(("FM_1", "1"), (exchange.values(said)["model"], exchange.values(said)["models taken"]))
        folder = recorded.wait().data
        self.assertEqual({"input": 0, "move": 0, "output": 0}, exchange.summary(folder)["violations"])
        with tempfile.TemporaryDirectory() as reference:
            exchange.run_in_process(loop, reference, sets)
            exchange.assert_same_run(self, folder, reference, beyond="model_refused")
        said = exchange.summary(folder)["events"]
        self.assertIn("model_refused", [e["code"] for e in said], said)


if __name__ == "__main__":
    rospy.init_node("bad_models")
    rostest.rosrun("fmbpc", "bad_models", BadModels, sys.argv)
