#!/usr/bin/python3
"""What the loops of a plant cost in one process: processor time, memory and late samples for each number of loops, one sample a second each.
  bench/plant_bench.py [--seconds 60] [--loop asp_case1_clp] N ...
  bench/plant_bench.py --lockstep N         samples a second of N loops in lockstep beside one loop as four nodes, in turn, three times"""
import argparse
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import launching
import yaml

LATE = ("held", "fallback")  # sources of an action that nobody sent in time


def ticks_of(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def memory_of(pid):
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024
    return 0.0


def pid_of(name, uri):
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")
            if words and words[0].endswith(b"/" + name.encode()) and f"ROS_MASTER_URI={uri}".encode() in (process / "environ").read_bytes():
                return int(process.name)
        except OSError:
            continue
    return None


def measure(loop, count, seconds):
    with tempfile.TemporaryDirectory() as folder, launching.master() as env:
        resolved = yaml.safe_load(subprocess.run(["fmbpc", "resolve", loop], capture_output=True, text=True, check=True).stdout)
        sample_time = resolved["sampling"]["sample_time_s"]
        plant = {"pace": "realtime", "speedup": sample_time,
                 "set": {"sampling.duration_h": (seconds + 5 * count + 600) * sample_time / 3600},  # none ends before it was measured
                 "loops": {f"l{i:03}": {"loop": loop} for i in range(count)}}
        file = pathlib.Path(folder, "plant.yaml")
        file.write_text(yaml.safe_dump(plant), encoding="utf-8")
        names = [f"/l{i:03}/measurement" for i in range(count)]
        out = pathlib.Path(folder, "out")
        with launching.launched(env, ["fmbpc", "plant.launch", f"plant:={file}", f"out:={out}"], "loop", names) as (launch, ready):
            pid = pid_of("plant_host", env["ROS_MASTER_URI"])
            began, used = time.monotonic(), ticks_of(pid)
            time.sleep(seconds)
            used = (ticks_of(pid) - used) / (time.monotonic() - began)
            memory = memory_of(pid)
            launch.send_signal(signal.SIGINT)
            launch.wait()
        steps, late = 0, 0
        for summary in out.glob("*/summary.json"):
            read = json.loads(summary.read_text())
            steps += read["steps"]
            late += sum(read.get("sources", {}).get(source, 0) for source in LATE)
        return {"loops": count, "core_percent": 100 * used, "mb": memory, "ready_s": ready, "samples": steps, "late": late}


def samples_per_second(env, launch, out):
    """Of a launch that ends by itself: samples of all its loops over the time of the one that took longest."""
    subprocess.run(["roslaunch", *launch, f"out:={out}"], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
    runs = [json.loads(summary.read_text()) for summary in [*out.glob("summary.json"), *out.glob("*/summary.json")]]
    return sum(r["steps"] for r in runs) / max(r["wall_s"] for r in runs)


def lockstep(loop, count):
    hours = {1: 2000, count: 200}
    rates = {1: [], count: []}
    for _ in range(3):
        for n in rates:
            with tempfile.TemporaryDirectory() as folder, launching.master() as env:
                folder = pathlib.Path(folder)
                file = folder / "plant.yaml"
                file.write_text(yaml.safe_dump({"pace": "lockstep", "set": {"sampling.duration_h": hours[n]},
                                                "loops": {f"l{i:03}": {"loop": loop} for i in range(n)}}), encoding="utf-8")
                alone = ["fmbpc", "loop.launch", f"loop:={loop}", "pace:=lockstep", "draw:=false", f"set:=sampling.duration_h={hours[n]}"]
                rates[n].append(samples_per_second(env, alone if n == 1 else ["fmbpc", "plant.launch", f"plant:={file}"], folder / "out"))
    ratios = sorted(many / one for one, many in zip(rates[1], rates[count]))
    print(f"one loop as four nodes: {sorted(rates[1])[1]:.0f} samples/s; {count} loops in one process: {sorted(rates[count])[1]:.0f}; "
          f"ratio {ratios[1]:.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("counts", nargs="+", type=int, metavar="N")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--loop", default="asp_case1_clp")
    parser.add_argument("--lockstep", action="store_true")
    asked = parser.parse_args()
    if asked.lockstep:
        for count in asked.counts:
            lockstep(asked.loop, count)
        return
    print("loops  of a core  memory  ready  samples  late")
    for count in asked.counts:
        row = measure(asked.loop, count, asked.seconds)
        print(f"{row['loops']:5}  {row['core_percent']:8.1f} %  {row['mb']:3.0f} MB  {row['ready_s']:3.0f} s  {row['samples']:7}  {row['late']:4}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
