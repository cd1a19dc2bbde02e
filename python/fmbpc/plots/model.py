"""Draws what `fmbpc identify`, `validate` or `model --plots DIR` wrote: fuzzy sets, predictions against data beside the inputs, correlation
of the residuals, step responses at several rests.

Writes memberships.png, steps.png and, of a record, prediction.png, detail.png (the rows in which the free run errs most, of a long
record) and residuals.png into DIR.
"""
import argparse
import json
import os

from fmbpc.plots.table import read_table

COLOURS = ["#1f5fa8", "#c8452d", "#3a8a4d", "#8a56a8", "#c98a1b", "#4a4a4a", "#2aa5a0", "#b0508a"]
PARTS = ("identification", "validation")
BINS = 900  # of a long curve: the lowest and the highest value of each are drawn
DETAIL = 400  # rows


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


def envelope(time, values):
    """The lowest and the highest value of each of BINS bins in their order, so that no peak is lost; short curves as they are."""
    if len(values) <= 2 * BINS:
        return time, values
    times, kept = [], []
    for b in range(BINS):
        rows = range(len(values) * b // BINS, len(values) * (b + 1) // BINS)
        known = [k for k in rows if values[k] == values[k]]
        ends = sorted((min(known, key=values.__getitem__), max(known, key=values.__getitem__))) if known else [rows[0]]
        times += [time[k] for k in ends]
        kept += [values[k] for k in ends]
    return times, kept


def worst_rows(columns, outputs):
    """The DETAIL rows in which the free runs of all outputs err most, each in its own span."""
    n = len(columns["time"])
    sums = [0.0] * (n + 1)
    for output in outputs:
        known = [v for v in columns[output] if v == v]
        span = (max(known) - min(known)) or 1.0
        for k, (y, run) in enumerate(zip(columns[output], columns[output + "_free_run"])):
            error = (y - run) / span
            sums[k + 1] += error * error if error == error else 0.0
    total = [0.0]
    for v in sums[1:]:
        total.append(total[-1] + v)
    first = max(range(n - DETAIL + 1), key=lambda k: total[k + DETAIL] - total[k])
    return slice(first, first + DETAIL)


def draw_part(plt, report, folder, part, columns, units, name, title):
    """One panel per output: free run and one step against the data; below them one per input and disturbance."""
    outputs, causes = list(report["rules"]), [c for c in report["causes"] if c in columns]
    heights = [2.2] * len(outputs) + [1.1] * len(causes)
    figure, axes = plt.subplots(len(heights), 1, squeeze=False, sharex=True, figsize=(11.0, sum(heights) + 0.9),
                                gridspec_kw={"height_ratios": heights})
    time, unit = time_axis(columns["time"])
    width = 0.6 if len(time) > 2 * BINS else 1.1

    def curve(axis, key, colour, text, **style):
        axis.plot(*envelope(time, columns[key]), color=colour, linewidth=width, label=text, **style)

    for axis, output in zip(axes[:, 0], outputs):
        curve(axis, output, "black", "data")
        if len(time) <= 2 * BINS:
            curve(axis, output + "_one_step", COLOURS[2], "one step", linestyle="--")
        run = columns[output + "_free_run"]
        curve(axis, output + "_free_run", COLOURS[0], "free run")
        band = report[part][output].get("interval", {}).get("free_run", {})
        if band.get("half_width") and len(time) <= 2 * BINS:
            axis.fill_between(time, [v - band["half_width"] for v in run], [v + band["half_width"] for v in run],
                              color=COLOURS[0], alpha=0.15, linewidth=0,
                              label="95 %% interval, holds %.0f %%" % (band["coverage"] or 0.0))
        laws = columns.get(output + "_laws_free_run")
        if laws and any(a != b for a, b in zip(laws, run) if a == a and b == b):
            curve(axis, output + "_laws_free_run", COLOURS[3], "what laws take")
        curve(axis, output + "_linear_free_run", COLOURS[1], "linear")
        known = sorted(v for v in columns[output] if v == v)
        span = (known[-1] - known[0]) or 1.0
        axis.set_ylim(known[0] - 0.15 * span, known[-1] + 0.15 * span)  # a run that leaves it is seen to leave
        axis.set_ylabel(label(output, units[output]))
        figures = report[part][output]
        axis.set_title("%s%s: free-run VAF %s %% (linear %s %%), one step %s %%" % (
            part, title, *["-" if f["vaf"] is None else "%.1f" % f["vaf"]
                           for f in (figures["free_run"], figures.get("linear", figures)["free_run"], figures["one_step"])]),
            fontsize=9, loc="left")
        tidy(axis)
    for axis, cause in zip(axes[len(outputs):, 0], causes):
        axis.plot(*envelope(time, columns[cause]), color=COLOURS[5], linewidth=width, drawstyle="steps-post" if width > 1.0 else "default")
        axis.set_ylabel(label(cause, units[cause]), fontsize=8)
        tidy(axis)
    axes[-1][0].set_xlabel("time [%s]" % unit)
    figure.suptitle(report["name"], fontsize=11)
    save(plt, figure, folder, name)


def draw_prediction(plt, report, folder):
    """A figure per part; of a long record a second one of the rows that the free run errs most in."""
    for name in ("prediction.png", "detail.png", "prediction_validation.png", "detail_validation.png"):
        if os.path.isfile(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))  # of an earlier run
    found = [part for part in PARTS if os.path.isfile(os.path.join(folder, part + ".csv"))]
    for part in found:
        columns, units = read_table(os.path.join(folder, part + ".csv"))
        ending = ".png" if part == found[0] else "_%s.png" % part
        draw_part(plt, report, folder, part, columns, units, "prediction" + ending, "")
        if len(columns["time"]) > 2 * BINS:
            rows = worst_rows(columns, list(report["rules"]))
            draw_part(plt, report, folder, part, {name: values[rows] for name, values in columns.items()}, units, "detail" + ending,
                      ", rows %d to %d, where it errs most" % (rows.start + 1, rows.stop))


def draw_steps(plt, report, folder):
    """One row per output, one panel per input: the answer to a step of one unit at each rest."""
    points = [p for p in report.get("points", []) if p.get("steps")]
    if not points:
        return
    outputs, inputs = list(points[0]["outputs"]), list(points[0]["inputs"])
    figure, axes = plt.subplots(len(outputs), len(inputs), squeeze=False,
                                figsize=(max(6.0, 3.2 * len(inputs) + 0.8), 2.4 * len(outputs) + 0.9))
    for row, output in zip(axes, outputs):
        for axis, cause in zip(row, inputs):
            for i, point in enumerate(points):
                step = point["steps"].get(output, {}).get(cause)
                if step is None:
                    continue
                time, unit = time_axis([k * report["sample_time_s"] for k in range(len(step))])
                axis.plot(time, step, color=COLOURS[i % len(COLOURS)], linewidth=1.1, label=point["name"])
                axis.set_xlabel("time [%s]" % unit)
            axis.set_title("%s by a unit of %s" % (output, cause), fontsize=9)
            tidy(axis, legend=False)
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.suptitle("%s: step responses, linearised at rest" % report["name"], fontsize=11)
    figure.legend(handles, labels, loc="lower center", ncol=min(max(len(labels), 1), 6), fontsize=8, frameon=False)
    figure.tight_layout(rect=(0, 0.4 / figure.get_figheight(), 1, 1))
    figure.savefig(os.path.join(folder, "steps.png"), dpi=110)
    plt.close(figure)


def draw_residuals(plt, report, folder):
    """One row per output; correlation with itself, then with each past input; both parts in each panel."""
    parts = [(part, report["correlations"][part]) for part in PARTS if part in report.get("correlations", {})]
    if not parts:
        return
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
    for draw in (draw_memberships, draw_steps, draw_prediction, draw_residuals):
        draw(plt, report, folder)
