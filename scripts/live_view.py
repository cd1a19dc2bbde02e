"""What a person wants to see of a running loop: its signals by unit, over a time that can be read, at a rate that eyes
can follow, whatever the pace of the loop. Shared by watch.py and plot_live.py."""
import collections
import math
import socket
import threading

import rosgraph
import rospy
import yaml
from std_msgs.msg import String

# Debian 11's rospy asks threads by a name that its Python knows no more, and would end with a traceback.
if not hasattr(threading.Thread, "isAlive"):
    threading.Thread.isAlive = threading.Thread.is_alive

UNITS = ((5 * 3600.0, 3600.0, "h"), (300.0, 60.0, "min"), (0.0, 1.0, "s"))  # from this duration on: divisor, unit
ENDLESS = 200   # samples that are shown of a run without an end
APART = 5.0     # signals of one unit whose sizes differ by more than this get plots of their own


def loop_text():
    """The loop file as the nodes read it, {} where there is none."""
    name = rospy.search_param("loop_text")
    return yaml.safe_load(rospy.get_param(name)) if name else {}


def master_answers():
    """Quickly; a master that is busy for three seconds is taken to be gone."""
    before = socket.getdefaulttimeout()
    socket.setdefaulttimeout(3.0)
    try:
        return rosgraph.is_master_online()
    finally:
        socket.setdefaulttimeout(before)


class Axis:
    """Time since sample 0 in a unit that makes the run 5 to some hundred units long."""

    def __init__(self, sample_time_s, samples):
        self.endless = samples == 0
        seconds = sample_time_s * (samples or ENDLESS)
        self.divisor, self.unit = next((divisor, unit) for least, divisor, unit in UNITS if seconds >= least)
        self.length = seconds / self.divisor

    def at(self, seconds):
        return seconds / self.divisor


class Panel:
    """Signals that share a y axis."""

    def __init__(self, unit, names):
        self.unit, self.names = unit, list(names)


def panels_of(info, values):
    """One panel per unit, or more if the sizes of its signals are too far apart."""
    panels = []
    for signal in list(info.outputs) + list(info.inputs):
        names = [n for n in (signal.name, signal.name + "_setpoint", signal.name + "_reference") if n in values]
        size = abs(values.get(signal.name, 0.0))
        for panel, of in panels:
            if panel.unit == signal.unit and size <= APART * of and of <= APART * max(size, 1e-300):
                panel.names += names
                break
        else:
            panels.append((Panel(signal.unit, names), size))
    return [panel for panel, _ in panels]


class LiveView:
    """Listens to a loop and keeps the newest value of each signal, and `points` of them over time."""

    def __init__(self, points=20000):
        from fmbpc.msg import ControlAction, LoopState, Measurement, PlantInfo, Tracking  # not there before a build
        self.lock = threading.Lock()
        self.info = self.axis = self.run_id = None
        self.values, self.step, self.seconds = {}, None, 0.0
        self.history = collections.defaultdict(lambda: collections.deque(maxlen=points))
        self.states, self.summary = {}, None
        self.run_end = self.recorded = None
        for topic, kind, take in (("plant_info", PlantInfo, self.on_info), ("measurement", Measurement, self.on_measurement),
                                  ("tracking", Tracking, self.on_tracking),
                                  ("control_action", ControlAction, self.on_action), ("loop_state", LoopState, self.on_state)):
            rospy.Subscriber(topic, kind, take, queue_size=20, tcp_nodelay=True)
        rospy.Subscriber("run_end", String, self.on_run_end)
        rospy.Subscriber("recorded", String, self.on_recorded)

    def on_run_end(self, msg):
        with self.lock:
            self.run_end = msg.data

    def on_recorded(self, msg):
        with self.lock:
            self.recorded = msg.data

    def outcome(self):
        """(went well, words) when the loop is over, None before: a recorder or the plant said so, or the master is gone."""
        with self.lock:
            finished = self.summary is not None and "finished" in self.summary.reason
            if self.run_end not in (None, "recorded"):
                return False, "ended: " + self.run_end
            if self.run_end or (self.recorded and finished):
                return True, "finished" + (": recorded in " + self.recorded if self.recorded else " and recorded")
        if master_answers():
            return None
        return (True, "finished") if finished else (False, "ended before its last sample: the launch is gone")

    def on_info(self, msg):
        with self.lock:
            if msg.run_id == self.run_id:
                return
            self.info, self.run_id, self.step = msg, msg.run_id, None
            duration = float(loop_text().get("sampling", {}).get("duration_h", 0.0) or 0.0)
            self.axis = Axis(msg.sample_time_s, int(round(3600.0 * duration / msg.sample_time_s)))
            self.values.clear()
            self.history.clear()

    def on_measurement(self, msg):
        with self.lock:
            if self.info is None or msg.run_id != self.run_id:
                return
            self.step, self.seconds = msg.step, msg.step * self.info.sample_time_s
            self.keep(self.info.outputs, msg.outputs)

    def on_tracking(self, msg):
        with self.lock:
            if self.info is None or msg.run_id != self.run_id:
                return
            self.keep(self.info.outputs, msg.setpoint, "_setpoint")
            self.keep(self.info.outputs, msg.reference, "_reference")

    def on_action(self, msg):
        with self.lock:
            if self.info is not None and msg.run_id == self.run_id:
                self.keep(self.info.inputs, msg.input)

    def keep(self, signals, numbers, suffix=""):
        if len(signals) != len(numbers):
            return
        for signal, number in zip(signals, numbers):
            if math.isfinite(number):
                self.values[signal.name + suffix] = number

    def on_state(self, msg):
        with self.lock:
            self.states[msg.node] = msg
            if msg.summary:
                self.summary = msg

    def sample(self):
        """(time, values) of now, which also go into the history; None before the first sample."""
        with self.lock:
            if self.step is None or not self.values:
                return None
            time = self.axis.at(self.seconds)
            for name, value in self.values.items():
                points = self.history[name]
                if not points or points[-1][0] < time:
                    points.append((time, value))
            return time, dict(self.values)

    def complete(self):
        """All outputs and inputs have a value."""
        with self.lock:
            return self.info is not None and all(s.name in self.values for s in list(self.info.outputs) + list(self.info.inputs))

    def panels(self):
        with self.lock:
            return panels_of(self.info, self.values)
