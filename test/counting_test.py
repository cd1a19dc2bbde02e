#!/usr/bin/python3
"""The count of scripts/test says what the assertions say: in every kind of runner an assertion is broken on purpose, and the
count must see one failure. A result that is missing, empty or cut short is a failure too."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
PROGRAMS = pathlib.Path(os.environ.get("FMBPC_BROKEN_TESTS", ""))  # folder of the broken test programs
WITH_ROS = os.environ.get("FMBPC_TEST_ROS") == "1"
PASSED = '<testsuite><testcase classname="C" name="{}"/></testsuite>'
FAILED = '<testsuite failures="1"><testcase classname="C" name="a"><failure message="1 is not 2"/></testcase></testsuite>'


class Counting(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.build = pathlib.Path(scratch.name)
        self.results = self.build / "test_results" / "fmbpc"
        self.results.mkdir(parents=True)

    def count(self, *registered):
        """(exit code, last line) of the count over these results."""
        (self.build / "registered_tests.txt").write_text("\n".join(registered) + "\n")
        run = subprocess.run([sys.executable, TOP / "scripts/count_tests.py", self.build], capture_output=True, text=True)
        return run.returncode, run.stdout.splitlines()[-1]

    def test_what_passes_is_counted(self):
        (self.results / "gtest-a.xml").write_text(PASSED.format("a"))
        self.assertEqual((0, "1 passed, 0 failed"), self.count("gtest-a.xml"))

    def test_a_gtest(self):
        subprocess.run([PROGRAMS / "broken_test", f"--gtest_output=xml:{self.results}/gtest-broken.xml"], capture_output=True)
        self.assertEqual((1, "0 passed, 1 failed"), self.count("gtest-broken.xml"))

    def test_the_contract_of_plants(self):
        subprocess.run([PROGRAMS / "broken_contract", "--gtest_filter=*DerivativesAreFinite*/broken",
                        f"--gtest_output=xml:{self.results}/gtest-contract.xml"], capture_output=True)
        self.assertEqual((1, "0 passed, 1 failed"), self.count("gtest-contract.xml"))

    def test_a_python_test(self):
        subprocess.run([sys.executable, TOP / "test/run_unittest.py", TOP / "test/broken/broken.py",
                        self.results / "python-broken.xml"], capture_output=True)
        self.assertEqual((1, "0 passed, 1 failed"), self.count("python-broken.xml"))

    @unittest.skipUnless(WITH_ROS, "built without ROS")
    def test_a_rostest(self):
        with tempfile.TemporaryDirectory() as home:
            environment = dict(os.environ, ROS_TEST_RESULTS_DIR=str(self.build / "test_results"), ROS_HOME=home,
                               ROS_HOSTNAME="localhost")
            subprocess.run(["rostest", TOP / "test/broken/broken.test"], env=environment, capture_output=True)
        wrapper = next(path.name for path in self.results.glob("rostest-*.xml"))
        self.assertEqual((1, "0 passed, 1 failed"), self.count(wrapper, "rosunit-broken.xml"))

    @unittest.skipUnless(WITH_ROS, "built without ROS")
    def test_a_rostest_with_a_case(self):
        with tempfile.TemporaryDirectory() as home:
            environment = dict(os.environ, ROS_TEST_RESULTS_DIR=str(self.build / "test_results"), ROS_HOME=home,
                               ROS_HOSTNAME="localhost")
            for case in ("one", "two"):
                subprocess.run(["rostest", "--results-filename", f"broken_case__case_{case}.xml", TOP / "test/broken/broken_case.test",
                                f"case:={case}"], env=environment, capture_output=True)
        written = sorted(path.name for path in self.results.glob("*.xml"))
        self.assertEqual(["rostest-broken_case__case_one.xml", "rostest-broken_case__case_two.xml", "rosunit-broken_one.xml",
                          "rosunit-broken_two.xml"], written)
        self.assertEqual((1, "0 passed, 2 failed"), self.count(*written))
        self.assertEqual((1, "0 passed, 3 failed"), self.count(*written, "rosunit-broken_three.xml"))

    @unittest.skipUnless(WITH_ROS, "built without ROS")
    def test_every_case_of_every_rostest_is_registered(self):
        registered = (PROGRAMS.parent.parent / "registered_tests.txt").read_text().split()
        known = subprocess.run([TOP / "scripts/flaky", "nobody"], capture_output=True, text=True).stderr
        for file in sorted((TOP / "test/ros").glob("*.test")):
            text = file.read_text()
            cases = re.search(r'<arg name="case" doc="([^"]+)"/>', text)
            self.assertEqual(cases is not None, "$(arg case)" in text, file)
            if file.stem == "modbus" and "rosunit-modbus.xml" not in registered:
                continue  # built without libmodbus
            for case in re.split(r", | or ", cases[1]) if cases else [""]:
                for name in re.findall(r'test-name="([^"]+)"', text):
                    self.assertIn(f"rosunit-{name.replace('$(arg case)', case)}.xml", registered)
                wrapper = f"rostest-{file.stem}__case_{case}.xml" if cases else f"rostest-test_ros_{file.stem}.xml"
                self.assertIn(wrapper, registered)
                self.assertIn(file.stem + ("_" + case if case else ""), re.findall(r"\w+", known))

    @unittest.skipUnless(WITH_ROS, "built without ROS")
    def test_a_rostest_that_is_run_again_and_again(self):
        run = subprocess.run([TOP / "scripts/flaky", "-n", "2", "--keep", self.build / "logs", "../broken/broken"],
                             env=dict(os.environ, ROS_HOSTNAME="localhost"), capture_output=True, text=True)
        self.assertEqual((1, "0 passed, 2 failed"), (run.returncode, run.stdout.splitlines()[-1]), run.stderr)
        self.assertIn("FAILED ../broken/broken, run 2", run.stdout)
        self.assertEqual(2, len(list((self.build / "logs").glob("*.log"))))

    def test_the_wrapper_of_a_rostest_adds_no_passes(self):
        (self.results / "rostest-a.xml").write_text(PASSED.format("a"))
        (self.results / "rosunit-a.xml").write_text(PASSED.format("a"))
        self.assertEqual((0, "1 passed, 0 failed"), self.count("rostest-a.xml", "rosunit-a.xml"))

    def test_a_launch_that_failed_counts_even_if_the_assertions_passed(self):
        (self.results / "rostest-a.xml").write_text(FAILED)
        (self.results / "rosunit-a.xml").write_text(PASSED.format("a"))
        self.assertEqual((1, "1 passed, 1 failed"), self.count("rostest-a.xml", "rosunit-a.xml"))

    def test_missing_empty_and_broken_results_are_failures(self):
        (self.results / "gtest-empty.xml").write_text("<testsuite/>")
        (self.results / "gtest-cut.xml").write_text("<testsuite><testcase name='a'")
        self.assertEqual((1, "0 passed, 3 failed"), self.count("gtest-missing.xml", "gtest-empty.xml", "gtest-cut.xml"))

    def test_a_result_file_that_nobody_registered_is_a_failure(self):
        (self.results / "gtest-a.xml").write_text(PASSED.format("a"))
        (self.results / "rosunit-b.xml").write_text(FAILED)
        self.assertEqual((1, "1 passed, 1 failed"), self.count("gtest-a.xml"))


if __name__ == "__main__":
    unittest.main()
