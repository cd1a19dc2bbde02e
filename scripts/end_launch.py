#!/usr/bin/python3
"""Node end_launch: ends the launch that started it, as Ctrl-C does, when the run is over (topic run_end). roslaunch with
a master of its own never ends by itself, and a node that is `required` is announced in red as having died. Where the
recorder is gone, it makes the run's files of the journal (`fmbpc recover`) in the folder ~out, and ends the launch when
the plant has finished and the recorder has been gone for ~patience seconds (5). One that has not answered for ~hanging
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

import rosgraph
import rospy
from fmbpc.msg import LoopState
from std_msgs.msg import String

# Debian 11's rospy asks threads by a name that its Python knows no more, and would end with a traceback.
if not hasattr(threading.Thread, "isAlive"):
    threading.Thread.isAlive = threading.Thread.is_alive


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


class Recorder:
    """Whether the run has ended, and whether the one who should record it still lives."""

    def __init__(self):
        self.name, self.plant_finished, self.gone_since, self.came = rospy.resolve_name("loop_recorder"), False, None, False
        self.hangs_since, self.process = None, 0
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
            self.came, self.gone_since, self.hangs_since, self.process = True, None, None, now or self.process

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


def ask(node):
    """The process of a node, 0 where the master is not to be asked; or what is wrong with it."""
    try:
        uri = rosgraph.Master(rospy.get_name()).lookupNode(node)
    except rosgraph.MasterException:
        return GONE
    except (OSError, xmlrpc.client.Error):
        return 0
    try:
        code, _, process = xmlrpc.client.ServerProxy(uri, transport=Impatient()).getPid(rospy.get_name())
        return process if code == 1 else GONE
    except socket.timeout:
        return HANGS
    except (OSError, xmlrpc.client.Error):
        return GONE


def kill(process, parent):
    """True if it was a child of this launch, and is killed: a process that hangs keeps its journal to itself."""
    try:
        with open(f"/proc/{process}/stat", encoding="utf-8") as stat:
            if int(stat.read().rsplit(")", 1)[1].split()[1]) != parent:
                return False
        os.kill(process, signal.SIGKILL)
        return True
    except (OSError, ValueError, IndexError):
        return False


def recover(folder):
    """The files of a journal that its recorder left behind."""
    if not os.path.isfile(os.path.join(folder, "journal.bin")):
        rospy.logerr("end_launch: the run is not recorded: %s holds no journal.bin on this machine", folder or "no folder")
        return
    done = subprocess.run(["rosrun", "fmbpc", "fmbpc", "recover", folder], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False, start_new_session=True)  # Ctrl-C is not for it
    rospy.logerr("end_launch: the recorder was gone; its journal: %s", done.stdout.strip())


def main():
    rospy.init_node("end_launch")
    parent = launcher()
    if not parent:
        rospy.logwarn("end_launch: no roslaunch has started this node: there is nothing to end")
        return 0
    socket.setdefaulttimeout(5.0)
    words, recorder = queue.Queue(), Recorder()
    rospy.Subscriber("run_end", String, words.put)
    names = ["loop_recorder", "plant_simulator", rospy.get_param("~manager", "")]  # nodelets speak with their manager's name
    ours = {rospy.resolve_name(name) for name in names if name}
    patience, folder = rospy.get_param("~patience", 5.0), rospy.get_param("~out", "")
    if rospy.get_param("~manager", ""):
        recorder.name = rospy.resolve_name(rospy.get_param("~manager"))
    while not rospy.is_shutdown():
        try:
            message = words.get(timeout=0.5)
        except queue.Empty:
            recorder.look()
            if not recorder.plant_finished:
                continue
            if recorder.hangs_for() > rospy.get_param("~hanging", 20.0):
                rospy.logerr("end_launch: %s has not answered for %.0f s: it is killed", recorder.name, recorder.hangs_for())
                if kill(recorder.process, parent):
                    recorder.hangs_since = None
                    continue
                rospy.logerr("end_launch: the run is over, but %s hangs on another machine: the launch ends; "
                             "`fmbpc recover` makes the files there", recorder.name)
                os.kill(parent, signal.SIGINT)
                return 0
            if recorder.gone_for() < patience:
                continue
            rospy.logerr("end_launch: the run is over, but %s is gone: the launch ends", recorder.name)
            recover(folder)
            os.kill(parent, signal.SIGINT)
            return 0
        if end(message._connection_header["callerid"], message.data, ours):
            os.kill(parent, signal.SIGINT)
            break
    if recorder.gone_for() > 1.0:  # not one that ends with the launch, as this node does
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
