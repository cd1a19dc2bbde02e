"""Plants and laws that are Python classes."""
from __future__ import annotations

import inspect
import re
from typing import Any, NamedTuple

import numpy

from fmbpc import _core, _text


class Quantity(NamedTuple):
    """A signal or parameter of a plant: unit, usual value, range. A plain tuple does as well."""

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
        found.append((name, unit, float(nominal), float(lower), float(upper)))
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
    Raises InputError naming what is wrong with the description.
    """
    name = _name_of(cls)
    if _is_plant(cls):
        steps = not hasattr(cls, "derivatives")
        if steps and not hasattr(cls, "step"):
            raise _core.InputError(f"plant {name}: expected derivatives(x, u, d) or step(u, d)")
        about = {key: _quantities(cls, key) for key in ("states", "inputs", "disturbances", "parameters")}
        about["outputs"] = list(getattr(cls, "outputs", None) or dict(getattr(cls, "states", {})))
        _core.register_plant({"name": name, "title": _title_of(cls), "time_unit_s": float(getattr(cls, "time_unit_s", 1.0)),
                              **about}, _make_plant(cls), steps)
    elif hasattr(cls, "step"):
        _core.register_controller(name, _title_of(cls), dict(getattr(cls, "parameters", {})), _make_controller(cls))
    else:
        raise _core.InputError(f"{name}: expected a plant with states, or a law with step(y, setpoint)")
    return cls


def controllers() -> dict[str, dict[str, Any]]:
    """What is registered as controller.type: summary, needs_model, predicts, open_loop, settings."""
    return {name: _core.controller_type(name) for name in _core.controller_names()}


def check(cls, *, loop=None, samples: int = 50, seed: int = 1) -> list[str]:
    """Contract tests of a class of your own; returns what is wrong, an empty list if nothing is.

    A plant: derivatives finite and the same again anywhere in the ranges, arguments left alone, the same bits after a
    reset, for derivatives() also half a sample twice against a whole one. A law, in `loop` (a Loop or what it is made
    of; the loop's law is replaced): finite inputs of the right size for setpoints and readings anywhere in their
    ranges, the same bits again, a start where the input was. The class is registered by this.
    """
    register(cls)
    rng = numpy.random.default_rng(seed)
    return _check_plant(cls, samples, rng) if _is_plant(cls) else _check_law(cls, loop, samples, rng)


def _drawn(rng, quantities):
    """Anywhere in the ranges, corners included."""
    share = numpy.clip(rng.uniform(-0.2, 1.2, len(quantities)), 0.0, 1.0)
    return numpy.array([q[-2] + s * (q[-1] - q[-2]) for q, s in zip(quantities, share)])


def _check_plant(cls, samples, rng):
    name, wrong = _name_of(cls), []
    about = _core.plant_description(name)
    for group in ("states", "inputs", "disturbances", "parameters"):
        wrong += [f"{q[0]}: no unit (1 for a number without one)" for q in about[group] if not q[1]]
    if hasattr(cls, "derivatives"):
        plant = _make_plant(cls)({q[0]: q[2] for q in about["parameters"]})
        for _ in range(samples):
            x, u, d = (_drawn(rng, about[group]) for group in ("states", "inputs", "disturbances"))
            kept = [v.copy() for v in (x, u, d)]
            first = numpy.array(plant.derivatives(x, u, d), dtype=float)
            if any((a != b).any() for a, b in zip(kept, (x, u, d))):
                return wrong + ["derivatives: changes its arguments"]
            if first.shape != x.shape or not numpy.isfinite(first).all():
                return wrong + [f"derivatives: {first} at x = {x}, u = {u}, d = {d}: expected {len(x)} finite numbers"]
            if (numpy.array(plant.derivatives(x, u, d), dtype=float) != first).any():
                return wrong + ["derivatives: not the same again: it must not remember"]
    moves = [(_drawn(rng, about["inputs"]), about["inputs"]) for _ in range(5)]
    nominal = numpy.array([q[2] for q in about["inputs"]])
    near = [nominal + 0.1 * (u - nominal) for u, _ in moves]
    whole = _core.Plant(name, {}, about["time_unit_s"])
    once = [whole.step(u, None) for u in near]
    whole.reset(None)
    again = [whole.step(u, None) for u in near]
    if any((a != b).any() for a, b in zip(once, again)):
        wrong.append("step: not the same bits after a reset")
    if hasattr(cls, "derivatives"):
        half = _core.Plant(name, {}, 0.5 * about["time_unit_s"])
        for u, y in zip(near, once):
            half.step(u, None)
            z = half.step(u, None)
            if not numpy.allclose(y, z, rtol=1e-6, atol=1e-6):
                wrong.append(f"derivatives: half a time unit twice gives {z}, a whole one {y}: expected the same")
                break
    return wrong


def _check_law(cls, loop, samples, rng):
    from fmbpc._loop import Loop
    if loop is None:
        raise _core.InputError("check: expected a loop that the law is tried in: check(MyLaw, loop=...)")
    source = loop._core.file if isinstance(loop, Loop) else loop
    tried = Loop(source, set={"controller": {"type": _name_of(cls), **_defaults(cls)}, "clp.enabled": False})
    spans = [tuple(s) for s in tried.outputs]
    setpoints, readings = ([_drawn(rng, spans) for _ in range(samples)] for _ in range(2))

    def inputs():
        law = tried.controller()
        return [law.step(y, setpoint=r) for y, r in zip(readings, setpoints)], law
    first, law = inputs()
    second, _ = inputs()
    wrong = []
    if any((a != b).any() for a, b in zip(first, second)):
        wrong.append("step: not the same bits again with the same readings")
    if law.source == "held":
        wrong.append("step: gave no finite input: " + "; ".join(e.text for e in law.events))
    return wrong


def _defaults(cls):
    return {key: value for key, value in dict(getattr(cls, "parameters", {})).items()}
