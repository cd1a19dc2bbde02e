"""A loop's law before a plant that is not ours."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Sequence, Union

import numpy

from fmbpc import _text
from fmbpc._run import Event

if TYPE_CHECKING:
    from fmbpc._loop import Loop
    from fmbpc._model import Model

Values = Union[float, Sequence[float], numpy.ndarray, Mapping[str, float]]


class Controller:
    """The law of a loop with guard, optimizer and identifier, one sample a call.

    Before the loop's own plant it gives the bits of the run. Arrays are in the order of the loop's `outputs`,
    `inputs` and `disturbances`; a dict, or a Series with names as its index, names what it holds. Made by
    Loop.controller(). What the laws compute and where they were published: docs/theory.md. Controllers share nothing and may run in threads; one of them takes one call at a time (RuntimeError).
    """

    def __init__(self, core, loop: "Loop"):
        self._core, self.loop = core, loop
        self._step = core.step

    def step(self, y: Values, setpoint: Values | None = None, disturbance: Values | None = None, applied: Values | None = None,
             quality: Sequence[bool] | Mapping[str, bool] | None = None) -> numpy.ndarray:
        """u(k), inside the limits of the loop, n_u.

        y: what is measured at this sample, n_y
        setpoint: n_y, until another one comes; until the first one the schedule of the loop file holds
        disturbance: what is measured of the disturbances, n_d; left out: as at the last sample
        applied: n_u, what the actuators really did since the last sample; left out: what was asked
        quality: False marks a reading that cannot be used, outputs then disturbances: the law is held
            or uses what the loop file says. Without it a number that is not finite is an error.
        Raises InputError naming the argument and the signal; the controller is then as before.
        """
        return self._step(y, setpoint, disturbance, applied, quality)

    def reset(self, y: Values, setpoint: Values | None = None, disturbance: Values | None = None, applied: Values | None = None,
              quality: Sequence[bool] | Mapping[str, bool] | None = None) -> numpy.ndarray:
        """Begins anew with this as sample 0 and returns u(0); see step(). `applied` left out: the loop's initial input.

        Setpoints are again those of the schedule; what manual(), retune() and set_model() have set stays.
        Raises InputError as step().
        """
        return self._core.reset(y, setpoint, disturbance, applied, quality)

    def manual(self, u: Values) -> None:
        """A person's input from the next sample on, inside the limits; the law looks on. Bumpless both ways. Raises InputError."""
        self._core.manual(u)

    def auto(self) -> None:
        """Gives the input back to the law."""
        self._core.automatic()

    def release(self) -> None:
        """Gives the setpoint back to the schedule of the loop file."""
        self._core.release_setpoint()

    def retune(self, **settings: Any) -> None:
        """Changes settings of the law from the next sample on; see `settings`. Raises InputError, and then changes nothing."""
        from fmbpc import InputError
        if not self._core.retune([(key, _text.yaml_text(value)) for key, value in settings.items()]):
            raise InputError(f"retune: {self.loop.law} has nothing to change")

    def adapt(self, on: bool) -> None:
        """Lets the law change itself, or freezes it. Raises InputError for one that never does."""
        from fmbpc import InputError
        if not self._core.adapt(on):
            raise InputError(f"adapt: {self.loop.law} never changes itself")

    def set_model(self, model: "Model") -> None:
        """Another model from the next sample on, bumplessly. Raises InputError if it does not fit or cannot be trusted here; the old one stays."""
        self._core.set_model(_text.core_of(model, "model", "Model"))

    @property
    def settings(self) -> dict[str, str]:
        """What retune() may change, as it is now."""
        return self._core.settings

    @property
    def steps(self) -> int:
        """Samples answered since the start or the last reset()."""
        return self._core.steps

    @property
    def setpoint(self) -> numpy.ndarray:
        """n_y of the last sample, clamped and rate-limited as the loop file says."""
        return self._core.setpoint

    @property
    def reference(self) -> numpy.ndarray:
        """n_y, the filtered path to the setpoint at the last sample."""
        return self._core.reference

    @property
    def source(self) -> str:
        """Where the last input came from: base, constrained, clipped, held, manual, fallback, guarded."""
        return self._core.source

    @property
    def events(self) -> list[Event]:
        """What is to be known of the last sample."""
        return [Event(*event) for event in self._core.events]

    @property
    def signals(self) -> dict[str, float]:
        """Numbers of the law at the last sample, by name."""
        return self._core.signals

    @property
    def trust(self) -> float | None:
        """How far the law trusts its model here, 0..1; None: it has none."""
        return self.signals.get("model_trust")

    @property
    def prediction(self) -> dict[str, numpy.ndarray] | None:
        """The local model and law of the last sample, frozen over n_c samples; None: the law does not predict.

        x(k+i+1) = A x(k+i) + B u(k+i) + offset_state, y(k+i) = C x(k+i) + offset_output,
        u(k+i) = -K x(k+i) + feedforward[i]; `inputs` (n_c, n_u) and `outputs` (n_c, n_y) are what follows,
        outputs[i] at k+1+i, for which `reference` (n_c, n_y) is asked. `state` is x(k).
        """
        p = self._core.prediction
        if p is None:
            return None
        x, inputs, outputs = p["state"], [], []
        for feedforward in p["feedforward"]:
            u = feedforward - p["K"] @ x
            x = p["A"] @ x + p["B"] @ u + p["offset_state"]
            inputs.append(u)
            outputs.append(p["C"] @ x + p["offset_output"])
        p["inputs"], p["outputs"] = numpy.array(inputs), numpy.array(outputs)
        return p

    @property
    def report(self) -> dict[str, Any] | None:
        """What the optimizer did at the last sample: perturbation, status, iterations, KKT residual, active rows."""
        return self._core.report

    def __repr__(self) -> str:
        return f"<fmbpc.Controller {self.loop.law} of {self.loop.name}, {self.steps} samples>"
