"""A loop over topics in a launch of its own, and everything it says, with the wall time at which it came."""
import os
import re
import signal
import subprocess
import threading
import time
import xmlrpc.client

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from fmbpc.msg import (CommandEffect, ControlAction, Disturbance, FuzzyModel, Identified, LoopState, Measurement, NodeReady,
                       OperatorState, PlantInfo, PlantState, PredictiveAction, Setpoint, SolverReport, Tracking)
from std_msgs.msg import String

from pulse import Pulse

KINDS = {"plant_info": PlantInfo, "measurement": Measurement, "plant_state": PlantState, "base_action": ControlAction,
         "predictive_action": PredictiveAction, "control_action": ControlAction, "tracking": Tracking,
         "solver_report": SolverReport, "fuzzy_model": FuzzyModel, "identified": Identified, "setpoint": Setpoint,
         "disturbance": Disturbance, "loop_state": LoopState, "operator_state": OperatorState,
         "operator_kept": OperatorState, "model_kept": FuzzyModel, "ready": NodeReady, "recorded": String,
         "run_end": String}
HEARD = ("plant_info", "measurement", "plant_state", "base_action", "predictive_action", "control_action", "tracking",
         "solver_report", "fuzzy_model", "loop_state", "operator_kept")


SIMULATOR = "plant_simulator"  # in the names of faults: whatever plant the loop has
MANAGER = "loop_manager"       # of nodelets, who speak in its name
ROLES = {"plant": SIMULATOR, "controller": "fmbpc_controller", "optimizer": "clp_optimizer", "recorder": "loop_recorder",
         "model": "fuzzy_identifier"}


class Log:
    """(wall time, message) of a topic."""

    def __init__(self, topic, kind):
        self.items, self.arrived = [], threading.Condition()
        self.subscriber = rospy.Subscriber(topic, kind, self.take, queue_size=1000, tcp_nodelay=True)

    def take(self, message):
        """What this node itself has forged is no word of the loop."""
        if message._connection_header.get("callerid") == rospy.get_name():
            return
        with self.arrived:
            self.items.append((time.monotonic(), message))
            self.arrived.notify_all()

    def last(self):
        return self.items[-1][1] if self.items else None

    def since(self, start):
        return [(t, m) for t, m in list(self.items) if t >= start]

    def wait(self, fits, start, patience):
        """(time, message) of the first that fits since `start`; None if there is none within `patience` of now."""
        end, seen = time.monotonic() + patience, 0
        with self.arrived:
            while True:
                for item in self.items[seen:]:
                    if item[0] >= start and fits(item[1]):
                        return item
                seen = len(self.items)
                left = end - time.monotonic()
                if left <= 0 or not self.arrived.wait(left):
                    return None


class Loop:
    """Nodes, topics and services by their short names."""

    def __init__(self, nodes, plant=SIMULATOR):
        self.nodes, self.plant = ["/" + name for name in nodes], plant
        self.logs = {topic: Log(topic, KINDS[topic]) for topic in HEARD}
        self.effects = Log("disturbance_effect", CommandEffect)
        self.diagnostics = Log("/diagnostics", DiagnosticArray)
        self.publishers = {topic: rospy.Publisher(topic, kind, queue_size=10000, tcp_nodelay=True)
                           for topic, kind in KINDS.items() if topic not in ("plant_info",)}
        self.publishers["plant_info"] = rospy.Publisher("plant_info", PlantInfo, queue_size=10, tcp_nodelay=True)
        self.master = rosgraph.Master(rospy.get_name())
        self.frozen, self.children, self.pulse = set(), [], Pulse()

    # What it says.
    def now(self):
        return self.logs["measurement"].last()

    def info(self):
        return self.logs["plant_info"].last()

    def words(self, start):
        """(time, "NODE WORD: REASON (MISSING)") of everything said since by whoever is not in order."""
        lines = [(t, f"{s.node} {s.word}: {s.reason} ({', '.join(s.missing)})")
                 for t, s in self.logs["loop_state"].since(start)]
        for t, array in self.diagnostics.since(start):
            lines += [(t, f"{self.speaker(s.name)} {('automatic', 'warning', 'error', 'stale')[s.level]}: {s.message} ()")
                      for s in array.status]
        return sorted((line for line in lines if " automatic:" not in line[1]), key=lambda line: line[0])

    def summary(self):
        states = [s for _, s in list(self.logs["loop_state"].items)[-200:] if s.summary]
        return states[-1] if states else None

    def wait_for_summary(self, word, start, patience):
        return self.logs["loop_state"].wait(lambda s: s.summary and s.word == word, start, patience)

    def wait_for_words(self, pattern, start, patience):
        """(seconds after `start`, line), or None."""
        expression, end = re.compile(pattern), time.monotonic() + patience
        while True:
            for t, line in self.words(start):
                if expression.search(line):
                    return t - start, line
            if time.monotonic() > end:
                return None
            time.sleep(0.02)

    def counter(self, node, key):
        """Sum of a node's counters whose names start with `key`, as it said last."""
        for _, array in reversed(list(self.diagnostics.items)[-400:]):
            for status in array.status:
                if self.speaker(status.name) == self.name(node):
                    return sum(int(p.value) for p in status.values if p.key.startswith(key) and p.value.isdigit())
        return 0

    def name(self, node):
        return self.plant if node == SIMULATOR else node

    def speaker(self, status_name):
        """The node of a status "NODE: ROLE"."""
        node, _, role = status_name.partition(": ")
        return self.name(ROLES.get(role, node)) if node == MANAGER else node

    # What is done to it.
    def pid(self, node):
        try:
            return xmlrpc.client.ServerProxy(self.master.lookupNode(node)).getPid(rospy.get_name())[2]
        except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
            return 0

    def pids(self):
        return {node: self.pid(node) for node in self.nodes}

    def kill(self, *nodes, with_signal=signal.SIGKILL):
        for node in nodes:
            process = self.pid("/" + self.name(node))
            if not process:
                raise RuntimeError(f"/{node} is not there to be killed")
            os.kill(process, with_signal)

    def freeze(self, *nodes):
        for node in nodes:
            process = self.pid("/" + self.name(node))
            if process:
                os.kill(process, signal.SIGSTOP)
                self.frozen.add(process)

    def thaw(self):
        for process in self.frozen:
            try:
                os.kill(process, signal.SIGCONT)
            except ProcessLookupError:
                pass
        self.frozen.clear()

    def send(self, topic, message, times=1):
        for _ in range(times):
            self.publishers[topic].publish(message)

    def start(self, *command, **options):
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
                                 **options)
        self.children.append(child)
        return child

    def end_children(self):
        for child in self.children:
            if child.poll() is None:
                os.killpg(child.pid, signal.SIGKILL)
            child.wait()
        self.children.clear()

    def samples(self, count, patience=20.0):
        """Waits for so many more samples."""
        first = self.now().step
        self.logs["measurement"].wait(lambda m: m.step >= first + count, time.monotonic(), patience)
