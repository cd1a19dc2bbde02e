#!/usr/bin/python3
"""Two laws that tell each other their plans beside one law for both pumps and two that do not talk: pair_study.py [--seeds 24]; prints the table of
docs/plant_loops.md. Needs the package fmbpc (. scripts/env.sh)."""
import argparse
import concurrent.futures
import itertools
import json
import os
import pathlib
import subprocess
import tempfile

import numpy as np
from scipy.signal import cont2discrete

import fmbpc

TOOL = pathlib.Path(__file__).resolve().parents[1] / "scripts/fmbpc"
HOURS, SAMPLE_S = 1.0, 5.0
# level: (loop of its side, its pump, the other one, level at rest)
SIDES = {"h1": ("four_tanks_left", "v1", "v2", 12.6), "h2": ("four_tanks_right", "v2", "v1", 13.0)}
# johansson2000: gain [cm/V] and time constants [s] of each level from its own pump and from the other one. In non-minimum phase the pump that fills
# the upper tank is the level's own.
PLANTS = {"minimum phase": {"h1": ((2.6, 62, 0), (1.5, 62, 23)), "h2": ((2.8, 90, 0), (1.4, 90, 30))},
          "non-minimum phase": {"h1": ((2.5, 63, 39), (1.5, 63, 0)), "h2": ((2.5, 91, 56), (1.6, 91, 0))}}
WEIGHTS, WRONG = (2, 20, 100, 500), (0.0, 0.2)  # of the moves [(cm/V)^2]; largest relative error of the plant's gains


def submodel(level, own, other, elements, late):
    """The lags of one level sampled exactly. late: samples by which the other pump acts later."""
    rest = {"v1": 3.15, "v2": 3.15, level: SIDES[level][3]}
    taus = sorted({tau for _, *lags in elements for tau in lags if tau})
    common = np.poly(np.exp(-SAMPLE_S / np.array(taus)))
    terms = {f"{level}(k-{i - 1})": -float(common[i]) for i in range(1, len(common))}
    for pump, (gain, *lags), dead in ((own, elements[0], 0), (other, elements[1], late)):
        lags = [tau for tau in lags if tau]
        top = cont2discrete(([gain], np.poly([-1.0 / tau for tau in lags]) * np.prod(lags)), SAMPLE_S, "zoh")[0].ravel()
        missing = [tau for tau in taus if tau not in lags]
        top = np.polymul(top[1:], np.poly(np.exp(-SAMPLE_S / np.array(missing))) if missing else [1.0])
        for i, value in enumerate(top):
            terms[f"{pump}(k-{i + dead})"] = float(value)
    terms = {name.replace("(k-0)", "(k)"): value for name, value in terms.items()}
    offset = rest[level] - sum(value * rest[name.split("(")[0]] for name, value in terms.items())
    return {"antecedents": [], "regressors": list(terms), "rules": [{"then": {**terms, "offset": offset}}]}


def model(plant, levels):
    late = len(levels) - 1
    outputs, inputs = dict.fromkeys(levels, "cm"), {SIDES[level][1]: "V" for level in levels}
    ranges = {**{name: [0, 20] for name in outputs}, "v1": [0, 6], "v2": [0, 6]}
    return {"name": "exact", "source": "exact", "sample_time_s": SAMPLE_S, "outputs": outputs, "inputs": inputs,
            "disturbances": {} if late else {SIDES[levels[0]][2]: "V"}, "ranges": ranges,
            "submodels": {level: submodel(level, SIDES[level][1], SIDES[level][2], PLANTS[plant][level], late) for level in levels}}


def settings(folder, plant, levels, schedule, seed, weight, factors):
    """Keys over a loop of these levels: its plant, the exact model of the plant without errors, and the case. A folder of its own for the model."""
    file = pathlib.Path(folder, "-".join(levels) + ".yaml")
    file.write_text(json.dumps(model(plant, levels)), encoding="utf-8")
    found = {"sampling.duration_h": HOURS, "seed": seed, "setpoint.schedule": schedule, "model.file": str(file), "controller.reference_pole": 0.0}
    found.update({f"controller.weight_move.{SIDES[level][1]}": weight for level in levels})
    elements = [e for level in levels for e in PLANTS[plant][level]]
    for i, ((gain, tau, inner), factor) in enumerate(zip(elements, factors)):
        key = f"plant.matrix.elements.{i}."
        found.update({key + "gain": gain * float(factor), key + "time_constant_min": tau / 60, key + "second_time_constant_min": inner / 60})
    return found


def drawn(seed, wrong):
    """Setpoints of both levels, and factors of the four gains."""
    dice = np.random.default_rng(seed)
    schedules = {}
    for level, (*_, rest) in SIDES.items():
        times = np.cumsum(dice.uniform(0.05, 0.2, 40))
        schedules[level] = [{"time_h": float(t), level: float(rest + dice.uniform(-2.0, 2.0))} for t in times if t < HOURS - 0.1]
    return schedules, 1.0 + wrong * dice.uniform(-1.0, 1.0, (2, 2))


def figures(summaries):
    """ISE of both levels [cm2], mean absolute move of the pumps [V]."""
    outputs = [o for s in summaries for o in s["outputs"].values()]
    inputs = [u for s in summaries for u in s["inputs"].values()]
    return sum(o["ise"] for o in outputs), sum(u["mean_abs_move"] for u in inputs) / len(inputs)


def central(seed, plant, weight, wrong):
    schedules, factors = drawn(seed, wrong)
    schedule = sorted(schedules["h1"] + schedules["h2"], key=lambda step: step["time_h"])
    with tempfile.TemporaryDirectory() as folder:
        return figures([fmbpc.Loop("four_tanks", set=settings(folder, plant, ["h1", "h2"], schedule, seed, weight, factors.ravel())).run(progress=False).summary])


def pair(seed, plant, weight, wrong, link):
    schedules, factors = drawn(seed, wrong)
    with tempfile.TemporaryDirectory() as folder:
        loops = {level: {"loop": SIDES[level][0], "set": settings(folder, plant, [level], schedules[level], seed + 1000 * i, weight, factors[i])}
                 for i, level in enumerate(SIDES)}
        links = [{"from": "h2/v2", "to": "h1/v2", **link}, {"from": "h1/v1", "to": "h2/v1", **link}]
        file = pathlib.Path(folder, "pair.yaml")
        file.write_text(json.dumps({"pace": "lockstep", "loops": loops, "links": links}), encoding="utf-8")
        subprocess.run([TOOL, "run", "--plant", file, "--no-plot", "--out", f"{folder}/out"], check=True, stdout=subprocess.DEVNULL)
        return figures([json.loads(pathlib.Path(folder, "out", level, "summary.json").read_text(encoding="utf-8")) for level in SIDES])


CONTROLS = {"one law": None, "plans": {"plan": True}, "plans, cut at half the time": {"plan": True, "plan_until_h": HOURS / 2}, "no plans": {}}


def case(arguments):
    seed, control, *rest = arguments
    return central(seed, *rest) if CONTROLS[control] is None else pair(seed, *rest, CONTROLS[control])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=24)
    seeds = range(1, parser.parse_args().seeds + 1)
    best = ["| plant | gains off by | control | its best weight | ISE beside no plans, median (worst) | lower in |\n|---|---|---|---|---|---|"]
    print("| plant | gains off by | control | " + " | ".join(f"weight {w}" for w in WEIGHTS) + " |\n|---|---|---|" + "---|" * len(WEIGHTS), flush=True)
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count()) as pool:
        for plant, wrong in itertools.product(PLANTS, WRONG):
            found = {}
            for control in CONTROLS:
                runs = [np.array(list(pool.map(case, [(s, control, plant, w, wrong) for s in seeds]))) for w in WEIGHTS]
                cells = [f"{np.median(r[:, 0]):.0f} ({r[:, 0].max():.0f}), {np.median(r[:, 1]):.3f}" for r in runs]
                print(f"| {plant} | {wrong:.0%} | {control} | " + " | ".join(cells) + " |", flush=True)
                chosen = int(np.argmin([np.median(r[:, 0]) for r in runs]))
                found[control] = WEIGHTS[chosen], runs[chosen][:, 0]
            for control, (weight, ise) in found.items():
                ratio = ise / found["no plans"][1]
                if control != "no plans":
                    best.append(f"| {plant} | {wrong:.0%} | {control} | {weight} (no plans: {found['no plans'][0]}) | {np.median(ratio):.3f} ({ratio.max():.3f}) | "
                                f"{int((ratio < 1.0).sum())} of {len(seeds)} |")
    print("\nISE of both levels [cm2], median (worst), and mean absolute move of the pumps [V], over", len(seeds), "seeds.\n")
    print("\n".join(best))


if __name__ == "__main__":
    main()
