"""Contacts of a stranger with the ports of a node: bytes that ended one, and bytes made at random."""
import random
import socket
import struct
import threading
import time
import xmlrpc.client

SILENT = 0.3  # s for an answer


def address(uri):
    host, port = uri.split("//")[1].rstrip("/").rsplit(":", 1)
    return host, int(port)


def ports(uri):
    """(host, port) of the node at this URI, by protocol."""
    _, _, (_, host, port) = xmlrpc.client.ServerProxy(uri).requestTopic("/x", "/rosout", [["TCPROS"]])
    return {"xmlrpc": address(uri), "tcpros": (host, port)}


def send(to, data, answer=False):
    """What somebody sends who then hangs up, at once or when no more answers come; a topic's messages may come without end."""
    end = time.monotonic() + 3.0 * SILENT
    try:
        with socket.create_connection(to, SILENT) as connection:
            connection.sendall(data)
            connection.settimeout(SILENT)
            while answer and time.monotonic() < end and connection.recv(4096):
                pass
    except OSError:
        pass


def header(fields):
    body = b"".join(struct.pack("<I", len(f)) + f for f in fields)
    return struct.pack("<I", len(body)) + body


def post(body, length=None):
    length = len(body) if length is None else length
    return b"POST / HTTP/1.1\r\nContent-Type: text/xml\r\nContent-length: %d\r\n\r\n" % length + body


def call(method, *params):
    return post(xmlrpc.client.dumps(params, method).encode())


def nested(depth, method="getPid", kind=b"array"):
    if kind == b"array":
        opening, closing = b"<value><array><data>", b"</data></array></value>"
    else:
        opening, closing = b"<value><struct><member><name>a</name>", b"</member></struct></value>"
    body = b"<?xml version='1.0'?><methodCall><methodName>" + method.encode() + b"</methodName><params><param>"
    return post(body + opening * depth + closing * depth + b"</param></params></methodCall>")


def subscriber(node, topic, md5=b"*"):
    return [b"callerid=" + node.encode(), b"topic=" + topic.encode(), b"md5sum=" + md5, b"type=*", b"tcp_nodelay=1"]


def datagrams(topic, size):
    head = header([b"callerid=/x", b"topic=" + topic.encode(), b"md5sum=*", b"type=*"])[4:]
    return call("requestTopic", "/x", topic, [["UDPROS", xmlrpc.client.Binary(head), "127.0.0.1", 9, size]])


def service(name, md5, payload, length=None):
    head = header([b"callerid=/x", b"service=" + name.encode(), b"md5sum=" + md5])
    return head + struct.pack("<I", len(payload) if length is None else length) + payload


def killers(node):
    """(words, port, bytes): each ended a node at first contact before it was mended."""
    space = node.rsplit("/", 1)[0]
    yield "element longer than its TCPROS header", "tcpros", struct.pack("<II", 8, 900000) + b"abcd"
    yield "header of three bytes", "tcpros", struct.pack("<I", 3) + b"abc"
    yield "paramUpdate of a name that is none", "xmlrpc", call("paramUpdate", "/x", "no name!~//", 1)
    yield "arrays in arrays", "xmlrpc", nested(60000)
    yield "structures in structures", "xmlrpc", nested(40000, kind=b"struct")
    yield "multicall of itself", "xmlrpc", call("system.multicall", [{"methodName": "system.multicall", "params": []}])
    for topic in (space + "/loop_state", space + "/measurement", "/rosout"):
        yield f"datagrams of 8 bytes of {topic}", "xmlrpc", datagrams(topic, 8)
    yield "header of a gigabyte", "tcpros", struct.pack("<I", 999999999) + b"x" * 64
    yield "half a billion inputs", "tcpros", service(node + "/manual_input", b"*", struct.pack("<I", 0x1fffffff))


METHODS = ("getBusStats", "getBusInfo", "getMasterUri", "shutdownX", "getPid", "getSubscriptions", "getPublications", "paramUpdate",
           "publisherUpdate", "requestTopic", "system.multicall", "system.listMethods", "")
TOPICS = ("/rosout", "/measurement", "/loop_state", "/setpoint", "/control_action", "/plant_info", "/clock", "", "no name!", "/a//b")


def value(chance, depth=0):
    kind = chance.randrange(9 if depth < 4 else 7)
    if kind == 0:
        return chance.choice((0, 1, -1, 2 ** 31 - 1, -2 ** 31))
    if kind == 1:
        return chance.choice((0.0, -1e308, 1e-300, 5.5))
    if kind == 2:
        return chance.choice(TOPICS)
    if kind == 3:
        return "".join(chr(chance.randrange(32, 127)) for _ in range(chance.randrange(300)))
    if kind == 4:
        return bool(chance.randrange(2))
    if kind == 5:
        return xmlrpc.client.Binary(chance.randbytes(chance.randrange(100)))
    if kind == 6:
        return xmlrpc.client.DateTime("19980717T14:08:55")
    if kind == 7:
        return [value(chance, depth + 1) for _ in range(chance.randrange(6))]
    return {chance.choice(("a", "methodName", "params", "")): value(chance, depth + 1) for _ in range(chance.randrange(4))}


def mutated(chance, data):
    data = bytearray(data)
    for _ in range(chance.choice((0, 0, 1, 2, 8, 40))):
        if not data:
            break
        at = chance.randrange(len(data))
        what = chance.randrange(4)
        if what == 0:
            data[at] = chance.randrange(256)
        elif what == 1:
            del data[at:at + chance.randrange(1, 30)]
        elif what == 2:
            data[at:at] = chance.randbytes(chance.randrange(1, 9))
        else:
            data[at:at + 4] = struct.pack("<I", chance.choice((0, 1, 3, 4, 2 ** 31, 2 ** 32 - 1, 1000000, 999999999, chance.randrange(2 ** 32))))
    return bytes(data)


def random_contact(chance, node, liar):
    """(port, bytes) of a stranger."""
    kind = chance.randrange(12)
    if kind < 3:
        fields = subscriber("/x", chance.choice(TOPICS))
        if chance.randrange(3) == 0:
            fields = [b"callerid=/x", b"service=" + node.encode() + chance.choice((b"/manual_input", b"/set_parameters", b"/get_loggers", b"/x")),
                      b"md5sum=*", chance.choice((b"probe=1", b"persistent=1", b"a=b"))]
        chance.shuffle(fields)
        data = header(fields[:chance.randrange(1, 6)] + [chance.randbytes(chance.randrange(40))] * chance.randrange(2))
        return "tcpros", mutated(chance, data + chance.randbytes(chance.randrange(60)))
    if kind == 3:
        return "tcpros", chance.randbytes(chance.choice((1, 4, 5, 12, 64, 3000)))
    if kind == 4:
        return "tcpros", service(node + "/manual_input", b"*", mutated(chance, struct.pack("<Id", 1, 5.0)))
    if kind == 5:
        return "xmlrpc", mutated(chance, nested(chance.choice((1, 5, 40, 3000)), chance.choice(METHODS), chance.choice((b"array", b"struct"))))
    if kind == 6:
        return "xmlrpc", mutated(chance, datagrams(chance.choice(TOPICS), chance.choice((0, 8, 9, -1, 1500))))
    if kind == 7:
        return "xmlrpc", call("publisherUpdate", "/x", chance.choice(TOPICS), [liar] * chance.randrange(3))
    if kind == 8:
        return "xmlrpc", post(chance.randbytes(chance.randrange(200)), chance.choice((0, 1, -1, 2 ** 31 - 1, 2 ** 40)))
    if kind == 9:
        return "xmlrpc", b"POST / HTTP/1.1\r\n" + b"X: y\r\n" * chance.choice((1, 100, 40000))
    data = call(chance.choice(METHODS), *[value(chance) for _ in range(chance.randrange(5))])
    return "xmlrpc", mutated(chance, data) if kind == 10 else data


class Liar(threading.Thread):
    """A publisher that answers rubbish: to XMLRPC, and as a TCPROS server."""

    def __init__(self, seed):
        super().__init__(daemon=True)
        self.chance, self.server = random.Random(seed), socket.create_server(("127.0.0.1", 0))
        self.uri = "http://127.0.0.1:%d/" % self.server.getsockname()[1]

    def run(self):
        while True:
            connection = self.server.accept()[0]
            with connection:
                try:
                    connection.settimeout(0.3)
                    first = connection.recv(4096)
                    connection.sendall(self.answer(first))
                except OSError:
                    pass

    def answer(self, request):
        if not request.startswith(b"POST"):
            head = header([b"callerid=/x", b"md5sum=*", b"type=*", b"latching=1", b"topic=/setpoint"])
            return mutated(self.chance, head + struct.pack("<I", 40) + self.chance.randbytes(40) * 3)
        body = self.chance.choice((xmlrpc.client.dumps(([1, "", ["TCPROS", "127.0.0.1", self.server.getsockname()[1]]],), methodresponse=True).encode(),
                                   nested(30000).split(b"\r\n\r\n", 1)[1]))
        return mutated(self.chance, b"HTTP/1.1 200 OK\r\nContent-length: %d\r\n\r\n" % len(body) + body)
