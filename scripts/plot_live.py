#!/usr/bin/python3
"""Node plot_live: waits until the signals of the loop exist, then becomes rqt_plot on them. Without rqt_plot it says
so and ends."""
import os
import shutil
import sys
import threading

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

import rospkg
import rospy
from fmbpc.msg import PlantInfo


def rqt_plot():
    """The command that starts rqt_plot, None if it is not installed."""
    if shutil.which("rqt_plot"):
        return ["rqt_plot"]
    try:
        rospkg.RosPack().get_path("rqt_plot")
        return ["rosrun", "rqt_plot", "rqt_plot"]
    except rospkg.ResourceNotFound:
        return None


def signals(info):
    names = []
    for output in info.outputs:
        names += [output.name, output.name + "_setpoint", output.name + "_reference"]
    return [rospy.resolve_name("signal/" + name) for name in names + [i.name for i in info.inputs]]


def main():
    rospy.init_node("plot_live", anonymous=False)
    command = rqt_plot()
    if command is None:
        rospy.logwarn("plot:=true, but rqt_plot is not installed (Debian 12 has no package of it): no live plot. "
                      "The signals are on /signal/*; plot.png is drawn at the end of the run.")
        return 0
    topics = signals(rospy.wait_for_message("plant_info", PlantInfo))
    pause = threading.Event()
    while not rospy.is_shutdown():
        known = {topic for topic, _ in rospy.get_published_topics()}
        if known.issuperset(topics):
            # rqt_plot silently drops topics that do not exist at its start.
            os.execvp(command[0], command + [topic + "/data" for topic in topics])
        pause.wait(0.2)
    return 0


if __name__ == "__main__":
    sys.exit(main())
