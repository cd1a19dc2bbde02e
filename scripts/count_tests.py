#!/usr/bin/python3
"""Adds up the results of every registered test: count_tests.py BUILD_DIR [SINCE]

Prints failures and skips with their reasons; the last line is `N passed, N failed`. Fails when a test failed, when a
registered test wrote no result (since SINCE, seconds of the epoch) or one whose totals say more than its cases, when its
program ended otherwise than well (RESULT.xml.exit holds the exit code), when an unregistered test wrote a result, or when
there was no test at all. A rostest writes two files: rosunit-*.xml holds what its assertions say, rostest-*.xml only that
the launch ended (it shows no failure when an assertion fails), so the passes of the second are not counted.
"""
import os
import sys
import xml.etree.ElementTree as xml


def cases_of(root):
    """(name, kind, message) of every case in a JUnit file; kind is passed, failed or skipped."""
    for case in root.iter("testcase"):
        name = f"{case.get('classname', '')}.{case.get('name', '')}".strip(".")
        bad = case.find("failure")
        bad = case.find("error") if bad is None else bad
        skip = case.find("skipped")
        if bad is not None:
            yield name, "failed", bad.get("message") or (bad.text or "").strip()
        elif skip is not None or case.get("status") == "notrun":
            message = "" if skip is None else skip.get("message") or skip.text or ""
            yield name, "skipped", message.strip()
        else:
            yield name, "passed", ""


def without_case(root):
    """How many (tests, failures and errors) the totals of the suites name beyond their cases."""
    beyond = [0, 0]
    for suite in (element for element in root.iter() if element.tag in ("testsuite", "testsuites")):
        cases = list(cases_of(suite))
        failed = sum(kind == "failed" for _, kind, _ in cases)
        totals = [int(suite.get(key, 0)) for key in ("tests", "failures", "errors")]
        beyond = [max(beyond[0], totals[0] - len(cases)), max(beyond[1], totals[1] + totals[2] - failed)]
    return beyond


def cases_in(folder, name, since):
    """(name, kind, message) of one result file; a missing, empty or broken file is a failure."""
    path = os.path.join(folder, name)
    if not os.path.exists(path) or os.path.getmtime(path) < since:
        return [(name, "failed", "wrote no result")]
    try:
        root = xml.parse(path).getroot()
        found = list(cases_of(root))
        tests, failures = without_case(root)
    except (xml.ParseError, ValueError) as error:
        return [(name, "failed", f"broken result file: {error}")]
    if tests or failures:
        told = "\n".join((element.text or "").strip()[-1500:] for element in root.iter("system-err"))
        found.append((name, "failed", f"its totals name {tests} tests and {failures} failures or errors more than its cases\n{told}"))
    return found or [(name, "failed", "ran no test")]


def exit_of(folder, name, since):
    """What is wrong with how the program of a result ended, in words, or nothing."""
    path = os.path.join(folder, name + ".exit")
    if not os.path.exists(path) or os.path.getmtime(path) < since:
        return "its program did not end"
    with open(path, encoding="utf-8") as file:
        code = file.read().strip()
    return "" if code == "0" else f"its program ended with code {code}"


def runs_of(registered):
    """Results by the program that wrote them: a rostest's wrapper and what it runs, which follow it."""
    runs = []
    for name in registered:
        if name.startswith("rosunit-") and runs:
            runs[-1].append(name)
        else:
            runs.append([name])
    return runs


def results(build, since):
    """(file, name, kind, message) over all registered tests."""
    with open(os.path.join(build, "registered_tests.txt"), encoding="utf-8") as file:
        registered = file.read().split()
    folder = os.path.join(build, "test_results", "fmbpc")
    for run in runs_of(registered):
        cases = [(name, *case) for name in run for case in cases_in(folder, name, since)]
        wrong = exit_of(folder, run[0], since)
        if wrong and "failed" not in (kind for _, _, kind, _ in cases):
            cases.append((run[0], run[0], "failed", wrong))
        yield from (case for case in cases if not (case[0].startswith("rostest-") and case[2] == "passed"))
    for name in sorted(os.listdir(folder) if os.path.isdir(folder) else []):
        if name.endswith(".xml") and name not in registered:
            yield name, name, "failed", "a result that no registered test should write"


def reason_of(message):
    lines = [line for line in message.splitlines() if line.strip()]
    return lines[-1].strip() if lines else "no reason given"


def main(build, since="0"):
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    skips = {}
    for file, name, kind, message in results(build, float(since)):
        counts[kind] += 1
        if kind == "failed":
            print(f"FAILED {name} ({file})\n    " + message.strip().replace("\n", "\n    ")[:2000])
        elif kind == "skipped":
            reason = reason_of(message)
            skips[reason] = skips.get(reason, 0) + 1
    for reason, count in skips.items():
        print(f"{count} skipped: {reason}")
    print(f"{counts['passed']} passed, {counts['failed']} failed")
    return 0 if counts["failed"] == 0 and counts["passed"] > 0 else 1


if __name__ == "__main__":
    if {"-h", "--help"} & set(sys.argv[1:]):
        print(__doc__.strip())
        sys.exit(0)
    sys.exit(main(*sys.argv[1:]))
