#!/usr/bin/python3
"""Node end_launch: ends the launch that started it, as Ctrl-C does, when the run is over (topic run_end). roslaunch with
a master of its own never ends by itself, and a node that is `required` is announced in red as having died. Where the
recorder is gone, it makes the run's files of the journal (`fmbpc recover`) in the folder ~out, and ends the launch when
the plant has finished and the recorder has been gone for ~patience seconds (5). Where roslaunch itself was killed, it says so and asks
the nodes of the loop one by one to end when the run is over. One that has not answered for ~hanging
seconds (20) when the plant has finished hangs for ever: it is killed first."""
import os
import queue
import signal
import socket
import subprocess
import sys
import threading
import time
import xmlrpc.client

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

os.nice(10)  # the nodes of the loop first: they start in these moments, this one has nothing to do before the end

import rosgraph
import rospy
from fmbpc.msg import LoopState
from std_msgs.msg import String

# Debian 11's rospy asks threads by a name that its Python knows no more, and would end with a traceback.
if not hasattr(threading.Thread, "isAlive"):
    threading.Thread.isAlive = threading.Thread.is_alive


class Process:
    """A process itself, not its number, which is somebody else's once the process has ended."""

    def __init__(self, number):
        self.number = number
        self.handle = os.pidfd_open(number) if hasattr(os, "pidfd_open") else None  # Python 3.9

    def send(self, what):
        """False if it has ended."""
        try:
            if self.handle is None:
                os.kill(self.number, what)
            else:
                signal.pidfd_send_signal(self.handle, what)
        except ProcessLookupError:
            return False
        return True


def launcher():
    """The roslaunch that is the parent of this node; None if a person started the node."""
    parent = Process(os.getppid())
    try:
        uris = rosgraph.Master("/end_launch").getParam("/roslaunch/uris")
    except (OSError, rosgraph.MasterException):
        uris = {}
    for uri in uris.values():
        try:
            if xmlrpc.client.ServerProxy(uri).get_pid()[2] == parent.number == os.getppid():
                return parent
        except (OSError, xmlrpc.client.Error):
            continue
    return None


class Recorder:
    """Whether the run has ended, and whether the one who should record it still lives."""

    def __init__(self):
        self.name, self.plant_finished, self.gone_since, self.came = rospy.resolve_name("loop_recorder"), False, None, False
        self.hangs_since = None
        rospy.Subscriber("loop_state", LoopState, self.hear)

    def hear(self, state):
        if state.summary:
            self.plant_finished = state.reason.startswith("finished")
            self.came = self.came or state.mode != LoopState.STARTING  # it was ready before sample 0
        if state.node == self.name:
            self.came, self.gone_since, self.hangs_since = True, None, None

    def look(self):
        """Silent is not gone: one that writes a long record does not speak, but its process answers."""
        begun, now = time.monotonic(), ask(self.name)
        if now == HANGS:
            self.gone_since, self.hangs_since = None, self.hangs_since or begun
        elif now == GONE:
            self.gone_since, self.hangs_since = self.gone_since or (begun if self.came else None), None
        else:
            self.came, self.gone_since, self.hangs_since = True, None, None

    def gone_for(self):
        return seconds_since(self.gone_since)

    def hangs_for(self):
        return seconds_since(self.hangs_since)


def seconds_since(begin):
    return 0.0 if begin is None else time.monotonic() - begin


class Impatient(xmlrpc.client.Transport):
    """rospy sets the time-out of all sockets to a minute whenever it connects a topic."""

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = 2.0
        return connection


GONE, HANGS = "gone", "hangs"
STARTED = ("plant_simulator", "plant_gateway", "fmbpc_controller", "clp_optimizer", "target_optimizer", "fuzzy_identifier", "loop_recorder", "plot_live")


def ask(node):
    """What is wrong with a node; empty if nothing is, or if the master is not to be asked."""
    try:
        uri = rosgraph.Master(rospy.get_name()).lookupNode(node)
    except rosgraph.MasterException:
        return GONE
    except (OSError, xmlrpc.client.Error):
        return ""
    try:
        code = xmlrpc.client.ServerProxy(uri, transport=Impatient()).getPid(rospy.get_name())[0]
        return "" if code == 1 else GONE
    except socket.timeout:
        return HANGS
    except (OSError, xmlrpc.client.Error):
        return GONE


def child(parent, node):
    """The process of a node among those that the launch has started on this machine; None if it is not there."""
    name = b"__name:=" + node.rsplit("/", 1)[-1].encode()

    def is_it(number):
        try:
            with open(f"/proc/{number}/stat", encoding="utf-8") as stat, open(f"/proc/{number}/cmdline", "rb") as line:
                return int(stat.read().rsplit(")", 1)[1].split()[1]) == parent.number == os.getppid() and name in line.read().split(b"\0")
        except OSError:  # it has just ended
            return False
    for number in filter(is_it, filter(str.isdigit, os.listdir("/proc"))):
        found = Process(int(number))
        if is_it(number):  # still: then it is the one that is held
            return found
    return None


def killed(recorder, parent):
    """True if one that hangs, and keeps its journal to itself, was killed; False if it is on another machine."""
    process, seconds = child(parent, recorder.name), recorder.hangs_for()
    if not process:
        rospy.logerr("end_launch: %s has not answered for %.0f s: the launch ends; on its machine `fmbpc recover` makes the files",
                     recorder.name, seconds)
        return False
    rospy.logerr("end_launch: %s has not answered for %.0f s: it is killed", recorder.name, seconds)
    process.send(signal.SIGKILL)
    recorder.hangs_since = None
    for _ in range(100):  # its journal is free when it has ended
        if not process.send(0):
            break
        time.sleep(0.05)
    return True


def recover(folder):
    """The files of a journal that its recorder left behind."""
    if not os.path.isfile(os.path.join(folder, "journal.bin")):
        rospy.logerr("end_launch: the run is not recorded: %s holds no journal.bin on this machine", folder or "no folder")
        return
    done = subprocess.run(["rosrun", "fmbpc", "fmbpc", "recover", folder], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False, start_new_session=True)  # Ctrl-C is not for it
    rospy.logerr("end_launch: the recorder was gone; its journal: %s", done.stdout.strip())


def end_launch(parent, ours):
    """As Ctrl-C does. This node ends by itself: rospy cannot be interrupted while it says its last. A parent that has ended is
    no parent any more, whoever has its number now: then the nodes are asked to end, as `rosnode kill` does."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if os.getppid() == parent.number and parent.send(signal.SIGINT):
        return
    for node in sorted(ours):
        try:
            uri = rosgraph.Master(rospy.get_name()).lookupNode(node)
            xmlrpc.client.ServerProxy(uri, transport=Impatient()).shutdown(rospy.get_name(), "the run is over")
        except (OSError, xmlrpc.client.Error, rosgraph.MasterException):
            continue  # it has ended, or never was


def main():
    parent = launcher()  # before anybody sees the node: the launch may be killed at any time from then on
    rospy.init_node("end_launch")
    if not parent:
        rospy.logwarn("end_launch: no roslaunch has started this node: there is nothing to end")
        return 0
    socket.setdefaulttimeout(5.0)
    words, recorder = queue.Queue(), Recorder()
    rospy.Subscriber("run_end", String, words.put)
    names = ["loop_recorder", "plant_simulator", rospy.get_param("~manager", "")]  # nodelets speak with their manager's name
    ours = {rospy.resolve_name(name) for name in names if name}
    started = {rospy.resolve_name(name) for name in (*STARTED, rospy.get_param("~manager", "")) if name}
    patience, folder = rospy.get_param("~patience", 5.0), rospy.get_param("~out", "")
    if rospy.get_param("~manager", ""):
        recorder.name = rospy.resolve_name(rospy.get_param("~manager"))
    orphaned = False
    while not rospy.is_shutdown():
        try:
            message = words.get(timeout=0.5)
        except queue.Empty:
            if os.getppid() != parent.number and not orphaned:
                orphaned = True
                rospy.logerr("end_launch: the roslaunch of this loop was killed: nobody starts its nodes again; they are ended "
                             "when the run is over")
            recorder.look()
            if not recorder.plant_finished:
                continue
            if recorder.hangs_for() > rospy.get_param("~hanging", 20.0):
                if killed(recorder, parent):
                    continue
                end_launch(parent, started)
                return 0
            if recorder.gone_for() < patience:
                continue
            rospy.logerr("end_launch: the run is over, but %s is gone: the launch ends", recorder.name)
            recover(folder)
            end_launch(parent, started)
            return 0
        if end(message._connection_header["callerid"], message.data, ours):
            end_launch(parent, started)
            break
    # Not one that ends with the launch, as this node does.
    if recorder.gone_for() > 1.0 or (recorder.hangs_for() > 1.0 and killed(recorder, parent)):
        recover(folder)
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
