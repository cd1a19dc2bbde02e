"""python3 -m fmbpc.plots KIND DIR [DIR ...] [--out FILE]"""
import importlib
import sys

from fmbpc.plots import KINDS


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in KINDS:
        print(f"fmbpc.plots: expected one of {', '.join(KINDS)}, then folders", file=sys.stderr)
        return 2
    kind = sys.argv.pop(1)
    sys.argv[0] = f"fmbpc.plots {kind}"
    try:
        import matplotlib
        matplotlib.use("Agg")
        importlib.import_module(f"fmbpc.plots.{kind}").main()
    except ImportError as error:
        print(f"fmbpc.plots {kind}: no picture, a python module is missing: {error}", file=sys.stderr)
        return 3
    except (OSError, ValueError, KeyError, IndexError, TypeError) as error:
        print(f"fmbpc.plots {kind}: cannot read what is to be drawn: {error!r}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
