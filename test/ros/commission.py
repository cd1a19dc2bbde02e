#!/usr/bin/python3
"""`fmbpc commission --topics` on a reactor behind a PLC, under a PI: from the brief to a design, its controller killed in the stages that last, and every
write inside the limits of the loop."""
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest

import rospy
import rostest
import yaml
from fmbpc.msg import LoopState, Measurement

import exchange
from modbus import LOWER, UPPER, Plc

LOOP = {"extends": "cstr_modbus", "title": "Reactor behind a PLC, PI",
        "controller": {"type": "pi", "loops": [{"input": "q_c", "output": "CA", "kp": 60, "ki_per_h": 2500, "start": "bumpless"}]}}
BRIEF = {"limits": {"CA": [0.03, 0.25]}, "moves": {"q_c": 4}, "hold": {"CA": 0.1}, "plant_time_h": 1.5, "seed": 1}
STAGES = ("brief", "watch", "test", "model", "design")


class Commission(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.loop, cls.brief = (os.path.join(cls.folder, name) for name in ("reactor.yaml", "brief.yaml"))
        for file, content in ((cls.loop, LOOP), (cls.brief, BRIEF)):
            pathlib.Path(file).write_text(yaml.safe_dump(content), encoding="utf-8")
        cls.plc = Plc(exchange.free_port())
        cls.addClassCleanup(lambda: exchange.killed(cls.plc.process))
        sets = f"gateway.modbus.port={cls.plc.port} sampling.duration_h=0 setpoint.schedule=[]"
        cls.launch = subprocess.Popen(
            exchange.tied(["roslaunch", "--wait", "fmbpc", "loop.launch", f"loop:={cls.loop}", f"set:={sets}", "draw:=false", "keep:=true",
                       "sim_time:=false", "respawn:=true", f"out:={cls.folder}/out"]), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cls.addClassCleanup(exchange.end_launch, cls.launch)
        cls.states = exchange.Listener("loop_state", LoopState, "/plant_gateway")
        cls.measurements = exchange.Listener("measurement", Measurement)
        cls.states.wait(lambda s: s.summary and s.mode == LoopState.AUTOMATIC)

    def words(self, until):
        return ["fmbpc_tool", "commission", self.brief, "--topics", "--folder", os.path.join(self.folder, "stages"), "--until", until, "--evaluations", "8", "--members", "8"]

    def kill_in(self, stage):
        """Begins up to this stage, kills the controller in it. What the command says."""
        words = self.words(stage)
        command = subprocess.Popen(exchange.tied([exchange.program(words[0]), *words[1:]]), text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        for line in command.stderr:
            if line.startswith(stage + ":"):
                break
        else:
            self.fail(f"stage {stage} has not begun")
        os.kill(exchange.pid("/fmbpc_controller"), signal.SIGKILL)
        rest = command.stderr.read()
        self.assertEqual(1, command.wait(60), rest)
        self.measurements.clear()
        self.states.clear()
        self.states.wait(lambda s: s.summary and s.mode == LoopState.AUTOMATIC)
        return rest

    def finish(self, stage):
        words = self.words(stage)
        done = subprocess.run([exchange.program(words[0]), *words[1:], "--json"], capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(0, done.returncode, done.stderr)
        return json.loads(done.stdout)

    def test_from_a_brief_to_a_design_with_the_controller_killed_on_the_way(self):
        kept = {}
        for stage in STAGES[1:]:
            if stage != "model":  # which is over within a second
                self.assertIn("goes on", self.kill_in(stage))
            figures = self.finish(stage)
            for name in STAGES[:STAGES.index(stage) + 1]:
                self.assertIsNotNone(figures[name], name)
                if name in kept:
                    self.assertEqual(kept[name], figures[name], f"{name} was gone through again")
                kept[name] = figures[name]
            for name in STAGES[STAGES.index(stage) + 1:]:
                self.assertIsNone(figures[name], name)
        self.assertIn(kept["test"]["ended"], ("enough", "time"))
        self.assertEqual(0, kept["test"]["limits_left"])
        self.assertIn(kept["design"]["offers"], ("law", "pi", "none"))
        lines = [line for line in self.plc.lines() if "asked" in line and line["remote"]]
        self.assertGreater(len(lines), 300)
        for line in lines:
            self.assertTrue(LOWER <= line["asked"] <= UPPER, line)
            self.assertTrue(line["allowed"], line)

    def test_what_is_wrong_is_refused_and_nothing_is_sent(self):
        bad = os.path.join(self.folder, "bad.yaml")
        pathlib.Path(bad).write_text(yaml.safe_dump({**BRIEF, "limits": {"nobody": [0, 1]}}), encoding="utf-8")
        words = [bad if word == self.brief else word for word in self.words("test")]
        done = subprocess.run([exchange.program(words[0]), *words[1:]], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(1, done.returncode)
        self.assertIn("nobody", done.stderr)


if __name__ == "__main__":
    rospy.init_node("commission_test", disable_signals=True)
    rostest.rosrun("fmbpc", "commission", Commission)
