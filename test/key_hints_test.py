#!/usr/bin/python3
"""Every key that a message of the sources names exists: it stands in the tables of the docs, which other tests compare
with the readers. A hint that leads nowhere is worse than none."""
import pathlib
import re
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
DOCS = [*sorted(p.relative_to(TOP).as_posix() for p in (TOP / "docs").glob("loop_*.md")), "docs/structure_file.md", "docs/tuning_file.md", "docs/study_file.md"]
SECTIONS = ("plant", "sampling", "disturbance", "setpoint", "model", "controller", "clp", "actuator", "noise", "loop", "tf",
            "report", "partition", "consequents", "repair", "validation", "time", "csv", "fitness", "search", "scenarios",
            "guard", "sensors", "gateway")
FILES = {"yaml", "csv", "json", "cpp", "hpp", "launch", "msg", "new", "png", "py", "md"}


def without_lists(key):
    return re.sub(r"\[[^\]]*\]", "", key)


def written_out(key):
    """The keys that a row stands for: lists of signals and sections of the same keys."""
    if "SIGNALS" in key:
        return [key.replace("SIGNALS", matrix + signals) for signals in ("outputs", "inputs", "disturbances") for matrix in ("", "matrix.")]
    same = {"controller.observer": "targets.observer", "plant.matrix.elements": "controller.model", "disturbance.commands": "setpoint.commands"}
    return [key, *(key.replace(one, other) for one, other in same.items() if key.startswith(one))]


def documented():
    """Keys of the tables with their sections, names of signals as NAME, and all that lead to them."""
    keys, section = set(), ""
    for name in DOCS:
        if not (TOP / name).exists():
            continue
        for line in (TOP / name).read_text().splitlines():
            if not line.startswith("| `"):
                continue
            for key in re.findall(r"`([^`]+)`", line.split("|")[1]):
                key = without_lists(key)
                key = section + key if key.startswith(".") else key
                section = key.rsplit(".", 1)[0]
                for one in written_out(key.replace("TOPIC", "NAME")):
                    parts = one.split(".")
                    keys.update(".".join(parts[:n]) for n in range(1, len(parts) + 1))
                keys.update(f"{key}.{word}" for word in re.findall(r"`([a-z_]+): ", line))
    return keys


def leading(known):
    """Keys that are sections: others stand below them."""
    return {key.rsplit(".", 1)[0] for key in known if "." in key}


def named():
    """(key, file) for every dotted key in a string of the sources."""
    pattern = re.compile(r"(?<![\w./\-])((?:%s)\.[a-z][\w]*(?:\[[^\]\"]*\])?(?:\.[\w]+(?:\[[^\]\"]*\])?)*)" % "|".join(SECTIONS))
    for file in sorted((TOP / "src").rglob("*.[ch]pp")):
        if file.name == "gone_keys.cpp":  # those are what its errors name
            continue
        text = re.sub(r'"\s*\n\s*"', "", file.read_text())
        text = re.sub(r"//[^\n]*", "", text)
        for literal in re.findall(r'"((?:[^"\\\n]|\\.)*)"', text):
            for key in pattern.findall(literal):
                if key.rsplit(".", 1)[-1] not in FILES:
                    yield without_lists(key), file.relative_to(TOP)


def is_known(key, known):
    """As written, with numbers of list items, with names of signals, or a name below a key that takes them."""
    parts = [part for part in key.split(".") if not part.isdigit()]
    if ".".join(parts) in known or ".".join(parts[:-1]) in known - leading(known):
        return True
    return any(".".join(parts[:n] + ["NAME"] + parts[n + 1:]) in known for n in range(1, len(parts)))


class KeyHints(unittest.TestCase):
    maxDiff = None

    def test_every_key_that_a_message_names_exists(self):
        known = documented()
        self.assertGreater(len(known), 200)
        found = list(named())
        self.assertGreater(len(found), 50)
        wrong = sorted({f"{file}: {key}" for key, file in found if not key.endswith(".bag") and not is_known(key, known)})
        self.assertEqual(wrong, [])

    def test_a_key_that_does_not_exist_is_noticed(self):
        known = documented()
        for key in ("disturbance.missing", "disturbance.end", "controller.horizont"):
            self.assertFalse(is_known(key, known), key)
        for key in ("disturbance.csv.missing", "plant.parameters.yield", "repair.missing", "setpoint.schedule.time_h"):
            self.assertTrue(is_known(key, known), key)


if __name__ == "__main__":
    unittest.main()
