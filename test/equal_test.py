#!/usr/bin/python3
"""A run over topics writes the files of the same run in one process, bit for bit: every type of controller, every pace,
noise, limits, sample lines, a user's own plant and controller. Each launch has a master of its own."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import rosgraph

TOP = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "test" / "ros"))
import exchange  # noqa: E402

EXAMPLE = TOP / "examples" / "two_tanks" / "config"
HANDOVER = TOP / "examples" / "handover"
LINE = '[{"output": x, "from": reactor, "to": sludge_analyzer, "velocity_m_s": 0.05}]'

# name: loop, samples, keys over it, pace, speedup
CASES = {
    "fmbpc": ("asp_case1", 830, [], "lockstep", 3600),
    "pi": ("asp_case1_pi_x", 830, [], "lockstep", 3600),
    "clp": ("asp_case1_clp", 830, [], "lockstep", 3600),
    "noise_limits": ("asp_case1_clp", 100, ["sampling.duration_h=20", "noise.std.s=5", "noise.std.x=20", "seed=3",
                                            "actuator.move_upper.q_r=30"], "lockstep", 3600),
    "paced": ("asp_case1_clp", 25, ["sampling.duration_h=5"], "paced", 7200),
    "realtime": ("asp_case1_clp", 25, ["sampling.duration_h=5"], "realtime", 3600),
    "sample_line": ("asp_case1", 50, ["sampling.duration_h=10", "tf.sample_lines=" + LINE], "lockstep", 3600),
    "csv": ("asp_influent_csv", 840, [], "lockstep", 3600),
    "excitation": ("asp_excite", 100, ["sampling.duration_h=20", "actuator.move_upper.q_r=400", "noise.std.x=5"],
                   "lockstep", 3600),
    "adaptive_pi": ("column_adaptive", 900, [], "lockstep", 3600),
    "matrix": ("heated_tank", 360, [], "lockstep", 3600),
    "targets": ("tanks_three_pumps", 240, [], "lockstep", 3600),
    "targets_clp": ("four_on_two", 180, [], "lockstep", 3600),
    "column_clp": ("column_clp_tracking", 150, [], "lockstep", 3600),
    "fuzzy_optimal": ("surge_tank_steps", 1200, [], "lockstep", 3600),
    "fuzzy_optimal_two_inputs": ("mimo_cstr_steps", 5400, ["sampling.duration_h=0.9"], "lockstep", 3600),
    "fuzzy_optimal_clp": ("surge_tank_steps_clp", 1200, [], "lockstep", 3600),
    "hybrid_mpc": ("batch_fuzzy_eq45", 3000, [], "lockstep", 3600),
    "nmpc": ("mimo_cstr_steps_nmpc", 600, ["sampling.duration_h=0.1"], "lockstep", 3600),
    "swarm_mpc": ("mimo_cstr_steps_swarm", 600, ["sampling.duration_h=0.1"], "lockstep", 3600),
    "online": ("asp_case1_clp", 300, ["sampling.duration_h=60", "model.identify.online.every=40"], "lockstep", 3600),
    "identified": ("asp_case1", 300, ["sampling.duration_h=60", "model.identify.structure=asp_d.yaml",
                                      "model.identify.after=200"], "lockstep", 3600),
    "guard": ("asp_case_c_own", 400, ["sampling.duration_h=80", "guard.lock_samples=12"], "lockstep", 3600),
    "guard_clp": ("asp_case1_own", 200, ["sampling.duration_h=40", "guard.trust=[0.5,0.75]", "clp.perturbation_steps=10"],
                  "lockstep", 3600),
    "observer": ("cstr_tracking_observer", 400, ["noise.std.CA=0.0005"], "lockstep", 3600),
    "observer_clp": ("surge_tank_steps_clp", 600, ["sampling.duration_h=0.016666666666666666", "noise.std.H=0.001"],
                     "lockstep", 3600),
    "observer_nmpc": ("surge_tank_steps_nmpc", 300, ["sampling.duration_h=0.008333333333333333", "noise.std.H=0.001"],
                      "lockstep", 3600),
    "guard_plan": ("asp_best", 150, ["sampling.duration_h=30", "guard.trust=[0.9,1]",
                                     "clp.perturbation_steps=10"], "lockstep", 3600),
    "estimator": ("asp_best_estimated", 150, ["sampling.duration_h=30", "clp.perturbation_steps=10"], "lockstep", 3600),
    "nmpc_hidden": ("asp_case1_nmpc", 60, ["sampling.duration_h=12"], "lockstep", 3600),
    "nmpc_late": ("cstr_tracking_nmpc", 60, ["sampling.duration_h=0.1"], "lockstep", 3600),
    "pi_late": ("cstr_tracking_pi_best", 60, ["sampling.duration_h=0.1"], "lockstep", 3600),
    "pi_best": ("asp_case1_pi_x_best", 200, ["sampling.duration_h=40"], "lockstep", 3600),
    "bsm1_sampled_pi": ("bsm1_default_sampled", 240, ["disturbance={}", "sampling.duration_h=4", "report.record_from_h=0"],
                        "lockstep", 3600),
    "load_ahead": ("bsm1_supervisor", 60, ["disturbance={}", "sampling.duration_h=5", "report.record_from_h=0"],
                        "lockstep", 3600),
    "handover": (str(HANDOVER / "tank.yaml"), 1200, [f"candidate.loop={HANDOVER / 'tank_candidate.yaml'}",
                                                     "candidate.automatic=true"], "lockstep", 3600),
    "plugin": ("two_tanks_outflow", 360, [], "lockstep", 3600),
}
CLAMPED = ("heated_tank", 360, ["setpoint.upper.T=55", "setpoint.commands=[{time_h: 1, name: T, mode: offset, value: 9}]",
                                "disturbance.commands=[{time_h: 0.5, name: T_in, mode: offset, value: -20}]"],
           "lockstep", 3600)
MODELS_REFUSED = ("asp_case1", 100, ["sampling.duration_h=20", "model.identify.structure=asp_d.yaml", "model.identify.after=10",
                                     "model.identify.online.every=40", "model.max_pole=0.9"], "lockstep", 3600)


def environment():
    """With the example of a user's package where a user would have it: in a folder of its own."""
    return {**os.environ, "FMBPC_CONFIG_PATH": str(EXAMPLE),
            "FMBPC_PLUGIN_PATH": os.environ.get("FMBPC_TEST_PLUGINS", str(TOP / "build" / "test" / "plugins"))}


def launch(folder, loop, sets, pace, speedup, port=None):
    port = port or exchange.free_port()
    done = subprocess.run(
        exchange.tied(["roslaunch", "-p", port, "fmbpc", "loop.launch", f"loop:={loop}", "set:=" + " ".join(sets), f"pace:={pace}",
                   f"speedup:={speedup}", f"out:={folder}", "draw:=false"]),
        env={**environment(), "ROS_MASTER_URI": f"http://localhost:{port}"}, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True, timeout=240, check=False)
    return done.stdout


def tool(*arguments):
    done = subprocess.run([exchange.program("fmbpc_tool"), *arguments], env=environment(), capture_output=True, text=True,
                          timeout=240, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def first_case(kind):
    """Forty samples of the first loop of a type of controller."""
    loops = json.loads(tool("loops", "--json"))["loops"]
    loop = next(entry["name"] for entry in loops if entry["controller"].split(" ")[0] == kind)
    hours = 40 * float(re.search(r"^ *sample_time_s: (.*)$", tool("resolve", loop), re.M)[1]) / 3600
    return loop, 40, [f"sampling.duration_h={hours:.12g}", "report.record_from_h=0"], "lockstep", 3600


class Equal(unittest.TestCase):
    """One test for each of CASES, made below."""

    def compare(self, name):
        self.compare_case(*CASES[name])

    def compare_case(self, loop, steps, sets, pace, speedup, port=None):
        with tempfile.TemporaryDirectory() as folder:
            topics, process = os.path.join(folder, "over topics"), os.path.join(folder, "process")
            text = launch(topics, loop, sets, pace, speedup, port)
            self.assertTrue(os.path.exists(os.path.join(topics, "summary.json")), text[-3000:])
            tool("run", loop, "--no-plot", "--out", process, *[word for s in sets for word in ("--set", s)])
            late = 0
            if pace == "realtime":
                late = self.compare_realtime(topics, process, steps)
            else:
                exchange.assert_same_run(self, topics, process)
            self.assertLessEqual(exchange.summary(topics)["steps"], steps)
            self.assertGreaterEqual(exchange.summary(topics)["steps"], steps - late)  # none is missing but for a late one
            return exchange.summary(topics)

    def compare_realtime(self, topics, process, steps):
        """A machine may be too slow for a sample: the runs are the same up to the first action that came too late, where
        the input that was held is not the one that was commanded, or that went out without the optimizer."""
        here, there = exchange.trajectory(topics), exchange.trajectory(process)
        applied, commanded = (here[0].split(",").index(name) for name in ("q_r[m3/h]", "q_r_commanded[m3/h]"))
        cells = [row.split(",") for row in here]
        late = [k for k in range(1, steps + 1) if cells[k][applied] != cells[k][commanded]]
        alone = [e["first"] + 1 for e in exchange.summary(topics)["events"] if e["code"] == "optimizer_lost"]
        same = min(late + alone, default=steps + 2)
        if same == steps + 2:
            exchange.assert_same_run(self, topics, process)
        self.assertEqual(there[:same], here[:same])
        self.assertEqual(len(there), len(here))
        print(f"realtime: {same - 1} of {steps + 1} rows compared, {len(late)} actions too late, "
              f"{len(alone)} without the optimizer")
        return len(late)

    def test_a_listener_that_died_unsaid_costs_no_sample(self):
        """Every node waits for it before it is ready, and none while another waits for its answer."""
        port = exchange.free_port()
        core = subprocess.Popen(exchange.tied(["rosmaster", "--core", "-p", port]), stdout=subprocess.DEVNULL)
        self.addCleanup(exchange.killed, core)
        master = rosgraph.Master("/died", f"http://localhost:{port}")
        exchange.wait_until(master.is_online, "the master")
        for topic in ("base_action", "control_action", "solver_report", "measurement", "predictive_action"):
            master.registerSubscriber("/" + topic, "*", "http://localhost:1")
        self.compare_case(*CASES["paced"], port=port)

    def test_a_setpoint_and_an_offset_clamped_are_events_in_both_ways(self):
        self.assertEqual([("disturbance_clamped", "T_in", 60, 300), ("setpoint_clamped", "T", 120, 240)],
                         [(e["code"], e["signal"], e["first"], e["count"]) for e in self.compare_case(*CLAMPED)["events"]])

    def test_models_that_could_not_be_had_are_events_in_both_ways(self):
        said = [(e["code"], e["first"]) for e in self.compare_case(*MODELS_REFUSED)["events"]]
        self.assertEqual([("identification_failed", 10), ("model_refused", 41), ("model_refused", 81)],  # from the next sample on
                         [event for event in said if event[0] in ("identification_failed", "model_refused")], said)

    def test_types_without_a_case_run_their_first_loop(self):
        """A new type is compared by the loop that it brings."""
        types = {entry["type"] for entry in json.loads(tool("controllers", "--json"))["controllers"]}
        self.assertGreaterEqual(len(types), 8)
        for name in sorted(types - set(CASES)):
            self.compare_case(*first_case(name))

    def test_the_case_of_a_type_is_its_first_loop(self):
        self.assertEqual(first_case("excitation"), ("asp_excite", 40, ["sampling.duration_h=8", "report.record_from_h=0"], "lockstep", 3600))


def add(name):
    setattr(Equal, "test_" + name, lambda self: self.compare(name))


for case in CASES:
    add(case)

if __name__ == "__main__":
    unittest.main()
