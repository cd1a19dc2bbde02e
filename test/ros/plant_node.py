#!/usr/bin/python3
"""plant_simulator against a controller that does everything wrong. Each test starts with sample 0 of a new run of 10
samples in lockstep."""
import math
import sys
import time
import unittest

import rosgraph
import rospy
import rostest
from fmbpc.msg import (CommandEffect, ControlAction, Disturbance, LoopState, Measurement, NodeReady, PlantInfo, PlantState,
                       Signal)
from rosgraph_msgs.msg import Clock, Log
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

import exchange


class PlantNode(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.measurements = exchange.Listener("measurement", Measurement)
        cls.states = exchange.Listener("plant_state", PlantState)
        cls.infos = exchange.Listener("plant_info", PlantInfo)
        cls.status = exchange.NodeStatus("plant_simulator")
        cls.log = exchange.Listener("/rosout", Log, "/plant_simulator")
        cls.pub = exchange.publisher("control_action", ControlAction, "/plant_simulator")
        cls.pause = rospy.ServiceProxy("plant_simulator/pause", SetBool)
        cls.step = rospy.ServiceProxy("plant_simulator/step", Trigger)
        cls.reset = rospy.ServiceProxy("plant_simulator/reset", Trigger)
        cls.reset.wait_for_service(exchange.PATIENCE)
        assert not cls.reset().success  # the first run has not begun
        cls.status.wait(lambda s: s.message == "waiting for /plant_node")
        assert cls.measurements.messages == []
        ready = rospy.Publisher("ready", NodeReady, queue_size=1, latch=True)
        absent = rosgraph.Master("/absent")  # listens, as the master knows, and never connects
        where = (rospy.resolve_name("plant_state"), "fmbpc/PlantState", "http://127.0.0.1:9/")
        absent.registerSubscriber(*where)
        begun = time.monotonic()
        ready.publish(node=rospy.get_name())
        cls.now = cls.measurements.wait()
        cls.held_back_s = time.monotonic() - begun
        absent.unregisterSubscriber(where[0], where[2])

    def setUp(self):
        before = self.now.run_id
        self.assertTrue(self.pause(False).success)
        self.assertTrue(self.reset().success)
        self.now = type(self).now = self.measurements.wait(lambda m: m.run_id > before)

    def action(self, value=600.0, **fields):
        values = {"run_id": self.now.run_id, "step": self.now.step, "input": [value], "source": ControlAction.BASE}
        return ControlAction(**{**values, **fields})

    def advance(self, value=600.0):
        self.pub.publish(self.action(value))
        return self.next()

    def next(self):
        self.now = self.measurements.wait(lambda m: (m.run_id, m.step) == (self.now.run_id, self.now.step + 1))
        return self.now

    def state(self):
        return self.states.wait(lambda s: (s.run_id, s.step) == (self.now.run_id, self.now.step))

    def test_the_first_sample_waits_a_second_for_who_listens(self):
        """A recorder that was ready long before this plant came back may connect only now."""
        self.assertGreater(self.held_back_s, 0.9)

    def test_sample_0_is_what_the_loop_file_says(self):
        info = self.infos.wait(lambda m: m.run_id == self.now.run_id)
        self.assertEqual((0, 720.0), (info.step, info.sample_time_s))
        self.assertEqual(["s", "x"], [o.name for o in info.outputs])
        self.assertEqual(["q_r"], [i.name for i in info.inputs])
        self.assertEqual(["q_i", "s_i"], [d.name for d in info.disturbances])
        self.assertEqual(rospy.Time(1), info.header.stamp)
        self.assertEqual(rospy.Time(1), self.now.header.stamp)
        self.assertEqual(info.frame_id, self.now.header.frame_id)
        self.assertEqual(((200.0, 2000.0), (570.0,), 0, False),
                         (self.now.outputs, self.now.input_applied, self.now.step, self.now.final))

    def test_an_unanswered_sample_is_sent_again(self):
        self.measurements.clear()
        first = self.measurements.wait()
        self.measurements.wait(lambda m: m is not first)
        self.assertEqual({0}, {m.step for m in self.measurements.messages})
        self.assertGreater(self.status.counts()["measurements sent again"], 1)

    def test_time_does_not_go_back_while_nobody_answers(self):
        """The run is introduced again to who may have missed it; who did not must not see its first second again."""
        clock = exchange.Listener("/clock", Clock)
        self.advance()
        told = len(self.infos.messages)
        exchange.wait_until(lambda: len(self.infos.messages) > told, "plant_info once more")
        self.advance()
        clock.wait(lambda m: m.clock == self.now.header.stamp)
        times = [m.clock for m in clock.messages]
        self.assertEqual(sorted(times), times)

    def test_what_does_not_answer_the_sample_is_dropped_and_counted_apart(self):
        self.advance()
        self.advance()
        before = self.status.counts()
        wrong = [self.action(input=[]), self.action(input=[1.0, 2.0]), self.action(math.nan), self.action(math.inf),
                 self.action(step=1), self.action(step=1), self.action(step=1), self.action(step=0),
                 self.action(step=3), self.action(run_id=self.now.run_id + 1), self.action(run_id=0), ControlAction()]
        for message in wrong:
            self.pub.publish(message)
        now = self.advance(700.0)
        self.assertEqual((3, (700.0,)), (now.step, now.input_applied))
        after = self.status.counts()
        for kind, count in (("wrong size", 2), ("not finite", 2), ("repeated", 3), ("old step", 1), ("later step", 1),
                            ("other run", 2)):
            key = "actions dropped: " + kind
            self.assertEqual(before[key] + count, after[key], key)
        self.assertEqual(before.get("refused: control_action", 0) + 1, after["refused: control_action"])  # no source

    def test_an_action_twice_moves_the_plant_once(self):
        action = self.action()
        self.pub.publish(action)
        self.pub.publish(action)
        self.next()
        self.pub.publish(self.action(650.0))
        self.assertEqual((650.0,), self.next().input_applied)

    def test_the_actuator_keeps_its_bounds_whatever_arrives(self):
        for asked, applied in ((1e9, 1600.0), (-5.0, 0.0), (1600.0, 1600.0)):
            self.assertEqual((applied,), self.advance(asked).input_applied)
        self.assertEqual(0, self.state().actuator_clips)
        self.advance(1601.0)
        self.assertEqual(1, self.state().actuator_clips)

    def events(self):
        return [(e.code, e.signal) for e in self.state().events]

    def test_an_input_put_beyond_its_limits_is_clamped_and_said(self):
        clamped, states = ("input_clamped", "input/q_r"), exchange.Listener("loop_state", LoopState)
        pub = exchange.publisher("disturbance", Disturbance, "/plant_simulator")
        self.log.clear()
        pub.publish(name=["input/q_r"], value=[1e300], mode=Disturbance.OVERRIDE)
        self.log.wait(lambda m: "disturbance of input/q_r from sample 1 on" in m.msg)
        self.advance()
        self.assertEqual([clamped], self.events())
        self.assertEqual((1600.0,), self.advance().input_applied)
        for _ in range(5):  # a better word than that of before comes after a second; who gets no action is stalled
            states.clear()
            self.advance()
            said = states.wait(lambda s: s.summary)
            if said.mode == LoopState.DEGRADED:
                break
        self.assertEqual((LoopState.DEGRADED, "input_clamped"), (said.mode, said.code))
        self.status.wait(lambda s: exchange.values(s)["event input_clamped of input/q_r"] == str(self.now.step))
        effects = exchange.Listener("disturbance_effect", CommandEffect)  # the log says one refusal in some seconds only
        effects.clear()  # the latest one is latched
        pub.publish(name=["input/q_r"], value=[math.inf], mode=Disturbance.OVERRIDE)
        effects.wait(lambda e: e.refused)
        self.log.clear()
        self.advance()
        self.assertEqual([clamped, ("command_refused", "")], self.events())
        pub.publish(name=["input/q_r"], value=[], mode=Disturbance.RELEASE)
        self.log.wait(lambda m: f"disturbance of input/q_r from sample {self.now.step + 1} on" in m.msg)
        self.advance()
        self.assertEqual([], self.events())

    def test_a_disturbance_without_a_stamp_acts_at_the_next_sample(self):
        effects = exchange.Listener("disturbance_effect", CommandEffect)
        pub = exchange.publisher("disturbance", Disturbance, "/plant_simulator")
        before = self.status.counts().get("refused: disturbance", 0)
        for wrong in (Disturbance(name=["q_i"], value=[1.0], mode=0), Disturbance(name=["nobody"], value=[1.0], mode=1),
                      Disturbance(name=["q_i"], value=[math.nan], mode=1),
                      Disturbance(name=["q_i", "s_i"], value=[1.0], mode=1)):
            pub.publish(wrong)
        pub.publish(name=["q_i", "input/q_r", "output/x"], value=[1900.0, 100.0, 1.0], mode=Disturbance.OVERRIDE)
        self.status.wait(lambda s: exchange.values(s).get("refused: disturbance") == str(before + 4))
        now = self.advance()
        effect = effects.wait(lambda m: not m.refused)
        self.assertEqual((1, ["q_i", "input/q_r", "output/x"]), (effect.step, effect.name))
        self.assertEqual((1900.0, 1.0), (now.disturbances[0], now.outputs[1]))
        self.assertEqual((600.0,), now.input_applied)  # the valve sticks from sample 1 on
        self.assertEqual((100.0,), self.advance().input_applied)
        self.assertGreater(self.state().outputs[1], 1000.0)  # only the sensor is wrong
        pub.publish(name=["q_i", "input/q_r", "output/x"], value=[], mode=Disturbance.RELEASE)
        self.log.wait(lambda m: "disturbance of q_i, input/q_r, output/x from sample 3 on" in m.msg)
        self.advance()
        self.assertEqual((600.0,), self.advance().input_applied)

    def test_pause_and_step(self):
        self.assertFalse(self.step().success)
        self.assertTrue(self.pause(True).success)
        accepted = self.status.counts()["actions accepted"]
        self.pub.publish(self.action())
        self.status.wait(lambda s: s.message == "paused" and exchange.values(s)["actions accepted"] == str(accepted + 1)
                    and exchange.values(s)["step"] == "0")
        self.assertTrue(self.step().success)
        self.assertEqual(1, self.next().step)
        self.assertTrue(self.step().success)  # allowed now, taken when the action comes
        self.assertEqual(2, self.advance().step)
        self.pub.publish(self.action())
        self.status.wait(lambda s: exchange.values(s)["actions accepted"] == str(accepted + 3) and exchange.values(s)["step"] == "2")
        self.assertTrue(self.pause(False).success)
        self.assertEqual(3, self.next().step)

    def test_reset_gives_the_same_run_again_under_a_larger_run_id(self):
        first = [self.advance(500.0 + 50 * k).outputs for k in range(4)]
        old = self.action()
        self.setUp()
        self.assertEqual((0, (200.0, 2000.0)), (self.now.step, self.now.outputs))
        self.infos.wait(lambda m: m.run_id == self.now.run_id)
        self.pub.publish(old)
        self.assertEqual(first, [self.advance(500.0 + 50 * k).outputs for k in range(4)])

    def test_the_final_sample_is_marked_and_nothing_follows(self):
        finals = [self.advance().final for _ in range(10)]
        self.assertEqual([False] * 9 + [True], finals)
        self.status.wait(lambda s: s.message.startswith("finished"))
        self.measurements.clear()
        again = exchange.Listener("measurement", Measurement).wait()  # latched for those who come later
        self.assertEqual((10, True), (again.step, again.final))

    def test_clock_frames_and_signals_are_there(self):
        self.assertEqual(rospy.Time(1), exchange.Listener("/clock", Clock).wait(
            lambda m: m.clock == rospy.Time(1)).clock)
        signal, held = exchange.Listener("signal/x", Signal), exchange.Listener("signal/q_r", Signal)
        frames = {t.child_frame_id: t for t in exchange.Listener("/tf_static", TFMessage).wait().transforms}
        info = self.infos.wait(lambda m: m.run_id == self.now.run_id)
        self.assertTrue(set(info.output_frames) <= set(frames) | {info.frame_id})
        now = self.advance()
        stamp = now.header.stamp
        self.assertEqual(now.outputs[1], signal.wait(lambda s: s.header.stamp == stamp).data)
        self.assertEqual(600.0, held.wait(lambda s: s.header.stamp == stamp - rospy.Duration(720)).data)


if __name__ == "__main__":
    rospy.init_node("plant_node")
    rostest.rosrun("fmbpc", "plant_node", PlantNode, sys.argv)
