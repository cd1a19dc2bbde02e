#!/usr/bin/python3
"""Fails if one of the nodes named lives on the master already: a launch that starts a loop beside another one of the same
names would shut that one down; or if nothing can be recorded in the folder. Usage: check_master.py [--out FOLDER] NODE...;
prints one word, or says who is there or what is wrong with the folder."""
import argparse
import fcntl
import os
import socket
import sys
import xmlrpc.client

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

import rosgraph
import rosgraph.names

CALLER = "/fmbpc_check_master"


def lives(uri):
    """True if the node at this address answers: a name may outlive its process on the master."""
    try:
        return xmlrpc.client.ServerProxy(uri).getPid(CALLER)[0] == 1
    except (OSError, xmlrpc.client.Error):
        return False


def living(names):
    master, found = rosgraph.Master(CALLER), []
    try:
        master.getPid()
    except OSError:
        return []  # no master: the launch brings its own
    for name in names:
        try:
            uri = master.lookupNode(name)
        except (OSError, rosgraph.MasterException):
            continue
        if lives(uri):
            found.append(f"{name} ({uri})")
    return found


def wrong_with(folder):
    """Why a recorder could not use it, empty if it could. Nothing is made or changed."""
    there = os.path.abspath(folder)
    while not os.path.lexists(there):
        there = os.path.dirname(there)
    if not os.path.isdir(there):
        return f"{there} is no folder"
    if not os.access(there, os.W_OK | os.X_OK):
        return f"{there} cannot be written"
    journal = os.path.join(folder, "journal.bin")
    if not os.path.exists(journal):
        return ""
    try:
        with open(journal, "r+b") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return "another loop is running with this folder"
    except OSError as error:
        return f"{journal}: {error.strerror}"
    return ""


def main():
    socket.setdefaulttimeout(3.0)
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", default="")
    parser.add_argument("nodes", nargs="*")
    arguments = parser.parse_args()
    found = living([rosgraph.names.resolve_name(name, "/") for name in arguments.nodes])
    if found:
        sys.exit("fmbpc: another loop is running here and is left alone: " + ", ".join(found))
    wrong = wrong_with(arguments.out) if arguments.out else ""
    if wrong:
        sys.exit(f"fmbpc: out:={arguments.out}: expected a folder that can be written: {wrong}")
    print("free")


if __name__ == "__main__":
    main()
