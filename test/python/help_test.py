#!/usr/bin/python3
"""help(fmbpc): every public name says what it is, what it raises and where more is written; the blocks of the page and of the help run."""
import inspect
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import types
import unittest

import fmbpc
from fmbpc import plots

TOP = pathlib.Path(__file__).resolve().parents[2]


def members(cls):
    """Public ones that the package itself defines, by name."""
    for name in dir(cls):
        value = inspect.getattr_static(cls, name)
        if not name.startswith("_") and any(name in c.__dict__ for c in cls.__mro__ if c.__module__.startswith("fmbpc")):
            if isinstance(value, (types.FunctionType, property)) or hasattr(value, "attrname"):  # cached_property
                yield name, value


def public():
    """(name, object) of all that help(fmbpc) and help(fmbpc.plots) show."""
    for module in (fmbpc, plots):
        for name in module.__all__:
            value = getattr(module, name)
            if isinstance(value, (type, types.FunctionType)):
                yield name, value
            if isinstance(value, type):
                yield from ((f"{name}.{member}", found) for member, found in members(value))


def may_be_wrong(value):
    """It takes an argument by name, which somebody may hand over wrongly."""
    function = value.__init__ if isinstance(value, type) else value
    if not isinstance(function, types.FunctionType):
        return False
    return any(p.name != "self" and p.kind != p.VAR_POSITIONAL for p in inspect.signature(function).parameters.values())


class Help(unittest.TestCase):
    def test_every_public_name_says_what_it_is(self):
        found = dict(public())
        self.assertGreater(len(found), 100)
        self.assertEqual([], [name for name, value in found.items() if not (getattr(value, "__doc__", None) or "").strip()])

    def test_what_takes_arguments_says_what_it_raises(self):
        made_by_others = {"Controller", "Env", "Run", "Signal", "Simulation", "VectorEnv", "InputError"}
        silent = [name for name, value in public() if name not in made_by_others and may_be_wrong(value) and not re.search(r"[Rr]aises ", value.__doc__)]
        self.assertEqual([], silent)

    def test_every_name_leads_to_its_page(self):
        """Pages of docs/, which name the sources."""
        for name, value in public():
            for page in re.findall(r"docs/\w+\.md", value.__doc__ or ""):
                self.assertTrue((TOP / page).exists(), f"{name}: {page}")
        without = [name for name, value in public() if "." not in name and "docs/" not in (value.__doc__ or "")]
        self.assertEqual([], without)

    def test_the_module_names_all_it_has(self):
        """Its own help is the list of contents."""
        self.assertEqual([], [name for name in fmbpc.__all__ if not re.search(rf"\b{name}\b", fmbpc.__doc__)])

    def test_what_the_page_and_the_help_show_runs(self):
        """The blocks of docs/python.md, and the lines of help(fmbpc), one after the other."""
        page = (TOP / "docs/python.md").read_text(encoding="utf-8")
        blocks = re.findall(r"```python\n(.*?)```", page, flags=re.S)
        blocks.append("\n".join(line.strip() for line in fmbpc.__doc__.splitlines() if line.startswith("    ")))
        self.assertTrue(all("import fmbpc" in block for block in blocks) and len(blocks) > 1)
        with tempfile.TemporaryDirectory() as folder:
            for block in blocks:
                subprocess.run([sys.executable, "-c", block], check=True, cwd=folder, env={**os.environ, "MPLBACKEND": "Agg"})
            self.assertTrue(pathlib.Path(folder, "run.png").exists())


if __name__ == "__main__":
    unittest.main()
