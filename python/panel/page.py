#!/usr/bin/python3
"""fmbpc page: a finished run as one HTML file to send to somebody: trends, indices, what went otherwise than asked.

  fmbpc page RUN_FOLDER [--out FILE]   of `fmbpc run --out` or a launch; default: page.html in the folder
  fmbpc page BAG [--out FILE]          of loop.launch record:=true; default: beside the bag

Example: fmbpc page ~/.ros/fmbpc/asp_case1_clp
"""
import argparse
import json
import math
import os
import sys

import numpy

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, HERE)

from panel_server.history import plain, read_csv  # noqa: E402
from panel_server.tool import event_list  # noqa: E402

SUFFIXES = ("_setpoint", "_reference", "_true", "_commanded", "_base", "_perturbation")
MOST_NUMBERS = 2000000  # in one page


class PageError(Exception):
    """One line that says what is wrong."""


def read_folder(folder):
    """{title, complete, outputs (indices), events, names, units, table} of a folder with trajectory.csv and summary.json."""
    path, summary_path = os.path.join(folder, "trajectory.csv"), os.path.join(folder, "summary.json")
    for wanted in (path, summary_path):
        if not os.path.isfile(wanted):
            raise PageError(f"{folder}: expected the folder of a finished run ({os.path.basename(wanted)} is missing)")
    try:
        with open(summary_path, encoding="utf-8") as stream:
            summary = json.load(stream)
    except ValueError as error:
        raise PageError(f"{summary_path}: expected JSON ({error})") from error
    try:
        names, units, table = read_csv(path)
    except ValueError as error:
        raise PageError(str(error)) from error
    if not table.size or names[0] != "time":
        raise PageError(f"{path}: expected a column time[h] and rows of {len(names)} numbers")
    return {"title": summary.get("title") or summary.get("loop", folder), "complete": bool(summary.get("complete")), "outputs": summary.get("outputs", {}),
            "inputs": list(summary.get("inputs", {})), "events": summary.get("events", []), "names": names, "units": units, "table": table, "ranges": {}}


def read_bag(path):
    """The same of a bag; of several runs the last one."""
    import rosbag  # noqa: PLC0415: folders need no ROS
    info, rows, events, finished = None, {}, {}, False
    try:
        bag = rosbag.Bag(path)
    except (rosbag.ROSBagException, OSError) as error:
        raise PageError(f"{path}: expected a bag ({error})") from error
    with bag:
        for topic, message, _ in bag.read_messages():
            name = topic.rsplit("/", 1)[-1]
            if name == "plant_info":
                if info is None or message.run_id != info.run_id:
                    info, rows, events, finished = message, {}, {}, False
            elif info is not None and getattr(message, "run_id", None) == info.run_id:
                row = rows.setdefault(message.step, {}) if name in ("measurement", "tracking", "control_action", "base_action") else {}
                if name == "measurement":
                    row.update({s.name: v for s, v in zip(info.outputs, message.outputs)})
                    row.update({s.name: v for s, v in zip(info.disturbances, message.disturbances)})
                    rows.get(message.step - 1, {}).update({s.name: v for s, v in zip(info.inputs, message.input_applied)})  # in force until now
                    finished = finished or message.final
                elif name == "tracking":
                    row.update({s.name + "_setpoint": v for s, v in zip(info.outputs, message.setpoint)})
                    row.update({s.name + "_reference": v for s, v in zip(info.outputs, message.reference)})
                elif name in ("control_action", "base_action"):
                    row.update({s.name + ("_commanded" if name == "control_action" else "_base"): v for s, v in zip(info.inputs, message.input)})
                elif name == "loop_state":
                    for e in message.events:
                        events[(e.code, e.signal)] = {"code": e.code, "severity": ("info", "warning", "error")[min(e.severity, 2)], "signal": e.signal, "first": e.first,
                                                      "last": e.last, "count": e.count, "text": e.text}
    if info is None or not rows:
        raise PageError(f"{path}: expected plant_info and measurements of a loop")
    names = ["time"] + sorted({c for row in rows.values() for c in row})
    steps = range(min(rows), max(rows) + 1)
    table = numpy.array([[k * info.sample_time_s / 3600.0] + [rows.get(k, {}).get(c, math.nan) for c in names[1:]] for k in steps])
    units = {s.name: s.unit for s in list(info.outputs) + list(info.inputs) + list(info.disturbances)}
    outputs = {s.name: {"unit": s.unit, **indices(table, names, s.name)} for s in info.outputs}
    return {"title": f"{info.name}, {os.path.basename(path)}", "complete": finished, "outputs": outputs, "inputs": [s.name for s in info.inputs], "events": list(events.values()),
            "names": names, "units": units, "table": table, "ranges": {s.name: (s.lower, s.upper) for s in info.inputs}}


def indices(table, names, output):
    """As summary.json has them: sums over the samples."""
    if output + "_setpoint" not in names or output not in names:
        return {}
    error = table[:, names.index(output + "_setpoint")] - table[:, names.index(output)]
    good = numpy.isfinite(error)
    error, time = error[good], table[good, 0]
    return {"ise": float((error ** 2).sum()), "iae": float(abs(error).sum()), "itae": float((time * abs(error)).sum()), "rmse": float(math.sqrt((error ** 2).mean()))} if len(error) else {}


def contents(run, events):
    """What the page is given."""
    names, table = run["names"], run["table"]
    hours = table[:, 0]
    dt = float(numpy.median(numpy.diff(hours))) * 3600.0 if len(hours) > 1 else 1.0
    outputs = [n for n in run["outputs"] if n in names]
    inputs = [n for n in run["inputs"] if n in names or n + "_commanded" in names]
    known = set(outputs) | set(inputs) | {"time"}
    # Disturbances are measured, and stand before the first column that belongs to another one; states stand behind.
    first = next((i for i, n in enumerate(names) if n.endswith(SUFFIXES)), len(names))
    disturbances = [n for n in names[1:first] if n not in known]
    if not any(n.endswith("_true") for n in names):  # a bag: in the order of the alphabet
        disturbances = [n for n in names[1:] if n not in known and not n.endswith(SUFFIXES)]
    columns, data = [], []
    for name in names[1:]:
        base = next((name[:-len(s)] for s in SUFFIXES if name.endswith(s)), name)
        if base not in known and name not in disturbances:
            continue
        if name.endswith(("_true", "_perturbation")):
            continue
        target = name[:-len("_commanded")] if name.endswith("_commanded") else name + "_applied" if name in inputs else name
        columns.append(target)
        data.append(plain(table[:, names.index(name)]))
    if len(columns) * len(hours) > MOST_NUMBERS:
        raise PageError(f"expected a run of at most {MOST_NUMBERS // max(len(columns), 1)} samples for a page, got {len(hours)}")
    steps = [int(s) for s in numpy.rint(hours * 3600.0 / dt)]

    def signal(name):
        low, high = run["ranges"].get(name, (-math.inf, math.inf))
        return {"name": name, "unit": run["units"].get(name, ""), "value": None, "lower": low if math.isfinite(low) else None, "upper": high if math.isfinite(high) else None}
    return {"loop": {"name": "run", "title": run["title"], "step": steps[-1], "outputs": [signal(n) for n in outputs], "inputs": [signal(n) for n in inputs],
                     "disturbances": [signal(n) for n in disturbances], "ahead": None},
            "series": {"name": "run", "run": "0", "columns": columns, "steps": steps, "wall": [None] * len(steps), "data": data, "dt": dt},
            "complete": run["complete"], "samples": len(steps), "outputs": run["outputs"], "events": run["events"],
            "remedies": {code: {"remedy": event["remedy"]} for code, event in events.items()}}


def page(given):
    """The HTML: scripts, styles and data in one file that loads nothing."""
    def text(name):
        with open(os.path.join(HERE, "web", name), encoding="utf-8") as stream:
            return stream.read()

    def script(code):
        return "<script>" + code.replace("</script", "<\\/script") + "</script>"
    # No name of a signal may end the script or open another.
    data = json.dumps(given, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
    html = text("index.html")
    policy = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
    html = html.replace('<meta charset="utf-8">', f'<meta charset="utf-8">\n<meta http-equiv="Content-Security-Policy" content="{policy}">')
    html = html.replace('<link rel="icon" href="icon.svg">\n', "")
    html = html.replace('<link rel="stylesheet" href="uPlot.css">', "<style>" + text("uPlot.min.css") + "</style>").replace('<link rel="stylesheet" href="app.css">', "<style>" + text("app.css") + "</style>")
    scripts = script("window.FMBPC_RUN=" + data) + script("/*\n" + text("uPlot.LICENSE") + "\n*/\n" + text("uPlot.iife.min.js")) + script(text("app.js"))
    return html.replace('<script src="uPlot.js"></script>\n<script src="app.js"></script>', scripts)


def main():
    parser = argparse.ArgumentParser(prog="fmbpc page", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.error = lambda message: sys.exit(f"fmbpc: page: {message}")
    parser.add_argument("run", metavar="RUN_FOLDER|BAG")
    parser.add_argument("--out", default="")
    parser.add_argument("--tool", default="", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    folder = os.path.isdir(arguments.run)
    if not folder and not os.path.isfile(arguments.run):
        raise PageError(f"{arguments.run}: expected the folder of a run, or a bag")
    run = read_folder(arguments.run) if folder else read_bag(arguments.run)
    out = arguments.out or (os.path.join(arguments.run, "page.html") if folder else os.path.splitext(arguments.run)[0] + ".html")
    html = page(contents(run, event_list(arguments.tool)))
    try:
        with open(out, "w", encoding="utf-8") as stream:
            stream.write(html)
    except OSError as error:
        raise PageError(f"{out}: expected a file that can be written ({error.strerror})") from error
    print(f"written: {out}")


if __name__ == "__main__":
    try:
        main()
    except PageError as problem:
        sys.exit(f"fmbpc: page: {problem}")
