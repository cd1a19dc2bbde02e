"""Draws the folder of `fmbpc commission`.

test.png: the record of watch and test, outputs with the limits of the brief, and inputs.
model.png: the response to a unit step of each input, of the likeliest model and of the ensemble; a slope where the output integrates.
"""
import argparse
import json
import math
import pathlib

import matplotlib.pyplot as plt
import numpy

from fmbpc.plots.table import read_table

RECORD, MODEL, LIMIT = "#1f5fa8", "#c8452d", "#777777"


def read(file):
    with open(file, encoding="utf-8") as stream:
        return json.load(stream)


def draw_test(folder):
    columns, units = read_table(folder / ("test.csv" if (folder / "test.csv").exists() else "watch.csv"))
    brief = read(folder / "brief.json")
    names = [name for name in columns if name != "time" and not name.endswith("_applied")]
    figure, axes = plt.subplots(len(names), 1, figsize=(9.0, 1.0 + 1.5 * len(names)), sharex=True, squeeze=False)
    for axis, name in zip(axes[:, 0], names):
        axis.step(columns["time"], columns[name], where="post", color=RECORD, lw=0.9)
        for side in ("lower", "upper"):
            if name in brief[side]:
                axis.axhline(brief[side][name], color=LIMIT, ls="--", lw=1)
        axis.set_ylabel(f"{name} [{units[name]}]" if units[name] else name)
        axis.grid(True, color="#dddddd")
    axes[-1, 0].set_xlabel("time [h]")
    figure.align_ylabels()
    figure.suptitle("Watch and test, limits dashed", fontsize=11)
    figure.tight_layout()
    figure.savefig(folder / "test.png", dpi=110)
    plt.close(figure)


def settling(e):
    if e["damping"] < 1.0:
        return e["dead_time_s"] + (3.0 / e["damping"] + 1.0) * e["time_constant_s"]
    first = 0.0 if e["integrating"] else abs(e["time_constant_s"])
    return e["dead_time_s"] + 3.0 * max(first, e["second_s"]) + min(first, e["second_s"])


def lag_response(t, poles):
    """Of 1 / product(tau s + 1) to a unit step at 0, poles the time constants, complex ones in pairs."""
    residues = [pole ** (len(poles) - 1) / numpy.prod([pole - other for other in poles if other is not pole]) for pole in poles]
    return numpy.real(1.0 - sum(r * numpy.exp(-t / pole) for r, pole in zip(residues, poles)))


def step(e, time):
    """y(t) of K (beta s + 1) exp(-theta s) over the lags of an element."""
    t = numpy.maximum(time - e["dead_time_s"], 0.0)
    one, two, lead = e["time_constant_s"], e["second_s"], e["lead_s"]
    if e["integrating"]:
        return e["gain"] * (t + ((lead - two) * -numpy.expm1(-t / two) if two > 0 else numpy.where(t > 0, lead, 0.0)))
    if e["damping"] < 1.0:
        swing = math.sqrt(1.0 - e["damping"] ** 2)
        poles = [complex(e["damping"], swing) * one, complex(e["damping"], -swing) * one]
    else:
        poles = [one] if two <= 0 else [one, two if abs(one - two) > 1e-6 * abs(one) else one * (1 + 1e-6)]
    y = lag_response(t, poles)
    if lead:  # the slope of the response
        residues = [pole ** (len(poles) - 2) / numpy.prod([pole - other for other in poles if other is not pole]) for pole in poles]
        y = y + numpy.where(t > 0, lead * numpy.real(sum(r * numpy.exp(-t / pole) for r, pole in zip(residues, poles))), 0.0)
    return e["gain"] * y


def draw_model(folder):
    outputs = read(folder / "model.json")["outputs"]
    sources = [e["from"] for e in outputs[0]["elements"]]
    figure, axes = plt.subplots(len(outputs), len(sources), figsize=(1.0 + 3.2 * len(sources), 0.8 + 2.2 * len(outputs)), squeeze=False)
    for output, row in zip(outputs, axes):
        for e, axis in zip(output["elements"], row):
            axis.set_title(f"{output['name']} from {e['from']}", fontsize=10)
            axis.grid(True, color="#dddddd")
            if not e["seen"]:
                axis.text(0.5, 0.5, "not seen", ha="center", va="center", transform=axis.transAxes)
                continue
            time = numpy.linspace(0.0, 1.3 * settling(e), 300)
            for member in e["ensemble"]:
                axis.plot(time, step(member, time), color=LIMIT, lw=0.6, alpha=0.6)
            axis.plot(time, step(e, time), color=MODEL, lw=1.8)
            axis.set_xlabel("time [s]")
    figure.suptitle("Responses to a unit step: likeliest model and ensemble", fontsize=11)
    figure.tight_layout()
    figure.savefig(folder / "model.png", dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    draw_test(folder)
    if (folder / "model.json").exists():
        draw_model(folder)
