"""The tables that fmbpc writes."""
import csv


def read_table(file):
    """Columns by name (lists, NaN where a cell is empty), units by name, of a CSV whose header cells are NAME[UNIT]."""
    with open(file, newline="", encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    columns, units = {}, {}
    for i, cell in enumerate(rows[0]):
        name, _, unit = cell.partition("[")
        units[name] = unit.rstrip("]")
        columns[name] = [float(row[i]) if row[i] else float("nan") for row in rows[1:]]
    return columns, units
