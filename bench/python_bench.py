#!/usr/bin/python3
"""The Python package beside its aims and beside the tool, in turn: python_bench.py FOLDER_OF_THE_PACKAGE TOOL ROUNDS; JSON lines.

Times are those of the processor, of this process and of those that it starts, so that other work on the machine counts little.
"""
import json
import os
import resource
import statistics
import subprocess
import sys

FOLDER, TOOL, ROUNDS = sys.argv[1], sys.argv[2], int(sys.argv[3])
sys.path.insert(0, FOLDER)
LONG = {"sampling.duration_h": 20000 if ROUNDS > 1 else 200}
STEPS = 20000 if ROUNDS > 1 else 200


def spent():
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


def seconds(call):
    start = spent()
    call()
    return spent() - start


def importing():
    subprocess.run([sys.executable, "-c", "import fmbpc"], check=True, env={**os.environ, "PYTHONPATH": FOLDER})


def starting():
    subprocess.run([sys.executable, "-c", "pass"], check=True)


def row(path, baseline, aim, ours, theirs):
    ratios = [b / a for a, b in zip(ours, theirs)]
    print(json.dumps({"path": path, "baseline": baseline, "ratio": statistics.median(ratios), "least": min(ratios), "most": max(ratios), "aim": aim,
                      "ours_us": 1e6 * statistics.median(ours), "baseline_us": 1e6 * statistics.median(theirs)}))


def main():
    imported = [seconds(importing) - seconds(starting) for _ in range(ROUNDS)]
    import fmbpc
    loop = fmbpc.Loop("asp_case1")
    law, plant = loop.controller(), loop.simulation()
    y, d = plant.outputs, plant.disturbance

    def step():
        for _ in range(STEPS):
            law.step(y, None, d)
    stepped = [seconds(step) / STEPS for _ in range(ROUNDS)]

    def run():
        return fmbpc.Loop("asp_case1", set=LONG).run(progress=False).summary

    def tool():
        subprocess.run([TOOL, "run", "asp_case1", "--set", f"sampling.duration_h={LONG['sampling.duration_h']}", "--json"], check=True, stdout=subprocess.DEVNULL)
    both = [(seconds(run), seconds(tool)) for _ in range(ROUNDS)]
    row("Python: Controller.step of asp_case1, arrays in and out", "20 us", "1", stepped, [20e-6] * ROUNDS)
    row("Python: Loop.run of asp_case1", "the tool", "0.95", [a for a, _ in both], [b for _, b in both])
    row("Python: import fmbpc, numpy included", "0.5 s", "1", imported, [0.5] * ROUNDS)


if __name__ == "__main__":
    main()
