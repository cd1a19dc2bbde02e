#!/usr/bin/python3
"""Runs the subset of Structured Text that `fmbpc export` writes, as Python code made from it.

    structured_text.py NAME.st NAME_test.st     runs the block FB_NAME_TEST until it is done; exit code 0: passed

Names without regard to case, integers of 32 bits, LREAL as IEEE double, REAL as IEEE single; LREAL_TO_DINT rounds to the nearest even
number. What is not in the subset is an error that names it."""
import re
import sys

TOKEN = re.compile(r"\s+|\(\*.*?\*\)|(?:REAL#)?(?P<number>\d+(?:\.\d+)?(?:E-?\d+)?)|(?P<word>[A-Za-z_]\w*)|(?P<sign>:=|<=|>=|<>|\.\.|[-+*/()\[\],;:.<>=])", re.S)
REALS = {"LREAL", "REAL"}
PYTHON = {"AND": "and", "OR": "or", "=": "==", "<>": "!=", "MOD": "%"}
RANK = [["OR"], ["AND"], ["=", "<>", "<", "<=", ">", ">="], ["+", "-"], ["*", "/", "MOD"]]


def single(value):
    """The nearest number of single precision; operations on them round to it."""
    import numpy
    return numpy.float32(value)


RESERVED = set("""ABS ACOS ADD AND ANY ARRAY ASIN AT ATAN BOOL BY BYTE CASE CONCAT CONSTANT COS CTD CTU DATE DELETE DINT DIV DO DT ELSE ELSIF EN ENO
EQ EXIT EXP EXPT FALSE FIND FOR FROM FUNCTION GE GT IF INSERT INT INTERVAL LE LEFT LEN LIMIT LINT LN LOG LREAL LT MAX MID MIN MOD MOVE MUL MUX NE NOT
OF ON OR PRIORITY PROGRAM READ_ONLY READ_WRITE REAL REPEAT REPLACE RETAIN RETURN RIGHT ROL ROR RS SEL SHL SHR SIN SINGLE SINT SQRT SR STEP STRING
STRUCT SUB TAN TASK THEN TIME TO TOD TOF TON TP TRUE TRUNC TYPE UDINT UINT ULINT UNTIL USINT VAR WHILE WITH WORD WSTRING XOR
CTUD DERIVATIVE F_TRIG HYSTERESIS INTEGRAL PID RAMP RTC R_TRIG SEMA""".split())


class Subset(Exception):
    """The text is not in the subset."""


def tokens(text):
    found, at = [], 0
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise Subset(f"line {text.count(chr(10), 0, at) + 1}: {text[at:at + 20]!r}")
        if match.lastgroup:
            word = match[match.lastgroup]
            found.append((match.lastgroup, word.upper() if match.lastgroup == "word" else word, at))
        at = match.end()
    return found + [("end", "", at)]


class Unit:
    """A function or a function block: its variables, and its body as Python."""

    def __init__(self, kind, name, result):
        self.kind, self.name, self.result = kind, name, result
        self.inputs, self.types, self.sizes, self.initial = [], {}, {}, {}
        self.lines = []


class Reader:
    def __init__(self, text, single=None):
        self.text, self.tokens, self.at, self.units, self.unit = text, tokens(text), 0, {}, None
        self.single = bool(re.search(r"\bREAL\b", text)) if single is None else single

    def fail(self, wanted):
        kind, word, at = self.tokens[self.at]
        raise Subset(f"line {self.text.count(chr(10), 0, at) + 1}: expected {wanted}, got {word or kind}")

    def next(self, *words):
        if words and self.tokens[self.at][1] not in words:
            self.fail(" or ".join(words))
        self.at += 1
        return self.tokens[self.at - 1][1]

    def sees(self, *words):
        return self.tokens[self.at][1] in words and self.tokens[self.at][0] != "number"

    def word(self):
        if self.tokens[self.at][0] != "word":
            self.fail("a name")
        return self.next()

    def read(self):
        while not self.tokens[self.at][0] == "end":
            kind = self.next("FUNCTION", "FUNCTION_BLOCK")
            name = self.word()
            result = None
            if kind == "FUNCTION":
                self.next(":")
                result = self.word()
            self.unit = self.units[name] = Unit(kind, name, result)
            while self.sees("VAR", "VAR_INPUT", "VAR_OUTPUT"):
                self.section()
            if result:
                self.unit.types[name] = result
            self.statements(1, "END_" + kind)
            self.next("END_" + kind)
        return self.units

    def section(self):
        section = self.next()
        if self.sees("CONSTANT"):
            self.next()
        while not self.sees("END_VAR"):
            name = self.word()
            if name in self.unit.types or name in RESERVED or name in self.units:
                self.fail(f"a name of its own instead of {name}")
            self.next(":")
            size = None
            if self.sees("ARRAY"):
                self.next()
                for word in ("[", "0", ".."):
                    self.next(word)
                size = int(self.next()) + 1
                self.next("]")
                self.next("OF")
            self.unit.types[name], self.unit.sizes[name] = self.word(), size
            values = None
            if self.sees(":="):
                self.next()
                values = self.initials(size)
            self.unit.initial[name] = values
            if section == "VAR_INPUT":
                self.unit.inputs.append(name)
            self.next(";")
        self.next("END_VAR")

    def initials(self, size):
        if size is None:
            return self.constant()
        self.next("[")
        values = [self.constant()]
        while self.sees(","):
            self.next()
            values.append(self.constant())
        self.next("]")
        if len(values) != size:
            self.fail(f"{size} initial values")
        return values

    def constant(self):
        sign = -1 if self.sees("-") and self.next() else 1
        if self.sees("TRUE", "FALSE"):
            return self.next() == "TRUE"
        word = self.next()
        return sign * (float(word) if "." in word else int(word))

    def statements(self, depth, *ends):
        while not self.sees(*ends):
            self.statement(depth)

    def line(self, depth, text):
        self.unit.lines.append("  " * depth + text)

    def body(self, depth, *ends):
        before = len(self.unit.lines)
        self.statements(depth, *ends)
        if len(self.unit.lines) == before:
            self.line(depth, "pass")

    def statement(self, depth):
        if self.sees("IF"):
            self.next()
            self.line(depth, f"if {self.expression('BOOL')}:")
            self.next("THEN")
            self.body(depth + 1, "ELSE", "END_IF")
            if self.sees("ELSE"):
                self.next()
                self.line(depth, "else:")
                self.body(depth + 1, "END_IF")
            self.next("END_IF")
        elif self.sees("FOR"):
            self.next()
            index = self.word()
            self.next(":=")
            self.next("0")
            self.next("TO")
            last = int(self.next())
            self.next("DO")
            if last < 1:
                self.fail("a loop of two passes or more")
            self.line(depth, f"for {self.name(index)} in range({last + 1}):")
            self.body(depth + 1, "END_FOR")
            self.next("END_FOR")
        elif self.unit.types.get(self.tokens[self.at][1]) in self.units:
            self.block_call(depth)
        else:
            target, kind = self.place()
            self.next(":=")
            self.line(depth, f"{target} = {self.expression(kind)}")
        self.next(";")

    def block_call(self, depth):
        instance = self.word()
        block = self.units[self.unit.types[instance]]
        self.next("(")
        while True:
            name = self.word()
            self.next(":=")
            self.line(depth, f"{self.name(instance)}.{self.name(name)} = {self.expression(block.types[name])}")
            if self.next(",", ")") == ")":
                break
        self.line(depth, f"{self.name(instance)}()")

    @staticmethod
    def name(word):
        return "v_" + word.lower()

    def place(self):
        word = self.word()
        if word not in self.unit.types:
            self.fail(f"a variable instead of {word}")
        kind = self.unit.types[word]
        if self.sees("."):
            self.next()
            member = self.word()
            return f"{self.name(word)}.{self.name(member)}", self.units[kind].types[member]
        if self.unit.sizes.get(word) is None:
            return self.name(word), kind
        self.next("[")
        index = self.expression("DINT")
        self.next("]")
        return f"{self.name(word)}[{index}]", kind

    def expression(self, wanted):
        text, kind = self.level(0)
        if kind != wanted:
            self.fail(f"{wanted} instead of {kind}")
        return text

    def level(self, rank):
        if rank == len(RANK):
            return self.unary()
        text, kind = self.level(rank + 1)
        while self.sees(*RANK[rank]):
            sign = self.next()
            other, its = self.level(rank + 1)
            if its != kind:
                self.fail(f"{kind} beside {sign}, not {its}")
            word = "//" if sign == "/" and kind == "DINT" else PYTHON.get(sign, sign)
            text = f"({text} {word} {other})"
            if rank <= 2:
                kind = "BOOL"
        return text, kind

    def unary(self):
        if self.sees("-"):
            self.next()
            text, kind = self.unary()
            return f"(-{text})", kind
        if self.sees("("):
            self.next()
            text, kind = self.level(0)
            self.next(")")
            return text, kind
        if self.tokens[self.at][0] == "number":
            word = self.next()
            if "." not in word:
                return word, "DINT"
            if not 1e-38 < abs(float(word)) < 1e38 and float(word) != 0.0:
                self.fail("a literal that every compiler takes")
            return (f"real({word})", "REAL") if self.single else (word, "LREAL")
        if self.sees("TRUE", "FALSE"):
            return self.next().capitalize(), "BOOL"
        word = self.tokens[self.at][1]
        if self.tokens[self.at + 1][1] == "(":
            return self.call(word)
        return self.place()

    def call(self, word):
        self.next()
        self.next("(")
        converted = re.fullmatch(r"(LREAL|REAL|DINT)_TO_(LREAL|REAL|DINT)", word)
        if converted:
            text, result = self.expression(converted[1]), converted[2]
            text = f"int(round({text}))" if result == "DINT" else f"real({text})"
        elif word in self.units:
            unit = self.units[word]
            text, result = f"f_{word.lower()}({self.expression(unit.types[unit.inputs[0]])})", unit.result
        else:
            self.fail(f"a function instead of {word}")
        self.next(")")
        return text, result


def literal(value, kind):
    if isinstance(value, list):
        return "[" + ", ".join(literal(one, kind) for one in value) + "]"
    return f"real({value!r})" if kind in REALS else repr(value)


def python_of(units):
    lines = []
    for unit in units.values():
        values = {}
        for name, kind in unit.types.items():
            zero = {"BOOL": False, "DINT": 0}.get(kind, 0.0)
            size, initial = unit.sizes.get(name), unit.initial.get(name)
            if kind in units:
                values[name] = f"c_{kind.lower()}()"
            else:
                values[name] = literal(initial if initial is not None else zero if size is None else [zero] * size, kind)
        names = [Reader.name(n) for n in unit.types]
        if unit.kind == "FUNCTION":
            lines.append(f"def f_{unit.name.lower()}({Reader.name(unit.inputs[0])}):")
            lines += unit.lines + [f"  return {Reader.name(unit.name)}"]
            continue
        lines.append(f"class c_{unit.name.lower()}:")
        lines.append("  def __init__(self):")
        lines += [f"    self.{Reader.name(n)} = {v}" for n, v in values.items()] or ["    pass"]
        lines.append("  def __call__(self):")
        lines += [f"    {n} = self.{n}" for n in names]
        lines += ["  " + line for line in unit.lines]
        scalars = [n for n in unit.types if unit.sizes.get(n) is None and unit.types[n] not in units]
        lines += [f"    self.{Reader.name(n)} = {Reader.name(n)}" for n in scalars]
    return "\n".join(lines)


def load(*texts):
    """The function blocks of these texts, by name in small letters: classes whose instances have v_NAME and are called once a sample."""
    reader = Reader("\n".join(texts))
    units = reader.read()
    space = {"real": single if reader.single else float}
    exec(compile(python_of(units), "structured text", "exec"), space)  # pylint: disable=exec-used
    return {name[2:]: made for name, made in space.items() if name.startswith("c_")}


def main():
    blocks = load(*(open(path, encoding="utf-8").read() for path in sys.argv[1:]))
    test = next(block for name, block in blocks.items() if name.endswith("_test"))()
    samples = 0
    while not test.v_xdone:
        test()
        samples += 1
    print(f"{samples} vectors, " + ("passed" if test.v_xpassed else f"differs first at sample {test.v_ifailed}"))
    return 0 if test.v_xpassed else 1


if __name__ == "__main__":
    if {"-h", "--help"} & set(sys.argv[1:]):
        sys.exit(print(__doc__))
    sys.exit(main())
