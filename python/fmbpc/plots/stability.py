"""Draws stability.json of `fmbpc stability --out DIR`.

root_locus.png: closed-loop eigenvalues over the coincidence horizon against the unit circle, and their largest modulus.
margins.png: loop gain of each input against -1 (Nyquist) and sensitivity, at points of the loop's run.
bifurcation.png: steady states of the plant over its input, stable ones solid, unstable ones dashed, special points marked.
"""
import argparse
import json
import os

import matplotlib.colors
import matplotlib.pyplot as plt

MARKS = {"fold": ("o", "#c8452d"), "hopf": ("s", "#8a56a8"), "flip": ("D", "#3a8a4d"), "turning point": ("^", "#c98a1b")}


def draw_root_locus(report, folder):
    rows = [r for r in report.get("horizon", []) if r["applicable"]]
    if not rows:
        return
    figure, (plane, modulus) = plt.subplots(1, 2, figsize=(11, 5))
    x = [v[0] for r in rows for v in r["eigenvalues"]]
    y = [v[1] for r in rows for v in r["eigenvalues"]]
    horizon = [r["coincidence_steps"] for r in rows for _ in r["eigenvalues"]]
    points = plane.scatter(x, y, c=horizon, s=14, cmap="viridis", norm=matplotlib.colors.LogNorm())
    figure.colorbar(points, ax=plane, label="coincidence horizon H")
    plane.add_patch(plt.Circle((0, 0), 1, fill=False, color="0.5"))
    open_loop = report["blended"]["open_loop"]
    plane.plot([v[0] for v in open_loop], [v[1] for v in open_loop], "x", color="#c8452d", label="open loop")
    plane.set_aspect("equal")
    plane.set_xlim(-1.15, 1.15)
    plane.set_ylim(-1.15, 1.15)
    plane.set_xlabel("real part")
    plane.set_ylabel("imaginary part")
    plane.legend(loc="lower left")
    plane.set_title("%s: closed-loop eigenvalues" % report["name"])
    modulus.plot([r["coincidence_steps"] for r in rows], [r["radius"] for r in rows], ".-", color="#1f5fa8")
    modulus.axhline(1.0, color="0.5", linewidth=0.8)
    modulus.axvline(report["law"]["coincidence_steps"], color="#c98a1b", linewidth=0.8, label="H of the loop")
    modulus.set_xlabel("coincidence horizon H")
    modulus.set_ylabel("largest modulus")
    modulus.legend()
    figure.tight_layout()
    figure.savefig(os.path.join(folder, "root_locus.png"), dpi=110)


def draw_branch(axis, branch, output, first):
    """Stretches of equal stability, each with one point of its neighbour so that no gap shows."""
    points = branch["points"]
    start = 0
    for i in range(1, len(points) + 1):
        if i < len(points) and (points[i]["unstable"] > 0) == (points[start]["unstable"] > 0):
            continue
        stretch = points[start:min(i + 1, len(points))]
        unstable = points[start]["unstable"] > 0
        axis.plot([p["input"] for p in stretch], [p["state"][output] for p in stretch], "--" if unstable else "-",
                  color="#c8452d" if unstable else "#1f5fa8", label=None if unstable in first else ("unstable" if unstable else "stable"))
        first.add(unstable)
        start = i


def draw_bifurcation(report, folder):
    if "steady_states" not in report:
        return
    steady = report["steady_states"]
    output, seen = steady["output"], set()
    figure, axis = plt.subplots(figsize=(8, 5))
    for branch in steady["branches"]:
        draw_branch(axis, branch, output, seen)
        for point in branch["special"]:
            if point["kind"] == "turning point" and point["of"] != output:
                continue
            mark, colour = MARKS[point["kind"]]
            axis.plot(point["input"], point["state"][output], mark, color=colour,
                      label=None if point["kind"] in seen else point["kind"])
            seen.add(point["kind"])
    axis.set_xlabel("%s [%s]" % (steady["input"], steady["input_unit"]))
    axis.set_ylabel(output)
    axis.set_title("%s: steady states" % report["name"])
    axis.legend()
    figure.tight_layout()
    figure.savefig(os.path.join(folder, "bifurcation.png"), dpi=110)


def curve_of(row):
    gain = [complex(*v) if None not in v else complex("nan") for v in row["curve"]["loop_gain"]]
    return row["curve"]["rad_s"], gain


def draw_margins(report, folder):
    rows = [(point, row) for point in report.get("points", []) for row in point.get("inputs", []) if "curve" in row]
    if not rows:
        return
    figure, (plane, sensitivity) = plt.subplots(1, 2, figsize=(11, 5))
    for point, row in rows:
        omega, gain = curve_of(row)
        label = "%.4g h, %s: %s" % (point["time_h"], row["input"], point["verdict"])
        line, = plane.plot([g.real for g in gain], [g.imag for g in gain], linewidth=1.2)
        sensitivity.loglog(omega, [1 / abs(1 + g) for g in gain], color=line.get_color(), linewidth=1.2, label=label)
    plane.plot([-1], [0], "+", color="#c8452d", markersize=12)
    plane.add_patch(plt.Circle((0, 0), 1, fill=False, color="0.7", linewidth=0.8))
    plane.set_xlim(-2.5, 1.5)
    plane.set_ylim(-2, 2)
    plane.set_aspect("equal")
    plane.set_xlabel("real part of the loop gain")
    plane.set_ylabel("imaginary part")
    plane.set_title("%s: Nyquist" % report["name"])
    sensitivity.axhline(1.0, color="0.7", linewidth=0.8)
    sensitivity.set_xlabel("frequency [rad/s]")
    sensitivity.set_ylabel("sensitivity |1 / (1 + L)|")
    figure.tight_layout(rect=(0, 0.05 + 0.035 * len(rows), 1, 1))
    figure.legend(loc="lower center", fontsize="small", ncol=1)
    figure.savefig(os.path.join(folder, "margins.png"), dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="DIR")
    folder = parser.parse_args().folder
    with open(os.path.join(folder, "stability.json"), encoding="utf-8") as stream:
        report = json.load(stream)
    draw_margins(report, folder)
    draw_root_locus(report, folder)
    draw_bifurcation(report, folder)
