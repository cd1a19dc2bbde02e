#!/usr/bin/python3
"""Writes docs/faults.md from the results of matrix.py. Usage: table.py RESULTS.json PAGE.md"""
import collections
import json
import pathlib
import sys

HEAD = """# What happens when something breaks

Written by `scripts/faults`; do not edit. Every fault is met by running loops over topics, paced (0.1 s a sample) and in
realtime (0.2 s a sample), with all move limits on (2.5 % of the input's range a sample). Loops: {loops}.

A cell says when the fault was said on `loop_state` or `/diagnostics` (s of wall time; `-`: the loop went on and nothing need
be said), how many samples after its end no answer was in time any more, the largest move of the input, and the first move
after the input was held or on its fallback (both in % of the range). What is asked of every cell: no sample lost, bounds and
move limits kept at every sample, said within 2 s, automatic again (or manual, where it was) within 30 s with everything that
the operator had asked, no time of 2 s without a sample that nobody explains, no node dead but those that were killed.

What counts as a move: what the plant applied from one sample to the next. Where somebody forces a valve (`input/NAME` of a
disturbance) the jump to the forced position, the way while it is forced, and the sample of its release are the fault's, not the
loop's; from the next sample on all limits hold again, counted from where the valve was left.

Loops behind a gateway (realtime, 0.1 s a sample, 2 % and 10 % of the range a sample) meet faults of their own. There an input is
also never further than one move from what was asked of it, whatever is read back.

{verdict}
"""


def cell(result):
    if result is None:
        return ""
    said = "-" if result["said_after"] is None else f"{result['said_after']:.1f} s"
    back = "not back" if result["back_after"] is None else str(result["back_after"])
    text = f"{said}, {back}, {result['largest_move']:.2f} / {result['bump']:.2f}"
    return f"**{text}**" if result["problems"] else text


def verdict(results):
    def count(words):
        return sum(any(words in p for p in r["problems"]) for r in results)
    bad = sum(bool(r["problems"]) for r in results)
    moves = count("moved by") + count("outside its bounds")
    return (f"{len({r['fault'] for r in results})} faults, {len(results)} meetings: {len(results) - bad} as asked, {bad} not. "
            f"Silent stalls: {count('silent stall')}. Limits broken: {moves}. Crashes: {count('crashed')}. "
            f"Samples missing: {count('samples missing')}. Not recovered: {sum(r['back_after'] is None for r in results)}.")


def main():
    results = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    columns = sorted({(r["loop"], r["pace"]) for r in results})
    rows = collections.OrderedDict()
    for r in results:
        rows.setdefault((r["family"], r["fault"]), {})[(r["loop"], r["pace"])] = r
    lines = [HEAD.format(loops=", ".join(f"`{name}`" for name in sorted({r["loop"] for r in results})),
                         verdict=verdict(results))]
    lines.append("| fault | " + " | ".join(f"{name}, {pace}" for name, pace in columns) + " |")
    lines.append("|---" * (len(columns) + 1) + "|")
    for (_, fault), cells in rows.items():
        lines.append(f"| {fault} | " + " | ".join(cell(cells.get(column)) for column in columns) + " |")
    slow = [r for r in results if r.get("stood_still", 0.0) > 0.0]
    if slow:
        lines += ["", "The machine stood still, the judge with it:", ""]
        lines += [f"- {r['fault']} ({r['loop']}, {r['pace']}): {r['stood_still']:.1f} s" for r in slow]
    bad = [r for r in results if r["problems"]]
    if bad:
        lines += ["", "Not as asked:", ""]
        lines += [f"- {r['fault']} ({r['loop']}, {r['pace']}): {'; '.join(dict.fromkeys(r['problems'][:3]))}" for r in bad]
    pathlib.Path(sys.argv[2]).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
