"""Distributions of a study: costs of each loop, and its ratio to the loop that it is paired with, case by case.

    fmbpc study STUDY --out DIR
"""
import argparse
import json
import pathlib

import matplotlib.pyplot as plt
import numpy


def costs_of(study, name):
    return {run["case"]: numpy.inf if run["cost"] is None else run["cost"] for run in study["runs"] if run["loop"] == name}


def draw_costs(axis, study):
    names = [loop["name"] for loop in study["loops"]]
    finite = [numpy.array([c for c in costs_of(study, name).values() if numpy.isfinite(c)]) for name in names]
    axis.boxplot(finite, vert=False, showfliers=False, widths=0.6, medianprops={"color": "#c8452d"})
    for row, costs in enumerate(finite, start=1):
        lost = len(costs_of(study, names[row - 1])) - len(costs)
        shift = 0.25 * (numpy.arange(len(costs)) % 7 - 3) / 3.0
        axis.plot(costs, row + shift, ".", ms=3, color="#1f5fa8", alpha=0.6)
        if lost:
            axis.annotate(f"{lost} diverged", (1.0, row), xycoords=("axes fraction", "data"), ha="right", color="#c8452d", fontsize=8)
    axis.set_yticks(range(1, len(names) + 1), names, fontsize=8)
    everything = numpy.concatenate(finite) if finite else numpy.array([])
    if everything.size and everything.min() > 0 and everything.max() / everything.min() > 30:
        axis.set_xscale("log")
    axis.set_xlabel("cost")
    axis.invert_yaxis()


def draw_ratios(axis, study):
    for pair in study["pairs"]:
        mine, theirs = costs_of(study, pair["name"]), costs_of(study, pair["against"])
        ratios = numpy.sort([mine[c] / theirs[c] for c in mine if c in theirs and numpy.isfinite(mine[c]) and theirs[c] > 0])
        share = (numpy.arange(len(ratios)) + 0.5) / max(len(mine), 1)
        axis.step(ratios, 100.0 * share, where="mid", label=f"{pair['name']} ({100 * pair['share']:.0f} % won)")
    axis.axvline(1.0, color="k", ls=":", lw=1)
    axis.set_xscale("log")
    axis.set_ylim(0, 100)
    axis.set_xlabel(f"cost / cost of {study['pairs'][0]['against']}" if study["pairs"] else "")
    axis.set_ylabel("% of the pairs below")
    if study["pairs"]:
        axis.legend(fontsize=7)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    with open(folder / "study.json", encoding="utf-8") as stream:
        study = json.load(stream)
    height = 2.2 + 0.45 * len(study["loops"])
    panels = 2 if study["pairs"] else 1
    figure, axes = plt.subplots(1, panels, figsize=(5.2 * panels, max(height, 3.2)), squeeze=False)
    draw_costs(axes[0][0], study)
    if panels > 1:
        draw_ratios(axes[0][1], study)
    for axis in axes[0]:
        axis.grid(True, which="major", color="#dddddd")
        axis.set_axisbelow(True)
    figure.suptitle(study["title"] or study["study"], fontsize=10)
    figure.tight_layout()
    figure.savefig(folder / "distributions.png", dpi=110)
