#!/usr/bin/python3
"""The panel's server: every role with every command and every wrong part of a request, odd requests, limits of rates, paths. No master, no loop."""
import asyncio
import http.client
import json
import os
import pathlib
import random
import socket
import sys
import tempfile
import threading
import time
import types
import unittest
from unittest import mock

TOP = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "python/panel"))
try:
    from panel_server import access, asked, web
except ImportError as error:  # a build without ROS
    raise unittest.SkipTest(str(error)) from error

import tornado.ioloop  # noqa: E402

FUZZ_S = float(os.environ.get("FMBPC_PANEL_FUZZ_S", "3"))
access.SCRYPT["n"] = 16  # a wrong token costs as many hashes as there are tokens: here they need not be dear
PASSWORDS = {"vera": "view", "olga": "operate", "emil": "engineer"}
ALARM = "/b|signal_missing|x"


class FakeDesk:
    def __init__(self):
        self.done = []

    def do(self, verb, arguments):
        self.done.append(verb)
        if arguments.get("refuse"):
            raise asked.Refused("because")
        return {"step": 7, "text": verb}


class Server:
    """The real server on a free port, with one loop whose desk only counts."""

    def __init__(self, anonymous="view"):
        self.folder = tempfile.TemporaryDirectory()
        path = os.path.join(self.folder.name, "users.json")
        for name, role in PASSWORDS.items():
            access.write_user(path, name, role, password="correct horse")
            access.write_user(path, name + "_token", role, token=name * 10)
        self.panel = web.Panel(os.path.join(self.folder.name, "data"), access.Access(access.read_users(path), anonymous))
        self.panel.find_loops = lambda: None
        self.desk = FakeDesk()
        self.panel.loops["/a"] = types.SimpleNamespace(name="/a", step=5, info=None, history=None, heard=None, look=lambda now: None, want_plan=lambda now: None)
        self.panel.desks["/a"] = self.desk
        self.panel.overview = lambda now: {"t": 0.0, "loops": [], "master": True, "trouble": ""}
        self.panel.update = lambda loop, now: {"name": loop.name}
        for bucket in (self.panel.commands_rate, self.panel.requests_rate, self.panel.access.tries):
            bucket.per_s = bucket.burst = 1e9
        self.panel.alarms.look("/a", {("signal_missing", "x"): ("warning", "x is missing")}, 1.0)
        started = threading.Event()

        def run():
            asyncio.set_event_loop(asyncio.new_event_loop())
            self.loop = tornado.ioloop.IOLoop.current()
            _, self.port = web.serve(self.panel, "127.0.0.1", 0, anonymous=anonymous)
            self.loop.add_callback(started.set)
            self.loop.start()
        self.thread = threading.Thread(target=run, daemon=True)
        self.thread.start()
        started.wait(20)
        self.host = f"127.0.0.1:{self.port}"

    def close(self):
        self.loop.add_callback(self.loop.stop)
        self.thread.join(10)
        self.panel.close()
        self.folder.cleanup()

    def ask(self, method, path, body=None, **headers):
        """(status, headers, body) with exactly these headers besides Content-Length."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        try:
            connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
            data = body if isinstance(body, bytes) else json.dumps(body).encode() if body is not None else b""
            for name, value in {"Host": self.host, **{k.replace("_", "-"): v for k, v in headers.items()}}.items():
                if value is not None:
                    connection.putheader(name, value)
            if data or method == "POST":
                connection.putheader("Content-Length", str(len(data)))
            connection.endheaders(data)
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        except (ConnectionError, http.client.HTTPException):
            return 0, {}, b""  # cut off
        finally:
            connection.close()

    def good(self, **more):
        return {"Origin": "http://" + self.host, "Content_Type": "application/json", **more}

    def login(self, name):
        """Headers of somebody who is logged in."""
        status, headers, body = self.ask("POST", "/api/login", {"name": name, "password": "correct horse"}, **self.good())
        assert status == 200, body
        return self.good(Cookie=headers["Set-Cookie"].split(";")[0], X_Xsrf=json.loads(body)["xsrf"])

    def token(self, name):
        return {"Content_Type": "application/json", "Authorization": "Bearer " + name * 10}


class Web(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.who = {name: cls.server.login(name) for name in PASSWORDS}

    @classmethod
    def tearDownClass(cls):
        cls.server.close()

    def command(self, verb, method="POST", **headers):
        return self.server.ask(method, "/api/command", {"verb": verb, "loop": "/a", "arguments": {"key": "none", "on": True}}, **headers)[0]

    def test_each_role_may_what_it_may_and_nothing_more(self):
        roles = [("none", self.server.good(), "view"), *[(n, self.who[n], r) for n, r in PASSWORDS.items()], *[(n + "_token", self.server.token(n), r) for n, r in PASSWORDS.items()]]
        for verb, needed in asked.VERBS.items():
            for name, headers, role in roles:
                before = len(self.server.desk.done)
                status = self.command(verb, **headers)
                if access.rank(role) < access.rank(needed):
                    self.assertEqual((403, before), (status, len(self.server.desk.done)), (verb, name))
                else:
                    self.assertIn(status, (200, 409), (verb, name))

    def test_nothing_wrong_gets_through_whoever_asks(self):
        """role x command x wrong Origin, Host, token, method, size, kind."""
        wrong = [{"Origin": "http://evil.example"}, {"Origin": "null"}, {"Origin": None}, {"Origin": "http://localhost:1"}, {"Host": "evil.example"}, {"Host": f"evil.example:{self.server.port}"},
                 {"Host": None}, {"X_Xsrf": None}, {"X_Xsrf": "x"}, {"X_Xsrf": self.who["vera"]["X_Xsrf"]}, {"Content_Type": "text/plain"}, {"Content_Type": None},
                 {"Content_Type": "application/x-www-form-urlencoded"}, {"Sec_Fetch_Site": "cross-site"}, {"Sec_Fetch_Site": "same-site"}, {"Authorization": "Bearer wrong"}, {"Authorization": "Basic x"}]
        before = list(self.server.desk.done)
        for verb in asked.VERBS:
            for name in ("olga", "emil"):
                for part in wrong:
                    self.assertIn(self.command(verb, **{**self.who[name], **part}), (400, 401, 403), (verb, name, part))
                for method in ("GET", "PUT", "DELETE", "PATCH", "OPTIONS", "HEAD", "TRACE", "BREW"):
                    self.assertIn(self.command(verb, method, **self.who[name]), (400, 404, 405), (verb, method))
            for part in ({"Origin": "http://evil.example"}, {"Host": "evil.example"}, {"Authorization": "Bearer emil"}, {"Content_Type": "text/plain"}):
                self.assertIn(self.command(verb, **{**self.server.token("emil"), **part}), (401, 403), (verb, part))
        self.assertEqual(before, self.server.desk.done)

    def test_bodies_that_are_too_large_or_no_object(self):
        before = list(self.server.desk.done)
        for body in (b"x" * 20000, b'{"verb":"set","loop":"/a","arguments":{"values":{"x":' + b"9" * 20000 + b"}}}", b"[1]", b"", b"null", b"{", b"\xff\xfe", b'{"verb":1}', b'{"verb":"set","loop":[]}',
                     b'{"verb":"set","loop":"/a","arguments":[]}', b'{"verb":"__init__","loop":"/a"}', b'{"verb":"_ask","loop":"/a"}', b'{"verb":"close","loop":"/a"}', b"[" * 9000,
                     b'{"verb":"set","loop":"/a","arguments":{"values":{"x":NaN}}}', b'{"verb":"set","loop":"/b","arguments":{}}'):
            status = self.server.ask("POST", "/api/command", body, **self.who["emil"])[0]
            self.assertIn(status, (0, 400, 404, 413), body[:60])
        self.assertEqual(before, self.server.desk.done)

    def test_paths_lead_to_the_files_of_the_page_only(self):
        secret = os.path.join(self.server.folder.name, "users.json")
        for path in ("/../" * 8 + "etc/passwd", "/..%2f..%2f..%2fetc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/app.js/../../panel_server/web.py", "/panel_server/web.py", "/app.js%00.html",
                     "/app.css/", "/index.html", "/.", "/web/app.js", "/static/app.js", secret, "/\\..\\..\\x", "http://127.0.0.1/app.js/x", "/app.js;x", "/./app.js"):
            status, _, body = self.server.ask("GET", path)
            self.assertIn(status, (0, 400, 404), path)
            self.assertNotIn(b"root:", body)
            self.assertNotIn(b"scrypt", body)
        for path in web.FILES:
            self.assertEqual(200, self.server.ask("GET", path)[0])

    def test_the_page_weighs_little_and_asks_nobody_else(self):
        total = 0
        for path in ("/", "/app.js", "/app.css", "/uPlot.js", "/uPlot.css", "/icon.svg"):
            status, headers, body = self.server.ask("GET", path, Accept_Encoding="gzip")
            self.assertEqual((200, "gzip"), (status, headers["Content-Encoding"]))
            self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
            self.assertNotIn("unsafe", headers["Content-Security-Policy"])
            self.assertEqual("nosniff", headers["X-Content-Type-Options"])
            total += len(body)
        self.assertLess(total, 150000)
        for name in ("app.js", "index.html", "app.css"):
            text = (TOP / "python/panel/web" / name).read_text()
            self.assertNotRegex(text, r"https?://(?!www\.w3\.org)")
            for never in ("innerHTML =", "insertAdjacentHTML", "eval(", "document.write", "new Function"):
                self.assertNotIn(never, text)

    def test_a_loop_that_vanishes_is_let_go_with_all_that_hears_it(self):
        panel = self.server.panel
        with mock.patch.object(web.loops, "Loop") as loop, mock.patch.object(web.commands, "Desk") as desk:
            loop.side_effect = lambda *_: mock.MagicMock(heard=None, history=None, info=None)
            desk.side_effect = lambda *_: mock.Mock()
            for name in ("/gone", "/heard"):
                panel.take_in(*panel.make(name))
            panel.keep(["/gone", "/heard"], 0.0)
            closed = [panel.loops["/gone"].close, panel.desks["/gone"].close]
            panel.loops["/heard"].heard = web.LEFT_AFTER  # its plant speaks, the master was started anew
            panel.alarms.look("/gone", {("link_lost", ""): ("warning", "lost")}, 1.0)
            panel.keep([], web.LEFT_AFTER - 1.0)
            panel.keep(None, 10.0 * web.LEFT_AFTER)  # no master: nothing is said of any loop
            self.assertLessEqual({"/gone", "/heard"}, set(panel.loops))
            self.assertEqual("unacknowledged", panel.alarms.alarms["/gone|link_lost|"].state)
            panel.keep([], web.LEFT_AFTER + 1.0)
            self.assertNotIn("/gone", panel.loops)
            self.assertNotIn("/gone", panel.desks)
            self.assertIn("/heard", panel.loops)
            self.assertEqual("returned", panel.alarms.alarms["/gone|link_lost|"].state)
            panel.executor.submit(lambda: None).result(10)
            for _ in range(100):
                if all(c.called for c in closed):
                    break
                time.sleep(0.01)
            self.assertEqual([1, 1], [c.call_count for c in closed])
            panel.let_go("/heard")

    def test_a_cookie_is_for_this_page_alone(self):
        headers = self.server.ask("POST", "/api/login", {"name": "vera", "password": "correct horse"}, **self.server.good())[1]
        for word in ("HttpOnly", "SameSite=Strict", "Path=/"):
            self.assertIn(word, headers["Set-Cookie"])
        out = self.server.login("olga")
        self.assertEqual(200, self.command("auto", **out))
        self.assertEqual(200, self.server.ask("POST", "/api/logout", {}, **out)[0])
        self.assertEqual(403, self.command("auto", **out))

    def test_who_has_not_logged_in_sees_nothing_on_a_network(self):
        closed = Server("none")
        try:
            for path in ("/stream", "/api/history?loop=/a", "/api/sparks", "/api/model?loop=/a", "/api/journal"):
                self.assertEqual(401, closed.ask("GET", path)[0], path)
            self.assertEqual(200, closed.ask("GET", "/api/journal", Cookie=closed.login("vera")["Cookie"])[0])
            self.assertEqual(200, closed.ask("GET", "/api/journal", **closed.token("vera"))[0])
        finally:
            closed.close()

    def test_everything_asked_is_journalled_with_who_and_what_became_of_it(self):
        self.server.ask("POST", "/api/command", {"verb": "set", "loop": "/a", "arguments": {}}, **self.who["olga"])
        self.server.ask("POST", "/api/command", {"verb": "set", "loop": "/a", "arguments": {"refuse": 1}}, **self.who["olga"])
        mine = [(e["what"], e["who"]) for e in self.server.panel.journal.latest(2000) if e["kind"] == "command"][-4:]
        self.assertEqual([("requested", "olga"), ("in force", "olga"), ("requested", "olga"), ("refused", "olga")], mine)
        self.server.panel.alarms.look("/b", {("signal_missing", "x"): ("warning", "x is missing")}, 1.0)
        self.assertEqual(200, self.server.ask("POST", "/api/command", {"verb": "acknowledge", "arguments": {"key": ALARM}}, **self.who["olga"])[0])
        self.assertEqual("acknowledged", self.server.panel.alarms.alarms[ALARM].state)

    def test_rates_have_limits(self):
        slow = Server()
        try:
            headers = slow.login("olga")
            slow.panel.commands_rate, slow.panel.requests_rate = access.Bucket(0.01, 20), access.Bucket(1e9, 1e9)
            codes = [slow.ask("POST", "/api/command", {"verb": "auto", "loop": "/a", "arguments": {}}, **headers)[0] for _ in range(40)]
            self.assertIn(429, codes)
            slow.panel.access.tries = access.Bucket(0.001, 5)
            answers = [slow.ask("POST", "/api/login", {"name": "emil", "password": "wrong"}, **slow.good()) for _ in range(8)]
            self.assertIn(b"too many", answers[-1][2])
            slow.panel.requests_rate = access.Bucket(0.01, 5)
            self.assertEqual(429, [slow.ask("GET", "/api/me")[0] for _ in range(10)][-1])
        finally:
            slow.close()

    def test_streams_speak_and_are_bounded(self):
        opened = []
        try:
            for _ in range(web.MOST_STREAMS_OF_ONE + 1):
                connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=10)
                connection.request("GET", "/stream", headers={"Host": self.server.host})
                opened.append((connection, connection.getresponse()))
            codes = [answer.status for _, answer in opened]
            self.assertEqual([200] * web.MOST_STREAMS_OF_ONE, codes[:-1])
            self.assertEqual(429, codes[-1])
            begin, said = time.monotonic(), 0
            while said < 4:  # hello's overview, then one twice a second
                said += opened[0][1].readline() == b"event: overview\n"
            self.assertLess(time.monotonic() - begin, 6.0)
        finally:
            for connection, _ in opened:
                connection.close()

    def test_odd_requests_change_nothing(self):
        """Random bytes and damaged requests, for FMBPC_PANEL_FUZZ_S seconds."""
        before, dice, end, sent = list(self.server.desk.done), random.Random(11), time.monotonic() + FUZZ_S, 0
        good = b"POST /api/command HTTP/1.1\r\nHost: %s\r\nOrigin: http://%s\r\nContent-Type: application/json\r\nContent-Length: 44\r\n\r\n" % (self.server.host.encode(), self.server.host.encode())
        good += b'{"verb":"set","loop":"/a","arguments":{"a":1}}'
        while time.monotonic() < end:
            data = bytearray(good)
            for _ in range(dice.choice((0, 1, 3, 20))):
                at = dice.randrange(len(data))
                what = dice.random()
                if what < 0.4:
                    data[at] = dice.randrange(256)
                elif what < 0.6:
                    del data[at:at + dice.randrange(1, 30)]
                elif what < 0.8:
                    data[at:at] = dice.choice((b"\r\n", b"\x00", b"Content-Length: 1\r\n", b"Transfer-Encoding: chunked\r\n", b"A" * 5000, b"../", b"%00", b"Cookie: fmbpc_panel=x\r\n", b"Authorization: Bearer \xff\r\n"))
                else:
                    data[at:at + 4] = bytes(dice.randrange(256) for _ in range(4))
                if not data:
                    break
            if dice.random() < 0.1:
                data = bytearray(dice.randrange(256) for _ in range(dice.randrange(2000)))
            with socket.create_connection(("127.0.0.1", self.server.port), timeout=10) as link:
                link.settimeout(0.05)
                try:
                    link.sendall(bytes(data))
                    link.shutdown(socket.SHUT_WR)
                    link.recv(4096)
                except OSError:
                    pass
            sent += 1
        self.assertGreater(sent, 10)
        self.assertEqual(before, self.server.desk.done)
        self.assertEqual(200, self.server.ask("GET", "/api/me")[0])


if __name__ == "__main__":
    unittest.main()
