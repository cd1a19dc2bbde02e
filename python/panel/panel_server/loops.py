"""Loops on a master, seen from outside: what they publish becomes tables, trends, plans and causes of alarms."""
import collections
import math
import os
import threading
import time

import numpy
import rospy
import yaml
from dynamic_reconfigure.msg import Config, ConfigDescription
from fmbpc import msg as messages
from std_msgs.msg import String

from panel_server import predict, state, wire
from panel_server.alarms import OF_SILENCE, SILENT_PLANT
from panel_server.history import History, Journal, plain, read_csv

SILENT = 1.5      # s of wall time without a word from the plant: the loop is stale
SILENT_NODE = 0.9 # likewise of a node that the plant misses: it speaks twice a second
LATE = 20         # samples: of a run that is joined later, what nodes list already is no news
MOST_WAITING = 20000  # raw messages of a topic between two looks
MOST_FILLED = 200000  # rows of a run's earlier parts
PLAN_GRACE = 60.0 # s that plans are listened to after the last page that shows them
FAST = 100        # samples a second of wall time; of a faster loop the recorder's journal is read, not each message
FOLLOW = 0.5      # s between two readings of that journal
GLANCE = 5.0      # s between two looks at the messages of a fast loop
GLANCED = 0.3     # s that such a look lasts at most
ALL_FOR = 6.0     # s that a fast loop's messages are heard once somebody asks something of it
TRUST = "signal/model_trust"
SAMPLED = ("measurement", "tracking", "control_action", TRUST)

# Who speaks where, as in the loop file (loop.publishers); () is anyone.
SPEAKERS = {"plant_info": ("plant_simulator", "plant_gateway"), "measurement": ("plant_simulator", "plant_gateway"),
            "tracking": ("fmbpc_controller",), "base_action": ("fmbpc_controller",), "predictive_action": ("fmbpc_controller",),
            "control_action": ("clp_optimizer", "fmbpc_controller"), "input_plan": ("clp_optimizer",),
            "operator_kept": ("plant_simulator", "plant_gateway"), "fuzzy_model": ("fuzzy_identifier",)}


class Raw:
    """A topic whose messages wait, unread, until somebody looks. keep: the newest ones."""

    def __init__(self, topic, keep=MOST_WAITING):
        self.waiting = collections.deque(maxlen=keep)
        self.subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._take, tcp_nodelay=True, buff_size=2 ** 20)

    def _take(self, message):
        self.waiting.append((message._connection_header.get("callerid", ""), message._buff, time.time()))

    def drain(self):
        taken = []
        while self.waiting:
            taken.append(self.waiting.popleft())
        return taken

    def close(self):
        self.subscriber.unregister()


def read(kind, buffer):
    message = kind()
    message.deserialize(buffer)
    return message


class Loop:
    """One loop: `name` is its namespace, "/" or "/a"."""

    def __init__(self, name, history_bytes, tool=None, executor=None):
        self.name, self.history_bytes, self.tool, self.executor = name, history_bytes, tool, executor
        self.prefix = name.rstrip("/") + "/"
        self.info = self.run_id = self.history = self.errors = None
        self.text, self.speakers = {}, dict(SPEAKERS)
        self.states, self.heard_of, self.seen_events = {}, {}, {}
        self.read_lists = set()    # nodes of whose events in this run one list at least was read
        self.step, self.joined = -1, -1  # joined: the first sample heard of the run
        self.quality, self.final = (), False
        self.applied, self.action, self.source, self.action_step = (), (), 0, -1
        self.base, self.base_step = (), -1
        self.setpoint, self.reference = (), ()
        self.plan = self.planned = None
        self.prediction_law, self.guard_limits, self.prediction_step = (), None, -1
        self.model = self.trust = None
        self.kept, self.settings, self.settings_now = None, None, None
        self.trust_said = None     # by the law, of now
        self.run_end = None
        self.heard = None
        self.damaged = self.strangers = 0
        self.sent_from = 0         # the sample from which rows are new to the pages
        self.restarted = 0         # counts runs
        self.filled, self.fill_tried, self.filling = 0, -math.inf, False
        self.plan_wanted = -math.inf
        self.paced = collections.deque()  # (time, step) of the latest second
        self.journal, self.following, self.followed = None, False, 0
        self.fast_tried = self.all_until = self.glanced = self.follow_at = -math.inf
        self.glance, self.closed = {}, False
        self.lock = threading.RLock()
        self.raw = {topic: Raw(self.prefix + topic) for topic in ("plant_info", *SAMPLED, "loop_state", "operator_kept", "fuzzy_model")}
        self.on_demand = {}
        self.subscribers = [
            rospy.Subscriber(self.prefix + "fmbpc_controller/parameter_descriptions", ConfigDescription, self._on_description),
            rospy.Subscriber(self.prefix + "fmbpc_controller/parameter_updates", Config, self._on_config),
            rospy.Subscriber(self.prefix + "run_end", String, lambda m: setattr(self, "run_end", m.data))]
        self._read_text()

    def close(self):
        with self.lock:
            self.closed = True
            topics = [*self.raw.values(), *self.on_demand.values()]
            self.raw, self.on_demand, self.glance = {}, {}, {}
            journal, self.journal = self.journal, None
        for item in topics:
            item.close()
        for item in self.subscribers:
            item.unregister()
        if journal is not None:
            journal.close()

    def _on_description(self, message):
        self.settings = [(p.name, p.type, p.description) for g in message.groups for p in g.parameters]

    def _on_config(self, message):
        self.settings_now = {p.name: p.value for kind in (message.bools, message.ints, message.strs, message.doubles) for p in kind}

    # What the loop file says.

    def _read_text(self):
        try:
            self.text = yaml.safe_load(rospy.get_param(self.prefix + "loop_text")) or {}
        except Exception:  # noqa: BLE001: no master, no parameter, or no YAML: then nothing is known of limits
            self.text = {}
        for topic, names in (self.get("loop", "publishers") or {}).items():
            if topic in self.speakers and isinstance(names, list):
                self.speakers[topic] = tuple(names)
        if self.get("plant", "type") == "external" and not self.get("gateway"):
            for topic in ("plant_info", "measurement", "operator_kept"):
                self.speakers.setdefault(topic, ())
                if topic not in (self.get("loop", "publishers") or {}):
                    self.speakers[topic] = ()

    def get(self, *keys):
        value = self.text
        for key in keys:
            value = value.get(key) if isinstance(value, dict) else None
        return value

    def limits(self):
        """As entered, in the order of the signals: {"input": [(lower, upper)], "move": [most], "output": [...], "setpoint": [...]}."""
        inputs, outputs, inf = self.info.inputs, self.info.outputs, math.inf
        of = state.of_limit
        return {"input": [(of(self.get("actuator", "input_lower"), s.name, s.lower), of(self.get("actuator", "input_upper"), s.name, s.upper)) for s in inputs],
                "move": [of(self.get("actuator", "move_upper"), s.name, inf) for s in inputs],
                "output": [(of(self.get("clp", "output_lower"), s.name, -inf), of(self.get("clp", "output_upper"), s.name, inf)) for s in outputs],
                "setpoint": [(of(self.get("setpoint", "lower"), s.name, s.lower), of(self.get("setpoint", "upper"), s.name, s.upper)) for s in outputs]}

    # What came.

    def _counts(self, topic, caller):
        names = self.speakers.get(topic, ())
        if not names or caller in [self.prefix + n for n in names] or caller == self.prefix + "loop_manager" or caller in names:
            return True
        self.strangers += 1
        return False

    def want_plan(self, now):
        self.plan_wanted = now
        if not self.on_demand and self.journal is None:
            # A plan costs as much as a hundred samples and is shown ten times a second: the newest ones are enough.
            keep = {"predictive_action": 2, "base_action": MOST_WAITING, "input_plan": 2}
            self.on_demand = {topic: Raw(self.prefix + topic, keep=n) for topic, n in keep.items()}

    def look(self, now):
        """Takes in what has come. now: of time.monotonic()."""
        with self.lock:
            if self.on_demand and now - self.plan_wanted > PLAN_GRACE:
                for item in self.on_demand.values():
                    item.close()
                self.on_demand, self.plan, self.planned = {}, None, None
            for topic, take in (("plant_info", self._on_info), ("measurement", self._on_measurement), ("tracking", self._on_tracking),
                                ("control_action", self._on_action), ("base_action", self._on_base), ("input_plan", self._on_plan),
                                ("predictive_action", self._on_prediction), ("fuzzy_model", self._on_model), ("operator_kept", self._on_kept),
                                (TRUST, self._on_trust), ("loop_state", self._on_state)):
                raw = self.raw.get(topic) or self.on_demand.get(topic) or self.glance.get(topic)
                for caller, buffer, wall in raw.drain() if raw else ():
                    if topic != "loop_state" and not self._counts(topic, caller):
                        continue
                    try:
                        take(buffer, wall, now, caller)
                    except Exception:  # noqa: BLE001: whatever a stranger sends must not end the panel; it is counted
                        self.damaged += 1
            self._pace(now)
            self._fill(now)

    def _on_info(self, buffer, _wall, now, _caller):
        info = read(messages.PlantInfo, buffer)
        if info.run_id == self.run_id:
            return
        if self.run_id is not None or not self.text:
            self._read_text()
        self.info, self.run_id, self.step, self.joined = info, info.run_id, -1, -1
        names = [s.name for s in info.outputs]
        columns = names + [n + "_setpoint" for n in names] + [n + "_reference" for n in names]
        columns += [s.name for s in info.inputs] + [s.name + "_base" for s in info.inputs] + [s.name + "_applied" for s in info.inputs]
        columns += [s.name for s in info.disturbances]
        self.history, self.errors = History(columns, self.history_bytes), predict.Errors(len(names))
        self.setpoint = self.reference = self.action = self.base = self.applied = ()
        self.action_step = self.base_step = self.prediction_step = -1
        self.plan = self.planned = None
        self.final, self.run_end, self.sent_from = False, None, 0
        self.seen_events, self.states, self.read_lists, self.fill_tried = {}, {}, set(), -math.inf
        self.filled = 0
        self.paced.clear()
        self.restarted += 1
        self.heard = now

    def _ours(self, run_id):
        return self.info is not None and run_id == self.run_id

    def _on_measurement(self, buffer, wall, now, _caller):
        run_id, step, outputs, disturbances, applied, final, quality, _, _ = wire.measurement(buffer)
        info = self.info
        if not self._ours(run_id) or len(outputs) != len(info.outputs) or len(disturbances) != len(info.disturbances):
            return
        if step > self.step + 10 ** 6:
            return
        values = {s.name: v for s, v in zip(info.outputs, outputs)}
        values.update({s.name: v for s, v in zip(info.disturbances, disturbances)})
        self.history.put(step, values, wall)
        self.history.put(step - 1, {s.name + "_applied": v for s, v in zip(info.inputs, applied)})  # u(k-1)
        self.errors.came(step, outputs)
        self.sent_from = min(self.sent_from, max(step - 1, 0))
        self.joined = step if self.joined < 0 else self.joined
        if step >= self.step:
            self.step, self.quality, self.final, self.applied = step, quality, final, applied
        self.heard = now

    def _on_tracking(self, buffer, *_):
        run_id, step, setpoint, reference = wire.tracking(buffer)
        if not self._ours(run_id) or len(setpoint) != len(self.info.outputs) or len(reference) != len(setpoint):
            return
        names = [s.name for s in self.info.outputs]
        self.history.put(step, {**{n + "_setpoint": v for n, v in zip(names, setpoint)}, **{n + "_reference": v for n, v in zip(names, reference)}})
        self.sent_from = min(self.sent_from, step)
        self.setpoint, self.reference = setpoint, reference

    def _on_action(self, buffer, *_):
        run_id, step, values, source = wire.action(buffer)
        if not self._ours(run_id) or len(values) != len(self.info.inputs):
            return
        self.history.put(step, {s.name: v for s, v in zip(self.info.inputs, values)})
        self.sent_from = min(self.sent_from, step)
        if step >= self.action_step:
            self.action, self.source, self.action_step = values, source, step

    def _on_trust(self, buffer, *_):
        self.trust_said = wire.signal(buffer)

    def _on_base(self, buffer, *_):
        run_id, step, values, _ = wire.action(buffer)
        if self._ours(run_id) and len(values) == len(self.info.inputs):
            self.base, self.base_step = values, step
            self.history.put(step, {s.name + "_base": v for s, v in zip(self.info.inputs, values)})
            self.sent_from = min(self.sent_from, step)

    def _on_plan(self, buffer, *_):
        plan = read(messages.InputPlan, buffer)
        if self._ours(plan.run_id):
            self.planned = {**{k: p for k, p in (self.planned or {}).items() if k >= plan.step - 3}, plan.step: plan}

    def _on_prediction(self, buffer, *_):
        action = read(messages.PredictiveAction, buffer)
        if not self._ours(action.run_id) or action.C.rows != len(self.info.outputs) or action.B.cols != len(self.info.inputs):
            return
        limits = self.limits()
        lower, upper = (numpy.array([pair[i] for pair in limits["input"]]) for i in (0, 1))
        self.prediction_law, self.prediction_step = tuple(action.input_base_unclipped), action.step
        self.guard_limits = list(zip(action.input_lower, action.input_upper)) if action.input_lower else None
        planned = (self.planned or {}).get(action.step)
        planned = planned.input if planned is not None and planned.input.data else None
        plan = predict.Plan(action, lower, upper, numpy.array(limits["move"]), planned)
        if plan.finite():
            self.plan = plan
            self.errors.add(plan)

    def _on_model(self, buffer, *_):
        self.model = read(messages.FuzzyModel, buffer)
        self.trust = predict.Trust(self.model)

    def _on_kept(self, buffer, *_):
        self.kept = read(messages.OperatorState, buffer)

    def _on_state(self, buffer, _wall, now, caller):
        message = read(messages.LoopState, buffer)
        if caller not in (message.node, self.prefix + "loop_manager"):
            self.strangers += 1
            return
        self.states[message.node] = message
        self.heard_of[message.node] = now
        if message.summary:
            self.heard = now
        if self.run_id is None or message.run_id not in (self.run_id, 0):
            return
        old = message.node not in self.read_lists and not 0 <= self.joined <= LATE
        self.read_lists.add(message.node)
        listed = {(message.node, e.code, e.signal, e.first) for e in message.events}
        self.seen_events = {k: v for k, v in self.seen_events.items() if k[0] != message.node or k in listed or now - v[2] < SILENT}
        for event in message.events:
            key = (message.node, event.code, event.signal, event.first)  # a node lists one code and signal several times, with other words
            said = (event.last, event.count)
            if self.seen_events.get(key, (None,))[0] != said:
                self.seen_events[key] = (said, event, now, old)

    # What there was before the panel came, or while it was away: the recorder's own journal.

    def _fill(self, now):
        if self.history is None or self.history.last is None or not self.info.outputs or self.filling or now - self.fill_tried < 5.0 or self.executor is None:
            return
        self.fill_tried = now
        begun = self.history.first > 0 and not self.filled
        # Not the newest samples of a run that goes on: those are on their way. Of a fast loop, not what its journal gives next.
        newest = self.followed if self.fast() else self.step if self.over() else self.step - 20
        first = 0 if begun else min((a for name in self._of_each_topic() for a, b in self.history.gaps(name) if self.filled < a and (a if self.over() else b) < newest), default=None)
        if first is None:
            return
        self.filling = True
        self.executor.submit(self._fill_from, self.run_id, first * self.info.sample_time_s / 3600.0)

    def _of_each_topic(self):
        """A column of each topic of samples: what is heard of one may be missed of another."""
        outputs, inputs = [[s.name for s in signals[:1]] for signals in (self.info.outputs, self.info.inputs)]
        return outputs + [n + "_setpoint" for n in outputs] + inputs

    def _fill_from(self, run_id, since_h):
        try:
            folder = rospy.get_param(self.prefix + "loop_recorder/out", "")
            for names, table, certain in recorded(folder, self.tool, run_id, since_h):
                with self.lock:
                    if run_id == self.run_id:
                        self._take_rows(names, table, certain)
        except Exception:  # noqa: BLE001: a record of another make leaves a gap, which the trend shows
            self.damaged += 1
        finally:
            self.filling = False

    def _take_rows(self, names, table, certain):
        """certain: it is of this run; else some of its samples must be those that came over the topics."""
        steps, wanted = self._placed(names, table)
        if not len(steps):
            return
        first = self.info.outputs[0].name
        mine = numpy.array([self.history.value(int(k), first) for k in steps[-200:]])
        both = numpy.isfinite(mine)
        if not certain and not (both.any() and first in wanted and numpy.allclose(mine[both], table[-200:][both, wanted[first]], rtol=1e-4, atol=1e-9)):
            return
        keep = (steps >= 0) & (steps <= self.step)
        self.history.fill(steps[keep], list(wanted), table[keep][:, list(wanted.values())])
        self.filled = max(self.filled, int(steps[keep].max(initial=0)))
        self.restarted += 1  # the pages fetch all again

    def _placed(self, names, table):
        """Of rows as trajectory.csv has them: (steps, {column of the history: column of the table})."""
        if "time" not in names or not len(table):
            return numpy.zeros(0, int), {}
        inputs = {s.name for s in self.info.inputs}
        wanted = {(n + "_applied" if n in inputs else n[:-len("_commanded")] if n.endswith("_commanded") else n): i for i, n in enumerate(names)}
        return (numpy.rint(table[:, names.index("time")] * 3600.0 / self.info.sample_time_s).astype(int),
                {n: i for n, i in wanted.items() if n in self.history.index})

    # A loop that goes much faster than anybody can look: each message to one more listener costs it, so the samples are read from the journal that
    # its recorder writes on this machine, and a message is looked at every now and then, for what is not in there (quality, source, trust). Of such
    # a loop no plan is shown: it would be old before it is drawn.

    def fast(self):
        return self.journal is not None

    def want_all(self, now):
        """Somebody asks something of the loop: each message counts for a while."""
        self.all_until = now + ALL_FOR

    def _pace(self, now):
        self.paced.append((now, self.step))
        while now - self.paced[0][0] > 1.0:
            self.paced.popleft()
        since, step = self.paced[0]
        rate = (self.step - step) / (now - since) if now - since >= 0.5 else math.nan
        if self.following:
            return
        if self.journal is None:
            if not rate > FAST or now < self.all_until or now - self.fast_tried < 5.0 or not self.tool or self.executor is None or self.over():
                return
            self.fast_tried = now
            self.following = True
            self.executor.submit(self._follow, now, self.run_id, False)
            return
        slow = rate < 0.5 * FAST or now < self.all_until or self.over()
        if slow or now - self.follow_at >= FOLLOW:
            self.following = True
            self.executor.submit(self._follow, now, self.run_id, slow)

    def _follow(self, now, run_id, ends):
        """In a thread: nothing here may keep the others waiting."""
        try:
            self.follow_at = now
            if self.journal is None:
                self._begin_to_follow(run_id)
            if self.journal is not None:
                if not ends and now - self.glanced > GLANCE:
                    self._glance(now)
                self._take_newest(now, run_id)
            if ends:
                self._hear_all()
        except Exception:  # noqa: BLE001: no journal (any more), or of another run: the messages are heard as before
            self._hear_all()
        finally:
            self.following = False

    def _begin_to_follow(self, run_id):
        journal = Journal(self.tool, rospy.get_param(self.prefix + "loop_recorder/out"))
        with self.lock:
            fits = journal.run_id == run_id == self.run_id and not self.closed
            if fits:
                self.journal, self.followed = journal, max(self.step - 20, 0)
                topics = [self.raw.pop(t) for t in SAMPLED] + list(self.on_demand.values())
                self.on_demand, self.plan, self.planned = {}, None, None
        if not fits:
            journal.close()
            return
        for raw in topics:
            raw.close()

    def _take_newest(self, now, run_id):
        table = self.journal.rows(self.followed)
        if not len(table):
            return
        with self.lock:
            if run_id != self.run_id:
                raise ValueError("a new run")
            steps, wanted = self._placed(self.journal.names, table)
            self.history.fill(steps, list(wanted), table[:, list(wanted.values())])
            last = int(steps[-1])
            self.history.put(last, {}, time.time())
            value = lambda names: tuple(float(table[-1, wanted[n]]) if n in wanted else math.nan for n in names)  # noqa: E731
            outputs, inputs = [s.name for s in self.info.outputs], [s.name for s in self.info.inputs]
            self.sent_from, self.followed = min(self.sent_from, int(steps[0])), last + 1
            if last > self.step:
                self.step, self.heard = last, now
                self.applied, self.action, self.action_step = value(n + "_applied" for n in inputs), value(inputs), last
                self.setpoint, self.reference = value(n + "_setpoint" for n in outputs), value(n + "_reference" for n in outputs)

    def _glance(self, now):
        """One message of each topic that says what the journal does not."""
        self.glanced = now
        topics = {topic: Raw(self.prefix + topic, keep=1) for topic in ("measurement", "control_action", *([TRUST] if self.trust_said is not None else []))}
        while not all(raw.waiting for raw in topics.values()) and time.monotonic() < now + GLANCED:
            time.sleep(0.002)
        for raw in topics.values():
            raw.close()
        with self.lock:
            self.glance = topics

    def _hear_all(self):
        with self.lock:
            journal, self.journal, self.glance = self.journal, None, {}
            missing = [] if self.closed else [t for t in SAMPLED if t not in self.raw]
        made = {t: Raw(self.prefix + t) for t in missing}
        with self.lock:
            self.raw.update(made)
        if journal is not None:
            journal.close()

    # What it is.

    def stale(self, now):
        """s since the plant was heard, if that is too long; else 0."""
        away = now - self.heard if self.heard is not None else math.inf
        return away if away > SILENT else 0.0

    def summary(self):
        return next((s for s in self.states.values() if s.summary), None)

    def current(self, now):
        """{(code, signal): (severity, text)} of what is wrong now, and nodes that are away."""
        found, severity = {}, self.severities
        for (node, code, signal, _), (_, event, came, old) in self.seen_events.items():
            here = self.states.get(node)
            fresh = not old and now - came < 0.6
            going_on = here is not None and event.count > 0 and event.last + 2 >= here.step
            if fresh or going_on:
                found[(code, signal)] = (("info", "warning", "error")[min(event.severity, 2)], event.text)
        codes = {code for code, _ in found}
        for message in self.states.values():
            if message.code and message.code not in codes and message.word not in ("finished",):
                signal = next((s for (_, code, s, _) in self.seen_events if code == message.code and s), "")  # one alarm, not one with and one without
                found[(message.code, signal)] = (severity.get(message.code, "warning"), message.reason)
        for node in self.silent_nodes(now):
            found.pop(("node_silent", ""), None)
            found[("node_silent", node)] = (severity.get("no_action" if "no_action" in codes else "node_silent", "warning"), f"no word from {node}")
        if self.heard is not None and self.stale(now) and not self.over():
            found = {key: said for key, said in found.items() if key[0] in OF_SILENCE}  # what else was said of it is old
            found[SILENT_PLANT] = ("warning", f"the plant has said nothing for {self.stale(now):.0f} s")
        return found

    def silent_nodes(self, now):
        """Nodes that the plant misses and that are not heard here either."""
        summary = self.summary()
        missing = summary.missing if summary is not None and summary.code in OF_SILENCE else ()
        return [n[len(self.prefix):] if n.startswith(self.prefix) else n for n in missing if now - self.heard_of.get(n, now) > SILENT_NODE]

    def excuse(self, seconds):
        """The panel itself stood still for so long: that says nothing of others."""
        with self.lock:
            self.heard = None if self.heard is None else self.heard + seconds
            self.heard_of = {node: t + seconds for node, t in self.heard_of.items()}

    severities = {}  # by code, of `fmbpc events`

    def over(self):
        summary = self.summary()
        return self.run_end is not None or (summary is not None and summary.word == "finished")

    def seconds(self, step=None):
        return (self.step if step is None else step) * self.info.sample_time_s if self.info else 0.0

    def overridden(self):
        """{output: value or offset} of what the operator asked."""
        asked = {}
        for setpoint in self.kept.setpoint if self.kept is not None and self.kept.run_id == self.run_id else ():
            for name, value in zip(setpoint.name, setpoint.value):
                asked[name] = (value, "offset" if setpoint.mode == 2 else "override")
        return asked

    def tables(self, now):
        """The rows of outputs, inputs and disturbances, for JSON."""
        if self.info is None or self.step < 0:
            return {"outputs": [], "inputs": [], "disturbances": []}
        limits, info = self.limits(), self.info
        codes = collections.defaultdict(set)
        for code, signal in self.current(now):
            codes[signal].add(code)
        plan = self.plan if self.plan is not None and self.plan.step >= self.step - 2 else None
        asked, outputs, inputs = self.overridden(), [], []
        steady = plan.steady_output() if plan is not None else None
        for j, s in enumerate(info.outputs):
            value = self.history.value(self.step, s.name)
            quality = self.quality[j] if j < len(self.quality) else 0
            low, high = limits["output"][j]
            word, reason = state.output_status(s, value, quality, codes[s.name], low, high, "setpoint_clamped" in codes[s.name])
            working = self.setpoint[j] if j < len(self.setpoint) else None
            outputs.append({"name": s.name, "unit": s.unit, "value": finite(value), "quality": state.QUALITY[min(quality, 3)],
                            "setpoint": finite(asked[s.name][0]) if asked.get(s.name, ("", ""))[1] == "override" else finite(working),
                            "offset": finite(asked[s.name][0]) if asked.get(s.name, ("", ""))[1] == "offset" else None,
                            "by_hand": s.name in asked, "working": finite(working),
                            "reference": finite(self.reference[j]) if j < len(self.reference) else None,
                            "lower": finite(low), "upper": finite(high), "range": [finite(s.lower), finite(s.upper)],
                            "setpoint_limits": [finite(v) for v in limits["setpoint"][j]],
                            "predicted": finite(plan.output[self.horizon(plan) - 1, j]) if plan is not None else None,
                            "predicted_in": self.horizon(plan) if plan is not None else None,
                            "steady": finite(steady[j]) if steady is not None else None, "status": word, "reason": reason})
        why = state.first_limit(plan, info.outputs, info.inputs, limits) if plan is not None else None
        manual = self.kept is not None and self.kept.run_id == self.run_id and self.kept.manual
        for j, s in enumerate(info.inputs):
            value = self.action[j] if j < len(self.action) else math.nan
            before = self.history.value(self.action_step - 1, s.name)
            low, high = limits["input"][j]
            law = self.prediction_law[j] if self.prediction_step == self.action_step and j < len(self.prediction_law) else None
            guard = self.guard_limits[j] if self.guard_limits and j < len(self.guard_limits) else None
            word, reason, active = state.input_status(s, value, before, self.source, law, low, high, limits["move"][j], guard, codes[s.name] | codes[""] & {"input_stuck"},
                                                      why[1] if why else "")
            inputs.append({"name": s.name, "unit": s.unit, "value": finite(value), "applied": finite(self.applied[j]) if j < len(self.applied) else None,
                           "law": finite(law), "lower": finite(low), "upper": finite(high), "move": finite(limits["move"][j]),
                           "active_lower": finite(max(low, guard[0])) if guard else finite(low), "active_upper": finite(min(high, guard[1])) if guard else finite(high),
                           "active": active, "target": "manual" if manual else "auto",
                           "actual": state.SOURCES.get(self.source, "?"), "status": word, "reason": reason})
        rows = []
        for j, s in enumerate(info.disturbances):
            value, quality = self.history.value(self.step, s.name), self.quality[len(info.outputs) + j] if len(info.outputs) + j < len(self.quality) else 0
            word, reason = state.output_status(s, value, quality, codes[s.name], -math.inf, math.inf)
            rows.append({"name": s.name, "unit": s.unit, "value": finite(value), "quality": state.QUALITY[min(quality, 3)],
                         "range": [finite(s.lower), finite(s.upper)], "status": word, "reason": reason})
        return {"outputs": outputs, "inputs": inputs, "disturbances": rows, "why": why[1] if why else ""}

    def horizon(self, plan):
        """Samples ahead at which the law wants to meet its reference; the whole plan where it says nothing of that."""
        steps = (self.settings_now or {}).get("coincidence_steps") or self.get("controller", "coincidence_steps")
        return min(int(steps), len(plan.output)) if isinstance(steps, (int, float)) and steps >= 1 else len(plan.output)

    def ahead(self):
        """The plan for JSON, None if there is none or it is old."""
        plan = self.plan
        if plan is None or plan.step < self.step - 2 or self.info is None:
            return None
        n = len(plan.output)
        band, trust = self.errors.rms(n), None
        if self.trust is not None and self.trust.known():
            values = {s.name: plan.output[:, j] for j, s in enumerate(self.info.outputs)}
            values.update({s.name: plan.input[:, j] for j, s in enumerate(self.info.inputs)})
            values.update({s.name: numpy.full(n, self.history.value(self.step, s.name)) for s in self.info.disturbances})
            points = numpy.column_stack([values.get(name, numpy.full(n, numpy.nan)) for name in self.trust.names])
            missing = [i for i, name in enumerate(self.trust.names) if name not in values]
            points[:, missing] = self.trust.centres[:, missing].mean(axis=0) if missing and len(self.trust.centres) else points[:, missing]
            trust = [round(float(t), 3) for t in self.trust.of(points)]
        return {"step": plan.step, "n": n, "constrained": plan.constrained, "trust": trust,
                "outputs": [plain(plan.output[:, j], 6) for j in range(plan.output.shape[1])],
                "base_outputs": [plain(plan.base_output[:, j], 6) for j in range(plan.output.shape[1])],
                "band": None if band is None else [plain(2.0 * band[:, j], 4) for j in range(band.shape[1])],
                "inputs": [plain(plan.input[:, j], 6) for j in range(plan.input.shape[1])],
                "base_inputs": [plain(plan.base_input[:, j], 6) for j in range(plan.input.shape[1])],
                "reference": [plain(plan.reference[j], 6) for j in range(len(plan.reference))]}

    def model_view(self):
        """Rules and where the process is among them, gains and poles here, errors of predictions; for JSON."""
        if self.model is None or self.info is None:
            return None

        def value(name, lag):
            step = self.step - lag
            found = self.history.value(step, name)
            return self.history.value(step - 1, name) if math.isnan(found) and lag == 0 else found

        plan = self.plan
        gains = plan.gains() if plan is not None else None
        units = {s.name: s.unit for s in list(self.info.outputs) + list(self.info.inputs) + list(self.info.disturbances)}
        return {"name": self.model.name, "source": self.model.source, "sample_time_s": self.model.sample_time_s, "units": units,
                "rules": predict.rules_of(self.model, value),
                "signals": [{"name": s.name, "unit": s.unit, "lower": finite(s.lower), "upper": finite(s.upper), "value": finite(self.history.value(self.step, s.name))}
                            for s in list(self.model.outputs) + list(self.model.inputs) + list(self.model.disturbances)],
                "trust_known": self.trust.known(), "trust_here": self._trust_here(),
                "poles": [] if plan is None else [[round(float(p.real), 6), round(float(p.imag), 6)] for p in plan.poles()],
                "gains": None if gains is None else [plain(row, 5) for row in gains],
                "outputs": [s.name for s in self.info.outputs], "inputs": [s.name for s in self.info.inputs],
                "rms": rms_table(self.errors, plan)}

    def _trust_here(self):
        if self.trust is None or not self.trust.known():
            return None
        point = [self.history.value(self.step, name) for name in self.trust.names]
        return None if any(math.isnan(v) for v in point) else round(float(self.trust.of([point])[0]), 3)


def rms_table(errors, plan):
    if errors is None or plan is None:
        return []
    band = errors.rms(len(plan.output))
    return [] if band is None else [{"ahead": a, "rms": plain(band[a - 1], 4)} for a in (1, 2, 5, 10, 20, 40) if a <= len(band)]


def finite(value):
    return float(f"{float(value):.9g}") if value is not None and math.isfinite(value) else None


def recorded(folder, tool, run_id=None, since_h=0.0):
    """(names, table, of this run for certain) of what the recorder of a loop has on disk: the parts of a run that are filed already, of those the ones that end after since_h
    of the run, then the run that goes on or has ended; nothing if that is elsewhere."""
    if not folder or not os.path.isdir(folder):
        return
    history = os.path.join(folder, "history")
    if run_id is not None and os.path.isdir(history):
        parts = [p for p in os.listdir(history) if p == str(run_id) or p.startswith(f"{run_id}-")]
        parts.sort(key=lambda p: int(p.rsplit("-", 1)[1]) if "-" in p and p.rsplit("-", 1)[1].isdigit() else 0)
        found, rows = [], 0
        for part in reversed(parts):
            path = os.path.join(history, part, "trajectory.csv")
            if os.path.exists(path):
                found.insert(0, read_csv(path))
                names, _, table = found[0]
                rows += len(table)
                if rows >= MOST_FILLED or len(table) and "time" in names and table[0, names.index("time")] <= since_h:
                    break
        for names, _, table in found:
            yield names, table, True
    if tool and os.path.exists(os.path.join(folder, "journal.bin")):
        with Journal(tool, folder) as journal:
            table = journal.rows(0) if run_id in (None, journal.run_id) else ()
            while len(table):
                yield journal.names, table, True
                table = journal.rows(journal.last + 1)
    path = os.path.join(folder, "trajectory.csv")
    if os.path.exists(path):
        names, _, table = read_csv(path)
        yield names, table, False
