#!/usr/bin/python3
"""scripts/golden tells loops that give the same bits from those that do not."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
LOOPS = ("heated_tank", "asp_case1_pi_s")


def golden(*arguments):
    tool = ["--tool", os.environ["FMBPC_TOOL"]] if "FMBPC_TOOL" in os.environ else []
    return subprocess.run([TOP / "scripts/golden", *tool, *arguments], capture_output=True, text=True, timeout=240, check=False)


class Golden(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        cls.table = cls.folder / "a"
        done = golden("write", cls.table, *LOOPS)
        assert done.returncode == 0, done.stderr

    def changed(self, loop, kind, value):
        """The table with the first fact of that kind of a loop changed, and the name of the fact."""
        lines = self.table.read_text().splitlines()
        at = next(n for n, line in enumerate(lines) if line.split("\t")[:2] == [loop, kind])
        name = lines[at].split("\t")[2]
        lines[at] = "\t".join((loop, kind, name, value))
        other = self.folder / "b"
        other.write_text("\n".join(lines) + "\n")
        return other, name

    def test_the_same_run_again(self):
        again = self.folder / "again"
        self.assertEqual(0, golden("write", "-j", "1", again, *LOOPS).returncode)
        self.assertEqual(self.table.read_text(), again.read_text())
        done = golden("compare", self.table, again)
        self.assertEqual((0, "2 loops the same, 0 different, 0 not compared (no records)"), (done.returncode, done.stdout.strip()))

    def test_it_holds_trajectory_and_indices(self):
        facts = {tuple(line.split("\t")[:3]) for line in self.table.read_text().splitlines()}
        self.assertLessEqual({("heated_tank", "run", "end"), ("heated_tank", "column", "T[degC]"), ("heated_tank", "index", "outputs.T.ise")}, facts)
        self.assertFalse([fact for fact in facts if fact[2].startswith(("wall", "events"))])

    def test_what_differs_is_named(self):
        for kind, value in (("column", "0123"), ("index", "42"), ("run", "1")):
            other, name = self.changed("heated_tank", kind, value)
            done = golden("compare", self.table, other)
            self.assertEqual(1, done.returncode)
            self.assertEqual("heated_tank", done.stdout.splitlines()[0])
            self.assertIn(name, done.stdout)
            self.assertEqual(1, golden("compare", other, self.table).returncode)
            self.assertEqual(0, golden("compare", self.table, other, "asp_case1_pi_s").returncode)

    def test_a_loop_that_is_gone_is_different(self):
        one = self.folder / "one"
        one.write_text("".join(line for line in self.table.read_text().splitlines(True) if line.startswith("heated_tank\t")))
        for pair in ((self.table, one), (one, self.table)):
            done = golden("compare", *pair)
            self.assertEqual((1, "1 loops the same, 1 different"), (done.returncode, done.stdout.splitlines()[-1][:29]))

    def test_no_records_are_no_difference(self):
        other = self.folder / "b"
        other.write_text(self.table.read_text() + "asp_uci\trun\tend\tno records\n")
        done = golden("compare", self.table, other)
        self.assertEqual((0, "2 loops the same, 0 different, 1 not compared (no records)"), (done.returncode, done.stdout.strip()))

    def test_what_is_no_table_is_refused(self):
        other = self.folder / "b"
        other.write_text("no table\n")
        done = golden("compare", self.table, other)
        self.assertEqual(1, done.returncode)
        self.assertIn("b:1: expected", done.stderr)


if __name__ == "__main__":
    unittest.main()
