#!/usr/bin/python3
"""Faults of a running loop as its operator sees them: each is one alarm within two seconds, with what to do, and goes once it is over."""
import http.client
import json
import math
import sys
import tempfile
import threading
import time
import unittest

import rospy
import rostest
from fmbpc.msg import Measurement, PlantInfo

import panel_page
import ring

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
        ring.wait_until(lambda: self.events, "the list of events")

    def read(self):
        kind = b""
        for line in self.lines:
            if line.startswith(b"event: "):
                kind = line[7:].strip()
            elif line.startswith(b"data: ") and kind == b"alarms":
                self.now = json.loads(line[6:])
                for alarm in self.active():
                    self.came.setdefault((alarm["code"], alarm["signal"]), time.monotonic())
            elif line.startswith(b"data: ") and kind == b"hello":
                self.events = json.loads(line[6:])["events"]

    def active(self):
        return [a for a in self.now if a["state"] in ACTIVE]


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.spoil, cls.first_spoilt = None, None
        cls.measurement = rospy.Publisher("measurement", Measurement, queue_size=100, tcp_nodelay=True)
        cls.info = rospy.Publisher("plant_info", PlantInfo, queue_size=10, latch=True)
        cls.true_info = rospy.Subscriber("plant_info_true", PlantInfo, cls.info.publish, tcp_nodelay=True)
        cls.true = rospy.Subscriber("measurement_true", Measurement, cls.pass_on, tcp_nodelay=True)
        cls.panel = panel_page.PanelProcess(ring.free_port(), cls.folder.name)
        cls.alarms = Alarms(cls.panel.port)
        heard = ring.Listener("measurement_true", Measurement)
        heard.wait(lambda m: m.step >= 50)  # of the start nothing is left

    @classmethod
    def tearDownClass(cls):
        cls.panel.kill()
        cls.folder.cleanup()

    @classmethod
    def pass_on(cls, message):
        if cls.spoil is not None:
            cls.first_spoilt = cls.first_spoilt or time.monotonic()
            cls.spoil(message)
        cls.measurement.publish(message)

    def setUp(self):
        ring.wait_until(lambda: not self.alarms.active(), f"no alarm, there is {self.alarms.active()}", 75.0)  # twice within a minute: it stays for one
        self.alarms.came.clear()

    def is_one_alarm(self, code, signal, since, first=()):
        """first: what may be said of it before more is known."""
        ring.wait_until(lambda: (code, signal) in self.alarms.came, f"{code} {signal}, there is {self.alarms.active()}", 10.0)
        self.assertLess(min(self.alarms.came.values()) - since(), SOON)
        time.sleep(2.0)  # while it lasts nothing comes or goes
        self.assertEqual([(code, signal)], [(a["code"], a["signal"]) for a in self.alarms.active()])
        self.assertLessEqual(set(self.alarms.came), {(code, signal), *first})
        self.assertIn(self.alarms.events[code]["severity"], ("warning", "error"))
        self.assertNotIn(self.alarms.events[code]["remedy"], ("", "none"))

    def goes_once(self, code, signal):
        ring.wait_until(lambda: not self.alarms.active(), f"the end of {code}", 90.0)  # a minute if it came twice
        mine = [a for a in self.alarms.now if (a["code"], a["signal"]) == (code, signal)]
        self.assertEqual(["returned"], [a["state"] for a in mine])
        count = mine[0]["count"]
        time.sleep(1.0)
        self.assertEqual([count], [a["count"] for a in self.alarms.now if (a["code"], a["signal"]) == (code, signal)])

    def spoilt(self, code, signal, spoil):
        """spoil: changes a measurement."""
        type(self).first_spoilt = None
        type(self).spoil = staticmethod(spoil)
        try:
            self.is_one_alarm(code, signal, lambda: self.first_spoilt)
        finally:
            type(self).spoil = None
        self.goes_once(code, signal)

    @staticmethod
    def put(field, index, value):
        def spoil(message):
            values = list(getattr(message, field))
            values[index] = value(values[index]) if callable(value) else value
            setattr(message, field, values)
        return spoil

    def test_a_reading_that_is_no_number(self):
        self.spoilt("signal_missing", "s", self.put("outputs", 0, math.nan))

    def test_a_link_that_is_stale(self):
        def spoil(message):
            message.quality = bytes([0, 1] + [0] * len(message.disturbances))
        self.spoilt("signal_missing", "x", spoil)

    def test_a_reading_out_of_range(self):
        self.spoilt("signal_out_of_range", "s", self.put("outputs", 0, 9e4))

    def test_a_reading_that_jumps(self):
        up = [400.0, -400.0]
        self.spoilt("signal_jumped", "x", self.put("outputs", 1, lambda v: v + up[int(time.monotonic() * 5) % 2]))

    def test_a_reading_that_is_too_fast(self):
        self.spoilt("signal_too_fast", "s", self.put("outputs", 0, lambda v: v + (60.0 if int(time.monotonic() * 5) % 2 else 0.0)))

    def frozen(self, node, code, signal=""):
        with ring.Frozen(node) as fault:
            self.is_one_alarm(code, signal, lambda: fault.since, [("node_silent", ""), ("no_measurement", ""), ("no_action", "")])
        self.goes_once(code, signal)

    def test_an_optimizer_that_hangs(self):
        self.frozen("/clp_optimizer", "optimizer_lost")


if __name__ == "__main__":
    rospy.init_node("operator_alarms")
    rostest.rosrun("fmbpc", "operator_alarms", Faults, sys.argv)
