#!/usr/bin/python3
"""What the panel makes of a loop's messages, without a master: every event of the list is one alarm, rows are complete, plans are rolled out,
damaged messages and strangers change nothing."""
import io
import itertools
import math
import pathlib
import random
import re
import sys
import tempfile
import types
import unittest
from unittest import mock

TOP = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "python/panel"))
try:
    import numpy
    from fmbpc import msg as messages
    from panel_server import alarms, loops, wire
except ImportError as error:  # a build without ROS
    raise unittest.SkipTest(str(error)) from error

RUN = 77
PLANT, CONTROLLER, OPTIMIZER = "/a/plant_simulator", "/a/fmbpc_controller", "/a/clp_optimizer"


def listed():
    """{code: severity} of docs/events.md."""
    rows = re.findall(r"^\| `(\w+)` \| (\w+) \|", (TOP / "docs/events.md").read_text(), re.MULTILINE)
    assert len(rows) > 40
    return dict(rows)


def packed(message):
    stream = io.BytesIO()
    message.serialize(stream)
    return stream.getvalue()


def loop():
    """/a with output y, input u, disturbance d; its topics are fed by put()."""
    with mock.patch.object(loops.rospy, "Subscriber"), mock.patch.object(loops.rospy, "get_param", side_effect=KeyError):
        made = loops.Loop("/a", 1e6)
    made.want_plan = lambda now: None
    for topic in ("predictive_action", "base_action", "input_plan"):
        with mock.patch.object(loops.rospy, "Subscriber"):
            made.on_demand[topic] = loops.Raw(topic)
    made.plan_wanted = math.inf
    info = messages.PlantInfo(run_id=RUN, name="tank", sample_time_s=60.0, outputs=[messages.SignalInfo("y", "m", 0.0, 10.0)], inputs=[messages.SignalInfo("u", "l/s", 0.0, 5.0)],
                              disturbances=[messages.SignalInfo("d", "l/s", 0.0, 9.0)])
    put(made, "plant_info", info, PLANT)
    made.look(0.0)
    return made


def put(made, topic, message, caller):
    raw = made.raw.get(topic) or made.on_demand[topic]
    raw.waiting.append((caller, message if isinstance(message, bytes) else packed(message), 1000.0))


def sample(made, k, y=1.0, u=2.0, source=1):
    put(made, "measurement", messages.Measurement(run_id=RUN, step=k, outputs=[y], disturbances=[3.0], input_applied=[u]), PLANT)
    put(made, "tracking", messages.Tracking(run_id=RUN, step=k, setpoint=[4.0], reference=[3.5]), CONTROLLER)
    put(made, "control_action", messages.ControlAction(run_id=RUN, step=k, input=[u], source=source), OPTIMIZER)


def state(made, k, node=PLANT, code="", events=(), word="automatic"):
    put(made, "loop_state", messages.LoopState(run_id=RUN, step=k, node=node, summary=node == PLANT, mode=2, word=word, code=code, reason=code, events=list(events)), node)


class Loop(unittest.TestCase):
    def test_quick_reading_is_what_ros_reads(self):
        dice = random.Random(3)
        for _ in range(300):
            numbers = lambda: [dice.choice((math.inf, -0.0, dice.uniform(-1e9, 1e9))) for _ in range(dice.randrange(4))]  # noqa: E731
            m = messages.Measurement(run_id=dice.getrandbits(64), step=dice.getrandbits(32), outputs=numbers(), disturbances=numbers(), input_applied=numbers(), final=dice.random() < 0.5,
                                     quality=bytes(dice.randrange(4) for _ in range(dice.randrange(4))), age_s=numbers(), local=dice.random() < 0.5)
            m.header.frame_id = "x" * dice.randrange(9)
            self.assertEqual((m.run_id, m.step, tuple(m.outputs), tuple(m.disturbances), tuple(m.input_applied), m.final, tuple(m.quality), tuple(m.age_s), m.local), wire.measurement(packed(m)))
            a = messages.ControlAction(run_id=m.run_id, step=m.step, input=numbers(), source=dice.randrange(8))
            self.assertEqual((a.run_id, a.step, tuple(a.input), a.source), wire.action(packed(a)))
            t = messages.Tracking(run_id=m.run_id, step=m.step, setpoint=numbers(), reference=numbers())
            self.assertEqual((t.run_id, t.step, tuple(t.setpoint), tuple(t.reference)), wire.tracking(packed(t)))

    def test_samples_become_rows_and_tables(self):
        made = loop()
        for k in range(50):
            sample(made, k, y=0.1 * k, u=5.0 if k == 49 else 1.0)
        made.look(1.0)
        self.assertEqual([], made.history.gaps("y") + made.history.gaps("u") + made.history.gaps("y_setpoint"))
        table = made.tables(1.0)
        self.assertEqual((4.9, 4.0, "good"), (round(table["outputs"][0]["value"], 4), table["outputs"][0]["working"], table["outputs"][0]["status"]))
        self.assertEqual(("limited", ["upper"]), (table["inputs"][0]["status"], table["inputs"][0]["active"]))
        self.assertEqual(3.0, table["disturbances"][0]["value"])

    def test_strangers_and_damage_change_nothing(self):
        made, dice = loop(), random.Random(5)
        for k in range(10):
            sample(made, k)
        made.look(1.0)
        before = made.tables(1.0)
        liar = messages.Measurement(run_id=RUN, step=9, outputs=[9.0], disturbances=[9.0], input_applied=[9.0])
        put(made, "measurement", liar, "/stranger")
        put(made, "control_action", messages.ControlAction(run_id=RUN, step=9, input=[9.0], source=5), "/stranger")
        put(made, "loop_state", messages.LoopState(run_id=RUN, step=9, node=PLANT, summary=True, word="finished"), "/stranger")
        for message in (messages.Measurement(run_id=RUN, step=9, outputs=[9.0, 9.0], disturbances=[9.0], input_applied=[9.0]), messages.Measurement(run_id=1, step=9, outputs=[9.0], disturbances=[9.0], input_applied=[9.0]),
                        messages.Measurement(run_id=RUN, step=2 ** 32 - 1, outputs=[9.0], disturbances=[9.0], input_applied=[9.0])):
            put(made, "measurement", message, PLANT)
        for topic in ("measurement", "tracking", "control_action", "predictive_action", "fuzzy_model", "loop_state", "operator_kept", "plant_info"):
            for _ in range(200):
                put(made, topic, bytes(dice.randrange(256) for _ in range(dice.randrange(120))), PLANT if topic in ("measurement", "plant_info", "operator_kept") else CONTROLLER)
        made.look(1.0)
        self.assertEqual(before, made.tables(1.0))
        self.assertGreater(made.strangers, 2)

    def test_the_plan_is_ahead_of_now(self):
        made = loop()
        sample(made, 0)
        matrix = lambda rows: messages.Matrix(len(rows), len(rows[0]), [v for row in rows for v in row])  # noqa: E731
        put(made, "input_plan", messages.InputPlan(run_id=RUN, step=0, input=matrix([[1.0, 2.0, 3.0]])), OPTIMIZER)
        put(made, "predictive_action", messages.PredictiveAction(run_id=RUN, step=0, state=[1.0], A=matrix([[0.5]]), B=matrix([[1.0]]), C=matrix([[1.0]]), offset_state=[0.0], offset_output=[0.0],
                                                                   K=matrix([[0.0]]), feedforward=matrix([[7.0, 7.0, 7.0]]), reference=matrix([[4.0, 4.0, 4.0]]), setpoint=[4.0],
                                                                   input_base_unclipped=[7.0], input_previous=[0.0]), CONTROLLER)
        made.look(1.0)
        ahead = made.ahead()
        self.assertEqual(([[1.0, 2.0, 3.0]], [[7.0, 7.0, 7.0]], [[1.5, 2.75, 4.375]], True), (ahead["inputs"], ahead["base_inputs"], ahead["outputs"], ahead["constrained"]))
        self.assertIn("upper limit is 5", made.tables(1.0)["why"])

    def test_a_new_run_begins_anew(self):
        made = loop()
        sample(made, 5)
        made.look(1.0)
        put(made, "plant_info", messages.PlantInfo(run_id=RUN + 1, sample_time_s=60.0, outputs=made.info.outputs, inputs=made.info.inputs), PLANT)
        made.look(1.1)
        self.assertEqual((-1, None), (made.step, made.history.first))


class FakeJournal:
    """What the recorder of a loop has on disk: y is the number of the sample."""

    names, run_id, samples, closed, gone = ["time", "y", "u_commanded", "y_setpoint"], RUN, 0, False, False

    def rows(self, first):
        if self.gone:
            raise ValueError("no journal")
        k = numpy.arange(first, self.samples, dtype=float)
        return numpy.column_stack([k / 60.0, k, 0 * k + 2.0, 0 * k + 4.0])

    def close(self):
        self.closed = True


class Now:
    """Runs at once what is for another thread."""

    @staticmethod
    def submit(act, *arguments):
        act(*arguments)


class Fast(unittest.TestCase):
    """A loop of 1,000 samples a second is read from the journal; a slow one, or one of which something is asked, is heard. No sample lacks."""

    def setUp(self):
        self.file, self.now, self.k = FakeJournal(), 100.0, 0
        self.file.closed = False
        for patch in (mock.patch.object(loops.rospy, "Subscriber"), mock.patch.object(loops.rospy, "get_param", lambda *_: ""),
                      mock.patch.object(loops, "Journal", lambda tool, folder: self.file)):
            patch.start()
            self.addCleanup(patch.stop)
        self.made = loop()
        self.made.tool, self.made.executor = "tool", Now
        self.made.fill_tried = math.inf  # a gap would be filled from the same journal

    def go(self, seconds, per_tick):
        """Ten ticks a second; each sample is in the journal, and comes as a message where it is heard."""
        for _ in range(round(10 * seconds)):
            self.now += 0.1
            for _ in range(per_tick):
                if "measurement" in self.made.raw:
                    sample(self.made, self.k, y=float(self.k))
                self.k += 1
            self.file.samples = self.k
            self.made.look(self.now)

    def whole(self):
        """Nothing lacks but what is on its way."""
        self.assertEqual([], [gap for gap in self.made.history.gaps("y") if gap[0] < self.made.step])
        self.assertEqual(0, self.made.history.first)
        self.assertEqual([float(k) for k in range(self.made.step + 1)], [self.made.history.value(k, "y") for k in range(self.made.step + 1)])

    def test_it_is_followed_and_heard_again_without_a_hole(self):
        self.go(2.0, 1)
        self.assertFalse(self.made.fast())
        self.go(4.0, 100)
        self.assertTrue(self.made.fast())
        self.assertEqual(set(), {"measurement", "tracking", "control_action", loops.TRUST} & set(self.made.raw))
        self.assertLess(self.k - self.made.step, 100 * 10 * loops.FOLLOW + 100)
        self.whole()
        self.go(3.0, 1)
        self.assertFalse(self.made.fast())
        self.assertTrue(self.file.closed)
        self.assertLessEqual({"measurement", "tracking", "control_action", loops.TRUST}, set(self.made.raw))
        self.whole()

    def test_a_message_ahead_of_the_journal_is_no_gap(self):
        """Else all that the recorder has on disk is read again after each look at the messages."""
        with mock.patch.object(loops, "recorded", return_value=[]) as read:
            self.go(4.0, 100)
            for _ in range(3):
                ahead = loops.Raw("measurement")
                ahead.waiting.append((PLANT, packed(messages.Measurement(run_id=RUN, step=self.k + 200, outputs=[self.k + 200.0], disturbances=[3.0], input_applied=[2.0])), 1000.0))
                self.made.glance, self.made.follow_at, self.made.fill_tried = {"measurement": ahead}, self.now, -math.inf
                self.go(6.0, 100)
            self.assertTrue(self.made.fast())
            read.assert_not_called()
        self.whole()

    def test_a_topic_that_is_heard_later_than_another_leaves_no_hole(self):
        """A panel that comes to a run: the connections to its nodes are not there at once; later a message of one topic is lost."""
        self.made.fill_tried = -math.inf
        patch = mock.patch.object(loops, "recorded", lambda *_: [(self.file.names, self.file.rows(0), True)])
        patch.start()
        self.addCleanup(patch.stop)
        for k in range(100, 220):
            self.now, self.file.samples = self.now + 0.1, k + 1
            put(self.made, "measurement", messages.Measurement(run_id=RUN, step=k, outputs=[float(k)], disturbances=[3.0], input_applied=[2.0]), PLANT)
            if k > 102:
                put(self.made, "tracking", messages.Tracking(run_id=RUN, step=k, setpoint=[4.0], reference=[3.5]), CONTROLLER)
            if k > 103 and k != 130:
                put(self.made, "control_action", messages.ControlAction(run_id=RUN, step=k, input=[2.0], source=1), OPTIMIZER)
            self.made.look(self.now)
            if k == 102:
                self.assertNotEqual([], self.made.history.gaps("u"))
        for column in ("y", "u", "y_setpoint"):
            self.assertEqual([], self.made.history.gaps(column), column)

    def test_a_column_that_nobody_says_is_not_looked_for_again_and_again(self):
        self.made.fill_tried = -math.inf
        with mock.patch.object(loops, "recorded", return_value=[]) as read:
            for k in range(220):
                self.now += 0.1
                put(self.made, "measurement", messages.Measurement(run_id=RUN, step=k, outputs=[float(k)], disturbances=[3.0], input_applied=[2.0]), PLANT)
                self.made.look(self.now)
            read.assert_not_called()

    def test_who_asks_something_is_answered_by_messages(self):
        self.go(4.0, 100)
        self.assertTrue(self.made.fast())
        self.made.want_all(self.now)
        self.go(1.0, 100)
        self.assertFalse(self.made.fast())
        self.go(loops.ALL_FOR + 5.0, 100)
        self.assertTrue(self.made.fast())
        self.whole()

    def test_a_journal_that_goes_away_costs_no_message(self):
        self.go(4.0, 100)
        self.file.gone = True
        self.go(1.0, 100)
        self.assertFalse(self.made.fast())
        self.assertIn("measurement", self.made.raw)
        self.assertEqual(self.k - 1, self.made.step)

    def test_the_journal_of_another_run_is_not_followed(self):
        self.file.run_id = RUN + 1
        self.go(4.0, 100)
        self.assertFalse(self.made.fast())
        self.assertTrue(self.file.closed)
        self.whole()


class Recorded(unittest.TestCase):
    def test_of_the_parts_of_a_run_only_those_that_are_wanted_are_read(self):
        with tempfile.TemporaryDirectory() as folder:
            for i, name in enumerate((f"{RUN}", *(f"{RUN}-{j}" for j in range(2, 12)), f"{RUN + 1}")):
                part = pathlib.Path(folder, "history", name)
                part.mkdir(parents=True)
                part.joinpath("trajectory.csv").write_text("time[h],y\n" + "".join(f"{10 * i + k},{10 * i + k}\n" for k in range(10)))
            for since, first in ((0.0, 0), (99.0, 90), (100.0, 100), (105.0, 100), (1e9, 100)):
                got = [float(v) for _, table, _ in loops.recorded(folder, "", RUN, since) for v in table[:, 1]]
                self.assertEqual([float(v) for v in range(first, 110)], got)


class Said(unittest.TestCase):
    """Time is 10 samples a second; loop_state comes twice a second, as from the nodes."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.now = 100.0
        journal = alarms.Journal(self.folder.name + "/journal.jsonl")
        journal.stream.close()
        journal.stream = types.SimpleNamespace(write=lambda _: None, flush=lambda: None, fileno=lambda: 1, tell=lambda: 0, close=lambda: None)
        self.fsync = mock.patch.object(alarms.os, "fsync")
        self.fsync.start()
        self.addCleanup(self.fsync.stop)
        self.list = alarms.AlarmList(journal, lambda: self.now)
        loops.Loop.severities = listed()

    def run_for(self, made, seconds, k, says):
        """says(k): (code of the node's state, events)."""
        for _ in range(int(round(10 * seconds))):
            self.now += 0.1
            k += 1
            sample(made, k)
            if k % 5 == 0:
                code, events = says(k)
                state(made, k)
                state(made, k, CONTROLLER, code, events, "degraded" if code else "automatic")
            made.look(self.now)
            self.list.look("/a", made.current(self.now), self.now, k, RUN)
        return k

    def active(self):
        return [a for a in self.list.alarms.values() if a.active and a.state != alarms.SUPPRESSED]

    def test_every_event_of_the_list_is_one_alarm_within_two_seconds_and_goes(self):
        number = {"info": 0, "warning": 1, "error": 2}
        for code, severity in listed().items():
            self.list.alarms.clear()
            made = loop()
            k = self.run_for(made, 3.0, 0, lambda k: ("", ()))
            self.assertEqual([], self.active())
            first = k + 1

            def lasting(k):
                event = messages.Event(code=code, severity=number[severity], signal="y", first=first, last=k, count=k - first + 1, text=code)
                return code, [event]
            k = self.run_for(made, 2.0, k, lasting)
            self.assertEqual(0 if severity == "info" else 1, len(self.active()), (code, severity))
            k = self.run_for(made, 4.0, k, lasting)
            gone = messages.Event(code=code, severity=number[severity], signal="y", first=first, last=k, count=k - first + 1, text=code)
            k = self.run_for(made, alarms.OFF_DELAY + 2.0, k, lambda k: ("", [gone]))
            self.assertEqual([], self.active(), code)
            self.assertEqual([1] if severity != "info" else [], [a.count for a in self.list.alarms.values()])

    def test_one_cause_in_several_words_is_one_alarm_that_goes(self):
        made = loop()
        k = self.run_for(made, 1.0, 0, lambda k: ("", ()))
        listed_thrice = [messages.Event(code="signal_missing", severity=1, signal="y", first=k + a, last=k + b, count=b - a + 1, text=text)
                         for a, b, text in ((1, 3, "y is stale: the model's value is used"), (4, 9, "y is stale: input held"), (10, 15, "y is stale: the configured fallback"))]
        k = self.run_for(made, 2.0, k, lambda k: ("signal_missing", [e for e in listed_thrice if e.first <= k]))
        self.assertEqual([("signal_missing", "y")], [(a.code, a.signal) for a in self.active()])
        self.run_for(made, alarms.OFF_DELAY + 2.0, k, lambda k: ("", listed_thrice))
        self.assertEqual([], self.active())

    def test_what_lasts_one_sample_is_not_missed_and_what_flickers_does_not_chatter(self):
        made = loop()
        k = self.run_for(made, 1.0, 0, lambda k: ("", ()))
        once = messages.Event(code="qp_not_solved", severity=1, first=k - 8, last=k - 8, count=1, text="once")
        k = self.run_for(made, 1.0, k, lambda k: ("", [once]))
        self.assertEqual(["qp_not_solved"], [a.code for a in self.active()])
        dice, count = random.Random(1), [0]

        def flickers(k):
            if dice.random() < 0.3:
                count[0] += 1
            return "", [messages.Event(code="law_failed", severity=2, first=1, last=k if dice.random() < 0.3 else max(k - 40, 1), count=1 + count[0], text="flickers")]
        self.run_for(made, 120.0, k, flickers)
        self.assertLessEqual(self.list.alarms["/a|law_failed|"].count, 2)

    def test_what_was_over_before_the_panel_came_is_no_alarm(self):
        """Whichever of a running loop's messages comes first; those of an identifier stand at its first sample."""
        over = messages.Event(code="signal_too_fast", severity=1, signal="y", first=1, last=2, count=2, text="over")
        coming = [lambda made: state(made, 0, "/a/fuzzy_identifier"), lambda made: state(made, 500, CONTROLLER, "", [over]), lambda made: sample(made, 500)]
        for order in itertools.permutations(coming):
            made = loop()
            made.heard = self.now
            for come in order:
                come(made)
                self.now += 0.1
                made.look(self.now)
                self.assertEqual({}, made.current(self.now))

    def test_a_plant_that_is_silent_is_said_in_two_seconds(self):
        made = loop()
        self.run_for(made, 2.0, 0, lambda k: ("", ()))
        self.now += 1.9
        made.look(self.now)
        self.assertEqual({("node_silent", "plant")}, set(made.current(self.now)))


if __name__ == "__main__":
    unittest.main()
