"""One fault on a running loop, and the verdict computed from what was recorded meanwhile."""
import os
import time
import types

from fault import PATIENCE, RECOVERY, SETTLE, SILENCE, Outcome
from loop_under_test import SIMULATOR

PLC_PATIENCE = 0.9  # s without a command until a gateway's plant takes its inputs itself


class Limits:
    """Bounds from plant_info, move limits of the launch."""

    def __init__(self, info, move_share):
        self.names = [signal.name for signal in info.inputs]
        self.lower = [signal.lower for signal in info.inputs]
        self.upper = [signal.upper for signal in info.inputs]
        self.range = [u - l for l, u in zip(self.lower, self.upper)]
        self.move = [move_share * r for r in self.range]


def forced_steps(loop, start):
    """{(step, input)} at which somebody put a valve by hand (disturbance input/NAME): what counts is what the loop commands,
    so the jump of a forced valve, and its way while it is forced, are no moves of the loop."""
    return {(effect.step, name.split("/", 1)[1]) for _, effect in loop.effects.since(start) for name in effect.name
            if name.startswith("input/")}


def genuine_samples(loop, start):
    """(time, sample with step, run_id, input_missing) that the plant itself has shown: its states, or behind a gateway its
    measurements, which nobody forges there."""
    if loop.far is None:
        return [(t, s) for t, s in loop.logs["plant_state"].since(start)]
    return [(t, types.SimpleNamespace(step=m.step, run_id=m.run_id, state=True, input_missing=m.local))
            for t, m in loop.logs["measurement"].since(start)]


def judge_law(loop, limits, start, outcome):
    """Behind a gateway: no input is further than a move from what was asked of it."""
    asked = {(a.run_id, a.step): a.input for _, a in loop.logs["control_action"].since(start)}
    for _, m in loop.logs["measurement"].since(start):
        before = (m.run_id, m.step - 1)
        if before not in asked:
            continue
        for i, name in enumerate(limits.names):
            if abs(m.input_applied[i] - asked[before][i]) > limits.move[i] + 1e-6 * limits.range[i]:
                outcome.problems.append(f"sample {m.step}: {name} = {m.input_applied[i]:.6g}, asked was {asked[before][i]:.6g}")


def judge_inputs(loop, limits, start, outcome, own_hand=False):
    """Bounds and move limits of what the plant applied, sample by sample, and that no sample is missing."""
    seen, arrived = {}, {}
    for t, m in loop.logs["measurement"].since(start - 1.0):
        if len(m.input_applied) == len(limits.names):
            seen.setdefault(m.run_id, {})[m.step] = m
            arrived[m.run_id, m.step] = t
    real = {s.run_id for _, s in genuine_samples(loop, start - 1.0) if s.state}
    forced = forced_steps(loop, start)
    for run_id in sorted(set(seen) & real):
        genuine = {s.step for _, s in genuine_samples(loop, start - 1.0) if s.run_id == run_id}
        run = {step: m for step, m in seen[run_id].items() if step in genuine}
        steps = sorted(run)
        if steps and steps != list(range(steps[0], steps[-1] + 1)):
            outcome.problems.append("samples missing")
        for before, after in zip(steps, steps[1:]):
            late = arrived[run_id, after] - arrived[run_id, before] > PLC_PATIENCE  # it has taken its inputs meanwhile
            if not (own_hand and (run[before].local or run[after].local or late)):
                judge_move(run[before], run[after], limits, forced, outcome)


def judge_move(before, after, limits, forced, outcome):
    for i, name in enumerate(limits.names):
        value, move = after.input_applied[i], abs(after.input_applied[i] - before.input_applied[i])
        if not limits.lower[i] - 1e-9 <= value <= limits.upper[i] + 1e-9:
            outcome.problems.append(f"sample {after.step}: {name} = {value:.6g} outside its bounds")
        if (after.step, name) in forced or (before.step, name) in forced:
            continue
        outcome.largest_move = max(outcome.largest_move, 100.0 * move / limits.range[i])
        if move > limits.move[i] + 1e-9 * limits.range[i]:
            outcome.problems.append(f"sample {after.step}: {name} moved by {move:.6g}, allowed are {limits.move[i]:.6g}")


def judge_stalls(loop, start, end, outcome):
    """A time without samples must be said while it lasts, by anybody of the loop; not one in which the whole machine stood
    still, this process with it."""
    times = [start] + [t for t, _ in genuine_samples(loop, start)] + [end]
    words = loop.words(start - 2.0)
    for before, after in zip(times, times[1:]):
        stood_still = loop.pulse.within(before, after)
        if after - before - stood_still <= SILENCE:
            outcome.stood_still = max(outcome.stood_still, stood_still)
            continue
        if not any(before - 0.5 <= t <= before + SILENCE + 0.3 for t, _ in words):
            outcome.problems.append(f"silent stall of {after - before:.1f} s")


def bump_of(loop, limits, start):
    """The largest first move after the input was held or on its fallback, in % of the range."""
    state = {s.step: s for _, s in genuine_samples(loop, start)}
    inputs = {m.step: m for _, m in loop.logs["measurement"].since(start) if len(m.input_applied) == len(limits.names)}
    largest = 0.0
    for step, s in state.items():
        before = state.get(step - 1)
        if before is None or not before.input_missing or s.input_missing or not {step, step - 1} <= set(inputs):
            continue
        moves = (abs(a - b) / r for a, b, r in zip(inputs[step].input_applied, inputs[step - 1].input_applied, limits.range))
        largest = max(largest, 100.0 * max(moves))
    return largest


def samples_until_back(loop, fault, undone):
    """Samples from the end of the fault until the loop is as it should be and stays so for five; None: not in time."""
    said = loop.wait_for_summary(fault.end, undone, RECOVERY)
    if said is None:
        return None
    end = time.monotonic() + RECOVERY
    while time.monotonic() < end:
        states = [s for _, s in genuine_samples(loop, undone)]
        good = [i for i, s in enumerate(states) if not s.input_missing]
        if len(states) >= 5 and good and states[-1].input_missing is False and len(states) - good[0] >= 5:
            run = len(states) - 1
            while run > 0 and not states[run - 1].input_missing:
                run -= 1
            return run
        time.sleep(0.05)
    return None


def meet(loop, limits, fault):
    """Does it, waits for its words, undoes it, waits for the loop, and judges."""
    outcome = Outcome(fault.name)
    before = loop.pids()
    count = loop.counter(*fault.counted) if fault.counted else 0
    start = outcome.began = time.monotonic()
    attempt(fault.do, loop, outcome)
    if fault.said:
        found = loop.wait_for_words(fault.said.replace(SIMULATOR, loop.plant), start, max(PATIENCE, fault.said_within))
        if found:
            outcome.said_after, outcome.said_words = found
        if found is None or found[0] > fault.said_within:
            outcome.problems.append(f"not said within {fault.said_within:.0f} s" + (f" but after {found[0]:.1f} s" if found else ""))
    time.sleep(fault.lasts)
    if fault.undo:
        attempt(fault.undo, loop, outcome)
    undone = time.monotonic()
    if fault.touches:
        time.sleep(SETTLE)
    outcome.back_after = samples_until_back(loop, fault, undone)
    if outcome.back_after is None:
        state = loop.summary()
        outcome.problems.append(f"not {fault.end} within {RECOVERY:.0f} s: {state.word if state else '?'}: "
                                f"{state.reason if state else ''}")
    judge_counter(loop, fault, count, outcome)
    end = time.monotonic()
    judge_stalls(loop, start, end, outcome)
    judge_inputs(loop, limits, start, outcome, fault.own_hand)
    if loop.far and not fault.own_hand:
        judge_law(loop, limits, start, outcome)
    outcome.bump = bump_of(loop, limits, start)
    judge_processes(loop, fault, before, outcome)
    if fault.after:
        attempt(fault.after, loop, outcome)
    outcome.ended = time.monotonic()
    return outcome


def attempt(action, loop, outcome):
    """Does it; what it complains of, and what goes wrong in it, is a problem."""
    try:
        complaint = action(loop)
    except Exception as error:  # whatever it is, the matrix goes on
        complaint = f"{type(error).__name__}: {error}"
    if isinstance(complaint, str):
        outcome.problems.append(complaint)


def judge_counter(loop, fault, count, outcome):
    if not fault.counted:
        return
    end = time.monotonic() + PATIENCE
    while loop.counter(*fault.counted) <= count:
        if time.monotonic() > end:
            outcome.problems.append(f"{fault.counted[0]} did not count '{fault.counted[1]}'")
            return
        time.sleep(0.05)


def judge_processes(loop, fault, before, outcome):
    """Nobody has died but those whom the fault kills."""
    for node, process in before.items():
        if process and node.lstrip("/") not in fault.touches and not os.path.exists(f"/proc/{process}"):
            outcome.problems.append(f"{node} crashed")
