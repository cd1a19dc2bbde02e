"""What is around the loop: clocks, disks, the master, second loops, viewers."""
import os
import signal
import subprocess
import time

import exchange
from fault import Fault

CONTROLLER, PLANT, RECORDER = "fmbpc_controller", "plant_simulator", "loop_recorder"


def clock(loop, offset):
    """The wall clock of all nodes jumps (clock_shim.c); the steady clock does not."""
    with open(loop.clock, "w", encoding="utf-8") as file:
        file.write(offset)


def jump(what, offset):
    return Fault(f"wall clock {what}", lambda loop: clock(loop, offset), lambda loop: clock(loop, "0"), needs=("clock",),
                 lasts=3.0)


def fill(loop):
    """Takes what is left of the small disk that the record is on."""
    with open(os.path.join(loop.disk, "filler"), "wb", buffering=0) as file:
        try:
            while file.write(b"x" * 65536):
                pass
        except OSError:
            pass
    try:
        with open(os.path.join(loop.disk, "filler2"), "wb", buffering=0) as file:
            while file.write(b"x" * 512):
                pass
    except OSError:
        pass


def room(loop):
    for name in ("filler", "filler2"):
        if os.path.exists(os.path.join(loop.disk, name)):
            os.remove(os.path.join(loop.disk, name))


def second(executable, name, *arguments):
    return lambda loop: loop.start(exchange.program(executable), f"__name:={name}", *arguments)


def end(loop):
    loop.end_children()


def stranger_node(executable, what, counted=None, needs=()):
    return Fault(f"second {what} beside ours", second(executable, "second"), end, counted=counted, needs=needs, lasts=3.0)


def usurper(executable, node, what):
    """The same name: the master ends the old one. The launch starts it again, which ends the second."""
    return Fault(f"second {what} of the same name", second(executable, node), end, touches=(node,), lasts=4.0)


def second_launch(loop):
    loop.second = ""
    done = subprocess.run(["roslaunch", "fmbpc", "loop.launch", "loop:=asp_case1"], capture_output=True, text=True,
                          timeout=60, check=False)
    loop.second = done.stdout + done.stderr


def was_refused(loop):
    return None if "another loop is running here" in loop.second else "a second launch was not refused"


def viewers(loop):
    for _ in range(5):
        loop.start("rostopic", "echo", "/measurement")
    time.sleep(2.0)


def hung_viewer(loop):
    child = loop.start("rostopic", "echo", "/measurement")
    time.sleep(1.5)
    os.killpg(child.pid, signal.SIGSTOP)


def unhang(loop):
    for child in loop.children:
        os.killpg(child.pid, signal.SIGCONT)
    loop.end_children()


def no_parameters(loop):
    loop.text = loop.master.getParam("/loop_text")
    for name in ("/loop_text", "/loop_name"):
        loop.master.deleteParam(name)


def parameters(loop):
    loop.master.setParam("/loop_text", loop.text)
    loop.kill(CONTROLLER)


def other_text(loop):
    """The loop file has changed, and one of the nodes is started again."""
    loop.text = loop.master.getParam("/loop_text")
    loop.master.setParam("/loop_text", loop.text + "\n# changed\n")
    loop.kill(CONTROLLER)


def master_frozen(loop):
    os.kill(loop.core.pid, signal.SIGSTOP)


def master_thawed(loop):
    os.kill(loop.core.pid, signal.SIGCONT)


def master_killed(loop):
    loop.core.kill()
    loop.core.wait()


def master_again(loop):
    loop.start_core()
    loop.wait_until_known()


def then_the_controller(loop):
    master_again(loop)
    time.sleep(1.0)
    loop.kill(CONTROLLER)


FAULTS = [
    jump("an hour back", "-3600"), jump("an hour ahead", "3600"), jump("a day back", "-86400"),
    jump("20 years ahead", "630720000"),
    Fault("disk full", fill, room, said=f"{RECORDER}.*(cannot be written|full|room|No space)", needs=("disk",), lasts=2.0),
    Fault("disk full, recorder killed", lambda loop: (fill(loop), loop.kill(RECORDER)), room,
          touches=(RECORDER,), needs=("disk",), lasts=4.0),
    stranger_node("fmbpc_controller", "controller", counted=(RECORDER, "refused: tracking from /second"), needs=("processes",)),
    stranger_node("loop_recorder", "recorder"),
    stranger_node("plant_simulator", "plant", counted=(CONTROLLER, "refused: plant_info from /second"), needs=("simulator",)),
    usurper("fmbpc_controller", CONTROLLER, "controller"),
    usurper("loop_recorder", RECORDER, "recorder"),
    Fault("second launch on the same master", second_launch, after=was_refused),
    Fault("five viewers come and go", viewers, end, lasts=1.0),
    Fault("a viewer hangs", hung_viewer, unhang, lasts=3.0),
    Fault("loop_text removed, then the controller killed", no_parameters, parameters, touches=(CONTROLLER,), lasts=3.0),
    Fault("loop_text changed, the controller killed", other_text, parameters, touches=(CONTROLLER,), lasts=2.0,
          said="/fmbpc_controller .*the plant reads another loop_text", said_within=10.0),
    Fault("master frozen for 4 s", master_frozen, master_thawed, lasts=4.0),
    Fault("master killed and started anew", master_killed, master_again, lasts=3.0),
    Fault("master killed and started anew, then the controller killed", master_killed, then_the_controller,
          touches=(CONTROLLER,), lasts=3.0),
]
