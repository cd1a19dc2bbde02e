"""Draws runs of BSM1 as the field draws them, over each other.

DIR is a folder of `fmbpc run LOOP --out DIR`. Ammonium and total nitrogen of the effluent with their limits, aeration of tanks 3 to 5,
internal recirculation, influent (of the first run, and of others if theirs is another); days on the axis, counted from the beginning of
the test file (the last 14 days of the protocol), or of the run where it is shorter. Without --out: bsm1.png in the first folder.
"""
import argparse
import json
import os

from fmbpc.plots.table import read_table

COLOURS = ["#8a8a8a", "#c98a1b", "#1f5fa8", "#c8452d", "#3a8a4d"]
LIMITS = {"NH": 4.0, "TN": 18.0}
SOLIDS_PER_COD = 0.75
TEST_H = 336.0
XB, XP = 0.08, 0.06  # nitrogen in biomass and in its products


class Run:
    """The columns of one folder, by name without unit; what is measured as it really was."""

    def __init__(self, folder):
        self.columns, _ = read_table(os.path.join(folder, "trajectory.csv"))
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as stream:
            self.name = json.load(stream)["loop"]
        end = self.columns["time"][-1]
        self.whole = end >= TEST_H
        begin = end - TEST_H if self.whole else 0.0
        self.days = [(t - begin) / 24.0 for t in self.columns["time"]]

    def __getitem__(self, name):
        return self.columns.get(name + "_true", self.columns.get(name))

    def solids(self):
        parts = [self[name + "5"] for name in ("X_I", "X_S", "X_BH", "X_BA", "X_P")]
        return [SOLIDS_PER_COD * sum(values) for values in zip(*parts)]

    def total_nitrogen(self):
        """Solubles of the settler's top; particulates of tank 5 in proportion to the suspended solids."""
        share = [out / tank for out, tank in zip(self["TSS_L1"], self.solids())]
        bound = [nd + XB * (bh + ba) + XP * (p + i) for nd, bh, ba, p, i in
                 zip(self["X_ND5"], self["X_BH5"], self["X_BA5"], self["X_P5"], self["X_I5"])]
        return [nh + nd + no + s * x for nh, nd, no, s, x in
                zip(self["S_NH_L1"], self["S_ND_L1"], self["S_NO_L1"], share, bound)]

    def aeration(self):
        """Mean KLa of the three aerated tanks, which are of the same size."""
        return [sum(values) / 3.0 for values in zip(self["KLa3"], self["KLa4"], self["KLa5"])]


def panels(axes, run, colour, first, day):
    kept = [i for i, d in enumerate(run.days) if d >= day or not run.whole]
    days = [run.days[i] for i in kept]

    def draw(axis, values, **style):
        axis.plot(days, [values[i] for i in kept], color=colour, linewidth=1.2, **style)

    draw(axes[0], run["S_NH_L1"], label=run.name)
    draw(axes[1], run.total_nitrogen())
    draw(axes[2], run.aeration())
    draw(axes[3], [q / 1000.0 for q in run["Qintr"]])
    if first:
        axes[4].plot(days, [run["Q_in"][i] / 1000.0 for i in kept], color="#4a4a4a", linewidth=1.2, label="flow")
        axes[4].plot(days, [run["S_NH_in"][i] for i in kept], color="#3a8a4d", linewidth=1.0, label="ammonium [g/m3]")
        axes[4].legend(loc="upper right", ncol=2, fontsize=8)
    return days


def draw_other_influent(axis, run, first, day):
    """The flow of a run under another influent than the first one's: nobody should read it off the wrong curve."""
    rows = {round(t, 4): (q, n) for t, q, n in zip(first["time"], first["Q_in"], first["S_NH_in"])}
    if all(rows.get(round(t, 4), (q, n)) == (q, n) for t, q, n in zip(run["time"], run["Q_in"], run["S_NH_in"])):
        return
    kept = [i for i, d in enumerate(run.days) if d >= day or not run.whole]
    axis.plot([run.days[i] for i in kept], [run["Q_in"][i] / 1000.0 for i in kept], linestyle="--", linewidth=1.0,
              label="flow, " + run.name)
    axis.legend(loc="upper right", ncol=2, fontsize=8)


def draw_all(runs, day, out):
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(5, 1, sharex=True, figsize=(10, 11), constrained_layout=True)
    for number, run in enumerate(runs):
        panels(axes, run, COLOURS[number % len(COLOURS)], number == 0, day)
        draw_other_influent(axes[4], run, runs[0], day)
    labels = ("ammonium, effluent\n[g N/m3]", "total nitrogen,\neffluent [g N/m3]", "mean KLa of tanks\n3, 4, 5 [1/d]",
              "internal recirculation\n[1000 m3/d]", "influent: flow\n[1000 m3/d]")
    for axis, label in zip(axes, labels):
        axis.set_ylabel(label, fontsize=9)
        axis.grid(True, color="#dddddd", linewidth=0.6)
        axis.margins(x=0.0)
    for axis, key in zip(axes, ("NH", "TN")):
        axis.axhline(LIMITS[key], color="black", linestyle=":", linewidth=1.2)
    axes[0].legend(loc="upper right", ncol=len(runs), fontsize=9)
    axes[-1].set_xlabel("day of the test" if all(run.whole for run in runs) else "day of the run")
    figure.savefig(out, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="DIR")
    parser.add_argument("--names", default="", help="names in the legend, separated by commas")
    parser.add_argument("--from", dest="day", type=float, default=7.0, help="first day that is drawn (7)")
    parser.add_argument("--out", default="")
    options = parser.parse_args()
    runs = [Run(folder) for folder in options.folders]
    for run, name in zip(runs, filter(None, options.names.split(","))):
        run.name = name
    draw_all(runs, options.day, options.out or os.path.join(options.folders[0], "bsm1.png"))
