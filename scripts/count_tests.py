#!/usr/bin/python3
"""Adds up the results of every registered test: count_tests.py BUILD_DIR [SINCE]

Prints failures and skips with their reasons; the last line is `N passed, N failed`. Fails when a test failed, when a
registered test wrote no result (since SINCE, seconds of the epoch), or when there was no test at all.
"""
import os
import sys
import xml.etree.ElementTree as xml


def cases_of(path):
    """(name, kind, message) of every case in a JUnit file; kind is passed, failed or skipped."""
    for case in xml.parse(path).getroot().iter("testcase"):
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


def results(build, since):
    """(file, name, kind, message) over all registered tests; a missing or broken file is a failure."""
    with open(os.path.join(build, "registered_tests.txt"), encoding="utf-8") as file:
        registered = file.read().split()
    for name in registered:
        path = os.path.join(build, "test_results", "fmbpc", name)
        if not os.path.exists(path) or os.path.getmtime(path) < since:
            yield name, name, "failed", "wrote no result"
            continue
        try:
            found = list(cases_of(path))
        except xml.ParseError as error:
            found = [(name, "failed", f"broken result file: {error}")]
        if not found:
            found = [(name, "failed", "ran no test")]
        for case in found:
            yield (name, *case)


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
