"""The launch itself is killed: its nodes go on without anybody who would start them again, so this comes last."""
from fault import Fault


def killed(loop):
    loop.launch.kill()
    loop.launch.wait()


FAULTS = [Fault("roslaunch killed (-9)", killed, end="degraded", lasts=2.0, said="roslaunch that started this node was killed",
                said_within=10.0)]
