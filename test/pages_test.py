#!/usr/bin/python3
"""Commands of the pages can be typed. Those of the tool that need no running loop are run, as they stand there, in the order of the
page; searches and studies shortened. Of all others: programs, launch files with their arguments, subcommands and options exist."""
import json
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
PAGES = [TOP / "README.md", *sorted((TOP / "docs").glob("*.md"))]
GENERATED = {"results.md", "faults.md", "performance.md", "noise_survey.md", "events.md"}
RUN = ("identification", "own_data", "own_plant", "real_plant", "first_loop", "loop_file", "loop_controller", "structure_file", "study", "stability", "tuning")
COMMAND = re.compile(r"^    ((?:sudo |mpirun -n \d+ )?(?:scripts/fmbpc|fmbpc|scripts/\w+|roslaunch|rosrun fmbpc)(?:\.py)? ?.*)$", re.MULTILINE)
RUNNING = {"set", "disturb", "manual", "auto", "release", "watch", "replay", "recover"}  # ask a loop over topics, or its record
LONG = {"evaluate", "check", "export"}  # their own tests run them
SHORTER = {"--work": "1", "--evaluations": "20", "--points": "2", "--seeds": "1:1"}


def commands(page):
    """Lines of a page's code blocks, without comments, usage lines left out."""
    for line in COMMAND.findall(page.read_text()):
        words = shlex.split(line, comments=True)
        if not any(re.fullmatch(r"\[?[A-Z]{4,}[A-Z0-9:=,.\]]*", word) for word in words):
            yield words


def shortened(words):
    words = list(words)
    for option, value in SHORTER.items():
        if option in words:
            words[words.index(option) + 1] = value
    if words[0] == "tune":
        words += ["--population", "2"] + ([] if "--evaluations" in words else ["--evaluations", "2"])
    if words[0] == "study":
        words = [word for word in words if word not in ("--out", "results/sludge")]
        words += ["--set", "sampling.duration_h=2", "--json"] + ([] if "--seeds" in words else ["--seeds", "1:1"])
    return words


def tool_words(words):
    """What the tool gets, if this is a call of it."""
    while words and words[0] in ("sudo", "mpirun", "-n") or words and words[0].isdigit():
        words = words[1:]
    return words[1:] if words and words[0] in ("fmbpc", "scripts/fmbpc") else None


class Pages(unittest.TestCase):
    def test_what_they_name_is_there(self):
        tool = "".join(p.read_text() for p in sorted((TOP / "src/tool").glob("*.cpp")))
        seen = 0
        for page in PAGES:
            if page.name in GENERATED:
                continue
            for words in commands(page):
                with self.subTest(page=page.name, words=words):
                    seen += 1
                    if words[0] == "roslaunch":
                        launch = next(word for word in words if word.endswith(".launch"))
                        known = set(re.findall(r'<arg name="(\w+)"', (TOP / "launch" / launch).read_text()))
                        given = {word.split(":=")[0] for word in words if ":=" in word}
                        self.assertLessEqual(given, known)
                    elif words[0].startswith("scripts/") and words[0] != "scripts/fmbpc":
                        self.assertTrue((TOP / words[0]).exists())
                    elif tool_words(words):
                        called = tool_words(words)
                        self.assertRegex(tool, rf'"{called[0]}"')
                        for option in (word for word in called if word.startswith("--") and word != "--"):
                            self.assertRegex(tool, rf'["!,]{option}\b')
        self.assertGreater(seen, 60)

    def test_they_run(self):
        environment = dict(os.environ, FMBPC_CONFIG_PATH="")
        with tempfile.TemporaryDirectory() as folder:
            for name in ("examples", "config"):
                os.symlink(TOP / name, pathlib.Path(folder) / name)
            count = 0
            for page in RUN:
                for words in commands(TOP / "docs" / f"{page}.md"):
                    called = tool_words(words)
                    if not called or called[0] in RUNNING | LONG or words[0] == "mpirun":
                        continue
                    called = [word.replace("$PWD", folder) for word in shortened(called)]
                    with self.subTest(page=page, words=called):
                        done = subprocess.run([str(TOP / "scripts" / "fmbpc"), *called], cwd=folder, env=environment,
                                              capture_output=True, text=True, timeout=120, check=False)
                        worse = called[0] == "tune" and done.returncode == 3  # two points may end worse on what is held out
                        self.assertTrue(worse or done.returncode == 0, done.stdout[-400:] + done.stderr)
                        if called[0] == "study":
                            self.assertTrue(all(loop["median"] > 0.0 for loop in json.loads(done.stdout)["loops"]))
                        count += 1
            self.assertGreater(count, 25)


if __name__ == "__main__":
    unittest.main()
