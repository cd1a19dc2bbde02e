"""Many runs on all cores, and analyses; the results are what the tool prints as JSON."""
from __future__ import annotations

import contextlib
import json
import numbers
import pathlib
import tempfile
import threading
from typing import Any, Callable, Mapping, Sequence

from fmbpc import _core, _progress, _text
from fmbpc._loop import Loop
from fmbpc._model import Model


def _interruptible(call, progress):
    """In a thread of its own, so that Ctrl-C reaches this one; the computation hears of it by its progress."""
    ended, found = threading.Event(), {}

    def look(share, words):
        if ended.is_set():
            raise KeyboardInterrupt
        if progress is not None:
            progress(share, words)

    def work():
        try:
            found["value"] = call(look)
        except BaseException as error:  # handed over to the caller below
            found["error"] = error
    thread = threading.Thread(target=work)
    thread.start()
    try:
        while thread.is_alive():
            thread.join(0.1)
    except KeyboardInterrupt:
        ended.set()
        thread.join()
        raise
    if "error" in found:
        raise found["error"]
    return json.loads(found["value"])


def study(*loops: str, set: Mapping[str, Any] | None = None, seeds: str | int | Sequence[int] = "", vary: Mapping[str, str] | None = None,
          noise: Mapping[str, float] | None = None, noise_percent: float | None = None, against: str = "", index: str = "", threads: int = 0,
          progress: bool | Callable[[float, str], None] | None = None) -> dict[str, Any]:
    """Compares loops in pairs over seeds, parameters and noise; or runs the one study file that is named (docs/study.md).

    loops: names or paths; set: keys over all of them, as Loop() takes them
    seeds: a number of them, a list, or "1:40"; vary: {"KEY": "0.7:1.3"} factors, "value:0.1:0.2" numbers
    noise: {"OUTPUT": std}; noise_percent of the span of the setpoints; against: the loop to pair with, else the last
    index: of docs/study.md, ise if left out; threads: 0 all cores, the answer does not depend on it
    Returns `loops` with quantiles of the cost, `pairs`, and `runs`. Raises InputError; Ctrl-C KeyboardInterrupt.
    """
    text = seeds if isinstance(seeds, str) else f"1:{_text.whole(seeds, 'seeds')}" if isinstance(seeds, numbers.Number) else ",".join(map(str, seeds))
    noise_share = -1.0 if noise_percent is None else _text.real(noise_percent, "noise_percent")
    threads = _text.whole(threads, "threads")
    varied = [f"{key}={value}" for key, value in _text.items(vary, "vary")]
    noisy = [f"{key}={value!r}" for key, value in _text.numbers_of(noise, "noise")]
    against, index = _text.text(against, "against"), _text.text(index, "index")
    with _progress.bar("study", progress) as bar:
        return _interruptible(lambda look: _core.study([_text.path(loop, "study") for loop in loops], _text.assignments(set), varied, noisy,
                                                       noise_share, text, against, index, threads, look), bar)


def tune(loop: str, tuning: str, *, set: Mapping[str, Any] | None = None, method: str = "", evaluations: int = 0, seed: int = -1, threads: int = 0,
         progress: bool | Callable[[float, str], None] | None = None) -> dict[str, Any]:
    """Searches numbers of a loop file, as a tuning file says (docs/tuning.md).

    loop, tuning: names or paths; set: keys over the loop, as Loop() takes them; threads: 0 all cores
    method, evaluations, seed: instead of what the file says
    Returns the costs before and after and the values found, as tuning.json. Raises InputError; Ctrl-C KeyboardInterrupt.
    """
    counts = [_text.whole(value, what) for value, what in ((evaluations, "evaluations"), (seed, "seed"), (threads, "threads"))]
    with _progress.bar("tune", progress) as bar:
        return _interruptible(lambda look: _core.tune(_text.path(loop, "loop"), _text.path(tuning, "tuning"), _text.assignments(set), _text.text(method, "method"), *counts, look), bar)


def commission(brief: str, folder: str = "", *, until: str = "design", again: str = "", evaluations: int = 48, members: int = 16, threads: int = 0,
               progress: bool | Callable[[float, str], None] | None = None) -> dict[str, Any]:
    """Goes from a brief of a simulated plant to a law that holds it, stage by stage (docs/commissioning.md).

    folder: keeps what is done, so that the next call goes on; NAME_commissioned if left out
    until: last stage, of brief, watch, test, model, design; again: this one and those after it once more
    evaluations: of each search of stage design; members: of the ensemble of models
    Returns the figures of each stage, None of those that are not done. Raises InputError; Ctrl-C KeyboardInterrupt, and what is done is kept.
    """
    brief = _text.path(brief, "brief")
    folder = _text.path(folder, "folder") or f"{pathlib.Path(brief).stem}_commissioned"
    counts = [_text.whole(value, what) for value, what in ((evaluations, "evaluations"), (members, "members"), (threads, "threads"))]
    with _progress.bar("commission", progress) as bar:
        return _interruptible(lambda look: _core.commission(brief, folder, _text.text(until, "until"), _text.text(again, "again"), *counts, look), bar)


def stability(subject: str | Loop | Model, *, set: Mapping[str, Any] | None = None, at: Mapping[str, float] | None = None,
              horizon: range | str = "1..200", noise_gain: float = 0.0, settling: int = 0, points: int = 4,
              on_model: bool = False) -> dict[str, Any]:
    """Margins of a loop; of a fuzzy law eigenvalues over the coincidence horizon and a Lyapunov certificate (docs/stability.md).

    subject: a Loop, a Model, or the name or path of one; set: keys over a loop, as Loop() takes them
    points: so many places of the loop's run at which it is linearised; on_model: the loop's model in the place of its plant
    at: the operating point, {"NAME": value} of inputs, disturbances, outputs; horizon: range(1, 201) or "1..200"
    noise_gain and settling [samples]: largest ones of an advised horizon
    Returns what `fmbpc stability --json` prints. Raises InputError.
    """
    if isinstance(horizon, range) and horizon.step != 1:
        raise _core.InputError("horizon: expected a range without steps")
    text = f"{horizon.start}..{horizon.stop - 1}" if isinstance(horizon, range) else horizon
    point = ",".join(f"{key}={value!r}" for key, value in _text.numbers_of(at, "at"))
    counts = [_text.whole(value, what) for value, what in ((settling, "settling"), (points, "points"))]
    with _file_of(subject) as file:
        return json.loads(_core.stability(file, _text.assignments(set), point, text, _text.real(noise_gain, "noise_gain"), *counts, bool(on_model)))


@contextlib.contextmanager
def _file_of(subject):
    """Name or path; of a Loop or a Model, the path of a file while it is needed."""
    if not isinstance(subject, (Loop, Model)):
        yield _text.path(subject, "subject")
        return
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, subject.name + ".yaml")
        file.write_text(subject.resolved if isinstance(subject, Loop) else subject._core.text, encoding="utf-8")
        yield str(file)
