#!/usr/bin/python3
"""Case 1 under every controller over seeds of the disturbance pattern: case1_table.py [SEED ...] (default 1..8)

Runs in process; prints median and range of the biomass ISE, and medians of the substrate ISE and of the mean move.
"""
import json
import os
import statistics
import subprocess
import sys

TOOL = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fmbpc")
ROWS = (
    ("FMBPC, published law, FM_1, H 6", "asp_case1", ()),
    ("the same, bounds 0..3000", "asp_case1", ("actuator.input_upper.q_r=3000",)),
    ("the same with CLP", "asp_case1_clp", ()),
    ("FMBPC, general law", "asp_case1_general", ()),
    ("FMBPC, published law, H 3, a_r2 0.3", "asp_case1",
     ("controller.coincidence_steps=3", "controller.reference_pole.x=0.3")),
    ("FMBPC, published law, own model, H 6", "asp_case1_own", ()),
    ("FMBPC, iterated law, own model, preview", "asp_best", ()),
    ("PI on substrate, paper's gains", "asp_case1_pi_s", ()),
    ("PI on biomass, paper's gains", "asp_case1_pi_x", ()),
    ("PI on biomass, kp 10, ki 1", "asp_case1_pi_x_tuned",
     ("controller.loops.0.kp=10", "controller.loops.0.ki_per_h=1")),
    ("PI on biomass, tuned (kp 13, ki 20)", "asp_case1_pi_x_tuned", ()),
)


def run(loop, overrides):
    command = [TOOL, "run", loop, "--json"]
    for override in overrides:
        command += ["--set", override]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def main(seeds):
    print("| controller | ISE of x, median | range | ISE of s | mean move [m3/h] | violations |")
    print("|---|---|---|---|---|---|")
    for title, loop, overrides in ROWS:
        runs = [run(loop, (*overrides, f"disturbance.pattern.seed={seed}")) for seed in seeds]
        x = [r["outputs"]["x"]["ise"] for r in runs]
        s = statistics.median(r["outputs"]["s"]["ise"] for r in runs)
        move = statistics.median(r["inputs"]["q_r"]["mean_abs_move"] for r in runs)
        beyond = sum(r["violations"]["input"] + r["violations"]["move"] for r in runs)
        print(f"| {title} | {statistics.median(x):.3g} | {min(x):.3g} .. {max(x):.3g} | {s:.3g} | {move:.1f} | {beyond} |")


if __name__ == "__main__":
    if {"-h", "--help"} & set(sys.argv[1:]):
        print(__doc__.strip())
        sys.exit(0)
    main(sys.argv[1:] or [str(seed) for seed in range(1, 9)])
