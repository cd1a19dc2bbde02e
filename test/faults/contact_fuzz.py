#!/usr/bin/python3
"""Six nodes on a master of their own, and a stranger who connects to their ports: known killers first, then contacts made at
random of TCPROS headers, XMLRPC requests, services and publishers that answer rubbish. Fails if a node ends or grows, or if one
listens on other addresses than the loopback.

    contact_fuzz.py [SECONDS [SEED]]    default: 5 s; NODES in the environment: a folder with the nodes of another build (scripts/contacts)
"""
import itertools
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "ros")]
import contacts  # noqa: E402
import exchange  # noqa: E402
import rosgraph  # noqa: E402

ME = "/contact_fuzz"
NODES = os.environ.get("NODES")
MOST = 1200 if NODES else 400  # MB of a node, at any time; sanitizers keep what was freed for a while
LOOPS = {"": ("asp_case1_clp", "sampling.duration_h=0 disturbance.source=constant loop.pace=realtime loop.speedup=3600 loop.publish_clock=false",
              ("plant_simulator", "fmbpc_controller", "clp_optimizer", "fuzzy_identifier", "loop_recorder")),
         "/behind": ("example_external", "setpoint.schedule=[] sampling.duration_h=0 loop.ready_timeout_s=100000", ("plant_gateway",))}


class Nodes:
    """Their processes, and the ports that they can be reached at."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="fmbpc_contacts_")
        os.environ.update(ROS_MASTER_URI=f"http://localhost:{exchange.free_port()}", ROS_HOME=self.folder)
        self.processes, self.master = {}, self.start("rosmaster", "--core", "-p", os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1])
        try:
            self.begin()
        except BaseException:
            self.end()
            raise

    def begin(self):
        exchange.wait_until(rosgraph.is_master_online, "the master")
        master = rosgraph.Master(ME)
        for space, (loop, sets, nodes) in LOOPS.items():
            master.setParam(space + "/loop_text", exchange.tool("resolve", loop, "--sets", sets).stdout)
            for node in nodes:
                name = f"{space}/{node}"
                self.processes[name] = self.start(os.path.join(NODES, node) if NODES else exchange.program(node), "__ns:=" + (space or "/"))
        for name in self.processes:
            exchange.wait_until(lambda n=name: self.known(n), f"{name} (see {self.folder})")
        self.ports = {name: contacts.ports(master.lookupNode(name)) for name in self.processes}

    def known(self, name):
        try:
            return rosgraph.Master(ME).lookupNode(name)
        except rosgraph.MasterException:
            return None

    def start(self, *command):
        with open(os.path.join(self.folder, os.path.basename(command[0]) + ".log"), "w", encoding="utf-8") as log:
            return subprocess.Popen(command, stdout=log, stderr=log)

    def dead(self):
        return [name for name, process in self.processes.items() if process.poll() is not None]

    def answer(self):
        """Those that do not answer any more."""
        silent = []
        for name in self.processes:
            try:
                if xmlrpc.client.ServerProxy("http://%s:%d" % self.ports[name]["xmlrpc"]).getPid(ME)[0] != 1:
                    silent.append(name)
            except OSError:
                silent.append(name)
        return silent

    def largest(self):
        """The largest that one of them has ever been [MB]."""
        sizes = [pathlib.Path(f"/proc/{p.pid}/status").read_text().split("VmHWM:")[1].split()[0]
                 for p in self.processes.values() if p.poll() is None]
        return max((int(size) >> 10 for size in sizes), default=0)

    def open_to_all(self):
        """Addresses that they listen on and that are not the loopback's."""
        with open("/proc/net/tcp", encoding="utf-8") as file:
            listening = {words[9]: words[1] for words in map(str.split, file) if words[3] == "0A"}
        found = []
        for name, process in self.processes.items():
            for descriptor in pathlib.Path(f"/proc/{process.pid}/fd").iterdir():
                try:
                    at = listening.get(os.readlink(descriptor)[len("socket:["):-1])
                except OSError:  # closed meanwhile
                    continue
                if at and not at.startswith("0100007F"):
                    found.append(f"{name} listens at {at}")
        return found

    def end(self):
        for process in [*self.processes.values(), self.master]:
            if process.poll() is None:
                process.kill()
            process.wait()


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 5.0
    chance = random.Random(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    nodes, killed, count = Nodes(), [], 0
    liar = contacts.Liar(chance.random())
    liar.start()
    try:
        killed += nodes.open_to_all()
        for node in nodes.processes:
            for words, port, data in contacts.killers(node):
                if nodes.processes[node].poll() is not None:
                    break
                contacts.send(nodes.ports[node][port], data, answer=port == "tcpros")
                time.sleep(0.03)
                count += 1
                if nodes.processes[node].poll() is not None:
                    killed.append(f"{node} was killed ({nodes.processes[node].returncode}) by: {words}")
        end = time.monotonic() + seconds
        for node in itertools.cycle(nodes.processes):
            if time.monotonic() > end or nodes.dead():
                break
            for _ in range(20):
                port, data = contacts.random_contact(chance, node, liar.uri)
                contacts.send(nodes.ports[node][port], data, answer=chance.randrange(20) == 0)
                count += 1
        time.sleep(0.5)
        killed += [f"{node} ended ({nodes.processes[node].returncode})" for node in nodes.dead()]
        killed += [f"{node} does not answer any more" for node in nodes.answer() if node not in nodes.dead()]
        if nodes.largest() > MOST:
            killed.append(f"a node grew to {nodes.largest()} MB")
        print("\n".join(killed + [f"{count} contacts, {len(killed)} problems, largest node {nodes.largest()} MB"]))
    finally:
        nodes.end()
    return 1 if killed else 0


if __name__ == "__main__":
    sys.exit(main())
