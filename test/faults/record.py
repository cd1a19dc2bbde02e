"""What the recorder has filed of a launch, row by row, beside what the plant showed on its topics."""
import csv
import json
import math
import pathlib

SHOWN = 3  # of one kind, in words


def number(text):
    return float(text) if text else math.nan


def alike(a, b):
    return a == b or (math.isnan(a) and math.isnan(b))


def filed(folder, signals):
    """Of the newest run and of history/: {(run_id, step): values of the signals (header of a column each)}, last rows of the
    parts, where what was applied from there on is not read any more, and the gaps that the summaries name."""
    rows, last, gaps = {}, set(), set()
    for summary in sorted(pathlib.Path(folder).glob("**/summary.json")):
        about = json.loads(summary.read_text(encoding="utf-8"))
        run, step = about["run_id"], -1
        with open(summary.parent / "trajectory.csv", encoding="utf-8") as file:
            for step, row in enumerate(csv.DictReader(file), about.get("first_step", 0)):
                values = [number(row[name]) for name in signals]
                if (run, step) not in rows or not all(map(math.isnan, values)):
                    rows[run, step] = values
        last.add((run, step))
        gaps |= {(run, k) for event in about["events"] if event["code"] == "record_gap"
                 for k in range(event["first"], event["last"] + 1)}
    return rows, last, gaps


def shown(measurements, plant):
    """{(run_id, step): message} of what the plant itself has published; a run that another one replaced at its first sample is
    none."""
    seen = {(m.run_id, m.step): m for _, m in measurements if m._connection_header.get("callerid") == plant}
    replaced = {run for run, _ in seen if (run, 1) not in seen and run < max(r for r, _ in seen)}
    return {(run, step): m for (run, step), m in seen.items() if step > 0 or run not in replaced}


def is_empty(row, n_y):
    return row is None or all(math.isnan(v) for v in row[:n_y])


def complaints(record, seen, info, gap):
    """Outputs of every sample that was shown stand in its row, and so does what was applied until the next one. `gap`: samples
    may lack if the summary names them."""
    (rows, last, gaps), lost, wrong = record, [], []
    n_y = len(info.outputs)
    for (run, step), message in sorted(seen.items()):
        row, after = rows.get((run, step)), seen.get((run, step + 1))
        if row is None or is_empty(row, n_y) and not all(math.isnan(v) for v in message.outputs):
            lost += [] if gap and (run, step) in gaps else [step]
            continue
        known = after and (run, step) not in last and not is_empty(rows.get((run, step + 1)), n_y)
        expected = list(message.outputs) + (list(after.input_applied) if known else row[n_y:])
        wrong += [step] if not all(map(alike, row, expected)) else []
    return ([f"record: {len(lost)} samples lack, {lost[:SHOWN]}"] if lost else []) + (
        [f"record: {len(wrong)} rows are wrong, {wrong[:SHOWN]}"] if wrong else [])


def signals(info):
    return [f"{s.name}[{s.unit}]" for s in [*info.outputs, *info.inputs]]
