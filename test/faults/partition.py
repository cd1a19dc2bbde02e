#!/usr/bin/python3
"""Two hosts: run by scripts/partition in the network namespace of the plant; its argument is that of the controllers."""
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "ros")]
import exchange  # noqa: E402
import rosgraph  # noqa: E402

PLANT, CONTROL, STRANGER, MASTER = "10.77.0.1", "10.77.0.2", "10.77.0.3", "http://10.77.0.1:11311"
OTHER = sys.argv.pop(1) if len(sys.argv) > 1 else ""
MOVE = 0.025
SETS = ("sampling.duration_h=0 disturbance.source=constant actuator.move_upper.q_r=40 actuator.fallback.q_r=300 "
        "actuator.hold_samples=5 loop.pace=realtime loop.speedup=3600 loop.publish_clock=false loop.ready_timeout_s=600")


class Hosts:
    """Master, plant and recorder here; identifier, controller and optimizer there, started with `ip` as ROS_IP (None: with
    ROS_HOSTNAME=localhost, as on a machine of its own). Without `there` all are here, by the name localhost."""

    def __init__(self, ip, there=True):
        self.folder, self.processes = tempfile.mkdtemp(prefix="fmbpc_partition_"), []
        os.environ.update({"ROS_MASTER_URI": MASTER, "ROS_IP": PLANT} if there else
                          {"ROS_MASTER_URI": "http://localhost:11311", "ROS_HOSTNAME": "localhost"}, ROS_HOME=self.folder)
        self.start([], "rosmaster", "--core", "-p", "11311")
        exchange.wait_until(lambda: rosgraph.is_master_online(), "the master")
        text = exchange.tool("resolve", "asp_case1_clp", "--sets", SETS).stdout
        rosgraph.Master("/partition_setup").setParam("/loop_text", text)
        for node in ("plant_simulator", "loop_recorder"):
            self.start([], exchange.program(node))
        name = {"ROS_IP": ip} if ip else {"ROS_HOSTNAME": "localhost"}
        self.there = ["ip", "netns", "exec", OTHER, "env", "-u", "ROS_IP", *[f"{k}={v}" for k, v in name.items()]] if there else []
        for node in ("fuzzy_identifier", "fmbpc_controller", "clp_optimizer"):
            self.start(self.there, exchange.program(node))

    def start(self, before, *command):
        log = open(os.path.join(self.folder, os.path.basename(command[0]) + ".log"), "w", encoding="utf-8")
        environment = {**os.environ, "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1"}
        self.processes.append(subprocess.Popen([*before, *command], stdout=log, stderr=log, env=environment))
        log.close()

    def log(self, node):
        return pathlib.Path(self.folder, node + ".log").read_text(encoding="utf-8", errors="replace")

    def end(self):
        for process in reversed(self.processes):
            exchange.killed(process)


def link(state):
    subprocess.run(["ip", "link", "set", "fmbpc0", state], check=True)


def cable(whole):
    """A switch between the two that drops everything, which neither of them sees."""
    subprocess.run(["nft", "table inet cut { chain input { type filter hook input priority 0; iif fmbpc0 drop; }; }"]
                   if not whole else ["nft", "delete", "table", "inet", "cut"], check=True)


def fence(*arguments):
    subprocess.run([str(HERE.parent.parent / "scripts" / "fence"), *arguments], check=True)


def listening():
    """TCP ports of this network namespace at which somebody listens, on whatever address."""
    with open("/proc/net/tcp", encoding="utf-8") as file:
        return sorted({int(words[1].split(":")[1], 16) for words in map(str.split, file) if words[3] == "0A"})


def reachable(ports, source):
    """Those of them that accept a connection from this address of the other namespace."""
    program = ("import socket, sys\nfor port in map(int, sys.argv[3:]):\n  try:\n"
               "    socket.create_connection((sys.argv[1], port), 0.2, (sys.argv[2], 0)).close(); print(port)\n"
               "  except OSError: pass")
    done = subprocess.run(["ip", "netns", "exec", OTHER, sys.executable, "-c", program, PLANT, source, *map(str, ports)],
                          check=True, capture_output=True, text=True)
    return [int(word) for word in done.stdout.split()]


class Partition(unittest.TestCase):
    """Each test in a process of its own (one rospy node a process), see main()."""

    def begin(self, ip):
        self.hosts = Hosts(ip)
        self.addCleanup(self.hosts.end)

    def said(self, node, words, within):
        """Seconds until the log of a node holds the words."""
        start = time.monotonic()
        exchange.wait_until(lambda: words in self.hosts.log(node), f"'{words}' of {node}", within)
        return time.monotonic() - start

    def test_ten_seconds_without_a_link(self):
        import rospy
        from fault import Outcome
        from judge import Limits, bump_of, judge_inputs
        from loop_under_test import Loop
        self.begin(CONTROL)
        rospy.init_node("partition", disable_signals=True, disable_rosout=True)
        loop = Loop(["plant_simulator"])
        self.assertIsNotNone(loop.wait_for_summary("automatic", time.monotonic(), 60.0))
        loop.samples(20)
        start = time.monotonic()
        link("down")
        held = loop.wait_for_words("/plant_simulator (held|fallback|degraded): ", start, 8.0)
        fallback = loop.wait_for_summary("fallback", start, 8.0)
        time.sleep(max(0.0, start + 10.0 - time.monotonic()))
        link("up")
        healed, at = time.monotonic(), loop.now().step
        back = loop.wait_for_summary("automatic", healed, 90.0)
        self.assertIsNotNone(back)
        outcome = Outcome("partition")
        judge_inputs(loop, Limits(loop.info(), MOVE), start, outcome)
        loop.samples(20)
        print(f"cut: said after {held[0]:.1f} s ({held[1]}); healed: automatic after {back[0] - healed:.1f} s and "
              f"{back[1].step - at} samples, first move {bump_of(loop, Limits(loop.info(), MOVE), start):.2f} % of the range")
        self.assertLess(held[0], 2.0)
        self.assertIsNotNone(fallback)
        self.assertEqual([], outcome.problems)
        self.assertTrue(all(process.poll() is None for process in self.hosts.processes))

    def test_a_node_that_starts_again_while_the_link_is_cut_is_connected_soon_after(self):
        import rospy
        import links
        from loop_under_test import Loop
        self.begin(CONTROL)
        rospy.init_node("partition", disable_signals=True, disable_rosout=True)
        loop = Loop(["plant_simulator", "loop_recorder"])
        self.assertIsNotNone(loop.wait_for_summary("automatic", time.monotonic(), 60.0))
        links.remember(loop)
        cable(False)
        self.addCleanup(subprocess.run, ["nft", "delete", "table", "inet", "cut"], check=False, stderr=subprocess.DEVNULL)
        start = time.monotonic()
        recorder = next(p for p in self.hosts.processes if "loop_recorder" in p.args[-1])
        recorder.kill()
        recorder.wait()
        self.hosts.processes.remove(recorder)
        self.hosts.start([], exchange.program("loop_recorder"))
        controller = next(p for p in self.hosts.processes if "fmbpc_controller" in p.args[-1])
        time.sleep(max(0.0, start + 15.0 - time.monotonic()))
        cable(True)
        healed = time.monotonic()
        loop.nodes += ["/fmbpc_controller", "/clp_optimizer", "/fuzzy_identifier"]
        self.assertIsNone(links.whole(loop))
        print(f"cut for 15 s with a restart in it: connected {time.monotonic() - healed:.1f} s after it", end="; ")
        back = loop.wait_for_summary("automatic", healed, 20.0)
        said = dict.fromkeys((round(t - healed, 1), line) for t, line in loop.words(healed) if t < (back or [healed + 20.0])[0])
        self.assertLess(back[0] - healed, 5.0, "\n".join(f"{t} s: {line}" for t, line in said))
        print(f"automatic {back[0] - healed:.1f} s after it")
        self.assertIsNone(controller.poll())

    def test_nobody_reaches_a_loop_of_the_name_localhost(self):
        self.hosts = Hosts(None, there=False)
        self.addCleanup(self.hosts.end)
        self.said("plant_simulator", "run ", 30.0)
        ports = listening()
        self.assertGreaterEqual(len(ports), 11)  # the master's, and two of each node
        self.assertEqual([], reachable(ports, CONTROL))

    def test_only_members_pass_the_fence(self):
        self.begin(CONTROL)
        self.said("plant_simulator", "run ", 30.0)
        subprocess.run(["ip", "-n", OTHER, "addr", "add", STRANGER + "/24", "dev", "fmbpc1"], check=True)
        self.addCleanup(subprocess.run, ["ip", "-n", OTHER, "addr", "del", STRANGER + "/24", "dev", "fmbpc1"], check=False)
        ports = listening()
        self.assertEqual(ports, reachable(ports, STRANGER))
        self.addCleanup(fence, "down")
        fence("up", CONTROL)
        self.assertEqual((ports, []), (reachable(ports, CONTROL), reachable(ports, STRANGER)))
        fence("up")
        self.assertEqual(([], []), (reachable(ports, CONTROL), reachable(ports, STRANGER)))

    def test_a_wrong_address_is_said_at_both_ends(self):
        self.begin("10.99.0.9")
        there = self.said("fmbpc_controller", "no address of this machine", 10.0)
        here = self.said("plant_simulator", "is registered at http://10.99.0.9", 10.0)
        print(f"wrong ROS_IP: said there after {there:.1f} s, here after {here:.1f} s")

    def test_a_missing_address_is_said_at_both_ends(self):
        self.begin(None)
        there = self.said("fmbpc_controller", "set ROS_IP to this machine's address", 10.0)
        here = self.said("plant_simulator", "is registered at http://localhost", 10.0)
        print(f"no ROS_IP: said there after {there:.1f} s, here after {here:.1f} s")


def main():
    tests = [name for name in dir(Partition) if name.startswith("test_")]
    if len(sys.argv) > 1 or not OTHER:
        return unittest.main()
    codes = [subprocess.run([sys.executable, __file__, OTHER, f"Partition.{name}"], check=False).returncode for name in tests]
    return 1 if any(codes) else 0


if __name__ == "__main__":
    sys.exit(main())
