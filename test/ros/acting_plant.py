"""A test that acts as the plant of a loop: it announces runs, sends samples and reads answers."""
import unittest

import rospy
from fmbpc.msg import ControlAction, LoopState, Measurement, NodeReady, PlantInfo, Tracking
from rosgraph_msgs.msg import Log

import exchange


class ActingPlant(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # The plant in the other namespace never starts: it is there to introduce itself.
        cls.info = exchange.Listener("reference/plant_info", PlantInfo).wait()
        cls.info_pub = rospy.Publisher("plant_info", PlantInfo, queue_size=10, latch=True)
        cls.pub = exchange.publisher("measurement", Measurement, "/fmbpc_controller")
        cls.actions = exchange.Listener("control_action", ControlAction)
        cls.tracking = exchange.Listener("tracking", Tracking)
        cls.log = exchange.Listener("/rosout", Log, "/fmbpc_controller")
        cls.status = exchange.NodeStatus("fmbpc_controller")
        cls.ready = exchange.Listener("ready", NodeReady, "/fmbpc_controller")

    def setUp(self):
        self.new_run()

    def new_run(self):
        self.info.run_id += 1000
        self.info_pub.publish(self.info)
        for listener in (self.actions, self.tracking, self.log):
            listener.clear()
        self.applied = [570.0]
        self.sent = -1
        exchange.wait_until(lambda: self.answered(0), "an answer to sample 0")

    def answered(self, step):
        """plant_info and measurement travel apart: send again, as a plant does."""
        self.send(step)
        try:
            self.actions.wait(lambda a: (a.run_id, a.step) == (self.info.run_id, step), patience=0.05)
            return True
        except AssertionError:
            return False

    def wait_for_state(self, step, fits):
        """Meanwhile the sample is sent again: who gets no measurement is stalled."""
        state = exchange.Listener("loop_state", LoopState, "/fmbpc_controller")

        def said():
            self.send(step)
            return any(fits(m) for m in list(state.messages))
        exchange.wait_until(said, "the controller to say it")

    def message(self, step, run_id=None, outputs=(200.0, 2000.0), final=False, quality=()):
        msg = Measurement(run_id=self.info.run_id if run_id is None else run_id, step=step, outputs=outputs,
                          disturbances=[1300.0, 430.0], input_applied=self.applied, final=final,
                          quality=quality)
        msg.header.stamp = self.info.header.stamp + rospy.Duration(720 * step)
        return msg

    def send(self, step, **fields):
        self.pub.publish(self.message(step, **fields))

    def answer(self, step, **fields):
        """Sends a sample and returns its action; whatever was answered before it is in self.actions."""
        self.send(step, **fields)
        action = self.actions.wait(lambda a: (a.run_id, a.step) == (self.info.run_id, step))
        self.applied = list(action.input)
        return action
