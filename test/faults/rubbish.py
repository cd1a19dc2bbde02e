"""The loop takes messages of the exchange from anyone (loop.publishers: []), and gets wrong ones: steps far ahead, other runs,
NaN, wrong sizes, answers of an impostor, bursts. What the plant keeps sending wins."""
import math

from fault import Fault
from strangers import far, final, latest, needs, next_run

NAN = [math.nan]
WRONG_SIZE = ("dropped: wrong size", "refused: measurement")  # the second: its qualities, of a gateway, are of another size


def fault(topic, name, change, times=3, counted=None, said=None, lasts=1.0, **more):
    def do(loop):
        message = latest(loop, topic)
        change(message, loop)
        loop.send(topic, message, times)
    return Fault(f"rubbish: {topic}, {name}", do, counted=counted, said=said, needs=needs(topic), lasts=lasts, **more)


def inputs(make):
    def change(message, loop):
        message.input = make(loop.info().inputs)
    return change


def nan(field):
    def change(message, _):
        setattr(message, field, NAN * len(getattr(message, field)))
    return change


def sized(field, size):
    def change(message, _):
        setattr(message, field, [1.0] * size)
    return change


def ahead(steps):
    def change(message, _):
        message.step += steps
    return change


def stale(message, _):
    message.step = max(0, message.step - 5)


def bad_matrix(message, _):
    message.A.data = [1.0]


def other_units(message, _):
    message.outputs[0].unit = "furlong"


def impostor(loop):
    """Answers every sample before the loop does, with the valves open: the plant goes on with the one that commands it."""
    for _ in range(10):
        message = latest(loop, "control_action")
        message.input = [signal.upper for signal in loop.info().inputs]
        loop.send("control_action", message)
        loop.samples(1)


PLANT, CONTROLLER, OPTIMIZER, RECORDER = "plant_simulator", "fmbpc_controller", "clp_optimizer", "loop_recorder"
FAULTS = [
    fault("measurement", "one step far ahead", far, times=1, counted=(CONTROLLER, "dropped: step too far ahead")),
    fault("measurement", "three steps far ahead", far),
    fault("measurement", "10 steps ahead", ahead(10)),
    fault("measurement", "900 steps ahead", ahead(900)),
    fault("measurement", "final", final),
    fault("measurement", "another run", next_run, counted=(CONTROLLER, "dropped: run not announced")),
    fault("measurement", "5 steps old", stale, counted=(CONTROLLER, "dropped: old step")),
    fault("measurement", "NaN at the next step", lambda m, loop: (nan("outputs")(m, loop), ahead(1)(m, loop))),
    fault("measurement", "no outputs", sized("outputs", 0), counted=(CONTROLLER, WRONG_SIZE)),
    fault("measurement", "too many outputs", sized("outputs", 9), counted=(CONTROLLER, WRONG_SIZE)),
    fault("measurement", "burst of 3000 old ones", stale, times=3000),
    fault("base_action", "far ahead", far),
    fault("base_action", "NaN", nan("input")),
    fault("base_action", "no inputs", sized("input", 0)),
    fault("predictive_action", "far ahead", far),
    fault("predictive_action", "matrix of wrong size", bad_matrix, counted=(OPTIMIZER, "refused: predictive_action")),
    fault("predictive_action", "NaN state", nan("state")),
    fault("control_action", "far ahead", far, counted=(PLANT, "actions dropped: later step")),
    fault("control_action", "NaN", lambda m, loop: (nan("input")(m, loop), ahead(0)(m, loop))),
    fault("control_action", "no inputs", sized("input", 0)),
    fault("control_action", "another run", next_run, counted=(PLANT, "refused: control_action")),
    fault("control_action", "burst of 3000", stale, times=3000, counted=(PLANT, "actions dropped: old step")),
    Fault("rubbish: control_action, an impostor that is first ten times", impostor, counted=(PLANT, "refused: control_action"), lasts=1.0),
    fault("tracking", "far ahead", far, counted=(RECORDER, "dropped: other run")),
    fault("tracking", "wrong size", sized("setpoint", 7), counted=(RECORDER, "dropped: wrong size")),
    fault("solver_report", "wrong size", sized("perturbation", 0)),
    fault("plant_state", "wrong size", sized("state", 1), counted=(RECORDER, "dropped: wrong size")),
    fault("plant_info", "run 2^63", next_run, times=1, lasts=2.5, gap=True),
    fault("plant_info", "other units", other_units, times=1, counted=(CONTROLLER, "refused: plant_info"), gap=True),
]


def announced_lie(loop):
    info, now = latest(loop, "plant_info"), latest(loop, "measurement")
    info.run_id = now.run_id = 2 ** 63
    loop.send("plant_info", info)
    loop.send("measurement", now, 3)


FAULTS += [Fault("rubbish: a second plant announces a run and measures once", announced_lie, lasts=3.0, gap=True)]
