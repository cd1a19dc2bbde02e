#!/usr/bin/python3
"""Writes docs/faults.md from the results of matrix.py and apart.py. Usage: table.py RESULTS.json... APART.json PAGE.md"""
import collections
import json
import pathlib
import sys

HEAD = """# What happens when something breaks

For anyone who has to know what a loop does under a fault. `scripts/faults` writes this page; do not edit.

Every fault meets running loops, each launch on a master of its own. Simulated plants: `asp_case1_clp` and `mimo_cstr_steps`, with a move
limit of 2.5 % of the input's range a sample. Behind a gateway: `example_external` (Float64, 10 %) and `cstr_modbus` (Modbus/TCP, 2 %).
Paced and gateways: 0.1 s a sample; realtime and nodelets (realtime, all nodes in one process): 0.2 s. Faults that want a launch, a machine
or a file of their own are tests of their own, in the last table.

A cell shows when the fault was reported on `loop_state` or `/diagnostics` (no time: the loop went on, and nothing need be reported), how many
samples after its end an answer was still late (if any), then the largest move of an input and the first move after the input was held or
on its fallback, both in % of the range. An empty cell: this loop has no such part.

| asked of every cell | |
|---|---|
| limits | bounds and moves at every sample; behind a gateway no input is farther than one move from what was asked |
| report | within 2 s; within 5 s for lost connections, within 10 s for a frozen analyser, a changed loop and a killed roslaunch |
| return | automatic (manual where it was) within 30 s, with everything that the operator had asked |
| record | once the launch has ended: every sample of the fault's time has its row, and the row holds what the plant showed |
| silence | an interval of 2 s without samples has its reason reported |
| processes | none ended but those that the fault kills |

A forced valve (`input/NAME` of a disturbance), the way there and the sample of its release are the fault's moves, not the loop's. In
realtime no plant waits for a recorder that was killed: samples may lack, and the summary must name them.

{verdict}
"""
SIMULATED = ("asp_case1_clp", "mimo_cstr_steps")


def cell(result):
    if result is None:
        return ""
    said = "" if result["said_after"] is None else f"{result['said_after']:.1f} s, "
    late = "not back, " if result["back_after"] is None else f"{result['back_after']} late, " if result["back_after"] else ""
    text = f"{said}{late}{result['largest_move']:.2f}/{result['bump']:.2f}"
    return f"**{text}**" if result["problems"] else text


def verdict(results, apart):
    def count(words):
        return sum(any(words in p for p in r["problems"]) for r in results)
    bad = sum(bool(r["problems"]) for r in results)
    moves = count("moved by") + count("outside its bounds")
    rows = [("faults, meetings", f"{len({r['fault'] for r in results})}, {len(results)}"), ("as asked", len(results) - bad), ("not as asked", bad),
            ("silent stalls", count("silent stall")), ("limits broken", moves), ("crashes", count("crashed")),
            ("samples missing", count("samples missing")), ("records that lack rows or hold wrong ones", count("record: ")),
            ("not recovered", sum(r["back_after"] is None for r in results)),
            ("tests of their own, passed", f"{len(apart)}, {sum(r['passed'] for r in apart)}")]
    return "| count | |\n|---|---|\n" + "\n".join(f"| {what} | {number} |" for what, number in rows)


def table(results):
    columns = list(dict.fromkeys((r["loop"], r["pace"]) for r in sorted(results, key=lambda r: r["loop"])))
    rows = collections.OrderedDict()
    for r in results:
        rows.setdefault((r["family"], r["fault"]), {})[(r["loop"], r["pace"])] = r
    return (["", "| fault | " + " | ".join(f"{name}, {pace}" for name, pace in columns) + " |", "|---" * (len(columns) + 1) + "|"] +
            [f"| {fault} | " + " | ".join(cell(cells.get(column)) for column in columns) + " |" for (_, fault), cells in rows.items()])


def main():
    *files, page = map(pathlib.Path, sys.argv[1:])
    parts = [json.loads(file.read_text(encoding="utf-8")) for file in files]
    results, apart = [r for part in parts[:-1] for r in part], parts[-1]
    lines = [HEAD.format(verdict=verdict(results, apart)), "## Simulated plants"]
    lines += table([r for r in results if r["loop"] in SIMULATED]) + ["", "## Behind a gateway"]
    lines += table([r for r in results if r["loop"] not in SIMULATED]) + ["", "## Tests of their own", "", "| fault | test | |", "|---|---|---|"]
    lines += [f"| {r['fault']} | `{r['test']}` | {'as asked' if r['passed'] else '**not as asked**'} |" for r in apart]
    slow = [r for r in results if r.get("stood_still", 0.0) > 0.0]
    if slow:
        lines += ["", "The machine stood still, the judge with it:", ""]
        lines += [f"- {r['fault']} ({r['loop']}, {r['pace']}): {r['stood_still']:.1f} s" for r in slow]
    bad = [r for r in results if r["problems"]]
    if bad:
        lines += ["", "## Not as asked", ""]
        lines += [f"- {r['fault']} ({r['loop']}, {r['pace']}): {'; '.join(dict.fromkeys(r['problems'][:3]))}" for r in bad]
    page.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
