#!/usr/bin/python3
"""The example of a plant of one's own behind the gateway: every sample is recorded, the level reaches its setpoints, and
what the tank was told kept all limits. A second publisher of its level is refused and named, so is whoever commands the tank
beside the gateway; values of who may not speak for the tank do not count; and a stranger neither takes the
plant into its own hand nor sets its level where the loop names who may. The master lists each node of ours for the topics
that it hears, and no others."""
import csv
import math
import os
import subprocess
import sys
import unittest

import rosgraph
import rospy
import rostest
from fmbpc.msg import LoopState, Measurement
from std_msgs.msg import Bool, Float64, String

import exchange


class Example(unittest.TestCase):
    def test_the_tank_follows_its_setpoints_inside_its_limits(self):
        efforts = exchange.Listener("tank/control_effort", Float64, "/plant_gateway")
        states = exchange.Listener("loop_state", LoopState, "/plant_gateway")
        measurements, recorded = exchange.Listener("measurement", Measurement), exchange.Listener("recorded", String)
        liar = exchange.publisher("tank/state", Float64, "/plant_gateway")
        liar.publish(math.nan)  # a lie among the truth
        measurements.wait(lambda m: math.isfinite(m.outputs[0]))

        def said():
            liar.publish(3.9)
            return any(s.summary and s.mode == LoopState.DEGRADED and
                       "/tank/state has two publishers: /example_plant counts" in s.reason for s in list(states.messages))
        exchange.wait_until(said, "the second publisher to be named")
        counts = {"refused: enable from /example", "refused: setpoint from /example"}
        enable, level = (exchange.publisher(f"tank/{name}", kind, "/plant_gateway")
                         for name, kind in (("pid_enable", Bool), ("setpoint", Float64)))
        enable.publish(False)
        level.publish(3.0)
        stranger = subprocess.Popen(["rostopic", "pub", "-r", "10", "/tank/state", "std_msgs/Float64", "3.9"],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(stranger.kill)
        status = exchange.NodeStatus("plant_gateway")
        status.wait(lambda s: all(int(exchange.values(s).get(key, 0)) > 0 for key in counts))
        status.wait(lambda s: any(key.startswith("refused: tags from /rostopic") for key in exchange.values(s)))
        stranger.kill()
        other = exchange.publisher("tank/control_effort", Float64, "/plant_gateway")

        def seen():
            other.publish(efforts.messages[-1])
            return any(s.summary and s.mode == LoopState.DEGRADED and
                       "/tank/control_effort is published by /example as well" in s.reason for s in list(states.messages))
        exchange.wait_until(seen, "the stranger that commands the tank to be named")
        folder = recorded.wait().data
        summary = exchange.summary(folder)
        nodes = ("/fmbpc_controller", "/loop_recorder", "/plant_gateway")
        listeners = rosgraph.Master(rospy.get_name()).getSystemState()[1]
        for node in nodes:
            own = {topic for topic, _ in exchange.slave(node).getSubscriptions(rospy.get_name())[2]}
            self.assertEqual(own, {topic for topic, names in listeners if node in names}, node)
        self.assertEqual((240, True), (summary["steps"], summary["complete"]))
        self.assertEqual({"input": 0, "move": 0, "output": 0}, summary["violations"])
        with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
            level = [float(row["level[m]"]) for row in csv.DictReader(file)]
        self.assertAlmostEqual(1.0, level[119], delta=0.02)
        self.assertAlmostEqual(2.0, level[240], delta=0.02)
        told = [message.data for message in efforts.messages]
        self.assertGreater(len(told), 100)
        self.assertTrue(all(0.0 <= value <= 20.0 for value in told))
        self.assertLessEqual(max(abs(b - a) for a, b in zip(told, told[1:])), 2.0 + 1e-9)


if __name__ == "__main__":
    rospy.init_node("example")
    rostest.rosrun("fmbpc", "example", Example, sys.argv)
