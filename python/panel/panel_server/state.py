"""What is said of each signal of a loop: one status word with its reason, from numbers and codes alone."""
import math

GOOD, PREDICTED, HELD, HIGH, LOW, LIMITED, BAD = "good", "predicted", "held", "high", "low", "limited", "bad"
QUALITY = ("good", "stale", "bad", "missing")
SOURCES = {0: "", 1: "law", 2: "optimizer", 3: "clipped", 4: "held", 5: "manual", 6: "fallback", 7: "guarded"}
MODEL_USED = {"signal_frozen", "signal_not_renewed"}
REFUSED = {"signal_missing", "signal_out_of_range", "signal_too_fast", "signal_jumped"}
NEAR = 1e-6  # of a range, or of the number


def number(value):
    """As people write it, with a narrow no-break space never: 4 digits that count."""
    if value is None or not math.isfinite(value):
        return "?"
    return f"{value:.4g}" if abs(value) < 1e5 else f"{value:.6g}"


def near(a, b, span):
    return abs(a - b) <= NEAR * max(span if math.isfinite(span) else 0.0, abs(b), 1e-12)


def of_limit(setting, name, default):
    """A limit of the loop file: by name, one number for all, or none."""
    if isinstance(setting, dict):
        setting = setting.get(name)
    try:
        return default if setting is None else float(setting)
    except (TypeError, ValueError):
        return default


def output_status(info, value, quality, causes, low, high, setpoint_clamped=False):
    """(word, reason). causes: codes of this signal that stand; low, high: soft limits, infinite where there are none."""
    refused = sorted(REFUSED & causes)
    if quality >= 2 or value is None or not math.isfinite(value):
        return BAD, f"the measurement is {QUALITY[min(quality, 3)] if quality else 'no number'}"
    if quality == 1:
        return HELD, "the measurement is stale"
    if sorted(MODEL_USED & causes):
        return PREDICTED, f"the model's value is used ({sorted(MODEL_USED & causes)[0]})"
    if refused:
        return HELD, f"the measurement is not accepted ({refused[0]})"
    if value > high:
        return HIGH, f"above its limit {number(high)} {info.unit}"
    if value < low:
        return LOW, f"below its limit {number(low)} {info.unit}"
    if value > info.upper or value < info.lower:
        return (HIGH if value > info.upper else LOW), "outside the plant's range"
    if setpoint_clamped:
        return LIMITED, "the setpoint asked is beyond its limits"
    return GOOD, ""


def first_limit(plan, outputs, inputs, limits):
    """Which limit the base law would be the first to break: (samples ahead, words), or None.

    limits: {"input": [(lower, upper)], "move": [most], "output": [(lower, upper)]}, all as lists in the order of the signals."""
    found = []
    for j, info in enumerate(inputs):
        low, high = limits["input"][j]
        before = None
        for i, u in enumerate(plan.base_input[:, j]):
            span = high - low
            if u > high and not near(u, high, span):
                found.append((i, 0, f"{info.name} would go to {number(u)}, its upper limit is {number(high)} {info.unit}"))
                break
            if u < low and not near(u, low, span):
                found.append((i, 0, f"{info.name} would go to {number(u)}, its lower limit is {number(low)} {info.unit}"))
                break
            if before is not None and abs(u - before) > limits["move"][j] * (1 + 1e-9):
                found.append((i, 1, f"{info.name} would move by {number(u - before)}, at most {number(limits['move'][j])} {info.unit} a sample"))
                break
            before = u
    for j, info in enumerate(outputs):
        low, high = limits["output"][j]
        for i, y in enumerate(plan.base_output[:, j]):
            if y > high or y < low:
                word, limit = ("pass its upper", high) if y > high else ("pass its lower", low)
                found.append((i + 1, 2, f"{info.name} would {word} limit {number(limit)} {info.unit} in {i + 1} samples"))
                break
    return min(found)[::2] if found else None


def input_status(info, value, before, source, law, low, high, move, guard, causes, why=""):
    """(word, reason, [limits that are active]).

    value: u(k); before: u(k-1); law: what the law asked without limits, or None; guard: (lower, upper) that the guard leaves."""
    if "input_stuck" in causes:
        return BAD, "it does not follow its command (input_stuck)", []
    if value is None or not math.isfinite(value):
        return BAD, "no action has come", []
    if source == 6:
        return BAD, "the configured fallback acts", []
    if source == 4:
        return HELD, "the last input stays: data are missing or not finite", []
    span, active, reasons = high - low, [], []
    asked = f", the law asks {number(law)}" if law is not None and math.isfinite(law) and not near(law, value, span) else ""
    if math.isfinite(high) and near(value, high, span):
        active.append("upper")
        reasons.append(f"at its upper limit {number(high)} {info.unit}{asked}")
    if math.isfinite(low) and near(value, low, span):
        active.append("lower")
        reasons.append(f"at its lower limit {number(low)} {info.unit}{asked}")
    if before is not None and math.isfinite(before) and math.isfinite(move) and move > 0 and abs(value - before) >= move * (1 - 1e-6):
        active.append("move")
        reasons.append(f"moves by {number(value - before)}, the most that is allowed in a sample{asked if not reasons else ''}")
    if not active and guard and (near(value, guard[0], span) and guard[0] > low or near(value, guard[1], span) and guard[1] < high):
        active.append("guard")
        reasons.append(f"the guard leaves {number(guard[0])} to {number(guard[1])} {info.unit}: the model has few data here")
    if not active and source == 2:
        active.append("ahead")
        reasons.append("the optimizer turned it aside" + (f": {why}" if why else asked))
    if not active and source == 7:
        active.append("guard")
        reasons.append("inside what the guard leaves of the limits")
    return (LIMITED if active else GOOD), "; ".join(reasons), active
