"""A block that `fmbpc export` wrote in C99, built by this machine's compiler and called from Python."""
import ctypes
import glob
import os
import re
import subprocess
import tempfile

TYPES = {"double": ctypes.c_double, "float": ctypes.c_float, "int32_t": ctypes.c_int32, "bool": ctypes.c_bool}
MEMBER = re.compile(r"^  (double|float|int32_t|bool) (\w+)(?:\[(\d+)\])?;", re.M)


class ExportedLaw:
    """`given` and `answer` are the block's structs; step() computes a sample."""

    def __init__(self, folder):
        headers = glob.glob(os.path.join(folder, "*.h"))
        if len(headers) != 1:
            raise ValueError(f"{folder}: expected the folder of an export with one NAME.h, found {len(headers)}")
        self.name = os.path.basename(headers[0])[:-2]
        with open(headers[0], encoding="utf-8") as file:
            text = file.read()
        self.given, self.answer, self.state = (self.struct(text, part)() for part in ("in", "out", "state"))
        with tempfile.TemporaryDirectory() as into:
            library = os.path.join(into, "law.so")
            subprocess.run(["gcc", "-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC", f"{self.name}.c", "-o", library],
                           cwd=folder, check=True)
            self.library = ctypes.CDLL(library)
        getattr(self.library, f"{self.name}_defaults")(ctypes.byref(self.given))

    def struct(self, text, part):
        end = text.index(f"}} {self.name}_{part}_t;")
        body = text[text.rindex("typedef struct {", 0, end):end]
        fields = [(name, TYPES[kind] * int(size) if size else TYPES[kind]) for kind, name, size in MEMBER.findall(body)]
        return type(part, (ctypes.Structure,), {"_fields_": fields})

    def step(self):
        getattr(self.library, f"{self.name}_step")(ctypes.byref(self.state), ctypes.byref(self.given), ctypes.byref(self.answer))
