"""What happened in a run."""
from __future__ import annotations

import json
import os
from collections.abc import Mapping
from functools import cached_property
from typing import Iterator, NamedTuple

import numpy


class Signal(numpy.ndarray):
    """A numpy vector of one signal over the run, with `name`, `unit` and `time` [h]; what is computed from it is a plain array.

    Of a run (docs/recording.md).
    """

    name: str
    unit: str
    time: numpy.ndarray

    def __new__(cls, values, name, unit, time):
        self = numpy.asarray(values).view(cls)
        self.name, self.unit, self.time = name, unit, time
        return self

    def __array_finalize__(self, source):
        for key in ("name", "unit", "time"):
            setattr(self, key, getattr(source, key, None))

    def __array_wrap__(self, array, context=None, return_scalar=False):
        array = numpy.asarray(array)
        return array[()] if array.ndim == 0 else array

    def __getitem__(self, item):
        return numpy.asarray(self)[item]

    def __repr__(self):
        return f"<fmbpc.Signal {self.name} [{self.unit}]: {len(self)} samples>"


class Signals(Mapping):
    """Signals by name; tab completion lists the names."""

    def __init__(self, run, names):
        self._run, self._names = run, list(names)

    def __getitem__(self, name: str) -> Signal:
        if name not in self._names:
            raise KeyError(f"{name}: expected one of {', '.join(self._names)}")
        return self._run[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def _ipython_key_completions_(self):
        return self._names

    def __repr__(self):
        return f"<signals {', '.join(self._names)}>"


class Event(NamedTuple):
    """What did not go as asked (docs/events.md): `count` samples from `first` to `last`; 0: the run as a whole."""

    code: str
    severity: str
    signal: str
    text: str
    first: int
    last: int
    count: int


class Run:
    """Outputs, inputs and all other columns of trajectory.csv as arrays, the summary, the events (docs/operation.md). Made by Loop.run()."""

    def __init__(self, core):
        self._core = core

    @cached_property
    def _table(self):
        names, units, values = self._core.table()
        return names, dict(zip(names, units)), {name: values[:, i] for i, name in enumerate(names)}

    @property
    def names(self) -> list[str]:
        """All columns: time, outputs, inputs, disturbances, then NAME_setpoint, NAME_reference, ..."""
        return self._table[0]

    def __getitem__(self, name: str) -> Signal:
        _, units, columns = self._table
        if name not in columns:
            raise KeyError(f"{name}: expected one of {', '.join(columns)}")
        return Signal(columns[name], name, units[name], columns["time"])

    @property
    def time(self) -> numpy.ndarray:
        """[h] since the start, n samples; the input of the last one is NaN."""
        return self._table[2]["time"]

    @property
    def outputs(self) -> Mapping[str, Signal]:
        """As they were measured, n samples each."""
        return Signals(self, self.summary["outputs"])

    @property
    def inputs(self) -> Mapping[str, Signal]:
        """As they were applied, n samples each; input k acts from time k on."""
        return Signals(self, self.summary["inputs"])

    @property
    def units(self) -> dict[str, str]:
        """By name, of all columns."""
        return dict(self._table[1])

    @cached_property
    def summary(self) -> dict:
        """What summary.json holds: indices of outputs and inputs, violations, remarks (docs/operation.md)."""
        return json.loads(self._core.summary())

    @property
    def events(self) -> list[Event]:
        """What did not go as asked, as the tool and the nodes say it."""
        return [Event(**event) for event in self.summary["events"]]

    @property
    def complete(self) -> bool:
        """The final sample came and the plant moved as asked at every one."""
        return self._core.complete

    @property
    def interrupted(self) -> bool:
        """Ctrl-C ended it."""
        return self._core.interrupted

    @property
    def seconds(self) -> float:
        """Wall time."""
        return self._core.wall_s

    def save(self, folder: str | os.PathLike) -> None:
        """trajectory.csv and summary.json in a folder, as `fmbpc run --out`. Raises InputError where it cannot be written."""
        self._core.save(os.fspath(folder))

    def to_pandas(self):
        """A DataFrame of all columns, its index the time [h]; units in attrs["units"]. Needs pandas."""
        import pandas
        names, units, columns = self._table
        frame = pandas.DataFrame({n: columns[n] for n in names if n != "time"}, index=pandas.Index(columns["time"], name="time_h"))
        frame.attrs["units"] = dict(units)
        return frame

    def plot(self, *others: "Run"):
        """A matplotlib figure of this run, or of several compared. Needs matplotlib."""
        from fmbpc import plots
        return plots.run_picture([self, *others])

    def __repr__(self) -> str:
        ise = [f"ISE of {n} {o['ise']:.4g}" for n, o in self.summary["outputs"].items() if o.get("ise") is not None]
        state = [] if self.complete else ["not complete"]
        return f"<fmbpc.Run {self.summary['loop']}: {', '.join([f'{len(self.time)} samples', *ise, *state])}>"
