"""Behind the gateway: positions that lie, masters that do not lead, strangers on the plant's topics."""
import math
import os
import random
import signal
import struct
import subprocess

import exchange
import wire
from fault import Fault

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPTS = os.path.join(HERE, "..", "..", "scripts")
AWAY, UNREAD = "does not follow its command", "is not read back"


class PlcBehindWire:
    """The soft PLC, and the wire on which its position register can be changed."""
    RANGE, SHARE = 200.0, 100.0  # l/min, counts per l/min

    def __init__(self, folder):
        self.port = exchange.free_port()
        self.log = os.path.join(folder, "plc.jsonl")
        self.process = subprocess.Popen(
            ["/usr/bin/python3", os.path.join(SCRIPTS, "soft_plc.py"), "--port", str(self.port), "--log", self.log],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.wire = wire.Wire(self.port)
        self.sets = f"gateway.modbus.port={self.wire.port}"

    def position(self, change):
        """`change` of the position in shares of its range; None: the truth."""
        def changed(data):
            share = change(struct.unpack(">H", data)[0] / self.SHARE / self.RANGE)
            return struct.pack(">H", int(round(min(max(share * self.RANGE * self.SHARE, 0.0), 65535.0))))
        if change:
            self.wire.breaks(wire.Registers(3, 12, changed))
        else:
            self.wire.heals()

    def unread(self):
        """The PLC answers that it has no such register."""
        class NoPosition(wire.Healthy):
            def question(self, data):
                mine = data[0] == 3 and struct.unpack(">H", data[1:3])[0] == 12
                return (None, bytes([0x83, 2])) if mine else (data, None)
        self.wire.breaks(NoPosition())

    def measures(self, change):
        def changed(data):
            return struct.pack(">f", change(struct.unpack(">f", data)[0]))
        if change:
            self.wire.breaks(wire.Registers(4, 0, changed))
        else:
            self.wire.heals()

    def end(self):
        self.process.kill()
        self.process.wait()


class TankBehindRelay:
    """The example's tank, whose level and position reach the gateway through this process."""
    RANGE = 20.0
    sets = ""

    def __init__(self, _):
        import rospy
        from std_msgs.msg import Float64
        self.change, self.silent, self.analyser = None, False, None
        self.process = subprocess.Popen(["/usr/bin/python3", os.path.join(SCRIPTS, "example_plant.py")],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.publisher = rospy.Publisher("tank/inflow_read", Float64, queue_size=10, tcp_nodelay=True)
        self.level = rospy.Publisher("tank/state_read", Float64, queue_size=10, tcp_nodelay=True)
        self.subscribers = [rospy.Subscriber(topic, Float64, take, queue_size=10, tcp_nodelay=True)
                            for topic, take in (("tank/inflow", self.relay), ("tank/state", self.relay_level))]

    def relay(self, message):
        if self.silent:
            return
        change = self.change
        self.publisher.publish(self.RANGE * change(message.data / self.RANGE) if change else message.data)

    def relay_level(self, message):
        analyser = self.analyser
        self.level.publish(analyser(message.data) if analyser else message.data)

    def position(self, change):
        self.change, self.silent = change, False

    def measures(self, change):
        """`change` of the measured output; None: the truth."""
        self.analyser = change

    def unread(self):
        self.silent = True

    end = PlcBehindWire.end


def lie(what, make, said=AWAY, lasts=2.0, **more):
    """`make` gives the change of a position (share of the range) anew at each meeting."""
    return Fault(f"position {what}", lambda loop: loop.far.position(make()), lambda loop: loop.far.position(None), said=said,
                 needs=("gateway",), lasts=lasts, **more)


def offset(share):
    return lie(f"reads {100 * share:+g} % of the range", lambda: lambda p: p + share, AWAY if abs(share) > 0.02 else None)


def stepping(share):
    def make():
        count = [0]

        def change(p):
            count[0] += 1
            return p + (share if count[0] % 60 < 40 else 0.0)
        return change
    return make


def drifting(per_reading):
    def make():
        sum_of = [0.0]

        def change(p):
            sum_of[0] += per_reading
            return p + sum_of[0]
        return change
    return make


def noisy(share):
    dice = random.Random(1)
    return lambda: lambda p: p + dice.uniform(-share, share)


def frozen():
    first = []

    def change(p):
        first.append(p)
        return first[0]
    return change


def noisy_analyser(loop):
    """Noise of a thousandth of what it shows, for so long that it is known."""
    dice = random.Random(1)
    loop.far.measures(lambda y: y * (1.0 + dice.gauss(0.0, 1e-3)))
    loop.samples(180)


def frozen_analyser(loop):
    first = []

    def shows(y):
        first.append(y)
        return first[0]
    loop.far.measures(shows)


def well(loop):
    loop.far.measures(None)


def unread(loop):
    loop.far.unread()


def truth(loop):
    loop.far.position(None)


def nan():
    return lambda p: math.nan


def gateway_gone(how, number):
    return Fault(f"plant_gateway {how}", lambda loop: loop.kill("plant_gateway", with_signal=number), needs=("gateway",),
                 touches=("plant_gateway",), new_run=True, own_hand=True, lasts=2.0)


def said_by_plc(words):
    def check(loop):
        with open(loop.far.log, encoding="utf-8") as file:
            return None if words in file.read() else f"the PLC did not say '{words}'"
    return check


def another_word(loop):
    loop.far.wire.breaks(wire.Registers(3, 22, lambda _: struct.pack(">H", 4711)))


def heal(loop):
    loop.far.wire.heals()


def second_gateway(loop):
    """A second launch of the same loop, on a master of its own, at the same PLC: refused in words."""
    folder, port = os.path.join(os.path.dirname(loop.far.log), "second"), exchange.free_port()
    with open(folder + ".log", "w", encoding="utf-8") as log:
        loop.second = subprocess.Popen(
            exchange.tied(["roslaunch", "-p", port, "fmbpc", "loop.launch", "loop:=cstr_modbus", f"out:={folder}",
                       f"set:=gateway.modbus.port={loop.far.wire.port} sampling.duration_h=0", "draw:=false", "sim_time:=false"]),
            env={**os.environ, "ROS_MASTER_URI": f"http://localhost:{port}"}, stdout=log, stderr=log, start_new_session=True)

    def refused():
        with open(folder + ".log", encoding="utf-8", errors="replace") as file:
            return "the word of another master" in file.read()
    exchange.wait_until(refused, "the second gateway to be refused", 40.0)


def end_second(loop):
    exchange.end_launch(loop.second)


def end(loop):
    loop.end_children()


def stranger(topic, value):
    def do(loop):
        loop.start("rostopic", "pub", "-r", "20", topic, "std_msgs/Float64", str(value))
    return do


def modbus(name, do, undo=lambda loop: None, **more):
    return Fault(name, do, undo, needs=("modbus",), **more)


def float64(name, do, **more):
    return Fault(name, do, end, needs=("float64",), said_within=6.0, lasts=1.0, **more)


FAULTS = (
    [offset(sign * share) for share in (0.01, 0.015, 0.03, 0.06, 0.15, 0.5) for sign in (1, -1)] +
    [lie("steps to and fro", stepping(0.1)), lie("steps down and back", stepping(-0.1)),
     lie("drifts up", drifting(0.001), said_within=4.0), lie("drifts down", drifting(-0.001), said_within=4.0),
     lie("is noisy within the band", noisy(0.015), None), lie("is noisy", noisy(0.5)),
     lie("is rounded to 1 %", lambda: lambda p: round(100 * p) / 100, None),
     lie("is rounded to the half", lambda: lambda p: round(2 * p) / 2),
     lie("is 0", lambda: lambda p: 0.0), lie("is at its end", lambda: lambda p: 1.0),
     lie("stays where it was", frozen, None),
     Fault("position is not read any more", unread, truth, said=UNREAD + "|Illegal data address", needs=("gateway",), lasts=3.0,
           said_within=3.0),
     Fault("position is no number", lambda loop: loop.far.position(nan()), truth, said=UNREAD, needs=("float64",), lasts=3.0,
           said_within=3.0),
     Fault("analyser noisy", noisy_analyser, needs=("gateway",)),
     Fault("analyser frozen, noisy before", frozen_analyser, well, said="frozen", needs=("gateway",), said_within=10.0, lasts=2.0),
     gateway_gone("killed (-9)", signal.SIGKILL), gateway_gone("ended (SIGINT)", signal.SIGINT),
     Fault("plant_gateway frozen for 3 s", lambda loop: loop.freeze("plant_gateway"), lambda loop: loop.thaw(),
           said="/plant_gateway|no measurement", needs=("gateway", "processes"), own_hand=True, lasts=3.0),
     modbus("another master's word in the owner's register", another_word, heal, said="the word of another master", lasts=1.5,
            own_hand=True),
     modbus("a second master claims the plant", lambda loop: wire.write_register(loop.far.port, 22, 4711), lasts=1.0,
            after=said_by_plc("another master is refused")),
     modbus("the owner's word is taken away", lambda loop: wire.write_register(loop.far.port, 22, 0),
            said="somebody has taken our word", lasts=1.0, own_hand=True),
     modbus("the coil is switched off by somebody", lambda loop: wire.write_coil(loop.far.port, 0, False),
            said="somebody has switched coil 0 off", lasts=1.0, own_hand=True),
     modbus("a second gateway at the same PLC", second_gateway, end_second, lasts=3.0),
     float64("a stranger commands the tank", stranger("/tank/control_effort", 4.0),
             said="control_effort is published by /rostopic.* as well"),
     float64("a stranger speaks for the tank", stranger("/tank/state_read", 3.9),
             counted=("plant_gateway", "refused: tags from /rostopic"))])
