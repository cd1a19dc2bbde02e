#!/usr/bin/python3
"""Faults of a running loop as its operator sees them: each is one alarm within two seconds, with what to do, and goes once it is over."""
import http.client
import json
import math
import random
import sys
import tempfile
import threading
import time
import unittest

import rospy
import rostest
from fmbpc.msg import LoopState, Measurement, PlantInfo, Setpoint

import panel_page
import exchange

SOON = 2.0  # s of wall time
ACTIVE = ("unacknowledged", "acknowledged")


class Alarms:
    """What the panel says to a browser: the latest list, and when each alarm was in one for the first time."""

    def __init__(self, port):
        self.events, self.now, self.came = {}, [], {}
        self.answer = http.client.HTTPConnection("localhost", port)
        self.answer.request("GET", "/stream")
        self.lines = self.answer.getresponse()
        threading.Thread(target=self.read, daemon=True).start()
        exchange.wait_until(lambda: self.events, "the list of events")

    def read(self):
        kind = b""
        for line in self.lines:
            if line.startswith(b"event: "):
                kind = line[7:].strip()
            elif line.startswith(b"data: ") and kind == b"alarms":
                self.now = json.loads(line[6:])
                for key in self.active():
                    self.came.setdefault(key, time.monotonic())
            elif line.startswith(b"data: ") and kind == b"hello":
                self.events = json.loads(line[6:])["events"]

    def active(self):
        return {(a["code"], a["signal"]) for a in self.now if a["state"] in ACTIVE}


class Faults(unittest.TestCase):
    """One after another in one loop, in the order of their numbers; the last test judges how all of them went."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.spoil, cls.first_spoilt, cls.reported, cls.shown = None, None, {}, {}
        cls.measurement = rospy.Publisher("measurement", Measurement, queue_size=100, tcp_nodelay=True)
        cls.info = rospy.Publisher("plant_info", PlantInfo, queue_size=10, latch=True)
        cls.true_info = rospy.Subscriber("plant_info_true", PlantInfo, cls.info.publish, tcp_nodelay=True)
        cls.true = rospy.Subscriber("measurement_true", Measurement, cls.pass_on, tcp_nodelay=True)
        cls.setpoint = exchange.publisher("setpoint", Setpoint, "/fmbpc_controller")
        cls.states = exchange.Listener("loop_state", LoopState, "/plant_simulator", "/fmbpc_controller")
        cls.reports = rospy.Subscriber("loop_state", LoopState, cls.report, tcp_nodelay=True)
        heard = exchange.Listener("measurement_true", Measurement)
        heard.wait(lambda m: m.step >= 140)  # nothing is left of the start, and the noise of s is known
        cls.panel = panel_page.PanelProcess(exchange.free_port(), cls.folder.name)
        cls.alarms = Alarms(cls.panel.port)
        exchange.wait_until(lambda: cls.panel.get("/api/model", loop="/") is not None, "the panel to find the loop")

    @classmethod
    def tearDownClass(cls):
        cls.panel.kill()
        cls.folder.cleanup()

    @classmethod
    def pass_on(cls, message):
        noise = random.Random(message.step).gauss(0.0, 0.05)
        message.outputs = [message.outputs[0] + noise, *message.outputs[1:]]
        if cls.spoil is not None:
            cls.first_spoilt = cls.first_spoilt or time.monotonic()
            cls.spoil(message)
        cls.measurement.publish(message)

    @classmethod
    def report(cls, message):
        for code in (message.code, *[e.code for e in message.events if e.last + 2 >= message.step]):
            cls.reported.setdefault(code, time.monotonic())

    def setUp(self):
        self.before = self.alarms.active()
        self.alarms.came.clear()
        self.reported.clear()

    def is_one_alarm(self, code, signal, since):
        """since: when it began, or was reported; of its consequences nothing is said."""
        exchange.wait_until(lambda: (code, signal) in self.alarms.came, f"{code} {signal}, there is {self.alarms.active()}", 20.0)
        self.assertLess(self.alarms.came[(code, signal)] - since(), SOON)
        time.sleep(2.0)  # while it lasts nothing comes or goes
        self.assertEqual({(code, signal)}, self.alarms.active() - self.before)
        self.assertIn(self.alarms.events[code]["severity"], ("warning", "error"))
        self.assertNotIn(self.alarms.events[code]["remedy"], ("", "none"))
        self.shown[(code, signal)] = 1

    def is_over(self):
        """Nothing else was said until the loop is in order again."""
        self.states.clear()
        self.states.wait(lambda s: s.summary and s.word == "automatic" and not s.code)
        self.assertLessEqual(set(self.alarms.came) - self.before, set(self.shown))

    def spoilt(self, code, signal, spoil):
        """spoil: changes a measurement."""
        type(self).first_spoilt = None
        type(self).spoil = staticmethod(spoil)
        try:
            self.is_one_alarm(code, signal, lambda: self.first_spoilt)
        finally:
            type(self).spoil = None
        self.is_over()

    @staticmethod
    def put(field, index, value):
        def spoil(message):
            values = list(getattr(message, field))
            values[index] = value(values[index]) if callable(value) else value
            setattr(message, field, values)
        return spoil

    def test_01_a_reading_that_is_frozen(self):
        """At its last value, whatever that is: one far from its own noise has jumped first."""
        last = []

        def spoil(message):
            last.append(message.outputs[0])
            message.outputs = [last[0], *message.outputs[1:]]
        self.spoilt("signal_frozen", "s", spoil)

    def test_02_a_reading_that_is_no_number(self):
        self.spoilt("signal_missing", "s", self.put("outputs", 0, math.nan))

    def test_03_a_link_that_is_stale(self):
        def spoil(message):
            message.quality = bytes([0, 1] + [0] * len(message.disturbances))
        self.spoilt("signal_missing", "x", spoil)

    def test_04_a_reading_out_of_range(self):
        self.spoilt("signal_out_of_range", "s", self.put("outputs", 0, 9e4))

    def test_05_a_reading_that_jumps(self):
        up = [400.0, -400.0]
        self.spoilt("signal_jumped", "x", self.put("outputs", 1, lambda v: v + up[int(time.monotonic() * 5) % 2]))

    def test_06_a_reading_that_is_too_fast(self):
        self.spoilt("signal_too_fast", "s", self.put("outputs", 0, lambda v: v + (60.0 if int(time.monotonic() * 5) % 2 else 0.0)))

    def frozen(self, node, signal):
        with exchange.Frozen(node) as fault:
            self.is_one_alarm("node_silent", signal, lambda: fault.since)
        self.is_over()

    def test_07_an_optimizer_that_hangs(self):
        self.frozen("/clp_optimizer", "clp_optimizer")

    def test_08_a_controller_that_hangs(self):
        self.frozen("/fmbpc_controller", "fmbpc_controller")

    def test_09_a_plant_that_hangs(self):
        self.frozen("/plant_simulator", "plant")

    def asked(self, code, signal, setpoint, since):
        self.setpoint.publish(Setpoint(name=["x"], value=[setpoint], mode=Setpoint.OVERRIDE))
        try:
            self.is_one_alarm(code, signal, since)
        finally:
            self.setpoint.publish(Setpoint(mode=Setpoint.RELEASE))
        self.is_over()

    def test_10_a_setpoint_beyond_its_limits(self):
        began = time.monotonic()
        self.asked("setpoint_clamped", "x", 9000.0, lambda: began)

    def test_11_a_process_where_the_model_has_no_data(self):
        self.spoilt("outside_model", "", self.put("disturbances", 1, 1300.0))

    def test_12_an_optimizer_without_a_solution(self):
        self.asked("qp_not_solved", "", 1000.0, lambda: self.reported["qp_not_solved"])

    def test_13_all_of_them_have_gone_and_came_once(self):
        exchange.wait_until(lambda: not self.alarms.active(), f"the end of {self.alarms.active()}", 30.0)
        self.assertEqual(self.shown, {(a["code"], a["signal"]): a["count"] for a in self.alarms.now})
        self.assertEqual({"returned"}, {a["state"] for a in self.alarms.now})


if __name__ == "__main__":
    rospy.init_node("operator_alarms")
    rostest.rosrun("fmbpc", "operator_alarms", Faults, sys.argv)
