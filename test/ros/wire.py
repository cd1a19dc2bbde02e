"""A wire between a Modbus/TCP client and its server that can be broken in many ways."""
import random
import socket
import struct
import threading
import time


def frame(stream):
    """One whole message: (transaction, unit, function and data)."""
    head = exactly(stream, 7)
    transaction, _, length, unit = struct.unpack(">HHHB", head)
    return transaction, unit, exactly(stream, length - 1)


def exactly(stream, count):
    data = b""
    while len(data) < count:
        more = stream.recv(count - len(data))
        if not more:
            raise OSError("closed")
        data += more
    return data


def packed(transaction, unit, data):
    return struct.pack(">HHHB", transaction, 0, len(data) + 1, unit) + data


def is_write(data):
    return data[0] in (5, 6, 15, 16)


def ask(port, data, unit=1):
    """The answer of the server itself to one question."""
    with socket.create_connection(("127.0.0.1", port), 5) as server:
        server.sendall(packed(1, unit, data))
        return frame(server)[2]


def write_register(port, address, value):
    return ask(port, struct.pack(">BHH", 6, address, value))


def write_coil(port, address, on):
    return ask(port, struct.pack(">BHH", 5, address, 0xFF00 if on else 0))


class Healthy:
    """What a wire does with a question and its answer: None is silence; OSError cuts."""
    accepts = True

    def question(self, data):
        """(what goes to the server or None, an answer made here or None)"""
        return data, None

    def answer(self, question, data, transaction, unit):
        return packed(transaction, unit, data)


class Wire:
    def __init__(self, target):
        self.target, self.fault, self.connections = target, Healthy(), []
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            client, _ = self.listener.accept()
            if not self.fault.accepts:
                client.close()
                continue
            self.connections.append(client)
            threading.Thread(target=self.carry, args=(client,), daemon=True).start()

    def carry(self, client):
        server = None
        try:
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            server = socket.create_connection(("127.0.0.1", self.target), 5)
            server.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            while True:
                transaction, unit, data = frame(client)
                fault = self.fault
                forward, made = fault.question(data)
                reply = made
                if forward is not None:
                    server.sendall(packed(transaction, unit, forward))
                    answered = frame(server)[2]
                    reply = answered if made is None else made
                sent = fault.answer(data, reply, transaction, unit) if reply is not None else None
                if sent:
                    client.sendall(sent)
        except (OSError, struct.error):
            pass
        finally:
            for stream in (client, server):
                if stream:
                    stream.close()

    def cut(self):
        while self.connections:
            client = self.connections.pop()
            try:
                client.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def breaks(self, fault):
        self.fault = fault
        if not fault.accepts:
            self.cut()

    def heals(self):
        self.fault = Healthy()


class Refused(Healthy):
    accepts = False


class Once(Healthy):
    """Calls `act` once, behind a question that begins with `head` and before its answer: the client sends nothing meanwhile."""

    def __init__(self, head, act):
        self.head, self.act = head, act

    def answer(self, question, data, transaction, unit):
        if self.act and question.startswith(self.head):
            act, self.act = self.act, None
            act()
        return packed(transaction, unit, data)


class Silent(Healthy):
    def question(self, data):
        return None, None


class Slow(Healthy):
    def __init__(self, seconds):
        self.seconds = seconds

    def question(self, data):
        time.sleep(self.seconds)
        return data, None


class Dropping(Healthy):
    """Cuts the connection at every n-th question."""

    def __init__(self, every):
        self.every, self.count = every, 0

    def question(self, data):
        self.count += 1
        if self.count % self.every == 0:
            raise OSError("cut")
        return data, None


class Exceptions(Healthy):
    def __init__(self, code, writes_only=False, reads_only=False):
        self.code, self.writes_only, self.reads_only = code, writes_only, reads_only

    def question(self, data):
        spared = (self.writes_only and not is_write(data)) or (self.reads_only and is_write(data))
        return (data, None) if spared else (None, bytes([data[0] | 0x80, self.code]))


class LostWrites(Healthy):
    """Questions that write vanish, answered or not; or they arrive and their answers vanish."""

    def __init__(self, arrive, answered):
        self.arrive, self.answered = arrive, answered

    def question(self, data):
        if not is_write(data) or self.arrive:
            return data, None
        return None, data[:5] if self.answered else None

    def answer(self, question, data, transaction, unit):
        if is_write(question) and not self.answered:
            return None
        return packed(transaction, unit, data)


class Garbage(Healthy):
    def __init__(self, seed, share=1.0):
        self.dice, self.share = random.Random(seed), share

    def answer(self, question, data, transaction, unit):
        if self.dice.random() > self.share:
            return packed(transaction, unit, data)
        return bytes(self.dice.randrange(256) for _ in range(self.dice.randrange(1, 40)))


class Mangled(Healthy):
    """`change(transaction, unit, data)` gives the three back, changed."""

    def __init__(self, change):
        self.change = change

    def answer(self, question, data, transaction, unit):
        return packed(*self.change(transaction, unit, data))


class Truncated(Healthy):
    def answer(self, question, data, transaction, unit):
        return packed(transaction, unit, data)[:-1]


class Doubled(Healthy):
    def answer(self, question, data, transaction, unit):
        return 2 * packed(transaction, unit, data)


class Registers(Healthy):
    """Changes the registers that are read with a function code from an address on."""

    def __init__(self, function, address, change):
        self.function, self.address, self.change = function, address, change

    def answer(self, question, data, transaction, unit):
        if data[0] == self.function and struct.unpack(">H", question[1:3])[0] == self.address:
            data = data[:2] + self.change(data[2:])
        return packed(transaction, unit, data)


class Stale(Healthy):
    """Answers every question that reads as it was answered first."""

    def __init__(self):
        self.known = {}

    def answer(self, question, data, transaction, unit):
        if not is_write(question):
            data = self.known.setdefault(question, data)
        return packed(transaction, unit, data)
