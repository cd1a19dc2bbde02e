#!/usr/bin/python3
"""An exported law has the valve, behind the Modbus gateway: ROS gives setpoints, and when all its nodes are killed the law goes on within its
limits."""
import json
import os
import signal
import subprocess
import tempfile
import unittest

import rospy
import rostest
from fmbpc.msg import Setpoint

import exchange

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")
LOWER, UPPER, MOVE = 0.0, 200.0, 4.0
AUTOMATIC, CASCADE = 2, 3


class PlcLaw(unittest.TestCase):
    def lines(self):
        with open(self.log.name, encoding="utf-8") as file:
            return [line for line in map(json.loads, (text for text in file if text.endswith("\n"))) if "moved" in line]

    def await_line(self, condition, what, since=0):
        exchange.wait_until(lambda: any(condition(line) for line in self.lines()[since:]), what)

    def test_the_law_goes_on_when_ros_is_killed(self):
        folder, self.log, port = tempfile.mkdtemp(), tempfile.NamedTemporaryFile(suffix=".jsonl"), exchange.free_port()
        exchange.tool("export", "cstr_modbus", "--to", "c99", "--samples", "10", "--out", folder)
        plc = subprocess.Popen(exchange.tied(["/usr/bin/python3", os.path.join(SCRIPTS, "soft_plc.py"), "--port", str(port), "--log", self.log.name,
                                          "--law", folder]), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(exchange.killed, plc)
        launch = subprocess.Popen(
            exchange.tied(["roslaunch", "--wait", "fmbpc", "loop.launch", "loop:=cstr_plc", f"set:=gateway.modbus.port={port} sampling.duration_h=0",
                       "draw:=false", "sim_time:=false", f"out:={tempfile.mkdtemp()}"]), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(exchange.killed, launch)
        self.await_line(lambda line: line["state"] == CASCADE, "the law in cascade")
        asked = rospy.Publisher("setpoint", Setpoint, queue_size=1, latch=True)
        asked.publish(name=["CA"], value=[0.08], mode=1)
        self.await_line(lambda line: abs(line["setpoint"] - 0.08) < 1e-3, "the setpoint in the PLC")

        nodes = [exchange.pid(node) for node in ("/plant_gateway", "/fmbpc_controller")]
        for node in ("/plant_simulator", "/loop_recorder", "/end_launch"):  # the run has no end, and neither have they
            exchange.wait_until(lambda: exchange.is_registered(node), node)  # pylint: disable=cell-var-from-loop
            self.addCleanup(os.kill, exchange.pid(node), signal.SIGKILL)
        os.kill(launch.pid, signal.SIGKILL)
        for node in nodes:
            os.kill(node, signal.SIGKILL)
        killed = len(self.lines())
        self.await_line(lambda line: line["state"] == AUTOMATIC, "the law on its own", killed)
        exchange.wait_until(lambda: len(self.lines()) > killed + 200, "200 samples without ROS")
        lines = self.lines()
        self.assertIsNone(plc.poll())
        for line in lines:
            self.assertTrue(LOWER <= line["flow"] <= UPPER and line["moved"] <= MOVE + 1e-9, line)
        last = lines[-1]
        self.assertEqual((AUTOMATIC, True), (last["state"], abs(last["setpoint"] - 0.08) < 1e-3))
        self.assertLess(abs(last["CA"] - last["setpoint"]), 0.004, last)


if __name__ == "__main__":
    rospy.init_node("plc_law_test")
    rostest.rosrun("fmbpc", "plc_law", PlcLaw)
