#!/usr/bin/python3
"""Online mode: while a loop runs, the consequents of its model learn, and the controller takes what they have learned
at a stated interval of samples."""
import re
import sys
import unittest

import rospy
import rostest
from fmbpc.msg import FuzzyModel
from std_msgs.msg import String

import exchange


class Online(unittest.TestCase):
    def test_models_come_at_the_stated_steps_and_the_loop_goes_on(self):
        models, recorded = exchange.Listener("fuzzy_model", FuzzyModel), exchange.Listener("recorded", String)
        identifier, controller = exchange.NodeStatus("fuzzy_identifier"), exchange.NodeStatus("fmbpc_controller")
        folder = recorded.wait().data
        summary = exchange.summary(folder)
        self.assertEqual((300, True), (summary["steps"], summary["complete"]))
        self.assertEqual((0, 0), (summary["violations"]["input"], summary["violations"]["move"]))
        counts = identifier.counts()
        self.assertEqual(300, counts["samples learned online"])  # all but the first, which has no past
        due = 300 // 40
        self.assertEqual(due, counts["models published"] - 1 + counts["models refused"])
        self.assertGreater(counts["models published"], 1)
        learned = [int(found.group(1)) for m in models.messages
                   if (found := re.search(r"online from (\d+) samples", m.source))]
        self.assertTrue(all(n % 40 == 0 for n in learned), learned)  # published at steps 40, 80, ...
        taken = controller.wait(lambda s: int(exchange.values(s)["models taken"]) >= 1 + len(learned))
        self.assertEqual("FM_1", exchange.values(taken)["model"])


if __name__ == "__main__":
    rospy.init_node("online")
    rostest.rosrun("fmbpc", "online", Online, sys.argv)
