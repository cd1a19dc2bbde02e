#!/usr/bin/python3
"""Prints config/data/influent_week.csv: one synthetic week of influent, hourly, always the same.

A daily cycle with its harmonic, weekends with less load, a storm on the fifth day that doubles the flow and dilutes it,
measurement scatter from a fixed linear congruential generator, and three missing cells.
"""
import math
import sys

HOURS = 168
MISSING = {(37, "flow"), (90, "cod"), (91, "cod")}


def scatter(state):
    """Next state and a number in -1..1 (Numerical Recipes' 32-bit constants)."""
    state = (1664525 * state + 1013904223) % 2**32
    return state, 2.0 * state / 2**32 - 1.0


def rows():
    state = 2021
    for t in range(HOURS + 1):
        day = 2.0 * math.pi * t / 24.0
        storm = max(0.0, 1.0 - abs(t - 104.0) / 8.0)
        weekend = 1.0 if t >= 120 else 0.0
        state, a = scatter(state)
        state, b = scatter(state)
        flow = 1250.0 + 260.0 * math.sin(day - 2.4) + 110.0 * math.sin(2.0 * day - 2.1) + 900.0 * storm + 40.0 * a
        cod = 400.0 + 70.0 * math.sin(day - 2.9) - 45.0 * weekend - 150.0 * storm + 15.0 * b
        yield t, {"flow": flow, "cod": cod}


def main():
    if {"-h", "--help"} & set(sys.argv[1:]):
        print(__doc__.strip())
        return
    print("time[h],flow[m3/h],cod[mg/l]")
    for t, values in rows():
        cells = ["" if (t, name) in MISSING else "%.1f" % values[name] for name in ("flow", "cod")]
        print("%d,%s,%s" % (t, *cells))


if __name__ == "__main__":
    main()
