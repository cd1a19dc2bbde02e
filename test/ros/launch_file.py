#!/usr/bin/python3
"""loop.launch as a person types it, each time with a master of its own on a free port."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rosgraph
import rostest

import panel_page
import exchange


PATIENT = 3 * exchange.PATIENCE  # end_launch gives way to all others (os.nice)


def roslaunch(*arguments):
    port = exchange.free_port()
    environment = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{port}"}
    environment.pop("DISPLAY", None)
    done = subprocess.run(exchange.tied(["roslaunch", "-p", port, "fmbpc", "loop.launch", *arguments]), env=environment,
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=150, check=False)
    return done.returncode, re.sub(r"\x1b\[[0-9;]*m", "", done.stdout)


def known(master, *nodes):
    try:
        return all(master.lookupNode(node) for node in nodes)
    except (OSError, rosgraph.MasterException):
        return False


class LaunchFile(unittest.TestCase):
    def setUp(self):
        self.out = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.out)

    def test_a_run_ends_by_itself_with_its_files_and_a_bag_of_every_sample(self):
        _, text = roslaunch("loop:=asp_case1_clp", "set:=sampling.duration_h=10", "pace:=lockstep", "record:=true",
                            "plot:=true", "out:=" + self.out)
        for name in ("trajectory.csv", "summary.json", "plot.png", "loop.bag"):
            self.assertTrue(os.path.isfile(os.path.join(self.out, name)), f"{name}\n{text}")
        with rosbag.Bag(os.path.join(self.out, "loop.bag")) as bag:
            steps = {topic: sorted({m.step for _, m, _ in bag.read_messages("/" + topic)})
                     for topic in ("measurement", "base_action", "predictive_action", "control_action",
                                   "solver_report", "tracking", "plant_state")}
            self.assertGreater(min(t.to_sec() for _, _, t in bag.read_messages()), 0.9)
            signals = {t for t in bag.get_type_and_topic_info().topics if t.startswith("/signal/")}
        for topic in ("measurement", "tracking", "plant_state"):
            self.assertEqual(list(range(51)), steps[topic], topic)
        for topic in ("base_action", "predictive_action", "control_action", "solver_report"):
            self.assertEqual(list(range(50)), steps[topic], topic)
        self.assertLessEqual({"/signal/x", "/signal/x_setpoint", "/signal/x_reference", "/signal/q_r",
                              "/signal/q_r_perturbation"}, signals)
        here, there = (exchange.tool("identify", os.path.join(self.out, record), "asp_c", "--json").stdout
                       for record in ("loop.bag", "trajectory.csv"))
        here, there = json.loads(here), json.loads(there)
        for part in ("identification", "rule_details", "rules"):
            self.assertEqual(there[part], here[part])
        self.assertIn("there is no screen", text)
        self.assertNotIn("REQUIRED", text)
        for topic, steps_wanted in (("/signal/x_reference", 51), ("/signal/x_setpoint", 51), ("/signal/x", 51),
                                    ("/signal/q_r", 50), ("/signal/q_r_perturbation", 50)):
            with rosbag.Bag(os.path.join(self.out, "loop.bag")) as bag:
                self.assertEqual(steps_wanted, len({m.header.stamp for _, m, _ in bag.read_messages(topic)}), topic)
        replayed = json.loads(exchange.tool("replay", os.path.join(self.out, "loop.bag"), "--json").stdout)
        self.assertEqual((True, 51, 50, 50), (replayed["equal"], replayed["measurements"],
                                              replayed["base_action"]["equal"], replayed["control_action"]["equal"]))
        self.pages_hold_the_same(self.out, os.path.join(self.out, "loop.bag"))

    def pages_hold_the_same(self, *records):
        """All trends, and the indices that a bag gives."""
        given = []
        for i, record in enumerate(records):
            out = os.path.join(self.out, f"{i}.html")
            subprocess.run([os.path.join(os.path.dirname(panel_page.SCRIPT), "fmbpc"), "page", record, "--out", out], check=True, stdout=subprocess.DEVNULL)
            with open(out, encoding="utf-8") as file:
                given.append(json.loads(file.read().split("window.FMBPC_RUN=")[1].split("</script>")[0]))
        trends = [dict(zip(g["series"]["columns"], g["series"]["data"])) for g in given]
        self.assertEqual(11, len(trends[0]))
        self.assertEqual(*trends)
        for name in ("steps", "dt"):
            self.assertEqual(*(g["series"][name] for g in given))
        self.assertEqual([(True, 51)] * 2, [(g["complete"], g["samples"]) for g in given])
        for name, indices in given[1]["outputs"].items():
            for index in ("ise", "iae", "itae", "rmse"):
                self.assertAlmostEqual(1.0, indices[index] / given[0]["outputs"][name][index], 12)

    def test_the_arguments_are_listed_without_a_loop_in_a_bare_shell(self):
        for file, required in (("loop", {"loop"}), ("example", set()), ("modbus_demo", set()),
                               ("two_machines", {"loop", "plant_host", "control_host"})):
            done = subprocess.run(["roslaunch", "--ros-args", "fmbpc", file + ".launch"], text=True, timeout=60, check=False,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  env={name: value for name, value in os.environ.items() if name != "USER"})
            self.assertEqual(0, done.returncode, done.stdout)
            first = done.stdout.split("Optional Arguments:")[0]
            self.assertEqual(required, set(re.findall(r"^  (\w+):", first, re.MULTILINE)), done.stdout)
            self.assertIn("  set (default", done.stdout)
            self.assertNotIn("undocumented", done.stdout)

    def test_without_a_loop_one_line_says_so(self):
        code, text = roslaunch()
        self.assertNotEqual(0, code)
        self.assertIn("requires the 'loop' arg to be set", text)
        self.assertNotIn("xml is", text)

    def test_paths_and_values_may_hold_spaces(self):
        folder = os.path.join(self.out, "my loops")
        os.mkdir(folder)
        loop, out = os.path.join(folder, "it's mine.yaml"), os.path.join(self.out, "my results")
        with open(loop, "w", encoding="utf-8") as file:
            file.write("extends: asp_case1\ntitle: Mine\n")
        _, text = roslaunch("loop:=" + loop, "set:=setpoint.initial={s: 55, x: 1900} sampling.duration_h=2 title='Mine, too'",
                            "pace:=lockstep", "record:=true", "draw:=false", "out:=" + out)
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        self.assertEqual(("Mine, too", 10), (summary["title"], summary["steps"]), text)
        self.assertTrue(os.path.isfile(os.path.join(out, "loop.bag")), text)

    def test_two_loops_started_at_the_same_moment_on_one_master_both_run(self):
        port = exchange.free_port()
        environment = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{port}"}
        core = subprocess.Popen(exchange.tied(["roscore", "-p", port]), env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(exchange.killed, core)
        launches = [subprocess.Popen(
            exchange.tied(["roslaunch", "--wait", "fmbpc", "loop.launch", "loop:=" + loop, "ns:=/" + loop, "out:=" + os.path.join(self.out, loop),
                       "set:=sampling.duration_h=2", "pace:=lockstep", "draw:=false"]),
            env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for loop in ("asp_case1", "asp_case2")]
        for launch in launches:
            self.addCleanup(exchange.killed, launch)
            launch.wait(60)
        for loop in ("asp_case1", "asp_case2"):
            with open(os.path.join(self.out, loop, "summary.json"), encoding="utf-8") as file:
                self.assertTrue(json.load(file)["complete"], loop)

    def test_a_launcher_that_is_killed_is_said_and_its_nodes_end_with_the_run(self):
        port = exchange.free_port()
        environment = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{port}"}
        core = subprocess.Popen(exchange.tied(["roscore", "-p", port]), env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(exchange.killed, core)
        quiet = {"env": environment, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        launch = subprocess.Popen(exchange.tied(
            ["roslaunch", "--wait", "fmbpc", "loop.launch", "loop:=asp_case1", "out:=" + self.out, "pace:=lockstep", "draw:=false",
             "set:=sampling.duration_h=20 loop.ready_timeout_s=600 loop.wait_for=[loop_recorder,fmbpc_controller,launch_file]"]), **quiet)
        self.addCleanup(exchange.killed, launch)
        master = rosgraph.Master("/launch_file", environment["ROS_MASTER_URI"])
        nodes = ("/plant_simulator", "/fmbpc_controller", "/fuzzy_identifier", "/loop_recorder", "/end_launch")
        exchange.wait_until(lambda: known(master, *nodes), "the nodes", PATIENT)
        processes = {node: exchange.pid(node, master) for node in nodes}
        launch.kill()
        launch.wait()
        with tempfile.TemporaryFile("w+") as said:
            listener = subprocess.Popen(exchange.tied(["rostopic", "echo", "/loop_state/reason"]), **{**quiet, "stdout": said})
            self.addCleanup(exchange.killed, listener)
            exchange.wait_until(lambda: "roslaunch that started this node was killed" in os.pread(said.fileno(), 1 << 20, 0).decode(),
                            "the nodes to say it")
        begins = subprocess.Popen(exchange.tied(["rostopic", "pub", "/ready", "fmbpc/NodeReady", "{node: /launch_file}",
                                             "__name:=launch_file"]), **quiet)  # the run itself, after all that
        self.addCleanup(exchange.killed, begins)
        for node, process in processes.items():
            exchange.wait_until(lambda p=process: not exchange.runs(p), node + " to end", PATIENT)
        with open(os.path.join(self.out, "summary.json"), encoding="utf-8") as file:
            self.assertTrue(json.load(file)["complete"])

    def test_a_bad_loop_starts_nothing(self):
        for arguments, words in ((["loop:=nobody"], "nobody"),
                                 (["loop:=asp_case1", "set:=controller.coincidence_stepz=3"], "coincidence_stepz"),
                                 (["loop:=asp_case1", "pace:=slowly"], "loop.pace")):
            code, text = roslaunch(*arguments, "out:=" + self.out)
            self.assertNotEqual(0, code)
            self.assertIn(words, text)
            self.assertNotIn("process[", text)
        self.assertEqual([], os.listdir(self.out))


if __name__ == "__main__":
    rostest.rosrun("fmbpc", "launch_file", LaunchFile, sys.argv)
