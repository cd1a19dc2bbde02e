"""Whether this machine gave time to anybody."""
import threading
import time


class Pulse(threading.Thread):
    """Beats ten times a second; where it could not, this machine stood still, and nothing can be said of the loop."""

    def __init__(self):
        super().__init__(daemon=True)
        self.gaps = []  # (from, to) of more than half a second
        self.start()

    def run(self):
        before = time.monotonic()
        while True:
            time.sleep(0.1)
            now = time.monotonic()
            if now - before > 0.6:
                self.gaps.append((before + 0.1, now))
            before = now

    def within(self, start, end):
        """Seconds of it in which this machine stood still."""
        return sum(max(0.0, min(end, b) - max(start, a)) for a, b in list(self.gaps))
