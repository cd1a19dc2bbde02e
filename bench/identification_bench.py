#!/usr/bin/python3
"""The plain command `fmbpc identify DATA --auto` on simulated records of many kinds, judged in free run on records with new inputs: the
model it chose beside its linear one and beside a least-squares ARX model whose orders were chosen by free runs over the last rows.

    bench/identification_bench.py [KIND..] [--seeds N] [--first SEED] [--work W] [--tool FILE]

Prints a table; exit code 1 if on some record the chosen model is worse than linear by more than 5 %."""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy
from simulated_records import KINDS, records, write

TOOL = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "fmbpc"
LOSS = 1.05  # of the linear model's error: what a chosen model may lose
WINDOW = 5


def regressors(record, inputs, output, n, m, delay):
    """Rows (y(k-1)..y(k-n), u(k-1-delay).., 1) and targets y(k)."""
    y = record[output]
    first = max(n, m + delay)
    columns = [y[first - i:len(y) - i] for i in range(1, n + 1)]
    for name in inputs:
        columns += [record[name][first - delay - i:len(y) - delay - i] for i in range(1, m + 1)]
    return numpy.column_stack(columns + [numpy.ones(len(y) - first)]), y[first:]


def free_run(record, inputs, output, theta, n, m, delay):
    y = record[output]
    run, first = y.copy(), max(n, m + delay, WINDOW)
    run = numpy.where(numpy.isnan(run), numpy.nanmean(y), run)
    for k in range(first, len(y)):
        past = [run[k - i] for i in range(1, n + 1)]
        for name in inputs:
            past += [record[name][k - delay - i] for i in range(1, m + 1)]
        run[k] = numpy.clip(numpy.dot(past + [1.0], theta), -1e6, 1e6)
    return run


def rmse(record, output, run):
    error = (record[output] - run)[20:]
    return float(numpy.sqrt(numpy.nanmean(error * error)))


def fitted(parts, inputs, output, n, m, delay):
    rows = [regressors(part, inputs, output, n, m, delay) for part in parts]
    phi, y = numpy.vstack([r[0] for r in rows]), numpy.concatenate([r[1] for r in rows])
    known = numpy.isfinite(phi).all(axis=1) & numpy.isfinite(y)
    return numpy.linalg.lstsq(phi[known], y[known], rcond=None)[0]


def arx(parts, judge, inputs, output):
    """rmse of a free run over `judge` by the orders that run best over the last third of the first record."""
    whole = {name: numpy.where(numpy.isnan(v), numpy.nanmean(v), v) for name, v in judge.items() if name in inputs}
    whole[output] = judge[output]
    cut = len(parts[0][output]) * 2 // 3
    early, late = ({name: v[part] for name, v in parts[0].items()} for part in (slice(0, cut), slice(cut, None)))
    if any(numpy.isnan(late[name]).any() for name in inputs):
        late = {**late, **{name: numpy.nan_to_num(late[name]) for name in inputs}}
    best = (numpy.inf, None)
    for n, m in ((1, 1), (2, 1), (2, 2), (3, 3), (4, 4)):
        for delay in range(0, 9):
            theta = fitted([early] + parts[1:], inputs, output, n, m, delay)
            best = min(best, (rmse(late, output, free_run(late, inputs, output, theta, n, m, delay)), (n, m, delay)))
    theta = fitted(parts, inputs, output, *best[1])
    return rmse(whole, output, free_run(whole, inputs, output, theta, *best[1]))


def identify(folder, kind, seed, arguments):
    parts, judge, inputs, outputs = records(kind, seed)
    files = []
    for i, part in enumerate(parts):
        files.append(str(folder / ("%s_%d.csv" % (kind, i))))
        write(files[-1], part)
    held = folder / (kind + "_held_out.csv")
    write(held, judge)
    command = [arguments.tool, "identify", *files, "--auto", "--inputs", ",".join(inputs), "--outputs", ",".join(outputs),
               "--validate", str(held), "--work", str(arguments.work), "--json"]
    report = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    for output in outputs:
        validation = report["validation"][output]
        yield {"record": "%s %d, %s" % (kind, seed, output), "best": validation["best"],
               "blocks": report["cross_validation"][output][validation["best"]]["free_run"],
               "fuzzy": validation["free_run"]["rmse"], "linear": validation["linear"]["free_run"]["rmse"],
               "kinds": {k: validation[k]["free_run"]["rmse"] for k in ("state", "regressors") if k in validation},
               "arx": arx(parts, judge, inputs, output), "seconds": report["seconds"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--seeds", type=int, default=1, help="records of each kind")
    parser.add_argument("--first", type=int, default=1, help="first seed")
    parser.add_argument("--work", type=float, default=90.0, help="per record")
    parser.add_argument("--tool", default=str(TOOL), help="the tool fmbpc")
    arguments = parser.parse_args()
    unknown = [kind for kind in arguments.kinds if kind not in KINDS]
    if unknown:
        parser.error("unknown kind %s; known: %s" % (unknown[0], ", ".join(KINDS)))
    print("| record | chosen | rmse: blocks | held out | linear | chosen / linear | least-squares ARX | state, regressors | s |\n"
          "|---|---|---|---|---|---|---|---|---|")
    worse = 0
    with tempfile.TemporaryDirectory() as folder:
        for kind in arguments.kinds or KINDS:
            for seed in range(arguments.first, arguments.first + arguments.seeds):
                for r in identify(pathlib.Path(folder), kind, seed, arguments):
                    lost = r["fuzzy"] > LOSS * min(r["linear"], r["arx"])
                    worse += lost
                    print("| %s | %s | %.4g | %.4g | %.4g | %.3f%s | %.4g | %s | %.0f |" % (
                        r["record"], r["best"], r["blocks"], r["fuzzy"], r["linear"], r["fuzzy"] / r["linear"],
                        " worse" if lost else "", r["arx"], ", ".join("%.4g" % v for v in r["kinds"].values()), r["seconds"]), flush=True)
    print("\n%d worse than a linear model by more than %.0f %%" % (worse, 100.0 * (LOSS - 1.0)))
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
