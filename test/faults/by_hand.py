"""What an operator asks is kept when nodes die; what nobody can mean is refused or clamped."""
import math
import time

import dynamic_reconfigure.client
import rospy
from fmbpc.msg import ControlAction
from fmbpc.srv import ManualInput
from std_srvs.srv import SetBool, Trigger

import exchange
from fault import Fault

CONTROLLER, PLANT = "fmbpc_controller", "plant_simulator"
BUMPLESS = 1e-6  # of the range
REFUSED = {"setpoint": (CONTROLLER, "refused: setpoint"), "disturbance": (PLANT, "refused: disturbance")}


def switch(node, service, on):
    rospy.ServiceProxy(f"/{node}/{service}", SetBool)(on)


def trigger(loop, service):
    rospy.ServiceProxy(f"/{loop.plant}/{service}", Trigger)()


def manual(loop):
    """To 0.6 of the range; two per cent away where that is nothing for the plant or the model."""
    switch(CONTROLLER, "manual", True)
    target = [s.lower + 0.6 * (s.upper - s.lower) if loop.wide else u + 0.02 * (s.upper - s.lower)
              for s, u in zip(loop.info().inputs, loop.now().input_applied)]
    rospy.ServiceProxy(f"/{CONTROLLER}/manual_input", ManualInput)(target)
    loop.target = target
    loop.samples(3)


def automatic(_):
    switch(CONTROLLER, "manual", False)


def input_is_kept(loop):
    loop.samples(30, patience=40.0)
    applied = loop.now().input_applied
    if any(abs(a - b) > 1e-6 * max(1.0, abs(b)) for a, b in zip(applied, loop.target)):
        return f"the manual input was forgotten: {list(applied)} for {loop.target}"
    return None


def in_control(state):
    """The law has the inputs; where manual left the plant its model may have no data, which degrades it."""
    return state.summary and (state.word == "automatic" or state.word == "degraded" and state.code == "outside_model")


def bump(loop, since):
    """The first action that is not a person's any more starts from where the person left the inputs."""
    found = loop.logs["control_action"].wait(lambda a: a.source != ControlAction.MANUAL, since, 10.0)
    left = found and next((m for _, m in loop.logs["measurement"].items[::-1] if m.step == found[1].step), None)
    if not left:
        return "no action after manual"
    ranges = [s.upper - s.lower for s in loop.info().inputs]
    largest = max(abs(a - b) / r for a, b, r in zip(found[1].input, left.input_applied, ranges))
    return None if largest < BUMPLESS else f"first move after manual: {100 * largest:.3g} % of the range"


def in_manual(name, *victims):
    """Manual, then nodes die: manual again, with the same input, and back without a bump."""
    def do(loop):
        manual(loop)
        loop.kill(*victims)

    def after(loop):
        complaint = input_is_kept(loop)
        given_back = time.monotonic()
        automatic(loop)
        back = loop.logs["loop_state"].wait(in_control, given_back, 10.0)
        last = loop.summary()
        if not back:
            return complaint or f"not automatic 10 s after manual: {last and last.word}, {last and last.reason}"
        return complaint or bump(loop, given_back)
    return Fault(name, do, end="manual", touches=victims, after=after, lasts=1.0 if victims else 4.0,
                 needs=("optimizer",) if "clp_optimizer" in victims else ())


def setpoint_of(loop):
    return loop.logs["tracking"].last().setpoint


def asked(loop, **fields):
    loop.send("setpoint", loop.publishers["setpoint"].data_class(**fields))


def setpoint_then_kill(loop):
    name = loop.info().outputs[-1].name
    loop.asked = 1.002 * setpoint_of(loop)[-1]  # the model has data there
    asked(loop, name=[name], value=[loop.asked], mode=1)
    loop.samples(3)
    loop.kill(CONTROLLER)


def setpoint_is_kept(loop):
    loop.samples(3)
    kept = setpoint_of(loop)[-1]
    asked(loop, name=[loop.info().outputs[-1].name], value=[], mode=3)
    return None if abs(kept - loop.asked) < 1e-9 * abs(loop.asked) else f"the setpoint was forgotten: {kept} for {loop.asked}"


def settings(loop):
    return dynamic_reconfigure.client.Client(CONTROLLER, timeout=10.0)


def settings_then_kill(loop):
    client = settings(loop)
    loop.before = client.get_configuration(timeout=10.0)
    key = next(k for k in ("coincidence_steps", "horizon_steps") if k in loop.before)
    loop.setting = (key, loop.before[key] + 2)
    client.update_configuration({key: loop.setting[1]})
    loop.samples(3)
    loop.kill(CONTROLLER)


def settings_are_kept(loop):
    client = settings(loop)
    value = client.get_configuration(timeout=10.0)[loop.setting[0]]
    client.update_configuration({loop.setting[0]: loop.before[loop.setting[0]]})
    return None if value == loop.setting[1] else f"{loop.setting[0]} was forgotten: {value}"


def hold_then_kill(loop):
    switch(CONTROLLER, "hold", True)
    loop.samples(3)
    loop.kill(CONTROLLER)


def hold_is_kept(loop):
    end = time.monotonic() + 5.0
    held = False
    while time.monotonic() < end and not held:
        held = any(p.key == "recipe" and p.value == "held" for _, a in list(loop.diagnostics.items)[-20:] for s in a.status
                   if s.name.startswith(CONTROLLER + ":") for p in s.values)
        time.sleep(0.1)
    switch(CONTROLLER, "hold", False)
    return None if held else "the hold was forgotten"


def needs(topic):
    return ("simulator",) if topic == "disturbance" else ()


def wrong(topic, what, counted=True, said=None, **fields):
    def do(loop):
        kind, now = loop.publishers[topic].data_class, dict(fields)
        if now.get("name") == "output":
            now["name"] = [loop.info().outputs[-1].name]
        if now.get("name") == "input":
            now["name"] = ["input/" + loop.info().inputs[0].name]
        loop.send(topic, kind(**now))

    def undo(loop):
        if not counted and topic == "setpoint":
            asked(loop, name=[loop.info().outputs[-1].name], value=[], mode=3)
        if said:
            loop.send(topic, loop.publishers[topic].data_class(name=["input/" + loop.info().inputs[0].name], mode=3))
    counter = REFUSED[topic] if counted is True else counted or None
    return Fault(f"person: {topic}, {what}", do, undo, said=said, counted=counter, needs=needs(topic), lasts=1.0)


def flood(topic):
    def do(loop):
        kind = loop.publishers[topic].data_class
        loop.send(topic, kind(name=["nobody"], value=[1.0], mode=1), 5000)
    node = CONTROLLER if topic == "setpoint" else PLANT
    return Fault(f"person: 5000 {topic}s at once", do, counted=(node, "commands dropped: too many"), needs=needs(topic),
                 lasts=1.0)


def huge_manual(loop):
    switch(CONTROLLER, "manual", True)
    rospy.ServiceProxy(f"/{CONTROLLER}/manual_input", ManualInput)([1e300] * len(loop.info().inputs))
    loop.samples(10)


def toggles(_):
    for on in [True, False] * 25:
        switch(CONTROLLER, "manual", on)


def pause(loop):
    switch(loop.plant, "pause", True)


def resume(loop):
    switch(loop.plant, "pause", False)


def steps(loop):
    pause(loop)
    for _ in range(5):
        trigger(loop, "step")
        time.sleep(0.2)


def joins_without_state(loop):
    """A controller in the middle of the run that nobody tells what was asked: its actions go nowhere."""
    loop.start(exchange.program(CONTROLLER), "__name:=newcomer", "operator_kept:=nobody_keeps", "base_action:=nobody_hears",
               "control_action:=nobody_hears", "predictive_action:=nobody_predicts")


FAULTS = [
    Fault("a controller joins without knowing what was asked", joins_without_state, lambda loop: loop.end_children(),
          said="/newcomer held: ", needs=("processes",), lasts=1.0, said_within=6.0),
    in_manual("manual for 30 samples and more, then automatic"),
    in_manual("manual, controller killed", CONTROLLER),
    in_manual("manual, optimizer killed", "clp_optimizer"),
    in_manual("manual, recorder killed", "loop_recorder"),
    in_manual("manual, controller and recorder killed", CONTROLLER, "loop_recorder"),
    Fault("setpoint asked, controller killed", setpoint_then_kill, touches=(CONTROLLER,), after=setpoint_is_kept, lasts=1.0),
    Fault("settings changed, controller killed", settings_then_kill, touches=(CONTROLLER,), after=settings_are_kept,
          needs=("model",), lasts=1.0),
    Fault("schedule held, controller killed", hold_then_kill, touches=(CONTROLLER,), after=hold_is_kept, lasts=1.0),
    wrong("setpoint", "NaN", name="output", value=[math.nan], mode=1),
    wrong("setpoint", "of an unknown signal", name=["nobody"], value=[1.0], mode=1),
    wrong("setpoint", "unknown mode", name="output", value=[1.0], mode=9),
    wrong("setpoint", "no value", name="output", value=[], mode=1),
    wrong("setpoint", "1e300", name="output", value=[1e300], mode=1),
    wrong("disturbance", "infinite", name="input", value=[math.inf], mode=1),
    wrong("disturbance", "input 1e300", said="was asked to be 1e\\+300, beyond its limits", counted=False, name="input", value=[1e300], mode=1),
    wrong("disturbance", "of an unknown signal", name=["nobody"], value=[1.0], mode=1),
    flood("setpoint"), flood("disturbance"),
    Fault("person: manual input of 1e300", huge_manual, automatic, said="was asked by hand to be 1e\\+300, beyond its limits",
          needs=("wide",), lasts=0.5),
    Fault("person: manual and back 25 times", toggles, lasts=0.5),
    Fault("person: plant paused and resumed", pause, resume, said="paused", lasts=3.0),
    Fault("person: five single steps", steps, resume, said="paused", lasts=0.5),
    Fault("person: plant reset", lambda loop: trigger(loop, "reset"), new_run=True, lasts=1.0),
    Fault("person: plant reset twice", lambda loop: (trigger(loop, "reset"), trigger(loop, "reset")), new_run=True, lasts=1.0),
]
