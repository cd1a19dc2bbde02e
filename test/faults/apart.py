"""Faults that want a launch, a machine or a file of their own: each is a test of its own, met by running it.

    apart.py --out RESULTS.json    run by scripts/faults
"""
import argparse
import functools
import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent.parent
sys.path[:0] = [str(HERE.parent / "ros")]
import exchange  # noqa: E402


def gtest(binary, tests):
    def meet():
        done = subprocess.run([exchange.program(binary), "--gtest_filter=" + tests], capture_output=True, text=True, check=False, cwd=TOP / "test")
        return done.returncode == 0 and "[  PASSED  ] 0 tests" not in done.stdout
    return tests.replace(":", ", "), meet


@functools.lru_cache(maxsize=None)
def cases_of(stem):
    """{test case: whether it passed} of a rostest."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["rostest", "--pkgdir", str(TOP), "--package", "fmbpc", "--results-base-dir", folder, "--results-filename", "x.xml",
                        str(TOP / "test" / "ros" / (stem + ".test"))], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        found = [case for file in pathlib.Path(folder).rglob("rosunit-*.xml") for case in xml.parse(file).iter("testcase")]
        return {case.get("name"): not list(case.iter("failure")) + list(case.iter("error")) for case in found}


def rostest(stem, case):
    return f"{stem}.{case}", lambda: cases_of(stem).get("test_" + case, False)


def hosts(case):
    """Two network namespaces; needs root, `ip` and `nft`."""
    return f"partition.{case}", lambda: subprocess.run(
        [str(TOP / "scripts" / "partition"), "Partition.test_" + case], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        check=False).returncode == 0


FAULTS = {
    "position reads anything, 200 random courses": gtest("test_gateway", "LyingPosition.*"),
    "another host reaches for a loop of the name localhost": hosts("nobody_reaches_a_loop_of_the_name_localhost"),
    "another host reaches for a loop behind scripts/fence": hosts("only_members_pass_the_fence"),
    "link cut for 10 s": hosts("ten_seconds_without_a_link"),
    "link cut for 15 s, a node starts again meanwhile": hosts("a_node_that_starts_again_while_the_link_is_cut_is_connected_soon_after"),
    "`--out` is a device, a link, a folder": gtest("test_base", "FilesTest.*"),
    "recorder ended in mid-run, four times": rostest(
        "records", "a_recorder_that_is_told_to_end_in_mid_run_and_comes_back_has_all_samples_in_record_and_bag"),
    "a node of the recorder's name": rostest("records", "a_node_of_the_recorders_name_goes_on_with_record_and_bag"),
    "endless run": rostest("records", "an_endless_run_is_filed_in_parts_each_with_its_bag"),
    "recorder hangs at the end": rostest("records", "a_recorder_that_hangs_is_killed_when_the_run_is_over"),
    "plant ended": rostest("records", "a_plant_that_is_told_to_end_says_so_last"),
    "analyser frozen": gtest("test_runtime", "SignalFaults.*"),
    "healthy signals of shipped loops and public records": gtest("test_gateway", "PlausibleSession.NoShippedLoopIsDoubted"),
    "healthy signals of public records": gtest("test_gateway", "FlatLine.*"),
    "manual to automatic, every shipped loop": gtest("test_runtime", "HandOver.*"),
    "member that reads another loop": rostest("startup", "members_that_read_another_loop_do_not_join"),
    "Modbus map in which an address means two things": gtest("test_gateway", "GatewayParams.*"),
    "nobody at the PLC's address": rostest("startup", "a_plc_where_nobody_answers_is_named_at_once_and_the_plant_ends"),
    "forged final sample, publishers open": gtest("test_runtime", "RecorderSessionTest.AForgedFinalDoesNotEndARunThatGoesOn"),
    "two loops started at the same moment": rostest("launch_file", "two_loops_started_at_the_same_moment_on_one_master_both_run"),
    "roslaunch killed (-9), to the end of the run": rostest("launch_file", "a_launcher_that_is_killed_is_said_and_its_nodes_end_with_the_run"),
    "standard output full": gtest("test_tool", "Tool.StdoutThatIsFullIsAnError"),
    "list of 29 MB in a loop file": gtest("test_tool", "LoopsTool.ALoopFileOfTooManyValuesIsRefusedBeforeItTakesMemory"),
    "weights that are no numbers": gtest("test_runtime", "*ShippedLoop.RefusesAWeight*"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", required=True)
    results = []
    out = parser.parse_args().out
    for fault, (test, meet) in FAULTS.items():
        passed = meet()
        print(f"{fault}: {'as asked' if passed else 'NOT AS ASKED'} ({test})", flush=True)
        results.append({"fault": fault, "test": test, "passed": passed})
    pathlib.Path(out).write_text(json.dumps(results, indent=1), encoding="utf-8")
    return 0 if all(r["passed"] for r in results) else 1


if __name__ == "__main__":
    sys.exit(main())
