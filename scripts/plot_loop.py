#!/usr/bin/python3
"""Draws a run, or several over each other, from trajectory.csv and summary.json.

    plot_loop.py DIR [DIR ...] [--out FILE]

Outputs with setpoint and reference, inputs with their limits and the optimizer's perturbation, disturbances that change (gains
of the plant in a panel of their own); time in hours, of long runs in days, of short ones in seconds. One folder: DIR/plot.png. Several folders are compared, one colour each, in comparison.png
of the current folder.
"""
import argparse
import csv
import json
import os
import sys
import textwrap

LONG_H = 240.0  # days beyond
LEGEND_COLUMNS = 4
COLOURS = ["#1f5fa8", "#c8452d", "#3a8a4d", "#8a56a8", "#c98a1b", "#4a4a4a"]
DASHES = [(7, 3), (3, 2), (9, 3, 2, 3), (1.5, 1.5), (5, 2, 1.5, 2, 1.5, 2)]
SUFFIXES = ("_setpoint", "_reference", "_true", "_commanded", "_base", "_perturbation")


class Run:
    """One folder: columns by name, units by name, the summary."""

    def __init__(self, folder):
        self.folder = folder
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as stream:
            self.summary = json.load(stream)
        with open(os.path.join(folder, "trajectory.csv"), newline="", encoding="utf-8") as stream:
            rows = list(csv.reader(stream))
        self.units, self.columns = {}, {}
        for i, cell in enumerate(rows[0]):
            name, _, unit = cell.partition("[")
            self.units[name] = unit.rstrip("]")
            self.columns[name] = [float(row[i]) if row[i] else float("nan") for row in rows[1:]]
        self.time = self.columns["time"]
        self.name = self.summary["loop"]

    def outputs(self):
        return list(self.summary["outputs"])

    def inputs(self):
        return list(self.summary["inputs"])

    def disturbances(self):
        """Columns between the inputs and the first setpoint, as the writer orders them."""
        names = list(self.columns)
        first = names.index(self.inputs()[-1]) + 1
        plain = [n for n in names[first:] if not n.endswith(SUFFIXES)]
        last = names.index(self.outputs()[0] + "_setpoint")
        return [n for n in plain if names.index(n) < last and not n.startswith("gain/")]

    def gains(self):
        """The plant's own gains: what changes in it, not what acts on it."""
        return [n for n in self.columns if n.startswith("gain/") and not n.endswith(SUFFIXES)]

    def limits(self, kind, name):
        return self.summary.get("limits", {}).get(kind, {}).get(name, {})


def label(run, name):
    """Name and unit, on two lines if they are long."""
    unit = run.units.get(name)
    return "%s%s[%s]" % (name, "\n" if len(name + unit) > 14 else " ", unit) if unit else name


def draw_limits(axis, limits, values, always):
    """Limits as dotted lines; far ones only if they do not squeeze the picture."""
    finite = [v for v in values if v == v]
    for key in ("lower", "upper"):
        limit = limits.get(key)
        near = finite and limit is not None and min(finite) - 1e-9 <= limit <= max(finite) + 1e-9
        if limit is not None and (always or near):
            known = axis.get_legend_handles_labels()[1]
            axis.axhline(limit, color="black", linewidth=1.1, linestyle=":", zorder=3,
                         label=None if "limit" in known else "limit")


def draw_run(axis, run, values, colour, text, drawn, step):
    """One line; all but the lowest have gaps, through which those below are seen."""
    style = {"drawstyle": "steps-post"} if step else {}
    if drawn:
        style["dashes"] = DASHES[(len(drawn) - 1) % len(DASHES)]
    drawn.append(values)
    axis.plot(run.time, values, color=colour, linewidth=1.2, label=text, zorder=3 + 0.1 * len(drawn), **style)


def draw_output(axis, runs, name):
    single = len(runs) == 1
    first = runs[0]
    followed = any(v == v for v in first.columns[name + "_setpoint"])  # not in an open-loop experiment
    if followed:
        axis.step(first.time, first.columns[name + "_setpoint"], where="post", color="black", linewidth=1.1,
                  linestyle="--", label="setpoint")
    if single and followed:
        axis.plot(first.time, first.columns[name + "_reference"], color=COLOURS[2], linewidth=2.4, alpha=0.6,
                  label="reference")
    drawn = []
    for run, colour in zip(runs, COLOURS):
        draw_run(axis, run, run.columns[name], colour, name if single else run.name, drawn, False)
    draw_limits(axis, first.limits("outputs", name), [], True)
    axis.set_ylabel(label(first, name))


def draw_input(axis, runs, name):
    single = len(runs) == 1
    values, drawn = [], []
    for run, colour in zip(runs, COLOURS):
        draw_run(axis, run, run.columns[name], colour, name if single else run.name, drawn, True)
        values += run.columns[name]
    run = runs[0]
    if single and name + "_perturbation" in run.columns:
        axis.step(run.time, run.columns[name + "_perturbation"], where="post", color=COLOURS[1], linewidth=0.9,
                  label="perturbation")
    draw_limits(axis, run.limits("inputs", name), values, False)
    axis.set_ylabel(label(run, name))


def draw_disturbance(axis, runs, name):
    drawn = []
    for run, colour in zip(runs, COLOURS):
        if name in run.columns and run.columns[name] not in drawn:
            drawn.append(run.columns[name])
            axis.step(run.time, run.columns[name], where="post", color="#666666" if len(drawn) == 1 else colour,
                      linewidth=1.0)
    axis.set_ylabel(label(runs[0], name))


def draw_gains(axis, runs, names):
    """All gains that change, each as a share of what it was at the start."""
    for number, name in enumerate(names):
        values = runs[0].columns[name]
        start = next((v for v in values if v == v and v != 0.0), 1.0)
        axis.step(runs[0].time, [v / start for v in values], where="post", linewidth=1.0 + 1.7 * (len(names) - 1 - number),
                  color=COLOURS[number % len(COLOURS)], label=name[len("gain/"):])
    axis.set_ylabel("gain /\nits start")


def changes(runs, name):
    return any(len(set(v for v in run.columns.get(name, []) if v == v)) > 1 for run in runs)


def held(run, names):
    """One line on the disturbances that never change."""
    return ", ".join(("%s %.4g %s" % (name, run.columns[name][0], run.units[name])).strip() for name in names)


def title_of(runs):
    return runs[0].summary.get("title") or runs[0].name if len(runs) == 1 else "Comparison"


def time_unit(runs):
    """Hours, but seconds where the whole run is a few minutes and days where it is more than ten: (per hour, name)."""
    length = max(run.time[-1] for run in runs)
    if length > LONG_H:
        return (1.0 / 24.0, "d")
    return (3600.0, "s") if length < 0.1 else (1.0, "h")


def draw(runs, file):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    first = runs[0]
    per_hour, unit = time_unit(runs)
    for run in runs:
        run.time = [per_hour * hours for hours in run.time]
    panels = [(draw_output, n, 2.0) for n in first.outputs()] + [(draw_input, n, 1.7) for n in first.inputs()]
    panels += [(draw_disturbance, n, 1.0) for n in first.disturbances() if changes(runs, n)]
    gains = [n for n in first.gains() if changes(runs, n)]
    panels += [(draw_gains, gains, 1.6)] if gains else []
    heights = [height for _, _, height in panels]
    figure, axes = plt.subplots(len(panels), 1, sharex=True, squeeze=False, figsize=(9.0, 1.15 * sum(heights) + 1.0),
                                gridspec_kw={"height_ratios": heights})
    for axis, (draw_panel, name, _) in zip(axes[:, 0], panels):
        draw_panel(axis, runs, name)
        axis.grid(True, color="#dddddd", linewidth=0.6)
        axis.margins(x=0.0)
        handles, _ = axis.get_legend_handles_labels()
        if handles:
            low, high = axis.get_ylim()
            rows = -(-len(handles) // LEGEND_COLUMNS)
            axis.set_ylim(low, high + 0.16 * rows * (high - low))  # room for the legend
            axis.legend(loc="upper right", ncol=min(len(handles), LEGEND_COLUMNS), fontsize=8, framealpha=0.85, borderpad=0.3)
    figure.align_ylabels(axes[:, 0])
    constant = held(first, [n for n in first.disturbances() if not changes(runs, n)])
    axes[-1, 0].set_xlabel("time [%s]" % unit + ("\nheld: " + textwrap.fill(constant, 110) if constant else ""))
    axes[0, 0].set_title(title_of(runs), fontsize=11)
    figure.tight_layout()
    figure.savefig(file, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", metavar="DIR")
    parser.add_argument("--out", metavar="FILE")
    arguments = parser.parse_args()
    single = len(arguments.folders) == 1
    file = arguments.out or (os.path.join(arguments.folders[0], "plot.png") if single else "comparison.png")
    try:
        draw([Run(folder) for folder in arguments.folders], file)
    except ImportError as error:
        print("plot_loop.py: no picture, a python module is missing: %s" % error, file=sys.stderr)
        return 3
    except (OSError, ValueError, KeyError, IndexError) as error:
        print("plot_loop.py: cannot read the run: %r" % error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
