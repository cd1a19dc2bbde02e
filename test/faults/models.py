"""Models that do not fit, from somebody who may send them (loop.publishers.fuzzy_model: [])."""
import copy
import math

from fault import Fault

CONTROLLER = "fmbpc_controller"


def every_rule(model):
    for submodel in model.submodels:
        yield from submodel.rules


def wrong_sizes(model):
    for rule in every_rule(model):
        rule.coefficients = list(rule.coefficients)[:-1]


def not_finite(model):
    for rule in every_rule(model):
        rule.coefficients = [math.nan] * len(rule.coefficients)


def negated(model):
    for rule in every_rule(model):
        rule.coefficients = [-c for c in rule.coefficients]


def huge(model):
    for rule in every_rule(model):
        rule.coefficients = [1e6 * c for c in rule.coefficients]


def no_rules(model):
    for submodel in model.submodels:
        submodel.rules = []


def no_outputs(model):
    model.submodels = []


def other_sample_time(model):
    model.sample_time_s *= 7.0


def other_plant(model):
    model.outputs[0].name = "nothing_of_ours"


def other_units(model):
    model.outputs[0].unit = "furlong"


def wild_index(model):
    model.submodels[0].regressors[0].index = 99


def fault(name, change, said="refused", counted=(CONTROLLER, "refused: fuzzy_model")):
    """Refused in words, degraded until a model is taken again: the good one ends the fault."""
    kept = {}

    def do(loop):
        kept["good"] = loop.logs["fuzzy_model"].last()
        bad = copy.deepcopy(kept["good"])
        change(bad)
        bad.name = "bad: " + name
        loop.send("fuzzy_model", bad)

    def undo(loop):
        loop.send("fuzzy_model", kept["good"])
    return Fault(f"model: {name}", do, undo, said=said, counted=counted, needs=("model",), lasts=2.0)


FAULTS = [fault("coefficients missing", wrong_sizes), fault("NaN coefficients", not_finite),
          fault("coefficients a million times too large", huge), fault("no rules", no_rules),
          fault("no outputs", no_outputs), fault("another sample time", other_sample_time),
          fault("another plant's names", other_plant), fault("other units", other_units),
          fault("regressor that does not exist", wild_index),
          fault("negated coefficients (wrong sign)", negated)]
