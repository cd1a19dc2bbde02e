"""What the tests over topics share: waiting for messages, the tool, comparing result folders."""
import fcntl
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import xmlrpc.client

import actionlib
import rosgraph
import roslib.packages
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from fmbpc.msg import NodeReady

PATIENCE = 60.0  # s of wall time for anything that must come
LOADED = time.monotonic() - 60.0  # no run of a test began before


class Listener:
    """Keeps every message of a topic; wait() returns the first one that fulfils a condition.

    What the test publishes itself on the topic is not heard: it may arrive at any time. Connected once it is made: to
    all nodes in `of` where several publish on a topic, else to whoever publishes. A lockstep loop does thousands of
    samples while a subscriber is still being connected, so nothing may be stepped before. Only a test that starts the
    publishers itself says connected=False.
    """

    def __init__(self, topic, kind, *of, connected=True):
        self.messages, self.arrived = [], threading.Condition()
        self.subscriber = rospy.Subscriber(topic, kind, self.take, tcp_nodelay=True)
        self.topic = topic
        if connected:
            wait_until(lambda: self.publishers() >= set(of) and self.publishers(), f"{of or 'a publisher'} on {topic}")

    def publishers(self):
        """Nodes that are connected to this listener: rospy lists a connection before the other side has answered."""
        return {connection.callerid_pub for connection in list(self.subscriber.impl.connections)} - {"unknown"}

    def take(self, message):
        if message._connection_header["callerid"] == rospy.get_name():
            return
        with self.arrived:
            self.messages.append(message)
            self.arrived.notify_all()

    def wait(self, condition=lambda message: True, patience=PATIENCE):
        end, seen = time.monotonic() + patience, 0
        with self.arrived:
            while True:
                for message in self.messages[seen:]:
                    if condition(message):
                        return message
                seen = len(self.messages)
                if not self.arrived.wait(max(0.0, end - time.monotonic())):
                    raise AssertionError(f"{self.topic}: what was waited for did not come within {patience} s; "
                                         f"last of {seen}: {self.messages[-1:]}")

    def clear(self):
        with self.arrived:
            self.messages.clear()


def wait_until(condition, what, patience=PATIENCE):
    """For what sends no message of its own (connections, processes, files)."""
    end = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < end, f"waited {patience} s for {what}"
        time.sleep(0.01)


def begin():
    """Says that this test is ready: a loop whose loop.wait_for names it starts at sample 0 now, and misses nothing."""
    ready = rospy.Publisher("ready", NodeReady, queue_size=1, latch=True)
    ready.publish(node=rospy.get_name())


def slave(node, master=None):
    """A node's own interface."""
    return xmlrpc.client.ServerProxy((master or rosgraph.Master(rospy.get_name())).lookupNode(node))


def pid(node, master=None):
    return slave(node, master).getPid(rospy.get_name())[2]


def is_registered(node, master=None):
    try:
        return bool((master or rosgraph.Master(rospy.get_name())).lookupNode(node))
    except rosgraph.MasterException:
        return False


def threads(process):
    """Names of its threads."""
    names = []
    for task in os.listdir(f"/proc/{process}/task"):
        try:
            with open(f"/proc/{process}/task/{task}/comm", encoding="utf-8") as file:
                names.append(file.read().strip())
        except OSError:  # it has ended
            pass
    return names


class Frozen:
    """A node that hangs, as long as the block lasts."""

    def __init__(self, node):
        self.process = pid(node)

    def __enter__(self):
        os.kill(self.process, signal.SIGSTOP)
        self.since = time.monotonic()
        return self

    def __exit__(self, *_):
        os.kill(self.process, signal.SIGCONT)


def publisher(topic, kind, *to, latch=False):
    """Connected once it is made: to all nodes in `to`, which are those that must hear it."""
    pub = rospy.Publisher(topic, kind, queue_size=10000, latch=latch, tcp_nodelay=True)
    wait_until(lambda: {connection.endpoint_id for connection in list(pub.impl.connections)} >= set(to),
               f"{to} to listen to {topic}")
    return pub


PORTS, held_ports = range(12000, 30000), []  # below those that the system gives to clients


def free_port():
    """A port for a master of one's own. It stays this process's among all tests (a locked file), and no client's connection
    can take it by chance before the master listens."""
    first = os.getpid() * 37
    for number in range(len(PORTS)):
        port = PORTS[(first + number) % len(PORTS)]
        lock = open(os.path.join(tempfile.gettempdir(), f"fmbpc_port_{port}"), "w", encoding="utf-8")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            with socket.socket() as probe:
                probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                probe.bind(("", port))
        except OSError:
            lock.close()
            continue
        held_ports.append(lock)
        return str(port)
    raise AssertionError("no free port")


def program(name):
    """Path of an executable of the build."""
    found = [p for p in roslib.packages.find_node("fmbpc", name) if os.path.basename(os.path.dirname(p)) == "fmbpc"]
    assert found, f"no executable {name} in the build"
    return found[0]


def tool(*arguments, check=True):
    return subprocess.run([program("fmbpc_tool"), *arguments], check=check, capture_output=True, text=True)


def overrides(text):
    return [word for pair in text.split() for word in ("--set", pair)]


def run_in_process(loop, folder, sets):
    tool("run", loop, "--no-plot", "--out", folder, *[word for s in sets for word in ("--set", s)])


def trajectory(folder):
    with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
        return file.read().splitlines()


def summary(folder):
    """summary.json without what depends on the speed of the machine."""
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        data = json.load(file)
    assert 0.0 < data.pop("wall_s") < time.monotonic() - LOADED
    data.pop("run_id", None)
    for key in ("median_us", "p99_us"):
        data.get("clp", {}).pop(key, None)
    return data


def assert_same_run(test, folder, reference, beyond=None):
    """Bit for bit: the CSV holds the shortest decimals that read back to the same doubles. `beyond`: events of this code in
    `folder` are its own."""
    here, there = trajectory(folder), trajectory(reference)
    test.assertEqual(here[0], there[0])
    for row, (a, b) in enumerate(zip(here, there)):
        test.assertEqual(a, b, f"row {row} of trajectory.csv")
    test.assertEqual(len(here), len(there))
    ours = summary(folder)
    if beyond:
        ours["events"] = [e for e in ours["events"] if e["code"] != beyond]
    test.assertEqual(ours, summary(reference))


def diagnostics_of(message, name):
    """Status of one node in a DiagnosticArray, None if it is not in there."""
    for status in message.status:
        if status.name.startswith(name + ":"):
            return status
    return None


def values(status):
    return {pair.key: pair.value for pair in status.values}


class NodeStatus:
    """What a node says of itself on /diagnostics."""

    def __init__(self, name):
        self.name, self.listener = name, Listener("/diagnostics", DiagnosticArray, "/" + name)

    def wait(self, fits=lambda status: True, patience=PATIENCE):
        """Its next status that fits."""
        self.listener.clear()

        def found(message):
            status = diagnostics_of(message, self.name)
            return status is not None and fits(status)
        return diagnostics_of(self.listener.wait(found, patience), self.name)

    def counts(self):
        return {k: int(v) for k, v in values(self.wait()).items() if v.isdigit()}


def action_end(client, patience=PATIENCE):
    """(state, result) of a SimpleActionClient's goal. Its own simple_state stays "pending" for ever if the answer comes before its
    send_goal() has returned; the goal's handle knows."""
    wait_until(lambda: client.gh.get_comm_state() == actionlib.CommState.DONE, "the end of the action", patience)
    return client.get_state(), client.get_result()


def tied(command):
    """The same command; its process gets a SIGTERM when the one that starts it dies, however that dies: nothing is left behind
    that waits for a master which never comes."""
    return ["setpriv", "--pdeathsig", "TERM", *command]


def runs(process):
    """False also for one that has ended and that nobody has asked for its exit code."""
    try:
        with open(f"/proc/{process}/stat", encoding="utf-8") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def end_launch(launch):
    """Ctrl-C to a roslaunch. One that does not end is a failure, and what still runs of it is printed."""
    launch.send_signal(signal.SIGINT)
    try:
        launch.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        left = subprocess.run(["ps", "-eo", "pid,ppid,stat,wchan:20,etimes,args"], capture_output=True, text=True, check=False).stdout
        print("\n".join(line[:200] for line in left.splitlines() if "__name:=" in line or "roslaunch" in line), file=sys.stderr)
        launch.kill()
        raise


def killed(process):
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
