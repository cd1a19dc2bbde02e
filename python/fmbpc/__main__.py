"""The tool `fmbpc` of a wheel: python3 -m fmbpc, and the command `fmbpc`."""
import os
import sys


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    for tool in (os.path.join(here, "lib", "fmbpc", "fmbpc_tool"), os.path.join(here, *[".."] * 4, "lib", "fmbpc", "fmbpc_tool"),
                 os.path.join(here, *[".."] * 3, "fmbpc", "fmbpc_tool")):
        if os.access(tool, os.X_OK):
            os.execv(tool, ["fmbpc", *sys.argv[1:]])
    print("fmbpc: the tool fmbpc_tool is not installed beside the Python package", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
