#!/usr/bin/python3
"""The loop over topics beside a bare ring of three processes, and as nodelets beside a bare ring in one process:
ring_bench.py [ROUNDS] [LOOP] [HOURS]

In every round they run one after the other, each with a master of its own, for as many samples as HOURS of the
loop have (4000 h: 20,000 samples, 2 s and more); those of several processes once where the system places them and once on one core
(taskset), where a message wakes no other core. Prints lines of JSON as bench/pairs.hpp does, with microseconds a
sample. Before: make -C build bare_ring, and source scripts/env.sh.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile

from launching import free_port

BARE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "devel", "lib", "fmbpc", "bare_ring")
ROLES = ("listener", "optimizer", "controller", "plant")
LONGEST = 600  # [s] of one run
ONE_CORE = ("taskset", "-c", "0")


def environment(port):
    return dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}", ROS_HOSTNAME="localhost")


def bare(samples, nodelets, place=()):
    """Microseconds a sample of the bare exchange."""
    port = free_port()
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": environment(port)}
    master = subprocess.Popen([*place, "rosmaster", "--core", "-p", str(port)], **quiet)
    nodes = []
    try:
        subprocess.run(["rostopic", "list"], check=False, **quiet)
        for role in () if nodelets else ROLES[:-1]:
            nodes.append(subprocess.Popen([*place, BARE, role, str(samples)], **quiet))
        plant = subprocess.run([*place, BARE, "all" if nodelets else "plant", str(samples)], env=environment(port), check=True,
                               capture_output=True, text=True, timeout=LONGEST)
        return 1e6 * float(plant.stdout.split()[-1]) / samples
    finally:
        for node in [*nodes, master]:
            node.terminate()
        for node in [*nodes, master]:
            node.wait()


def ring(loop, hours, nodelets, place=()):
    """(microseconds a sample of the loop over topics in lockstep, samples)"""
    port = free_port()
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([*place, "roslaunch", "-p", str(port), "fmbpc", "loop.launch", f"loop:={loop}", "pace:=lockstep", f"out:={out}", "draw:=false",
                        "sim_time:=false", f"nodelets:={str(nodelets).lower()}", f"set:=sampling.duration_h={hours}"],
                       env=environment(port), check=True, capture_output=True, timeout=LONGEST)
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
    return 1e6 * summary["wall_s"] / summary["steps"], summary["steps"]


def row(path, baseline, aim, ours, theirs):
    ratios = [b / a for a, b in zip(ours, theirs)]
    return {"path": path, "baseline": baseline, "aim": aim, "ratio": statistics.median(ratios), "least": min(ratios), "most": max(ratios),
            "ours_us": statistics.median(ours), "baseline_us": statistics.median(theirs), "pairs": len(ratios)}


def main(rounds="10", loop="asp_case1_clp", hours="4000"):
    _, samples = ring(loop, hours, False)  # warms the file cache and tells the length
    nodes, nodelets, pinned, bare_nodes, bare_nodelets, bare_pinned = [], [], [], [], [], []
    for _ in range(int(rounds)):
        bare_nodes.append(bare(samples, False))
        nodes.append(ring(loop, hours, False)[0])
        bare_nodelets.append(bare(samples, True))
        nodelets.append(ring(loop, hours, True)[0])
        bare_pinned.append(bare(samples, False, ONE_CORE))
        pinned.append(ring(loop, hours, False, ONE_CORE)[0])
    for line in (row(f"loop over topics, 4 nodes, {loop}", "bare ring of three roscpp processes", "0.8", nodes, bare_nodes),
                 row(f"loop over topics, 4 nodes on one core, {loop}", "bare ring of three processes on one core", "0.8", pinned, bare_pinned),
                 row(f"loop as nodelets, {loop}", "bare ring in one process", "0.8", nodelets, bare_nodelets),
                 row(f"loop as nodelets, {loop}", "the same as four nodes", "2.5", nodelets, nodes)):
        print(json.dumps(line))


if __name__ == "__main__":
    main(*sys.argv[1:])
