#!/usr/bin/python3
"""How many outputs of the shipped loops `fmbpc health` alarms: every loop with a controller is run, then judged.

  bench/shipped_health.py FOLDER [--seconds 120]

Runs that FOLDER holds are kept. The plants are taken in turns for two halves: thresholds are chosen on the first, the second counts.
An input at its limits is a fact of the record and no alarm.
"""
import argparse
import collections
import json
import os
import pathlib
import subprocess

QUIET = ("healthy", "at_limits")
TOOL = os.environ.get("FMBPC_TOOL", "fmbpc")


def told(*arguments):
    done = subprocess.run([TOOL, *map(str, arguments)], text=True, capture_output=True, check=False)
    return json.loads(done.stdout[done.stdout.index("{"):])


def run(name, folder, seconds):
    if (folder / name / "trajectory.csv").exists():
        return True
    try:
        subprocess.run([TOOL, "run", name, "--no-plot", "--out", folder / name], capture_output=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        pass
    return (folder / name / "trajectory.csv").exists()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=120, help="that a run may take")
    options = parser.parse_args()
    loops = [loop for loop in told("loops", "--json")["loops"] if loop["controller"] != "excitation"]
    halves = {plant: i % 2 for i, plant in enumerate(sorted({loop["plant"] for loop in loops}))}
    judged, alarms = [0, 0], ([], [])
    missing = []
    for loop in loops:
        if not run(loop["name"], options.folder, options.seconds):
            missing.append(loop["name"])
            continue
        half = halves[loop["plant"]]
        for output in told("health", options.folder / loop["name"], "--json")["loops"]:
            judged[half] += output["cause"] != "unknown"
            if output["cause"] not in QUIET + ("unknown",):
                alarms[half].append((output["cause"], output["name"]))
    for half in (0, 1):
        count = collections.Counter(cause for cause, _ in alarms[half])
        print(f"half {half + 1}: {len(alarms[half])} of {judged[half]} outputs alarmed; {dict(count)}")
        for cause, name in alarms[half]:
            print(f"  {cause:<18} {name}")
    print(f"together: {len(alarms[0]) + len(alarms[1])} of {sum(judged)}; not run: {', '.join(missing) or 'none'}")


if __name__ == "__main__":
    main()
