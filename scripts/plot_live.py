#!/usr/bin/python3
"""Node plot_live: shows the run in rqt_plot, one plot per unit, the whole run on the time axis, moving by itself. Without
rqt_plot it shows `fmbpc watch --window`, and without a screen it says so and ends. The window of a run that went well
stays until it is closed.

rqt_plot draws every sample of a fast loop and counts time in simulated seconds from its own start; so it gets signals of
its own (view/NAME) ten times a second of wall time, whose stamps count the hours (or minutes, seconds) of the run."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

import rospkg  # noqa: E402
import rospy  # noqa: E402
from fmbpc.msg import Signal  # noqa: E402
from live_view import LiveView  # noqa: E402

PERIOD = 0.1   # s of wall time between two points
MARGIN = 0.1   # of the values at the start, above and below
PLUGIN = "rqt_plot/Plot"


def rqt():
    """The command that starts rqt with the plugin rqt_plot, None if one of them is not installed."""
    try:
        packages = rospkg.RosPack()
        packages.get_path("rqt_plot")
        packages.get_path("rqt_gui")
    except rospkg.ResourceNotFound:
        return None
    return ["rqt"] if shutil.which("rqt") else ["rosrun", "rqt_gui", "rqt_gui"]


def stored(value):
    return {"repr": repr(value), "type": "repr"}


def plot_settings(number, topics, axis, values):
    """The settings that the plugin itself would store."""
    low, high = min(values), max(values)
    room = MARGIN * ((high - low) or max(abs(high), 1e-3))
    keys = {"autoscroll": stored(axis.endless), "topics": stored(topics), "plot_type": stored(1),  # 1: matplotlib
            "x_limits": stored([0.0, axis.length]), "y_limits": stored([low - room, high + room])}
    return f"plugin__rqt_plot__Plot__{number}", {"keys": {}, "groups": {
        "plugin": {"keys": keys, "groups": {}},
        "dock_widget__DataPlotWidget": {"keys": {"dock_widget_title": stored("")}, "groups": {}}}}


def perspective(panels, topics, axis, values):
    """One plugin per panel, docked below each other."""
    plots = dict(plot_settings(number, [topics[name] + "/data" for name in panel.names], axis,
                               [values[name] for name in panel.names])
                 for number, panel in enumerate(panels, start=1))
    running = {PLUGIN: list(range(1, len(panels) + 1))}
    return {"keys": {}, "groups": {
        "mainwindow": {"keys": {}, "groups": {"toolbar_areas": {"keys": {}, "groups": {}}}},
        "pluginmanager": {"keys": {"running-plugins": stored(running)}, "groups": plots}}}


class Relay:
    """The newest values of the loop on view/NAME, ten times a second."""

    def __init__(self, view, names):
        self.view = view
        self.publishers = {name: rospy.Publisher("view/" + name, Signal, queue_size=2000) for name in names}
        self.sent = {}

    def publish(self):
        """What is new, and to a plot that has just opened all that was before."""
        self.view.sample()
        for name, publisher in self.publishers.items():
            if publisher.get_num_connections() == 0:
                continue
            with self.view.lock:
                points = [p for p in self.view.history[name] if p[0] > self.sent.get(name, -1.0)]
            for time, value in points:
                self.sent[name] = time
                message = Signal(data=value)
                message.header.stamp = rospy.Time.from_sec(time)
                publisher.publish(message)


def show(command, view):
    """Starts rqt and feeds it until one of the two ends."""
    panels, (_, values) = view.panels(), view.sample()
    relay = Relay(view, [name for panel in panels for name in panel.names])
    topics = {name: publisher.resolved_name for name, publisher in relay.publishers.items()}
    # rqt's time stays 0, so that rqt_plot subtracts nothing from our stamps.
    still = rospy.resolve_name("view/no_clock")
    rospy.set_param(still, True)
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "fmbpc.perspective")
        with open(file, "w", encoding="utf-8") as stream:
            json.dump(perspective(panels, topics, view.axis, values), stream)
        follow(command + ["--perspective-file", file, f"/use_sim_time:={still}", f"/clock:={still}"], view, relay.publish)


def follow(command, view, feed=lambda: None):
    """Runs a window until one of the two ends: one that shows a run that went well stays, whatever becomes of the launch."""
    window, pause, outcome = subprocess.Popen(command, start_new_session=True), threading.Event(), None
    while not rospy.is_shutdown() and window.poll() is None:
        feed()
        pause.wait(PERIOD)
        outcome = outcome or view.outcome()
    outcome = outcome or view.outcome()
    if outcome and outcome[0]:
        return
    if window.poll() is None:
        window.terminate()
    window.wait()


def main():
    command = rqt()
    if not os.environ.get("DISPLAY"):
        rospy.init_node("plot_live")
        rospy.logwarn("plot:=true, but there is no screen (DISPLAY is not set): no live plot. `fmbpc watch` shows the loop in "
                      "a terminal; plot.png is drawn at the end of the run.")
        return 0
    if command is None:
        print("plot:=true: rqt_plot is not installed (Debian 12 has no package of it): fmbpc watch --window instead",
              flush=True)
    rospy.init_node("plot_live")
    view, pause = LiveView(), threading.Event()
    if command is None:
        script = os.path.join(os.path.dirname(os.path.realpath(__file__)), "watch.py")
        follow([sys.executable, script, "--window"], view)
        return 0
    while not rospy.is_shutdown() and (view.sample() is None or not view.complete()):
        pause.wait(PERIOD)
    if not rospy.is_shutdown():
        show(command, view)
    return 0


if __name__ == "__main__":
    sys.exit(main())
