#!/usr/bin/python3
"""How many bags of a loop are whole when the machine is busy: each run is launched in lockstep with record:=true beside processes that
take all processors, and its bag is replayed.

  bench/bags_bench.py [COUNT] [LOOP]     default: 100 asp_case1_clp
"""
import multiprocessing
import os
import pathlib
import subprocess
import sys
import tempfile

import launching

TOOL = os.environ.get("FMBPC_TOOL", "fmbpc")


def burn():
    while True:
        pass


def judged(env, loop, folder):
    """What is wrong with the bag of one run, in words; empty: nothing."""
    words = launching.loop_words(loop, folder)
    run = subprocess.run(["roslaunch", "--wait", *words, "record:=true"], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=600, check=False)
    bags = sorted(pathlib.Path(folder).rglob("*.bag"))
    if run.returncode or len(bags) != 1:
        return f"launch ended with {run.returncode}, {len(bags)} bags"
    replay = subprocess.run([TOOL, "replay", str(bags[0]), "--json"], env=env, capture_output=True, text=True, check=False)
    if replay.returncode:
        return f"replay ended with {replay.returncode}: {(replay.stdout + replay.stderr)[-300:]}"
    return ""


def main(count="100", loop="asp_case1_clp"):
    burners = [multiprocessing.Process(target=burn, daemon=True) for _ in range(os.cpu_count())]
    for burner in burners:
        burner.start()
    broken = []
    with launching.master() as env:
        for i in range(int(count)):
            with tempfile.TemporaryDirectory() as folder:
                word = judged(env, loop, folder)
            if word:
                broken.append(word)
                print(f"run {i + 1}: {word}", flush=True)
    print(f"{int(count) - len(broken)} of {count} bags are whole and replay to the same actions")
    return len(broken) > 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
