#!/usr/bin/python3
"""Every command of docs/study.md can be typed: it is run as it stands there, over one seed and an hour or two."""
import json
import os
import pathlib
import re
import shlex
import subprocess
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
COMMAND = re.compile(r"^    (?:mpirun -n \d+ )?scripts/fmbpc (.*)$", re.MULTILINE)


def shortened(line):
    """One seed in place of the line's, no files, an hour or two."""
    words = shlex.split(line, comments=True)
    for option in ("--seeds", "--out"):
        if option in words:
            del words[words.index(option):words.index(option) + 2]
    return words + ["--seeds", "1:1", "--set", "sampling.duration_h=2", "--threads", "1", "--json"]


class StudyPage(unittest.TestCase):
    def test_its_commands_run(self):
        lines = COMMAND.findall((TOP / "docs" / "study.md").read_text())
        self.assertGreaterEqual(len(lines), 3)
        for line in lines:
            with self.subTest(line=line):
                done = subprocess.run([str(TOP / "scripts" / "fmbpc"), *shortened(line)], cwd=TOP, env=os.environ,
                                      capture_output=True, text=True, timeout=120, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                for loop in json.loads(done.stdout)["loops"]:
                    self.assertGreater(loop["median"], 0.0, loop)


if __name__ == "__main__":
    unittest.main()
