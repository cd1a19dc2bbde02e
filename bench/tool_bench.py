#!/usr/bin/python3
"""`fmbpc study` and `fmbpc tune` on two threads beside one, start and files included: tool_bench.py [--tool FILE] [--quick] [PAIRS]

Pairs in turn; prints lines of JSON as bench/pairs.hpp does.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parent.parent


def study(tool, seeds):
    return [tool, "study", "asp_case1", "asp_case1_clp", "--seeds", f"1:{seeds}"]


def tune(tool, evaluations):
    return [tool, "tune", "cstr_tracking", "cstr_law", "--evaluations", str(evaluations)]


def seconds(words, threads):
    with tempfile.TemporaryDirectory() as out:
        began = time.perf_counter()
        subprocess.run([*words, "--threads", str(threads), "--no-plot", "--out", out], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return time.perf_counter() - began


def row(path, words, pairs):
    ours, theirs = [], []
    for _ in range(pairs):
        ours.append(seconds(words, 2))
        theirs.append(seconds(words, 1))
    ratios = [b / a for a, b in zip(ours, theirs)]
    return {"path": path, "baseline": "one thread", "aim": "1.8", "ratio": statistics.median(ratios), "least": min(ratios), "most": max(ratios),
            "ours_us": 1e6 * statistics.median(ours), "baseline_us": 1e6 * statistics.median(theirs), "pairs": pairs}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", default=str(TOP / "scripts/fmbpc"))
    parser.add_argument("--quick", action="store_true", help="small sizes: shows that it works")
    parser.add_argument("pairs", nargs="?", type=int, default=10)
    options = parser.parse_args()
    seeds, evaluations = (2, 10) if options.quick else (80, 320)
    for line in (row(f"fmbpc study, two loops of 166 h over {seeds} seeds, two threads", study(options.tool, seeds), options.pairs),
                 row(f"fmbpc tune, {evaluations} evaluations, two threads", tune(options.tool, evaluations), options.pairs)):
        print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main()
