"""The tables that fmbpc writes."""
import csv


def name_and_unit(cell):
    """Of "x[mg/l]"."""
    name, bracket, unit = str(cell).partition("[")
    return name.strip(), unit.rstrip().removesuffix("]") if bracket else ""


def read_table(file):
    """Columns by name (lists, NaN where a cell is empty), units by name, of a CSV whose header cells are NAME[UNIT] (docs/recording.md).

    Raises OSError where it cannot be read, ValueError for a cell that is no number or a row of another length.
    """
    with open(file, newline="", encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    columns, units = {}, {}
    if any(len(row) != len(rows[0]) for row in rows):
        raise ValueError(f"{file}: expected {len(rows[0])} cells in each row")
    for i, cell in enumerate(rows[0] if rows else ()):
        name, unit = name_and_unit(cell)
        units[name] = unit
        columns[name] = [float(row[i]) if row[i] else float("nan") for row in rows[1:]]
    return columns, units
