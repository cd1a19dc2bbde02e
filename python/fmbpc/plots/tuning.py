"""Convergence of a tuning (history.csv) or of several methods (compare.json): cost of the best so far.

    fmbpc tune LOOP TUNING --out DIR
"""
import argparse
import json
import pathlib

import matplotlib.pyplot as plt
import numpy

from fmbpc.plots.table import read_table

COLOURS = {"apso": "#c8452d", "pso": "#e09a2b", "de": "#1f5fa8", "cmaes": "#3a8f4d", "random": "#777777"}


def draw_one(axis, folder):
    columns, _ = read_table(folder / "history.csv")
    at, cost, best = (numpy.array(columns[name]) for name in ("evaluation", "cost", "best"))
    finite = numpy.isfinite(cost)
    top = best[numpy.isfinite(best)].max(initial=0.0)
    seen = finite & (cost <= 5.0 * top)
    axis.plot(at[seen], cost[seen], ".", ms=3, color="#bbbbbb", label="each point")
    axis.step(at, numpy.where(numpy.isfinite(best), best, numpy.nan), where="post", color="#c8452d", label="best so far")
    with open(folder / "tuning.json", encoding="utf-8") as stream:
        tuning = json.load(stream)
    if tuning["before"]["cost"] is not None:
        axis.axhline(tuning["before"]["cost"], color="k", ls=":", lw=1, label="untouched loop")
    low, high = axis.get_ylim()
    if low > 0 and high / low > 20:
        axis.set_yscale("log")
    axis.set_ylabel("cost")
    axis.set_title(f"{tuning['loop']}, {tuning['method']}", fontsize=10)


def draw_comparison(axis, comparison):
    """Cost above the least that any run found, in parts of it: methods differ in the last percent."""
    methods = [(method["method"], numpy.array([[numpy.inf if c is None else c for c in curve] for curve in method["curves"]]))
               for method in comparison["methods"]]
    least = min(curves.min() for _, curves in methods)
    for name, curves in methods:
        above = numpy.maximum(curves / least - 1.0, 1e-7)
        at = numpy.arange(1, curves.shape[1] + 1)
        middle = numpy.median(above, axis=0)
        colour = COLOURS.get(name)
        axis.plot(at, numpy.where(numpy.isfinite(middle), middle, numpy.nan), color=colour, label=name)
        axis.fill_between(at, above.min(axis=0), numpy.where(numpy.isfinite(above.max(axis=0)), above.max(axis=0), middle),
                          color=colour, alpha=0.1, lw=0)
    if comparison["before"] is not None:
        axis.axhline(comparison["before"] / least - 1.0, color="k", ls=":", lw=1, label="untouched loop")
    axis.set_yscale("log")
    axis.set_ylim(bottom=1e-6)
    axis.set_ylabel(f"cost above the least ({least:.4g}), relative")
    axis.set_title(f"{comparison['loop']}, {comparison['seeds']} seeds", fontsize=10)


def finish(axis):
    axis.set_xlabel("evaluations")
    axis.grid(True, which="major", color="#dddddd")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=pathlib.Path, help="several comparisons: one panel each")
    parser.add_argument("--out", help="default: convergence.png in the folder")
    arguments = parser.parse_args()
    count = len(arguments.folders)
    figure, axes = plt.subplots(1, count, figsize=(6.0 if count == 1 else 4.2 * count, 3.8), squeeze=False)
    for axis, folder in zip(axes[0], arguments.folders):
        compared = folder / "compare.json"
        single = folder / "tuning.json"
        newest = compared.exists() and (not single.exists() or compared.stat().st_mtime >= single.stat().st_mtime)
        if newest:
            with open(compared, encoding="utf-8") as stream:
                draw_comparison(axis, json.load(stream))
        else:
            draw_one(axis, folder)
        finish(axis)
    axes[0][0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(arguments.out or arguments.folders[0] / "convergence.png", dpi=110)
