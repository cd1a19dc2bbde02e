"""Loops by name, path or dict."""
from __future__ import annotations

import os
import tempfile
from typing import Any, Callable, Mapping, Sequence

from fmbpc import _core, _progress, _text
from fmbpc._control import Controller
from fmbpc._described import Described
from fmbpc._plant import Simulation
from fmbpc._run import Run


class Loop(Described):
    """A loop: plant, law, optimizer, schedule, as a loop file says (docs/loop_file.md lists the keys).

    loop: a name of loops(), a path, or a dict with the sections of a file, `extends` included
    set: keys over the file, {"sampling.duration_h": 48}, as --set of the tool; a text is a YAML value
    Raises InputError, in the words of the tool: file, line, key and what was expected.
    """

    def __init__(self, loop: str | os.PathLike | Mapping[str, Any], *, set: Mapping[str, Any] | Sequence[str] | None = None):
        pairs = _text.overrides(set)
        if isinstance(loop, Mapping):
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "loop.yaml")
                with open(path, "w", encoding="utf-8") as stream:
                    for key, value in loop.items():
                        stream.write(f"{key}: {_text._flow(value)}\n")
                self._core = _core.read_loop(path, pairs)
        else:
            self._core = _core.read_loop(_text.path(loop, "loop"), pairs)

    @property
    def title(self) -> str:
        """What it shows, in a line, with its source."""
        return self._core.title

    @property
    def samples(self) -> int:
        """How many inputs a run sends; 0: it has no end of its own."""
        return self._core.samples

    @property
    def plant(self) -> str:
        """Type of the plant."""
        return self._core.plant

    @property
    def law(self) -> str:
        """Type of the controller, " + clp" behind it where an optimizer follows."""
        return self._core.type + (" + clp" if self._core.has_optimizer else "")

    @property
    def model_file(self) -> str:
        """Path of the model that the law starts with; empty: none."""
        return self._core.model_file

    @property
    def resolved(self) -> str:
        """The text that the loop was read from: merged, checked, with all that `set` changed."""
        return self._core.resolved

    def run(self, *, progress: bool | Callable[[float, str], None] | None = None, commands: str | os.PathLike | None = None) -> Run:
        """Closes the loop in this process and returns what happened.

        progress: True, False, a callable (share, words), or None: a bar where a person looks
        commands: a file of what an operator does (docs/operation.md)
        Ctrl-C ends the run; what there is until then is returned, with `interrupted` true.
        Raises InputError for an external plant or an endless run, and what code of your own raises.
        """
        with _progress.bar(self.name, progress) as bar:
            return Run(self._core.run("" if commands is None else _text.path(commands, "commands"), bar))

    def controller(self) -> Controller:
        """The law with guard, optimizer and identifier, before a plant that is not ours."""
        return Controller(self._core.controller(), self)

    def simulation(self) -> Simulation:
        """The plant of the loop, with its records, actuators, sensors and noise, before a law that is not ours."""
        return Simulation(self._core.simulation(), self)

    def export(self, folder: str | os.PathLike, *, to: str = "all", single: bool = False, name: str = "law", samples: int = 1000,
               seed: int = 1) -> list[str]:
        """The law as a block for a PLC or a board, with vectors and tests, as `fmbpc export` (docs/export.md).

        to: "c99", "st" or "all"; single: single precision; samples, seed: of the closed loops of its vectors
        Returns the names of the files in the folder. Raises InputError, also for a law that is not exported.
        """
        if to not in ("c99", "st", "all"):
            raise _core.InputError(f"to: expected c99, st or all, got {to}")
        return self._core.export(_text.path(folder, "folder"), to != "st", to != "c99", single, name, _text.whole(samples, "samples"), _text.whole(seed, "seed"))

    def __repr__(self) -> str:
        return f"<fmbpc.Loop {self.name}: {self.plant} with {self.law}>"


def loops(*words: str) -> list[str]:
    """Names of the loops that are shipped or lie below $FMBPC_CONFIG_PATH, those that contain all words: loops("asp", "pi"); docs/loop_file.md."""
    return [name for name in _core.loop_names() if all(_text.text(word, "words") in name for word in words)]
