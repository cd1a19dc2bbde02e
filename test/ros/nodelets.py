#!/usr/bin/python3
"""All nodes as nodelets of one process give the run in process bit for bit, and nobody else may steer there either."""
import json
import os
import shutil
import pathlib
import subprocess
import sys
import tempfile
import unittest

import rosgraph
import rostest

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "faults"))
import contacts
import exchange
from launch_file import roslaunch


class Nodelets(unittest.TestCase):
    def setUp(self):
        self.out = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.out)

    def equal(self, loop, *sets):
        over_topics, in_process = (os.path.join(self.out, name) for name in ("topics", "process"))
        code, text = roslaunch("loop:=" + loop, "set:=" + " ".join(sets), "pace:=lockstep", "nodelets:=true", "draw:=false",
                               "out:=" + over_topics)
        self.assertEqual(0, code, text)
        self.assertTrue(os.path.isfile(os.path.join(over_topics, "summary.json")), text)
        exchange.run_in_process(loop, in_process, (*sets, "loop.pace=lockstep"))
        exchange.assert_same_run(self, over_topics, in_process)
        return text

    def test_a_law_with_its_optimizer(self):
        text = self.equal("asp_case1_clp", "sampling.duration_h=20")
        self.assertIn("/fmbpc_controller: ready", text)

    def test_a_model_that_is_identified_on_the_way(self):
        self.equal("asp_identify")

    def test_one_thread_watches_the_master_for_all_and_strangers_end_no_process(self):
        port = exchange.free_port()
        address = f"http://localhost:{port}"
        launch = subprocess.Popen(
            exchange.tied(["roslaunch", "-p", port, "fmbpc", "loop.launch", "loop:=asp_case1_clp", "set:=sampling.duration_h=2",
                       "pace:=lockstep", "nodelets:=true", "keep:=true", "draw:=false", "out:=" + self.out]),
            env={**os.environ, "ROS_MASTER_URI": address}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(exchange.killed, launch)
        master = rosgraph.Master("/nodelets_test", address)

        def serves(service):
            try:
                return bool(master.lookupService(service))
            except (rosgraph.MasterException, OSError):  # not yet
                return False
        for service in ("/plant_simulator/pause", "/fmbpc_controller/manual"):
            exchange.wait_until(lambda name=service: serves(name), service)
        self.assertEqual(1, exchange.threads(exchange.pid("/loop_manager", master)).count("master_watch"))
        for node in ("/loop_manager", "/plant_simulator"):  # the second is the process that loads
            process, ports = exchange.pid(node, master), contacts.ports(master.lookupNode(node))
            for words, port, data in contacts.killers(node):
                contacts.send(ports[port], data, answer=True)
                self.assertTrue(exchange.runs(process), f"{node}: {words}")

    def test_a_loop_that_is_wrong_ends_the_launch_in_words(self):
        code, text = roslaunch("loop:=asp_case1", "set:=model.file=nowhere.yaml", "nodelets:=true", "draw:=false",
                               "out:=" + self.out)
        self.assertNotEqual(0, code)
        self.assertIn("nowhere.yaml", text)


if __name__ == "__main__":
    rostest.rosrun("fmbpc", "nodelets", Nodelets)
