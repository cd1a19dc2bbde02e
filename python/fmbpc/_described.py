"""What loops and models say of themselves alike."""
from __future__ import annotations

from typing import Any


class Described:
    """Name, sample time and signals of the object of the core in `_core`."""

    _core: Any

    @property
    def name(self) -> str:
        """As its file calls it."""
        return self._core.name

    @property
    def sample_time_s(self) -> float:
        """[s] from one sample to the next."""
        return self._core.sample_time_s

    @property
    def outputs(self) -> list[tuple[str, str, float, float]]:
        """(name, unit, lower, upper) of each measured output: of a model the range of the data."""
        return self._core.outputs

    @property
    def inputs(self) -> list[tuple[str, str, float, float]]:
        """(name, unit, lower, upper) of each input: of a loop the limits of the actuator, of a model the range of the data."""
        return self._core.inputs

    @property
    def disturbances(self) -> list[tuple[str, str, float, float]]:
        """(name, unit, lower, upper) of each disturbance that is measured."""
        return self._core.disturbances
