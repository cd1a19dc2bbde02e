#!/usr/bin/python3
"""People at the adaptive column: adaptation frozen and released by service, a gain that jumps while the loop runs, a
sensor that tells nonsense. The plant is paused and let go sample by sample, so that every act falls between two."""
import sys
import unittest

import rospy
import rostest
from fmbpc.msg import ControlAction, Disturbance, Measurement, Signal
from rosgraph_msgs.msg import Log
from std_srvs.srv import SetBool, Trigger

import exchange

OVERRIDE, RELEASE = 1, 3
NOMINAL, JUMPED, RATIO_UPPER, LIMIT, SAMPLES = 12.8, 15.36, 2.0, 2.0, 900


class ColumnAdapt(unittest.TestCase):
    def advance(self, samples):
        for _ in range(samples):
            self.assertTrue(self.step().success)
        self.at += samples
        self.gains.wait(lambda s: s.header.stamp.to_sec() >= 1 + 60 * self.at)

    def gains_between(self, first, last):
        """Gains in use at these samples."""
        return [s.data for s in list(self.gains.messages) if 1 + 60 * first <= s.header.stamp.to_sec() <= 1 + 60 * last]

    def test_freeze_release_gain_jump_and_nonsense(self):
        self.at = 0
        self.gains = exchange.Listener("signal/gain_in_use_y_D_L", Signal)
        actions, measurements = exchange.Listener("control_action", ControlAction), exchange.Listener("measurement", Measurement)
        pause = rospy.ServiceProxy("plant_simulator/pause", SetBool)
        self.step = rospy.ServiceProxy("plant_simulator/step", Trigger, persistent=True)
        adapt = rospy.ServiceProxy("fmbpc_controller/adapt", SetBool)
        for service in (pause, adapt):
            service.wait_for_service(exchange.PATIENCE)
        disturbance = exchange.publisher("disturbance", Disturbance, "/plant_simulator")
        self.assertTrue(pause(True).success)
        self.assertEqual("frozen", adapt(False).message)
        exchange.begin()
        measurements.wait(lambda m: m.step == 0)

        log = exchange.Listener("/rosout", Log, "/plant_simulator")

        def tell(name, mode, value=None):
            disturbance.publish(Disturbance(name=[name], value=[] if value is None else [value], mode=mode))
            exchange.wait_until(lambda: any(m.name == "/plant_simulator" and name in m.msg for m in list(log.messages)),
                            f"the plant to take {name}")
            log.clear()

        self.advance(150)
        tell("gain/y_D/L", OVERRIDE, JUMPED)
        self.advance(150)
        self.assertEqual({NOMINAL}, set(self.gains_between(0, 300)), "frozen: nothing is learned")

        self.assertEqual("adapting", adapt(True).message)
        self.advance(300)
        self.assertAlmostEqual(JUMPED, self.gains_between(600, 600)[0], delta=0.05 * JUMPED)

        tell("output/y_D", OVERRIDE, 1e6)
        self.advance(20)
        tell("output/y_D", OVERRIDE, 99.0)  # nonsense inside the range
        self.advance(20)
        tell("output/y_D", RELEASE)
        self.advance(60)
        for gain in self.gains_between(0, self.at):
            self.assertTrue(NOMINAL / RATIO_UPPER <= gain <= NOMINAL * RATIO_UPPER, gain)

        self.assertTrue(adapt(False).success)
        self.advance(1)
        held = self.gains_between(self.at, self.at)[0]
        self.advance(SAMPLES - 1 - self.at)
        self.assertEqual({held}, set(self.gains_between(SAMPLES - 50, SAMPLES - 1)))
        for action in actions.messages:
            self.assertTrue(all(abs(u) <= LIMIT for u in action.input), action.input)


if __name__ == "__main__":
    rospy.init_node("column_adapt")
    rostest.rosrun("fmbpc", "column_adapt", ColumnAdapt, sys.argv)
