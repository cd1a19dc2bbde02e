#!/usr/bin/python3
"""Nodes that branch and bound visits against the full tree, over the horizon and over the number of inputs.

    make -C build hybrid_bench
    build/bench/hybrid_bench --benchmark_filter=BM_Growth --benchmark_format=json > growth.json
    plot_tree_growth.py growth.json --out tree_growth.png
"""
import argparse
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def points(runs):
    """(levels, inputs, bound) -> (nodes, full tree)"""
    found = {}
    for run in runs:
        _, levels, inputs, _ = run["name"].replace("/iterations:1", "").split("/")
        found[int(levels), int(inputs), run["label"]] = (run["nodes"], run["full_tree"])
    return found


def draw(axis, found, keys, x_label):
    keys = sorted(keys)
    axis.semilogy([x for x, _ in keys], [found[(*key, "cost")][1] for _, key in keys], "k:", label="full tree")
    for bound, label, colour in (("cost", "bound by cost so far", "#c8452d"),
                                 ("reach", "bound by reachable error", "#1f5fa8")):
        axis.semilogy([x for x, _ in keys], [found[(*key, bound)][0] for _, key in keys], "o-", color=colour,
                      label=label)
    axis.set_xlabel(x_label)
    axis.grid(True, which="major", color="#dddddd")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("json")
    parser.add_argument("--out", default="tree_growth.png")
    arguments = parser.parse_args()
    with open(arguments.json, encoding="utf-8") as stream:
        found = points(json.load(stream)["benchmarks"])
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 3.6), sharey=True)
    draw(axes[0], found, {(levels, (levels, inputs)) for levels, inputs, _ in found if inputs == 7},
         "blocks of the horizon, 7 inputs")
    draw(axes[1], found, {(inputs, (levels, inputs)) for levels, inputs, _ in found if levels == 4},
         "input vectors, 4 blocks")
    axes[0].set_ylabel("nodes, mean of 40 states")
    axes[0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(arguments.out, dpi=110)


if __name__ == "__main__":
    main()
