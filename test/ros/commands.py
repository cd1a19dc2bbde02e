#!/usr/bin/python3
"""What people publish acts exactly as the same commands in a loop file. The plant waits for this node as well, so
that every command is there before the first sample."""
import sys
import tempfile
import unittest

import rospy
import rostest
from fmbpc.msg import CommandEffect, Disturbance, Setpoint
from rosgraph_msgs.msg import Log
from std_msgs.msg import String

import exchange

T0_S, SAMPLE_TIME_H = 1, 0.2
OVERRIDE, OFFSET, RELEASE = 1, 2, 3
WORDS = {OVERRIDE: "override", OFFSET: "offset", RELEASE: "release"}
# time [h], name, mode, value
SETPOINTS = [(5, "x", OVERRIDE, 1900.0), (6, "s", OFFSET, 10.0), (12.1, "x", RELEASE, 0.0), (13, "x", OFFSET, -50.0)]
DISTURBANCES = [(4, "q_i", OVERRIDE, 1900.0), (8, "s_i", OFFSET, 50.0), (10, "input/q_r", OVERRIDE, 300.0),
                (11, "input/q_r", RELEASE, 0.0), (13, "output/x", OFFSET, 100.0), (15, "q_i", RELEASE, 0.0)]


def message(kind, time_h, name, mode, value):
    msg = kind(name=[name], value=[value] if mode != RELEASE else [], mode=mode)
    msg.header.stamp = rospy.Time(T0_S) + rospy.Duration.from_sec(time_h * 3600)
    return msg


def key(commands):
    items = [f'{{time_h: {t}, name: {n}, mode: {WORDS[m]}, value: {v!r}}}' for t, n, m, v in commands]
    return "[" + ", ".join(items) + "]"


def steps(commands):
    return [(n, int(-(-t // SAMPLE_TIME_H)) if (t / SAMPLE_TIME_H) % 1 > 1e-9 else round(t / SAMPLE_TIME_H))
            for t, n, _, _ in commands]


class Commands(unittest.TestCase):
    def test_commands_by_topic_act_as_those_of_the_loop_file(self):
        log, recorded = exchange.Listener("/rosout", Log, "/fmbpc_controller", "/plant_simulator"), exchange.Listener("recorded", String)
        effects = {kind: exchange.Listener(kind, CommandEffect) for kind in ("setpoint_effect", "disturbance_effect")}
        active = exchange.Listener("setpoint_active", Setpoint)
        setpoint = exchange.publisher("setpoint", Setpoint, "/fmbpc_controller")
        disturbance = exchange.publisher("disturbance", Disturbance, "/plant_simulator")
        for command in SETPOINTS:
            setpoint.publish(message(Setpoint, *command))
        for command in DISTURBANCES:
            disturbance.publish(message(Disturbance, *command))
        for node, words, count in (("/fmbpc_controller", ": setpoint of", len(SETPOINTS)),
                                   ("/plant_simulator", ": disturbance of", len(DISTURBANCES))):
            exchange.wait_until(lambda n=node, w=words, c=count:
                            sum(m.name == n and w in m.msg for m in list(log.messages)) == c, f"{node} to take all")
        exchange.begin()

        folder = recorded.wait().data
        with tempfile.TemporaryDirectory() as reference:
            exchange.run_in_process(rospy.get_param("~loop"), reference, rospy.get_param("~set").split() + [
                "setpoint.commands=" + key(SETPOINTS), "disturbance.commands=" + key(DISTURBANCES)])
            exchange.assert_same_run(self, folder, reference)
        for topic, commands in (("setpoint_effect", SETPOINTS), ("disturbance_effect", DISTURBANCES)):
            effects[topic].wait(lambda m, last=commands[-1]: m.step == steps([last])[0][1])
            self.assertEqual([(m.name[0], m.step) for m in effects[topic].messages], steps(commands))
        active.wait(lambda m: m.name == ["s", "x"] and list(m.value) == [10.0, -50.0] and m.mode == OFFSET)


if __name__ == "__main__":
    rospy.init_node("commands")
    rostest.rosrun("fmbpc", "commands", Commands, sys.argv)
