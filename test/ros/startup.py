#!/usr/bin/python3
"""Sample 0 waits for everybody. Nodes are started one by one here, the loop text is on the parameter server."""
import os
import socketserver
import subprocess
import sys
import threading
import time
import unittest
import xmlrpc.client
import xmlrpc.server

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fmbpc.msg import LoopState, Measurement, NodeReady
from std_msgs.msg import String

import exchange


class SlowMaster(socketserver.ThreadingMixIn, xmlrpc.server.SimpleXMLRPCServer):
    """The master, who takes long for publishers of one topic."""
    daemon_threads = True

    def __init__(self, topic, seconds):
        super().__init__(("localhost", 0), logRequests=False, allow_none=True)
        self.topic, self.seconds, self.asked = topic, seconds, 0
        self.uri = f"http://localhost:{self.server_address[1]}"
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def _dispatch(self, method, parameters):
        if method == "registerPublisher" and parameters[1] == self.topic:
            self.asked += 1
            time.sleep(self.seconds)
        return getattr(xmlrpc.client.ServerProxy(os.environ["ROS_MASTER_URI"]), method)(*parameters)


class Startup(unittest.TestCase):
    def setUp(self):
        self.processes = []

    def tearDown(self):
        for process in self.processes:
            exchange.killed(process)

    def start(self, name, *arguments, **options):
        process = subprocess.Popen(exchange.tied([exchange.program(name), *arguments]), **options)
        self.processes.append(process)
        return process

    def wait_for_status(self, name, level, words):
        listener = exchange.Listener("/diagnostics", DiagnosticArray, "/" + name)

        def fits(message):
            status = exchange.diagnostics_of(message, name)
            return status is not None and status.level == level and words in status.message
        listener.wait(fits)

    def test_what_a_test_starts_ends_with_it(self):
        """Killed from outside, it cleans up nothing."""
        lines = "import subprocess, sys; print(subprocess.Popen(sys.argv[1:]).pid, flush=True); sys.stdin.read()"
        test = subprocess.Popen([sys.executable, "-c", lines, *exchange.tied(["sleep", "600"])], stdin=subprocess.PIPE,
                                stdout=subprocess.PIPE, text=True)
        with test:
            child = int(test.stdout.readline())
            exchange.wait_until(lambda: exchange.threads(child) == ["sleep"], "the child to begin")
            test.kill()
        exchange.wait_until(lambda: not exchange.runs(child), "the child to end")

    def test_a_missing_node_is_named_and_the_plant_ends(self):
        """Whoever says of another that it is ready is not believed."""
        ready = rospy.Publisher("impatient/ready", NodeReady, queue_size=1, latch=True)
        ready.publish(node="/impatient/fuzzy_identifier")
        plant = self.start("plant_simulator", "__ns:=impatient", stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                           text=True)
        text, _ = plant.communicate(timeout=exchange.PATIENCE)
        self.assertEqual(1, plant.returncode)
        self.assertIn("not ready within loop.ready_timeout_s = 3 s: /impatient/fmbpc_controller, "
                      "/impatient/fuzzy_identifier, /impatient/loop_recorder\n", text.replace("\x1b[0m", ""))
        self.assertIn(f"ready of {rospy.get_name()} dropped: it speaks for /impatient/fuzzy_identifier", text)

    def test_members_that_read_another_loop_do_not_join(self):
        text = rospy.get_param("divided/loop_text")
        rospy.set_param("divided/fuzzy_identifier/loop_text", text.replace("duration_h: 2", "duration_h: 3"))
        ready = rospy.Publisher("divided/ready", NodeReady, queue_size=1, latch=True)
        ready.publish(node=rospy.get_name(), loop_digest="of another text")
        for name in ("plant_simulator", "fuzzy_identifier"):
            self.start(name, "__ns:=divided")
        self.wait_for_status("divided/plant_simulator", DiagnosticStatus.WARN,
                             "waiting for /divided/fuzzy_identifier, /startup; another loop_text is read by /startup")
        self.wait_for_status("divided/fuzzy_identifier", DiagnosticStatus.ERROR,
                             "plant_info: the plant reads another loop_text than this node")

    def test_a_plc_where_nobody_answers_is_named_at_once_and_the_plant_ends(self):
        for host, port, why in (("127.0.0.1", exchange.free_port(), "Connection refused"),
                                ("no-such-plc.invalid", 502, "no such host is known")):
            sets = [f"gateway.modbus.host={host}", f"gateway.modbus.port={port}", "loop.ready_timeout_s=4"]
            text = exchange.tool("resolve", "cstr_modbus", "--sets", " ".join(sets)).stdout
            rospy.set_param("lonely/loop_text", text)
            begun = time.monotonic()
            gateway = self.start("plant_gateway", "__ns:=lonely", stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            words = f"no connection to {host}:{port}: {why}"
            self.assertIn(words, gateway.stderr.readline())
            self.assertLess(time.monotonic() - begun, 5.0)
            rest = gateway.stderr.read()
            self.assertEqual(1, gateway.wait(exchange.PATIENCE))
            self.assertIn(f"the plant ({words}), ", rest)

    def test_a_controller_without_a_model_is_not_ready_and_one_that_joins_late_finds_sample_0(self):
        measurements, recorded = (exchange.Listener(topic, kind, connected=False)
                                  for topic, kind in (("measurement", Measurement), ("recorded", String)))
        ready = exchange.Listener("ready", NodeReady, connected=False)
        self.start("plant_simulator")
        self.start("loop_recorder")
        self.wait_for_status("plant_simulator", DiagnosticStatus.WARN,
                             "waiting for /fmbpc_controller, /fuzzy_identifier, /loop_recorder")
        self.start("fmbpc_controller")
        self.wait_for_status("fmbpc_controller", DiagnosticStatus.WARN, "waiting for fuzzy_model")
        self.assertNotIn("/fmbpc_controller", [m.node for m in ready.messages])
        self.assertEqual([], measurements.messages)
        self.start("fuzzy_identifier")
        recorded.wait()
        self.assertEqual({"/fmbpc_controller", "/fuzzy_identifier", "/loop_recorder"}, {m.node for m in ready.messages})
        exchange.wait_until(lambda: measurements.messages and measurements.messages[-1].step == 10, "the last sample, on a connection of its own")
        self.assertEqual(list(range(11)), [m.step for m in measurements.messages])

    def test_a_registration_that_takes_long_is_not_taken_for_a_lost_one(self):
        master = SlowMaster("/slow/loop_state", 4.0)
        self.addCleanup(master.shutdown)
        self.start("loop_recorder", "__ns:=slow", env={**os.environ, "ROS_MASTER_URI": master.uri}, stderr=subprocess.DEVNULL)
        states = exchange.Listener("slow/loop_state", LoopState, connected=False)
        exchange.wait_until(lambda: len(states.messages) > 8, "its states, two a second, which go on through two looks at the master")
        self.assertEqual(1, master.asked)

    def test_nodes_that_the_loop_does_not_need_say_so_and_end(self):
        for name, reason in (("clp_optimizer", "has no section clp"),):
            done = subprocess.run([exchange.program(name)], capture_output=True, text=True, timeout=exchange.PATIENCE, check=True)
            self.assertIn(reason, done.stdout)

    def test_a_node_without_a_loop_says_what_it_misses(self):
        rospy.set_param("empty/loop_text", "")
        done = subprocess.run([exchange.program("plant_simulator"), "__ns:=empty"], capture_output=True, text=True,
                              timeout=exchange.PATIENCE, check=False)
        self.assertEqual(1, done.returncode)
        self.assertIn("plant_simulator: ", done.stderr)


if __name__ == "__main__":
    rospy.init_node("startup")
    rostest.rosrun("fmbpc", "startup", Startup, sys.argv)
