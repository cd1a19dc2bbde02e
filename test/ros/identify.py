#!/usr/bin/python3
"""The action IdentifyModel on a plant that runs an open-loop experiment: progress, result, cancel, refusals."""
import os
import sys
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from fmbpc.msg import FuzzyModel, IdentifyModelAction, IdentifyModelActionFeedback, IdentifyModelGoal, Measurement

import exchange

ACTION = "fuzzy_identifier/identify"
# Clusterings that go on for minutes, unless they are cancelled.
ENDLESS = """
name: endless
sample_time_s: 720
outputs: {s: {}, x: {}}
inputs: {q_r: {}}
disturbances: {q_i: {}, s_i: {}}
submodels:
  s: {N_y: {s: 2, x: 2}, N_u: {q_i: 2, s_i: 2, q_r: 2}, clusters: 40}
  x: {N_y: {x: 2}, N_u: {q_r: 2}, clusters: 40}
partition: {max_iterations: 100000, tolerance: 1e-14, restarts: 1000}
"""


class Identify(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.status = exchange.NodeStatus("fuzzy_identifier")
        cls.models = exchange.Listener("fuzzy_model", FuzzyModel)
        exchange.Listener("measurement", Measurement).wait(lambda m: m.step >= 900)
        cls.client = actionlib.SimpleActionClient(ACTION, IdentifyModelAction)
        cls.client.wait_for_server()
        # The client forgets what comes after the result; topics have no order.
        cls.progress = exchange.Listener(ACTION + "/feedback", IdentifyModelActionFeedback)

    def send(self, client=None, **goal):
        feedback = []
        (client or self.client).send_goal(IdentifyModelGoal(**goal), feedback_cb=feedback.append)
        return feedback

    def finish(self, client=None):
        return exchange.action_end(client or self.client)

    def test_a_goal_brings_progress_and_a_model_with_honest_figures(self):
        models = len(self.models.messages)
        self.progress.clear()
        state, result = self.finish_after(window=800)
        self.assertEqual((GoalStatus.SUCCEEDED, True), (state, result.ok), result.message)
        self.assertEqual(("asp_d", 800, True), (result.model, result.rows, result.held_out))
        self.assertEqual(["s", "x"], list(result.outputs))
        self.assertTrue(all(vaf > 95 for vaf in result.one_step_vaf), result.one_step_vaf)
        self.assertGreater(result.free_run_vaf[0], result.linear_free_run_vaf[0])
        self.assertIn("sample_time_s: 720", result.model_text)
        last = self.progress.wait(lambda m: m.feedback.share == 1.0).feedback
        self.assertEqual(("done", ["s", "x"]), (last.stage, last.validated))
        self.assertEqual(result.free_run_vaf, last.free_run_vaf)
        self.assertEqual(models, len(self.models.messages))  # nobody asked for it to be published

    def test_a_goal_may_publish_and_the_file_is_written(self):
        state, result = self.finish_after(publish=True, validation_share=-1)
        self.assertEqual((GoalStatus.SUCCEEDED, True, False), (state, result.ok, result.held_out), result.message)
        model = self.models.wait(lambda m: m.name == "asp_d")
        self.assertEqual(["s", "x"], [o.name for o in model.outputs])
        self.assertIn("Identified from the running plant activated_sludge", model.source)
        path = os.path.join(rospy.get_param("fuzzy_identifier/out"), "model.yaml")
        self.assertIn("asp_d", exchange.tool("model", path).stdout)
        self.status.wait(lambda s: exchange.values(s)["models published"] == "1" and "published" in s.message)

    def finish_after(self, **goal):
        self.send(**goal)
        return self.finish()

    def test_cancel_ends_an_identification_at_once_and_the_next_goal_is_served(self):
        feedback = self.send(structure=ENDLESS, publish=True)
        exchange.wait_until(lambda: any(f.iteration > 0 for f in feedback), "an iteration of the clustering")
        self.status.wait(lambda s: s.message.startswith("identifying: s clusters"))
        other = actionlib.SimpleActionClient(ACTION, IdentifyModelAction)
        other.wait_for_server()
        self.send(other)
        state, result = self.finish(other)
        self.assertEqual((GoalStatus.REJECTED, False), (state, result.ok))
        self.assertIn("another identification is running", result.message)
        self.client.cancel_goal()
        state, result = self.finish()
        self.assertEqual((GoalStatus.PREEMPTED, False, "cancelled"), (state, result.ok, result.message))
        self.assertNotIn("endless", [m.name for m in self.models.messages])
        self.assertEqual(GoalStatus.SUCCEEDED, self.finish_after(window=500)[0])

    def test_what_cannot_be_identified_is_refused_in_words(self):
        for goal, state, words in (
                ({"structure": "name: [bad"}, GoalStatus.REJECTED, "goal.structure"),
                ({"structure": ENDLESS.replace("q_r", "pump")}, GoalStatus.REJECTED, "pump"),
                ({"structure": ENDLESS.replace("720", "60")}, GoalStatus.REJECTED, "sample_time_s"),
                ({"validation_share": 2.0}, GoalStatus.REJECTED, "validation_share"),
                ({"window": 12}, GoalStatus.ABORTED, "rows")):
            got, result = self.finish_after(**goal)
            self.assertEqual((state, False), (got, result.ok), result.message)
            self.assertIn(words, result.message)
        said = self.status.wait(lambda s: exchange.values(s).get("code") == "identification_failed")  # of the last one, the loop goes on
        self.assertIn("rows", said.message)

    def test_diagnostics_say_what_was_collected(self):
        values = exchange.values(self.status.wait())
        self.assertGreaterEqual(int(values["samples collected"]), 900)
        self.assertEqual(("0", "0", "1"), (values["samples missing"], values["samples incomplete"], values["runs"]))


if __name__ == "__main__":
    rospy.init_node("identify")
    rostest.rosrun("fmbpc", "identify", Identify, sys.argv)
