"""Draws what `fmbpc identify --plots DIR` or `fmbpc validate --plots DIR` wrote: fuzzy sets, predictions against data, correlation of the residuals.

Writes memberships.png, prediction.png and residuals.png into DIR.
"""
import argparse
import json
import os

from fmbpc.plots.table import read_table

COLOURS = ["#1f5fa8", "#c8452d", "#3a8a4d", "#8a56a8", "#c98a1b", "#4a4a4a", "#2aa5a0", "#b0508a"]
PARTS = ("identification", "validation")
MOST_POINTS = 4000  # of a curve: more only make the file large


def label(name, unit):
    return "%s [%s]" % (name, unit) if unit else name


def tidy(axis, legend=True):
    axis.grid(True, color="#dddddd", linewidth=0.6)
    axis.margins(x=0.0)
    handles, _ = axis.get_legend_handles_labels()
    if handles and legend:
        low, high = axis.get_ylim()
        axis.set_ylim(low, high + 0.18 * (high - low))  # room for the legend
        axis.legend(loc="upper right", ncol=min(len(handles), 4), fontsize=8, framealpha=0.85, borderpad=0.3)


def save(plt, figure, folder, name):
    figure.tight_layout()
    figure.savefig(os.path.join(folder, name), dpi=110)
    plt.close(figure)


def draw_memberships(plt, report, folder):
    """One row per output, one panel per antecedent."""
    outputs = [(name, sets) for name, sets in report["memberships"].items() if sets]
    if not outputs:
        return
    width = max(len(sets) for _, sets in outputs)
    figure, axes = plt.subplots(len(outputs), width, squeeze=False, sharey=True,
                                figsize=(max(6.0, 2.6 * width + 0.8), 2.1 * len(outputs) + 0.7))
    for row, (output, sets) in zip(axes, outputs):
        for axis, panel in zip(row, sets):
            for rule, degrees in enumerate(panel["degrees"]):
                axis.plot(panel["z"], degrees, color=COLOURS[rule % len(COLOURS)], linewidth=1.2,
                          linestyle="-" if rule < len(COLOURS) else "--", label="rule %d" % (rule + 1))
            axis.set_xlabel(label(panel["variable"], panel["unit"]))
            axis.set_ylim(0.0, 1.05)
            tidy(axis, legend=False)
        for axis in row[len(sets):]:
            axis.set_visible(False)
        row[0].set_ylabel("membership, %s" % output)
    handles, labels = max((row[0].get_legend_handles_labels() for row in axes), key=lambda pair: len(pair[1]))
    projected = any(panel["projected"] for _, sets in outputs for panel in sets)
    figure.suptitle("%s: %s" % (report["name"], "multivariate sets of the rules, projected on each variable"
                                if projected else "fuzzy sets of the rules"), fontsize=11)
    figure.legend(handles, labels, loc="lower center", ncol=min(len(labels), 8), fontsize=8, frameon=False)
    figure.tight_layout(rect=(0, 0.35 / figure.get_figheight(), 1, 1))
    figure.savefig(os.path.join(folder, "memberships.png"), dpi=110)
    plt.close(figure)


def time_axis(seconds):
    longest = seconds[-1] if seconds else 0.0
    for unit, scale, enough in (("d", 86400.0, 20.0), ("h", 3600.0, 3.0), ("min", 60.0, 5.0)):
        if longest / scale >= enough:
            return [t / scale for t in seconds], unit
    return seconds, "s"


def draw_prediction(plt, report, folder):
    """One row per output and part: free run and one step against the data."""
    parts = [(part, *read_table(os.path.join(folder, part + ".csv"))) for part in PARTS
             if os.path.isfile(os.path.join(folder, part + ".csv"))]
    outputs = list(report["rules"])
    panels = [(output, part) for output in outputs for part in parts]
    figure, axes = plt.subplots(len(panels), 1, squeeze=False, figsize=(9.0, 2.4 * len(panels) + 0.6))
    for axis, (output, (part, columns, units)) in zip(axes[:, 0], panels):
        step = max(1, len(columns["time"]) // MOST_POINTS)
        time, unit = time_axis(columns["time"][::step])
        axis.plot(time, columns[output][::step], color="black", linewidth=1.1, label="data")
        axis.plot(time, columns[output + "_one_step"][::step], color=COLOURS[2], linewidth=0.9, linestyle="--",
                  label="one step")
        axis.plot(time, columns[output + "_free_run"][::step], color=COLOURS[0], linewidth=1.1, label="free run")
        band = report[part][output].get("interval", {}).get("free_run", {})
        if band.get("half_width"):
            run = columns[output + "_free_run"][::step]
            axis.fill_between(time, [v - band["half_width"] for v in run], [v + band["half_width"] for v in run],
                              color=COLOURS[0], alpha=0.15, linewidth=0,
                              label="95 %% interval, holds %.0f %%" % (band["coverage"] or 0.0))
        axis.plot(time, columns[output + "_linear_free_run"][::step], color=COLOURS[1], linewidth=0.8,
                  label="linear, free run")
        known = sorted(v for v in columns[output] if v == v)
        span = (known[-1] - known[0]) or 1.0
        axis.set_ylim(known[0] - 0.15 * span, known[-1] + 0.15 * span)  # a run that leaves it is seen to leave
        axis.set_ylabel(label(output, units[output]))
        axis.set_xlabel("time [%s]" % unit)
        figures = report[part][output]
        axis.set_title("%s: free-run VAF %s %% (linear %s %%), one step %s %%" % (
            part, *["-" if f["vaf"] is None else "%.1f" % f["vaf"]
                    for f in (figures["free_run"], figures.get("linear", figures)["free_run"], figures["one_step"])]),
            fontsize=9, loc="left")
        tidy(axis)
    figure.suptitle(report["name"], fontsize=11)
    save(plt, figure, folder, "prediction.png")


def draw_residuals(plt, report, folder):
    """One row per output; correlation with itself, then with each past input; both parts in each panel."""
    parts = [(part, report["correlations"][part]) for part in PARTS if part in report["correlations"]]
    outputs = list(report["rules"])
    causes = list(parts[0][1][outputs[0]]["cross"])
    figure, axes = plt.subplots(len(outputs), 1 + len(causes), squeeze=False, sharey="row",
                                figsize=(max(6.0, 3.0 * (1 + len(causes))), 2.2 * len(outputs) + 0.7))
    for row, output in zip(axes, outputs):
        for axis, cause in zip(row, [None] + causes):
            for (part, values), colour, shift in zip(parts, COLOURS, (-0.15, 0.15)):
                found = values[output]
                bars = found["auto"] if cause is None else found["cross"][cause]
                lags = [lag + shift for lag in range(1, len(bars) + 1)]
                axis.vlines(lags, 0.0, bars, color=colour, linewidth=1.4, label=part)
                for side in (-1.0, 1.0):
                    axis.axhline(side * found["bound"], color=colour, linewidth=0.9, linestyle=":")
            axis.axhline(0.0, color="black", linewidth=0.6)
            axis.set_xlabel("lag [samples]")
            axis.set_title("%s with %s" % (output, "itself" if cause is None else cause), fontsize=9)
            tidy(axis, legend=False)
            axis.set_xlim(0.0, len(bars) + 1.0)
        row[0].set_ylabel("correlation")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.suptitle("%s: one-step residuals" % report["name"], fontsize=11)
    figure.legend(handles, labels, loc="lower center", ncol=2, fontsize=8, frameon=False)
    figure.tight_layout(rect=(0, 0.35 / figure.get_figheight(), 1, 1))
    figure.savefig(os.path.join(folder, "residuals.png"), dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="DIR")
    folder = parser.parse_args().folder
    import matplotlib.pyplot as plt
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as stream:
        report = json.load(stream)
    for draw in (draw_memberships, draw_prediction, draw_residuals):
        draw(plt, report, folder)
