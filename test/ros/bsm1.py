#!/usr/bin/python3
"""BSM1 over topics, FMBPC with the constraint optimizer: what a person types with rostopic acts as in the loop file, the run
is that of one process, and tanks and settler stand in the tf tree."""
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from fmbpc.msg import NodeReady
from rosgraph_msgs.msg import Log
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

import exchange

T0_S = 1
# topic, type, name, value, time [h]
TYPED = [("setpoint", "fmbpc/Setpoint", "S_NH5", 0.6, 6), ("disturbance", "fmbpc/Disturbance", "Q_in", 36892.0, 9),
         ("disturbance", "fmbpc/Disturbance", "blower", 0.6, 12)]


def rostopic(topic, kind, name, value, time_h):
    """As a person types it, for a time of the plant; ends once the message is latched long enough."""
    text = f"{{header: {{stamp: {{secs: {T0_S + 3600 * time_h}}}}}, name: [{name}], value: [{value}], mode: 1}}"
    return subprocess.Popen(exchange.tied(["rostopic", "pub", "-1", topic, kind, text]), stdout=subprocess.DEVNULL)


def key(topic):
    items = [f"{{time_h: {time_h}, name: {name}, value: {value!r}}}" for t, _, name, value, time_h in TYPED if t == topic]
    return f"{topic}.commands=[" + ", ".join(items) + "]"


class Bsm1(unittest.TestCase):
    def test_typed_commands_act_and_the_run_is_that_of_one_process(self):
        log, recorded = exchange.Listener("/rosout", Log, "/fmbpc_controller", "/plant_simulator"), exchange.Listener("recorded", String)
        frames = exchange.Listener("/tf_static", TFMessage)
        parents = {t.child_frame_id: t.header.frame_id for t in frames.wait().transforms}
        for tank in range(1, 6):
            self.assertEqual("plant", parents[f"tank_{tank}"])
        self.assertEqual("plant", parents["settler"])
        self.assertEqual("settler", parents["layer_10"])
        self.assertEqual("tank_5", parents["ammonium_analyser"])

        typed = [rostopic(*command) for command in TYPED]
        for node, words, count in (("/fmbpc_controller", ": setpoint of", 1), ("/plant_simulator", ": disturbance of", 2)):
            exchange.wait_until(lambda n=node, w=words, c=count:
                            sum(m.name == n and w in m.msg for m in list(log.messages)) == c, f"{node} to take all")
        ready = rospy.Publisher("ready", NodeReady, queue_size=1, latch=True)
        ready.publish(node=rospy.get_name())
        folder = recorded.wait(patience=150).data
        for process in typed:
            process.wait(timeout=60)
        with tempfile.TemporaryDirectory() as reference:
            exchange.run_in_process("bsm1_own_fmbpc_clp", reference, rospy.get_param("~set").split() +
                                [key("setpoint"), key("disturbance")])
            exchange.assert_same_run(self, folder, reference)
        summary = exchange.summary(folder)
        self.assertEqual(96, summary["steps"])
        self.assertEqual({"input": 0, "move": 0}, {k: summary["violations"][k] for k in ("input", "move")})


if __name__ == "__main__":
    rospy.init_node("bsm1")
    rostest.rosrun("fmbpc", "bsm1", Bsm1, sys.argv)
