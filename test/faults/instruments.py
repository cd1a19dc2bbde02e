"""Valves that are stuck or forced, sensors that lie: `rostopic pub /disturbance` with input/NAME and output/NAME."""
from fault import Fault


def disturb(loop, name, value, mode=1):
    loop.send("disturbance", loop.publishers["disturbance"].data_class(name=[name], value=value, mode=mode))


def valve(what, share):
    """Forced to a share of its range: the jump is the fault's, what the loop commands afterwards keeps its limits."""
    def name(loop):
        return "input/" + loop.info().inputs[0].name

    def do(loop):
        s = loop.info().inputs[0]
        disturb(loop, name(loop), [s.lower + share * (s.upper - s.lower)])
    return Fault(f"valve {what}", do, lambda loop: disturb(loop, name(loop), [], 3), needs=("simulator",),
                 lasts=2.0)


def sensor(what, value, mode):
    def name(loop):
        return "output/" + loop.info().outputs[-1].name

    def do(loop):
        disturb(loop, name(loop), [value(loop.now().outputs[-1])], mode)
    return Fault(f"sensor {what}", do, lambda loop: disturb(loop, name(loop), [], 3), needs=("simulator",), lasts=2.0)


FAULTS = [
    valve("stuck open", 1.0), valve("stuck shut", 0.0), valve("stuck in the middle", 0.5),
    sensor("reads 10 % more", lambda y: 0.1 * y, 2), sensor("reads 0", lambda y: 0.0, 1),
    sensor("frozen", lambda y: y, 1), sensor("reads a million times too much", lambda y: 1e6 * y, 1),
]
