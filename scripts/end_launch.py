#!/usr/bin/python3
"""Node end_launch: ends the launch that started it, as Ctrl-C does, when the run is over (topic run_end). roslaunch with
a master of its own never ends by itself, and a node that is `required` is announced in red as having died."""
import os
import queue
import signal
import sys
import xmlrpc.client

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

import rospy
from std_msgs.msg import String


def launcher():
    """Process of the roslaunch that is the parent of this node; 0 if a person started the node."""
    parent = os.getppid()
    for uri in (rospy.get_param("/roslaunch/uris", {}) or {}).values():
        try:
            if xmlrpc.client.ServerProxy(uri).get_pid()[2] == parent:
                return parent
        except (OSError, xmlrpc.client.Error):
            continue
    return 0


def main():
    rospy.init_node("end_launch")
    parent = launcher()
    if not parent:
        rospy.logwarn("end_launch: no roslaunch has started this node: there is nothing to end")
        return 0
    words = queue.Queue()
    rospy.Subscriber("run_end", String, words.put)
    names = ["loop_recorder", "plant_simulator", rospy.get_param("~manager", "")]  # nodelets speak with their manager's name
    ours = {rospy.resolve_name(name) for name in names if name}
    while not rospy.is_shutdown():
        try:
            message = words.get(timeout=0.5)
        except queue.Empty:
            continue
        if end(message._connection_header["callerid"], message.data, ours):
            os.kill(parent, signal.SIGINT)
            break
    return 0


def end(said_by, why, ours):
    """True if it is said by one who may."""
    if said_by not in ours:
        rospy.logerr("end_launch: run_end of %s refused: the loop takes it only from %s", said_by, ", ".join(sorted(ours)))
    elif why == "recorded":
        rospy.loginfo("end_launch: the run is recorded, the launch ends")
    else:
        rospy.logerr("end_launch: the launch ends: %s", why)
    return said_by in ours


if __name__ == "__main__":
    sys.exit(main())
