#!/usr/bin/python3
"""A PLC in software: the stirred-tank reactor of config/loop/cstr behind Modbus/TCP, for demonstrations and tests.

    soft_plc.py [--port 1502] [--speedup 60] [--log FILE] [--law FOLDER]

Input registers 0-1: CA [mol/l], float32. Holding registers: 10 coolant flow asked [0.01 l/min], 12 coolant flow in force,
20 heartbeat of the PLC, 21 heartbeat of the gateway, 22 the word of the master that leads. Coils: 0 the gateway wants the
valve, 1 the PLC lets it.

It trusts nobody: when the gateway's heartbeat stands still for a second, coil 0 is off, or nobody leads, it takes the valve
itself, moves it to its safe flow and puts what is in force into register 10, so that whoever comes back starts there. It
counts every write to register 10 that is out of bounds or moves too far at once, and does not follow it. Whoever writes a
word into register 22 while it is 0 leads until it writes 0 there or its heartbeat stands still; the words of others are
undone and counted meanwhile.

With --law the valve belongs to a law that `fmbpc export cstr_modbus --to c99 --out FOLDER` wrote: it runs here, every 6 s of
process time. Whoever leads gives setpoints only, in register 30 [0.0001 mol/l]; 31 is the one in force, 32 and 33 are the
block's iState and iErrors. When nobody leads the law goes on with the last setpoint."""
import argparse
import inspect
import json
import logging
import math
import os
import signal
import struct
import sys
import threading
import time

LOWER, UPPER, MOVE, SAFE = 0.0, 200.0, 4.0, 103.41  # l/min
SCAN_S, PATIENCE_S, SETTLE_S = 0.02, 1.0, 0.3  # of wall time
SAMPLE_S, DELAY_S = 6.0, 30.0  # of process time: the compensator's sample, the analyser's line
SET_LOWER, SET_UPPER, SET_SCALE = 0.02, 0.2, 10000.0  # mol/l; registers per mol/l
SET_ASKED, SET_IN_FORCE, LAW_STATE, LAW_ERRORS = 30, 31, 32, 33
ASKED, IN_FORCE, BEAT_OUT, BEAT_IN, OWNER, SIZE = 10, 12, 20, 21, 22, 64
COILS, INPUTS, HOLDING = 1, 4, 3  # function codes that stand for a table
SCALE = 100.0  # registers per l/min


class Reactor:
    """dCA/dt, dT/dt of blazic2007, eqs. 1 and 2, with the compensator of eq. 10 inside."""

    def __init__(self):
        self.concentration, self.temperature = 0.1000001680476245, 438.5443805030675
        self.before, self.share, self.seconds = self.temperature, 0.0, 0.0
        self.line = [self.concentration] * int(DELAY_S / SAMPLE_S * 30)

    def derivatives(self, concentration, temperature, flow):
        rate = 7.2e10 * concentration * math.exp(-1e4 / temperature)
        cooling = flow * 1e3 * (1.0 - math.exp(-7e5 / (flow * 1e3))) if flow > 0.0 else 0.0
        return (1.0 - concentration - rate,
                350.0 - temperature + 200.0 * rate + cooling / 1e5 * (350.0 - temperature))

    def step(self, flow, seconds):
        """Classical Runge-Kutta over `seconds` of process time, one compensator sample at most."""
        self.seconds += seconds
        if self.seconds >= SAMPLE_S:
            self.seconds -= SAMPLE_S
            self.share = 3.0 * (self.temperature - self.before)
            self.before = self.temperature
        flow = min(max(flow + self.share, 0.0), 500.0)
        h, state = seconds / 60.0, (self.concentration, self.temperature)
        k1 = self.derivatives(*state, flow)
        k2 = self.derivatives(*(s + h / 2 * k for s, k in zip(state, k1)), flow)
        k3 = self.derivatives(*(s + h / 2 * k for s, k in zip(state, k2)), flow)
        k4 = self.derivatives(*(s + h * k for s, k in zip(state, k3)), flow)
        self.concentration, self.temperature = (
            s + h / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in zip(state, k1, k2, k3, k4))
        self.line = self.line[1:] + [self.concentration]

    def measured(self):
        return self.line[0]


class Plc:
    """The scan: what a PLC does every 20 ms. `table` reads and writes registers and coils; `clock` in s."""

    def __init__(self, table, speedup, log):
        self.table, self.speedup, self.log, self.reactor = table, speedup, log, Reactor()
        self.flow, self.remote, self.beat, self.scans = SAFE, False, None, 0
        self.writes, self.refused, self.takeovers, self.owner, self.strangers = 0, 0, 0, 0, 0
        self.heard = self.calm = time.monotonic()
        self.left, self.lock = 0.0, threading.RLock()
        self.publish()

    def written(self, raw):
        """The gateway has written register 10. Called by the server, at every write."""
        with self.lock:
            asked, self.writes = raw / SCALE, self.writes + 1
            allowed = LOWER <= asked <= UPPER and abs(asked - self.flow) <= MOVE + 1e-9
            if self.log:
                print(json.dumps({"t": time.monotonic(), "asked": asked, "before": round(self.flow, 6), "allowed": allowed,
                                  "remote": self.remote}), file=self.log, flush=True)
            self.refused += not allowed and self.remote
            if self.remote and allowed:
                self.flow = asked

    def claimed(self, word):
        """Somebody has written register 22. Called by the server, at every write."""
        with self.lock:
            if word in (0, self.owner) or not self.owner:
                self.heard = self.heard if self.owner else time.monotonic()
                self.owner = word
                return
            self.strangers += 1
            self.note("another master is refused")
            self.table.put(HOLDING, OWNER, [self.owner])

    def scan(self, seconds):
        with self.lock:
            now, beat = time.monotonic(), self.table.get(HOLDING, BEAT_IN)
            if beat != self.beat:
                self.beat, self.heard = beat, now
            if self.owner and now - self.heard >= PATIENCE_S:
                self.owner = 0
                self.table.put(HOLDING, OWNER, [0])
            asked = self.table.get(COILS, 0) and self.owner
            if not asked:
                self.calm = now
            if self.remote and not asked:
                self.takeovers += 1
                self.note("the PLC takes the valve")
            if not self.remote and asked and now - self.calm > SETTLE_S:
                self.note("the gateway has the valve")
            self.remote = bool(asked and (self.remote or now - self.calm > SETTLE_S))
            self.drive(seconds)
            self.left += seconds
            slice_s = SAMPLE_S / 30
            while self.left >= slice_s:
                self.reactor.step(self.flow, slice_s)
                self.left -= slice_s
            self.scans += 1
            self.publish()

    def drive(self, seconds):
        """What the PLC itself does with the valve."""
        if not self.remote:
            self.flow += min(max(SAFE - self.flow, -MOVE * seconds / SAMPLE_S), MOVE * seconds / SAMPLE_S)

    def note(self, event):
        if self.log:
            print(json.dumps({"t": time.monotonic(), "event": event, "flow": round(self.flow, 6)}), file=self.log, flush=True)

    def publish(self):
        raw = int(round(self.flow * SCALE))
        if not self.remote:
            self.table.put(HOLDING, ASKED, [raw])
        self.table.put(HOLDING, IN_FORCE, [raw])
        self.table.put(HOLDING, BEAT_OUT, [self.scans & 0xFFFF])
        self.table.put(INPUTS, 0, list(struct.unpack(">HH", struct.pack(">f", self.reactor.measured()))))
        self.table.put(COILS, 1, [self.remote])

    def summary(self):
        return (f"soft_plc: {self.writes} writes, {self.refused} of them out of bounds or too far at once; the PLC took the "
                f"valve {self.takeovers} times and refused other masters {self.strangers} times; CA is "
                f"{self.reactor.concentration:.4f} mol/l")


class LawPlc(Plc):
    """The same with an exported law that has the valve."""

    def __init__(self, table, speedup, log, law):
        self.law, self.setpoint, self.waited = law, 0.12, SAMPLE_S
        super().__init__(table, speedup, log)

    def written(self, raw):
        """The gateway has written register 30."""
        with self.lock:
            asked, self.writes = raw / SET_SCALE, self.writes + 1
            allowed = SET_LOWER <= asked <= SET_UPPER
            self.refused += not allowed and self.remote
            if self.remote and allowed:
                self.setpoint = asked

    def drive(self, seconds):
        self.waited += seconds
        if self.waited < SAMPLE_S:
            return
        self.waited -= SAMPLE_S
        given = self.law.given
        given.iMode = 3 if self.remote else 2
        given.rSetpoint_CA = given.rCascade_CA = self.setpoint
        given.rValue_CA = self.reactor.measured()
        given.rActuator_q_c = self.flow
        self.law.step()
        moved = abs(self.law.answer.rOut_q_c - self.flow)
        self.flow = self.law.answer.rOut_q_c
        if self.log:
            print(json.dumps({"t": time.monotonic(), "flow": self.flow, "moved": moved, "CA": given.rValue_CA, "setpoint": self.setpoint,
                              "state": self.law.answer.iState, "source": self.law.answer.iSource}), file=self.log, flush=True)

    def publish(self):
        raw = int(round(self.setpoint * SET_SCALE))
        if not self.remote:
            self.table.put(HOLDING, SET_ASKED, [raw])
        self.table.put(HOLDING, SET_IN_FORCE, [raw])
        self.table.put(HOLDING, LAW_STATE, [self.law.answer.iState])
        self.table.put(HOLDING, LAW_ERRORS, [self.law.answer.iErrors])
        super().publish()


def server_parts():
    """pymodbus is another one on every Debian: 2.1 on 11, 3.0 on 12, 3.8 on 13; later ones say device, not slave."""
    from pymodbus import datastore
    try:
        from pymodbus.server import StartTcpServer
    except ImportError:
        from pymodbus.server.sync import StartTcpServer
    unit = getattr(datastore, "ModbusSlaveContext", None) or datastore.ModbusDeviceContext
    return StartTcpServer, datastore.ModbusServerContext, unit, datastore.ModbusSequentialDataBlock


def made_table():
    """Registers and coils as pymodbus holds them, the server's context, and what to call at a write from outside."""
    _, server_context, unit, block = server_parts()

    class Heard(block):
        """Tells of writes that are not our own, which come from the server's thread."""
        heard, ours = None, threading.get_ident()

        def setValues(self, address, values):
            super().setValues(address, values)
            if self.heard and threading.get_ident() != self.ours:
                self.heard(address, values)

    class Table:
        def __init__(self):
            self.holding = Heard(0, [0] * SIZE)
            self.unit = unit(di=block(0, [0] * SIZE), co=block(0, [0] * SIZE), ir=block(0, [0] * SIZE), hr=self.holding)
            self.shift = 0 if getattr(self.unit, "zero_mode", False) else 1
            many = "slaves" if "slaves" in inspect.signature(server_context.__init__).parameters else "devices"
            self.context = server_context(**{many: self.unit, "single": True})
            self.heard = {}  # what to call, by register
            self.holding.heard = self.listen

        def listen(self, address, values):
            values = values if isinstance(values, (list, tuple)) else [values]
            for register, call in self.heard.items():
                if address - self.shift <= register < address - self.shift + len(values):
                    call(values[register - (address - self.shift)])

        def get(self, table, address):
            return self.unit.getValues(table, address, 1)[0]

        def put(self, table, address, values):
            self.unit.setValues(table, address, values)

    return Table()


def serve(table, port):
    logging.getLogger("pymodbus").setLevel(logging.CRITICAL)  # who comes and goes is no error
    start = server_parts()[0]
    for more in ({"allow_reuse_address": True}, {}):  # newer ones do so anyhow, and do not know the word
        try:
            start(context=table.context, address=("127.0.0.1", port), **more)
            return
        except TypeError:
            continue


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--port", type=int, default=1502)
    parser.add_argument("--speedup", type=float, default=60.0)
    parser.add_argument("--law", help="folder of `fmbpc export`: its law has the valve, the gateway gives setpoints")
    parser.add_argument("--log", help="one JSON object a line, added to it: every write to register 10, every change of hands")
    options = parser.parse_known_args()[0]  # roslaunch adds some
    with open(options.log or os.devnull, "a", encoding="utf-8") as log:  # of a PLC before this one, too
        table = made_table()
        if options.law:
            from exported_law import ExportedLaw
            plc = LawPlc(table, options.speedup, log if options.log else None, ExportedLaw(options.law))
        else:
            plc = Plc(table, options.speedup, log if options.log else None)
        table.heard = {SET_ASKED if options.law else ASKED: plc.written, OWNER: plc.claimed}
        threading.Thread(target=serve, args=(table, options.port), daemon=True).start()
        ended = threading.Event()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: ended.set())
        before = time.monotonic()
        while not ended.wait(SCAN_S):
            now = time.monotonic()
            plc.scan(min(now - before, 1.0) * options.speedup)
            before = now
        print(plc.summary(), flush=True)


if __name__ == "__main__":
    sys.exit(main())
