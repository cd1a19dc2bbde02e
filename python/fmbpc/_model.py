"""Models from records."""
from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Any, Callable, Sequence

import numpy

from fmbpc import _core, _progress, _text
from fmbpc._control import Values
from fmbpc._described import Described
from fmbpc.plots.table import name_and_unit


def _column(values):
    """Numbers, and whether they are days of dates."""
    if numpy.ma.isMaskedArray(values):
        values = values.astype(float).filled(numpy.nan)
    column = numpy.asarray(values)
    if column.dtype.kind == "M":
        missing = numpy.isnat(column)
        days = column.astype("datetime64[ns]").astype("int64") / 86400e9
        return numpy.where(missing, numpy.nan, days), True
    if column.dtype.kind not in "fiu":
        raise _core.InputError(f"expected a column of real numbers, got {column.dtype}")
    return column.astype(float), False


def _record(data, name="frame"):
    """A path, or what tableFrom() of the module takes."""
    if isinstance(data, (str, os.PathLike)):
        return os.fspath(data)
    if not hasattr(data, "keys") and not hasattr(data, "to_pandas"):
        raise _core.InputError(f"{name}: expected a DataFrame, a dict of columns, a Run or the path of a CSV, got {type(data).__name__}")
    units = dict(getattr(data, "attrs", {}).get("units", {}))
    if hasattr(data, "to_pandas") and not isinstance(data, Mapping):  # a Run
        data, units = data.to_pandas(), data.units
    columns = {str(key): data[key] for key in data.keys()}
    index = getattr(data, "index", None)
    if getattr(index, "name", None) and str(index.name) not in columns:  # times
        columns = {str(index.name): index, **columns}
    if not columns:
        raise _core.InputError(f"{name}: expected columns")
    names, found, dates, values = [], [], [], []
    for key, column in columns.items():
        short, unit = name_and_unit(key)
        try:
            numbers, is_date = _column(column)
        except _core.InputError as error:
            raise _core.InputError(f"{name}[{key}]: {error}") from None
        if numbers.ndim != 1 or (values and len(numbers) != len(values[0])):
            raise _core.InputError(f"{name}[{key}]: expected as many numbers as the first column has")
        if numpy.isinf(numbers).any():
            raise _core.InputError(f"{name}[{key}]: expected finite numbers, or nan where one is missing")
        if short == "time_h" and not unit:
            short, unit = "time", "h"
        names.append(short)
        found.append(unit or units.get(key, ""))
        dates.append(is_date)
        values.append(numbers)
    if len(set(names)) != len(names):
        raise _core.InputError(f"{name}: expected every column only once")
    return name, names, found, dates, numpy.column_stack(values)


class Model(Described):
    """A Takagi-Sugeno model: made by identify(), or read by name (of config/model) or path.

    Arrays have a row a sample: y n_y columns, u n_u, d n_d, in the order of `outputs`, `inputs`, `disturbances`;
    with one signal a vector will do. Row k + 1 of a prediction follows from rows up to k. The equations: docs/theory.md.
    Raises InputError for a file that is not there or does not hold a model.
    """

    def __init__(self, model: str | os.PathLike):
        self._core = model if isinstance(model, _core.Model) else _core.read_model(_text.path(model, "model"))

    @property
    def source(self) -> str:
        """What it was made from, in words."""
        return self._core.source

    @property
    def rules(self) -> dict[str, int]:
        """How many each output has."""
        return self._core.rules

    @property
    def remarks(self) -> list[tuple[str, int, str]]:
        """What to know before trusting it: (output, rule from 1, words)."""
        return self._core.remarks

    @cached_property
    def report(self) -> dict[str, Any]:
        """What identify() found: verdict by output, figures of the held-out blocks, remarks (docs/identification.md); {}: it was read."""
        return json.loads(self._core.report) if self._core.report else {}

    def _matrix(self, values, signals):
        if values is None:
            return None
        array = numpy.asarray(values)
        return array[:, None] if array.ndim == 1 and len(signals) == 1 else array

    def predict(self, y, u, d=None, *, steps: int = 1) -> numpy.ndarray:
        """What follows `steps` samples later from measured pasts, n_samples x n_y; NaN where the past is not there.

        Raises InputError naming the array whose size or type is wrong; here a NaN is a reading that did not come.
        """
        return self._core.predict(self._matrix(y, self.outputs), self._matrix(u, self.inputs), self._matrix(d, self.disturbances), steps)

    def simulate(self, u, d=None, *, y0: Values) -> numpy.ndarray:
        """Outputs n_samples x n_y when the process has rested at y0, u[0], d[0] before; row 0 is y0.

        Raises InputError naming the array whose size or type is wrong or that holds what is not finite.
        """
        return self._core.simulate(y0, self._matrix(u, self.inputs), self._matrix(d, self.disturbances))

    def validate(self, data, *, rows: str = "", columns: Mapping[str, str] | None = None, steps: int = 10) -> dict[str, Any]:
        """Judges it on another record (as identify() takes it), as `fmbpc validate --json`.

        rows: "FIRST:LAST", from 1; columns: {"SIGNAL": "COLUMN"} where names differ; steps: of the prediction ahead
        Raises InputError naming record and column.
        """
        pairs = [f"{signal}={column}" for signal, column in _text.items(columns, "columns")]
        return json.loads(self._core.validate(_record(data), rows, pairs, steps))

    def linearise(self, y: Values | None = None, u: Values | None = None, d: Values | None = None) -> dict[str, numpy.ndarray]:
        """A, B, C and offset_state of x(k+1) = A x(k) + B u(k) + offset_state, y(k) = C x(k), where it rests at these values.

        The state stacks the outputs' lags, then past inputs and disturbances. What is left out is the middle of its range.
        Raises InputError naming what is unknown, not finite or of the wrong size.
        """
        return self._core.linearise(y, u, d)

    def save(self, file: str | os.PathLike) -> None:
        """Writes a model file, which loops name as model.file. Raises OSError where it cannot be written."""
        with open(file, "w", encoding="utf-8") as stream:
            stream.write(self._core.text)

    def __repr__(self) -> str:
        rules = ", ".join(f"{name} {count}" for name, count in self.rules.items())
        return f"<fmbpc.Model {self.name}: rules of {rules}; sample time {self.sample_time_s:g} s>"


def identify(data, *, outputs: Sequence[str] = (), inputs: Sequence[str] = (), disturbances: Sequence[str] = (), auto: bool = True,
             structure: str | os.PathLike | None = None, validation=None, rows: str = "", validation_rows: str = "",
             time: str = "", sample_time_s: float | None = None, known: str | os.PathLike | Mapping | None = None, name: str | None = None,
             kind: str | None = None, work: float | None = None, budget_s: float | None = None, blocks: int | None = None, window: int | None = None,
             reach: int | None = None, longest_delay: int | None = None, input_row: str | None = None, keep_inputs: bool | None = None,
             seed: int | None = None, progress: bool | Callable[[float, str], None] | None = None) -> Model:
    """Identifies a model from a record: columns `outputs` from columns `inputs` and `disturbances`.

    data: a DataFrame, a dict of vectors, a Run, or the path of a CSV; a list of them are records one after the other.
        A column is a name, or "x[mg/l]" with its unit; NaN is a missing cell. A CSV and a frame of it give the same model.
    structure: name of config/structure, or path; else (auto) orders, delays, sets and rules are searched
    validation: another record to judge on; validation_rows: "FIRST:LAST" of it, or of the first record
    time: column of times, else found by its name
    known: what is known of the outputs, a file, a text or {"y": {"gain": {"u": "positive"}}}
    The rest are the options of `fmbpc identify --auto`; what is left out is as there:
    work: where the search ends, counted alike on every machine; 1 is about a second of one core
    budget_s: [s] that end it earlier; the model then depends on the machine
    kind: best, linear, regressors or state; seed: of the starts of all fits; name: of the model
    sample_time_s: instead of a column of times; input_row: auto, next or same; keep_inputs: True: those that hardly moved too
    blocks: held out in turn; window, reach, longest_delay: [samples] (docs/identification.md)
    How it searches, and the sources: docs/identification_method.md. Ctrl-C keeps the best that the search found. Raises InputError naming record and column, or the option.
    """
    records = data if isinstance(data, (list, tuple)) else [data]
    if structure is None and not auto:
        raise _core.InputError("identify: expected a structure, or auto=True")
    if structure is None and not outputs:
        raise _core.InputError("outputs: expected the columns to predict")
    if structure is None and not (inputs or disturbances):
        raise _core.InputError("inputs: expected the columns that act on the outputs")
    known_text = "" if known is None else ", ".join(f"{k}: {_text._flow(v)}" for k, v in known.items()) if isinstance(known, Mapping) else os.fspath(known)
    search = {"sample_time_s": sample_time_s, "name": name, "kind": kind, "work": work, "budget_s": budget_s, "blocks": blocks, "window": window,
              "reach": reach, "longest_delay": longest_delay, "input_row": input_row, "keep_inputs": keep_inputs, "seed": seed}
    signals = (("outputs", outputs), ("inputs", inputs), ("disturbances", disturbances))
    options = {**{what: _names(names, what) for what, names in signals}, "rows": rows, "validate_rows": validation_rows,
               "time": time, "known": known_text, "structure": "" if structure is None else _text.path(structure, "structure"),
               **{key: value for key, value in search.items() if value is not None}}
    with _progress.bar("identify", progress) as bar:
        return Model(_core.identify([_record(r) for r in records], None if validation is None else _record(validation, "validation"), options, bar))


def _names(names, what):
    found = [names] if isinstance(names, str) else names
    if not isinstance(found, Iterable) or not all(isinstance(name, str) for name in found):
        raise _core.InputError(f"{what}: expected names, got {names!r}")
    return list(found)
