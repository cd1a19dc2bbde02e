#!/usr/bin/python3
"""`fmbpc shadow` and `handover`: a candidate of a running loop is watched, refused until it has passed, handed over, taken
back, and watched anew; every decision is an event on topics."""
import json
import os
import sys
import unittest

import roslib.packages
import rospy
import rostest
from fmbpc.msg import Tracking

import exchange


class Handover(unittest.TestCase):
    def tool(self, *words, code=0):
        done = exchange.tool(*words, check=False)
        self.assertEqual(code, done.returncode, done.stdout + done.stderr)
        return done.stdout if code == 0 else done.stderr

    def said(self, code):
        """The sample of an event."""
        return self.tracking.wait(lambda t: any(e.code == code for e in t.events)).step

    def state(self, *words):
        return json.loads(self.tool(*words, "--json"))

    def test_the_way_there_and_back(self):
        self.tracking = exchange.Listener("tracking", Tracking, connected=False)
        rospy.wait_for_service("fmbpc_controller/candidate", timeout=exchange.PATIENCE)
        exchange.begin()
        self.tracking.wait()
        self.assertEqual("watched", self.state("shadow")["state"])
        self.tool("handover", code=1)
        self.tool("handover", "--back", code=1)
        self.tool("shadow", "nobody", code=1)
        passed = self.said("candidate_passed")
        self.assertGreaterEqual(passed, 200)
        report = self.state("shadow")
        self.assertEqual(("passed", "right"), (report["state"], report["figures"]["result"]))
        self.assertIn("passed", self.tool("shadow"))
        self.assertEqual(0.25, self.state("handover")["authority"])
        self.assertGreater(self.said("hand_over"), passed)
        self.assertEqual("back", self.state("handover", "--back")["state"])
        self.said("hand_back")
        candidate = os.path.join(roslib.packages.get_pkg_dir("fmbpc"), "examples", "handover", "tank_candidate.yaml")
        self.assertEqual("watched", self.state("shadow", candidate)["state"])


if __name__ == "__main__":
    rospy.init_node("handover")
    rostest.rosrun("fmbpc", "handover", Handover, sys.argv)
