#!/usr/bin/python3
"""A plant of one's own in 40 lines: a tank, area dh/dt = q - c sqrt(h), speaking the ring of config/loop/
example_external.yaml. Replace level() by whatever reads your sensors and moves your valves."""
import math
import sys
import time

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

import rospy
from fmbpc.msg import ControlAction, Measurement, NodeReady, PlantInfo, SignalInfo

SAMPLE_TIME_S, SAMPLES, T0_S = 60.0, 240, 1.0
AREA_M2, OUTFLOW = 2.0, 6.0  # m2, m3/h per sqrt(m)


def level(h, q):
    """The level one sample later [m], with inflow q [m3/h]."""
    for _ in range(60):
        h = max(0.0, h + (q - OUTFLOW * math.sqrt(h)) / AREA_M2 * SAMPLE_TIME_S / 60 / 3600)
    return h


class Tank:
    def __init__(self):
        self.measurement = Measurement(run_id=time.time_ns(), outputs=[0.5], input_applied=[2.0])
        self.waiting_for = {rospy.resolve_name(n) for n in ("fmbpc_controller", "loop_recorder")}
        self.info_pub = rospy.Publisher("plant_info", PlantInfo, queue_size=1, latch=True)
        self.pub = rospy.Publisher("measurement", Measurement, queue_size=10, latch=True, tcp_nodelay=True)
        rospy.Subscriber("control_action", ControlAction, self.on_action, tcp_nodelay=True)
        rospy.Subscriber("ready", NodeReady, lambda msg: self.waiting_for.discard(msg.node))
        info = PlantInfo(run_id=self.measurement.run_id, name="tank", frame_id="tank", sample_time_s=SAMPLE_TIME_S,
                         outputs=[SignalInfo("level", "m", 0, 4)], inputs=[SignalInfo("inflow", "m3/h", 0, 20)],
                         output_frames=["tank"])
        info.header.stamp = rospy.Time(T0_S)
        self.info_pub.publish(info)

    def send(self):
        m = self.measurement
        m.header.stamp, m.header.frame_id = rospy.Time(T0_S + m.step * SAMPLE_TIME_S), "tank"
        m.final = m.step == SAMPLES
        self.pub.publish(m)

    def on_action(self, action):  # anything but the answer to the present sample is old: drop it
        m = self.measurement
        if (action.run_id, action.step) != (m.run_id, m.step) or m.final or len(action.input) != 1:
            return
        q = min(max(action.input[0], 0.0), 20.0)
        self.measurement = Measurement(run_id=m.run_id, step=m.step + 1, outputs=[level(m.outputs[0], q)],
                                       input_applied=[q])
        self.send()


if __name__ == "__main__":
    rospy.init_node("example_plant")
    tank = Tank()
    while not rospy.is_shutdown():  # until it is answered, the present sample is sent again every 50 ms
        if not tank.waiting_for:
            tank.send()
        time.sleep(0.05)
