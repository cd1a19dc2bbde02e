#!/usr/bin/python3
"""The count of scripts/test says what the assertions say: in every kind of runner an assertion is broken on purpose, and the
count must see one failure. A result that is missing, empty or cut short is a failure too."""
import os
import pathlib
import re
import shutil
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

    def count(self, *registered, ended=0):
        """(exit code, last line) of the count over these results, whose programs ended with that code (None: not at all)."""
        (self.build / "registered_tests.txt").write_text("\n".join(registered) + "\n")
        for name in registered:
            if ended is not None and not name.startswith("rosunit-"):
                (self.results / (name + ".exit")).write_text(f"{ended}\n")
        run = subprocess.run([sys.executable, TOP / "scripts/count_tests.py", self.build], capture_output=True, text=True)
        return run.returncode, run.stdout.splitlines()[-1]

    def test_what_passes_is_counted(self):
        (self.results / "gtest-a.xml").write_text(PASSED.format("a"))
        self.assertEqual((0, "1 passed, 0 failed"), self.count("gtest-a.xml"))

    def test_a_program_that_ends_badly_after_its_result_is_a_failure(self):
        (self.results / "gtest-a.xml").write_text(PASSED.format("a"))
        self.assertEqual((1, "1 passed, 1 failed"), self.count("gtest-a.xml", ended=None))
        self.assertEqual((1, "1 passed, 1 failed"), self.count("gtest-a.xml", ended=134))
        (self.results / "gtest-a.xml").write_text(FAILED)
        self.assertEqual((1, "0 passed, 1 failed"), self.count("gtest-a.xml", ended=1))

    def test_a_gtest_that_crashes_after_its_result(self):
        result = self.results / "gtest-late.xml"
        run = subprocess.run([TOP / "test/keep_exit.sh", result, PROGRAMS / "broken_late", f"--gtest_output=xml:{result}"], capture_output=True)
        self.assertEqual((134, 1, "1 passed, 1 failed"), (run.returncode, *self.count("gtest-late.xml", ended=None)))

    def test_every_program_keeps_how_it_ended(self):
        """No test is registered past keep_exit.sh."""
        runs = (TOP / "test/CMakeLists.txt").read_text().split("function(fpc_add_run")[1].split("endfunction()", 1)[1]
        for past in ("catkin_run_tests_target", "catkin_add_gtest", "add_rostest("):
            self.assertNotIn(past, runs.replace("fpc_" + past, ""))

    def test_a_rostest_that_ends_badly_though_its_assertions_hold_is_a_failure(self):
        for name in ("rostest-a.xml", "rosunit-a.xml", "gtest-b.xml"):
            (self.results / name).write_text(PASSED.format("a"))
        self.assertEqual((1, "2 passed, 2 failed"), self.count("rostest-a.xml", "rosunit-a.xml", "gtest-b.xml", ended=2))

    def test_totals_without_cases_are_failures(self):
        for totals in ('tests="1" errors="1"', 'tests="3"', 'failures="2"'):
            suite = PASSED.format("a").replace("<testsuite", "<testsuite " + totals)
            for text in (suite, f'<testsuites>{suite}</testsuites>', f"<testsuites {totals}>{PASSED.format('a')}</testsuites>"):
                (self.results / "gtest-a.xml").write_text(text)
                self.assertEqual((1, "1 passed, 1 failed"), self.count("gtest-a.xml"), text)

    def test_a_gtest(self):
        subprocess.run([PROGRAMS / "broken_test", f"--gtest_output=xml:{self.results}/gtest-broken.xml"], capture_output=True)
        self.assertEqual((1, "0 passed, 1 failed"), self.count("gtest-broken.xml"))

    def test_the_contract_of_plants(self):
        subprocess.run([PROGRAMS / "broken_contract", "--gtest_filter=*KeepsWhatEveryPlantPromises*/broken",
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
            run = subprocess.run([TOP / "test/keep_exit.sh", self.results / "rostest-a.xml", "rostest", "--results-filename", "a.xml",
                                  TOP / "test/broken/broken.test"], env=environment, capture_output=True)
        self.assertNotEqual(0, run.returncode)
        self.assertEqual((1, "0 passed, 1 failed"), self.count("rostest-a.xml", "rosunit-broken.xml", ended=None))

    @unittest.skipUnless(WITH_ROS, "built without ROS")
    def test_a_rostest_with_a_case(self):
        with tempfile.TemporaryDirectory() as home:
            environment = dict(os.environ, ROS_TEST_RESULTS_DIR=str(self.build / "test_results"), ROS_HOME=home,
                               ROS_HOSTNAME="localhost")
            for case in ("one", "two"):
                subprocess.run(["rostest", "--results-filename", f"broken_case__case_{case}.xml", TOP / "test/broken/broken_case.test",
                                f"case:={case}"], env=environment, capture_output=True)
        written = [f"{kind}_{case}.xml" for case in ("one", "two") for kind in ("rostest-broken_case__case", "rosunit-broken")]
        self.assertEqual(sorted(written), sorted(path.name for path in self.results.glob("*.xml")))
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
                wrapper = f"rostest-{file.stem}__case_{case}.xml" if cases else f"rostest-{file.stem}.xml"
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


class Stages(unittest.TestCase):
    """.ci/run over scripts that stand for the real ones."""

    def run_stages(self, script, seconds, stages=("format", "tests")):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / ".ci").mkdir()
            (folder / "scripts").mkdir()
            shutil.copy(TOP / ".ci/run", folder / ".ci/run")
            for name, text in (("scripts/install", "exit 0"), ("scripts/check_format", script), (".ci/check_core", script), ("scripts/test", script)):
                (folder / name).write_text(f"#!/bin/sh\n{text}\n")
                (folder / name).chmod(0o755)
            for stage in stages:
                done = subprocess.run(["bash", folder / ".ci/run", stage], env=dict(os.environ, FMBPC_CI_SECONDS=str(seconds)),
                                      capture_output=True, text=True, timeout=60)
                yield done.returncode, done.stdout.splitlines()[-1]

    def test_what_passes(self):
        self.assertEqual([(0, "1 passed, 0 failed"), (0, "7 passed, 0 failed")], list(self.run_stages("echo '7 passed, 0 failed'", 100)))

    def test_what_hangs_has_failed(self):
        self.assertEqual([(1, "0 passed, 1 failed"), (1, "0 passed, 1 failed")], list(self.run_stages("exec sleep 50", 1)))

    def test_a_long_stage_that_does_not_fit_is_skipped_and_counted(self):
        self.assertEqual([(1, "0 passed, 0 failed, 1 skipped")], list(self.run_stages("exit 0", 100, ["core"])))
        self.assertEqual([(0, "1 passed, 0 failed")], list(self.run_stages("exit 0", 5000, ["core"])))

    def test_what_fails(self):
        self.assertEqual([(1, "0 passed, 1 failed"), (1, "7 passed, 1 failed")], list(self.run_stages("echo '7 passed, 0 failed'; exit 3", 100)))


if __name__ == "__main__":
    unittest.main()
