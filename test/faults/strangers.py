"""A stranger speaks on every topic of the loop: refused, counted by name, and nothing changes."""
import copy

from fault import Fault

ME = "/fault_matrix"
LISTENER = {"plant_info": "fmbpc_controller", "measurement": "fmbpc_controller", "plant_state": "loop_recorder",
            "base_action": "clp_optimizer", "predictive_action": "clp_optimizer", "control_action": "plant_simulator",
            "tracking": "loop_recorder", "solver_report": "loop_recorder", "fuzzy_model": "fmbpc_controller"}
NEEDS = {"base_action": "optimizer", "predictive_action": "optimizer", "solver_report": "optimizer", "plant_state": "simulator",
         "fuzzy_model": "model"}


def needs(topic):
    return (NEEDS[topic],) if topic in NEEDS else ()


def latest(loop, topic):
    """A copy of the topic's last message, for the sample on the table."""
    message, now = copy.deepcopy(loop.logs[topic].last()), loop.now()
    if hasattr(message, "step"):
        message.run_id, message.step = now.run_id, now.step
    return message


def forged(topic, change, what):
    def do(loop):
        message = latest(loop, topic)
        change(message, loop)
        loop.send(topic, message, 20)
    return Fault(f"stranger: {topic}, {what}", do, counted=(LISTENER[topic], f"refused: {topic} from {ME}"), needs=needs(topic),
                 lasts=1.0)


def far(message, _):
    message.step += 4000000


def next_run(message, _):
    message.run_id = 2 ** 63


def full_open(message, loop):
    message.input = [signal.upper for signal in loop.info().inputs]


def final(message, _):
    message.final, message.step = True, message.step + 1


def zeros(message, _):
    message.outputs = [0.0] * len(message.outputs)


def other_setpoint(message, _):
    message.setpoint = [1.0] * len(message.setpoint)


def as_it_is(*_):
    pass


def say(topic, make, what, **more):
    return Fault(f"stranger: {topic}, {what}", lambda loop: loop.send(topic, make(loop), 5), lasts=2.5, **more)


def finished(loop):
    state = copy.deepcopy(loop.summary())
    state.mode, state.word, state.reason = 8, "finished", "finished"
    return state


def forgotten(loop):
    kept = copy.deepcopy(loop.logs["operator_kept"].last())
    kept.manual, kept.manual_given, kept.manual_input = True, True, [s.lower for s in loop.info().inputs]
    return kept


def kind(loop, topic, **fields):
    return loop.publishers[topic].data_class(**fields)


FAULTS = [
    forged("plant_info", next_run, "another run"),
    forged("plant_info", as_it_is, "as it is"),
    forged("measurement", zeros, "outputs of 0"),
    forged("measurement", far, "step far ahead"),
    forged("measurement", final, "final"),
    forged("measurement", next_run, "another run"),
    forged("plant_state", as_it_is, "as it is"),
    forged("base_action", full_open, "valves open"),
    forged("predictive_action", far, "step far ahead"),
    forged("control_action", full_open, "valves open, in time"),
    forged("control_action", far, "step far ahead"),
    forged("tracking", other_setpoint, "other setpoint"),
    forged("solver_report", as_it_is, "as it is"),
    forged("fuzzy_model", as_it_is, "as it is"),
    say("loop_state", finished, "the summary 'finished'"),
    say("operator_kept", forgotten, "manual"),
    say("operator_state", forgotten, "manual"),
    say("ready", lambda loop: kind(loop, "ready", node="/nobody"), "of an unknown node"),
    say("recorded", lambda loop: kind(loop, "recorded", data="/nowhere"), "early"),
    say("run_end", lambda loop: kind(loop, "run_end", data="recorded"), "early"),
]
