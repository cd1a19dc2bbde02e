#!/usr/bin/python3
"""Prints config/data/reaction_rates.csv: rates of reaction and loads for an experiment on the stirred-tank reactor.

Another rate every three minutes for 20 h, and a load that goes with it, as the coolant flow that holds a concentration does
(0.5 l/min for each per cent), with up to 2 l/min beside it; from a fixed linear congruential generator.
"""
import sys

ROWS = 401


def scatter(state):
    """Next state and a number in -1..1 (Numerical Recipes' 32-bit constants)."""
    state = (1664525 * state + 1013904223) % 2**32
    return state, 2.0 * state / 2**32 - 1.0


def rows():
    state = 2026
    for i in range(ROWS):
        state, a = scatter(state)
        state, b = scatter(state)
        rate = round(12.0 * a)
        yield 0.05 * i, rate, 0.5 * rate + 2.0 * b


def main():
    if {"-h", "--help"} & set(sys.argv[1:]):
        print(__doc__.strip())
        return
    print("time[h],rate[%],load[l/min]")
    for row in rows():
        print("%.2f,%d,%.1f" % row)


if __name__ == "__main__":
    main()
