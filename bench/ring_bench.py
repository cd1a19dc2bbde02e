#!/usr/bin/python3
"""The loop over topics beside a bare ring of three processes: ring_bench.py [--nodelets] [PAIRS] [LOOP]

With --nodelets both are in one process, whose parts hand shared messages on.

Runs pairs, one after the other (bare, loop, bare, loop, ...), each run with a master of its own, and prints samples
per second of both and the median of the ratios. Before: make -C build bare_ring, and source scripts/env.sh.
"""
import json
import os
import socket
import statistics
import subprocess
import sys
import tempfile

BARE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "devel", "lib", "fmbpc", "bare_ring")
ROLES = ("listener", "optimizer", "controller", "plant")


def free_port():
    with socket.socket() as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


def bare_rate(samples, nodelets):
    """Samples per second of the bare ring."""
    port = free_port()
    env = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}", ROS_HOSTNAME="localhost")
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": env}
    master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], **quiet)
    nodes = []
    try:
        subprocess.run(["rostopic", "list"], check=False, **quiet)
        for role in () if nodelets else ROLES[:-1]:
            nodes.append(subprocess.Popen([BARE, role, str(samples)], **quiet))
        plant = subprocess.run([BARE, "all" if nodelets else "plant", str(samples)], env=env, check=True,
                               capture_output=True, text=True, timeout=300)
        return samples / float(plant.stdout.split()[-1])
    finally:
        for node in [*nodes, master]:
            node.terminate()
        for node in [*nodes, master]:
            node.wait()


def loop_rate(loop, nodelets):
    """(samples per second, samples) of the loop over topics, in lockstep."""
    port = free_port()
    env = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}", ROS_HOSTNAME="localhost")
    with tempfile.TemporaryDirectory() as out:
        subprocess.run(["roslaunch", "-p", str(port), "fmbpc", "loop.launch", f"loop:={loop}", "pace:=lockstep",
                        f"out:={out}", "draw:=false", "sim_time:=false", f"nodelets:={str(nodelets).lower()}"], env=env, check=True, capture_output=True, timeout=300)
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
    return summary["steps"] / summary["wall_s"], summary["steps"]


def main(*arguments):
    nodelets = "--nodelets" in arguments
    pairs, loop = [*(a for a in arguments if a != "--nodelets"), *("10", "asp_case1_clp")[len(arguments) - nodelets:]]
    _, samples = loop_rate(loop, nodelets)  # warms the file cache and tells the length
    ratios = []
    for pair in range(int(pairs)):
        bare = bare_rate(samples, nodelets)
        ours, _ = loop_rate(loop, nodelets)
        ratios.append(ours / bare)
        print(f"pair {pair + 1}: bare {bare:7.0f}/s  loop {ours:7.0f}/s  ratio {ratios[-1]:.2f}", flush=True)
    print(f"median ratio {statistics.median(ratios):.2f} over {len(ratios)} pairs of {samples} samples"
          f" (least {min(ratios):.2f}, most {max(ratios):.2f})")


if __name__ == "__main__":
    main(*sys.argv[1:])
