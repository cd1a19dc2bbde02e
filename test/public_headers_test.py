#!/usr/bin/python3
"""include/fmbpc holds the headers that docs/ and examples/ name, and what these include: no more, no less. All of it is installed."""
import pathlib
import re
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = TOP / "include" / "fmbpc"
OWN = re.compile(r'^#include ["<]fmbpc/([\w/.]+)[">]', re.MULTILINE)
NAMED = re.compile(r"\bfmbpc/([a-z0-9_]+/[a-z0-9_/]+\.hpp)\b")
ALLOWED_ROOMS = {"base", "plant", "model", "control"}
SYSTEM = re.compile(r"^#include <([\w/.]+)>", re.MULTILINE)


def installed():
    return sorted(str(path.relative_to(INCLUDE)) for path in INCLUDE.rglob("*.hpp"))


def closure(roots):
    reached, waiting = set(), list(roots)
    while waiting:
        header = waiting.pop()
        if header not in reached:
            reached.add(header)
            waiting += OWN.findall((INCLUDE / header).read_text())
    return reached


def named():
    """In the pages, and in the sources of the examples."""
    pages = [TOP / "README.md", *(TOP / "docs").glob("*.md"), *(p for p in (TOP / "examples").rglob("*") if p.is_file() and p.suffix != ".pyc")]
    return {header for page in pages for header in NAMED.findall(page.read_text())}


class PublicHeaders(unittest.TestCase):
    def test_pages_and_examples_name_installed_ones_only(self):
        self.assertGreaterEqual(len(named()), 8)
        self.assertEqual(set(), named() - set(installed()))

    def test_the_folder_is_what_they_name_and_what_that_includes(self):
        self.assertEqual(closure(named()), set(installed()))

    def test_they_show_a_compiler_nothing_but_eigen_and_the_standard_library(self):
        """No ROS, no yaml-cpp, no JSON; none of the rooms that read files, run loops or speak topics; no private header."""
        for header in installed():
            text = (INCLUDE / header).read_text()
            self.assertIn(header.split("/")[0], ALLOWED_ROOMS)
            for system in SYSTEM.findall(text):
                self.assertRegex(system, r"^(Eigen/\w+|[a-z_]+)$", header)
            for quoted in re.findall(r'^#include "([^"]+)"', text, re.MULTILINE):
                self.assertTrue(quoted.startswith("fmbpc/"), f"{header} includes {quoted}")

    def test_nothing_else_is_installed(self):
        for cmake in [TOP / "CMakeLists.txt", *(TOP / "src").rglob("CMakeLists.txt"), *(TOP / "cmake").iterdir()]:
            text = re.sub(r"#[^\n]*", "", cmake.read_text())
            for call in re.findall(r"\binstall\(([^)]*)\)", text):
                if re.search(r"\binclude\b|\.hpp", call):
                    self.assertEqual("DIRECTORY include/fmbpc/ DESTINATION ${FMBPC_INCLUDE}", call, cmake)


if __name__ == "__main__":
    unittest.main()
