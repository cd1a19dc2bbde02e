"""Draws the figures of the papers as they come out here, with the printed numbers beside ours.

DIR holds the NAME.json files that `fmbpc reproduce --plots DIR` writes; NAME.png goes beside each.
"""
import argparse
import glob
import json
import os
import textwrap

COLOURS = ["#1f5fa8", "#c8452d", "#3a8a4d", "#8a56a8", "#c98a1b", "#4a4a4a"]
STYLES = {"setpoint": {"color": "black", "linestyle": "--", "linewidth": 1.0, "drawstyle": "steps-post", "zorder": 2},
          "reference": {"color": "#888888", "linestyle": ":", "linewidth": 1.2, "zorder": 2}}
DASHES = [(0, (6, 2)), (0, (2, 2)), (0, (6, 2, 2, 2))]
PRINTED = "#b0006d"
MARKERS = ["o", "s", "^", "v", "D", "P"]
ROWS = 12  # of the table below a picture
LINE = 0.115  # height of a line of it [in]


def draw_curves(axis, curves):
    number = 0
    for curve in curves:
        style = dict(STYLES.get(curve["style"], {}))
        if not style:
            style = {"color": COLOURS[number % len(COLOURS)], "linewidth": 1.3 - 0.15 * min(number, 3),
                     "zorder": 3 + number, "linestyle": "-" if number < len(COLOURS) else "--"}
            if curve["style"] == "step":
                style["drawstyle"] = "steps-post"
            number += 1
        axis.plot(curve["x"], curve["y"], label=curve["label"], **style)


def draw_marks(axis, marks):
    """What the paper prints: a line across the panel, or a dot."""
    for number, mark in enumerate(marks):
        style = {"color": PRINTED, "label": mark["label"], "zorder": 9}
        if mark["x"] is None:
            axis.axhline(mark["y"], linewidth=1.0, linestyle=DASHES[number % len(DASHES)], **style)
        else:
            axis.plot([mark["x"]], [mark["y"]], linestyle="none", marker=MARKERS[number % len(MARKERS)], markersize=5, **style)


def set_axes(axis, panel):
    axis.set_ylabel(panel["label"], fontsize=9)
    axis.grid(True, color="#dddddd", linewidth=0.6)
    axis.margins(x=0.0)
    axis.ticklabel_format(axis="y", useOffset=False)
    if panel["from"] is not None and panel["to"] is not None:
        axis.set_xlim(panel["from"], panel["to"])
    low, high = axis.get_ylim()
    if high - low < 1e-6 * max(abs(low), abs(high)):  # a constant: no microscope on rounding
        middle = 0.5 * (low + high)
        low, high = middle - 0.01 * abs(middle), middle + 0.01 * abs(middle)
        axis.set_ylim(low, high)
    labels = [entry["label"] for entry in panel["curves"] + panel["marks"]]
    if len(labels) > 1:
        columns = max(1, min(3, 100 // (8 + max(len(label) for label in labels))))
        lines = (len(labels) + columns - 1) // columns
        axis.set_ylim(low, high + (0.06 + 0.17 * lines) * (high - low))  # room for the legend
        axis.legend(loc="upper right", ncol=columns, fontsize=7, framealpha=0.85, borderpad=0.3)


def draw_panel(axis, panel):
    draw_curves(axis, panel["curves"])
    draw_marks(axis, panel["marks"])
    set_axes(axis, panel)


def cell(value):
    return "-" if value is None else "%.4g" % value


def here_text(row):
    """As many digits as tell the number of a statement that fails from its limit."""
    text = cell(row["here"])
    for digits in range(5, 18):
        if row["verdict"] != "fails" or text != cell(row["paper"]):
            break
        text = "%.*g" % (digits, row["here"])
    return text


def table_of(rows):
    """One line a row: quantity, paper (or limit), here with its range, verdict."""
    lines = []
    for row in rows[:ROWS]:
        here = here_text(row)
        if row["runs"] > 1:
            here += " (%s .. %s)" % (cell(row["lowest"]), cell(row["highest"]))
        kind = "limit" if row["kind"] == "check" else "paper"
        lines.append("%s: %s %s, here %s %s: %s" % (row["quantity"], kind, cell(row["paper"]), here, row["unit"],
                                                   row["verdict"].replace("_", " ")))
    if len(rows) > ROWS:
        lines.append("and %d more rows" % (len(rows) - ROWS))
    return "\n".join(textwrap.shorten(line, 150) for line in lines)


def draw(file):
    import matplotlib.pyplot as plt
    with open(file, encoding="utf-8") as stream:
        picture = json.load(stream)
    panels, text = picture["panels"], table_of(picture["rows"])
    below = LINE * (text.count("\n") + 1) + 0.1
    height = 1.9 * len(panels) + 1.0 + below
    shared = all(panel["from"] is None for panel in panels)
    figure, axes = plt.subplots(len(panels), 1, sharex=shared, squeeze=False, figsize=(9.0, height))
    for axis, panel in zip(axes[:, 0], panels):
        draw_panel(axis, panel)
    axes[-1, 0].set_xlabel(picture["x_label"])
    axes[0, 0].set_title(picture["title"], fontsize=10)
    figure.align_ylabels(axes[:, 0])
    figure.tight_layout(rect=(0.0, below / height, 1.0, 1.0))
    figure.text(0.02, 0.1 / height, text, fontsize=7, family="monospace", va="bottom", linespacing=1.15)
    figure.savefig(os.path.splitext(file)[0] + ".png", dpi=100)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="DIR", help="filled by fmbpc reproduce --plots DIR")
    parser.add_argument("--only", metavar="NAME", default="*", help="one experiment, as NAME.json is called")
    arguments = parser.parse_args()
    files = sorted(glob.glob(os.path.join(arguments.folder, arguments.only + ".json")))
    if not files:
        raise ValueError("no NAME.json in %s" % arguments.folder)
    for file in files:
        draw(file)
