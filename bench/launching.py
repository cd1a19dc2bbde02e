"""A master of its own, a launch on it, and somebody who says when the first sample is answered. For the benchmarks."""
import contextlib
import os
import pathlib
import select
import signal
import socket
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent

WATCH = """
import sys, threading, time
import rospy
kind, names = sys.argv[1], sys.argv[2:]
up, lock = set(), threading.Lock()
def heard(name):
    with lock:
        up.add(name)
        if len(up) == len(names):
            print(time.monotonic(), flush=True)
            rospy.signal_shutdown("done")
rospy.init_node("start_watch", disable_signals=True)
if kind == "loop":
    from fmbpc.msg import Measurement
    for name in names:
        rospy.Subscriber(name, Measurement, lambda m, n=name: m.step >= 1 and heard(n), tcp_nodelay=True)
else:
    from std_msgs.msg import Empty
    for name in names:
        rospy.Subscriber(name, Empty, lambda m, n=name: heard(n))
print("ready", flush=True)
rospy.spin()
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def master():
    """Environment of a master that answers."""
    port = free_port()
    env = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}", ROS_HOSTNAME="localhost")
    core = subprocess.Popen(["roscore", "-p", str(port)], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while subprocess.run(["rosparam", "get", "/run_id"], env=env, capture_output=True).returncode != 0:
            if core.poll() is not None:
                raise RuntimeError("roscore has ended")
        yield env
    finally:
        core.send_signal(signal.SIGINT)
        core.wait()


@contextlib.contextmanager
def launched(env, words, kind, names):
    """Launches; yields (process of roslaunch, seconds until all `names` were heard: topics with the sample number of a
    loop, or those of empty nodes)."""
    watch = subprocess.Popen([sys.executable, "-c", WATCH, kind, *names], env=env, stdout=subprocess.PIPE, text=True)
    launch = None
    try:
        watch.stdout.readline()
        began = time.monotonic()
        launch = subprocess.Popen(["roslaunch", "--wait", *words], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not select.select([watch.stdout], [], [], 0.2)[0]:
            if launch.poll() is not None:
                raise RuntimeError(f"roslaunch has ended with {launch.returncode}: roslaunch {' '.join(words)}")
        line = watch.stdout.readline()
        if not line:
            raise RuntimeError("nothing was heard of " + " ".join(names))
        yield launch, float(line) - began
    finally:
        watch.kill()
        watch.wait()
        if launch is not None:
            launch.send_signal(signal.SIGINT)
            launch.wait()


def loop_words(loop, out):
    return ["fmbpc", "loop.launch", f"loop:={loop}", "pace:=lockstep", f"out:={out}", "draw:=false", "sim_time:=false"]
