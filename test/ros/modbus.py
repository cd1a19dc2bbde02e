#!/usr/bin/python3
"""plant_gateway on a wire that breaks: every write keeps its limits at the PLC's side, what is wrong is said, the input
falls back in the stated time and is taken up again without a bump. A few faults, all with FMBPC_LONG_TESTS."""
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from fmbpc.msg import LoopState, Measurement, Setpoint, Tracking

import exchange
import wire

LONG = bool(os.environ.get("FMBPC_LONG_TESTS"))
SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")
LOWER, UPPER, MOVE, FALLBACK = 0.0, 200.0, 4.0, 100.0
PLC_PATIENCE = 1.0  # s of wall time
CALM = (LoopState.AUTOMATIC, LoopState.FINISHED)


def swapped(data):
    return data[2:4] + data[0:2]


def more(raw):
    """A register that reads so many counts more."""
    return lambda data: struct.pack(">H", min(max(struct.unpack(">H", data)[0] + raw, 0), 65535))


def number(value):
    return lambda _: struct.pack(">f", value)


# name: (fault, s that it lasts, whether it must be said); quick ones first
QUICK = {
    "cut": (wire.Refused, 2.5, True),
    "writes are lost": (lambda: wire.LostWrites(False, False), 1.5, True),
    "garbage": (lambda: wire.Garbage(1), 1.5, True),
    "positions that lie": (lambda: wire.Registers(3, 12, lambda _: struct.pack(">H", 15000)), 1.5, True),
    "another master": (lambda: wire.Registers(3, 22, lambda _: struct.pack(">H", 4711)), 1.5, True),
    "word order": (lambda: wire.Registers(4, 0, swapped), 2.0, True),
}
SLOW = {
    "writes are confirmed and lost": (lambda: wire.LostWrites(False, True), 1.0, False),
    "exceptions": (lambda: wire.Exceptions(4), 1.5, True),
    "stale values": (wire.Stale, 2.0, True),
    "cut for a moment": (wire.Refused, 0.3, False),
    "cut again and again": (lambda: wire.Dropping(7), 2.0, False),
    "cut at every question": (lambda: wire.Dropping(1), 2.0, True),
    "silent": (wire.Silent, 2.0, True),
    "slow": (lambda: wire.Slow(0.01), 2.0, False),
    "slower": (lambda: wire.Slow(0.1), 2.0, True),
    "slower than the time-out": (lambda: wire.Slow(0.4), 2.0, True),
    "writes arrive and their answers are lost": (lambda: wire.LostWrites(True, False), 1.5, True),
    "writes are refused": (lambda: wire.Exceptions(4, writes_only=True), 1.5, True),
    "reads are refused": (lambda: wire.Exceptions(2, reads_only=True), 1.5, True),
    "illegal function": (lambda: wire.Exceptions(1), 1.5, True),
    "illegal address": (lambda: wire.Exceptions(2), 1.5, True),
    "illegal value": (lambda: wire.Exceptions(3), 1.5, True),
    "busy": (lambda: wire.Exceptions(6), 1.5, True),
    "some garbage": (lambda: wire.Garbage(2, 0.1), 2.0, False),
    "wrong transaction": (lambda: wire.Mangled(lambda t, u, d: (t ^ 1, u, d)), 1.5, True),
    "wrong unit": (lambda: wire.Mangled(lambda t, u, d: (t, u + 1, d)), 1.5, False),
    "wrong function": (lambda: wire.Mangled(lambda t, u, d: (t, u, bytes([d[0] ^ 7]) + d[1:])), 1.5, True),
    "empty answers": (lambda: wire.Mangled(lambda t, u, d: (t, u, d[:1])), 1.5, True),
    "truncated answers": (wire.Truncated, 1.5, True),
    "doubled answers": (wire.Doubled, 1.5, False),
    "no number": (lambda: wire.Registers(4, 0, number(float("nan"))), 2.0, True),
    "infinite": (lambda: wire.Registers(4, 0, number(float("inf"))), 2.0, True),
    "out of range": (lambda: wire.Registers(4, 0, number(40.0)), 2.0, True),
    "frozen heartbeat": (lambda: wire.Registers(3, 20, lambda _: b"\0\7"), 2.0, True),
}


class Plc:
    """The soft PLC as a process, and what it logs."""

    def __init__(self, port):
        self.port, self.log, self.seen = port, tempfile.NamedTemporaryFile(suffix=".jsonl"), 0
        self.start()

    def start(self):
        command = ["/usr/bin/python3", os.path.join(SCRIPTS, "soft_plc.py"), "--port", str(self.port), "--log", self.log.name]
        self.process = subprocess.Popen(exchange.tied(command), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def lines(self):
        with open(self.log.name, encoding="utf-8") as file:
            return [json.loads(line) for line in file if line.endswith("\n")]


class Modbus(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.plc = Plc(exchange.free_port())
        cls.addClassCleanup(lambda: exchange.killed(cls.plc.process))
        cls.wire = wire.Wire(cls.plc.port)
        sets = f"gateway.modbus.port={cls.wire.port} sampling.duration_h=0 setpoint.schedule=[]"
        cls.launch = subprocess.Popen(
            exchange.tied(["roslaunch", "--wait", "fmbpc", "loop.launch", "loop:=cstr_modbus", f"set:={sets}", "draw:=false",
                       "keep:=true", "sim_time:=false", "respawn:=true", f"out:={tempfile.mkdtemp()}"]),
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cls.addClassCleanup(exchange.end_launch, cls.launch)
        cls.states = exchange.Listener("loop_state", LoopState, "/plant_gateway")
        cls.measurements = exchange.Listener("measurement", Measurement)
        cls.await_calm()

    @classmethod
    def await_calm(cls, patience=exchange.PATIENCE):
        cls.states.clear()
        cls.states.wait(lambda s: s.summary and s.mode == LoopState.AUTOMATIC, patience)
        cls.measurements.clear()
        first = cls.measurements.wait()
        cls.measurements.wait(lambda m: m.step > first.step + 5 and not m.local)

    def check_limits(self, since):
        lines = self.plc.lines()[since:]
        for line in lines:
            if "asked" in line:
                self.assertTrue(LOWER <= line["asked"] <= UPPER, line)
                self.assertTrue(line["allowed"] or not line["remote"], line)
        return lines

    def check(self, begin, end, lasts, said):
        """From calm to calm, with what `begin` breaks and `end` mends in between."""
        self.await_calm()
        since, started = len(self.plc.lines()), time.monotonic()
        self.states.clear()
        try:
            begin()
            if said:
                state = self.states.wait(lambda s: s.summary and s.mode not in CALM)
                self.assertTrue(state.reason)
            time.sleep(max(0.0, started + lasts - time.monotonic()))  # a fault's own length
        finally:
            end()
        self.await_calm()
        return self.check_limits(since), started

    def run_faults(self, faults):
        failed = []
        for name, (fault, lasts, said) in faults.items():
            try:
                self.check(lambda f=fault: self.wire.breaks(f()), self.wire.heals, lasts, said)
            except AssertionError as error:
                failed.append(f"{name}: {error}")
        self.assertEqual([], failed)

    def test_limits_hold_and_the_loop_returns_from_every_fault(self):
        self.run_faults(QUICK)

    def test_the_plc_takes_the_valve_in_time_and_gives_it_back_without_a_bump(self):
        lines, started = self.check(lambda: self.wire.breaks(wire.Refused()), self.wire.heals, 2.5, True)
        events = [line for line in lines if "event" in line]
        self.assertEqual(["the PLC takes the valve", "the gateway has the valve"], [e["event"] for e in events])
        self.assertLess(events[0]["t"] - started, PLC_PATIENCE + 0.5)
        first = next(line for line in lines if "asked" in line and line["t"] > events[1]["t"])
        self.assertLess(abs(first["asked"] - events[1]["flow"]), MOVE)

    def test_an_offset_of_the_position_does_not_move_the_valve(self):
        for offset in (600, -600):  # l/min / 100: 3 % of the range
            lines, _ = self.check(lambda o=offset: self.wire.breaks(wire.Registers(3, 12, more(o))), self.wire.heals, 3.0, True)
            asked = [line["asked"] for line in lines if "asked" in line]
            self.assertGreater(len(asked), 20)
            self.assertLess(max(asked) - min(asked), 2 * MOVE)
            self.assertEqual([], [line for line in lines if "event" in line])

    def test_leadership_is_renewed_and_its_loss_is_said(self):
        def lost():
            return status.counts()["times that leadership was lost"]
        status, port = exchange.NodeStatus("plant_gateway"), self.plc.port
        # Each behind the gateway's own renewal: what is written between its look and its renewal is undone unseen.
        for renewal, write in (
                (b"\5\0\0", lambda: wire.write_coil(port, 0, False)),
                (b"\x10\0\x16", lambda: wire.write_register(port, 22, 0))):
            before = lost()
            lines, _ = self.check(lambda r=renewal, w=write: self.wire.breaks(wire.Once(r, w)), self.wire.heals, 0.0, True)
            self.assertNotIn("another master is refused", [line.get("event") for line in lines])
            exchange.wait_until(lambda b=before: lost() > b, "the loss to be counted")

    def test_a_second_master_is_refused(self):
        lines, _ = self.check(lambda: wire.write_register(self.plc.port, 22, 4711), lambda: None, 1.0, False)
        self.assertEqual(["another master is refused"], [e["event"] for e in lines if "event" in e])

    def test_a_lost_analyser_ends_in_the_fallback_and_back(self):
        def lose():
            self.wire.breaks(wire.Registers(4, 0, number(float("nan"))))
            self.states.wait(lambda s: s.summary and s.mode == LoopState.FALLBACK)
            self.measurements.wait(lambda m: abs(m.input_applied[0] - FALLBACK) < 0.02)
        self.check(lose, self.wire.heals, 0.0, True)

    def test_a_gateway_that_comes_back_goes_on_with_the_operators_setpoint(self):
        self.await_calm()
        tracking = exchange.Listener("tracking", Tracking)
        setpoint = exchange.publisher("setpoint", Setpoint, "/fmbpc_controller")
        setpoint.publish(name=["CA"], value=[0.1], mode=Setpoint.OVERRIDE)
        before = tracking.wait(lambda t: t.setpoint[0] == 0.1)
        os.kill(exchange.pid("/plant_gateway"), signal.SIGKILL)
        after = tracking.wait(lambda t: t.run_id not in (0, before.run_id))
        later = tracking.wait(lambda t: t.run_id == after.run_id and t.step > after.step + 5)
        self.assertEqual([0.1, 0.1], [after.setpoint[0], later.setpoint[0]])
        setpoint.publish(name=["CA"], value=[], mode=Setpoint.RELEASE)
        self.await_calm()

    @unittest.skipUnless(LONG, "long run: scripts/test --long")
    def test_every_other_fault(self):
        self.assertGreaterEqual(len(QUICK) + len(SLOW) + 3, 30)
        self.run_faults(SLOW)

    @unittest.skipUnless(LONG, "long run: scripts/test --long")
    def test_a_plc_that_hangs_dies_or_loses_its_registers(self):
        self.check(lambda: self.plc.process.send_signal(signal.SIGSTOP), lambda: self.plc.process.send_signal(signal.SIGCONT),
                   1.5, True)

        def kill():
            self.plc.process.kill()
            self.plc.process.wait()
        for lasts in (0.1, 2.0):
            self.check(kill, self.plc.start, lasts, lasts > 1.0)


if __name__ == "__main__":
    rospy.init_node("modbus")
    rostest.rosrun("fmbpc", "modbus", Modbus, sys.argv)
