#!/usr/bin/python3
"""The judge of examples/arena: draws, scores, what it takes from a law's loop file, J against a trajectory."""
import csv
import importlib.machinery
import importlib.util
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import yaml

TOP = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("FMBPC_BUILD", TOP / "build"))
os.environ.setdefault("FMBPC_TOOL", str(TOP / "devel" / "lib" / "fmbpc" / "fmbpc_tool"))
os.environ.setdefault("FMBPC_PLUGIN_PATH", str(BUILD / "test" / "plugins"))
SCRIPT = TOP / "examples" / "arena" / "scripts" / "arena"


def load_script():
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader("arena", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("arena", loader))
    loader.exec_module(module)
    return module


ARENA = load_script()


def arena(*arguments):
    done = subprocess.run([SCRIPT, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120, check=False)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return done.stdout


class Arithmetic(unittest.TestCase):
    def test_scores_on_paper(self):
        self.assertEqual(ARENA.score(2.0, 2.0, 1.0, False), 0.0)
        self.assertEqual(ARENA.score(2.0, 1.0, 1.0, False), 1.0)
        self.assertEqual(ARENA.score(2.0, 0.5, 1.0, False), 1.5)
        self.assertEqual(ARENA.score(2.0, 0.5, 1.0, True), 0.0)
        self.assertAlmostEqual(ARENA.score(2.0, 1.9, 2.0, False), 1.0)  # least denominator: a twentieth of J_hold

    def test_the_worst_tenth(self):
        self.assertEqual(ARENA.cvar(list(range(24))), 1.0)   # three of 24
        self.assertEqual(ARENA.cvar([3.0, 5.0]), 3.0)        # one at least

    def test_every_plant_has_its_files_and_they_agree(self):
        for name in ARENA.names():
            plant = ARENA.Plant(name)
            outputs = set(plant.loop["setpoint"]["initial"])
            self.assertEqual(set(plant.brief) - {"zone"}, {"loop", "limits", "moves", "hold", "plant_time_h", "seed"}, name)
            self.assertLessEqual(set(plant.brief["hold"]) | set(plant.brief["limits"]) | set(plant.brief.get("zone", {})), outputs, name)
            self.assertEqual(set(plant.known["scale"]), set(plant.brief["hold"]), name)
            self.assertEqual(plant.brief["moves"], plant.loop["actuator"]["move_upper"], name)
            for y, value in plant.brief["hold"].items():
                low, high = plant.brief["limits"].get(y, (-math.inf, math.inf))
                self.assertTrue(low < value < high, f"{name}: {y}")


class Judge(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.kept.name)

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def test_a_draw_is_the_same_again_and_lies_in_its_ranges(self):
        first, again, other = (self.folder / f"{name}.yaml" for name in ("first", "again", "other"))
        for file, seed in ((first, 3), (again, 3), (other, 4)):
            arena("draw", "drum_level", seed, "--out", file)
        self.assertEqual(first.read_text(), again.read_text())
        numbers = [yaml.safe_load(file.read_text())["plant"]["parameters"] for file in (first, other)]
        self.assertNotEqual(numbers[0], numbers[1])
        for drawn in numbers:
            self.assertTrue(0.9 * 0.547 <= drawn["gain"] <= 1.1 * 0.547, drawn)

    def test_the_cost_is_that_of_the_trajectory(self):
        plant = ARENA.Plant("drum_level")
        told = ARENA.study(self.folder / "cost", {"title": "J", "loops": [{"loop": plant.name, "name": "hold"}], "against": "hold",
                                                  "scenarios": [{"name": "one"}], "fitness": plant.fitness()})
        ARENA.fmbpc("run", plant.name, "--no-plot", "--out", self.folder / "run")
        with open(self.folder / "run" / "trajectory.csv", encoding="utf-8") as file:
            rows = [{key.split("[")[0]: value for key, value in row.items()} for row in csv.DictReader(file)]
        error = sum(((float(row["level_setpoint"]) - float(row["level_true"])) / 2) ** 2 for row in rows) / len(rows)
        feed = [50.0] + [float(row["feed"]) for row in rows[:-1]]  # the last one has no action
        move = sum(((b - a) / 5) ** 2 for a, b in zip(feed, feed[1:])) / (len(rows) - 1)
        self.assertAlmostEqual(told["runs"][0]["cost"], error + move, delta=0.002 * (error + move))

    def test_laws_are_judged_on_the_plant_of_the_arena(self):
        """Present control scores 0 whatever plant, setpoints and wide limits its file names; the reference 1; a law that breaks limits 0."""
        cheat = self.folder / "cheat.yaml"
        cheat.write_text("extends: arena_hicks_ray\nplant: {parameters: {cooling: 0.2}}\nsetpoint: {schedule: []}\n"
                         "actuator: {move_upper: {u: 2}}\n")
        wild = self.folder / "wild.yaml"
        wild.write_text("extends: arena_hicks_ray\ncontroller: {type: pi, loops: [{input: u, output: T, kp: 8, ki_per_h: 16}]}\n")  # the wrong way
        told = json.loads(arena("judge", "hicks_ray", cheat, wild, "--seeds", "201:203", "--out", self.folder / "judged", "--json"))
        laws = told["laws"]
        self.assertEqual(told["draws"], 3)
        self.assertEqual(laws[str(cheat)]["scores"], laws["hold"]["scores"])
        self.assertEqual(laws["hold"]["scores"], [0.0, 0.0, 0.0])
        self.assertEqual(laws[told["reference"]]["score_mean"], 1.0)
        self.assertEqual(laws[str(wild)]["limits_broken"], 3)
        self.assertEqual(laws[str(wild)]["score_cvar"], 0.0)
        self.assertGreater(laws[told["reference"]]["slowest_step_ms"], 0.0)  # a time: no test judges it

    def test_narrower_limits_of_a_law_hold(self):
        plant = ARENA.Plant("drum_level")
        narrow = self.folder / "narrow.yaml"
        narrow.write_text("extends: arena_drum_level\nactuator: {move_upper: {feed: 1}, input_upper: {feed: 70}}\n")
        actuator = ARENA.on_the_plant(plant, narrow)["actuator"]
        self.assertEqual((actuator["move_upper"], actuator["input_upper"], actuator["input_lower"]), ({"feed": 1}, {"feed": 70}, {"feed": 0}))

    def test_a_test_leaves_no_limit_where_the_effect_of_an_input_is_open(self):
        # On this draw the record does not show for hours whether Q raises or lowers T, and the control in charge is at its bound.
        plant = ARENA.Plant("van_de_vusse")
        with tempfile.TemporaryDirectory() as folder:
            arena("draw", "van_de_vusse", 2, "--out", f"{folder}/drawn.yaml")
            brief = ARENA.save(pathlib.Path(folder) / "brief.yaml", {**plant.brief, "loop": f"{folder}/drawn.yaml"})
            told = json.loads(ARENA.fmbpc("commission", brief, "--folder", f"{folder}/c", "--until", "test", "--no-plot", "--json"))
        self.assertEqual(told["test"]["limits_left"], 0)

    def test_what_is_missing_is_named(self):
        for arguments, word in (((["judge", "nowhere", "x"]), "nowhere"), ((["judge", "ph", "--reference", self.folder]), "arena_ph")):
            done = subprocess.run([SCRIPT, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(word, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)


if __name__ == "__main__":
    unittest.main()
