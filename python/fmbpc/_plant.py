"""Plants that are stepped."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping

import numpy

from fmbpc import _core, _text
from fmbpc._control import Values

if TYPE_CHECKING:
    from fmbpc._loop import Loop


class Plant:
    """The equations of a registered plant, ours or your own: no noise, no delays, no actuators (docs/own_plant.md; the title names the source).

    name: one of plants()
    sample_time_s: over which step() moves it [s]; left out: one time unit of its description
    parameters: {"NAME": value} over the nominal ones
    Raises InputError naming what is unknown or out of its range.
    """

    def __init__(self, name: str, *, sample_time_s: float | None = None, parameters: Mapping[str, float] | None = None):
        name = _text.path(name, "name")
        if sample_time_s is None:
            sample_time_s = _core.plant_description(name)["time_unit_s"]
        self._core = _core.Plant(name, dict(_text.numbers_of(parameters, "parameters")), _text.real(sample_time_s, "sample_time_s"))

    def step(self, u: Values | None = None, d: Values | None = None) -> numpy.ndarray:
        """Holds u and d over a sample; returns the outputs at its end, n_y. What is left out stays as it was.

        Raises InputError for what is not finite or out of range, RuntimeError if the plant could not be moved.
        """
        return self._core.step(u, d)

    def reset(self, state: Values | None = None) -> numpy.ndarray:
        """Back to the nominal state, with `state` (n_states, or a dict of some) over it; returns the outputs, n_y. Raises InputError."""
        return self._core.reset(state)

    def derivatives(self, x: Values | None = None, u: Values | None = None, d: Values | None = None) -> numpy.ndarray:
        """dx/dt, n_states, per time unit of the description, where it is or at what is given. Raises InputError."""
        return self._core.derivatives(x, u, d)

    @property
    def outputs(self) -> numpy.ndarray:
        """n_y, in the units of the description."""
        return self._core.outputs

    @property
    def state(self) -> numpy.ndarray:
        """n_states, in the units of the description."""
        return self._core.state

    @property
    def time_s(self) -> float:
        """[s] since the start or the last reset()."""
        return self._core.time_s

    @property
    def sample_time_s(self) -> float:
        """[s] over which step() moves it."""
        return self._core.sample_time_s

    @property
    def description(self) -> dict[str, Any]:
        """Title, time unit, outputs; states, inputs, disturbances, parameters as (name, unit, nominal, lower, upper)."""
        return self._core.description

    def __repr__(self) -> str:
        about = self.description
        return f"<fmbpc.Plant {about['name']}: {about['title']}, {self.time_s:g} s>"


class Simulation:
    """The plant of a loop with its records, actuators, sensors and noise (docs/loop_file.md). Made by Loop.simulation()."""

    def __init__(self, core, loop: "Loop"):
        self._core, self.loop = core, loop

    def step(self, u: Values) -> numpy.ndarray:
        """Sends u(k), which the actuator keeps inside its limits; returns the outputs of sample k + 1, NaN where none came.

        Raises InputError naming what is wrong with u, and after the final sample.
        """
        return self._core.step(u)

    def reset(self) -> numpy.ndarray:
        """Back to sample 0; returns its outputs, n_y."""
        return self._core.reset()

    def disturb(self, **values: float) -> None:
        """Overrides disturbances from the next sample on; `**{"input/NAME": value}` a stuck valve, "output/NAME" a sensor.

        Values are in the units of the loop. Raises InputError naming what is unknown or not finite; then nothing is changed.
        """
        self._core.disturb(values)

    @property
    def outputs(self) -> numpy.ndarray:
        """n_y, as measured at the present sample."""
        return self._core.outputs

    @property
    def true_outputs(self) -> numpy.ndarray:
        """n_y, without noise and faults."""
        return self._core.true_outputs

    @property
    def disturbance(self) -> numpy.ndarray:
        """n_d, as measured."""
        return self._core.disturbance

    @property
    def applied(self) -> numpy.ndarray:
        """n_u, what the actuators did over the last sample."""
        return self._core.applied

    @property
    def state(self) -> numpy.ndarray:
        """n_states of the plant, as they are."""
        return self._core.state

    @property
    def setpoint(self) -> numpy.ndarray:
        """n_y, what the loop's schedule asks of the present sample."""
        return self._core.setpoint

    @property
    def time_h(self) -> float:
        """[h] since the start, of the present sample."""
        return self._core.time_h

    @property
    def samples(self) -> int:
        """Number of the present sample."""
        return self._core.samples

    @property
    def done(self) -> bool:
        """This is the final sample."""
        return self._core.done

    @property
    def trouble(self) -> str:
        """Why the plant could last not be moved, with the sample; empty if it always could."""
        return self._core.trouble

    def __repr__(self) -> str:
        return f"<fmbpc.Simulation of {self.loop.name}, sample {self.samples}>"


def plants() -> dict[str, dict[str, Any]]:
    """Descriptions of the registered plants by name; see Plant.description and docs/own_plant.md."""
    return {name: _core.plant_description(name) for name in _core.plant_names()}
