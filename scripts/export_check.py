#!/usr/bin/python3
"""Builds and runs what `fmbpc export` wrote, with what this machine has, and says what it could not.

    export_check.py FOLDER      (`fmbpc export --check FOLDER`)

Every compiler must answer the vectors within their tolerance and give the same bits. Exit code 0: all that could run passed."""
import csv
import glob
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import structured_text  # noqa: E402

WARNINGS = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Wvla", "-Werror"]
EXACT = ["-ffp-contract=off"]
COMPARED_ERRORS = 1 + 4 + 8 + 32
MASK = (1 << 64) - 1


def run(words, **more):
    return subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False, **more)


def native(folder, name, compiler, level, into, vectors=None):
    """What the test program says, as a dictionary; raises RuntimeError with the compiler's words."""
    program = os.path.join(into, "test")
    law = os.path.join(into, "law.o")
    for words in ([compiler, *WARNINGS, *EXACT, level, "-c", f"{name}.c", "-o", law],
                  [compiler, "-std=c99", *EXACT, level, f"{name}_test.c", law, "-o", program]):
        built = run(words, cwd=folder)
        if built.returncode != 0:
            raise RuntimeError(built.stderr.strip())
    played = run([program] + ([vectors] if vectors else []), cwd=folder)
    return {**json.loads(played.stdout), "passed": played.returncode == 0}


def fnv(value, data):
    for byte in data:
        value = ((value ^ byte) * 1099511628211) & MASK
    return value


def interpreted(folder, name, samples=None):
    """The same of the block in Structured Text, by the interpreter: the same bits give the same hash."""
    with open(os.path.join(folder, f"{name}.st"), encoding="utf-8") as file:
        text = file.read()
    block = structured_text.load(text)[f"fb_{name}"]()
    single = "LREAL" not in text
    flags, count, hashed = 0, 0, 14695981039346656037
    number = structured_text.single if single else float
    with open(os.path.join(folder, f"{name}_vectors.csv"), encoding="utf-8") as file:
        rows = csv.reader(file)
        names = next(rows)
        first = next(i for i, n in enumerate(names) if n.startswith("rOut_"))
        columns = [structured_text.Reader.name(n) for n in names]
        for row in rows:
            for i in range(first):
                kind = names[i][0]
                value = number(row[i]) if kind == "r" else int(float(row[i])) if kind == "i" else float(row[i]) != 0.0
                setattr(block, columns[i], value)
            block()
            for i in range(first, len(names)):
                answer = getattr(block, columns[i])
                if names[i][0] == "r":
                    hashed = fnv(hashed, struct.pack("<f" if single else "<d", answer))
                else:
                    hashed = fnv(hashed, struct.pack("<i", answer))
                    seen = answer & COMPARED_ERRORS if names[i] == "iErrors" else answer
                    flags += seen != int(float(row[i]))
            count += 1
            if count == samples:
                break
    return {"samples": count, "flags": flags, "hash": f"{hashed:016x}"}


class Check:
    def __init__(self, folder):
        self.folder, self.rows, self.failed, self.hashes = folder, [], False, {}
        found = [os.path.basename(p)[:-len("_vectors.csv")] for p in glob.glob(os.path.join(folder, "*_vectors.csv"))]
        if len(found) != 1:
            sys.exit(f"export --check: expected one NAME_vectors.csv in {folder}, found {len(found)}")
        self.name = found[0]

    def say(self, what, words, failed=False):
        self.failed = self.failed or failed
        print(f"{what:<34}{'FAILED: ' if failed else ''}{words}", flush=True)

    def has(self, suffix):
        return os.path.exists(os.path.join(self.folder, self.name + suffix))

    def verdict(self, what, result):
        words = f"{result['samples']} samples"
        if "difference" in result:
            words += f", differs by {result['difference']:.2g} of the span"
        self.say(what, f"{words}, {result['flags']} flags differ, bits {result['hash']}",
                 not result.get("passed", True) or result["flags"] > 0)
        self.hashes[what] = result["hash"]

    def compilers(self):
        for compiler in ("gcc", "clang"):
            for level in ("-O0", "-O2"):
                what = f"{compiler} {level}"
                if not shutil.which(compiler):
                    self.say(what, f"not run: no {compiler}")
                    continue
                with tempfile.TemporaryDirectory() as into:
                    try:
                        self.verdict(what, native(self.folder, self.name, compiler, level, into))
                    except RuntimeError as wrong:
                        self.say(what, str(wrong), True)

    def structured_text(self):
        self.verdict("Structured Text, interpreter", interpreted(self.folder, self.name))
        texts = [open(os.path.join(self.folder, self.name + s), encoding="utf-8").read() for s in (".st", "_test.st")]
        test = structured_text.load(*texts)[f"fb_{self.name}_test"]()
        samples = 0
        while not test.v_xdone:
            test()
            samples += 1
        self.say("Structured Text, self-test", f"{samples} vectors" if test.v_xpassed else f"differs at {test.v_ifailed}",
                 not test.v_xpassed)

    def run(self):
        if self.has(".c"):
            self.compilers()
        if self.has(".st"):
            self.structured_text()
        if len(set(self.hashes.values())) > 1:
            self.say("bits", "not the same everywhere", True)
        return 1 if self.failed else 0


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    sys.exit(Check(sys.argv[1]).run())
