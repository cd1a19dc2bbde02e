#!/usr/bin/python3
"""Node end_launch signals no process that has got the number of one that has ended; numbers are given out as asked in a
namespace of their own."""
import os
import pathlib
import signal
import subprocess
import sys
import unittest
from unittest import mock

TOP = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "scripts"))
OWN_NUMBERS = ["unshare", "--user", "--map-root-user", "--pid", "--fork", "--mount-proc"]

try:
    import end_launch
except ImportError:
    end_launch = None


def sleeper():
    return subprocess.Popen(["sleep", "60"], start_new_session=True)


def end(process):
    process.kill()
    process.wait()


def in_its_place(process):
    """Another process of its number."""
    end(process)
    pathlib.Path("/proc/sys/kernel/ns_last_pid").write_text(str(process.pid - 1), encoding="utf-8")
    return sleeper()


@unittest.skipIf(end_launch is None, "built without ROS")
class Numbers(unittest.TestCase):
    def test_another_process_of_the_same_number_gets_no_signal(self):
        if subprocess.run([*OWN_NUMBERS, "true"], check=False, stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("no namespaces here")
        subprocess.run([*OWN_NUMBERS, sys.executable, __file__, "inside"], check=True)


def inside():
    first = sleeper()
    held = end_launch.Process(first.pid)
    assert held.send(0)
    second = in_its_place(first)
    assert second.pid == first.pid
    with mock.patch("os.getppid", return_value=second.pid):
        end_launch.end_launch(held, set())
    assert not held.send(signal.SIGKILL)
    try:
        second.wait(0.5)
        raise AssertionError("the other process was signalled")
    except subprocess.TimeoutExpired:
        end(second)


if __name__ == "__main__":
    inside() if sys.argv[1:] == ["inside"] else unittest.main()
