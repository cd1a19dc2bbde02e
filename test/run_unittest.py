#!/usr/bin/python3
"""Runs one unittest file and writes a JUnit file: run_unittest.py FILE RESULT.xml"""
import importlib.util
import sys
import time
import unittest
import xml.etree.ElementTree as xml


class Recorder(unittest.TextTestResult):
    """Keeps what became of every test, passed ones included."""

    def __init__(self, *args):
        super().__init__(*args)
        self.cases = []
        self.started = 0.0

    def startTest(self, test):
        self.started = time.monotonic()
        super().startTest(test)

    def note(self, test, kind=None, text=""):
        self.cases.append((test, kind, text, time.monotonic() - self.started))

    def addSuccess(self, test):
        super().addSuccess(test)
        self.note(test)

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self.note(test, "failure", self._exc_info_to_string(err, test))

    def addError(self, test, err):
        super().addError(test, err)
        self.note(test, "error", self._exc_info_to_string(err, test))

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self.note(test, "skipped", reason)


def write(cases, path):
    suite = xml.Element("testsuite", name=path, tests=str(len(cases)),
                        failures=str(sum(kind == "failure" for _, kind, _, _ in cases)),
                        errors=str(sum(kind == "error" for _, kind, _, _ in cases)))
    for test, kind, text, seconds in cases:
        case = xml.SubElement(suite, "testcase", name=str(test), time=f"{seconds:.3f}")
        if kind:
            xml.SubElement(case, kind, message=text.splitlines()[-1] if text else "").text = text
    xml.ElementTree(suite).write(path)


def main(file, result_file):
    spec = importlib.util.spec_from_file_location("tested", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    tests = unittest.defaultTestLoader.loadTestsFromModule(module)
    result = unittest.TextTestRunner(resultclass=Recorder, verbosity=2).run(tests)
    write(result.cases, result_file)
    return 0 if result.wasSuccessful() and result.testsRun else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
