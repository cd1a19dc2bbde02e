#!/usr/bin/python3
"""Commissions plants that ship and that the constants of `fmbpc commission` were not chosen on: from a slow PI, blind, with noise.

  bench/commissioned_plants.py [NAME...] [--out FOLDER] [--seeds 101:112]

Printed for each: what is offered, plant time of watch and test, limits left on the way, and the ISE of what is offered over that of the slow PI
and over that of the PI that ships (tuned or published), medians over noise that was not seen.
"""
import argparse
import json
import os
import pathlib
import subprocess

import yaml

TOP = pathlib.Path(__file__).resolve().parent.parent

# The PI that ships, and by what its gains are divided for the control in charge (gain, integral gain).
CASES = {
    "heated_tank": {"loop": "heated_tank", "slower": (3, 6), "noise": {"T": 0.05},
                    "brief": {"limits": {"T": [20, 60]}, "moves": {"heat": 1}, "hold": {"T": 40}, "plant_time_h": 12}},
    "jacketed_vessel": {"loop": "jacketed_vessel", "slower": (3, 6), "noise": {"T": 0.05},
                        "brief": {"limits": {"T": [25, 60]}, "moves": {"T_jacket": 2}, "hold": {"T": 38}, "plant_time_h": 60}},
    "surge_tank": {"loop": "surge_tank_steps_pi", "slower": (3, 6), "noise": {"H": 0.0005},
                   "brief": {"limits": {"H": [0.1, 0.35]}, "moves": {"I": 0.0003}, "hold": {"H": 0.2}, "plant_time_h": 0.3},
                   # as shipped it is asked for a step in its first sample, which a PI that starts without a bump answers by its integral alone
                   "plant": {"setpoint": {"initial": {"H": 0.15},
                                          "schedule": [{"time_h": 1 / 360, "H": 0.2}, {"time_h": 1 / 120, "H": 0.25}, {"time_h": 1 / 60, "H": 0.3},
                                                       {"time_h": 1 / 40, "H": 0.25}]}}},
    "reactor": {"loop": "cstr_small_steps_pi", "slower": (3, 3), "noise": {"CA": 0.0003},
                "brief": {"limits": {"CA": [0.06, 0.14]}, "moves": {"q_c": 2}, "hold": {"CA": 0.1}, "plant_time_h": 4},
                "plant": {"setpoint": {"initial": {"CA": 0.1}, "schedule": [{"time_h": 1 / 30, "CA": 0.12}, {"time_h": 1 / 6, "CA": 0.1},
                                                                            {"time_h": 1 / 3, "CA": 0.08}, {"time_h": 1 / 2, "CA": 0.1}]}}},
    "two_input_reactor": {"loop": "mimo_cstr_steps_pi", "slower": (3, 6), "noise": {"Ca": 0.0005, "T": 0.1},
                          "brief": {"limits": {"Ca": [0.05, 0.16], "T": [425, 450]}, "moves": {"q": 2, "qc": 2}, "hold": {"Ca": 0.1, "T": 438.54},
                                    "plant_time_h": 2},
                          # as shipped it goes far beyond these limits
                          "plant": {"setpoint": {"schedule": [{"time_h": 0.5, "T": 442}, {"time_h": 1.2, "Ca": 0.085}, {"time_h": 2, "T": 436},
                                                              {"time_h": 2.7, "Ca": 0.11}]}}},
    "sludge": {"loop": "asp_case1_pi_x", "slower": (3, 3), "noise": {"x": 5, "s": 2},
               "brief": {"limits": {"x": [1000, 3000], "s": [0, 300]}, "moves": {"q_r": 60}, "hold": {"x": 2000}, "plant_time_h": 400},
               "plant": {"setpoint": {"initial": {"s": 55, "x": 2000}, "schedule": [{"time_h": 6, "x": 1800}, {"time_h": 30, "x": 2200},
                                                                                    {"time_h": 80, "x": 2000}]}}},
}


def fmbpc(*arguments):
    done = subprocess.run([os.environ.get("FMBPC_TOOL", "fmbpc"), *map(str, arguments)], text=True, capture_output=True, check=False)
    if done.returncode not in (0, 3):
        raise RuntimeError(f"fmbpc {' '.join(map(str, arguments))}: {done.stderr.strip()[-600:]}")
    return done.stdout


def slower(controller, by):
    """The loops with smaller gains; they begin where the plant is."""
    loops = []
    for loop in controller["loops"]:
        loop = {**loop, "kp": float(loop["kp"]) / by[0], "ki_per_h": float(loop["ki_per_h"]) / by[1], "start": "bumpless"}
        loop.pop("bias", None)
        loops.append(loop)
    return {**controller, "loops": loops}


def commissioned(name, case, folder):
    shipped = yaml.safe_load(fmbpc("resolve", case["loop"]))
    noisy = {"extends": case["loop"], "noise": {"std": case["noise"]}, "actuator": {"move_upper": case["brief"]["moves"]},
             **case.get("plant", {})}
    present = {**noisy, "title": f"{name}, slow PI", "controller": slower(shipped["controller"], case["slower"])}
    folder.mkdir(parents=True, exist_ok=True)
    for file, content in (("present", present), ("shipped", {**noisy, "title": f"{name}, PI that ships"}),
                          ("brief", {"loop": "present.yaml", **case["brief"], "seed": 1})):
        (folder / f"{file}.yaml").write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
    return json.loads(fmbpc("commission", folder / "brief.yaml", "--folder", folder / "commissioned", "--again", "brief", "--no-plot", "--json"))


def ise(folder, seeds):
    """Median over the seeds of each loop's ISE, in parts of that of the slow PI."""
    files = {"law": folder / "commissioned" / "present_law.yaml", "pi": folder / "commissioned" / "present_pi.yaml", "shipped": folder / "shipped.yaml",
             "present": folder / "present.yaml"}
    told = json.loads(fmbpc("study", *files.values(), "--against", files["present"], "--seeds", seeds, "--json", "--no-plot"))
    medians = dict(zip(files, (loop["median"] for loop in told["loops"])))
    failed = [label for label, loop in zip(files, told["loops"]) if sum(loop["failures"].values()) > 0]
    return {label: medians[label] / medians["present"] for label in ("law", "pi", "shipped")}, failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=list(CASES))
    parser.add_argument("--out", default="commissioned_plants")
    parser.add_argument("--seeds", default="101:112")
    options = parser.parse_args()
    print(f"{'plant':<18} {'offers':<7} {'hours':>9} {'ended':<7} {'left':>4}   law    PI     shipped, ISE in parts of the slow PI's; failed runs")
    for name in options.names:
        folder = pathlib.Path(options.out).resolve() / name
        try:
            told = commissioned(name, CASES[name], folder)
        except RuntimeError as error:
            print(f"{name}: {error}", flush=True)
            continue
        ratio, failed = ise(folder, options.seeds)
        test = told["test"]
        print(f"{name:<18} {told['design']['offers']:<7} {told['watch']['samples'] * test['hours'] / test['samples'] + test['hours']:>9.3g} "
              f"{test['ended']:<7} {test['limits_left']:>4}   {ratio['law']:.3f}  {ratio['pi']:.3f}  {ratio['shipped']:.3f}  {' '.join(failed)}", flush=True)


if __name__ == "__main__":
    main()
