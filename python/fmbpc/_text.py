"""Values of Python as the text of a loop file."""
import collections.abc
import json
import math
import numbers
import os

import numpy

from fmbpc import _core


def path(value, what):
    """Text of a name or path."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    raise _core.InputError(f"{what}: expected a name or a path, got {type(value).__name__}")


def text(value, what):
    """A text."""
    if isinstance(value, str):
        return value
    raise _core.InputError(f"{what}: expected a text, got {value!r}")


def items(value, what):
    """Pairs of a dict; None: of none."""
    if value is None or isinstance(value, collections.abc.Mapping):
        return list((value or {}).items())
    raise _core.InputError(f"{what}: expected a dict, got {value!r}")


def numbers_of(value, what):
    """Pairs (name, number) of a dict."""
    return [(str(key), real(number, f"{what}[{key}]")) for key, number in items(value, what)]


def whole(value, what):
    """A whole number."""
    if isinstance(value, numbers.Integral) and not isinstance(value, bool):
        return int(value)
    raise _core.InputError(f"{what}: expected a whole number, got {value!r}")


def real(value, what):
    """A real number."""
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return float(value)
    raise _core.InputError(f"{what}: expected a number, got {value!r}")


def core_of(value, what, kind):
    """The object of the core in an object of class `kind`."""
    core = getattr(value, "_core", None)
    if isinstance(core, getattr(_core, kind)):
        return core
    raise _core.InputError(f"{what}: expected an fmbpc.{kind}, got {type(value).__name__}")


def yaml_text(value):
    """YAML in one line; a text is taken as it is, as the tool takes --set KEY=VALUE."""
    return value if isinstance(value, str) else _flow(value)


def _flow(value):
    if value is None:
        return "null"
    if isinstance(value, (bool, numpy.bool_)):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        number = float(value)
        return repr(number) if math.isfinite(number) else ".nan" if math.isnan(number) else ".inf" if number > 0 else "-.inf"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, collections.abc.Mapping):
        return "{" + ", ".join(f"{json.dumps(str(k))}: {_flow(v)}" for k, v in value.items()) + "}"
    if isinstance(value, numpy.ndarray):
        return _flow(value.tolist())
    if isinstance(value, collections.abc.Iterable):
        return "[" + ", ".join(_flow(v) for v in value) + "]"
    raise _core.InputError(f"a loop file: expected numbers, texts, truth values, lists and dicts, got {value!r}")


def assignments(settings):
    """What overrides() takes, as a list of "path=value"."""
    return [f"{key}={value}" for key, value in overrides(settings)]


def overrides(settings):
    """Pairs (path, text) of a dict {"sampling.duration_h": 48}, or of a list of "path=value"."""
    if settings is None:
        return []
    if isinstance(settings, collections.abc.Mapping):
        return [(str(key), yaml_text(value)) for key, value in settings.items()]
    pairs = []
    for text in settings if isinstance(settings, (list, tuple)) else [settings]:
        key, equals, value = text.partition("=") if isinstance(text, str) else ("", "", "")
        if not equals or not key:
            raise _core.InputError(f"set: expected KEY=VALUE or a dict, got {text!r}")
        pairs.append((key, value))
    return pairs
