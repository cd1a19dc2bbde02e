#!/usr/bin/python3
"""What becomes of a run that does not go as it should: folders that cannot be used, a recorder that dies, nodes without
a loop. Each launch has a master of its own."""
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rosgraph
import rosnode
import rospy
import rostest
from fmbpc.msg import LoopState

import exchange

# Debian 11's roslaunch asks its own thread by a name that its Python knows no more, and says so at its end.
OLD_ROSLAUNCH = re.compile(r"exception in shutdown_process_monitor: .*\nTraceback .*\n(?:  .*\n)+AttributeError: 'ProcessMonitor' object .*\n")


class Launch:
    """loop.launch as a person types it; what it has said is in text()."""

    def __init__(self, test, *arguments):
        port = exchange.free_port()
        self.uri = f"http://localhost:{port}"
        self.log = tempfile.NamedTemporaryFile("w")
        command = ["roslaunch", "-p", port, "fmbpc", "loop.launch", "draw:=false", *arguments]
        self.process = subprocess.Popen(exchange.tied(command), env={**os.environ, "ROS_MASTER_URI": self.uri}, stdout=self.log,
                                        stderr=subprocess.STDOUT, text=True)
        test.addCleanup(self.log.close)
        test.addCleanup(exchange.killed, self.process)

    def text(self):
        with open(self.log.name, encoding="utf-8") as log:  # not by the handle that the launch writes with
            return re.sub(r"\x1b\[[0-9;]*m", "", log.read())

    def pid(self, node):
        return exchange.pid(node, rosgraph.Master("/records", self.uri))

    def end(self, patience=exchange.PATIENCE):
        self.process.wait(patience)
        return self.text()


def holds_samples(journal):
    """Something stands behind the header and the text of the loop, whose length is in the header."""
    try:
        with open(journal, "rb") as file:
            header = file.read(80)
        return len(header) == 80 and os.path.getsize(journal) > 80 + struct.unpack_from("=Q", header, 56)[0]
    except OSError:
        return False


class Records(unittest.TestCase):
    def setUp(self):
        self.out = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.out)

    def summary(self, *folder):
        with open(os.path.join(self.out, *folder, "summary.json"), encoding="utf-8") as file:
            return json.load(file)

    def test_a_folder_that_cannot_be_used_starts_nothing(self):
        launch = Launch(self, "loop:=asp_case1", "out:=/dev/null/x")
        launch.end(20)
        why = "out:=/dev/null/x: expected a folder that can be written: /dev/null is no folder"
        exchange.wait_until(lambda: why in launch.text(), "the reason, which comes last")
        text = launch.text()
        self.assertNotIn("process[", text)

    def test_a_recorder_whose_folder_cannot_be_used_says_so_and_is_not_ready(self):
        rospy.set_param("useless/loop_recorder/out", "/dev/null/x")
        rospy.set_param("useless/loop_recorder/stay", True)
        recorder = subprocess.Popen(exchange.tied([exchange.program("loop_recorder"), "__ns:=useless"]), stderr=subprocess.PIPE,
                                    text=True)
        self.addCleanup(recorder.stderr.close)
        self.addCleanup(exchange.killed, recorder)
        states = exchange.Listener("useless/loop_state", LoopState, connected=False)
        state = states.wait(lambda s: s.mode == LoopState.FAILED)
        self.assertEqual("/useless/loop_recorder", state.node)
        self.assertEqual("recording_failed", state.code)
        self.assertIn("/dev/null/x", state.reason)

    def test_a_node_that_cannot_read_its_loop_says_so_on_loop_state(self):
        rospy.set_param("garbage/loop_text", "plant: [")
        states = exchange.Listener("garbage/loop_state", LoopState, connected=False)
        controller = subprocess.Popen(exchange.tied([exchange.program("fmbpc_controller"), "__ns:=garbage"]),
                                      stderr=subprocess.DEVNULL)
        self.addCleanup(exchange.killed, controller)
        state = states.wait(lambda s: s.mode == LoopState.FAILED)
        self.assertEqual("/garbage/fmbpc_controller", state.node)
        self.assertEqual("cannot_start", state.code)
        self.assertEqual(1, controller.wait(exchange.PATIENCE))

    def test_a_recorder_that_dies_ends_the_launch_with_the_files_of_what_it_had(self):
        launch = Launch(self, "loop:=asp_case1_clp", "set:=sampling.duration_h=15", "speedup:=14400", "out:=" + self.out)
        journal = os.path.join(self.out, "journal.bin")
        exchange.wait_until(lambda: holds_samples(journal), "samples on disk")
        os.kill(launch.pid("/loop_recorder"), signal.SIGKILL)
        text = launch.end()
        self.assertIn("loop_recorder is gone", text)
        summary = self.summary()
        self.assertFalse(summary["complete"])
        self.assertEqual("asp_case1_clp", summary["loop"])
        self.assertGreater(summary["steps"], 0)
        self.assertFalse(os.path.exists(journal))
        again = exchange.tool("recover", self.out, check=False)
        self.assertEqual(1, again.returncode)
        self.assertIn("expected a journal.bin", again.stderr)

    def assert_whole(self, steps, text):
        """Record and bag, in the one folder, of a run of so many samples."""
        summary = self.summary()
        self.assertEqual((steps, True), (summary["steps"], summary["complete"]), text)
        with open(os.path.join(self.out, "trajectory.csv"), encoding="utf-8") as file:
            self.assertEqual(steps + 2, len(file.readlines()))
        self.assertEqual([], [name for name in ("journal.bin", "history", "loop.bag.active", "loop.bag.joined")
                              if os.path.exists(os.path.join(self.out, name))])
        done = exchange.tool("replay", os.path.join(self.out, "loop.bag"), "--json", check=False)
        replayed = json.loads(done.stdout)
        self.assertEqual((0, True, True, 0, steps + 1), (done.returncode, replayed["equal"], replayed["ended"],
                                                         replayed["missing_samples"], replayed["measurements"]), done.stdout)

    def comes_back(self, launch, end):
        """`end` ends the recorder, and another one goes on."""
        journal = os.path.join(self.out, "journal.bin")
        exchange.wait_until(lambda: holds_samples(journal), "samples on disk")
        before = launch.pid("/loop_recorder")
        end()
        exchange.wait_until(lambda: not exchange.runs(before), "its end")
        size = os.path.getsize(journal)
        exchange.wait_until(lambda: os.path.getsize(journal) > size, "samples of the one that came back")

    def test_a_recorder_that_is_told_to_end_in_mid_run_and_comes_back_has_all_samples_in_record_and_bag(self):
        launch = Launch(self, "loop:=asp_case1_clp", "set:=sampling.duration_h=60", "speedup:=14400", "out:=" + self.out,
                        "record:=true", "respawn:=true")
        for _ in range(2):
            self.comes_back(launch, lambda: subprocess.run(["rosnode", "kill", "/loop_recorder"], check=True, stdout=subprocess.DEVNULL,
                                                           env={**os.environ, "ROS_MASTER_URI": launch.uri}))
            self.comes_back(launch, lambda: os.kill(launch.pid("/loop_recorder"), signal.SIGINT))
        self.assert_whole(300, launch.end())

    def test_a_node_of_the_recorders_name_goes_on_with_record_and_bag(self):
        launch = Launch(self, "loop:=asp_case1_clp", "set:=sampling.duration_h=40", "speedup:=14400", "out:=" + self.out, "record:=true")

        def start():
            other = subprocess.Popen(exchange.tied([exchange.program("loop_recorder"), "__name:=loop_recorder", "/clock:=clock"]),
                                     env={**os.environ, "ROS_MASTER_URI": launch.uri}, stderr=subprocess.DEVNULL)
            self.addCleanup(exchange.killed, other)
        self.comes_back(launch, start)
        self.assert_whole(200, launch.end())

    def test_an_endless_run_is_filed_in_parts_each_with_its_bag(self):
        launch = Launch(self, "loop:=asp_case1_clp", "set:=sampling.duration_h=0 disturbance.source=constant", "speedup:=144000", "out:=" + self.out, "record:=true")
        history = os.path.join(self.out, "history")
        exchange.wait_until(lambda: os.path.isdir(history) and os.listdir(history), "the third part of a day", 3 * exchange.PATIENCE)
        launch.process.send_signal(signal.SIGINT)
        text = launch.end()
        first = 0
        run = str(self.summary()["run_id"])
        parts = [os.path.join("history", run), *(os.path.join("history", f"{run}-{n}") for n in range(2, len(os.listdir(history)) + 1)), "."]
        for part in parts:
            with open(os.path.join(self.out, part, "trajectory.csv"), encoding="utf-8") as file:
                rows = len(file.readlines()) - 1
            with rosbag.Bag(os.path.join(self.out, part, "loop.bag")) as bag:
                steps = {message.step for _, message, _ in bag.read_messages("/measurement")}
                topics = bag.get_type_and_topic_info().topics
            self.assertGreaterEqual(steps, set(range(first, first + rows)), f"{part}: {text}")
            self.assertLess(max(steps), first + rows + 3, part)
            self.assertLessEqual({"/loop_text", "/plant_info", "/fuzzy_model"}, set(topics), part)
            first += rows
        self.assertGreater(first, 240)

    def test_a_plant_that_is_told_to_end_says_so_last(self):
        states = exchange.Listener("useless/loop_state", LoopState, connected=False)
        for end in (lambda: os.kill(plant.pid, signal.SIGINT), lambda: rosnode.kill_nodes(["/useless/plant_simulator"])):
            plant = subprocess.Popen(exchange.tied([exchange.program("plant_simulator"), "__ns:=useless"]), stderr=subprocess.DEVNULL)
            self.addCleanup(exchange.killed, plant)
            states.clear()
            states.wait(lambda s: s.node == "/useless/plant_simulator")
            end()
            self.assertEqual(0, plant.wait(exchange.PATIENCE))
            last = states.wait(lambda s: s.code == "shut_down")
            self.assertEqual((LoopState.STALLED, True), (last.mode, last.summary))

    def test_a_recorder_that_hangs_is_killed_when_the_run_is_over(self):
        launch = Launch(self, "loop:=asp_case1_clp", "set:=sampling.duration_h=15", "speedup:=14400", "out:=" + self.out)
        exchange.wait_until(lambda: holds_samples(os.path.join(self.out, "journal.bin")), "samples on disk")
        rosgraph.Master("/records", launch.uri).setParam("/end_launch/hanging", 2.0)
        os.kill(launch.pid("/loop_recorder"), signal.SIGSTOP)
        text = launch.end()
        self.assertIn("/loop_recorder has not answered for", text)
        self.assertIn("loop_recorder is gone", text)
        summary = self.summary()
        self.assertFalse(summary["complete"])
        self.assertGreater(summary["steps"], 0)
        self.assertFalse(os.path.exists(os.path.join(self.out, "journal.bin")))

    def test_a_node_that_is_started_again_and_again_on_a_bad_loop_stays_until_there_is_another(self):
        rospy.set_param("stays/loop_text", "plant: [")
        rospy.set_param("stays/fmbpc_controller/respawned", True)
        states = exchange.Listener("stays/loop_state", LoopState, connected=False)
        controller = subprocess.Popen(exchange.tied([exchange.program("fmbpc_controller"), "__ns:=stays"]), stderr=subprocess.PIPE,
                                      text=True)
        self.addCleanup(controller.stderr.close)
        self.addCleanup(exchange.killed, controller)
        for _ in range(8):  # for longer than one that ends would be heard
            self.assertEqual(LoopState.FAILED, states.wait(lambda s: s.code == "cannot_start").mode)
            states.clear()
        self.assertIsNone(controller.poll())
        rospy.set_param("stays/loop_text", "plant: [[")
        self.assertEqual(1, controller.wait(exchange.PATIENCE))
        self.assertIn("waits for another loop_text", controller.stderr.read())

    def test_in_a_namespace_with_a_bag_and_quotes_in_the_names(self):
        out = os.path.join(self.out, "it's mine")
        text = Launch(self, "loop:=asp_case1", "set:=sampling.duration_h=2", "pace:=lockstep", "ns:=/a", "record:=true",
                      "out:=" + out).end()
        replayed = json.loads(exchange.tool("replay", os.path.join(out, "loop.bag"), "--json").stdout)
        self.assertEqual((True, True, 0, 11), (replayed["equal"], replayed["ended"], replayed["missing_samples"],
                                               replayed["measurements"]), text)
        self.assertEqual(10, self.summary("it's mine")["steps"], text)
        self.assertNotIn("No closing quotation", text)
        self.assertNotIn("Traceback", OLD_ROSLAUNCH.sub("", text))


if __name__ == "__main__":
    rospy.init_node("records")
    rostest.rosrun("fmbpc", "records", Records, sys.argv)
