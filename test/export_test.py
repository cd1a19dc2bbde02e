#!/usr/bin/python3
"""Exported blocks against the law in process: C99 by this machine's compiler, Structured Text by the interpreter of scripts/."""
import ctypes
import decimal
import math
import os
import pathlib
import platform
import random
import re
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "scripts"))
import export_check  # noqa: E402
import fmbpc  # noqa: E402
import structured_text  # noqa: E402
from exported_law import ExportedLaw  # noqa: E402

TOOL = os.environ.get("FMBPC_TOOL", str(TOP / "devel/lib/fmbpc/fmbpc_tool"))
LOOPS = ["asp_case1_pi_x", "cstr_tracking_gspi", "cstr_tracking_pi_best", "bsm1_own_supervisor", "asp_case1", "asp_case1_general", "cstr_tracking",
         "cstr_modbus", "column_clip", "surge_tank_steps", "mimo_cstr_steps"]


OPTIMIZED = {"asp_case1_clp": 250, "asp_clp_1b": 250, "column_clp_limits": 250, "linear_2x2_clp": 250, "surge_tank_steps_clp": 250,
             "column_clp_tracking": 6800}  # samples; holds that differ by rounding, more than 500 working sets


def takes_over(before, now):
    return before.iMode == 1 and now.iMode == 2 and now.iSource in (1, 3, 7) and not now.xReset


def bad_for_long(before, now):
    return before.iState == now.iState == 4 and now.iErrors & ~2 == 0 and now.iMode >= 2


# What a block does, in each language and in process alike: when, what holds then.
BEHAVIOUR = {
    "cold start": (lambda before, now: before is None, lambda now: now.away <= now.rounding),
    "manual to automatic": (lambda before, now: before and takes_over(before, now), lambda now: now.away <= now.rounding),
    "reset": (lambda before, now: now.xReset and now.iMode == 2 and now.iSource in (1, 3, 7), lambda now: now.away <= now.rounding),
    "bad measured value": (lambda before, now: before and bad_for_long(before, now), lambda now: now.away == 0.0),
    "actuator no number": (lambda before, now: now.actuator != now.actuator, lambda now: now.iErrors & 8 and now.out == now.out),
    "wrong sample time": (lambda before, now: now.rSampleTime > 0.0 and now.iMode >= 2 and now.xEnable and now.iErrors == 1,
                          lambda now: now.iSource == 4 and now.away == 0.0),
    "limits crossed": (lambda before, now: now.lower > now.upper, lambda now: now.iErrors & 4),
    "setpoint no number": (lambda before, now: now.asked != now.asked, lambda now: now.iErrors & 32 and now.active == now.active),
}


class Row(types.SimpleNamespace):
    """A sample by the names of the block, and what the table above asks about its first input."""

    def __init__(self, names, cells):
        super().__init__(**{name: float(cell) if name[0] == "r" else int(float(cell)) for name, cell in zip(names, cells)})
        for key, prefix in (("out", "rOut_"), ("actuator", "rActuator_"), ("lower", "rLower_"), ("upper", "rUpper_"),
                            ("asked", "rSetpoint_"), ("active", "rActive_")):
            setattr(self, key, getattr(self, next(name for name in names if name.startswith(prefix))))
        self.away = abs(self.out - self.actuator)
        self.rounding = 1e-9 * abs(self.upper - self.lower)


class InC:
    def __init__(self, folder):
        self.law = ExportedLaw(folder)

    def answer(self, given, wanted):
        for name, value in given.items():
            setattr(self.law.given, name, value)
        self.law.step()
        return [getattr(self.law.answer, name) for name in wanted]


class InStructuredText:
    def __init__(self, folder):
        self.block = structured_text.load((pathlib.Path(folder) / "law.st").read_text())["fb_law"]()

    def answer(self, given, wanted):
        for name, value in given.items():
            setattr(self.block, structured_text.Reader.name(name), value)
        self.block()
        return [getattr(self.block, structured_text.Reader.name(name)) for name in wanted]


class InProcess:
    """The same names before the controller in process."""

    def __init__(self, loop, **changes):
        self.law = fmbpc.Loop(loop, set=changes).controller()

    def answer(self, given, _=None):
        def part(prefix, names):
            return {name: given[prefix + name] for name in names if prefix + name in given}
        outputs, disturbances, inputs = ([signal[0] for signal in getattr(self.law.loop, kind)] for kind in ("outputs", "disturbances", "inputs"))
        return list(self.law.step(part("rValue_", outputs), part("rSetpoint_", outputs) or None, part("rValue_", disturbances) or None,
                                  part("rActuator_", inputs) or None))


def export(folder, loop, *more):
    return subprocess.run([TOOL, "export", loop, "--out", str(folder), *more], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          check=False)


class Export(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name) / "block"
        self.into = self.scratch.name

    def exported(self, loop, *more):
        done = export(self.folder, loop, *more)
        self.assertEqual(0, done.returncode, done.stderr)

    def test_both_languages_answer_as_the_process_does_and_with_the_same_bits(self):
        for loop in LOOPS:
            with self.subTest(loop=loop):
                self.exported(loop, "--samples", "250")
                said = export_check.native(self.folder, "law", "gcc", "-O0", self.into)
                self.assertTrue(said["passed"], said)
                self.assertEqual((250, 0), (said["samples"], said["flags"]))
                self.assertLessEqual(said["difference"], 1e-9)
                text = export_check.interpreted(self.folder, "law")
                self.assertEqual((250, 0, said["hash"]), (text["samples"], text["flags"], text["hash"]))

    def test_an_optimizer_in_c_answers_as_the_one_in_process(self):
        for loop, samples in OPTIMIZED.items():
            with self.subTest(loop=loop):
                self.exported(loop, "--to", "c99", "--seed", "7", "--samples", str(samples))
                said = [export_check.native(self.folder, "law", "gcc", level, self.into) for level in ("-O0", "-O2")]
                self.assertEqual([(samples, 0)] * 2, [(s["samples"], s["flags"]) for s in said])
                self.assertLessEqual(said[0]["difference"], 1e-9)
                self.assertEqual(said[0]["hash"], said[1]["hash"])
                rows = [row.split(",") for row in (self.folder / "law_vectors.csv").read_text().splitlines()]
                sources = {row[rows[0].index("iSource")] for row in rows[1:]}
                self.assertLessEqual({"2", "3", "4", "5"}, sources)
                if shutil.which("clang"):
                    self.assertEqual(said[0]["hash"], export_check.native(self.folder, "law", "clang", "-O2", self.into)["hash"])

    @unittest.skipUnless(shutil.which("arm-none-eabi-gcc") and shutil.which("qemu-system-arm"), "no board to emulate")
    def test_an_optimizer_on_a_board_has_the_same_bits_and_calls_no_library(self):
        self.exported("linear_2x2_clp", "--to", "c99", "--samples", "40")
        here = export_check.native(self.folder, "law", "gcc", "-O2", self.into)
        there = export_check.emulated(self.folder, "law", "cortex-m7", self.into, 40)
        self.assertEqual(here["hash"], there["hash"])

    @unittest.skipUnless(shutil.which("arm-none-eabi-gcc") and shutil.which("qemu-system-arm"), "no board to emulate")
    def test_a_law_of_nine_rules_is_small_and_fast_on_a_board(self):
        for precision, core in (([], "cortex-m7"), (["--real"], "cortex-m4")):
            self.exported(str(TOP / "test/export/nine_rules.yaml"), "--to", "c99", "--samples", "200", *precision)
            said = export_check.emulated(self.folder, "law", core, self.into)
            for what, aim in (("code", 8192), ("stack", 1024), ("instructions", 20000)):
                self.assertLessEqual(said[what], aim, (core, what))

    @unittest.skipUnless(shutil.which("frama-c"), "no frama-c")
    def test_a_proof_finds_an_index_out_of_bounds_and_an_overflow(self):
        for loop, judge, right, wrong in (
                (f"{TOP}/test/export/nine_rules.yaml --real", export_check.analysed, r"9\.99999968e-21f", "1.0e-30f"),
                ("asp_case1_pi_x", export_check.analysed, r"s->last\[0\] = u\[0\]", "s->last[1] = u[0]"),
                ("linear_2x2_clp", export_check.analysed_optimizer, r"(within\(q->count, LAW_CLP_N) - 1", r"\1")):
            with self.subTest(loop=loop):
                self.exported(*loop.split(), "--to", "c99", "--samples", "10")
                law = self.folder / "law.c"
                text = law.read_text()
                self.assertRegex(text, right)
                self.assertEqual(0, judge(self.folder, "law", self.into))
                law.write_text(re.sub(right, wrong, text))
                self.assertLess(0, judge(self.folder, "law", self.into))

    def test_a_block_with_an_optimizer_may_have_any_name(self):
        self.exported("linear_2x2_clp", "--to", "c99", "--samples", "30", "--name", "clp")
        self.assertTrue(export_check.native(self.folder, "clp", "gcc", "-O0", self.into)["passed"])

    def own_exponential(self, words):
        """A library with the block's exp, behind these words of C."""
        text = (self.folder / "law.c").read_text()
        parts = [re.search(rf"^static \w+ law_{name}\(double x\) {{.*?^}}", text, re.M | re.S)[0] for name in ("floor", "exp")]
        source, library = pathlib.Path(self.into) / "exp.c", pathlib.Path(self.into) / "exp.so"
        source.write_text("#define _GNU_SOURCE\n#include <dlfcn.h>\n#include <stdint.h>\n" + "\n".join(parts) + words)
        subprocess.run(["gcc", "-std=c99", "-O2", "-ffp-contract=off", "-fno-builtin", "-shared", "-fPIC", str(source), "-o", str(library)], check=True)
        return library

    @unittest.skipUnless(platform.machine() == "x86_64" and platform.libc_ver()[0] == "glibc", "sums of Eigen with two numbers at a time")
    def test_the_published_law_has_the_bits_of_the_process_but_for_its_exponential(self):
        words = """
double exp(double x) {
  double (*rest)(double) = (double (*)(double))dlsym(RTLD_NEXT, "exp");
  return x >= -700.0 && x <= 0.0 ? law_exp(x) : rest(x);
}
"""
        for loop in ("asp_case1", "asp_case_d", "cstr_tracking"):
            with self.subTest(loop=loop):
                self.exported(loop, "--to", "c99", "--samples", "10")
                done = subprocess.run([TOOL, "export", loop, "--to", "c99", "--samples", "2000", "--out", str(self.folder)], check=False, stdout=subprocess.DEVNULL,
                                      stderr=subprocess.PIPE, env={**os.environ, "LD_PRELOAD": str(self.own_exponential(words))})
                self.assertEqual(0, done.returncode, done.stderr)
                said = export_check.native(self.folder, "law", "gcc", "-O2", self.into)
                self.assertEqual((2000, 0, 0.0), (said["samples"], said["flags"], said["difference"]))

    def test_the_own_exponential_is_rounded_right_but_for_one_number_in_200(self):
        self.exported("asp_case1", "--to", "c99", "--samples", "10")
        own = ctypes.CDLL(str(self.own_exponential("\ndouble own(double x) { return law_exp(x); }\n"))).own
        own.restype, own.argtypes = ctypes.c_double, [ctypes.c_double]
        draw, worst, wrong = random.Random(5), 0.0, 0
        decimal.getcontext().prec = 40
        for span in (1e-8, 1e-3, 0.35, 1.0, 5.0, 30.0, 300.0, 700.0):
            for _ in range(1000):
                x = -draw.uniform(0.0, span)
                exact = decimal.Decimal(x).exp()
                wrong += own(x) != float(exact)
                worst = max(worst, float(abs(decimal.Decimal(own(x)) - exact) / decimal.Decimal(math.ldexp(1.0, math.frexp(float(exact))[1] - 53))))
        self.assertEqual((1.0, 0.0), (own(0.0), own(-701.0)))
        self.assertLess(worst, 0.53)
        self.assertLess(0.1, worst)  # of rounding alone
        self.assertLess(wrong, 40)  # of 8,000

    def test_an_optimizer_that_may_not_try_enough_clips_the_law(self):
        self.exported("asp_clp_1b", "--to", "c99", "--samples", "250")
        vectors = self.folder / "law_vectors.csv"
        rows = [row.split(",") for row in vectors.read_text().splitlines()]
        column = rows[0].index("iMostSets")
        self.assertEqual({"10000"}, {row[column] for row in rows[1:]})
        for row in rows[1:]:
            row[column] = "0"
        vectors.write_text("".join(",".join(row) + "\n" for row in rows))
        said = export_check.native(self.folder, "law", "gcc", "-O0", self.into)
        self.assertLess(5, said["flags"])  # the law or clipped, where a limit makes the optimizer act
        self.assertLess(1e-3, said["difference"])

    def test_the_vectors_hold_everything_that_happens_to_a_block(self):
        self.exported("asp_case1_pi_x")
        rows = (self.folder / "law_vectors.csv").read_text().splitlines()
        names = rows[0].split(",")
        self.assertEqual(1001, len(rows))
        seen = {name: {row.split(",")[names.index(name)] for row in rows[1:]} for name in ("iSource", "iState", "iErrors", "xReset", "xTrack")}
        self.assertLessEqual({"1", "3", "4", "5"}, seen["iSource"])
        self.assertLessEqual({"0", "1", "2", "3", "4"}, seen["iState"])
        self.assertLessEqual({"0", "1", "4", "8", "32"}, seen["iErrors"])
        self.assertEqual(({"0", "1"}, {"0", "1"}), (seen["xReset"], seen["xTrack"]))

    def test_another_law_fails_the_vectors(self):
        self.exported("asp_case1_pi_x", "--samples", "300")
        law = self.folder / "law.c"
        wrong = law.read_text().replace("1.0 * error", "1.0001 * error")
        self.assertNotEqual(wrong, law.read_text())
        law.write_text(wrong)
        said = export_check.native(self.folder, "law", "gcc", "-O0", self.into)
        self.assertFalse(said["passed"], said)

    def test_the_self_test_of_structured_text_passes_and_can_fail(self):
        self.exported("asp_case1_pi_x", "--to", "st")
        law, test = ((self.folder / name).read_text() for name in ("law.st", "law_test.st"))
        self.assertFalse((self.folder / "law.c").exists())
        for text, passes in ((law, True), (law.replace("1.0 * error", "1.01 * error"), False)):
            block = structured_text.load(text, test)["fb_law_test"]()
            while not block.v_xdone:
                block()
            self.assertEqual(passes, block.v_xpassed)

    def test_what_happens_to_a_block_ends_alike_in_each_language_and_in_process(self):
        for loop in ("asp_case1_pi_x", "asp_case1"):
            self.exported(loop, "--seed", "4")
            lines = [line.split(",") for line in (self.folder / "law_vectors.csv").read_text().splitlines()]
            names, lines = lines[0], lines[1:]
            first = next(i for i, name in enumerate(names) if name.startswith("rOut_"))
            played = {"process": lines}
            for block in (InC(self.folder), InStructuredText(self.folder)):
                played[type(block).__name__] = rows = []
                for line in lines:
                    given = {name: float(cell) if name[0] == "r" else int(float(cell)) if name[0] == "i" else cell != "0"
                             for name, cell in zip(names[:first], line)}
                    rows.append(line[:first] + block.answer(given, names[first:]))
            for who, rows in played.items():
                rows = [Row(names, row) for row in rows]
                for what, (when, holds) in BEHAVIOUR.items():
                    with self.subTest(loop=loop, who=who, what=what):
                        seen = [now for before, now in zip([None, *rows], rows) if when(before, now)]
                        self.assertTrue(seen)
                        self.assertEqual([], [now for now in seen if not holds(now)])

    def test_nothing_winds_up_against_a_valve_that_stands(self):
        self.exported("asp_case1_pi_x", "--set", "actuator.move_upper=20")
        for block in (InC(self.folder), InStructuredText(self.folder), InProcess("asp_case1_pi_x", **{"actuator.move_upper": 20})):
            given = {"rValue_x": 1400.0, "rValue_s": 50.0, "rValue_q_i": 1300.0, "rValue_s_i": 400.0, "rSetpoint_x": 1500.0, "rActuator_q_r": 775.0}
            pushed = [block.answer(given, ["rOut_q_r"])[0] - 775.0 for _ in range(500)]
            turned = [block.answer({**given, "rValue_x": 1600.0}, ["rOut_q_r"])[0] - 775.0 for _ in range(3)]
            self.assertNotEqual(0.0, pushed[-1])
            self.assertLess(turned[-1] * pushed[-1], 0.0, (type(block).__name__, pushed[-1], turned))

    def test_a_changed_hash_starts_the_block_anew(self):
        self.exported("asp_case1_pi_x")
        given = {"rValue_x": 1500.0, "rValue_s": 50.0, "rValue_q_i": 1300.0, "rValue_s_i": 400.0, "rActuator_q_r": 500.0}
        for block, state, name in ((c := InC(self.folder), c.law.state, "hash"), (st := InStructuredText(self.folder), st.block, "v_hash")):
            answers = [block.answer(given, ["rOut_q_r"]) for _ in range(40)]
            self.assertNotEqual([500.0], answers[-1])
            setattr(state, name, getattr(state, name) + 1)
            self.assertEqual([[500.0]] * 2, [answers[0], block.answer(given, ["rOut_q_r"])])

    def test_a_changed_model_takes_over_in_process_without_a_bump(self):
        text = pathlib.Path(fmbpc.Loop("asp_case1").model_file).read_text()
        changed = pathlib.Path(self.scratch.name) / "changed.yaml"
        changed.write_text(re.sub(r"offset: ([-0-9.e]+)", lambda m: f"offset: {float(m[1]) + 20.0}", text))
        self.assertNotEqual(text, changed.read_text())
        given = {"rValue_x": 1700.0, "rValue_s": 50.0, "rValue_q_i": 1300.0, "rValue_s_i": 400.0, "rSetpoint_x": 1700.0}
        stays, changes = InProcess("asp_case1"), InProcess("asp_case1")
        for _ in range(5):
            self.assertEqual(stays.answer(given), changes.answer(given))
        changes.law.set_model(fmbpc.Model(changed))
        self.assertAlmostEqual(stays.answer(given)[0], changes.answer(given)[0], delta=1e-6)
        later = [(stays.answer(given)[0], changes.answer(given)[0]) for _ in range(40)]
        self.assertNotAlmostEqual(*later[-1], delta=1.0)

    def test_single_precision_is_exported_where_the_law_allows_it(self):
        self.exported("asp_case1", "--real", "--samples", "250")
        said = export_check.native(self.folder, "law", "gcc", "-O0", self.into)
        self.assertTrue(said["passed"], said)
        self.assertLess(1e-9, said["difference"])
        self.assertEqual(said["hash"], export_check.interpreted(self.folder, "law")["hash"])
        statements = re.sub(r"VAR.*?END_VAR|\(\*.*?\*\)", "", (self.folder / "law.st").read_text(), flags=re.S)
        # matiec reckons in double with a literal that has no type
        self.assertEqual({"REAL#"}, set(re.findall(r"(REAL#)?\b\d+\.\d", statements)))
        shutil.rmtree(self.folder)
        done = export(self.folder, "column_clip", "--real", "--samples", "500")
        self.assertEqual(1, done.returncode)
        self.assertIn("--real", done.stderr)
        self.assertFalse(self.folder.exists())

    def test_what_is_not_exported_is_refused_by_name_and_nothing_is_written(self):
        for loop, words in (("cstr_tracking_nmpc", ("controller.type", "nmpc")),
                            ("asp_case1_pi_x --set controller.loops.0.preview_h=1", ("preview_h",)),
                            ("asp_case1_clp", ("clp", "--to c99")),
                            ("asp_case1_clp --to c99 --real", ("--real",)),
                            ("asp_case1_pi_x --set standstill.window_h=6 --set standstill.signals.x=1", ("standstill",)),
                            ("four_on_two --to c99", ("targets",)),
                            ("cstr_tracking_observer", ("controller.realisation",)),
                            ("column_linear", ("controller.law",)),
                            ("asp_case1_pi_x --name Law-1", ("--name",))):
            done = export(self.folder, *loop.split())
            self.assertEqual(1, done.returncode, loop)
            for word in words:
                self.assertIn(word, done.stderr)
            self.assertFalse(self.folder.exists(), loop)


if __name__ == "__main__":
    unittest.main()
