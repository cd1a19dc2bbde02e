#!/usr/bin/python3
"""A plant of one's own behind plant_gateway: a tank, area dh/dt = q - c sqrt(h), that knows std_msgs/Float64 and nothing
else. Replace level() by whatever reads your sensors and moves your valves. It lives SPEEDUP times faster than the clock."""
import math
import sys
import time

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

import rospy
from std_msgs.msg import Float64

PERIOD_S, SPEEDUP = 0.02, 600.0  # of wall time between two looks; as gateway.speedup
AREA_M2, OUTFLOW = 2.0, 6.0  # m2, m3/h per sqrt(m)
LOWER, UPPER, SAFE, PATIENCE_S = 0.0, 20.0, 4.0, 3.0  # m3/h; s of wall time without a command


def level(h, q, seconds):
    """The level so much later [m], with inflow q [m3/h]."""
    for _ in range(10):
        h = max(0.0, h + (q - OUTFLOW * math.sqrt(h)) / AREA_M2 * seconds / 10 / 3600)
    return h


class Tank:
    """Keeps itself safe: a command that is no number is ignored, others are clipped, and without any it closes to SAFE."""

    def __init__(self, speedup):
        self.level, self.inflow, self.speedup = 0.5, 2.0, speedup
        self.told = self.now = time.monotonic()
        self.level_pub = rospy.Publisher("tank/state", Float64, queue_size=1, tcp_nodelay=True)
        self.inflow_pub = rospy.Publisher("tank/inflow", Float64, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber("tank/control_effort", Float64, self.on_effort, tcp_nodelay=True)

    def on_effort(self, message):
        if math.isfinite(message.data):
            self.inflow, self.told = min(max(message.data, LOWER), UPPER), time.monotonic()

    def live(self):
        before, self.now = self.now, time.monotonic()
        if self.now - self.told > PATIENCE_S:
            self.inflow = SAFE
        self.level = level(self.level, self.inflow, self.speedup * (self.now - before))
        self.level_pub.publish(self.level)
        self.inflow_pub.publish(self.inflow)


if __name__ == "__main__":
    rospy.init_node("example_plant")
    tank = Tank(rospy.get_param("~speedup", SPEEDUP))
    while not rospy.is_shutdown():
        tank.live()
        time.sleep(PERIOD_S)
