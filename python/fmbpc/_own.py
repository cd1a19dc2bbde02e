"""Plants and laws that are Python classes."""
from __future__ import annotations

import inspect
import os
import re
from typing import Any, NamedTuple

from fmbpc import _core, _text


class Quantity(NamedTuple):
    """A signal or parameter of a plant: unit, usual value, range. A plain tuple does as well; see register() and docs/python.md."""

    unit: str
    nominal: float
    lower: float
    upper: float


class _Range(NamedTuple):
    name: str
    unit: str
    lower: float
    upper: float


def _name_of(cls) -> str:
    return getattr(cls, "name", None) or re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", cls.__name__).lower()


def _title_of(cls) -> str:
    return getattr(cls, "title", None) or (inspect.getdoc(cls) or _name_of(cls)).splitlines()[0]


def _quantities(cls, key):
    found = []
    for name, values in dict(getattr(cls, key, {})).items():
        if len(tuple(values)) != 4:
            raise _core.InputError(f"{_name_of(cls)}: {key}.{name}: expected (unit, nominal, lower, upper)")
        unit, nominal, lower, upper = values
        found.append((name, _text.text(unit, f"{_name_of(cls)}: {key}.{name}"), *(_text.real(value, f"{_name_of(cls)}: {key}.{name}") for value in (nominal, lower, upper))))
    return found


def _make_plant(cls):
    def make(parameters):
        plant = cls()
        for name, value in parameters.items():
            setattr(plant, name, value)
        if hasattr(plant, "start"):
            plant.start()
        return plant
    return make


def _make_controller(cls):
    def make(parameters, context):
        law = cls()
        for key in ("outputs", "inputs", "disturbances"):
            setattr(law, key, [_Range(*signal) for signal in context.pop(key)])
        for name, value in {**context, **parameters}.items():
            setattr(law, name, value)
        if hasattr(law, "start"):
            law.start()
        return law
    return make


def _is_plant(cls) -> bool:
    return hasattr(cls, "states") or hasattr(cls, "derivatives")


def register(cls):
    """Registers a class as a plant or a law, under its `name` or that of the class; also as a decorator.

    A plant has `states`, `inputs`, `disturbances`, `parameters`: {"NAME": (unit, nominal, lower, upper)},
    `outputs`: the names of states that are measured (left out: all), and either
        derivatives(self, x, u, d) -> dx/dt per `time_unit_s` (1 s if left out), free of memory, or
        step(self, u, d) -> states at the end of a sample, with a memory of its own.
    A law has `parameters`: {"NAME": default}, keys of the section `controller`, and
        step(self, y, setpoint) -> u; the limits are kept for it. reset(self, y, u), if it has one, is called before
        the first sample and after others had the inputs. It finds as attributes: `outputs`, `inputs`, `disturbances`
        (name, unit, lower, upper), `sample_time_s`, `input_lower`, `input_upper`, `move`, `initial_input`, and at each
        sample `applied` and `disturbance`.
    Parameters are attributes of the object; start(self), if it has one, is called once they are there. A loop of this
    process names the class as plant.type or controller.type. A class of the same name takes the place of the former.
    A package's library in C++, by its name or path, registers all that it brings; a loop file says `plugins` for it
    (docs/own_plant.md, docs/own_controller.md).
    Raises InputError naming what is wrong with the description or the library.
    """
    if isinstance(cls, (str, os.PathLike)):
        _core.register_library(os.fspath(cls))
        return cls
    if not isinstance(cls, type):
        raise _core.InputError(f"register: expected a class or the name of a library, got {cls!r}")
    name = _name_of(cls)
    if _is_plant(cls):
        steps = not hasattr(cls, "derivatives")
        if steps and not hasattr(cls, "step"):
            raise _core.InputError(f"plant {name}: expected derivatives(x, u, d) or step(u, d)")
        about = {key: _quantities(cls, key) for key in ("states", "inputs", "disturbances", "parameters")}
        about["outputs"] = list(getattr(cls, "outputs", None) or dict(getattr(cls, "states", {})))
        _core.register_plant({"name": name, "title": _title_of(cls), "time_unit_s": _text.real(getattr(cls, "time_unit_s", 1.0), f"{name}: time_unit_s"),
                              **about}, _make_plant(cls), steps)
    elif hasattr(cls, "step"):
        _core.register_controller(name, _title_of(cls), dict(getattr(cls, "parameters", {})), _make_controller(cls))
    else:
        raise _core.InputError(f"{name}: expected a plant with states, or a law with step(y, setpoint)")
    return cls


def controllers() -> dict[str, dict[str, Any]]:
    """What is registered as controller.type: summary, needs_model, predicts, open_loop, settings (docs/loop_controller.md)."""
    return {name: _core.controller_type(name) for name in _core.controller_names()}


def check(cls, *, loop=None) -> list[str]:
    """The contract tests of every plant and law, asked of a class of your own; returns what is broken, in words.

    loop: for a law, a loop (name, path, dict or Loop) of a hundred samples or more that it is tried in, in the place of
    the loop's own. The class is registered by this (docs/python.md). Raises InputError, and what the class itself raises.
    """
    from fmbpc._loop import Loop
    if not isinstance(cls, type):
        raise _core.InputError(f"check: expected a class, got {cls!r}")
    register(cls)
    if _is_plant(cls):
        return _core.check_plant(_name_of(cls))
    if loop is None:
        raise _core.InputError("check: expected a loop that the law is tried in: check(MyLaw, loop=...)")
    source = loop._core.file if isinstance(loop, Loop) else loop
    return _core.check_controller(Loop(source, set=in_place_of(source, cls))._core)


def in_place_of(source, cls) -> dict[str, Any]:
    """What `set` needs for a law of one's own in a loop: its section is the class and its parameters, no optimizer follows."""
    from fmbpc._loop import Loop
    optimizer = {"clp": False} if Loop(source)._core.has_optimizer else {}
    return {"controller": {"type": _name_of(cls), **dict(getattr(cls, "parameters", {}))}, **optimizer}
