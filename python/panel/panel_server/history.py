"""What a loop did, sample by sample, in bounded memory: rows are found by the number of their sample, so late ones find their place."""
import csv
import math
import os
import subprocess

import numpy

from fmbpc.plots.table import name_and_unit

CHUNK = 4096  # rows
BLOCK = 1 << 18  # bytes of a table that are read at once: others run in between


class History:
    """Numbers of one run by sample and column, not a number where nothing came; and the wall time of each sample."""

    def __init__(self, columns, most_bytes=100e6):
        self.columns, self.index = list(columns), {name: i for i, name in enumerate(columns)}
        self.chunk_bytes = CHUNK * (4 * len(self.columns) + 8)
        self.chunks = {}       # number: (values, wall)
        self.first = self.last = None
        self.limit(most_bytes)

    def limit(self, most_bytes):
        """From the next new chunk on."""
        self.most = max(2, int(most_bytes / self.chunk_bytes))  # chunks

    def _empty(self):
        return (numpy.full((CHUNK, len(self.columns)), numpy.nan, dtype=numpy.float32), numpy.full(CHUNK, numpy.nan))

    def _rows(self, step):
        number = step // CHUNK
        chunk = self.chunks.get(number)
        if chunk is None:
            chunk = self._empty()
            self.chunks[number] = chunk
            while len(self.chunks) > self.most:
                oldest = min(self.chunks)
                del self.chunks[oldest]
                if number == oldest:
                    return None
                self.first = max(self.first if self.first is not None else 0, min(self.chunks) * CHUNK)
        return chunk

    def put(self, step, values, wall=None):
        """values: {column: number}; what is not named stays."""
        if step < 0 or (self.last is not None and step < self.last - self.most * CHUNK):
            return
        chunk = self._rows(step)
        if chunk is None:
            return
        row = chunk[0][step % CHUNK]
        for name, value in values.items():
            column = self.index.get(name)
            if column is not None:
                row[column] = value
        if wall is not None and math.isnan(chunk[1][step % CHUNK]):
            chunk[1][step % CHUNK] = wall
        self.first = step if self.first is None else min(self.first, step)
        self.last = step if self.last is None else max(self.last, step)

    def fill(self, steps, names, table):
        """Puts in what is not there yet: table has a row for each of steps, a column for each of names."""
        columns = [self.index[n] for n in names]
        numbers = steps // CHUNK
        for number in numpy.unique(numbers).tolist():
            if self.last is not None and number <= self.last // CHUNK - self.most:
                continue
            chunk = self._rows(number * CHUNK)
            mine = numbers == number
            if chunk is None or not mine.any():
                continue
            at = numpy.ix_(steps[mine] % CHUNK, columns)
            chunk[0][at] = numpy.where(numpy.isnan(chunk[0][at]), table[mine], chunk[0][at])
            first, last = int(steps[mine].min()), int(steps[mine].max())
            self.first = first if self.first is None else min(self.first, first)
            self.last = last if self.last is None else max(self.last, last)

    def get(self, step):
        """(values, wall) of a sample, or None."""
        chunk = self.chunks.get(step // CHUNK)
        return None if chunk is None else (chunk[0][step % CHUNK], chunk[1][step % CHUNK])

    def value(self, step, name):
        row = self.get(step) if step >= 0 else None
        return math.nan if row is None or name not in self.index else float(row[0][self.index[name]])

    def rows(self, first, last):
        """(steps, values, wall) of first..last, both included."""
        nothing = numpy.zeros(0, int), numpy.zeros((0, len(self.columns)), numpy.float32), numpy.zeros(0)
        if self.first is None:
            return nothing
        first, last = max(first, self.first), min(last, self.last)
        values, wall = [], []
        for number in range(first // CHUNK, last // CHUNK + 1):
            begin, end = max(first - number * CHUNK, 0), min(last - number * CHUNK, CHUNK - 1) + 1
            if end <= begin:
                continue
            chunk = self.chunks.get(number) or self._empty()
            values.append(chunk[0][begin:end])
            wall.append(chunk[1][begin:end])
        if not values:
            return nothing
        return numpy.arange(first, last + 1), numpy.concatenate(values), numpy.concatenate(wall)

    def gaps(self, name):
        """[(first, last)] of samples without a value in a column, inside what is kept."""
        if self.first is None:
            return []
        column, nothing = self.index[name], numpy.full(CHUNK, True)
        missing = numpy.concatenate([numpy.isnan(self.chunks[n][0][:, column]) if n in self.chunks else nothing
                                     for n in range(self.first // CHUNK, self.last // CHUNK + 1)])
        begin = self.first // CHUNK * CHUNK
        missing = missing[self.first - begin:self.last - begin + 1]
        edges = numpy.flatnonzero(numpy.diff(numpy.concatenate(([False], missing, [False])).astype(numpy.int8)))
        return [(int(self.first + a), int(self.first + b - 1)) for a, b in zip(edges[::2], edges[1::2])]

    def bytes(self):
        return len(self.chunks) * self.chunk_bytes

    def drawn(self, first, last, points):
        """(steps, values, wall), at most about `points` rows: of each bucket the least and the most of every column, so that no peak is lost."""
        if self.first is None or min(last, self.last) - max(first, self.first) < max(points, 4):
            return self.rows(first, last)
        first, last = max(first, self.first), min(last, self.last)
        bucket = -(-2 * (last - first + 1) // points)
        block = max(1, 4 * CHUNK // bucket) * bucket  # so that no copy of all is made
        parts = [thinned(*self.rows(begin, min(begin + block, last + 1) - 1), bucket) for begin in range(first, last + 1, block)]
        parts.append(self.rows(last, last))  # the newest sample as it is
        return tuple(numpy.concatenate(column) for column in zip(*parts))


def thinned(steps, values, wall, bucket):
    whole = -(-len(steps) // bucket) * bucket
    padded = numpy.full((whole, values.shape[1]), numpy.nan, dtype=numpy.float32)
    padded[:len(steps)] = values
    shaped = padded.reshape(-1, bucket, values.shape[1])
    empty = numpy.isnan(shaped).all(axis=1)
    low = numpy.where(numpy.isnan(shaped), numpy.inf, shaped).min(axis=1)
    high = numpy.where(numpy.isnan(shaped), -numpy.inf, shaped).max(axis=1)
    low[empty] = high[empty] = numpy.nan
    falls = padded[::bucket] > numpy.nan_to_num(padded[numpy.minimum(numpy.arange(bucket - 1, whole, bucket), len(steps) - 1)], nan=-numpy.inf)
    both = numpy.empty((2 * len(low), values.shape[1]), dtype=numpy.float32)
    both[::2], both[1::2] = numpy.where(falls, high, low), numpy.where(falls, low, high)
    starts = numpy.arange(0, whole, bucket)
    at = numpy.empty(2 * len(low), int)
    at[::2], at[1::2] = starts, numpy.minimum(starts + max(bucket // 2, 1), len(steps) - 1)
    return steps[at], both, wall[at]


class Journal:
    """The samples of a run from the journal that its recorder goes on writing: `fmbpc recover --rows`, which reads it, answers."""

    def __init__(self, tool, folder):
        """Raises ValueError or OSError if there is none."""
        self.last = -1
        self.process = subprocess.Popen([tool, "recover", "--rows", os.path.expanduser(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        run, _, names = self.process.stdout.readline().decode().strip().partition(" ")
        if not names:
            self.close()
            raise ValueError(f"{folder}: expected a journal of a run")
        self.run_id, self.names = int(run), names.split(",")

    def rows(self, first):
        """The rows from a sample on, as trajectory.csv has them; not all at once, where there are very many."""
        self.process.stdin.write(b"%d\n" % first)
        self.process.stdin.flush()
        begin, count = (int(word) for word in self.process.stdout.readline().split())
        table = numpy.frombuffer(self.process.stdout.read(8 * count * len(self.names)), dtype=float).reshape(count, len(self.names))
        if count:
            self.last = begin + count - 1
        return table

    def close(self):
        self.process.kill()
        self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def plain(array, digits=7):
    """A list for JSON: None for what is no number, as many digits as a float32 has."""
    return [None if not math.isfinite(v) else float(f"%.{digits}g" % v) for v in numpy.asarray(array, dtype=float).ravel()]


def read_csv(path):
    """(names, units by name, table) of a trajectory.csv; a last line that is being written is left out. ValueError for a cell that is no number."""
    with open(path, "rb") as stream:
        head = [name_and_unit(cell) for cell in next(csv.reader([stream.readline().decode()]), [])]
        names = [name for name, _ in head]
        blocks = [numpy.zeros((0, len(names)))]
        while True:
            lines = stream.readlines(BLOCK)
            if lines and not lines[-1].endswith(b"\n"):
                lines.pop()
            if not lines:
                return names, dict(head), numpy.concatenate(blocks)
            text = b"\n" + b"".join(lines).replace(b"\r\n", b"\n")
            for _ in range(2):  # an empty cell after an empty cell
                text = text.replace(b",,", b",nan,").replace(b",\n", b",nan\n").replace(b"\n,", b"\nnan,")
            numbers = numpy.fromstring(text[1:].replace(b"\n", b",") + b"0", sep=",")  # ends at what is no number: before that 0
            if numbers.size != len(lines) * len(names) + 1 or any(line.count(b",") != len(names) - 1 for line in lines):
                raise ValueError(f"{path}: expected {len(names)} numbers in each row")
            blocks.append(numbers[:-1].reshape(len(lines), len(names)))
