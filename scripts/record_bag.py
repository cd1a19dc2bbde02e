#!/usr/bin/python3
"""Node bag_recorder: records every topic (in a namespace: of it) with rosbag and says `ready` when rosbag listens to all of them, so that
the bag begins with sample 0. Usage: record_bag.py FILE.bag, or the parameter ~file"""
import os
import signal
import subprocess
import sys
import threading

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

import rosgraph
import rospy
from fmbpc.msg import NodeReady
from std_msgs.msg import String

# Debian 11's rospy asks threads by a name that its Python knows no more, and would end with a traceback.
if not hasattr(threading.Thread, "isAlive"):
    threading.Thread.isAlive = threading.Thread.is_alive

RECORDER = "rosbag_record"


def listens_to_all(master):
    """True if rosbag has subscribed to every topic that somebody publishes."""
    publishers, subscribers, _ = master.getSystemState()
    name = rospy.resolve_name(RECORDER)
    heard = {topic for topic, nodes in subscribers if name in nodes}
    text = rospy.resolve_name("loop_text")
    all_of_them = {topic for topic, nodes in publishers if topic.startswith(rospy.get_namespace()) and
              (topic == text or nodes not in ([name], [rospy.get_name()]))}
    needed = {rospy.resolve_name(topic) for topic in ("measurement", "tracking", "control_action")}
    return needed <= heard and all_of_them <= heard


def bag_file(arguments):
    """The one argument; words of a name with spaces that nobody quoted are an error, not another name."""
    arguments = arguments or [name for name in [rospy.get_param("~file", "")] if name]
    if len(arguments) != 1:
        raise SystemExit(f"record_bag.py: expected one file, got {len(arguments)}: {arguments}")
    return os.path.abspath(arguments[0])


def remaps(arguments):
    """What the launch has renamed (/clock, /tf), for rosbag as well: with simulated time it waits for the clock."""
    return [word for word in arguments if ":=" in word and not word.startswith("_")]


def main():
    rospy.init_node("bag_recorder", disable_signals=True)
    bag = bag_file(rospy.myargv()[1:])
    os.makedirs(os.path.dirname(bag), exist_ok=True)
    ready = rospy.Publisher("ready", NodeReady, queue_size=1, latch=True)
    text = rospy.Publisher("loop_text", String, queue_size=1, latch=True)  # `fmbpc replay` needs it
    text.publish(rospy.get_param(rospy.search_param("loop_text") or "loop_text", ""))
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    space = rospy.get_namespace()
    what = ["--all"] if space == "/" else ["--regex", space + ".*"]  # of several loops ours
    rosbag = subprocess.Popen(["rosbag", "record", *what, "--buffsize=0", "--tcpnodelay", "--output-name", bag,
                               "__name:=" + RECORDER, *remaps(sys.argv[1:])],
                              start_new_session=True, stdout=subprocess.DEVNULL)  # a line a topic; warnings go to stderr
    master, said, quiet = rosgraph.Master(rospy.get_name()), False, 0
    while rosbag.poll() is None and not stop.wait(0.1):
        quiet = quiet + 1 if not said and listens_to_all(master) else 0
        if quiet == 5:
            ready.publish(node=rospy.get_name())
            said = True
    if rosbag.poll() is None:
        os.killpg(rosbag.pid, signal.SIGINT)
    code = rosbag.wait()
    rospy.signal_shutdown("recorded")
    return 0 if stop.is_set() else code


if __name__ == "__main__":
    sys.exit(main())
