#!/usr/bin/python3
"""Memory: peak of every node of a loop, and how record and identification grow with their samples.
memory_bench.py [--tool FILE] [--topics] [--quick]

Prints one line of JSON each: {"what", "peak_mb", "private_mb"} of a process, {"what", "mb_per_million"} of a growth (by two
sizes; the larger is a million samples, which identification is to hold in 2 GB). The nodes (--topics) are looked at after 10 s in lockstep; source scripts/env.sh before.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parent.parent
HOURS = 0.2  # a sample of asp_case1: 720 s


def print_json(**values):
    print(json.dumps(values), flush=True)


def peak_mb(words):
    """Largest resident size of a command."""
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    said = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, words))}: {said}")
    return used.ru_maxrss / 1024


def growth(what, sizes, words, **more):
    """Megabytes per million samples between two sizes."""
    small, large = (peak_mb(words(n)) for n in sizes)
    print_json(what=f"{what}, {sizes[1]:,} samples", mb_per_million=(large - small) * 1e6 / (sizes[1] - sizes[0]), peak_mb=large, samples=sizes[1], **more)


def tool_growth(tool, sizes, work):
    with tempfile.TemporaryDirectory() as folder:
        def run(n):
            return [tool, "run", "asp_case1", "--set", f"sampling.duration_h={n * HOURS}", "--out", f"{folder}/{n}", "--no-plot"]
        growth("record of a run (asp_case1: 2 outputs, 1 input, 2 disturbances, 6 states)", sizes, run)
        growth("identification of it (asp_d)", sizes,
               lambda n: [tool, "identify", f"{folder}/{n}/trajectory.csv", "asp_d", "--out", f"{folder}/m.yaml"], aim_mb=2048)
        growth("identify --auto of it", sizes,
               lambda n: [tool, "identify", f"{folder}/{n}/trajectory.csv", "--auto", "--inputs", "q_r", "--outputs", "x",
                          "--disturbances", "q_i", "s_i", "--work", work, "--out", f"{folder}/m.yaml"], aim_mb=2048)


def field_mb(pid, file, names):
    total = 0
    for line in pathlib.Path(f"/proc/{pid}/{file}").read_text(encoding="ascii").splitlines():
        name, _, value = line.partition(":")
        if name in names:
            total += int(value.split()[0])
    return total / 1024


def descendants(pid):
    found = []
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        for child in (task / "children").read_text(encoding="ascii").split():
            found += [int(child), *descendants(child)]
    return found


def nodes(seconds):
    import launching
    with tempfile.TemporaryDirectory() as out, launching.master() as env:
        words = [*launching.loop_words("asp_case1_clp", out), "set:=sampling.duration_h=100000"]
        with launching.launched(env, words, "loop", ["/measurement"]) as (launch, _):
            time.sleep(seconds)
            for pid in descendants(launch.pid):
                name = pathlib.Path(f"/proc/{pid}/comm").read_text(encoding="ascii").strip()
                print_json(what=f"node {name}", peak_mb=field_mb(pid, "status", ["VmHWM"]),
                           private_mb=field_mb(pid, "smaps_rollup", ["Private_Clean", "Private_Dirty"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--topics", action="store_true")
    parser.add_argument("--quick", action="store_true", help="small sizes: shows that it works")
    parser.add_argument("--tool", default=str(TOP / "scripts/fmbpc"))
    options = parser.parse_args()
    sizes, work = ((1000, 3000), "1") if options.quick else ((200000, 1000000), "10")
    tool_growth(options.tool, sizes, work)
    if options.topics:
        nodes(1 if options.quick else 10)


if __name__ == "__main__":
    main()
