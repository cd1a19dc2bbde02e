"""Connections that are taken away: every node must have them again within five seconds of the end of the cause, or say what is
missing."""
import os
import resource
import time
import xmlrpc.client

import contacts
from fault import Fault

ME = "/fault_matrix"
PLANT, CONTROLLER, OPTIMIZER, RECORDER, IDENTIFIER = NODES = (
    "plant_simulator", "fmbpc_controller", "clp_optimizer", "loop_recorder", "fuzzy_identifier")
MANAGER = "loop_manager"
MENDED = 5.0  # s


def needs(node):
    """An identifier that the loop does not need is idle, and no member."""
    return ("nodelets",) if node == MANAGER else ("processes", *[what for of, what in ((OPTIMIZER, "optimizer"), (IDENTIFIER, "model"))
                                                                 if of == node])


def proxy(loop, node):
    return xmlrpc.client.ServerProxy(loop.master.lookupNode("/" + loop.name(node)))


def missing(loop, node):
    """Registrations and connections of a node of the loop that should be there, in words."""
    published, subscribed, _ = ({topic: names for topic, names in kind} for kind in loop.master.getSystemState())
    try:
        own = proxy(loop, node)
        publications, subscriptions, info = (call(ME)[2] for call in (own.getPublications, own.getSubscriptions, own.getBusInfo))
    except (OSError, Exception) as error:  # pylint: disable=broad-except
        return [f"{node}: {type(error).__name__}"]
    name, links = "/" + node, {(link[4], link[1]) for link in info if link[2] == "i"}
    lost = [f"{node} is not registered for {topic}" for topics, by in ((publications, published), (subscriptions, subscribed))
            for topic, _ in topics if name not in by.get(topic, [])]
    for topic, _ in subscriptions:
        lost += [f"{node} does not hear {topic} of {other}" for other in published.get(topic, [])
                 if other in loop.nodes and other != name and (topic, loop.master.lookupNode(other)) not in links]
    lost += [f"nobody publishes {topic} for {node}" for topic in loop.spoken.get(node, []) if not published.get(topic)]
    return lost


def remember(loop):
    """Topics that a node hears before the fault."""
    loop.spoken = {}
    published = {topic for topic, _ in loop.master.getSystemState()[0]}
    for node in (name.lstrip("/") for name in loop.nodes):
        loop.spoken[node] = [topic for topic, _ in proxy(loop, node).getSubscriptions(ME)[2] if topic in published]


def whole(loop):
    """All nodes of the loop are connected as they should be, in time; otherwise what is missing."""
    end = time.monotonic() + MENDED
    while True:
        lost = [words for node in loop.nodes for words in missing(loop, node.lstrip("/"))]
        if not lost:
            return None
        if time.monotonic() > end:
            return f"not mended within {MENDED:.0f} s: " + "; ".join(lost[:4])
        time.sleep(0.1)


def forget_publishers(loop, node):
    """Somebody tells a node that nobody publishes what it hears."""
    remember(loop)
    own = proxy(loop, node)
    for topic, _ in own.getSubscriptions(ME)[2]:
        own.publisherUpdate(ME, topic, [])


def forged(node):
    return Fault(f"{node}: publisherUpdate with empty lists", lambda loop: forget_publishers(loop, node), whole,
                 needs=needs(node), own_hand=node == PLANT, gap=True)


def clean_up(loop, node):
    """What `rosnode cleanup` does with a node that does not answer."""
    remember(loop)
    loop.freeze(node)
    name, master = "/" + loop.name(node), xmlrpc.client.ServerProxy(os.environ["ROS_MASTER_URI"])
    uri = loop.master.lookupNode(name)
    published, subscribed, services = loop.master.getSystemState()
    for topics, forget in ((published, master.unregisterPublisher), (subscribed, master.unregisterSubscriber)):
        for topic, names in topics:
            if name in names:
                forget(name, topic, uri)
    for service, names in services:
        if name in names:
            master.unregisterService(name, service, loop.master.lookupService(service))


def thaw(loop):
    loop.thaw()
    return whole(loop)


def cleaned(node):
    return Fault(f"rosnode cleanup while {node} hangs for 3 s", lambda loop: clean_up(loop, node), thaw, needs=needs(node),
                 lasts=3.0, own_hand=node == PLANT, gap=True)


def connections(process):
    """Both ends of its TCP connections, by descriptor."""
    with open("/proc/net/tcp", encoding="utf-8") as file:
        ends = {f"socket:[{words[9]}]": (words[1], words[2]) for words in map(str.split, file)}
    folder = f"/proc/{process}/fd"
    links = {int(name): os.readlink(os.path.join(folder, name)) for name in os.listdir(folder)}
    return {number: ends[link] for number, link in links.items() if link in ends}


def use_up(loop, node, left):
    """So many file descriptors are left to a node; those do not help that are free once somebody whom it hears has died, who
    is started again."""
    remember(loop)
    loop.starved = loop.pid("/" + loop.name(node))
    loop.descriptors = resource.prlimit(loop.starved, resource.RLIMIT_NOFILE)
    open_now = {int(name) for name in os.listdir(f"/proc/{loop.starved}/fd")}
    free = next(number for number in range(len(open_now) + 1) if number not in open_now)
    theirs = {(there, here) for here, there in connections(loop.pid("/" + CONTROLLER)).values()}
    shared = [number for number, ends in connections(loop.starved).items() if ends in theirs]
    resource.prlimit(loop.starved, resource.RLIMIT_NOFILE, (min([free, *shared]) + left, loop.descriptors[1]))
    loop.kill(CONTROLLER)


def give_back(loop):
    resource.prlimit(loop.starved, resource.RLIMIT_NOFILE, loop.descriptors)
    return whole(loop)


def starved(node, left):
    return Fault(f"{node}: {'one' if left else 'no'} file descriptor is left while the controller is killed",
                 lambda loop: use_up(loop, node, left), give_back,
                 said=f"/{node} .*(no connection can be made|not connected)", said_within=5.0, touches=(CONTROLLER,), lasts=2.0)


def contacted(node):
    """A stranger sends to its ports what once ended a node at first contact."""
    def do(loop):
        name = "/" + loop.name(node)
        ports = contacts.ports(loop.master.lookupNode(name))
        for _, port, data in contacts.killers(name):
            contacts.send(ports[port], data, answer=port == "tcpros")
    return Fault(f"{node}: bytes that once ended nodes", do, needs=needs(node), lasts=1.0)


FAULTS = [make(node) for make in (forged, contacted) for node in (*NODES, MANAGER)] + [cleaned(node) for node in NODES] + [
    starved(node, left) for node in (RECORDER, PLANT) for left in (0, 1)]
