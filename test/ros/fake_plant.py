#!/usr/bin/python3
"""fmbpc_controller against a plant that does everything wrong. The first sample of each test opens a new run."""
import copy
import math
import sys

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from fmbpc.msg import CommandEffect, ControlAction, FuzzyModel, LoopState, Measurement, PlantInfo, Setpoint
from fmbpc.srv import ManualInput
from rosgraph_msgs.msg import Log
from std_srvs.srv import SetBool

import exchange
from acting_plant import ActingPlant

BASE, HELD, MANUAL = ControlAction.BASE, ControlAction.HELD, ControlAction.MANUAL


class FakePlant(ActingPlant):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.refuse_a_plant_with_other_units()

    @classmethod
    def refuse_a_plant_with_other_units(cls):
        wrong = PlantInfo(name="wrong", sample_time_s=720.0, inputs=cls.info.inputs, output_frames=["", ""],
                          disturbances=cls.info.disturbances, outputs=list(cls.info.outputs)[::-1])
        cls.info_pub.publish(wrong)
        words = cls.status.wait(lambda s: s.level == DiagnosticStatus.ERROR).message
        assert words == ("plant_info: outputs are x[mg/l], s[mg/l], the loop file expects s[mg/l], x[mg/l]"), words
        cls.info_pub.publish(cls.of_another_loop())
        cls.status.wait(lambda s: s.message == "plant_info: the plant reads another loop_text than this node")
        assert "/fmbpc_controller" not in [m.node for m in cls.ready.messages]
        cls.info_pub.publish(cls.info)
        ready = cls.ready.wait(lambda m: m.node == "/fmbpc_controller")
        assert ready.loop_digest == cls.info.loop_digest != "", ready

    @classmethod
    def of_another_loop(cls):
        info = copy.deepcopy(cls.info)
        info.loop_digest = info.loop_digest[::-1]
        return info

    def steps_answered(self):
        return [a.step for a in self.actions.messages if a.run_id == self.info.run_id]

    def test_a_repeated_step_gets_the_cached_answer(self):
        first = self.answer(1)
        self.actions.clear()
        again = self.answer(1, outputs=(300.0, 1000.0))
        self.assertEqual((first.input, first.source, first.header.stamp), (again.input, again.source, again.header.stamp))
        self.assertEqual(BASE, self.answer(2).source)

    def test_a_plant_that_comes_back_with_another_loop_is_refused(self):
        other = copy.deepcopy(self.info)
        other.loop_digest = self.info.loop_digest[::-1]
        other.run_id += 500
        before = self.status.counts().get("refused: plant_info", 0)
        self.info_pub.publish(other)
        self.status.wait(lambda s: int(exchange.values(s).get("refused: plant_info", 0)) > before)
        self.answer(1)
        self.info_pub.publish(self.info)

    def test_old_steps_are_dropped_and_counted(self):
        for step in (1, 2):
            self.answer(step)
        before = self.status.counts()
        self.actions.clear()
        self.send(0)
        self.send(1)
        self.answer(3)
        self.assertEqual([3], self.steps_answered())
        self.assertEqual(before["dropped: old step"] + 2, self.status.counts()["dropped: old step"])

    def test_other_runs_are_dropped_and_counted_apart(self):
        before = self.status.counts()
        self.send(1, run_id=self.info.run_id - 1)
        self.send(1, run_id=0)
        self.send(1, run_id=self.info.run_id + 7)  # larger, but no plant has announced it
        self.answer(1)
        after = self.status.counts()
        self.assertEqual(before["dropped: run not announced"] + 3, after["dropped: run not announced"])
        self.assertEqual({self.info.run_id}, {a.run_id for a in self.actions.messages})

    def test_wrong_sizes_are_dropped_and_counted(self):
        before = self.status.counts()
        self.send(1, outputs=(200.0,))
        self.send(1, outputs=(200.0, 2000.0, 1.0))
        empty = Measurement(run_id=self.info.run_id, step=1)
        self.pub.publish(empty)
        self.assertEqual(BASE, self.answer(1).source)
        self.assertEqual(before["dropped: wrong size"] + 3, self.status.counts()["dropped: wrong size"])

    def test_a_nan_measurement_holds_the_last_applied_input_and_says_so(self):
        self.applied = [612.5]
        action = self.answer(1, outputs=(200.0, math.nan))
        self.assertEqual((HELD, (612.5,)), (action.source, action.input))
        status = self.status.wait(lambda s: s.level == DiagnosticStatus.WARN)
        self.assertIn("no number", status.message)
        self.log.wait(lambda m: m.name == "/fmbpc_controller" and "no number" in m.msg)
        action = self.answer(2, outputs=(200.0, math.inf))
        self.assertEqual((HELD, (612.5,)), (action.source, action.input))
        action = self.answer(3)
        self.assertEqual(BASE, action.source)
        self.log.wait(lambda m: "reset: data before were not finite" in m.msg)

    def test_a_gap_means_reset_and_is_reported(self):
        self.answer(1)
        before = self.status.counts()
        self.assertEqual(BASE, self.answer(5).source)
        self.log.wait(lambda m: "reset: samples 2..4 missing" in m.msg)
        self.assertEqual(before["gaps"] + 1, self.status.counts()["gaps"])

    def test_a_new_run_starts_afresh(self):
        first = [self.answer(k, outputs=(100.0 + k, 2000.0 - 20 * k)).input for k in (1, 2, 3)]
        self.new_run()
        self.log.wait(lambda m: "reset: new run" in m.msg)
        self.assertEqual(first, [self.answer(k, outputs=(100.0 + k, 2000.0 - 20 * k)).input for k in (1, 2, 3)])

    def test_the_final_sample_needs_no_action(self):
        self.answer(1)
        self.send(2, final=True)
        self.tracking.wait(lambda t: (t.run_id, t.step) == (self.info.run_id, 2))
        self.assertNotIn(2, self.steps_answered())

    def test_manual_and_back_without_a_bump(self):
        self.applied = list(self.answer(1).input)
        manual = rospy.ServiceProxy("fmbpc_controller/manual", SetBool)
        by_hand = rospy.ServiceProxy("fmbpc_controller/manual_input", ManualInput)
        self.assertFalse(by_hand([700.0]).success)  # not yet manual
        self.assertEqual("manual", manual(True).message)
        action = self.answer(2)
        self.assertEqual((MANUAL, self.applied), (action.source, list(action.input)))
        self.assertTrue(by_hand([700.0]).success)
        self.assertEqual((700.0,), self.answer(3).input)
        before = int(exchange.values(self.status.wait(lambda s: True)).get("refused: manual_input", 0))
        for refused in ([], [1.0, 2.0], [math.nan]):
            reply = by_hand(refused)
            self.assertEqual((False, True), (reply.success, "manual input" in reply.message))
        reply = by_hand([99999.0])
        self.assertTrue(reply.success)
        self.assertIn("q_r", reply.message)
        self.assertEqual((self.info.inputs[0].upper,), self.answer(4).input)
        self.assertEqual([("input_clamped", "q_r"), ("command_refused", "")], self.events(4)[:2])
        self.wait_for_state(4, lambda s: (s.mode, s.code) == (LoopState.MANUAL, "input_clamped"))
        self.status.wait(lambda s: exchange.values(s).get("refused: manual_input") == str(before + 3))
        self.assertEqual("", by_hand([650.0]).message)
        self.answer(5)
        self.assertEqual([], self.events(5))
        self.wait_for_state(5, lambda s: (s.mode, s.code) == (LoopState.MANUAL, ""))
        self.assertEqual("auto", manual(False).message)
        action = self.answer(6)
        self.assertEqual(BASE, action.source)
        self.assertAlmostEqual(650.0, action.input[0], delta=1e-6)

    def events(self, step):
        now = self.tracking.wait(lambda t: (t.run_id, t.step) == (self.info.run_id, step))
        self.assertEqual([], [e for e in now.events if (e.first, e.last, e.count) != (step, step, 1)])
        return [(e.code, e.signal) for e in now.events]

    def test_a_value_that_is_stale_or_has_not_come_is_called_so(self):
        for step, quality in enumerate((Measurement.STALE, Measurement.MISSING, Measurement.BAD), 1):
            action = self.answer(step, quality=[Measurement.GOOD, quality] + [Measurement.GOOD] * len(self.info.disturbances))
            self.assertEqual(HELD, action.source)
            self.assertEqual(("signal_missing", "x"), self.events(step)[0])
            self.wait_for_state(step, lambda s: (s.mode, s.code) == (LoopState.HELD, "signal_missing"))

    def test_a_model_that_is_refused_degrades_the_controller_for_a_while(self):
        before = self.status.counts().get("refused: fuzzy_model", 0)
        self.answer(1)
        exchange.publisher("fuzzy_model", FuzzyModel, "/fmbpc_controller").publish(FuzzyModel(name="empty"))
        self.wait_for_state(1, lambda s: (s.mode, s.code) == (LoopState.DEGRADED, "model_refused"))
        self.wait_for_state(1, lambda s: (s.mode, s.code) == (LoopState.AUTOMATIC, ""))
        self.assertEqual(before + 1, self.status.counts()["refused: fuzzy_model"])

    def test_a_setpoint_without_a_stamp_acts_at_the_next_sample(self):
        effects = exchange.Listener("setpoint_effect", CommandEffect)
        setpoint = exchange.publisher("setpoint", Setpoint, "/fmbpc_controller")
        self.answer(1)
        setpoint.publish(name=["x"], value=[1950.0], mode=Setpoint.OVERRIDE)
        self.log.wait(lambda m: "setpoint of x from sample 2 on" in m.msg)
        self.answer(2)
        now = self.tracking.wait(lambda t: (t.run_id, t.step) == (self.info.run_id, 2))
        self.assertEqual((55.0, 1950.0), now.setpoint)
        effect = effects.wait()
        self.assertEqual((2, self.info.run_id, ["x"]), (effect.step, effect.run_id, effect.name))
        before = int(exchange.values(self.status.wait(lambda s: True)).get("refused: setpoint", 0))
        for wrong in (Setpoint(name=["x"], value=[1.0], mode=0), Setpoint(name=["x"], value=[1.0], mode=4),
                      Setpoint(name=["nobody"], value=[1.0], mode=1), Setpoint(name=["x"], value=[], mode=1),
                      Setpoint(name=["x"], value=[math.nan], mode=1)):
            setpoint.publish(wrong)
        self.status.wait(lambda s: exchange.values(s).get("refused: setpoint") == str(before + 5))
        setpoint.publish(name=["x"], value=[], mode=Setpoint.RELEASE)
        self.log.wait(lambda m: "setpoint of x from sample 3 on" in m.msg)
        self.answer(3)
        now = self.tracking.wait(lambda t: (t.run_id, t.step) == (self.info.run_id, 3))
        self.assertEqual((55.0, 1800.0), now.setpoint)

    def test_a_setpoint_that_is_refused_is_answered_and_changes_nothing(self):
        effects = exchange.Listener("setpoint_effect", CommandEffect)
        setpoint = exchange.publisher("setpoint", Setpoint, "/fmbpc_controller")
        self.answer(1)
        for number, (name, value) in enumerate((("x", 20000.0), ("x", -1.0), ("nobody", 1.0)), 1):
            message = Setpoint(name=[name], value=[value], mode=Setpoint.OVERRIDE)
            message.header.stamp = rospy.Time(0, number)
            setpoint.publish(message)
            answer = effects.wait(lambda m, asked=message.header.stamp: m.asked == asked)
            self.assertEqual((1, self.info.run_id), (answer.step, answer.run_id))
            self.assertIn(name, answer.refused)
        self.answer(2)
        now = self.tracking.wait(lambda t: (t.run_id, t.step) == (self.info.run_id, 2))
        self.assertEqual((55.0, 1800.0), now.setpoint)

    def test_a_setpoint_beyond_its_limits_is_clamped_and_said(self):
        setpoint = exchange.publisher("setpoint", Setpoint, "/fmbpc_controller")
        setpoint.publish(name=["x"], value=[3000.0], mode=Setpoint.OVERRIDE)
        self.log.wait(lambda m: "setpoint of x from sample 1 on" in m.msg)
        self.answer(1)
        self.assertIn(("setpoint_clamped", "x"), self.events(1))
        self.log.wait(lambda m: m.level == Log.WARN and "setpoint_clamped" in m.msg)
        self.wait_for_state(1, lambda s: (s.mode, s.code) == (LoopState.DEGRADED, "setpoint_clamped") and
                            ("setpoint_clamped", "x", 1, 1) in [(e.code, e.signal, e.first, e.count) for e in s.events])
        self.status.wait(lambda s: exchange.values(s).get("event setpoint_clamped of x") == "1")
        setpoint.publish(name=["x"], value=[], mode=Setpoint.RELEASE)
        self.log.wait(lambda m: "setpoint of x from sample 2 on" in m.msg)
        self.answer(2)
        self.assertEqual([], self.events(2))


if __name__ == "__main__":
    rospy.init_node("fake_plant")
    rostest.rosrun("fmbpc", "fake_plant", FakePlant, sys.argv)
