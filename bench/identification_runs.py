"""Sections of bench/identification_table.py that need no public record: models found by --auto in closed loop, structures chosen by
hand, the cases of the thesis, models with states of their own, a long record. Each function gives the lines of a table."""
import json
import os
import pathlib
import subprocess
import time

import numpy

HERE = pathlib.Path(__file__).resolve().parent
TOOL = HERE.parent / "scripts" / "fmbpc"
CONFIG = HERE.parent / "config"
CLOSE = 1.05  # of the shipped model's cost in closed loop
AIM_OWN, AIM_OTHER = 79.0, 61.0  # VAF of x without x_r: half way from 60 and 25 to 98

# study: record, rows, columns and what is known, model file
LOOPS = {
    "auto_tank": ("surge_tank_excite", "1:1003", ["--inputs", "I", "--outputs", "H"], "surge_tank_auto"),
    "auto_column": ("column_excite", "1:1001", ["--inputs", "L,V", "--outputs", "y_D,x_B"], "column_auto"),
    "auto_cstr": ("cstr_excite", "1:3000", ["--inputs", "q_c", "--outputs", "CA", "--known", "CA: {gain: {q_c: positive}}"], "cstr_auto"),
    "auto_sludge": ("asp_excite", "1:3321", ["--inputs", "q_r", "--disturbances", "q_i,s_i", "--outputs", "s,x,x_r"], "asp_auto"),
    "auto_sludge_d": ("asp_excite", "1:3321", ["--inputs", "q_r", "--disturbances", "q_i,s_i", "--outputs", "s,x"], "asp_auto_d"),
}

# structure: record (a public file or a loop), rows, what judges it (rows, or another loop)
STRUCTURES = [
    ("daisy_cstr", "daisy_cstr.csv", "1:5000", "5001:7500"),
    ("box_jenkins_2", "box_jenkins_gas_furnace.csv", "1:200", "201:"),
    ("box_jenkins_6", "box_jenkins_gas_furnace.csv", "1:200", "201:"),
    ("cascaded_tanks", "cascaded_tanks_estimation.csv", "1:512", "513:"),
    ("cascaded_tanks", "cascaded_tanks_estimation.csv", "513:", "1:512"),
    ("surge_tank", "surge_tank_excite", "1:", "surge_tank_excite_validation"),
    ("mimo_cstr", "mimo_cstr_excite", "1:", "mimo_cstr_excite_validation"),
    ("asp_d_xr", "asp_excite", "1:", "asp_excite_validation"),
]

# case: structure, judged on its own record, what the thesis tells of s and x
CASES = {
    "A, own data, without q_i": ("asp_a", True, "over 92", "over 92"),
    "B, held out, without q_i": ("asp_b", False, "about 62", "about 42"),
    "C, own data": ("asp_c", True, "99", "87"),
    "D, held out": ("asp_d", False, "95", "66"),
}
PAIRS = [(1, 2), (11, 61), (12, 62), (13, 63)]  # seeds of levels and loads: own record, another


def asked(*arguments):
    return json.loads(subprocess.run([str(TOOL), *map(str, arguments), "--json"], check=True, capture_output=True, text=True).stdout)


class Records:
    """Records of loops, each run once, in a folder."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def of(self, loop, seed=None):
        out = self.folder / (loop if seed is None else "%s_%d" % (loop, seed))
        if not out.exists():
            command = [str(TOOL), "run", loop, "--out", str(out)]
            if seed is not None:
                command += ["--set", "seed=%d" % seed]
            subprocess.run(command, check=True, capture_output=True)
        found = list(out.rglob("trajectory.csv"))
        if len(found) != 1:
            raise SystemExit("identification_table.py: one trajectory.csv of %s was expected below %s" % (loop, out))
        return found[0]


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"] + ["| " + " | ".join(row) + " |" for row in rows]


def study_of(name, model, folder):
    """The shipped study with this model in place of the shipped one of the same name."""
    text = (CONFIG / "study" / (name + ".yaml")).read_text(encoding="utf-8")
    if text.count(LOOPS[name][3] + ".yaml") != 1:
        raise SystemExit("identification_table.py: config/study/%s.yaml names %s.yaml once" % (name, LOOPS[name][3]))
    own = pathlib.Path(folder) / (name + ".yaml")
    own.write_text(text.replace(LOOPS[name][3] + ".yaml", str(model)), encoding="utf-8")
    return asked("study", own)


def loop_row(name, told):
    pair = told["pairs"][0]
    cost = {loop["name"]: loop["median"] for loop in told["loops"]}
    low, high = pair["ratio_interval"]
    interval = " (%.3f to %.3f)" % (low, high) if low is not None else ""  # too few cases
    return ["`%s`" % name, told["title"].split(", model")[0], "%.4g" % cost["auto"], "%.4g" % cost[told["loops"][1]["name"]],
            "%.3f" % pair["median_ratio"] + interval, "yes" if pair["median_ratio"] <= CLOSE else "**no**"]


def loops(records, work, write):
    rows = []
    for name, (record, part, columns, model) in LOOPS.items():
        file = records.folder / (model + ".yaml")
        asked("identify", records.of(record), "--auto", "--kind", "regressors", "--rows", part, *columns, "--work", work, "--out", file)
        if write:
            (CONFIG / "model" / file.name).write_text(file.read_text(encoding="utf-8"), encoding="utf-8")
        rows.append(loop_row(name, study_of(name, file, records.folder)))
    return table(["study", "loop", "median cost, by --auto", "shipped model", "ratio of pairs (95 %)", "within 5 %"], rows)


def structures(records, work, write):
    rows = []
    for name, source, part, judge in STRUCTURES:
        public = source.endswith(".csv")
        data = os.path.join(os.environ["FMBPC_DATA"], source) if public else records.of(source)
        judged = ["--validate-rows", judge] if public else ["--validate", records.of(judge)]
        told = asked("identify", data, name, "--rows", part, *judged)["validation"]
        for output, f in told.items():
            if output == "linear":
                continue
            line = f["linear"]
            rows.append(["%s, %s, %s" % (source.replace(".csv", ""), part, output), name, judge]
                        + ["%.4g / %.4g" % (f[k][v], line[k][v]) for k in ("one_step", "free_run") for v in ("rmse", "fit")])
    return table(["record, rows, output", "structure", "judged on", "one step: rmse, fuzzy / linear", "fit %", "free run: rmse", "fit %"], rows)


def cases(records, work, write):
    rows = []
    own, other = records.of("asp_excite"), records.of("asp_excite_validation")
    for case, (structure, on_own, thesis_s, thesis_x) in CASES.items():
        told = asked("identify", own, structure, "--validate", other)["identification" if on_own else "validation"]
        vaf = {o: told[o]["free_run"]["vaf"] for o in ("s", "x")}
        line = {o: told[o]["linear"]["free_run"]["vaf"] for o in ("s", "x")}
        rows.append([case, "%.1f" % vaf["s"], thesis_s, "%.1f" % vaf["x"], thesis_x,
                     " / ".join("%.1f" % v if v > 0 else "below 0" for v in line.values())])
    return table(["case", "s here", "s thesis", "x here", "x thesis", "linear here, s / x"], rows)


def vaf_text(told, kind, aim):
    figures = told["x"].get(kind, told["x"])  # the model that laws take stands without its kind
    vaf = figures["free_run"]["vaf"]
    return "%s (%s)%s" % ("%.1f" % vaf if vaf > 0 else "below 0", kind, "" if vaf >= aim else ", **no**")


def states(records, work, write):
    rows = []
    for own, other in PAIRS:
        model = records.folder / ("without_xr_%d.yaml" % own)
        report = asked("identify", records.of("asp_excite", own), "--auto", "--inputs", "q_r", "--disturbances", "s_i", "--outputs", "s,x",
                       "--time", "time", "--work", work, "--out", model)
        best = report["cross_validation"]["x"]["best"]
        told = asked("validate", model, records.of("asp_excite_validation", other))["validation"]
        rows.append(["%d, %d" % (own, other), vaf_text(report["identification"], best, AIM_OWN), vaf_text(told, best, AIM_OTHER)])
    return table(["seeds of the two records", "own record, at least %g" % AIM_OWN, "another, at least %g" % AIM_OTHER], rows)


def long_record(records, work, write):
    """A million rows of a bent first-order process with two inputs, one of which acts."""
    random = numpy.random.default_rng(1)
    n = 1000000
    u = numpy.repeat(random.uniform(-1.0, 1.0, (n // 10, 2)), 10, axis=0)
    y = numpy.zeros(n)
    for k in range(n - 1):
        y[k + 1] = y[k] + (0.35 if y[k] > 0.0 else 0.08) * (u[k, 0] - y[k])
    y += 0.01 * random.standard_normal(n)
    file = records.folder / "long.csv"
    numpy.savetxt(file, numpy.column_stack([y, u]), fmt="%.6g", delimiter=",", header="y,u,v", comments="")
    command = ["identify", file, "--auto", "--inputs", "u,v", "--outputs", "y", "--sample-time", 1, "--work", work]
    begun = time.monotonic()
    with subprocess.Popen([str(TOOL), *map(str, command), "--json"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        told = json.load(process.stdout)["cross_validation"]["y"]
        usage = os.wait4(process.pid, 0)[2]
        process.returncode = 0
    return table(["rows x signals", "time [s]", "largest memory [MB]", "free run, best / linear"],
                 [["1,000,000 x 3", "%.0f" % (time.monotonic() - begun), "%.0f" % (usage.ru_maxrss / 1024.0),
                   "%.4g / %.4g" % (told[told["best"]]["free_run"], told["linear"]["free_run"])]])


SECTIONS = {"loops": loops, "structures": structures, "cases": cases, "states": states, "long": long_record}
