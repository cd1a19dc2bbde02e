#!/usr/bin/python3
"""Seeded records of processes of many kinds, for judging identification: each maker gives a table to identify from (or several),
one to judge on with a new input, and the names of its signals. Used by identification_bench.py."""
import argparse
import os

import numpy

ROWS = 700


def levels(random, rows, hold, low=-1.0, high=1.0):
    """Steps between uniform levels, each held for `hold` to twice `hold` samples."""
    values = []
    while len(values) < rows:
        values += [random.uniform(low, high)] * int(random.integers(hold, 2 * hold + 1))
    return numpy.array(values[:rows])


def filtered(u, a, b):
    """y(k) = -a1 y(k-1) - a2 y(k-2) + b1 u(k-1) + b2 u(k-2), at rest before."""
    y = numpy.zeros(len(u))
    for k in range(1, len(u)):
        y[k] = -a[0] * y[k - 1] + b[0] * u[k - 1]
        if k > 1:
            y[k] += -a[1] * y[k - 2] + b[1] * u[k - 2]
    return y


def noisy(random, y, share):
    return y + share * numpy.std(y) * random.standard_normal(len(y))


OSCILLATING, LAGS = ([-1.6, 0.68], [0.05, 0.03]), ([-1.7, 0.7125], [0.008, 0.0045])


def linear(random):
    u = levels(random, ROWS, 8)
    return {"u": u, "y": noisy(random, filtered(u, *OSCILLATING), 0.1)}


def linear_loud(random):
    u = levels(random, ROWS, 5)
    return {"u": u, "y": noisy(random, filtered(u, *LAGS), 0.7)}


def linear_coloured(random):
    u = levels(random, ROWS, 8)
    wander = filtered(random.standard_normal(ROWS), [-0.97, 0.0], [1.0, 0.0])
    y = filtered(u, *LAGS)
    return {"u": u, "y": y + 0.4 * numpy.std(y) * wander / numpy.std(wander)}


def unrelated(random):
    return {"u": levels(random, ROWS, 8), "y": filtered(random.standard_normal(ROWS), [-0.9, 0.0], [1.0, 0.0])}


def integrator(random):
    """A level under feedback of an operator: hardly damped by itself."""
    u, y = levels(random, ROWS, 6), numpy.zeros(ROWS)
    for k in range(1, ROWS):
        u[k] -= 0.5 * y[k - 1]
        y[k] = 0.998 * y[k - 1] + 0.05 * u[k - 1]
    return {"u": u, "y": noisy(random, y, 0.02)}


def wiener(random, wide=1.0):
    u = wide * levels(random, ROWS, 10)
    return {"u": u, "y": noisy(random, numpy.tanh(2.0 * filtered(u, *OSCILLATING)), 0.03)}


def hammerstein(random, wide=1.0):
    u = wide * levels(random, ROWS, 10)
    v = numpy.sign(u) * numpy.maximum(numpy.abs(u) - 0.3, 0.0) + 0.3 * u * u
    return {"u": u, "y": noisy(random, filtered(v, *LAGS), 0.03)}


def bilinear(random):
    """A heater whose flow is an input: gain and time constant go with it; the flow acts three samples late."""
    u, q = levels(random, ROWS, 12, 0.0, 1.0), levels(random, ROWS, 25, 0.2, 1.0)
    y = numpy.zeros(ROWS)
    for k in range(3, ROWS):
        y[k] = y[k - 1] + 0.15 * (u[k - 1] - q[k - 3] * y[k - 1])
    return {"u": u, "q": q, "y": noisy(random, y, 0.02)}


def titration(random):
    """Neutralisation: a first-order mixture under a steep titration curve."""
    acid, base = levels(random, ROWS, 15, 0.9, 1.1), levels(random, ROWS, 8, 0.7, 1.3)
    excess = filtered(base - acid, [-0.9, 0.0], [0.1, 0.0])
    return {"acid": acid, "base": base, "y": noisy(random, 7.0 + 1.8 * numpy.arcsinh(excess / 0.01), 0.02)}


def boiler(random):
    """Three inputs, two outputs: pressure bends with the fuel, oxygen has a delay and drifts."""
    fuel, air, level = (levels(random, ROWS, hold, 0.0, 1.0) for hold in (15, 12, 30))
    pressure, oxygen = numpy.zeros(ROWS), numpy.zeros(ROWS)
    for k in range(5, ROWS):
        pressure[k] = 0.97 * pressure[k - 1] + 0.05 * fuel[k - 2] ** 1.5 - 0.01 * level[k - 1] * pressure[k - 1]
        oxygen[k] = 0.85 * oxygen[k - 1] + 0.15 * (air[k - 5] / (0.3 + fuel[k - 5]))
    drift = filtered(random.standard_normal(ROWS), [-0.98, 0.0], [0.01, 0.0])
    return {"fuel": fuel, "air": air, "level": level, "p": noisy(random, pressure, 0.03), "o": noisy(random, oxygen, 0.05) + drift}


def closed_loop(random):
    """A reactor under PI control, its setpoint moved now and then, noise fed back."""
    y, u, sum_, setpoint = numpy.zeros(ROWS), numpy.zeros(ROWS), 0.0, levels(random, ROWS, 25, 0.1, 0.9)
    measured = numpy.zeros(ROWS)
    for k in range(1, ROWS):
        y[k] = y[k - 1] + 0.1 * (-y[k - 1] - y[k - 1] ** 3 + u[k - 1])
        measured[k] = y[k] + 0.01 * random.standard_normal()
        error = setpoint[k] - measured[k]
        sum_ += 0.08 * error
        u[k] = 1.2 * error + sum_
    return {"u": u, "y": measured}


def two_tanks(random, wide=1.0):
    """Square-root outflows, an upper tank that overflows, a level sensor that ends at 10."""
    u, upper, lower = numpy.maximum(2.5 + wide * levels(random, ROWS, 20, -2.5, 3.5), 0.0), 2.0, 3.0
    y = numpy.zeros(ROWS)
    for k in range(ROWS):
        y[k] = lower
        out = 0.45 * numpy.sqrt(max(upper, 0.0))
        upper += 0.35 * u[k] - out
        over = max(upper - 10.0, 0.0)
        upper -= over
        lower += out + 0.5 * over - 0.42 * numpy.sqrt(max(lower, 0.0))
        lower = max(lower, 0.0)
    return {"u": u, "y": numpy.minimum(noisy(random, y, 0.01), 10.0)}


def hardening_spring(random):
    u, y = levels(random, ROWS, 3), numpy.zeros(ROWS)
    for k in range(2, ROWS):
        y[k] = 1.5 * y[k - 1] - 0.8 * y[k - 2] + 0.3 * u[k - 1] - 0.1 * y[k - 1] ** 3
    return {"u": u, "y": noisy(random, y, 0.01)}


def two_speeds(random):
    """Heats fast, cools slowly."""
    u, y = levels(random, ROWS, 12), numpy.zeros(ROWS)
    for k in range(1, ROWS):
        y[k] = y[k - 1] + (0.25 if u[k - 1] > y[k - 1] else 0.06) * (u[k - 1] - y[k - 1])
    return {"u": u, "y": noisy(random, y, 0.03)}


def signed_drive(random):
    u = levels(random, ROWS, 12)
    return {"u": u, "y": numpy.abs(noisy(random, filtered(u, [-1.75, 0.79], [0.03, 0.02]), 0.02))}


def late_gain(random):
    u, y = levels(random, ROWS, 14), numpy.zeros(ROWS)
    for k in range(8, ROWS):
        y[k] = 0.88 * y[k - 1] + 0.12 * (u[k - 8] + 0.6 * u[k - 8] ** 2)
    return {"u": u, "y": noisy(random, y, 0.04)}


def spoilt(random):
    """Wiener with outliers and missing cells."""
    record = wiener(random)
    for name in record:
        record[name] = record[name].copy()
    where = random.choice(ROWS, 7, replace=False)
    record["y"][where] += 4.0 * random.choice([-1.0, 1.0], 7)
    record["y"][random.choice(ROWS, 30, replace=False)] = numpy.nan
    record["u"][random.choice(ROWS, 5, replace=False)] = numpy.nan
    return record


def wider(maker, narrow=0.7):
    """The record to judge on goes beyond what the others showed."""
    return lambda random: maker(random, narrow), maker


# name: maker (or one to identify from and one to judge on), outputs, records to identify from
KINDS = {
    "linear": (linear, ["y"], 1), "linear_loud": (linear_loud, ["y"], 1), "linear_coloured": (linear_coloured, ["y"], 1),
    "unrelated": (unrelated, ["y"], 1), "integrator": (integrator, ["y"], 1), "wiener": (wiener, ["y"], 1),
    "hammerstein": (hammerstein, ["y"], 1), "bilinear": (bilinear, ["y"], 1), "titration": (titration, ["y"], 1),
    "boiler": (boiler, ["p", "o"], 1), "closed_loop": (closed_loop, ["y"], 1), "two_tanks": (two_tanks, ["y"], 1),
    "hardening_spring": (hardening_spring, ["y"], 1), "two_speeds": (two_speeds, ["y"], 1),
    "signed_drive": (signed_drive, ["y"], 1), "late_gain": (late_gain, ["y"], 1), "spoilt": ((spoilt, wiener), ["y"], 1),
    "three_records": (hammerstein, ["y"], 3), "wiener_wider": (wider(wiener), ["y"], 1),
    "hammerstein_wider": (wider(hammerstein), ["y"], 1), "tanks_wider": (wider(two_tanks), ["y"], 1),
}


def records(kind, seed):
    """Tables to identify from, the table to judge on, inputs, outputs."""
    makers, outputs, count = KINDS[kind]
    maker, judge = makers if isinstance(makers, tuple) else (makers, makers)
    made = [(maker if i < count else judge)(numpy.random.default_rng([seed, i])) for i in range(count + 1)]
    return made[:-1], made[-1], [name for name in made[0] if name not in outputs], outputs


def write(path, record):
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(["k"] + list(record)) + "\n")
        for k, row in enumerate(zip(*record.values())):
            file.write(",".join([str(k)] + ["" if numpy.isnan(v) else repr(float(v)) for v in row]) + "\n")


def main():
    parser = argparse.ArgumentParser(description="Writes seeded records of a simulated process as CSV, the last one to judge on.")
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default=".", help="folder")
    arguments = parser.parse_args()
    parts, judge, inputs, outputs = records(arguments.kind, arguments.seed)
    for i, part in enumerate(parts + [judge]):
        write(os.path.join(arguments.out, "%s_%d.csv" % (arguments.kind, i + 1)), part)
    print("written: %d records; --inputs %s --outputs %s" % (len(parts) + 1, ",".join(inputs), ",".join(outputs)))


if __name__ == "__main__":
    main()
