#!/usr/bin/python3
"""`fmbpc study` and `fmbpc tune` on two threads beside one, a study on two MPI ranks beside one, start and files included, and the
time of `fmbpc identify --auto` beside its budget: tool_bench.py [--tool FILE] [--quick] [PAIRS]

Pairs in turn; prints lines of JSON as bench/pairs.hpp does. Answers of one and of two ranks are compared byte by byte.
"""
import argparse
import json
import pathlib
import random
import shutil
import statistics
import subprocess
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parent.parent
LONGEST_AUTO = 60  # [s] that a search may take


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
    return judged(path, "one thread", "1.8", ours, theirs)


def judged(path, baseline, aim, ours, theirs):
    ratios = [b / a for a, b in zip(ours, theirs)]
    return {"path": path, "baseline": baseline, "aim": aim, "ratio": statistics.median(ratios), "least": min(ratios), "most": max(ratios),
            "ours_us": 1e6 * statistics.median(ours), "baseline_us": 1e6 * statistics.median(theirs), "pairs": len(ratios)}


def ranks_seconds(tool, seeds, ranks):
    """(seconds, what is printed) of a study spread over MPI ranks."""
    words = ["mpirun", "--allow-run-as-root", "--bind-to", "none", "--oversubscribe", "-n", str(ranks), *study(tool, seeds),
             *(["--threads", "1"] if ranks == 1 else [])]
    with tempfile.TemporaryDirectory() as out:
        began = time.perf_counter()
        done = subprocess.run([*words, "--json", "--no-plot", "--out", out], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        return time.perf_counter() - began, done.stdout.replace(out.encode(), b"")


def ranks_row(tool, seeds, pairs):
    ours, theirs = [], []
    for _ in range(pairs):
        (two, answer), (one, expected) = ranks_seconds(tool, seeds, 2), ranks_seconds(tool, seeds, 1)
        if answer != expected:
            raise RuntimeError("a study on two ranks answers otherwise than on one")
        ours.append(two)
        theirs.append(one)
    return judged(f"fmbpc study, two loops of 166 h over {seeds} seeds, two MPI ranks", "one rank", "1.8", ours, theirs)


def record(path, rows, seed=1):
    """A record of two inputs and an output of a known nonlinear process of order two, measured with noise."""
    draw = random.Random(seed)
    u, v, y = [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]
    for k in range(2, rows):
        u.append(draw.uniform(-1, 1) if k % 20 == 0 else u[-1])
        v.append(draw.uniform(-1, 1) if k % 33 == 0 else v[-1])
        y.append(1.2 * y[-1] - 0.35 * y[-2] + 0.1 * u[-2] * (1.5 + y[-1]) + 0.05 * v[-1] + draw.gauss(0, 0.002))
    lines = ["time_s,u,v,y"] + [f"{k},{a!r},{b!r},{c + draw.gauss(0, 0.002)!r}" for k, (a, b, c) in enumerate(zip(u, v, y))]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def auto_row(tool, rows, options):
    with tempfile.TemporaryDirectory() as folder:
        data = pathlib.Path(folder) / "record.csv"
        record(data, rows)
        began = time.perf_counter()
        subprocess.run([tool, "identify", data, "--inputs", "u,v", "--outputs", "y", "--auto", *options, "--out", pathlib.Path(folder) / "model.yaml"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return judged(f"fmbpc identify --auto, {rows} rows x 3 signals", f"{LONGEST_AUTO} s", "1", [time.perf_counter() - began], [LONGEST_AUTO])


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
    if shutil.which("mpirun") and any((folder / "fmbpc_mpi").exists() for folder in (pathlib.Path(options.tool).parent, TOP / "devel/lib/fmbpc")):
        print(json.dumps(ranks_row(options.tool, seeds, options.pairs)), flush=True)
    print(json.dumps(auto_row(options.tool, *((200, ["--budget", "2"]) if options.quick else (1000, [])))), flush=True)


if __name__ == "__main__":
    main()
