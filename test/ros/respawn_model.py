#!/usr/bin/python3
"""A controller that is killed gets back the model that was learned while the loop ran, and the settings that a person changed; so does
the identifier that learns."""
import os
import signal
import sys
import unittest

import dynamic_reconfigure.client
import rospy
import rostest
from fmbpc.msg import ControlAction, FuzzyModel, OperatorState
from std_srvs.srv import SetBool

import exchange

SETTINGS = {"coincidence_steps": 17}


def learned(model):
    return "online from" in model.source


class RespawnModel(unittest.TestCase):
    def setUp(self):
        self.models = exchange.Listener("fuzzy_model", FuzzyModel)
        self.actions = exchange.Listener("control_action", ControlAction)
        self.controller = exchange.NodeStatus("fmbpc_controller")
        self.kept = exchange.Listener("operator_kept", OperatorState)
        self.pause = rospy.ServiceProxy("plant_simulator/pause", SetBool)

    def respawned(self, node):
        """Kills it and waits for the next one."""
        first = exchange.pid(node)
        os.kill(first, signal.SIGKILL)

        def another():
            try:
                return exchange.pid(node) not in (0, first)
            except Exception:  # it is not there, or half there
                return False
        exchange.wait_until(another, f"another {node}")

    def settings(self):
        return dynamic_reconfigure.client.Client("fmbpc_controller", timeout=exchange.PATIENCE)

    def test_model_and_settings_are_back(self):
        exchange.begin()
        self.actions.wait(lambda a: a.step >= 2)
        last = self.models.wait(learned)
        self.actions.wait(lambda a: a.step > last.step + 2)
        client = self.settings()
        self.assertNotEqual(SETTINGS["coincidence_steps"], client.get_configuration()["coincidence_steps"])
        client.update_configuration(SETTINGS)
        self.kept.wait(lambda k: "coincidence_steps" in k.setting)
        self.pause(True)
        step, model = self.actions.messages[-1].step, self.models.messages[-1]
        self.assertTrue(learned(model))
        self.respawned("/fmbpc_controller")
        self.pause(False)
        self.actions.wait(lambda a: a.step > step + 1)
        back = exchange.values(self.controller.wait(lambda s: "model source" in exchange.values(s)))
        self.assertIn("online from", back["model source"])
        self.assertIn(back["model source"], [m.source for m in self.models.messages])
        shown = self.settings().get_configuration(timeout=exchange.PATIENCE)
        self.assertEqual(SETTINGS["coincidence_steps"], shown["coincidence_steps"])

        self.models.clear()
        self.respawned("/fuzzy_identifier")
        again = self.models.wait()
        self.assertTrue(learned(again), again.source)


if __name__ == "__main__":
    rospy.init_node("respawn_model")
    rostest.rosrun("fmbpc", "respawn_model", RespawnModel, sys.argv)
