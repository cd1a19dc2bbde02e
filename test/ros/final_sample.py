#!/usr/bin/python3
"""Only the plant that announced a run says when it ends: a final sample of another node ends no record."""
import subprocess
import sys

import rospy
import rostest
from fmbpc.msg import Measurement, PlantState, Recorded
from std_msgs.msg import String

import exchange
from acting_plant import ActingPlant


class FinalSample(ActingPlant):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.info.run_id += 10 ** 6  # of no other test

    def test_a_final_sample_of_another_node_than_the_plant_ends_no_record(self):
        status, recorded = exchange.NodeStatus("loop_recorder"), exchange.Listener("recorded", String, "/loop_recorder")
        states, got = exchange.publisher("plant_state", PlantState, "/loop_recorder"), exchange.Listener("sample_recorded", Recorded)

        def record(step):
            def held():
                states.publish(PlantState(run_id=self.info.run_id, step=step, state=[0.0] * 6, outputs=[200.0, 2000.0]))
                return any((m.run_id, m.step) == (self.info.run_id, step) for m in list(got.messages))
            exchange.wait_until(held, f"sample {step} on record")
        exchange.publisher("measurement", Measurement, "/loop_recorder")
        self.answer(1)
        record(1)
        before = status.counts().get("refused: measurement", 0)
        forged = f"{{run_id: {self.info.run_id}, step: 2, final: true, outputs: [1, 2], disturbances: [1, 2], input_applied: [0]}}"
        stranger = subprocess.Popen(exchange.tied(["rostopic", "pub", "-r", "20", "/measurement", "fmbpc/Measurement", forged]))
        self.addCleanup(exchange.killed, stranger)
        states.publish(PlantState(run_id=self.info.run_id, step=2, state=[0.0] * 6, outputs=[200.0, 2000.0]))
        status.wait(lambda s: int(exchange.values(s).get("refused: measurement", 0)) > before + 2)
        self.tracking.wait(lambda t: (t.run_id, t.step) == (self.info.run_id, 2))  # the controller listens to anyone
        self.assertEqual([], recorded.messages)
        exchange.killed(stranger)
        self.send(3)
        record(3)
        self.send(4, final=True)
        record(4)
        self.assertEqual([], recorded.messages)  # nobody else's sample 2 is in it


if __name__ == "__main__":
    rospy.init_node("final_sample")
    rostest.rosrun("fmbpc", "final_sample", FinalSample, sys.argv)
