#!/usr/bin/python3
"""A long run in lockstep while things happen to it: nodes are killed and hang for a moment, strangers speak, people ask. No
sample may be lost, no limit broken, and no node may grow, the recorder while it makes the files of the run from its journal
included. Run with scripts/soak.

  --samples N      of the run (default 3000000)
  --injections N   (default 10000)
  --seed N         (default 1)
  --hours H        end the launch after this time, finished or not; what was reached is judged (default: wait for the end)
  --out FOLDER     figure soak.png and soak.json (default: build/soak)
"""
import argparse
import csv
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "ros")]
import exchange  # noqa: E402

import rosgraph  # noqa: E402
import rospy  # noqa: E402
from fmbpc.msg import ControlAction, FuzzyModel, LoopState, Measurement, PlantInfo, PredictiveAction, Setpoint, Tracking  # noqa: E402

LOOP, TS_H = "asp_case1_clp", 0.2
NODES = ("plant_simulator", "fmbpc_controller", "clp_optimizer", "fuzzy_identifier", "loop_recorder")
KILLED = ("fmbpc_controller", "clp_optimizer", "fuzzy_identifier")  # in lockstep the loop waits for them; nobody waits for a recorder
MOVE, GROWTH = 40.0, 4096.0  # m3/h a sample; kB from the middle of the run to its end


class Soak:
    def __init__(self, samples, seed):
        self.samples, self.random, self.latest, self.rows = samples, random.Random(seed), None, []
        self.master, self.counts, self.started = rosgraph.Master("/soak"), {}, time.monotonic()
        rospy.Subscriber("loop_state", LoopState, self.on_state, queue_size=5)
        self.info = None
        rospy.Subscriber("plant_info", PlantInfo, lambda m: setattr(self, "info", m), queue_size=1)
        kinds = {"measurement": Measurement, "control_action": ControlAction, "base_action": ControlAction,
                 "predictive_action": PredictiveAction, "tracking": Tracking, "fuzzy_model": FuzzyModel, "setpoint": Setpoint}
        self.publishers = {topic: rospy.Publisher(topic, kind, queue_size=10) for topic, kind in kinds.items()}

    def on_state(self, message):
        if message.summary:
            self.latest = message

    def pid(self, node):
        import xmlrpc.client
        try:
            return xmlrpc.client.ServerProxy(self.master.lookupNode("/" + node)).getPid("/soak")[2]
        except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
            return 0

    # What happens.
    def forge(self):
        topic, run, step = self.random.choice(("measurement", "control_action", "base_action", "predictive_action", "tracking",
                                               "fuzzy_model")), self.info.run_id, self.latest.step
        step += self.random.choice((0, 1, 2, 4000000))
        message = self.publishers[topic].data_class()
        if hasattr(message, "step"):
            message.run_id, message.step = run, step
        if topic == "measurement":
            message.outputs, message.disturbances, message.input_applied = [1.0, 1.0], [1.0, 1.0], [900.0]
        if topic in ("control_action", "base_action"):
            message.input, message.source = [1600.0], 1
        self.publishers[topic].publish(message)

    def ask(self):
        self.publishers["setpoint"].publish(name=["x"], value=[self.random.uniform(1700.0, 2300.0)], mode=Setpoint.OVERRIDE)

    def kill(self):
        process = self.pid(self.random.choice(KILLED))
        if process:
            os.kill(process, signal.SIGKILL)

    def blink(self):
        process = self.pid(self.random.choice(NODES))
        if process:
            os.kill(process, signal.SIGSTOP)
            time.sleep(0.02)
            os.kill(process, signal.SIGCONT)

    def inject(self):
        what = self.random.choices((self.forge, self.ask, self.blink, self.kill), (60, 25, 13, 2))[0]
        self.counts[what.__name__] = self.counts.get(what.__name__, 0) + 1
        what()

    def look(self):
        memory = {}
        for node in NODES:
            process = self.pid(node)
            if process:
                status = pathlib.Path(f"/proc/{process}/status").read_text(encoding="utf-8")
                memory[node] = int(status.split("VmRSS:")[1].split()[0])
        self.rows.append({"seconds": time.monotonic() - self.started, "step": self.latest.step, "pids":
                          {n: self.pid(n) for n in NODES}, "memory_kB": memory})

    def peak(self, node):
        """Largest memory that a node ever had [kB]."""
        status = pathlib.Path(f"/proc/{self.pid(node)}/status").read_text(encoding="utf-8")
        return int(status.split("VmHWM:")[1].split()[0])

    def run(self, injections, seconds):
        """Injects until the run is over, or for so many seconds."""
        exchange.wait_until(lambda: self.latest is not None and self.info is not None and self.latest.step > 0,
                        "the run", 600.0)
        done, looked = 0, -1
        while self.latest.word != "finished" and time.monotonic() - self.started < seconds:
            due = injections * self.latest.step // max(1, int(0.99 * self.samples))  # the last ones before the end
            if done < min(due, injections):
                self.inject()
                done += 1
            share = 50 * self.latest.step // self.samples
            if share > looked:
                looked = share
                self.look()
                print(f"sample {self.latest.step}, {done} injections, {self.latest.step / self.rows[-1]['seconds']:.0f} a second",
                      flush=True)
            time.sleep(0.005)
        self.finished, self.reached = time.monotonic() - self.started, self.latest.step
        self.recorder_peak = self.peak("loop_recorder")
        return done


def violations(folder):
    """Rows, the last one's sample, and broken limits of the record."""
    rows = broken = 0
    before, step = None, -1
    with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
        for row in csv.DictReader(file):
            rows += 1
            step = round(float(row["time[h]"]) / TS_H)
            if not row["q_r[m3/h]"]:
                continue
            value = float(row["q_r[m3/h]"])
            broken += not 0.0 <= value <= 1600.0
            broken += before is not None and abs(value - before) > MOVE + 1e-6
            before = value
    return rows, step, broken


def growth(rows):
    """kB by which each node has grown from the middle of its last life to the end."""
    result = {}
    for node in NODES:
        life = [r["memory_kB"][node] for r in rows if node in r["memory_kB"] and r["pids"][node] == rows[-1]["pids"][node]]
        result[node] = life[-1] - life[len(life) // 2] if len(life) > 3 else 0
    return result


def draw(rows, file):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot
    figure, axis = pyplot.subplots(figsize=(7, 3.5))
    for node in NODES:
        axis.plot([r["step"] for r in rows if node in r["memory_kB"]],
                  [r["memory_kB"][node] / 1024.0 for r in rows if node in r["memory_kB"]], label=node)
    axis.set_xlabel("sample")
    axis.set_ylabel("memory [MB]")
    axis.legend(fontsize="small")
    axis.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(file, dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=3000000)
    parser.add_argument("--injections", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hours", type=float, default=float("inf"))
    parser.add_argument("--out", default=str(HERE.parent.parent / "build" / "soak"))
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    port = exchange.free_port()
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
    with open(os.path.join(arguments.out, "launch.log"), "w", encoding="utf-8") as log:
        launch = subprocess.Popen(
            exchange.tied(["roslaunch", "-p", port, "fmbpc", "loop.launch", "loop:=" + LOOP, "pace:=lockstep", "respawn:=true",
                       "keep:=true", f"set:=sampling.duration_h={arguments.samples * TS_H!r} disturbance.source=constant "
                       "actuator.move_upper.q_r=40", "out:=" + arguments.out, "draw:=false", "sim_time:=false"]),
            stdout=log, stderr=log, start_new_session=True)
    try:
        exchange.wait_until(rosgraph.is_master_online, "the master", 600.0)
        rospy.init_node("soak", disable_signals=True, disable_rosout=True)
        soak = Soak(arguments.samples, arguments.seed)
        done = soak.run(arguments.injections, 3600.0 * arguments.hours)
        if soak.latest.word != "finished":
            launch.send_signal(signal.SIGINT)
            launch.wait(600)
        summary = os.path.join(arguments.out, "summary.json")
        begun = time.time() - (time.monotonic() - soak.started)
        exchange.wait_until(lambda: os.path.exists(summary) and os.path.getmtime(summary) > begun, "the record", 600.0)
        time.sleep(1.0)
        finishing = soak.peak("loop_recorder") - soak.recorder_peak if launch.poll() is None else 0
    finally:
        launch.terminate()
        launch.wait(60)
    rows, last, broken = violations(arguments.out)
    lost = max(soak.reached, last) + 1 - rows
    with open(summary, encoding="utf-8") as file:
        said = json.load(file)
    complete, gaps = said["complete"], [e for e in said["events"] if e["code"] == "record_gap"]
    grown = growth(soak.rows)
    seconds = soak.finished
    result = {"samples": rows - 1, "asked": arguments.samples, "lost": lost, "complete": complete, "gaps": gaps, "violations": broken,
              "injections": done, "kinds": soak.counts, "seconds": seconds, "samples_per_s": rows / seconds,
              "grown_kB": grown, "recorder_finish_kB": finishing, "rows": soak.rows}
    pathlib.Path(arguments.out, "soak.json").write_text(json.dumps(result, indent=1), encoding="utf-8")
    draw(soak.rows, os.path.join(arguments.out, "soak.png"))
    print(json.dumps({k: v for k, v in result.items() if k != "rows"}, indent=1))
    bad = not complete or rows < arguments.samples + 1 or lost or broken or max(grown.values()) > GROWTH or finishing > GROWTH
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
