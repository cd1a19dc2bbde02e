#!/usr/bin/python3
"""Faults of a running loop: each is said within two seconds with the name of who is missing, limits hold at every
sample, and the loop comes back without a bump."""
import sys
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from fmbpc.msg import ControlAction, LoopState, Measurement, PlantInfo

import exchange

SOON = 2.0  # s of wall time
LOWER, UPPER, MOVE = 0.0, 1600.0, 40.0


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.states = exchange.Listener("loop_state", LoopState, "/plant_simulator", "/fmbpc_controller")
        cls.measurements = exchange.Listener("measurement", Measurement)
        cls.plant, cls.controller = exchange.NodeStatus("plant_simulator"), exchange.NodeStatus("fmbpc_controller")

    def setUp(self):
        self.wait_for_summary(LoopState.AUTOMATIC)
        self.measurements.clear()

    def tearDown(self):
        """Whatever happened: all limits were kept at every sample, and none was lost."""
        seen = {m.step: m.input_applied[0] for m in self.measurements.messages}
        steps = sorted(seen)
        self.assertEqual(list(range(steps[0], steps[-1] + 1)), steps)
        for before, after in zip(steps, steps[1:]):
            self.assertLessEqual(abs(seen[after] - seen[before]), MOVE + 1e-9, after)
            self.assertTrue(LOWER <= seen[after] <= UPPER)

    def wait_for_summary(self, mode, code=None, missing=None, patience=exchange.PATIENCE):
        self.states.clear()
        return self.states.wait(lambda s: s.summary and s.mode == mode and code in (None, s.code) and
                                (missing is None or missing in s.missing), patience)

    def steps_on(self, count):
        now = self.measurements.messages[-1].step if self.measurements.messages else 0
        return self.measurements.wait(lambda m: m.step >= now + count)

    def test_a_lost_optimizer_is_said_and_the_base_action_goes_to_the_plant(self):
        with exchange.Frozen("/clp_optimizer") as fault:
            self.states.clear()
            said = self.states.wait(lambda s: s.node == "/fmbpc_controller" and s.mode in
                                    (LoopState.DEGRADED, LoopState.STALLED) and "/clp_optimizer" in s.missing)
            self.assertLess(time.monotonic() - fault.since, SOON, said.reason)
            self.controller.wait(lambda s: s.level != DiagnosticStatus.OK and "/clp_optimizer" in s.message)
            self.wait_for_summary(LoopState.DEGRADED, missing="/clp_optimizer")
            self.steps_on(10)
        self.wait_for_summary(LoopState.AUTOMATIC)
        self.assertGreater(self.controller.counts()["samples without the optimizer"], 5)

    def test_a_lost_controller_is_said_the_input_is_held_and_then_the_fallback(self):
        with exchange.Frozen("/fmbpc_controller") as fault:
            said = self.wait_for_summary(LoopState.STALLED, "no_action", "/fmbpc_controller")
            self.assertLess(time.monotonic() - fault.since, SOON, said.reason)
            self.wait_for_summary(LoopState.HELD, "no_action")
            self.wait_for_summary(LoopState.FALLBACK, "no_action", "/fmbpc_controller")
            self.plant.wait(lambda s: s.level == DiagnosticStatus.ERROR and "fallback" in s.message)
            self.measurements.wait(lambda m: m.input_applied[0] == 300.0)
        self.wait_for_summary(LoopState.AUTOMATIC)
        self.steps_on(5)

    def test_a_lost_recorder_is_said_and_the_loop_goes_on(self):
        with exchange.Frozen("/loop_recorder") as fault:
            # Degraded by its silence, or stalled by the sample that it did not record: whichever is seen first.
            self.states.clear()
            said = self.states.wait(lambda s: s.summary and s.mode in (LoopState.DEGRADED, LoopState.STALLED) and "/loop_recorder" in s.missing)
            self.assertLess(time.monotonic() - fault.since, SOON, said.reason)
            self.wait_for_summary(LoopState.DEGRADED, missing="/loop_recorder")
            self.steps_on(10)
        self.wait_for_summary(LoopState.AUTOMATIC)

    def test_a_stranger_is_refused_counted_and_named(self):
        now = self.measurements.wait()
        info = exchange.Listener("plant_info", PlantInfo).wait()
        forged = {"measurement": exchange.publisher("measurement", Measurement, "/fmbpc_controller"),
                  "plant_info": exchange.publisher("plant_info", PlantInfo, "/fmbpc_controller"),
                  "control_action": exchange.publisher("control_action", ControlAction, "/plant_simulator")}
        for step, final in ((now.step + 1, False), (4000000000, False), (now.step + 2, True)):
            forged["measurement"].publish(Measurement(run_id=now.run_id, step=step, outputs=[1.0, 1.0], final=final,
                                                      disturbances=now.disturbances, input_applied=[900.0]))
        info.run_id = 2 ** 63
        forged["plant_info"].publish(info)
        for ahead in range(20):
            forged["control_action"].publish(ControlAction(run_id=now.run_id, step=now.step + ahead, input=[1600.0],
                                                           source=ControlAction.BASE))
        for status, topic in ((self.controller, "measurement"), (self.controller, "plant_info"),
                              (self.plant, "control_action")):
            status.wait(lambda s, t=topic: int(exchange.values(s).get(f"refused: {t} from {rospy.get_name()}", 0)) > 0)
        self.steps_on(10)
        self.wait_for_summary(LoopState.AUTOMATIC)


if __name__ == "__main__":
    rospy.init_node("faults")
    rostest.rosrun("fmbpc", "faults", Faults, sys.argv)
