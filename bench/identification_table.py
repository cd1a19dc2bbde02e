#!/usr/bin/python3
"""Every table of figures in docs/identification_results.md: `fmbpc identify --auto` on public records (identified from the first rows of each,
judged on the others in free run and one step ahead), then the sections of identification_runs.py.

    FMBPC_DATA=FOLDER bench/identification_table.py [NAME..] [--section SECTION]... [--work W] [--write]

NAME: of a record, and no other section. --write puts each table between its marks in docs/identification_results.md, and the models of the
section `loops` into config/model.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from identification_runs import SECTIONS, Records

TOOL = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "fmbpc"
PAGE = TOOL.parent.parent / "docs" / "identification_results.md"
BEGIN, END = "<!-- identification_table.py %s -->", "<!-- end -->"
PLANT_INPUTS = "u1_gas_flow,u2_turbine_valves,u3_superheater_spray,u4_gas_dampers,u5_air_flow"
PLANT_OUTPUTS = "y1_steam_pressure,y2_main_steam_temp,y3_reheat_steam_temp"
COLUMN_INPUTS = "u_reboil_ratio_n0,u_reflux_ratio_n0,u_distillate_ratio_n0,u_feed_ethane_n0,u_top_pressure_n0"
COLUMN_OUTPUTS = "y_top_ethane_n0,y_bottom_ethylene_n0,y_dp_n0"
# name: file, inputs, outputs, last row to identify from (0: all rows, judged by held-out blocks only), sample time [s] where no column tells it
RECORDS = {
    "tanks": ("cascaded_tanks_estimation.csv", "u_V", "y_V", 0),
    "drives_1": ("coupled_drives_1_estimation.csv", "u_V", "y", 300),
    "drives_2": ("coupled_drives_2_estimation.csv", "u_V", "y", 300),
    "cstr": ("daisy_cstr.csv", "q_lpm", "Ca_molL,T_K", 5000),
    "power_plant": ("daisy_powerplant.csv", PLANT_INPUTS, PLANT_OUTPUTS, 140, 1228.8),
    "heating": ("daisy_heating_system.csv", "u_voltage_V", "y_temp_C", 530),
    "gas_furnace": ("box_jenkins_gas_furnace.csv", "u_gas_rate_ft3min", "y_co2_pct", 200, 9),
    "column": ("daisy_destill.csv", COLUMN_INPUTS, COLUMN_OUTPUTS, 0, 900),
}

# record, output, figure: published linear, best published baseline, aim. Published: free run over other rows of the same records.
AIMS = {
    ("tanks", "y_V", "free_run"): ("0.615-0.685", "0.396 (GRU), 0.343 (state space)", 0.40),
    ("tanks", "y_V", "one_step"): ("0.052-0.053", "0.062 (polynomial NARX)", 0.050),
    ("drives_1", "y", "free_run"): ("0.291", "0.096 (RNN), 0.100 (polynomial NARX)", 0.12),
    ("drives_2", "y", "free_run"): ("0.331", "0.089 (GP-NARX), 0.095 (FIR-MLP)", 0.12),
    ("cstr", "Ca_molL", "fit"): ("81.6", "-", 97.0),
    ("cstr", "T_K", "fit"): ("91.5", "-", 97.0),
}
BESIDE_LINEAR = " (linear + 5 %)"
WORSE = 1.05  # of the linear model's free run: the first try is never further off


def asked(*arguments):
    return json.loads(subprocess.run([str(TOOL), *arguments, "--json"], check=True, capture_output=True, text=True).stdout)


def identified(name, work):
    """Held-out rows are shown to the finished model only: `identify --validate-rows` may refuse a fuzzy model by them."""
    file, inputs, outputs, last, *sample_time = RECORDS[name]
    record = os.path.join(os.environ["FMBPC_DATA"], file)
    command = ["identify", record, "--auto", "--inputs", inputs, "--outputs", outputs, "--work", str(work)]
    command += ["--sample-time", str(*sample_time)] if sample_time else []
    if not last:
        return asked(*command)
    with tempfile.TemporaryDirectory() as folder:
        model = os.path.join(folder, "model.yaml")
        report = asked(*command, "--rows", "1:%d" % last, "--out", model)
        report["validation"] = asked("validate", model, record, "--rows", "%d:" % (last + 1))["validation"]
    return report


def text(value):
    return "-" if value is None else "%.4g" % value


def rows(name, report):
    for output, crossed in report["cross_validation"].items():
        best, held = crossed["best"], (report["validation"] or {}).get(output)
        cells = ["%s, %s" % (name, output), best]
        for kind in (best, "linear"):
            cells.append("%s / %s" % (text(crossed[kind]["free_run"]), text(crossed[kind]["one_step"])))
        if held:
            held.setdefault(best, held)  # the model that laws take stands without its kind
        for kind in (best, "linear"):
            figures = held[kind] if held else None
            cells.append("%s / %s" % (text(figures["free_run"]["rmse"]), text(figures["one_step"]["rmse"])) if held else "-")
        cells.append("%.1f / %.1f" % (held[best]["free_run"]["fit"], held["linear"]["free_run"]["fit"]) if held else
                     "%.1f / %.1f" % (crossed[best]["fit"], crossed["linear"]["fit"]))
        yield cells


def held_out(report, output):
    """Figures of the best kind and of linear: of the rows after those identified from, else of blocks held out in turn."""
    crossed, held = report["cross_validation"][output], (report["validation"] or {}).get(output)
    if not held:
        return "blocks", crossed[crossed["best"]], crossed["linear"]
    flat = [{"free_run": f["free_run"]["rmse"], "one_step": f["one_step"]["rmse"], "fit": f["free_run"]["fit"]}
            for f in (held.get(crossed["best"], held), held["linear"])]
    return "later rows", flat[0], flat[1]


def is_reached(figure, value, aim):
    return value is not None and (value >= aim if figure == "fit" else value <= aim)


def aim_rows(name, report):
    """One row per aim, and one per output: never worse than linear by more than 5 %."""
    for output in report["cross_validation"]:
        rows_of, best, linear = held_out(report, output)
        own, line = best["free_run"], linear["free_run"]
        stated = [(f, *AIMS[name, output, f]) for f in ("free_run", "one_step", "fit") if (name, output, f) in AIMS]
        stated.append(("free_run", "-", "-", None if line is None else WORSE * line))
        own_is_linear = report["cross_validation"][output]["best"] == "linear"
        for figure, published, baseline, aim in stated:
            reached = aim is not None and is_reached(figure, own if figure == "free_run" else best[figure], aim)
            side = ">=" if figure == "fit" else "<="
            words = "%s %s" % (side, text(aim)) + (BESIDE_LINEAR if baseline == published == "-" else "")
            yield ["%s, %s" % (name, output), figure, rows_of, published, baseline, text(best[figure]), words,
                   ("reached" if reached else "not reached") + (" (it is the linear model)" if own_is_linear else "")]


def written(page, section, tables):
    """The page with these tables between the marks of the section."""
    begin = BEGIN % section + "\n"
    if page.count(begin) != 1:
        raise SystemExit("identification_table.py: %s has %s %d times, not once" % (PAGE.name, begin.strip(), page.count(begin)))
    before, rest = page.split(begin)
    return before + begin + "\n" + tables + "\n" + END + rest.split(END, 1)[1]


def tables_of(names, work):
    """Both tables, each row printed as it is found."""
    lines = []

    def say(line):
        lines.append(line)
        print(line, flush=True)

    say("| record, output | best | blocks: free run / one step | linear | held out: free run / one step | linear | fit %, best / linear |")
    say("|---" * 7 + "|")
    aims = []
    for name in names:
        report = identified(name, work)
        aims += aim_rows(name, report)
        for cells in rows(name, report):
            say("| " + " | ".join(cells) + " |")
    linear = [cells for cells in aims if cells[6].endswith(BESIDE_LINEAR)]
    missed = [cells[0] for cells in linear if not cells[7].startswith("reached")]
    say("\nFree run at most 5 %% above the linear model's: %d of %d outputs%s." % (len(linear) - len(missed), len(linear), ", not " + "; ".join(missed) if missed else ""))
    say("\n| record, output | figure | held out | linear, published | best published | here | aim | |")
    say("|---" * 8 + "|")
    for cells in aims:
        if cells not in linear:
            say("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def tables_of_section(section, work, write):
    with tempfile.TemporaryDirectory() as folder:
        lines = SECTIONS[section](Records(folder), work, write)
    print("\n%s\n\n%s" % (section, "\n".join(lines)), flush=True)
    return "\n".join(lines) + "\n"


def refused(arguments):
    """What is wrong with the command, or nothing."""
    if "FMBPC_DATA" not in os.environ:
        return "FMBPC_DATA must name the folder of the records"
    unknown = [name for name in arguments.names if name not in RECORDS]
    if unknown:
        return "unknown record %s; known: %s" % (unknown[0], ", ".join(RECORDS))
    if arguments.names and (arguments.write or arguments.section):
        return "--write and --section take all records: name none"
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(RECORDS))
    parser.add_argument("--section", action="append", choices=["records", *SECTIONS], help="all, if none is named")
    parser.add_argument("--work", type=float, default=120.0, help="per record")
    parser.add_argument("--write", action="store_true", help="into docs/identification_results.md as well")
    arguments = parser.parse_args()
    wrong = refused(arguments)
    if wrong:
        print("identification_table.py: " + wrong, file=sys.stderr)
        return 1
    for section in arguments.section or (["records"] if arguments.names else ["records", *SECTIONS]):
        if section == "records":
            tables = tables_of(arguments.names or RECORDS, arguments.work)
        else:
            tables = tables_of_section(section, arguments.work, arguments.write)
        if arguments.write:
            PAGE.write_text(written(PAGE.read_text(encoding="utf-8"), section, tables), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
