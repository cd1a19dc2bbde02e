#!/usr/bin/python3
"""The fault matrix: every fault on running loops, paced, in realtime, and as nodelets. Each group of faults has a launch of its
own with a master of its own; a loop that does not come back is started anew and counts as not recovered. When a launch has ended
its record is compared with what the plant showed on its topics.

    run with scripts/faults; --quick is what belongs to every change
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "ros")]

RING = ("plant_info", "measurement", "plant_state", "base_action", "predictive_action", "control_action", "tracking",
        "solver_report", "fuzzy_model", "identified")
OPEN = " ".join(f"loop.publishers.{topic}=[]" for topic in RING)
LOOPS = {
    "asp_case1_clp": dict(
        sets="sampling.duration_h=0 disturbance.source=constant actuator.move_upper.q_r=40 "
             "actuator.fallback.q_r=300", sample_time=720.0, has=("optimizer", "model", "wide")),
    "mimo_cstr_steps": dict(
        sets="sampling.duration_h=0 setpoint.schedule=[] disturbance={} noise.std.T=0.02 actuator.move_upper.q=2.5 "
             "actuator.move_upper.qc=3.75 actuator.fallback.q=90 actuator.fallback.qc=90",
        sample_time=0.6, has=("model",)),
    "cstr_modbus": dict(sets="sampling.duration_h=0 setpoint.schedule=[]", sample_time=6.0, has=("gateway", "modbus", "model"), move=0.02),
    "example_external": dict(
        sets="sampling.duration_h=0 setpoint.schedule=[] gateway.stale_s=1 gateway.tags.inflow.readback=tank/inflow_read "
             "gateway.tags.level.topic=tank/state_read loop.publishers.tags=[example_plant,fault_matrix]", sample_time=60.0, has=("gateway", "float64", "wide"), move=0.1),
}
# wide: wherever its inputs lead the plant, it comes back, and the model, if any, has data there
MOVE = 0.025  # largest move a sample, share of the input's range
COMMON = "actuator.hold_samples=5 loop.action_timeout_s=1.5"
PERIOD = {"paced": 0.1, "realtime": 0.2, "nodelets": 0.2}  # s of wall time a sample; nodelets: realtime, in one process
GROUPS = {"closed": ("processes", "strangers", "by_hand", "instruments", "gateway", "links", "world", "launcher"),
          "open": ("rubbish", "models")}
QUICK = ("fmbpc_controller killed (-9)", "clp_optimizer frozen for 6 s", "fmbpc_controller frozen for 3 s",
         "stranger: control_action, valves open, in time", "manual, controller killed", "person: plant paused and resumed",
         "valve stuck open", "loop_recorder: publisherUpdate with empty lists", "rosnode cleanup while fmbpc_controller hangs for 3 s")


class Launch:
    """roscore and roslaunch with their own port and folder; the rospy node of this process talks to that master."""

    def __init__(self, name, pace, group, folder):
        self.name, self.pace, self.folder = name, pace, folder
        self.core = self.launch = self.far = None
        self.open = OPEN if group == "open" else ""
        self.clock = os.path.join(folder, "clock")
        self.disk = os.path.join(folder, "disk")
        os.makedirs(self.disk, exist_ok=True)
        self.small = os.geteuid() == 0 and subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=32m", "tmpfs", self.disk], check=False, stderr=subprocess.DEVNULL).returncode == 0
        self.library = os.path.join(folder, "clock_shim.so")
        made = shutil.which("cc") and subprocess.run(
            ["cc", "-shared", "-fPIC", "-O1", "-o", self.library, str(HERE / "clock_shim.c"), "-ldl"], check=False).returncode == 0
        self.library = self.library if made else None

    def has(self):
        about = LOOPS[self.name]["has"] + (("nodelets",) if self.pace == "nodelets" else ("processes",))
        about += () if self.far else ("simulator",)
        return about + (("disk",) if self.small else ()) + (("clock",) if self.library else ())

    def start_core(self):
        self.core = subprocess.Popen(["rosmaster", "--core", "-p", os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]],
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        wait_for_master()

    def start(self):
        about = LOOPS[self.name]
        self.far = far_side(self.name, self.folder)
        environment = dict(os.environ)
        if self.library:
            pathlib.Path(self.clock).write_text("0", encoding="utf-8")
            environment.update(LD_PRELOAD=self.library, FMBPC_CLOCK_OFFSET=self.clock)
        out = open(os.path.join(self.folder, "launch.log"), "a", encoding="utf-8")
        self.launch = subprocess.Popen(
            ["roslaunch", "fmbpc", "loop.launch", "loop:=" + self.name, f"pace:={self.pace.replace('nodelets', 'realtime')}",
             f"nodelets:={str(self.pace == 'nodelets').lower()}", "respawn:=true", "keep:=true",
             f"set:={about['sets']} {self.far.sets if self.far else COMMON} {self.open}",
             f"speedup:={about['sample_time'] / PERIOD[self.pace]}",
             "out:=" + self.disk, "draw:=false", "sim_time:=false"], env=environment, stdout=out, stderr=out,
            start_new_session=True)
        out.close()

    def end(self, nodes=()):
        """`nodes`: processes that outlive a launch that was killed."""
        for process in nodes:
            stop(process)
        for process, seconds in ((self.launch, 30), (self.core, 5)):
            if process is None:
                continue
            if process.poll() is None:
                process.terminate()
            try:
                process.wait(seconds)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        if self.far:
            self.far.end()

    def remove(self, whole):
        """What a launch leaves stays only where something was wrong with it."""
        if self.small and not whole:
            shutil.copytree(self.disk, os.path.join(self.folder, "record"))
        if self.small:
            subprocess.run(["umount", "-l", self.disk], check=False)
        if whole:
            shutil.rmtree(self.folder, ignore_errors=True)


def stop(process):
    """As roslaunch does it."""
    import exchange
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        if process and exchange.runs(process):
            os.kill(process, number)
            end = time.monotonic() + 15
            while exchange.runs(process) and time.monotonic() < end:
                time.sleep(0.05)


def wait_for_master():
    import rosgraph
    end = time.monotonic() + 20
    while time.monotonic() < end:
        if rosgraph.is_master_online():
            return
        time.sleep(0.05)
    raise RuntimeError("no master")


def far_side(name, folder):
    """What stands behind the loop's gateway; None: it has none."""
    from gateway import PlcBehindWire, TankBehindRelay
    makers = {"modbus": PlcBehindWire, "float64": TankBehindRelay}
    return next((makers[what](folder) for what in LOOPS[name]["has"] if what in makers), None)


def paces_of(name):
    has_gateway = {"modbus", "float64"} & set(LOOPS[name]["has"])
    return [pace for pace in PERIOD if pace != "paced" or not has_gateway]  # whose plant waits for nobody


def faults_of(group):
    faults = []
    for family in GROUPS[group]:
        faults += [(family, fault) for fault in __import__(family).FAULTS]
    return faults


def ready(launch):
    """The loop under test, automatic."""
    from loop_under_test import Loop
    plant = "plant_gateway" if launch.far else "plant_simulator"
    nodes = [plant, "fmbpc_controller", "loop_recorder"] + [node for node, part in (("fuzzy_identifier", "model"), ("clp_optimizer", "optimizer"))
                                                            if part in launch.has()]
    loop = Loop(["loop_manager"] if launch.pace == "nodelets" else nodes, plant)
    loop.clock, loop.disk, loop.core, loop.start_core, loop.far = launch.clock, launch.disk, launch.core, None, launch.far
    loop.launch, loop.wide = launch.launch, "wide" in launch.has()

    def start_core():
        launch.start_core()
        loop.core = launch.core
    loop.start_core = start_core

    def known():
        end = time.monotonic() + 15
        while not all(loop.pid(node) for node in loop.nodes):
            if time.monotonic() > end:
                raise RuntimeError("nodes unknown to the new master: " + ", ".join(n for n in loop.nodes if not loop.pid(n)))
            time.sleep(0.1)
    loop.wait_until_known = known
    started = time.monotonic()
    if loop.wait_for_summary("automatic", started, 60.0) is None:
        raise RuntimeError(f"{launch.name} did not become automatic: see {launch.folder}/launch.log")
    loop.samples(10)
    return loop


def begin(launch):
    """One process, one node: called in a child, since rospy starts once a process."""
    import rospy
    launch.start_core()
    rospy.init_node("fault_matrix", disable_signals=True, disable_rosout=True)
    launch.start()
    return ready(launch)


def can_be_met(launch, fault):
    return set(fault.needs) | ({"processes"} if fault.touches else set()) <= set(launch.has())


def meet_all(launch, loop, faults, met, report):
    """Adds to `met` the faults, each with its outcome, until one from which the loop does not come back."""
    from judge import Limits, meet
    limits = Limits(loop.info(), LOOPS[launch.name].get("move", MOVE))
    for family, fault in faults:
        if not can_be_met(launch, fault):
            continue
        met.append((fault, meet(loop, limits, fault)))
        loop.thaw()
        loop.end_children()
        report({"family": family, **vars(met[-1][1])})
        if met[-1][1].back_after is None:
            break
        loop.samples(2)  # between two faults there is none


def judge_records(launch, loop, met):
    """{name of a fault: what is wrong with the rows of its time}, once the launch has ended."""
    import record
    info, plant = loop.info(), "/loop_manager" if launch.pace == "nodelets" else "/" + loop.plant
    filed, measurements = record.filed(launch.disk, record.signals(info)), loop.logs["measurement"]

    def seen(outcome):
        return record.shown([item for item in measurements.since(outcome.began) if item[0] < outcome.ended], plant)
    return {fault.name: record.complaints(filed, seen(outcome), info, fault.gap or launch.pace != "paced" and "loop_recorder" in fault.touches)
            for fault, outcome in met}


def end_with_finally(*_):
    raise SystemExit(1)


def child(arguments):
    """Runs faults [first, last) of a group in this process and prints a line of JSON for each."""
    import exchange
    folder = tempfile.mkdtemp(prefix="fmbpc_faults_")
    os.environ.update(ROS_MASTER_URI=f"http://localhost:{exchange.free_port()}", ROS_HOME=os.path.join(folder, "home"))
    signal.signal(signal.SIGTERM, end_with_finally)
    launch = Launch(arguments.loop, arguments.pace, arguments.group, folder)
    faults = chosen(arguments, arguments.group)[arguments.first:]
    loop, met, filed = None, [], {}
    try:
        loop = begin(launch)
        meet_all(launch, loop, faults, met, lambda result: print("RESULT " + json.dumps(result), flush=True))
        if met and met[-1][1].back_after is not None:
            loop.samples(3)  # so that what was seen last has its rows
    finally:
        launch.end(loop.pids().values() if loop and launch.launch.poll() is not None else ())
        try:
            if met:
                filed = judge_records(launch, loop, met)
                print("RECORD " + json.dumps(filed), flush=True)
        finally:
            launch.remove(filed and not any(filed.values()) and all(outcome.back_after is not None for _, outcome in met))
    return 0


def chosen(arguments, group):
    faults = faults_of(group)
    if arguments.quick:
        faults = [(family, fault) for family, fault in faults if fault.name in QUICK]
    if arguments.only:
        faults = [(family, fault) for family, fault in faults if re.search(arguments.only, fault.name)]
    return faults


def run_config(arguments, name, pace, group):
    """All faults of a group, with a new launch after each that the loop did not survive."""
    results, first = [], 0
    total = len(chosen(arguments, group))
    while first < total:
        command = [sys.executable, __file__, "--child", "--loop", name, "--pace", pace, "--group", group, "--first", str(first)]
        command += ["--quick"] if arguments.quick else []
        command += ["--only", arguments.only] if arguments.only else []
        got = []
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            try:
                for line in process.stdout:
                    if line.startswith("RESULT "):
                        got.append(json.loads(line[7:]))
                        tell(name, pace, got[-1])
                        keep(arguments.out, {"loop": name, "pace": pace, **got[-1]})
                    if line.startswith("RECORD "):
                        add_records(got, json.loads(line[7:]), f"{name} {pace}")
            except BaseException:
                process.terminate()
                raise
        results += got
        if process.returncode == 0 and (not got or got[-1]["back_after"] is not None):
            break
        names = [fault.name for _, fault in chosen(arguments, group)]
        if not got:
            results.append({"family": group, "fault": names[first], "problems": [f"no result: {name} did not start"],
                            "back_after": None, "said_after": None, "said_words": "", "largest_move": 0.0, "bump": 0.0})
            first += 1
        else:
            first = names.index(got[-1]["fault"]) + 1
    return [{"loop": name, "pace": pace, **result} for result in results]


def add_records(results, problems, where):
    for result in results:
        result["problems"] += problems[result["fault"]]
        if problems[result["fault"]]:
            print(f"{where}: {result['fault']}:" + "".join("\n    PROBLEM " + p for p in problems[result["fault"]]), flush=True)


def keep(file, result):
    """Beside the results of before, so that a matrix that is cut short leaves what it has seen."""
    if file:
        with open(file + ".part", "a", encoding="utf-8") as stream:
            stream.write(json.dumps(result) + "\n")


def tell(name, pace, result):
    said = f"said {result['said_after']:.1f} s, " if result["said_after"] is not None else ""
    back = f"back after {result['back_after']}" if result["back_after"] is not None else "NOT BACK"
    print(f"{name} {pace}: {result['fault']}: {said}{back}, move {result['largest_move']:.2f} %"
          + "".join("\n    PROBLEM " + p for p in result["problems"][:5]), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="few faults, one loop, paced")
    parser.add_argument("--only", default="", help="regular expression for names of faults")
    parser.add_argument("--loop", action="append", choices=sorted(LOOPS))
    parser.add_argument("--pace", action="append", choices=sorted(PERIOD))
    parser.add_argument("--group", action="append", choices=sorted(GROUPS))
    parser.add_argument("--out", help="JSON of all results")
    parser.add_argument("--list", action="store_true", help="loops and paces")
    parser.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--first", type=int, default=0, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        arguments.loop, arguments.pace, arguments.group = arguments.loop[0], arguments.pace[0], arguments.group[0]
        return child(arguments)
    if arguments.list:
        print("\n".join(f"{name} {pace}" for name in LOOPS for pace in paces_of(name)))
        return 0
    signal.signal(signal.SIGTERM, end_with_finally)
    results = []
    for name in arguments.loop or (["asp_case1_clp"] if arguments.quick else sorted(LOOPS)):
        for pace in arguments.pace or (["paced"] if arguments.quick else paces_of(name)):
            for group in arguments.group or (["closed"] if arguments.quick else sorted(GROUPS)):
                results += run_config(arguments, name, pace, group)
                if arguments.out:
                    pathlib.Path(arguments.out).write_text(json.dumps(results, indent=1), encoding="utf-8")
    bad = [r for r in results if r["problems"]]
    print(f"{len(results)} faults met, {len(bad)} with problems")
    return 1 if bad or not results else 0


if __name__ == "__main__":
    sys.exit(main())
