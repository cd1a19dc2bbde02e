#!/usr/bin/python3
"""Fails if one of the nodes named lives on the master already: a launch that starts a loop beside another one of the same
names would shut that one down. Usage: check_master.py NODE...; prints one word, or says who is there."""
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


def main():
    socket.setdefaulttimeout(3.0)
    found = living([rosgraph.names.resolve_name(name, "/") for name in sys.argv[1:]])
    if found:
        sys.exit("fmbpc: another loop is running here and is left alone: " + ", ".join(found))
    print("free")


if __name__ == "__main__":
    main()
