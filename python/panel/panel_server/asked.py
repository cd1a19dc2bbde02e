"""What people may ask and what they type, before anything is asked of a loop. Free of ROS."""
import math
import re

MOST_NAMES = 64

# Verb: the role that may ask it, what its arguments are.
VERBS = {"set": "operate", "disturb": "operate", "release": "operate", "manual": "operate", "auto": "operate", "input": "operate", "hold": "operate",
         "adapt": "operate", "acknowledge": "operate", "acknowledge_all": "operate", "shelve": "operate", "unshelve": "operate",
         "setting": "engineer", "pause": "engineer", "step": "engineer", "reset": "engineer", "identify": "engineer", "service": "engineer"}


class Refused(Exception):
    """One line that says why nothing changes."""


def parse_number(text, decimal="."):
    """A number as people write it: 1234.5, 1,234.5, 1.234,5, 1234,5, 1e-3. `decimal`: the mark of the writer's language. What may be
    read in two ways (1.234 of a German, 1,234 of an English writer) is refused: a setpoint a thousand times too large is no typing error.

    Raises Refused."""
    if isinstance(text, bool):
        raise Refused("expected a number")
    if isinstance(text, (int, float)):
        value = float(text)
    else:
        word = str(text).strip()
        for mark in ("\u202f", "\u00a0", " ", "'", "\u2019"):
            word = word.replace(mark, "")
        value = _parse(word.replace("\u2212", "-"), str(text)[:40], decimal)
    if not math.isfinite(value):
        raise Refused(f"expected a number, got '{text}'")
    return value


NUMBER = re.compile(r"([+-]?)(\d[\d.,]*|[.,]\d+)((?:[eE][+-]?\d{1,3})?)", re.ASCII)


def _parse(word, text, decimal):
    match = NUMBER.fullmatch(word) if len(word) <= 40 else None
    if not match:
        raise Refused(f"expected a number, got '{text}'")
    sign, mantissa, exponent = match.groups()
    points, commas = mantissa.count("."), mantissa.count(",")
    if points and commas:
        mark = "." if mantissa.rfind(".") > mantissa.rfind(",") else ","
        whole, _, part = mantissa.rpartition(mark)
        groups = whole.split("," if mark == "." else ".")
        if not part.isdigit() or not grouped(groups):
            raise Refused(f"expected a number, got '{text}'")
        return float(f"{sign}{''.join(groups)}.{part}{exponent}")
    if points + commas > 1:
        groups = mantissa.split("." if points else ",")
        if not grouped(groups):
            raise Refused(f"expected a number, got '{text}'")
        return float(sign + "".join(groups) + exponent)
    mark = "." if points else ","
    if points + commas == 1 and mark != decimal and grouped(mantissa.split(mark)) and not mantissa.startswith("0"):
        raise Refused(f"'{text}' may be {mantissa.replace(mark, '')} or {mantissa.replace(mark, decimal)}: write it without a mark for thousands")
    return float(sign + mantissa.replace(",", ".") + exponent)


def grouped(groups):
    return 1 <= len(groups[0]) <= 3 and groups[0].isdigit() and all(len(g) == 3 and g.isdigit() for g in groups[1:])


def mark_of(arguments):
    return "," if arguments.get("decimal") == "," else "."


def numbers(arguments):
    values = arguments.get("values")
    if not isinstance(values, dict) or not 1 <= len(values) <= MOST_NAMES:
        raise Refused("values: expected an object of name and number")
    result = {}
    for name, text in values.items():
        try:
            result[str(name)] = parse_number(text, mark_of(arguments))
        except Refused as error:
            raise Refused(f"{name}: {error}") from None
    return result


def flag(arguments, key):
    if not isinstance(arguments.get(key), bool):
        raise Refused(f"{key}: expected true or false")
    return arguments[key]
