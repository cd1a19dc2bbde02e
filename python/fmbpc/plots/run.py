"""Draws a run, or several over each other, from trajectory.csv and summary.json, or from fmbpc.Run.

Outputs with setpoint and reference, inputs with their limits and the optimizer's perturbation, disturbances that change (gains
of the plant in a panel of their own); time in hours, of long runs in days, of short ones in minutes or seconds. One folder: DIR/plot.png.
Several folders are compared in comparison.png of the current folder: the first three in colour, the others in grey behind them; of each
output that they control its course, its error and the squared error summed up, which ends at the ISE of the table.
"""
import argparse
import json
import os
import textwrap

from fmbpc.plots.table import read_table

LONG_H = 240.0  # days beyond
FRONT = 3  # curves in colour
BEHIND = "#b5b5b5"
WIDE = 3.0  # an error panel shows so many times what the two best hold for 98 % of the time
COLOURS = ["#1f5fa8", "#c8452d", "#3a8a4d", "#8a56a8", "#c98a1b", "#4a4a4a"]
SUFFIXES = ("_setpoint", "_reference", "_true", "_commanded", "_base", "_perturbation")


class Run:
    """One folder: columns by name, units by name, the summary."""

    def __init__(self, summary, columns, units):
        self.summary, self.columns, self.units = summary, columns, units
        self.time = self.columns["time"]
        self.name = self.summary["loop"]
        self.title = self.summary.get("title") or self.name

    @classmethod
    def of(cls, run):
        """A folder, or an fmbpc.Run."""
        if hasattr(run, "summary"):
            return cls(run.summary, {name: list(map(float, run[name])) for name in run.names}, run.units)
        with open(os.path.join(run, "summary.json"), encoding="utf-8") as stream:
            return cls(json.load(stream), *read_table(os.path.join(run, "trajectory.csv")))

    def outputs(self):
        return list(self.summary["outputs"])

    def controlled(self):
        """All of them where nobody says which."""
        named = [n for n, y in self.summary["outputs"].items() if y.get("controlled", True)]
        return named or self.outputs()

    def error(self, name):
        return [y - r for y, r in zip(self.columns[name], self.columns[name + "_setpoint"])]

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


def draw_run(axis, runs, number, values, step=False, text=None):
    """The first ones in colour and in front, the best first; those behind thin and grey."""
    front = number < FRONT
    style = {"drawstyle": "steps-post"} if step else {}
    axis.plot(runs[number].time, values, color=COLOURS[number] if front else BEHIND, linewidth=1.3 if front else 0.9,
              label=text, zorder=4.0 - 0.1 * number if front else 2.0, **style)


def followed(run, name):
    return any(v == v for v in run.columns[name + "_setpoint"])  # not in an open-loop experiment


def draw_output(axis, runs, name):
    first = runs[0]
    if followed(first, name):
        axis.step(first.time, first.columns[name + "_setpoint"], where="post", color="black", linewidth=1.1,
                  linestyle="--", label="setpoint", zorder=5)
        reference = first.columns[name + "_reference"]
        if reference != first.columns[name + "_setpoint"]:
            axis.plot(first.time, reference, color=COLOURS[2] if len(runs) == 1 else COLOURS[0], linewidth=2.4 if len(runs) == 1 else 1.0,
                      linestyle="-" if len(runs) == 1 else ":", alpha=0.6,
                      label="reference" if len(runs) == 1 else "reference\nof the first")
    for number, run in enumerate(runs):
        draw_run(axis, runs, number, run.columns[name], text=name if len(runs) == 1 else None)
    draw_limits(axis, first.limits("outputs", name), [], True)
    axis.set_ylabel(label(first, name))


def draw_error(axis, runs, name):
    """As wide as the best two need, so that they can be told apart."""
    held = []
    for number, run in enumerate(runs):
        error = run.error(name)
        draw_run(axis, runs, number, error)
        sizes = sorted(abs(e) for e in error if e == e)
        if sizes:
            held.append((sizes[int(0.98 * (len(sizes) - 1))], sizes[-1]))
    if held:
        held.sort()
        limit = min(WIDE * held[min(1, len(held) - 1)][0], max(largest for _, largest in held))
        if limit > 0.0:
            axis.set_ylim(-1.05 * limit, 1.05 * limit)
    axis.axhline(0.0, color="black", linewidth=0.8, linestyle="--", zorder=5)
    axis.set_ylabel(label(runs[0], name).replace(name, name + " - setpoint", 1).replace(" [", "\n["))


def draw_squares(axis, runs, name):
    """Summed up: the last point is the ISE of the table; as high as the best two need, and twice that."""
    ends = []
    for number, run in enumerate(runs):
        total, sums = 0.0, []
        for e in run.error(name):
            total += e * e if e == e else 0.0
            sums.append(total)
        draw_run(axis, runs, number, sums)
        ends.append(total)
    ends.sort()
    top = max(e for e in ends if e <= 2.0 * ends[min(1, len(ends) - 1)])
    if top > 0.0:
        axis.set_ylim(0.0, 1.1 * top)
    axis.ticklabel_format(axis="y", scilimits=(-2, 4))
    axis.set_ylabel("sum of squared\nerrors of %s" % name)


def draw_input(axis, runs, name):
    values = [v for run in runs for v in run.columns[name]]
    for number, run in enumerate(runs):
        draw_run(axis, runs, number, run.columns[name], step=True, text=name if len(runs) == 1 else None)
    run = runs[0]
    if len(runs) == 1 and name + "_perturbation" in run.columns:
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


def titles_of(runs):
    """What all titles begin with, and what each of them adds: "Activated sludge, case 1" and "PI on biomass (asp_case1_pi_x)"."""
    if len(runs) == 1:
        return runs[0].title, []
    parts = [run.title.split(", ") for run in runs]
    same = 0
    while all(len(p) > same + 1 for p in parts) and len({p[same] for p in parts}) == 1:
        same += 1
    names = ["%s (%s)" % (", ".join(p[same:]), run.name) if run.title != run.name else run.name for p, run in zip(parts, runs)]
    return ", ".join(parts[0][:same]) or "Comparison", names


def time_unit(runs):
    """Hours, but seconds or minutes where the whole run is short and days where it is more than ten: (per hour, name)."""
    length = max(run.time[-1] for run in runs)
    if length > LONG_H:
        return (1.0 / 24.0, "d")
    return (3600.0, "s") if length < 0.1 else (60.0, "min") if length < 3.0 else (1.0, "h")


def panels_of(runs):
    """(draws, name, height) from above."""
    first = runs[0]
    if len(runs) == 1:
        panels = [(draw_output, n, 2.0) for n in first.outputs()]
    else:
        shared = [n for n in first.controlled() if all(n in run.controlled() for run in runs)] or first.controlled()
        panels = []
        for name in shared:
            panels.append((draw_output, name, 2.0))
            if all(followed(run, name) for run in runs):
                steps = len(set(first.columns[name + "_setpoint"])) > 1  # else it looks like the course itself
                panels += [(draw_error, name, 1.7)] * steps + [(draw_squares, name, 1.3)]
    panels += [(draw_input, n, 1.7) for n in first.inputs()]
    panels += [(draw_disturbance, n, 1.0) for n in first.disturbances() if changes(runs, n)]
    gains = [n for n in first.gains() if changes(runs, n)]
    return panels + ([(draw_gains, gains, 1.6)] if gains else [])


def legend_of_runs(figure, runs, names):
    """Below the title, a line each, the best known name first."""
    from matplotlib.lines import Line2D
    handles = [Line2D([], [], color=COLOURS[i] if i < FRONT else BEHIND, linewidth=2.0) for i in range(len(runs))]
    figure.legend(handles, names, loc="upper left", bbox_to_anchor=(0.01, 1.0 - 0.32 / figure.get_figheight()), ncol=1, fontsize=8.5,
                  frameon=False, borderaxespad=0.0)


def picture(runs):
    """A figure; the times of the runs are in its unit afterwards."""
    import matplotlib.pyplot as plt
    first = runs[0]
    per_hour, unit = time_unit(runs)
    for run in runs:
        run.time = [per_hour * hours for hours in run.time]
    panels = panels_of(runs)
    heights = [height for _, _, height in panels]
    title, names = titles_of(runs)
    head = 0.35 + 0.19 * len(names)  # inches
    tall = 1.15 * sum(heights) + 0.7 + head
    figure, axes = plt.subplots(len(panels), 1, sharex=True, squeeze=False, figsize=(9.6, tall),
                                gridspec_kw={"height_ratios": heights})
    for axis, (draw_panel, name, _) in zip(axes[:, 0], panels):
        draw_panel(axis, runs, name)
        axis.grid(True, color="#dddddd", linewidth=0.6)
        axis.margins(x=0.0)
        if axis.get_legend_handles_labels()[0]:  # beside the curves, not over them
            axis.legend(loc="upper left", bbox_to_anchor=(1.005, 1.0), borderaxespad=0.0, fontsize=8, frameon=False, handlelength=1.6)
    figure.align_ylabels(axes[:, 0])
    constant = held(first, [n for n in first.disturbances() if not changes(runs, n)])
    axes[-1, 0].set_xlabel("time [%s]" % unit + ("\nheld: " + textwrap.fill(constant, 110) if constant else ""))
    figure.text(0.5, 1.0 - 0.08 / tall, title, fontsize=11, ha="center", va="top")
    figure.tight_layout(rect=(0.0, 0.0, 1.0, 1.0 - head / tall), h_pad=0.5)
    if names:
        legend_of_runs(figure, runs, names)
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", metavar="DIR")
    parser.add_argument("--out", metavar="FILE")
    arguments = parser.parse_args()
    single = len(arguments.folders) == 1
    file = arguments.out or (os.path.join(arguments.folders[0], "plot.png") if single else "comparison.png")
    picture([Run.of(folder) for folder in arguments.folders]).savefig(file, dpi=110)
