"""What people may ask, by role, and how it is asked of a loop: the topics and services that `fmbpc set`, `manual` and the others use."""
import threading
import time

import actionlib
import rospy
from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter, IntParameter, StrParameter
from dynamic_reconfigure.srv import Reconfigure
from fmbpc.msg import CommandEffect, Disturbance, IdentifyModelAction, IdentifyModelGoal, Setpoint
from fmbpc.srv import ManualInput
from std_srvs.srv import SetBool, Trigger

from panel_server.asked import MOST_NAMES, VERBS, Refused, flag, mark_of, numbers, parse_number

OVERRIDE, OFFSET, RELEASE = 1, 2, 3
PATIENCE = 5.0        # s of wall time, and two samples of a loop that goes by a clock
LOST = 3              # samples after which a command is said again


class Desk:
    """Asks things of one loop. Its publishers are made once, so that a command finds its listener."""

    number = 0

    def __init__(self, loop):
        self.loop, self.effects, self.arrived = loop, {}, threading.Condition()
        prefix = loop.prefix
        self.setpoint = rospy.Publisher(prefix + "setpoint", Setpoint, queue_size=20)
        self.disturbance = rospy.Publisher(prefix + "disturbance", Disturbance, queue_size=20)
        self.listeners = [rospy.Subscriber(prefix + "setpoint_effect", CommandEffect, self._effect, tcp_nodelay=True),
                          rospy.Subscriber(prefix + "disturbance_effect", CommandEffect, self._effect, tcp_nodelay=True)]
        self.identify_client = None

    def close(self):
        for item in self.listeners + [self.setpoint, self.disturbance]:
            item.unregister()
        if self.identify_client is not None:
            self.identify_client.action_client.stop()

    def _effect(self, message):
        with self.arrived:
            self.effects[(message.asked.secs, message.asked.nsecs)] = message
            while len(self.effects) > 200:
                self.effects.pop(next(iter(self.effects)))
            self.arrived.notify_all()

    def patience(self):
        loop = self.loop
        by_clock = loop.get("loop", "pace") != "lockstep"
        speedup = float(loop.get("loop", "speedup") or 1.0)
        return PATIENCE + (2.0 * loop.info.sample_time_s / speedup if by_clock and loop.info else 0.0)

    def do(self, verb, arguments):
        """Blocks until it is in force; returns {"step": since, "text": words}. Raises Refused."""
        loop = self.loop
        if loop.info is None:
            raise Refused("the loop has not introduced itself yet")
        act = getattr(self, "_" + verb, None)
        if act is None or verb not in VERBS:
            raise Refused(f"unknown: {verb}")
        loop.want_all(time.monotonic())
        self._wait(lambda: loop.journal is None, 2.0)
        return act(arguments)

    # Topics.

    def _ask(self, publisher, kind, names, values, mode):
        if publisher.get_num_connections() == 0:
            self._wait(lambda: publisher.get_num_connections() > 0, 3.0)
        if publisher.get_num_connections() == 0:
            raise Refused("nobody takes it: the node is away")
        Desk.number += 1
        message = kind(name=list(names), value=[float(v) for v in values], mode=mode)
        # Before every sample, so that it acts as soon as it can, and no two alike.
        message.header.stamp.secs, message.header.stamp.nsecs = 0, 1 + (time.time_ns() + Desk.number) % 999_000_000
        key = (0, message.header.stamp.nsecs)
        end, sent = time.monotonic() + self.patience(), None
        while True:
            step = self.loop.step
            if sent is None or step >= sent + LOST or step < sent:
                publisher.publish(message)
                sent = step
            with self.arrived:
                self.arrived.wait_for(lambda: key in self.effects, 0.2)
                effect = self.effects.pop(key, None)
            if effect is not None:
                break
            if self.loop.final:
                raise Refused("the run is over")
            if time.monotonic() > end:
                raise Refused(f"no sample within {self.patience():.0f} s; it acts at the next one")
        if effect.refused:
            raise Refused(effect.refused)
        return effect.step

    def _wait(self, condition, seconds):
        end = time.monotonic() + seconds
        while not condition() and time.monotonic() < end:
            time.sleep(0.02)
        return condition()

    def _command(self, publisher, kind, what, arguments):
        values, offset = numbers(arguments), arguments.get("offset") is True
        step = self._ask(publisher, kind, values.keys(), values.values(), OFFSET if offset else OVERRIDE)
        words = ", ".join(f"{name}: {what} {'+' if offset and v >= 0 else ''}{v:.9g}" for name, v in values.items())
        return {"step": step, "text": words + self.since(step)}

    def since(self, step):
        return f" since sample {step} ({self.loop.seconds(step) / 3600.0:.4g} h)"

    def _set(self, arguments):
        return self._command(self.setpoint, Setpoint, "setpoint", arguments)

    def _disturb(self, arguments):
        return self._command(self.disturbance, Disturbance, "disturbance", arguments)

    def _release(self, arguments):
        names = arguments.get("names", [])
        if not isinstance(names, list) or len(names) > MOST_NAMES or not all(isinstance(n, str) for n in names):
            raise Refused("names: expected a list of names")
        outputs = {s.name for s in self.loop.info.outputs}
        setpoints, disturbances = [n for n in names if n in outputs], [n for n in names if n not in outputs]
        step = None
        if setpoints or not names:
            step = self._ask(self.setpoint, Setpoint, setpoints, [], RELEASE)
        if disturbances or (not names and self.disturbance.get_num_connections()):
            step = self._ask(self.disturbance, Disturbance, disturbances, [], RELEASE)
        return {"step": step, "text": (", ".join(names) or "everything") + " released" + self.since(step)}

    # Services.

    def _call(self, name, kind, **request):
        full = self.loop.prefix + name
        try:
            rospy.wait_for_service(full, timeout=2.0)
            answer = rospy.ServiceProxy(full, kind)(**request)
        except (rospy.ROSException, rospy.ServiceException, TypeError) as error:
            raise Refused(f"{name} does not answer: {error}") from None
        if hasattr(answer, "success") and not answer.success:
            raise Refused(answer.message or f"{name} refused it")
        return answer

    def _in_force(self, manual):
        before = max(self.loop.step, self.loop.action_step)
        if not self._wait(lambda: self.loop.action_step > before and (self.loop.source == 5) == manual, self.patience()):
            raise Refused(f"asked, but no action says so within {self.patience():.0f} s")
        return self.loop.action_step

    def _manual(self, _):
        self._call("fmbpc_controller/manual", SetBool, data=True)
        step = self._in_force(True)
        return {"step": step, "text": "manual" + self.since(step)}

    def _auto(self, _):
        self._call("fmbpc_controller/manual", SetBool, data=False)
        step = self._in_force(False)
        return {"step": step, "text": "auto" + self.since(step)}

    def _input(self, arguments):
        """Inputs that are not named stay where they are."""
        values, names = numbers(arguments), [s.name for s in self.loop.info.inputs]
        unknown = sorted(set(values) - set(names))
        if unknown:
            raise Refused(f"input '{unknown[0]}': expected one of {', '.join(names)}")
        if self.loop.source != 5:
            raise Refused("the loop is not in manual")
        now = list(self.loop.action or self.loop.applied)
        if len(now) != len(names):
            raise Refused("no action has come yet")
        for name, value in values.items():
            now[names.index(name)] = value
        answer = self._call("fmbpc_controller/manual_input", ManualInput, input=now)
        step = self._in_force(True)
        words = ", ".join(f"{name}: {self.loop.action[names.index(name)]:.9g} by hand" for name in values)
        return {"step": step, "text": words + self.since(step) + (f"; {answer.message}" if answer.message else "")}

    def _hold(self, arguments):
        on = flag(arguments, "on")
        answer = self._call("fmbpc_controller/hold", SetBool, data=on)
        return {"step": self.loop.step + 1, "text": answer.message + self.since(self.loop.step + 1)}

    def _adapt(self, arguments):
        answer = self._call("fmbpc_controller/adapt", SetBool, data=flag(arguments, "on"))
        return {"step": self.loop.step + 1, "text": answer.message + self.since(self.loop.step + 1)}

    def _pause(self, arguments):
        answer = self._call("plant_simulator/pause", SetBool, data=flag(arguments, "on"))
        return {"step": self.loop.step, "text": answer.message or "asked of the plant"}

    def _step(self, _):
        answer = self._call("plant_simulator/step", Trigger)
        return {"step": self.loop.step, "text": answer.message or "one sample"}

    def _reset(self, _):
        answer = self._call("plant_simulator/reset", Trigger)
        return {"step": 0, "text": answer.message or "the plant begins anew"}

    def _setting(self, arguments):
        key, text = arguments.get("key"), arguments.get("value")
        kind = next((k for name, k, _ in self.loop.settings or [] if name == key), None)
        if kind is None:
            raise Refused(f"setting '{key}': expected one of {', '.join(n for n, _, _ in self.loop.settings or []) or 'none: this law has no settings'}")
        config = Config()
        try:
            if kind == "str":
                if not isinstance(text, str) or len(text) > 500:
                    raise Refused(f"{key}: expected a text")
                config.strs = [StrParameter(key, text)]
            elif kind == "bool":
                config.bools = [BoolParameter(key, {"true": True, "false": False}[str(text).lower()])]
            elif kind == "int":
                value = parse_number(text, mark_of(arguments))
                if value != int(value) or abs(value) > 2 ** 31 - 1:
                    raise Refused(f"{key}: expected an integer")
                config.ints = [IntParameter(key, int(value))]
            else:
                config.doubles = [DoubleParameter(key, parse_number(text, mark_of(arguments)))]
        except KeyError:
            raise Refused(f"{key}: expected true or false") from None
        # A law says why it refuses on loop_state; here: what is in force afterwards.
        answer = self._call("fmbpc_controller/set_parameters", Reconfigure, config=config)
        asked = next(p.value for group in (config.strs, config.bools, config.ints, config.doubles) for p in group)
        now = {p.name: p.value for group in (answer.config.strs, answer.config.bools, answer.config.ints, answer.config.doubles) for p in group}.get(key)
        if kind != "str" and now != asked:
            raise Refused(f"{key} stays {now}: {self.why()}")
        if kind == "str" and self._wait(lambda: self._said_refused(), 0.8):
            raise Refused(f"{key} stays {now}: {self.why()}")
        return {"step": self.loop.step + 1, "text": f"{key} = {now}" + self.since(self.loop.step + 1)}

    def _said_refused(self):
        state = self.loop.states.get(self.loop.prefix + "fmbpc_controller")
        return state is not None and state.code == "command_refused" and "settings" in state.reason

    def why(self):
        state = self.loop.states.get(self.loop.prefix + "fmbpc_controller")
        return state.reason if state is not None and state.code == "command_refused" else "the law refuses it"

    def _identify(self, arguments):
        """From the newest samples; with `use` the model comes into force."""
        window = arguments.get("window", 0)
        if not isinstance(window, int) or isinstance(window, bool) or not 0 <= window <= 10 ** 7:
            raise Refused("window: expected samples >= 0")
        use = flag(arguments, "use")
        if self.identify_client is None:
            self.identify_client = actionlib.SimpleActionClient(self.loop.prefix + "fuzzy_identifier/identify", IdentifyModelAction)
        done = threading.Event()
        if not self._wait(lambda: self.identify_client.action_client.pub_goal.get_num_connections() > 0, 3.0):
            raise Refused("fuzzy_identifier does not answer")
        self.identify_client.send_goal(IdentifyModelGoal(window=window, publish=use), done_cb=lambda *_: done.set())
        if not done.wait(300.0):
            raise Refused("no result within 300 s")
        result = self.identify_client.get_result()
        if result is None or not result.ok:
            raise Refused(result.message if result is not None else "the identification gave no result")
        figures = "; ".join(f"{o}: one step {a:.4g} %, free run {b:.4g} %" for o, a, b in zip(result.outputs, result.one_step_vaf, result.free_run_vaf))
        return {"step": self.loop.step + 1, "text": f"{result.model} of {result.rows} rows {'in force' if use else '(not in force)'}: {figures}",
                "remarks": list(result.remarks), "held_out": result.held_out}
