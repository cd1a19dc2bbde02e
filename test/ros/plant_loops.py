#!/usr/bin/python3
"""The loops of a plant in one process give the runs of `fmbpc run --plant` bit for bit, links between them included; what happens to
one loop (its process killed, its plugin throws, its disk full) changes no bit of the others; each is stopped and replaced alone."""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import rosgraph
import rostest
import yaml
from fmbpc.srv import LoopOrderRequest

sys.path.append(str(pathlib.Path(__file__).resolve().parent))
import exchange

PLUGINS = os.path.dirname(exchange.program("fmbpc_tool"))
THROWS = {"plugins": ["throws"], "plant": {"type": "throwing"}, "sampling": {"sample_time_s": 1, "duration_h": 1},
          "controller": {"type": "pi", "loops": [{"input": "u", "output": "x", "kp": 0.1, "ki_per_h": 1}]}}


SMALL = ["-t", "tmpfs", "-o", "size=64k", "none"]
OWN_DISKS = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", f'mount {" ".join(SMALL)} "$0" && exec "$@"']  # FOLDER COMMAND
ENDLESS = {"loop": "heated_tank", "set": {"sampling.duration_h": 0, "setpoint.schedule": []}}


def small_disk(test, folder):
    """Makes a folder that is a disk of 64 kB; the words before a command that is to see it. Root mounts it: nobody has namespaces of
    users behind chroot."""
    os.makedirs(folder)
    if os.geteuid() != 0 or subprocess.run(["mount", *SMALL, folder], check=False, stderr=subprocess.DEVNULL).returncode != 0:
        return [*OWN_DISKS, folder]
    test.addCleanup(subprocess.run, ["umount", "--lazy", folder], check=True)
    return []


class Launch:
    """plant.launch on a master of its own; `before`: words before its command."""

    def __init__(self, test, plant, out, *arguments, before=()):
        port = exchange.free_port()
        self.uri = f"http://localhost:{port}"
        environment = {**os.environ, "ROS_MASTER_URI": self.uri, "FMBPC_PLUGIN_PATH": PLUGINS}
        environment.pop("DISPLAY", None)
        self.process = subprocess.Popen(
            exchange.tied([*before, "roslaunch", "-p", port, "fmbpc", "plant.launch", "plant:=" + plant, "out:=" + out, *arguments]),
            env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        test.addCleanup(exchange.killed, self.process)
        self.master = rosgraph.Master("/plant_loops_test", self.uri)

    def end(self):
        text = self.process.communicate(timeout=120)[0]
        return self.process.returncode, re.sub(r"\x1b\[[0-9;]*m", "", text)


class PlantLoops(unittest.TestCase):
    def setUp(self):
        self.out = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.out)
        self.topics, self.process = (os.path.join(self.out, name) for name in ("topics", "process"))

    def plant(self, content):
        file = os.path.join(self.out, "plant.yaml")
        pathlib.Path(file).write_text(yaml.safe_dump(content), encoding="utf-8")
        return file

    def loop(self, name, content):
        file = os.path.join(self.out, name + ".yaml")
        pathlib.Path(file).write_text(yaml.safe_dump(content), encoding="utf-8")
        return file

    def in_process(self, plant, *sets):
        exchange.tool("run", "--plant", plant, "--no-plot", "--out", self.process, *[word for s in sets for word in ("--set", s)])

    def same(self, *loops):
        for loop in loops:
            exchange.assert_same_run(self, os.path.join(self.topics, loop), os.path.join(self.process, loop))

    def shipped(self, name="jacketed_vessel", hours=6, **isolate):
        """A shipped plant in lockstep, some loops in a process of their own."""
        file = pathlib.Path(__file__).resolve().parents[2] / f"config/plant/{name}.yaml"
        content = yaml.safe_load(file.read_text(encoding="utf-8"))
        content["pace"] = "lockstep"
        content.setdefault("set", {})["sampling.duration_h"] = hours
        for loop in isolate:
            content["loops"][loop]["isolate"] = True
        return self.plant(content)

    def test_links_and_cascades_in_one_process(self):
        plant = self.shipped()
        self.in_process(plant)
        code, text = Launch(self, plant, self.topics).end()
        self.assertEqual(0, code, text)
        self.same("vessel", "jacket", "preheater")

    def test_links_and_cascades_over_processes(self):
        plant = self.shipped(vessel=True, preheater=True)
        self.in_process(plant)
        code, text = Launch(self, plant, self.topics).end()
        self.assertEqual(0, code, text)
        self.same("vessel", "jacket", "preheater")

    def test_plans_that_two_laws_tell_each_other(self):
        plant = self.shipped("four_tanks", 0.3, left=True)
        self.in_process(plant)
        code, text = Launch(self, plant, self.topics).end()
        self.assertEqual(0, code, text)
        self.same("left", "right")

    def test_faults_of_three_loops_change_no_bit_of_the_others(self):
        """One is killed, the plugin of one throws, the disk of one is full, while the others run. Each of those has a load of its own."""
        good = {f"good_{i}": {"loop": "asp_case1_clp", "set": {"sampling.duration_h": 1000, "seed": i}} for i in range(1, 13)}
        self.in_process(self.plant({"pace": "lockstep", "loops": good}))
        before = small_disk(self, os.path.join(self.topics, "full"))
        plant = self.plant({"pace": "lockstep", "loops": {
            **good, "apart": {**ENDLESS, "isolate": True}, "bad": {"loop": self.loop("bad", THROWS)},
            "full": {"loop": "asp_case1_clp", "set": {"sampling.duration_h": 200}}}})  # their names are those that start first
        launch = Launch(self, plant, self.topics, before=before)
        os.environ["ROS_MASTER_URI"] = launch.uri
        exchange.wait_until(lambda: self.state(launch, "apart")[0] == "automatic", "the isolated loop runs")
        os.kill(exchange.pid("/plant_host_apart", launch.master), signal.SIGKILL)
        self.assertFalse(all(self.recorded(loop) for loop in good), "the others run")
        text = launch.end()[1]
        for words in ("loop apart: its process was ended: Killed", "thrown by the plugin", "full/journal.bin cannot be written: No space left on device"):
            self.assertIn(words, text)
        self.assertTrue(self.recorded("bad"), text)  # what it had
        self.same(*good)

    def recorded(self, loop):
        return os.path.isfile(os.path.join(self.topics, loop, "summary.json"))

    def test_a_killed_loop_and_one_without_a_folder_are_named_and_replaced(self):
        os.makedirs(self.topics)
        pathlib.Path(self.topics, "full").touch()  # no folder can be made there
        plant = self.plant({"pace": "lockstep", "loops": {
            "apart": {**ENDLESS, "isolate": True}, "full": {"loop": "asp_case1_clp", "set": {"sampling.duration_h": 1}}}})
        launch = Launch(self, plant, self.topics, "keep:=true")
        os.environ["ROS_MASTER_URI"] = launch.uri
        exchange.wait_until(lambda: self.state(launch, "apart")[0] == "automatic", "the isolated loop runs")
        process = exchange.pid("/plant_host_apart", launch.master)
        os.kill(process, signal.SIGKILL)
        exchange.wait_until(lambda: "killed" in self.state(launch)[1].lower(), "the plant says so")
        code, words = self.state(launch)
        self.assertEqual("failed", code, words)
        self.assertIn("full", words)
        self.order(launch, LoopOrderRequest.REPLACE, "apart")
        exchange.wait_until(lambda: self.state(launch, "apart")[0] == "automatic", "it runs again")
        self.assertNotEqual(process, exchange.pid("/plant_host_apart", launch.master))
        os.unlink(os.path.join(self.topics, "full"))
        self.order(launch, LoopOrderRequest.REPLACE, "full")
        exchange.wait_until(lambda: self.recorded("full"), "the record of the replaced loop")
        self.order(launch, LoopOrderRequest.STOP, "apart")
        exchange.wait_until(lambda: "stopped: apart" in self.state(launch)[1], "the plant says that it is stopped")
        self.assertIn("success: False", self.order(launch, LoopOrderRequest.STOP, "nobody", good=False))

    @staticmethod
    def state(launch, loop=None):
        """Word and reason of the plant's state, or of a loop's."""
        done = subprocess.run(["rostopic", "echo", "-n", "4", f"/{loop}/loop_state" if loop else "/loop_state"],
                              env={**os.environ, "ROS_MASTER_URI": launch.uri}, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, timeout=30, check=False)
        for text in done.stdout.split("---\n"):
            message = yaml.safe_load(text) if text.strip() else None
            if message and message["summary"]:
                return message["word"], message["reason"]
        return "", ""

    def order(self, launch, order, loop, good=True):
        done = subprocess.run(["rosservice", "call", "/plant_host/order", f"{{order: {order}, loop: {loop}}}"],
                              env={**os.environ, "ROS_MASTER_URI": launch.uri}, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=60, check=True)
        self.assertIn(f"success: {good}", done.stdout)
        return done.stdout

    def test_what_is_of_one_loop_is_refused(self):
        for option in (["--commands", "file.yaml"], ["--on-model"]):
            done = exchange.tool("run", "--plant", "four_tanks", *option, check=False)
            self.assertNotEqual(0, done.returncode)
            self.assertIn(option[0], done.stderr)

    def test_a_wrong_file_starts_nothing(self):
        plant = self.plant({"loops": {"a": {"loop": "heated_tank", "isolated": True}}})
        code, text = Launch(self, plant, self.topics).end()
        self.assertNotEqual(0, code)
        self.assertIn("plant.yaml:", text)
        self.assertIn("loops.a.isolated", text)
        self.assertFalse(os.path.exists(self.topics))


if __name__ == "__main__":
    rostest.rosrun("fmbpc", "plant_loops", PlantLoops)
