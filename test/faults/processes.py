"""Nodes that are killed, ended or frozen."""
import http.client
import signal
import time
import xmlrpc.client

from fault import Fault

CONTROLLER, OPTIMIZER, RECORDER, IDENTIFIER, PLANT = (
    "fmbpc_controller", "clp_optimizer", "loop_recorder", "fuzzy_identifier", "plant_simulator")


def needs(*nodes):
    return ("processes", *(("optimizer",) if OPTIMIZER in nodes else ()), *(("simulator",) if PLANT in nodes else ()),
            *(("model",) if IDENTIFIER in nodes else ()))


def quickly_back(node, with_signal, how):
    """A respawned node may be back before anybody misses it: nothing need be said."""
    return Fault(f"{node} {how}", lambda loop: loop.kill(node, with_signal=with_signal), needs=needs(node), touches=(node,),
                 lasts=2.0)


def shut_down(node):
    """As rosnode kill asks it to."""
    def do(loop):
        try:
            xmlrpc.client.ServerProxy(loop.master.lookupNode("/" + node)).shutdown("/fault_matrix", "asked to")
        except (OSError, xmlrpc.client.Error, http.client.HTTPException):  # it may end before it answers
            pass
    return Fault(f"rosnode kill {node}", do, needs=needs(node), touches=(node,), lasts=2.0)


def frozen(*nodes, seconds=3.0):
    """SIGSTOP: it hangs, and its connections live."""
    return Fault(f"{' and '.join(nodes)} frozen for {seconds:g} s", lambda loop: loop.freeze(*nodes),
                 lambda loop: loop.thaw(), said="|".join(f"/{n}|no measurement" if n == PLANT else f"/{n}" for n in nodes),
                 needs=needs(*nodes), lasts=seconds)


def blink(node):
    return Fault(f"{node} frozen for 0.3 s", lambda loop: (loop.freeze(node), time.sleep(0.3), loop.thaw()),
                 needs=needs(node), lasts=0.5)


def twice(loop):
    loop.kill(CONTROLLER)
    time.sleep(1.0)
    loop.kill(CONTROLLER)


FAULTS = (
    [quickly_back(node, signal.SIGKILL, "killed (-9)") for node in (CONTROLLER, OPTIMIZER, RECORDER, IDENTIFIER)] +
    [quickly_back(node, signal.SIGTERM, "ended (SIGTERM)") for node in (CONTROLLER, OPTIMIZER, RECORDER, IDENTIFIER)] +
    [quickly_back(node, signal.SIGINT, "ended (SIGINT)") for node in (CONTROLLER, OPTIMIZER, RECORDER, IDENTIFIER)] +
    [shut_down(node) for node in (CONTROLLER, OPTIMIZER, RECORDER, IDENTIFIER)] +
    [quickly_back(CONTROLLER, signal.SIGSEGV, "crashed (SIGSEGV)")] +
    [frozen(node) for node in (CONTROLLER, OPTIMIZER, RECORDER, IDENTIFIER, PLANT)] +
    [blink(node) for node in (CONTROLLER, OPTIMIZER, RECORDER, PLANT)] +
    [frozen(CONTROLLER, OPTIMIZER), frozen(CONTROLLER, seconds=6.0), frozen(OPTIMIZER, seconds=6.0),
     Fault("controller killed twice", twice, touches=(CONTROLLER,), lasts=2.0),
     Fault("controller and optimizer killed", lambda loop: loop.kill(CONTROLLER, OPTIMIZER), needs=("optimizer",),
           touches=(CONTROLLER, OPTIMIZER), lasts=2.0),
     Fault("all but the plant killed", lambda loop: loop.kill(CONTROLLER, OPTIMIZER, RECORDER, IDENTIFIER),
           touches=(CONTROLLER, OPTIMIZER, RECORDER, IDENTIFIER), lasts=2.0),
     Fault("identifier killed, then the controller",
           lambda loop: (loop.kill(IDENTIFIER), time.sleep(1.0), loop.kill(CONTROLLER)),
           touches=(IDENTIFIER, CONTROLLER), lasts=2.0)])
