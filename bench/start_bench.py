#!/usr/bin/python3
"""Time from roslaunch to the first answered sample of a loop, beside that of four empty roscpp nodes until they speak:
start_bench.py [PAIRS] [LOOP]

Pairs in turn, each on a master of its own that is up before; prints one line of JSON as bench/pairs.hpp does. Before:
build empty_node, source scripts/env.sh.
"""
import json
import resource
import statistics
import sys
import tempfile

import launching

EMPTY = [f"/empty_{i}/up" for i in range(1, 5)]


def cpu():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def start(words, kind, names):
    """(seconds until heard, CPU seconds of all of it, the master and the watcher included)"""
    before = cpu()
    with launching.master() as env, launching.launched(env, words, kind, names) as (_, seconds):
        pass
    return seconds, cpu() - before


def main(pairs="10", loop="asp_case1_clp"):
    ours, theirs = [], []
    for _ in range(int(pairs)):
        theirs.append(start([str(launching.HERE / "empty.launch")], "empty", EMPTY))
        with tempfile.TemporaryDirectory() as out:
            # Of its own length, as users start it: a disturbance pattern is fitted over all samples before the first.
            ours.append(start(launching.loop_words(loop, out), "loop", ["/measurement"]))
    ratios = [b[0] / a[0] for a, b in zip(ours, theirs)]
    print(json.dumps({
        "path": f"start of a launch to the first sample, {loop}", "baseline": "roslaunch of four empty roscpp nodes", "aim": "0.77",
        "ratio": statistics.median(ratios), "least": min(ratios), "most": max(ratios), "pairs": len(ratios),
        "ours_us": 1e6 * statistics.median(s for s, _ in ours), "baseline_us": 1e6 * statistics.median(s for s, _ in theirs),
        "cpu_s": statistics.median(c for _, c in ours), "baseline_cpu_s": statistics.median(c for _, c in theirs)}))


if __name__ == "__main__":
    main(*sys.argv[1:])
