"""The only thing that prints: a bar on standard error where somebody looks."""
import contextlib
import sys

from fmbpc import _core


def _in_notebook():
    shell = sys.modules.get("IPython")
    return shell is not None and getattr(shell.get_ipython(), "kernel", None) is not None


class Bar:
    """Called with a share 0..1 and words, ten times a second at most; gone at its end."""

    def __init__(self, name):
        self.name = name
        self.shown = False
        self.width = 0

    def __call__(self, share, words=""):
        line = "%s [%-25s] %3d %% %s" % (self.name, "#" * int(25 * share), int(100 * share), words)
        sys.stderr.write("\r" + line.ljust(self.width))
        sys.stderr.flush()
        self.shown, self.width = True, len(line)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.shown:
            sys.stderr.write("\r" + " " * self.width + "\r")
            sys.stderr.flush()


def bar(name, asked):
    """`asked`: True, False, a callable (share, words), or None: where a person looks."""
    if not (asked is None or isinstance(asked, bool) or callable(asked)):
        raise _core.InputError(f"progress: expected True, False, a callable (share, words) or None, got {asked!r}")
    if callable(asked):
        return contextlib.nullcontext(asked)
    look = (sys.stderr is not None and sys.stderr.isatty()) or _in_notebook() if asked is None else asked
    return Bar(name) if look else contextlib.nullcontext()
