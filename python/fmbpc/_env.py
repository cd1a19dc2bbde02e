"""Loops as environments for learning, with the methods of gymnasium; gymnasium itself is used where it is installed."""
from __future__ import annotations

import importlib
import numbers
from typing import TYPE_CHECKING, Any, Callable, Sequence

import numpy

from fmbpc import _core, _text

if TYPE_CHECKING:
    from fmbpc._loop import Loop


class Box:
    """What gymnasium.spaces.Box is, as far as needed without it: lower and upper bounds of a vector."""

    def __init__(self, low, high):
        self.low, self.high = numpy.asarray(low, dtype=float), numpy.asarray(high, dtype=float)
        self.shape, self.dtype = self.low.shape, self.low.dtype
        self._rng = numpy.random.default_rng()

    def seed(self, seed=None):
        self._rng = numpy.random.default_rng(seed)

    def contains(self, x) -> bool:
        x = numpy.asarray(x)
        return bool(x.shape == self.shape and (x >= self.low).all() and (x <= self.high).all())

    def sample(self) -> numpy.ndarray:
        return self._rng.uniform(self.low, self.high)

    def __repr__(self):
        return f"Box({self.low}, {self.high})"


def _gymnasium():
    try:
        return importlib.import_module("gymnasium")
    except ImportError:
        return None


def _box(low, high):
    gymnasium = _gymnasium()
    return Box(low, high) if gymnasium is None else gymnasium.spaces.Box(numpy.asarray(low, float), numpy.asarray(high, float), dtype=numpy.float64)


def _squares(loop):
    """Minus the squared errors, each in parts of its output's range, and a hundredth of the squared moves in parts of the input's."""
    def spans(signals):
        width = numpy.array([s[3] - s[2] for s in signals])
        return numpy.where(numpy.isfinite(width) & (width > 0.0), width, 1.0)
    y_span, u_span = spans(loop.outputs), spans(loop.inputs)

    def reward(y, setpoint, u, move):
        error = numpy.nan_to_num((y - setpoint) / y_span)
        return -float(error @ error) - 0.01 * float((move / u_span) @ (move / u_span))
    return reward


class Env:
    """One loop without its law: reset(), step(action). Made by env().

    An observation holds the measured outputs, their setpoints, the measured disturbances and the applied inputs, n_y + n_y + n_d + n_u,
    in the loop's units; a reading that did not come is the one before. An action is the inputs, n_u, inside action_space. See docs/python.md.
    """

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode = None
    spec = None

    def __init__(self, make: Callable[[int | None], "Loop"], reward: Callable | None = None):
        self._make, self._seed = make, None
        self.loop = make(None)
        self._reward = reward or _squares(self.loop)
        self._plant = self.loop.simulation()
        lower, upper = numpy.array([s[2] for s in self.loop.inputs]), numpy.array([s[3] for s in self.loop.inputs])
        self.action_space = _box(lower, upper)
        size = 2 * len(self.loop.outputs) + len(self.loop.disturbances) + len(self.loop.inputs)
        self.observation_space = _box(numpy.full(size, -numpy.inf), numpy.full(size, numpy.inf))
        self._last = None

    @property
    def unwrapped(self):
        """Itself, as gymnasium asks."""
        return self

    def _observe(self):
        p = self._plant
        seen = numpy.concatenate([p.outputs, p.setpoint, p.disturbance, p.applied])
        if self._last is None:
            self._last = numpy.zeros_like(seen)
        self._last = numpy.where(numpy.isfinite(seen), seen, self._last)
        return self._last.copy()

    def _info(self):
        return {"time_h": self._plant.time_h, "true_outputs": self._plant.true_outputs, "trouble": self._plant.trouble}

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        """(observation, info) of sample 0; a seed makes other disturbances and noise, until the next one.

        Raises InputError for a seed that is not a whole number, 0 or more; `options` are not used.
        """
        if seed is not None and _text.whole(seed, "seed") < 0:
            raise _core.InputError(f"seed: expected 0 or more, got {seed}")
        getattr(super(), "reset", lambda **_: None)(seed=seed, options=options)  # of gymnasium.Env: its random numbers
        if seed is not None and seed != self._seed:
            self._seed, self.loop = seed, self._make(seed)
            self._plant = self.loop.simulation()
        else:
            self._plant.reset()
        self._last = None
        return self._observe(), self._info()

    def step(self, action):
        """(observation, reward, terminated, truncated, info). Terminated: the plant could not be moved; truncated: the final sample.

        Raises InputError naming what is wrong with the action, and after the end.
        """
        before = self._plant.applied
        if self._last is None:
            raise _core.InputError("step: expected reset() before")
        y = self._plant.step(action)
        p = self._plant
        reward = self._reward(y, p.setpoint, p.applied, p.applied - before)
        return self._observe(), reward, bool(p.trouble), p.done, self._info()

    def render(self):
        """Nothing: Run.plot() draws runs."""

    def close(self):
        """Nothing is held open."""


class VectorEnv:
    """The same loop under several seeds, stepped together: observations (n, ...), rewards (n,). An ended one begins anew at its next step.

    Made by env(seeds=...); see docs/python.md.
    """

    def __init__(self, envs: Sequence[Env], seeds: Sequence[int]):
        self.envs, self.seeds, self.num_envs = list(envs), list(seeds), len(envs)
        self.single_action_space, self.single_observation_space = envs[0].action_space, envs[0].observation_space
        self._ended = numpy.zeros(len(envs), dtype=bool)

    def reset(self, *, options: dict[str, Any] | None = None):
        """(observations, infos) of sample 0, each with its seed; raises as Env.reset()."""
        found = [e.reset(seed=s) for e, s in zip(self.envs, self.seeds)]
        self._ended[:] = False
        return numpy.array([o for o, _ in found]), [i for _, i in found]

    def step(self, actions):
        """actions: (n, n_u). The step after an end begins anew: its reward is 0 and its action is not used.

        Returns observations (n, size), rewards, terminated, truncated (n,), infos. Raises InputError as Env.step().
        """
        actions = numpy.asarray(actions)
        if len(actions) != self.num_envs:
            raise _core.InputError(f"actions: expected {self.num_envs} rows")
        found = []
        for env, action, ended in zip(self.envs, actions, self._ended):
            if ended:
                observation, info = env.reset()
                found.append((observation, 0.0, False, False, info))
            else:
                found.append(env.step(action))
        o, r, terminated, truncated, info = zip(*found)
        self._ended = numpy.array(terminated) | numpy.array(truncated)
        return numpy.array(o), numpy.array(r), numpy.array(terminated), numpy.array(truncated), list(info)

    def close(self):
        """Nothing is held open."""


def env(loop, *, set=None, seeds: Sequence[int] | None = None, reward: Callable | None = None):
    """A loop without its law, for learning or for a law of any other kind.

    loop, set: as Loop() takes them; seeds: several of them together, a VectorEnv, else one Env
    reward(y, setpoint, u, move): instead of minus the squared errors and moves in parts of their ranges
    Env has the interface of gymnasium.Env and is one where gymnasium is installed (docs/python.md).
    Raises InputError as Loop() does, and for seeds that are none.
    """
    from fmbpc._loop import Loop
    settings = _text.assignments(set)

    def make(seed):
        plain = Loop(loop, set=settings)
        if seed is None:
            return plain
        seeded = [f"{key}={int(seed)}" for key in plain._core.seeded_keys]
        return Loop(loop, set=settings + seeded) if seeded else plain
    gymnasium = _gymnasium()
    kind = Env if gymnasium is None else type("Env", (Env, gymnasium.Env), {"__doc__": Env.__doc__})
    if seeds is None:
        return kind(make, reward)
    if isinstance(seeds, (str, numbers.Number)) or not len(seeds):
        raise _core.InputError(f"seeds: expected a list of at least one, got {seeds!r}")
    return VectorEnv([kind(make, reward) for _ in seeds], seeds)
