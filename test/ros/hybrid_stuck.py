#!/usr/bin/python3
"""A mixing valve that sticks, injected by topic, is survived and reported: the run equals that with the same fault in
the loop file, the controller names the valve, and the core is heated again once it is free."""
import sys
import tempfile
import unittest

import rospy
import rostest
from fmbpc.msg import Disturbance
from rosgraph_msgs.msg import Log
from std_msgs.msg import String

import exchange

STUCK_H, FREE_H = 0.25, 0.75
SAMPLE_S, T0_S = 10, 1


def message(time_h, mode, values):
    msg = Disturbance(name=["input/kM"], value=values, mode=mode)
    msg.header.stamp = rospy.Time(T0_S) + rospy.Duration.from_sec(time_h * 3600)
    return msg


class HybridStuck(unittest.TestCase):
    def test_a_stuck_valve_is_survived_and_reported(self):
        recorded, log = exchange.Listener("recorded", String), exchange.Listener("/rosout", Log, "/fmbpc_controller", "/plant_simulator")
        disturbance = exchange.publisher("disturbance", Disturbance, "/plant_simulator")
        disturbance.publish(message(STUCK_H, Disturbance.OVERRIDE, [0.0]))
        disturbance.publish(message(FREE_H, Disturbance.RELEASE, []))
        exchange.wait_until(lambda: sum("disturbance of" in m.msg for m in list(log.messages)) == 2, "the plant to take both")
        exchange.begin()
        log.wait(lambda m: m.name == "/fmbpc_controller" and m.level == Log.WARN and
                 "kM is not where it was sent" in m.msg)
        folder = recorded.wait().data
        commands = (f"[{{time_h: {STUCK_H}, name: input/kM, value: 0}}, "
                    f"{{time_h: {FREE_H}, name: input/kM, mode: release}}]")
        with tempfile.TemporaryDirectory() as reference:
            exchange.run_in_process("batch_fuzzy_eq45", reference,
                                rospy.get_param("~set").split() + ["disturbance.commands=" + commands])
            exchange.assert_same_run(self, folder, reference)
        summary = exchange.summary(folder)
        self.assertTrue(summary["complete"])
        self.assertEqual(0, summary["violations"]["input"])
        rows = [line.split(",") for line in exchange.trajectory(folder)]
        t = [i for i, name in enumerate(rows[0]) if name.startswith("T[")][0]
        at = [float(row[t]) for row in rows[1:]]
        stuck, free = round(STUCK_H * 3600 / SAMPLE_S), round(FREE_H * 3600 / SAMPLE_S)
        self.assertLess(at[free], at[stuck] + 5.0)
        self.assertGreater(at[-1], at[free] + 10.0)


if __name__ == "__main__":
    rospy.init_node("hybrid_stuck")
    rostest.rosrun("fmbpc", "hybrid_stuck", HybridStuck, sys.argv)
