#!/usr/bin/python3
"""Somebody publishes on every topic of the exchange while a loop with optimizer runs: the run stays the same, bit for bit. With
loop.publishers as they are (~closed) valid answers of an impostor, forged plants and steps to come as well as rubbish; in a loop
that listens to anyone rubbish, which every receiver must refuse for what it is."""
import copy
import itertools
import math
import sys
import tempfile
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from fmbpc.msg import (ControlAction, Disturbance, FuzzyModel, LoopState, Matrix, Measurement, NodeReady, OperatorState,
                       PlantInfo, PlantState, PredictiveAction, Setpoint, SolverReport, Tracking)
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

import exchange

FAR = 2 ** 63  # a run that no plant has announced
LIE = "a lie"
KINDS = {"control_action": ControlAction, "base_action": ControlAction, "predictive_action": PredictiveAction,
         "measurement": Measurement, "plant_state": PlantState, "tracking": Tracking, "solver_report": SolverReport,
         "setpoint": Setpoint, "disturbance": Disturbance, "fuzzy_model": FuzzyModel, "plant_info": PlantInfo,
         "loop_state": LoopState, "ready": NodeReady, "operator_state": OperatorState}
PLANT, CONTROLLER, OPTIMIZER, RECORDER = NODES = ("/plant_simulator", "/fmbpc_controller", "/clp_optimizer", "/loop_recorder")
RECEIVERS = {"control_action": (PLANT, RECORDER), "base_action": (OPTIMIZER, RECORDER), "predictive_action": (OPTIMIZER,),
             "measurement": (CONTROLLER, RECORDER), "plant_state": (RECORDER,), "tracking": (RECORDER,),
             "solver_report": (RECORDER,), "setpoint": (CONTROLLER,), "disturbance": (PLANT,), "fuzzy_model": (CONTROLLER,),
             "plant_info": (CONTROLLER, OPTIMIZER, RECORDER), "loop_state": (PLANT, CONTROLLER), "ready": (PLANT,),
             "operator_state": (PLANT,)}


def rubbish(now):
    """(topic, message) to publish when the plant shows sample `now`."""
    this = {"run_id": now.run_id, "step": now.step}
    yield "control_action", ControlAction(input=[], source=1, **this)
    yield "control_action", ControlAction(input=[1.0, 2.0], source=1, **this)
    yield "control_action", ControlAction(input=[math.nan], source=1, **this)
    yield "control_action", ControlAction(input=[700.0], source=99, **this)
    yield "base_action", ControlAction(input=[], source=1, **this)
    yield "base_action", ControlAction(input=[700.0], source=0, **this)
    yield "predictive_action", PredictiveAction(A=Matrix(2, 2, [1.0]), **this)
    yield "measurement", Measurement(outputs=[1.0], **this)
    yield "plant_state", PlantState(state=[1.0], **this)
    yield "tracking", Tracking(setpoint=[1.0], **this)
    yield "solver_report", SolverReport(perturbation=[], status=1, **this)
    for topic, kind in KINDS.items():
        yield topic, kind()
    for run_id in (1, now.run_id - 1, FAR + now.step):
        yield "control_action", ControlAction(run_id=run_id, step=now.step, input=[700.0], source=1)
        yield "base_action", ControlAction(run_id=run_id, step=now.step, input=[700.0], source=1)
        yield "predictive_action", PredictiveAction(run_id=run_id, step=now.step)
        yield "measurement", Measurement(run_id=run_id, step=now.step, outputs=now.outputs,
                                         disturbances=now.disturbances, input_applied=now.input_applied)
        yield "tracking", Tracking(run_id=run_id, step=now.step, setpoint=[1.0, 1.0], reference=[1.0, 1.0])
    if now.step > 1:
        yield "control_action", ControlAction(run_id=now.run_id, step=now.step - 2, input=[700.0], source=1)
        yield "measurement", Measurement(run_id=now.run_id, step=now.step - 2, outputs=[1.0, 1.0],
                                         disturbances=now.disturbances, input_applied=now.input_applied)
    yield "setpoint", Setpoint(name=["nobody"], value=[1.0], mode=1)
    yield "disturbance", Disturbance(name=["q_i"], value=[math.inf], mode=1)


def impostors(now, info):
    """What would be taken if it came from a node of the loop: answers in time, runs, steps to come, an early end."""
    this = {"run_id": now.run_id, "step": now.step}
    measured = {"run_id": now.run_id, "outputs": now.outputs, "disturbances": now.disturbances,
                "input_applied": now.input_applied}
    for topic in ("control_action", "base_action"):
        for step in (now.step, now.step + 1, now.step + 4000000):
            yield topic, ControlAction(run_id=now.run_id, step=step, input=[700.0], source=1)
    for step in (now.step + 1, now.step + 2, now.step + 4000000, now.step + 4000001):
        yield "measurement", Measurement(step=step, **measured)
    yield "measurement", Measurement(step=now.step + 1, final=True, **measured)
    forged = copy.deepcopy(info)
    forged.run_id = FAR
    yield "plant_info", forged
    yield "measurement", Measurement(step=now.step, **{**measured, "run_id": FAR})
    yield "plant_info", info
    yield "tracking", Tracking(setpoint=[1.0, 1.0], reference=[1.0, 1.0], **this)
    yield "solver_report", SolverReport(perturbation=[9.0], status=1, **this)
    yield "loop_state", LoopState(node="/loop_recorder", mode=LoopState.FAILED, word="failed", reason=LIE, **this)
    yield "loop_state", LoopState(node=PLANT, summary=True, mode=LoopState.FINISHED, word="finished", reason=LIE, **this)
    yield "ready", NodeReady(node="/loop_recorder")
    yield "operator_state", OperatorState(node=CONTROLLER, run_id=now.run_id, manual=True)


OPEN = (("plant_simulator", ("actions dropped: wrong size", "actions dropped: other run", "refused: control_action",
                             "refused: disturbance")),
        ("fmbpc_controller", ("dropped: wrong size", "refused: setpoint", "refused: fuzzy_model", "refused: plant_info",
                              "dropped: run not announced")),
        ("clp_optimizer", ("refused: base_action", "refused: predictive_action", "dropped: run not announced")),
        ("loop_recorder", ("dropped: other run", "dropped: wrong size or not finite")))
CLOSED = (("plant_simulator", ("refused: control_action from /intruder", "refused: disturbance",
                               "refused: loop_state from /intruder", "refused: ready from /intruder",
                               "refused: operator_state from /intruder", "refused: services from /intruder")),
          ("fmbpc_controller", ("refused: measurement from /intruder", "refused: plant_info from /intruder",
                                "refused: fuzzy_model from /intruder", "refused: setpoint",
                                "refused: services from /intruder")),
          ("clp_optimizer", ("refused: base_action from /intruder", "refused: plant_info from /intruder")),
          ("loop_recorder", ("refused: measurement from /intruder", "refused: tracking from /intruder",
                             "refused: solver_report from /intruder", "refused: control_action from /intruder")))


class Intruder(unittest.TestCase):
    def test_rubbish_on_every_topic_changes_nothing_and_is_counted(self):
        loop, sets = rospy.get_param("~loop"), rospy.get_param("~set").split()
        recorded, diagnostics = exchange.Listener("recorded", String), exchange.Listener("/diagnostics", DiagnosticArray, *NODES)
        measurements, states = exchange.Listener("measurement", Measurement), exchange.Listener("loop_state", LoopState, PLANT)
        closed, info = rospy.get_param("~closed"), exchange.Listener("plant_info", PlantInfo).wait()
        publishers = {topic: exchange.publisher(topic, kind, *RECEIVERS[topic]) for topic, kind in KINDS.items()}
        exchange.Listener("ready", NodeReady, "/fmbpc_controller").wait(lambda m: m.node == "/fmbpc_controller")
        plant = exchange.NodeStatus("plant_simulator")

        def genuine(message):  # what this test forges comes back to it
            return message._connection_header["callerid"] == "/plant_simulator"

        def disturb(now):
            for topic, message in itertools.chain(rubbish(now), impostors(now, info) if closed else ()):
                publishers[topic].publish(message)
        with exchange.Frozen("/fmbpc_controller"):  # nobody else answers sample 0
            exchange.begin()
            disturb(measurements.wait(genuine))
            if not closed:
                plant.wait(lambda s: int(exchange.values(s).get("actions dropped: wrong size", 0)) > 0)
        if closed:
            self.call_services()
        for step in itertools.count(1):
            now = measurements.wait(lambda m, s=step: genuine(m) and m.step >= s)
            if now.final:
                break
            disturb(now)
        folder = recorded.wait().data
        with tempfile.TemporaryDirectory() as reference:
            exchange.run_in_process(loop, reference, sets)
            exchange.assert_same_run(self, folder, reference, beyond="command_refused")
        said = [e["text"] for e in exchange.summary(folder)["events"] if e["code"] == "command_refused"]
        for name in ("nobody", "q_i"):  # on setpoint and on disturbance
            self.assertTrue(any(name in text for text in said), said)
        self.assertEqual([], [s.reason for s in states.messages if s.summary and LIE in s.reason])
        for node, keys in CLOSED if closed else OPEN:
            diagnostics.wait(lambda m, n=node, k=keys: exchange.diagnostics_of(m, n) is not None and all(
                int(exchange.values(exchange.diagnostics_of(m, n)).get(key, 0)) > 0 for key in k))


    def call_services(self):
        for service in ("plant_simulator/pause", "fmbpc_controller/manual", "fmbpc_controller/hold"):
            answer = rospy.ServiceProxy(service, SetBool)(True)
            self.assertEqual((False, "refused: "), (answer.success, answer.message[:9]), service)
        for service in ("plant_simulator/step", "plant_simulator/reset"):
            self.assertFalse(rospy.ServiceProxy(service, Trigger)().success, service)


if __name__ == "__main__":
    rospy.init_node("intruder")
    rostest.rosrun("fmbpc", "intruder", Intruder, sys.argv)
