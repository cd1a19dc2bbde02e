#!/usr/bin/python3
"""fmbpc watch: shows a running loop from its topics. In the terminal: its state with the reason, every signal with its
setpoint and its course. --window: one plot per unit in a window of matplotlib that moves by itself.

  --window         a window instead of the terminal
  --picture FILE   draw into a file again and again (for a machine without a screen)
  --seconds N      end after so many seconds of wall time (default: with the run, or at Ctrl-C)
  --rate HZ        pictures a second (default 5)

It ends with the run: exit code 0 if that was recorded; a window stays until it is closed.

Example: fmbpc watch --window
"""
import argparse
import os
import sys
import threading
import time

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

import rosgraph  # noqa: E402
import rospy  # noqa: E402
from live_view import LiveView, master_answers  # noqa: E402

BARS = " ▁▂▃▄▅▆▇█"
WIDTH = 50      # letters of a course
POINT = 0.05    # s of wall time between two points of a curve
COLOURS = {"automatic": "32", "finished": "32", "manual": "36", "failed": "31", "fallback": "31", "stalled": "31", "ended": "31"}


def course(points):
    """The last points as a row of bars."""
    numbers = [value for _, value in points][-WIDTH:]
    if not numbers:
        return ""
    low, high = min(numbers), max(numbers)
    span = (high - low) or 1.0
    return "".join(BARS[1 + int(7.0 * (number - low) / span)] for number in numbers)


def row(view, signal):
    value, name = view.values.get(signal.name), signal.name
    if value is None:
        return f"{name:>12}"
    setpoint = view.values.get(name + "_setpoint")
    to = f"-> {setpoint:<10.5g}" if setpoint is not None else " " * 13
    return f"{name:>12} {value:>12.6g} {to} {signal.unit:<8} {course(view.history[name])}"


def events_of(view):
    """What was said last, the newest first."""
    said = sorted((event for state in view.states.values() for event in state.events), key=lambda event: -event.last)
    return [f"{e.code}: {e.text} (samples {e.first} to {e.last}: {e.count})" for e in said[:5]]


def frame(view, colour, outcome=None):
    """The lines of one picture; the last one says how it ended."""
    state = view.summary
    word, reason = (state.word, state.reason) if state else ("waiting", "no loop has spoken yet")
    if outcome:
        word, _, reason = outcome[1].partition(": ")
    if colour:
        word = f"\033[1;{COLOURS.get(word, '33')}m{word}\033[0m"
    if view.info is None or view.step is None:
        return [f"{word}: {reason}"]
    lines = [f"{view.info.name}   sample {view.step}   {view.axis.at(view.seconds):.4g} {view.axis.unit}   {word}: {reason}", ""]
    lines += [row(view, signal) for signal in list(view.info.outputs) + list(view.info.inputs)]
    others = [] if outcome else [s for node, s in sorted(view.states.items()) if not s.summary and s.word not in ("automatic", "finished")]
    return lines + ["", *[f"{s.node} {s.word}: {s.reason}" for s in others], *events_of(view)]


def terminal(view, arguments):
    """Repaints in place on a terminal; otherwise a line a second."""
    live, pause = sys.stdout.isatty(), threading.Event()
    end, period = time.monotonic() + arguments.seconds, 1.0 / arguments.rate if live else 1.0
    while not rospy.is_shutdown() and time.monotonic() < end:
        outcome = view.outcome()
        view.sample()
        lines = frame(view, live, outcome)
        if live:
            sys.stdout.write("\033[2J\033[H" + "\n".join(lines) + "\n")
        else:
            print("; ".join(line.strip() for line in lines if line))
        sys.stdout.flush()
        if outcome:
            return outcome
        pause.wait(period)
    return None


class Window:
    """One plot per unit, the time axis below."""

    def __init__(self, view):
        import matplotlib.pyplot
        self.view, self.pyplot = view, matplotlib.pyplot
        self.figure = self.run = None

    def begin(self):
        panels = self.view.panels()
        if self.figure is not None:
            self.pyplot.close(self.figure)
        self.figure, axes = self.pyplot.subplots(len(panels), 1, sharex=True, squeeze=False, figsize=(9, 1 + 2 * len(panels)))
        self.figure.subplots_adjust(left=0.1, right=0.82)
        self.run, self.curves = self.view.run_id, []
        for panel, axis in zip(panels, axes[:, 0]):
            for name in panel.names:
                style = {"ls": "--"} if name.endswith("_setpoint") else {"ls": ":"} if name.endswith("_reference") else {}
                self.curves.append((axis, name, axis.plot([], [], label=name, **style)[0]))
            axis.set_ylabel(panel.unit)
            axis.grid(alpha=0.3)
            axis.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0, fontsize="small", frameon=False)
        axes[-1, 0].set_xlabel(f"time of the run [{self.view.axis.unit}]")
        self.axes = axes[:, 0]

    def draw(self, outcome=None):
        if self.run != self.view.run_id:
            self.begin()
        with self.view.lock:
            for _, name, line in self.curves:
                line.set_data(*zip(*self.view.history[name]) if self.view.history[name] else ([], []))
            now, length = self.view.axis.at(self.view.seconds), self.view.axis.length
            state = self.view.summary
        left = max(0.0, now - length) if self.view.axis.endless else 0.0
        for axis in self.axes:
            axis.relim()
            axis.autoscale_view(scalex=False)
            axis.set_xlim(left, left + length)
        if outcome or state:
            self.axes[0].set_title(outcome[1].partition(": recorded in")[0] if outcome else f"{state.word}: {state.reason}", fontsize="medium")


def collect(view, seconds, pause):
    """Between two pictures, so that what is drawn does not depend on how often it is."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        pause(POINT)
        view.sample()


def window(view, arguments):
    import matplotlib
    if arguments.picture:
        matplotlib.use("Agg")
    shown, pause = Window(view), threading.Event()
    end = time.monotonic() + arguments.seconds
    while not rospy.is_shutdown() and time.monotonic() < end:
        outcome = view.outcome()
        if view.sample() is None:
            if outcome:
                return outcome
            pause.wait(0.1)
            continue
        shown.draw(outcome)
        if arguments.picture:
            shown.figure.savefig(arguments.picture + ".part", dpi=80, format="png")
            os.replace(arguments.picture + ".part", arguments.picture)
            if outcome:
                return outcome
            collect(view, 1.0 / arguments.rate, pause.wait)
        elif outcome:
            shown.pyplot.show()  # until it is closed
            return outcome
        else:
            collect(view, 1.0 / arguments.rate, shown.pyplot.pause)
            if not shown.pyplot.fignum_exists(shown.figure.number):
                break
    return None


class OneLineParser(argparse.ArgumentParser):
    """Says what is wrong as the other commands do."""

    def error(self, message):
        sys.exit(f"fmbpc: watch: {message}")


def main():
    parser = OneLineParser(prog="fmbpc watch", description=__doc__)
    parser.add_argument("--window", action="store_true")
    parser.add_argument("--picture", default="")
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--rate", type=float, default=5.0)
    arguments = parser.parse_args(rospy.myargv()[1:])
    if not arguments.rate > 0.0:
        parser.error("--rate: expected a number > 0")
    if not master_answers():
        sys.exit(f"fmbpc: no master at {rosgraph.get_master_uri()}: start a loop first (roslaunch fmbpc loop.launch loop:=NAME)")
    rospy.init_node("watch", anonymous=True, disable_signals=True)
    view, outcome = LiveView(), None
    try:
        outcome = (window if arguments.window or arguments.picture else terminal)(view, arguments)
    except KeyboardInterrupt:
        pass
    rospy.signal_shutdown("watched")
    sys.stdout.flush()
    os._exit(0 if outcome is None or outcome[0] else 1)  # without the goodbyes to a master that is gone


if __name__ == "__main__":
    sys.exit(main())
