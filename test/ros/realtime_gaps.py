#!/usr/bin/python3
"""In realtime the plant does not wait: it holds the last input, then takes the fallback, and a controller that joins
late finds a run under way."""
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from fmbpc.msg import ControlAction, Measurement, PlantState
from std_srvs.srv import SetBool

import exchange


class RealtimeGaps(unittest.TestCase):
    def answer_while_the_plant_waits(self, measurements, pub, run_id):
        """An action that is in time, however slow the machine is."""
        pause, status = rospy.ServiceProxy("plant_simulator/pause", SetBool), exchange.NodeStatus("plant_simulator")
        pause(True)
        paused = int(exchange.values(status.wait(lambda s: s.message == "paused"))["step"])
        measurements.wait(lambda m: m.step == paused)
        pub.publish(ControlAction(run_id=run_id, step=paused, input=[700.0], source=1))
        status.wait(lambda s: exchange.values(s)["actions accepted"] == "1")
        pause(False)

    def test_missing_actions_mean_hold_then_fallback(self):
        measurements, states = exchange.Listener("measurement", Measurement), exchange.Listener("plant_state", PlantState)
        diagnostics = exchange.Listener("/diagnostics", DiagnosticArray, "/plant_simulator")
        pub = exchange.publisher("control_action", ControlAction, "/plant_simulator")
        exchange.begin()
        run_id = measurements.wait(lambda m: m.step == 8).run_id
        pub.publish(ControlAction(run_id=run_id, step=2, input=[700.0], source=1))  # much too late
        measurements.wait(lambda m: m.step >= 20)
        self.answer_while_the_plant_waits(measurements, pub, run_id)
        measurements.wait(lambda m: m.final)
        states.wait(lambda s: s.step == 50)
        inputs = {m.step: m.input_applied[0] for m in measurements.messages}
        missing = {s.step: s.input_missing for s in states.messages}
        self.assertEqual(list(range(51)), sorted(inputs))
        self.assertEqual([570.0] * 4 + [800.0] * 16, [inputs[k] for k in range(20)])  # u(-1), three held, fallback
        self.assertEqual([False] + [True] * 19, [missing[k] for k in range(20)])
        answered = [k for k in range(21, 51) if not missing[k]]
        self.assertTrue(answered)
        self.assertEqual({700.0}, {inputs[k] for k in answered})
        self.assertEqual(1, len(answered))
        last = answered[-1]  # then three held, then the fallback again
        self.assertEqual([700.0] * 4 + [800.0] * (47 - last), [inputs[k] for k in range(last, 51)])
        count = str(sum(missing.values()))
        diagnostics.wait(lambda m: exchange.values(exchange.diagnostics_of(m, "plant_simulator") or
                                               type("None", (), {"values": []})).get("inputs missing") == count)


if __name__ == "__main__":
    rospy.init_node("realtime_gaps")
    rostest.rosrun("fmbpc", "realtime_gaps", RealtimeGaps, sys.argv)
