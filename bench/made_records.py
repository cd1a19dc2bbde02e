#!/usr/bin/python3
"""Prints a synthetic record of config/data, always the same: scatter is a fixed linear congruential generator.

    bench/made_records.py influent_week     one week, hourly: a daily cycle with its harmonic, weekends with less load, a storm on the
                                            fifth day that doubles the flow and dilutes it, three missing cells
    bench/made_records.py reaction_rates    another rate of reaction every three minutes for 20 h, and a load that goes with it, as the
                                            coolant flow that holds a concentration does (0.5 l/min for each per cent), up to 2 l/min off
"""
import math
import sys

MISSING = {(37, "flow"), (90, "cod"), (91, "cod")}


def scatter(state):
    """Next state and a number in -1..1 (Numerical Recipes' 32-bit constants)."""
    state = (1664525 * state + 1013904223) % 2**32
    return state, 2.0 * state / 2**32 - 1.0


def influent_week():
    yield "time[h],flow[m3/h],cod[mg/l]"
    state = 2021
    for t in range(169):
        day = 2.0 * math.pi * t / 24.0
        storm = max(0.0, 1.0 - abs(t - 104.0) / 8.0)
        weekend = 1.0 if t >= 120 else 0.0
        state, a = scatter(state)
        state, b = scatter(state)
        values = {"flow": 1250.0 + 260.0 * math.sin(day - 2.4) + 110.0 * math.sin(2.0 * day - 2.1) + 900.0 * storm + 40.0 * a,
                  "cod": 400.0 + 70.0 * math.sin(day - 2.9) - 45.0 * weekend - 150.0 * storm + 15.0 * b}
        yield "%d,%s,%s" % (t, *("" if (t, name) in MISSING else "%.1f" % value for name, value in values.items()))


def reaction_rates():
    yield "time[h],rate[%],load[l/min]"
    state = 2026
    for i in range(401):
        state, a = scatter(state)
        state, b = scatter(state)
        rate = round(12.0 * a)
        yield "%.2f,%d,%.1f" % (0.05 * i, rate, 0.5 * rate + 2.0 * b)


if __name__ == "__main__":
    made = {"influent_week": influent_week, "reaction_rates": reaction_rates}.get(sys.argv[1] if len(sys.argv) == 2 else "")
    print("\n".join(made()) if made else __doc__.strip())
