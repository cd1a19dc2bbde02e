#!/usr/bin/python3
"""Builds and runs what `fmbpc export` wrote, with what this machine has, and says what it could not.

    export_check.py FOLDER                (`fmbpc export --check FOLDER`)
    export_check.py --loops SAMPLES [LOOP ...]
    export_check.py --real SAMPLES [LOOP ...]

The second form exports loops (none named: all that can be exported) into a folder that it takes away, and prints a row for each: C99 by gcc against
the law in process, Structured Text against C99 by the interpreter and by $FMBPC_IEC2C. That variable names iec2c of matiec, its folder lib beside
it, where Structured Text is to be compiled as well. The third form does so in single precision, in C99 only, and names the loops that are refused
for it. Every compiler must answer the vectors within their tolerance and give the same bits. Exit code
0: all that could run passed."""
import csv
import glob
import json
import os
import re
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


def require_no_call(nm, law):
    """The block calls nothing that is not its own."""
    called = [line.split()[-1] for line in run([*nm, "-u", law]).stdout.splitlines()]
    if any(not name.startswith("__aeabi_") for name in called):  # arithmetic of a core without a floating-point unit
        raise RuntimeError(f"calls {', '.join(called)}")


def native(folder, name, compiler, level, into, vectors=None):
    """What the test program says, as a dictionary; raises RuntimeError with the compiler's words."""
    program = os.path.join(into, "test")
    law = os.path.join(into, "law.o")
    for words in ([compiler, *WARNINGS, *EXACT, level, "-c", f"{name}.c", "-o", law],
                  [compiler, "-std=c99", *EXACT, level, f"{name}_test.c", law, "-o", program]):
        built = run(words, cwd=folder)
        if built.returncode != 0:
            raise RuntimeError(built.stderr.strip())
    require_no_call(["nm"], law)
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


PLAYER = r"""#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "accessor.h"
#include "iec_std_lib.h"
TIME __CURRENT_TIME;
BOOL __DEBUG;
#include "POUS.h"
#include "POUS.c"
static unsigned long long hash = 14695981039346656037ULL;
static void add(const void *bytes, size_t count) {
  const unsigned char *b = bytes;
  for (size_t i = 0; i < count; i++) hash = (hash ^ b[i]) * 1099511628211ULL;
}
static FB_LAW fb;
int main(int argc, char **argv) {
  static char line[64 * COLUMNS];
  static double v[COLUMNS];
  long samples = 0, flags = 0;
  FILE *file = fopen(argv[1], "r");
  if (file == NULL || fgets(line, sizeof line, file) == NULL) return 2;
  FB_LAW_init__(&fb, 0);
  while (fgets(line, sizeof line, file) != NULL) {
    char *at = line;
    for (int i = 0; i < COLUMNS; i++) {
      v[i] = strtod(at, &at);
      at++;
    }
GIVE
    FB_LAW_body__(&fb);
TAKE
    samples++;
  }
  printf("{\"samples\": %ld, \"flags\": %ld, \"hash\": \"%016llx\"}\n", samples, flags, hash);
  return 0;
}
"""


def compiled(folder, name, compiler, into):
    """The same of the block in Structured Text, by the compiler iec2c; raises RuntimeError."""
    folder, library = os.path.abspath(folder), os.path.join(os.path.dirname(os.path.abspath(compiler)), "lib")
    with open(os.path.join(folder, f"{name}_vectors.csv"), encoding="utf-8") as file:
        names = file.readline().strip().split(",")
    first = next(i for i, n in enumerate(names) if n.startswith("rOut_"))
    give = "\n".join(f"    fb.{n.upper()}.value = v[{i}]{' != 0.0' if n[0] == 'x' else ''};" for i, n in enumerate(names[:first]))
    take = []
    for i, n in enumerate(names[first:], first):
        take.append(f"    add(&fb.{n.upper()}.value, sizeof fb.{n.upper()}.value);")
        if n[0] == "i":
            mask = f" & {COMPARED_ERRORS}" if n == "iErrors" else ""
            take.append(f"    flags += (fb.{n.upper()}.value{mask}) != (DINT)v[{i}];")
    text = PLAYER.replace("COLUMNS", str(len(names))).replace("GIVE", give).replace("TAKE", "\n".join(take)).replace("LAW", name.upper())
    with open(os.path.join(into, "player.c"), "w", encoding="utf-8") as file:
        file.write(text)
    program = os.path.join(into, "player")
    for words in ([compiler, "-f", "-I", library, "-T", into, os.path.join(folder, f"{name}.st")],
                  ["gcc", "-w", "-O1", *EXACT, "-I", os.path.join(library, "C"), "-I", into, os.path.join(into, "player.c"), "-o", program, "-lm"]):
        built = run(words, cwd=into)
        if built.returncode != 0:
            raise RuntimeError((built.stderr or built.stdout).strip()[-600:])
    played = run([program, os.path.join(folder, f"{name}_vectors.csv")])
    if played.returncode != 0:
        raise RuntimeError("the compiled block did not run")
    return json.loads(played.stdout)


# Rules of MISRA C 2012 that a block breaks, with the reason (docs/export.md lists them).
DEVIATIONS = {"misra-c2012-2.5": "identity macros are for the caller", "misra-c2012-8.9": "tables stand before the function, one below the other",
              "misra-c2012-8.7": "the caller is another file", "unusedFunction": "the caller is another file",
              "knownConditionTrueFalse": "the text is the same for every number of signals",
              "duplicateExpression": "the text is the same for every number of signals",
              "misra-c2012-2.2": "the text is the same for every number of signals", "moduloofone": "the text is the same for every number of signals",
              "unreadVariable": "the text is the same for every kind of optimizer",
              "variableScope": "variables stand at the head, as in Structured Text"}
BOARDS = {"cortex-m3": ("mps2-an385", ["-mfloat-abi=soft"]), "cortex-m4": ("mps2-an386", ["-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"]),
          "cortex-m7": ("mps2-an500", ["-mfloat-abi=hard", "-mfpu=fpv5-d16"])}
TICKS_PER_INSTRUCTION = 1.6  # of timer 0 at 25 MHz, an instruction taking 64 ns (-icount shift=6)
ON_BOARD = 200  # vectors
LINK = """ENTRY(reset)
MEMORY { code : ORIGIN = 0, LENGTH = 4M  data : ORIGIN = 0x20000000, LENGTH = 4M }
SECTIONS { .text : { KEEP(*(.vectors)) *(.text*) *(.rodata*) } > code  .ARM.exidx : { *(.ARM.exidx*) } > code
  .data : { *(.data*) *(.bss*) *(COMMON) } > data  end = .; }
"""
BOARD = """#include <stddef.h>
#include <stdint.h>
#include "NAME.h"
static long call(int what, const void *with) {
  register long r0 __asm__("r0") = what;
  register const void *r1 __asm__("r1") = with;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}
void reset(void);
__attribute__((section(".vectors"), used)) static const uint32_t vectors[2] = {0x20200000u, (uint32_t)reset};
static uint64_t hash = 14695981039346656037ULL;
static NAME_state_t state;
static NAME_in_t in;
static NAME_out_t out;
static void add(const void *bytes, size_t count) {
  const unsigned char *b = bytes;
  for (size_t i = 0; i < count; i++) hash = (hash ^ b[i]) * 1099511628211ULL;
}
static void print(uint64_t value) {
  char text[20];
  for (int i = 0; i < 16; i++) text[i] = "0123456789abcdef"[(value >> (60 - 4 * i)) & 15];
  text[16] = ' ';
  text[17] = 0;
  call(4, text);
}
VECTORS
static void __attribute__((noinline)) play(void) {
  uint32_t most = 0;
  uint64_t sum = 0;
  *(volatile uint32_t *)0x40000008 = 0xFFFFFFFF;
  *(volatile uint32_t *)0x40000000 = 1;
  NAME_defaults(&in);
  for (int k = 0; k < COUNT; k++) {
GIVE
    uint32_t before = *(volatile uint32_t *)0x40000004;
    NAME_step(&state, &in, &out);
    uint32_t ticks = before - *(volatile uint32_t *)0x40000004;
    sum += ticks;
    most = ticks > most ? ticks : most;
TAKE
  }
  print(hash);
  print(most);
  print(sum);
  print(sizeof state);
  call(0x18, (void *)0x20026);
}
/* Saves no register of the floating-point unit, if there is one, before it is switched on. */
void reset(void) {
  *(volatile uint32_t *)0xE000ED88 |= 0xFu << 20;
  __asm__ volatile("dsb");
  __asm__ volatile("isb");
  play();
  for (;;) {}
}
"""


def text_of(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return file.read()


def optimizes(header):
    return "iMostSets" in header


def rows_of(folder, name, samples):
    with open(os.path.join(folder, f"{name}_vectors.csv"), encoding="utf-8") as file:
        lines = file.read().splitlines()[:samples + 1]
    return lines, lines[0].split(","), [[float(cell) for cell in line.split(",")] for line in lines[1:]]


def board_program(folder, name, samples):
    """The test program of a board: the first vectors in its flash, what it says by semihosting."""
    _, names, rows = rows_of(folder, name, samples)
    first = next(i for i, n in enumerate(names) if n.startswith("rOut_"))
    real = "double" if " double " in text_of(folder, f"{name}.h") else "float"
    cells = [", ".join("(0.0/0.0)" if v != v else repr(v) for v in row[:first]) for row in rows]
    kinds = {"r": f"({real})", "i": "(int32_t)", "x": "0.0 != "}
    give = "\n".join(f"    in.{n} = {kinds[n[0]]}v[k][{i}];" for i, n in enumerate(names[:first]))
    take = "\n".join(f"    add(&out.{n}, sizeof out.{n});" for n in names[first:])
    vectors = f"static const double v[{len(rows)}][{first}] = {{{{" + "},{".join(cells) + "}};"
    text = BOARD.replace("NAME", name).replace("COUNT", str(len(rows)))
    return text.replace("VECTORS", vectors).replace("GIVE", give).replace("TAKE", take)


def emulated(folder, name, core, into, samples=ON_BOARD):
    """Bits, sizes, stack and instructions on an emulated board; raises RuntimeError."""
    board, floats = BOARDS[core]
    for file, text in (("board.c", board_program(folder, name, samples)), ("board.ld", LINK)):
        with open(os.path.join(into, file), "w", encoding="utf-8") as to:
            to.write(text)
    law, program = os.path.join(into, "law.o"), os.path.join(into, "board.elf")
    options = ["-std=gnu99", "-O2", *EXACT, "-mthumb", f"-mcpu={core}", *floats, f"-I{os.path.abspath(folder)}"]
    for words in (["arm-none-eabi-gcc", *options, "-fstack-usage", "-c", os.path.join(os.path.abspath(folder), f"{name}.c"), "-o", law],
                  ["arm-none-eabi-gcc", *options, "-nostartfiles", "-nostdlib", "-T", "board.ld", "board.c", law, "-o", program, "-lgcc"]):
        built = run(words, cwd=into)
        if built.returncode != 0:
            raise RuntimeError(built.stderr.strip()[-600:])
    require_no_call(["arm-none-eabi-nm"], law)
    size = run(["arm-none-eabi-size", law]).stdout.split("\n")[1].split()
    with open(os.path.join(into, "law.su"), encoding="utf-8") as file:
        stack = max(int(line.split("\t")[1]) for line in file)
    said = run(["timeout", "60", "qemu-system-arm", "-M", board, "-nographic", "-monitor", "none", "-serial", "none", "-semihosting-config",
                "enable=on,target=native", "-icount", "shift=6", "-kernel", program])
    words = (said.stdout + said.stderr).split()
    if len(words) != 4:
        raise RuntimeError("the board said " + (said.stderr or said.stdout)[-200:])
    return {"hash": words[0], "instructions": round(int(words[1], 16) / TICKS_PER_INSTRUCTION),
            "mean": round(int(words[2], 16) / TICKS_PER_INSTRUCTION / samples), "code": int(size[0]), "stack": stack,
            "state": int(words[3], 16)}


FINITE = "Frama_C_double_interval(-1.7e308, 1.7e308)"
WITHIN = "Frama_C_double_interval(-1e15, 1e15)"


def eva(folder, into, source, program, words):
    """Alarms of Frama-C EVA for a program behind the block's text, and claims that it cannot prove; raises RuntimeError."""
    main = os.path.join(into, "main.c")
    with open(main, "w", encoding="utf-8") as file:
        file.write(f'#include "__fc_builtin.h"\n{source}\n{program}')
    said = run(["frama-c", "-eva", *words, f"-cpp-extra-args=-I{os.path.abspath(folder)}", main])
    found = re.search(r"(\d+) alarms? generated", said.stdout)
    claims = re.search(r"Assertions +\d+ valid +(\d+) unknown +(\d+) invalid", said.stdout)
    if not found or not claims:
        raise RuntimeError((said.stderr or said.stdout)[-300:])
    return int(found[1]) + int(claims[1]) + int(claims[2])


def analysed_optimizer(folder, name, into):
    """Alarms of the optimizer alone, given any finite numbers: memory, indices, and that its inputs stay within their limits. Inside it numbers
    may become infinite or none."""
    source, header = (text_of(folder, name + suffix) for suffix in (".c", ".h"))
    members = header[header.index("/* The constraint optimizer of one sample"):header.index("/* answered */")]
    given = "\n".join(f"    for (int i = 0; i < {size}; i++) w.{m}[i] = {WITHIN if m in ('lower', 'upper') else FINITE};"
                      for m, size in re.findall(r"^  double (\w+)\[(.*?)\];", members, re.M))
    return eva(folder, into, source, f"""static {name}_clp_t w;
int main(void) {{
  while (Frama_C_interval(0, 1)) {{
{given}
    {name}_clp_step(&w, Frama_C_interval(-2147483647, 2147483647));
    for (int i = 0; i < {name.upper()}_CLP_NU; i++) {{
      //@ assert -1e15 <= w.u[i] <= 1e15;
    }}
    //@ assert 1 <= w.source <= 3 && 1 <= w.status <= 4;
  }}
  return 0;
}}
""", ["-eva-precision", "0", "-eva-auto-loop-unroll", "8", "-warn-special-float", "none"])


def replaced_optimizer(source, name):
    """The block's text with another optimizer: any answer that analysed_optimizer() proves, and its conditions claimed."""
    at = source.index(f"\nvoid {name}_defaults(")
    return source[:at] + f"""
static void any_step({name}_clp_t* w) {{
  for (int i = 0; i < {name.upper()}_CLP_NU; i++) {{
    //@ assert -1e15 <= w->lower[i] <= 1e15 && -1e15 <= w->upper[i] <= 1e15;
    w->u[i] = {WITHIN};
  }}
  w->source = Frama_C_interval(1, 3);
  w->status = Frama_C_interval(1, 4);
  w->iterations = Frama_C_interval(-2147483647, 2147483647);
  w->active = Frama_C_interval(-2147483647, 2147483647);
}}
""" + source[at:].replace(f"{name}_clp_step(&s->clp, in->iMostSets)", "any_step(&s->clp)")


def analysed(folder, name, into):
    """Alarms over any sequence of samples, every number within 1e15; an optimizer stands for itself: analysed_optimizer()."""
    source, header = (text_of(folder, name + suffix) for suffix in (".c", ".h"))
    body = header[header.index("typedef struct {"):header.index(f"}} {name}_in_t;")]
    draws = {"double": WITHIN, "float": "Frama_C_float_interval(-1e15f, 1e15f)", "int32_t": "Frama_C_interval(-2147483647, 2147483647)",
             "bool": "Frama_C_interval(0, 1)"}
    given = "\n".join(f"    in.{member} = {draws[kind]};" for kind, member in re.findall(r"^  (\w+) (\w+);", body, re.M))
    return eva(folder, into, replaced_optimizer(source, name) if optimizes(header) else source, f"""static {name}_state_t s;
static {name}_in_t in;
static {name}_out_t out;
int main(void) {{
  {name}_defaults(&in);
  while (Frama_C_interval(0, 1)) {{
{given}
    {name}_step(&s, &in, &out);
  }}
  return 0;
}}
""", ["-eva-precision", "1", "-eva-auto-loop-unroll", "64", "-warn-special-float", "non-finite"])


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

    def optimizes(self):
        return optimizes(text_of(self.folder, f"{self.name}.h"))

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

    def boards(self):
        missing = [p for p in ("arm-none-eabi-gcc", "qemu-system-arm") if not shutil.which(p)]
        for core in BOARDS:
            if missing:
                self.say(core, f"not run: no {' and no '.join(missing)}")
                continue
            if core != "cortex-m7" and self.optimizes():
                self.say(core, "not run: an optimizer in double precision is for a board that has it")
                continue
            with tempfile.TemporaryDirectory() as into:
                try:
                    vectors = os.path.join(into, "vectors.csv")
                    lines, _, rows = rows_of(self.folder, self.name, ON_BOARD)
                    with open(vectors, "w", encoding="utf-8") as file:
                        file.write("\n".join(lines) + "\n")
                    here = native(self.folder, self.name, "gcc", "-O2", into, vectors)
                    there = emulated(self.folder, self.name, core, into, len(rows))
                except (RuntimeError, FileNotFoundError) as wrong:
                    self.say(core, str(wrong), True)
                    continue
                self.say(core, f"{len(rows)} samples, {'same bits' if there['hash'] == here['hash'] else 'other bits'}, code and tables "
                         f"{there['code']} bytes, state {there['state']}, stack {there['stack']}, instructions a step {there['instructions']} at most, "
                         f"{there['mean']} on the average", there["hash"] != here["hash"])

    def judges(self):
        source = os.path.join(self.folder, f"{self.name}.c")
        if shutil.which("cppcheck"):
            said = run(["cppcheck", "--addon=misra", "--enable=all", "--std=c99", "--suppress=missingIncludeSystem", "--quiet",
                        "--template={id}", source])
            rules = sorted(set(line for line in said.stderr.split() if line))
            others = [rule for rule in rules if rule not in DEVIATIONS]
            self.say("cppcheck, MISRA C 2012", f"deviations {', '.join(r.replace('misra-c2012-', '') for r in rules) or 'none'}"
                     + (f"; without a reason: {', '.join(others)}" if others else ""), bool(others))
        else:
            self.say("cppcheck, MISRA C 2012", "not run: no cppcheck")
        if not shutil.which("frama-c"):
            self.say("Frama-C EVA", "not run: no frama-c")
            return
        for what, judge, words in (("Frama-C EVA", analysed, "numbers within 1e15"),
                                   ("Frama-C EVA, optimizer", analysed_optimizer, "of memory, indices and limits; any finite numbers"))[:1 + self.optimizes()]:
            with tempfile.TemporaryDirectory() as into:
                try:
                    alarms = judge(self.folder, self.name, into)
                    self.say(what, f"{alarms} alarms, {words}", alarms > 0)
                except RuntimeError as wrong:
                    self.say(what, str(wrong), True)

    def structured_text(self):
        self.verdict("Structured Text, interpreter", interpreted(self.folder, self.name))
        compiler = os.environ.get("FMBPC_IEC2C")
        if compiler:
            with tempfile.TemporaryDirectory() as into:
                try:
                    self.verdict("Structured Text, iec2c", compiled(self.folder, self.name, compiler, into))
                except (RuntimeError, OSError) as wrong:
                    self.say("Structured Text, iec2c", str(wrong), True)
        else:
            self.say("Structured Text, iec2c", "not run: FMBPC_IEC2C names no compiler")
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
            self.boards()
            self.judges()
        if self.has(".st"):
            self.structured_text()
        if len(set(self.hashes.values())) > 1:
            self.say("bits", "not the same everywhere", True)
        return 1 if self.failed else 0


def survey(form, samples, loops):
    """One row for each loop; 1 if one failed."""
    tool, compiler = os.environ.get("FMBPC_TOOL", "fmbpc"), os.environ.get("FMBPC_IEC2C")
    failed, refused, named, more = False, 0, bool(loops), ["--real", "--to", "c99"] if form == "--real" else []
    for loop in loops or run([tool, "loops", "--names"]).stdout.split():
        with tempfile.TemporaryDirectory() as scratch:
            folder = os.path.join(scratch, "block")
            done = run([tool, "export", loop, "--samples", samples, "--out", folder, *more])
            if done.returncode != 0:
                refused += 1
                failed = failed or named
                if named or "in single" in done.stderr:
                    print(f"| {loop} | {done.stderr.strip()} |", flush=True)
                continue
            try:
                says = [native(folder, "law", "gcc", "-O2", scratch)]
                if os.path.exists(os.path.join(folder, "law.st")):
                    says.append(interpreted(folder, "law"))
                    if compiler:
                        says.append(compiled(folder, "law", compiler, scratch))
            except (RuntimeError, OSError) as wrong:
                print(f"| {loop} | {wrong} |", flush=True)
                failed = True
                continue
        flags, same = max(s["flags"] for s in says), all(s["hash"] == says[0]["hash"] for s in says)
        good = says[0]["passed"] and flags == 0 and same
        failed = failed or not good
        print(f"| {loop} | {says[0]['samples']} | {says[0]['difference']:.2g} | {flags} | {'same' if same else 'OTHER'} bits of {len(says)} |"
              + ("" if good else " FAILED |"), flush=True)
    print(f"{refused} loops are not exported")
    return 1 if failed else 0


if __name__ == "__main__":
    if {"-h", "--help"} & set(sys.argv[1:]):
        sys.exit(print(__doc__))
    if len(sys.argv) > 2 and sys.argv[1] in ("--loops", "--real") and sys.argv[2].isdigit():
        sys.exit(survey(sys.argv[1], sys.argv[2], sys.argv[3:]))
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(Check(sys.argv[1]).run())
