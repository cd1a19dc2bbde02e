"""What the law sees ahead: its plan from PredictiveAction, how far its model is trusted there, how well such plans came true,
and where the process is among the rules. Formulas: msg/PredictiveAction.msg, include/fmbpc/model/domain.hpp and membership.hpp."""
import collections
import math

import numpy

FADE, RANGE_FADE = 1.0, 0.25  # kDomainFade, kRangeFade
OUTPUT, INPUT, DISTURBANCE = 1, 2, 3
REMEMBERED = 200              # predictions whose errors count
ENOUGH = 10                   # errors before a band is drawn


def matrix(msg):
    return numpy.array(msg.data, dtype=float).reshape(msg.rows, msg.cols)


class Plan:
    """The base law's inputs and outputs as it would like them (base) and as the loop will do them (plan)."""

    def __init__(self, action, lower, upper, move, planned=None):
        """action: PredictiveAction; lower, upper, move: of inputs, infinite where there is none; planned: Matrix of InputPlan or None."""
        self.step, self.run_id = action.step, action.run_id
        A, B, C, K = (matrix(getattr(action, name)) for name in "ABCK")
        forward = matrix(action.feedforward)
        self.reference = matrix(action.reference)
        self.setpoint = numpy.array(action.setpoint)
        n = forward.shape[1]
        offset_x, offset_y = numpy.array(action.offset_state), numpy.array(action.offset_output)
        planned = matrix(planned) if planned is not None and planned.rows == forward.shape[0] else None
        self.constrained = planned is not None

        def roll(choose):
            x, before, inputs, outputs = numpy.array(action.state), numpy.array(action.input_previous), [], []
            for i in range(n):
                u = choose(i, forward[:, i] - K @ x, before)
                inputs.append(u)
                x = A @ x + B @ u + offset_x
                outputs.append(C @ x + offset_y)
                before = u
            return numpy.array(inputs), numpy.array(outputs)  # n n_u, n n_y: outputs of k+1..k+n

        def limited(i, law, before):
            if planned is not None and i < planned.shape[1]:
                return planned[:, i]
            return numpy.clip(numpy.clip(law, before - move, before + move), lower, upper)

        self.base_input, self.base_output = roll(lambda i, law, before: law)
        self.input, self.output = roll(limited)
        self.A, self.B, self.C = A, B, C

    def finite(self):
        return bool(numpy.isfinite(self.output).all() and numpy.isfinite(self.input).all())

    def poles(self):
        """Of the local model, largest modulus first."""
        values = numpy.linalg.eigvals(self.A) if self.A.size else numpy.zeros(0)
        return sorted(values, key=lambda v: -abs(v))

    def gains(self):
        """Steady n_y n_u of the local model; None where it integrates or drifts away."""
        if not self.A.size or max(abs(p) for p in self.poles()) >= 1.0 - 1e-9:
            return None
        return self.C @ numpy.linalg.solve(numpy.eye(len(self.A)) - self.A, self.B)

    def steady_output(self):
        """Where the outputs settle with the last planned input; None as gains()."""
        return self.output[-1] if len(self.output) else None


def fade(t):
    return numpy.where(t <= 0.0, 1.0, numpy.where(t >= 1.0, 0.0, 0.5 * (1.0 + numpy.cos(math.pi * numpy.clip(t, 0.0, 1.0)))))


class Trust:
    """trustOf() of a FuzzyModel, for many points at once."""

    def __init__(self, model):
        signals = list(model.outputs) + list(model.inputs) + list(model.disturbances)
        self.names = [s.name for s in signals]
        n_y, n_u = len(model.outputs), len(model.inputs)
        self.is_input = numpy.array([n_y <= i < n_y + n_u for i in range(len(signals))], dtype=bool)
        self.lower, self.upper = numpy.array([s.lower for s in signals]), numpy.array([s.upper for s in signals])
        n = len(signals)
        centres = numpy.array(model.domain_centres, dtype=float)
        self.centres = centres.reshape(-1, n) if n and centres.size and centres.size % n == 0 else numpy.zeros((0, n))
        self.scale, self.radius = numpy.array(model.domain_scale, dtype=float), model.domain_radius

    def known(self):
        return bool(len(self.centres)) or bool((numpy.isfinite(self.lower) & numpy.isfinite(self.upper)).any())

    def of(self, points):
        """points: m n in the order of self.names; m numbers 0..1."""
        points = numpy.atleast_2d(points)
        if not len(self.centres):
            span = self.upper - self.lower
            good = numpy.isfinite(span) & (span > 0.0)
            beyond = numpy.maximum(numpy.maximum(self.lower - points, points - self.upper), 0.0)[:, good] / span[good]
            trust = fade(numpy.sqrt((beyond ** 2).sum(axis=1)) / RANGE_FADE)
        else:
            process = ~self.is_input & numpy.isfinite(self.scale)
            apart = (points[:, None, process] - self.centres[None, :, process]) / self.scale[process]
            square = (apart ** 2).sum(axis=2).min(axis=1)
            hands = self.is_input & numpy.isfinite(self.scale)
            low, high = self.centres[:, hands].min(axis=0), self.centres[:, hands].max(axis=0)
            beyond = numpy.maximum(numpy.maximum(low - points[:, hands], points[:, hands] - high), 0.0) / self.scale[hands]
            distance = numpy.sqrt(square + (beyond ** 2).sum(axis=1))
            trust = fade((distance - self.radius) / max(FADE * self.radius, RANGE_FADE))
        return numpy.where(numpy.isfinite(points).all(axis=1), trust, 0.0)


class Errors:
    """How far plans were from what came: for each number of samples ahead the errors of the latest plans."""

    def __init__(self, n_y):
        self.n_y, self.waiting, self.errors = n_y, collections.OrderedDict(), {}

    def add(self, plan):
        """The output of k + i was planned at k."""
        if plan.step in self.waiting or not plan.finite():
            return
        self.waiting[plan.step] = plan.output
        while len(self.waiting) > max(REMEMBERED, len(plan.output) + 1):
            self.waiting.popitem(last=False)

    def came(self, step, outputs):
        for at in reversed(self.waiting):
            planned, ahead = self.waiting[at], step - at
            if ahead > len(planned):
                return  # those before it are older still
            if ahead >= 1:
                error = numpy.array(outputs) - planned[ahead - 1]
                if numpy.isfinite(error).all():
                    self.errors.setdefault(ahead, collections.deque(maxlen=REMEMBERED)).append(error)

    def rms(self, n):
        """n n_y, of 1..n ahead; None until there are enough, then what is not known is as the one before it."""
        if len(self.errors.get(1, ())) < ENOUGH:
            return None
        result, last = [], None
        for ahead in range(1, n + 1):
            errors = self.errors.get(ahead, ())
            if len(errors) >= ENOUGH:
                last = numpy.sqrt((numpy.array(errors) ** 2).mean(axis=0))
            result.append(last)
        return numpy.maximum.accumulate(numpy.array(result), axis=0)


def log_degree(shape, p, z):
    """Logarithm of a membership (FuzzySet)."""
    if shape == 1:
        return -0.5 * ((z - p[0]) / p[1]) ** 2 if p[1] > 0 else (0.0 if z == p[0] else -math.inf)
    if shape == 2:
        p = [p[0], p[1], p[1], p[2]]
    if z < p[1]:
        beyond, width = p[1] - z, p[1] - p[0]
    elif z > p[2]:
        beyond, width = z - p[2], p[3] - p[2]
    else:
        return 0.0
    if width <= 0.0:
        return -math.inf
    if shape == 0:
        return -7.0 * (beyond / width) ** 2
    return math.log1p(-beyond / width) if beyond < width else -math.inf


def firing(submodel, z):
    """(weights of the rules, degrees of each set by rule), weights of sum 1; of no rule that fires: zeros."""
    logs, degrees = [], []
    for rule in submodel.rules:
        if rule.center:
            d, S = numpy.array(z) - numpy.array(rule.center), numpy.array(rule.inverse_covariance).reshape(len(z), len(z))
            logs.append(float(-0.5 * d @ S @ d))
            degrees.append([])
        else:
            each = [log_degree(s.shape, s.parameters, v) for s, v in zip(rule.antecedents, z)]
            logs.append(sum(each))
            degrees.append([math.exp(e) for e in each])
    top = max(logs, default=-math.inf)
    if not math.isfinite(top):
        return [0.0] * len(logs), degrees
    weights = [math.exp(v - top) for v in logs]
    return [w / sum(weights) for w in weights], degrees


KINDS = {OUTPUT: "outputs", INPUT: "inputs", DISTURBANCE: "disturbances"}


def rules_of(model, value):
    """Where the process is among the rules. value(name, lag): the signal at k - lag, not a number if unknown. For JSON."""
    shown = []
    for output, submodel in zip(model.outputs, model.submodels):
        def signal(r):
            names = getattr(model, KINDS.get(r.kind, "outputs"))
            return names[r.index].name if 0 <= r.index < len(names) else "?"
        z = [value(signal(r), r.lag) for r in submodel.antecedents]
        known = all(math.isfinite(v) for v in z)
        weights, degrees = firing(submodel, z) if known else ([None] * len(submodel.rules), [[]] * len(submodel.rules))
        shown.append({
            "output": output.name,
            "antecedents": [{"name": signal(r), "lag": r.lag, "value": v if math.isfinite(v) else None} for r, v in zip(submodel.antecedents, z)],
            "regressors": [{"name": signal(r), "lag": r.lag} for r in submodel.regressors],
            "rules": [{"weight": w, "degrees": d, "data": int(rule.data_count), "coefficients": list(rule.coefficients), "offset": rule.offset,
                       "sets": [{"shape": s.shape, "p": list(s.parameters)} for s in rule.antecedents], "center": list(rule.center)}
                      for rule, w, d in zip(submodel.rules, weights, degrees)]})
    return shown
