"""The panel's server: pages and streams for browsers, commands of operators. One thread looks at the loops ten times a second;
what it makes is made once for all browsers."""
import concurrent.futures
import fcntl
import gzip
import hashlib
import json
import logging
import math
import os
import socket
import time

import rosgraph
import tornado.httpserver
import tornado.ioloop
import tornado.iostream
import tornado.netutil
import tornado.web

from panel_server import access, alarms, asked, commands, loops
from panel_server.history import plain
from panel_server.tool import event_list, tool_path

TICK = 0.1            # s
SLEPT = 1.0           # s between two ticks: the panel was stopped
LOOK_FOR_LOOPS = 2.0  # s
MOST_LOOPS = 200
LEFT_AFTER = 600.0    # s that a loop is shown that no master lists and nobody hears any more
MOST_ROWS = 200       # in one message; of more, the least and the most of each stretch
SELDOM = 5            # ticks from one message about a fast loop to the next
MOST_STREAMS, MOST_STREAMS_OF_ONE = 100, 32
DEAF = 30.0           # s without reading, then a browser is cut off
MOST_POINTS = 4000
WEB = os.path.join(os.path.dirname(os.path.dirname(os.path.realpath(__file__))), "web")
FILES = {"/": ("index.html", "text/html; charset=utf-8"), "/app.js": ("app.js", "text/javascript; charset=utf-8"),
         "/app.css": ("app.css", "text/css; charset=utf-8"), "/uPlot.js": ("uPlot.iife.min.js", "text/javascript; charset=utf-8"),
         "/uPlot.css": ("uPlot.min.css", "text/css; charset=utf-8"), "/icon.svg": ("icon.svg", "image/svg+xml"),
         "/uPlot.LICENSE": ("uPlot.LICENSE", "text/plain; charset=utf-8")}
POLICY = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"


class Seldom(logging.Filter):
    """One line of a logger in ten seconds: whoever sends rubbish must not fill the disk."""

    last = -1e9

    def filter(self, record):
        now = time.monotonic()
        passes = now - self.last > 10.0
        if passes:
            self.last = now
        return passes


class StartError(Exception):
    """One line that says why the panel does not start."""


def compact(value):
    return json.dumps(value, separators=(",", ":"), allow_nan=False)


class Panel:
    """What all browsers share."""

    def __init__(self, folder, who, only=(), history_mb=100.0):
        os.makedirs(folder, mode=0o700, exist_ok=True)
        self.lock_file = open(os.path.join(folder, "lock"), "w")
        try:
            fcntl.flock(self.lock_file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise StartError(f"{folder}: another panel keeps its journal there (_data:=FOLDER is another one)") from error
        self.access, self.only, self.history_bytes = who, [n if n.startswith("/") else "/" + n for n in only], history_mb * 1e6
        self.tool = tool_path()
        self.events = event_list(self.tool)
        loops.Loop.severities = {code: e["severity"] for code, e in self.events.items()}
        self.journal = alarms.Journal(os.path.join(folder, "journal.jsonl"))
        self.alarms = alarms.AlarmList(self.journal, time.time)
        self.executor = concurrent.futures.ThreadPoolExecutor(8)
        self.loops, self.desks, self.streams = {}, {}, set()
        self.listed = {}  # name: when a master listed it last
        self.commands_rate = access.Bucket(per_s=5.0, burst=20)
        self.requests_rate = access.Bucket(per_s=100.0, burst=400)
        self.beat, self.said_alarms, self.ticked = 0, None, time.monotonic()
        self.journal.write({"t": round(time.time(), 3), "kind": "panel", "what": "started", "who": "", "note": ""})
        self.said_journal = self.journal.number
        self.looking, self.master_gone = False, False

    # Loops.

    def find_loops(self):
        """Namespaces with a plant, of the master; None if it does not answer."""
        before = socket.getdefaulttimeout()
        socket.setdefaulttimeout(3.0)
        try:
            topics = rosgraph.Master("/panel_look").getPublishedTopics("")  # of types the master forgets none
        except Exception:  # noqa: BLE001: gone, or busy: those that are there stay
            return None
        finally:
            socket.setdefaulttimeout(before)
        found = [t[:-len("/plant_info")] or "/" for t, kind in topics if kind == "fmbpc/PlantInfo" and t.endswith("/plant_info")]
        return [n for n in sorted(found) if not self.only or n in self.only][:MOST_LOOPS]

    def make(self, name):
        """A loop and its desk. Waits for the master: in a thread."""
        loop = loops.Loop(name, self.history_bytes, self.tool, self.executor)
        return name, loop, commands.Desk(loop)

    def take_in(self, name, loop, desk):
        self.loops[name], self.desks[name], self.listed[name] = loop, desk, time.monotonic()

    def keep(self, names, now):
        """names: of loops that a master lists; None: it does not answer."""
        self.master_gone = names is None
        for name in names or ():
            self.listed[name] = now
        for name, loop in list(self.loops.items()) if names is not None else ():
            if now - max(self.listed.get(name, now), loop.heard or -math.inf) > LEFT_AFTER:
                self.let_go(name)
        share = self.history_bytes / max(len(self.loops), 1)
        for loop in self.loops.values():
            loop.history_bytes = share
            if loop.history is not None:
                loop.history.limit(share)

    def let_go(self, name):
        """Its alarms go, and stay in the list where nobody has acknowledged them."""
        for item in (self.loops.pop(name), self.desks.pop(name)):
            self.executor.submit(item.close)  # the master may hang
        self.alarms.end(name)
        self.listed.pop(name, None)
        self.journal.write({"t": round(time.time(), 3), "kind": "loop", "what": "gone", "who": "", "loop": name, "note": f"unheard for {LEFT_AFTER:.0f} s"})

    def look_for_loops(self):
        if self.looking:
            return
        self.looking = True
        server = tornado.ioloop.IOLoop.current()

        def look():
            names = self.find_loops()
            server.add_callback(self.keep, names, time.monotonic())
            for name in names or ():
                if name not in self.loops:
                    server.add_callback(self.take_in, *self.make(name))

        def done(future):
            self.looking = False
            future.result()
        server.add_future(self.executor.submit(look), done)

    # Ten times a second.

    def tick(self):
        now = time.monotonic()
        slept, self.ticked = now - self.ticked, now
        self.beat += 1
        watched = {s.loop for s in self.streams}
        for name, loop in list(self.loops.items()):
            if name in watched:
                loop.want_plan(now)
            if slept > SLEPT:
                loop.excuse(slept)
            loop.look(now)
            if loop.info is not None:
                with loop.lock:
                    self.alarms.look(name, loop.current(now), now, max(loop.step, 0), loop.run_id or 0)
        self.alarms.tick()
        if self.streams:
            self.say(now, watched)
        for name, loop in self.loops.items():
            if name not in watched:
                loop.sent_from = loop.step + 1

    def say(self, now, watched):
        if self.beat % 5 == 0:
            self.send("overview", compact(self.overview(now)))
        for name in watched:
            if name in self.loops and (self.beat % SELDOM == 0 or not self.loops[name].fast()):
                self.send("loop", compact(self.update(self.loops[name], now)), name)
        if self.said_alarms != self.alarms.changes:
            self.said_alarms = self.alarms.changes
            self.send("alarms", compact(self.alarms.listed()))
        if self.said_journal != self.journal.number:
            news = [e for e in self.journal.latest(100) if e["n"] > self.said_journal]
            self.said_journal = self.journal.number
            self.send("journal", compact([light(e) for e in news]))

    def send(self, kind, text, loop=None):
        packed = event(kind, text)
        for stream in list(self.streams):
            if loop is None or stream.loop == loop:
                stream.push(packed)

    def overview(self, now):
        rows = []
        for name, loop in sorted(self.loops.items()):
            with loop.lock:
                rows.append(self.brief(name, loop, now))
        return {"t": round(time.time(), 3), "loops": rows, "master": not self.master_gone, "trouble": self.journal.trouble}

    def brief(self, name, loop, now):
        info, state = loop.info, loop.summary()
        first = lead(loop)
        return {"name": name, "title": loop.get("title") or (info.name if info else name), "plant": info.name if info else "",
                "word": state.word if state else "waiting", "reason": state.reason if state else "nothing has come yet", "code": state.code if state else "",
                "stale": round(loop.stale(now), 1) if loop.heard is not None and not loop.over() else 0.0, "over": loop.over(),
                "step": loop.step, "seconds": loop.seconds(), "run": str(loop.run_id or ""), "restarted": loop.restarted,
                "mode": mode_of(loop), "alarm": self.alarms.worst(name),
                "output": None if first is None or loop.step < 0 else {
                    "name": info.outputs[first].name, "unit": info.outputs[first].unit, "value": loops.finite(loop.history.value(loop.step, info.outputs[first].name)),
                    "setpoint": loops.finite(loop.setpoint[first]) if first < len(loop.setpoint) else None},
                "input": None if not loop.action or info is None else {"name": info.inputs[0].name, "unit": info.inputs[0].unit, "value": loops.finite(loop.action[0])}}

    def update(self, loop, now):
        """What is new in a loop since the last tick."""
        with loop.lock:
            update = self.brief(loop.name, loop, now)
            if loop.info is None:
                return update
            update.update(loop.tables(now))
            update["columns"], update["dt"] = loop.history.columns, loop.info.sample_time_s
            update["nodes"] = [{"node": s.node, "word": s.word, "reason": s.reason, "code": s.code, "away": round(now - loop.heard_of.get(s.node, now), 1)} for s in loop.states.values()]
            update["ahead"] = loop.ahead() if self.beat % 2 == 0 else False  # False: as before
            update["held"] = bool(loop.kept and loop.kept.recipe_held)
            update["adapt"] = bool(loop.kept.adapt) if loop.kept is not None and loop.kept.adapt_given else None
            update["trust"], update["fast"] = loops.finite(loop.trust_said) if loop.trust is None or loop.trust.known() else None, loop.fast()
            update["external"] = loop.get("plant", "type") == "external"
            steps, values, wall = loop.history.drawn(loop.sent_from, loop.step, MOST_ROWS)
            loop.sent_from = loop.step + 1
            update["rows"] = [[int(s), None if w != w else round(float(w), 2)] + plain(v) for s, v, w in zip(steps, values, wall)]
        return update

    # Commands.

    def run(self, caller, body):
        """(status, answer) of a command; blocks."""
        verb, name, arguments = body.get("verb"), body.get("loop", ""), body.get("arguments", {})
        if not isinstance(verb, str) or verb not in asked.VERBS or not isinstance(arguments, dict) or not isinstance(name, str):
            return 400, {"error": "expected verb, loop and arguments"}
        if not caller.may(asked.VERBS[verb]):
            return 403, {"error": f"'{verb}' needs the role {asked.VERBS[verb]}: log in" if caller.role in ("view", "none") else f"'{verb}' needs the role {asked.VERBS[verb]}"}
        if not self.commands_rate.take(caller.name):
            return 429, {"error": "too many commands: wait a second"}
        if verb in ("acknowledge", "acknowledge_all", "shelve", "unshelve", "service"):
            return self.on_alarm(caller, verb, arguments)
        if name not in self.loops:
            return 404, {"error": "no such loop"}
        entry = {"t": round(time.time(), 3), "kind": "command", "who": caller.name, "loop": name, "step": self.loops[name].step, "verb": verb}
        self.journal.write({**entry, "what": "requested", "note": compact(arguments)[:500]})
        try:
            answer = self.desks[name].do(verb, arguments)
        except asked.Refused as error:
            self.journal.write({**entry, "t": round(time.time(), 3), "what": "refused", "note": str(error)[:500]})
            return 409, {"error": str(error)}
        except Exception as error:  # noqa: BLE001: a loop that ends in between; the journal says what became of the wish
            self.journal.write({**entry, "t": round(time.time(), 3), "what": "failed", "note": str(error)[:500]})
            return 502, {"error": str(error)}
        self.journal.write({**entry, "t": round(time.time(), 3), "step": answer["step"], "what": "in force", "note": answer["text"][:500]})
        return 200, answer

    def on_alarm(self, caller, verb, arguments):
        key = arguments.get("key")
        if verb == "acknowledge_all":
            loop = arguments.get("loop")
            keys = [a["key"] for a in self.alarms.listed() if a["state"] in (alarms.UNACKNOWLEDGED, alarms.RETURNED) and loop in (None, a["loop"])]
            for each in keys:
                self.alarms.acknowledge(each, caller.name)
            return 200, {"step": None, "text": f"{len(keys)} acknowledged"}
        if not isinstance(key, str):
            return 400, {"error": "expected the key of an alarm"}
        if verb == "service":
            if not isinstance(arguments.get("on"), bool):
                return 400, {"error": "on: expected true or false"}
            why = self.alarms.serve(key, arguments["on"], caller.name)
        elif verb == "shelve":
            seconds = arguments.get("seconds")
            why = self.alarms.shelve(key, seconds if not isinstance(seconds, bool) else None, caller.name)
        else:
            why = getattr(self.alarms, verb)(key, caller.name)
        return (409, {"error": why}) if why else (200, {"step": None, "text": verb + "d"})

    def close(self):
        self.journal.write({"t": round(time.time(), 3), "kind": "panel", "what": "ended", "who": "", "note": ""})
        self.executor.shutdown(wait=False)


def event(kind, text):
    """Of server-sent events, one."""
    return f"event: {kind}\ndata: {text}\n\n".encode()


def lead(loop):
    """Index of the output that the overview shows, the first one; None before there is one."""
    return 0 if loop.info is not None and loop.info.outputs else None


def mode_of(loop):
    manual = loop.kept is not None and loop.kept.run_id == loop.run_id and loop.kept.manual
    return "manual" if manual else "auto"


def light(entry):
    """Of a journal entry what pages show."""
    short = {k: v for k, v in entry.items() if k != "alarm"}
    if "alarm" in entry:
        short.update({k: entry["alarm"][k] for k in ("code", "signal", "text", "state", "priority") if k in entry["alarm"]})
    return short


class Handler(tornado.web.RequestHandler):
    """Checks who asks, and from where, before anything else."""

    def initialize(self, panel, hosts, secure, cookie, anonymous):
        self.panel, self.hosts, self.secure, self.cookie, self.anonymous = panel, hosts, secure, cookie, anonymous

    def set_default_headers(self):
        self.clear_header("Server")
        for name, value in (("Content-Security-Policy", POLICY), ("X-Content-Type-Options", "nosniff"), ("Referrer-Policy", "no-referrer"),
                            ("X-Frame-Options", "DENY"), ("Cross-Origin-Opener-Policy", "same-origin"), ("Cross-Origin-Resource-Policy", "same-origin"),
                            ("Cache-Control", "no-store"), ("Permissions-Policy", "camera=(), geolocation=(), microphone=()")):
            self.set_header(name, value)

    def prepare(self):
        if self.request.headers.get("Host") not in self.hosts:
            self.refuse(403, "host: not an address of this panel")
            return
        if not self.panel.requests_rate.take(self.request.remote_ip):
            self.refuse(429, "too many requests: wait a second")
            return
        self.caller = self.who()
        if self.caller is None:
            self.refuse(401, "token: unknown")

    def who(self):
        """The caller; None if it shows an unknown token."""
        given = self.request.headers.get("Authorization")
        if given is not None:
            found = self.panel.access.token(given[7:], self.request.remote_ip) if given.startswith("Bearer ") else None
            return access.Caller(found[0], found[1], by_token=True) if found else None
        session = self.panel.access.session(self.get_cookie(self.cookie))
        if session is not None:
            return access.Caller(session.name, session.role, session)
        return access.Caller("", self.anonymous)

    def refuse(self, status, why):
        self.set_status(status)
        self.answer({"error": why})

    def answer(self, value):
        self.set_header("Content-Type", "application/json; charset=utf-8")
        text = compact(value).encode()
        if len(text) > 1000 and "gzip" in self.request.headers.get("Accept-Encoding", ""):
            self.set_header("Content-Encoding", "gzip")
            text = gzip.compress(text, 5)
        self.finish(text)

    def write_error(self, status_code, **_):
        self.finish(compact({"error": {404: "no such page", 405: "method: not for this page"}.get(status_code, "it could not be done")}))

    def may_view(self):
        """Answers itself if not."""
        if self.caller.may("view"):
            return True
        self.refuse(401, "log in to see this")
        return False

    def seen_loop(self):
        """The loop asked for; None after an answer of its own: the caller may not see it, or there is none."""
        if not self.may_view():
            return None
        found = self.panel.loops.get(self.get_query_argument("loop", ""))
        if found is None or found.history is None:
            self.refuse(404, "no such loop")
            return None
        return found

    def log_exception(self, typ, value, tb):
        if not isinstance(value, tornado.web.HTTPError):
            super().log_exception(typ, value, tb)


class Static(Handler):
    """The files of the page, read at the start: no path leads anywhere else."""

    store = {}

    @classmethod
    def load(cls):
        for path, (name, kind) in FILES.items():
            with open(os.path.join(WEB, name), "rb") as stream:
                data = stream.read()
            cls.store[path] = (data, gzip.compress(data, 9), kind, '"' + hashlib.sha256(data).hexdigest()[:16] + '"')

    def get(self):
        data, packed, kind, tag = self.store[self.request.path]
        self.set_header("Content-Type", kind)
        self.set_header("Cache-Control", "no-cache")
        self.set_header("ETag", tag)
        self.set_header("Vary", "Accept-Encoding")
        if self.request.headers.get("If-None-Match") == tag:
            self.set_status(304)
            self.finish()
            return
        if "gzip" in self.request.headers.get("Accept-Encoding", ""):
            self.set_header("Content-Encoding", "gzip")
            data = packed
        self.finish(data)


class Stream(Handler):
    """Server-sent events. A browser that is slow gets the newest, not all: it fetches the trend when it lacks rows."""

    loop = None
    pending = None
    missed = False
    pushed = 0.0

    async def get(self):
        if not self.may_view():
            return
        panel = self.panel
        of_one = sum(s.request.remote_ip == self.request.remote_ip for s in panel.streams)
        if len(panel.streams) >= MOST_STREAMS or of_one >= MOST_STREAMS_OF_ONE:
            self.refuse(429, "too many pages are open")
            return
        self.loop = self.get_query_argument("loop", None)
        self.set_header("Content-Type", "text/event-stream")
        self.set_header("X-Accel-Buffering", "no")
        now = time.monotonic()
        self.write("retry: 1000\n\n")
        self.write(event("hello", compact({"me": me(self.caller), "events": panel.events})))
        self.write(event("overview", compact(panel.overview(now))))
        self.write_lists()
        try:
            await self.flush()
        except tornado.iostream.StreamClosedError:
            return
        panel.streams.add(self)
        self.until = tornado.ioloop.IOLoop.current().time() + access.LONGEST
        self.ended = tornado.ioloop.IOLoop.current().asyncio_loop.create_future()
        try:
            await self.ended
        finally:
            panel.streams.discard(self)

    def write_lists(self):
        self.write(event("alarms", compact(self.panel.alarms.listed())))
        self.write(event("journal", compact([light(e) for e in self.panel.journal.latest(200)])))

    def push(self, packed):
        now = time.monotonic()
        if self.pending is not None and not self.pending.done():
            self.missed = True
            if now - self.pushed > DEAF:
                self.request.connection.stream.close()
            return
        if self.caller.session is not None and self.panel.access.session(self.get_cookie(self.cookie)) is None and self.anonymous == "none":
            self.on_connection_close()
            return
        if self.missed:
            self.missed = False
            self.write(event("missed", "1"))
            self.write_lists()
        self.write(packed)
        try:
            self.pending, self.pushed = self.flush(), now
        except tornado.iostream.StreamClosedError:
            self.on_connection_close()

    def on_connection_close(self):
        self.panel.streams.discard(self)
        if hasattr(self, "ended") and not self.ended.done():
            self.ended.set_result(None)


class HistoryPage(Handler):
    def get(self):
        loop = self.seen_loop()
        if loop is None:
            return
        try:
            first, last = int(self.get_query_argument("from", "0")), int(self.get_query_argument("to", str(2 ** 53)))
            points = min(max(int(self.get_query_argument("points", "1500")), 10), MOST_POINTS)
        except ValueError:
            self.refuse(400, "from, to, points: expected integers")
            return
        with loop.lock:
            steps, values, wall = loop.history.drawn(first, last, points)
            self.answer({"columns": loop.history.columns, "run": str(loop.run_id), "first": loop.history.first, "last": loop.history.last,
                         "dt": loop.info.sample_time_s, "steps": [int(s) for s in steps], "wall": [None if w != w else round(float(w), 2) for w in wall],
                         "data": [plain(values[:, j]) for j in range(values.shape[1])]})


class Sparks(Handler):
    """The small trends of the overview, all at once."""

    def get(self):
        if not self.may_view():
            return
        found = {}
        for name, loop in self.panel.loops.items():
            with loop.lock:
                first = lead(loop)
                if first is None or loop.history is None or loop.history.last is None:
                    continue
                output = loop.info.outputs[first].name
                steps, values, _ = loop.history.drawn(max(0, loop.step - 300), loop.step, 120)
                j = loop.history.index[output]
                k = loop.history.index[output + "_setpoint"]
                found[name] = {"steps": [int(s) for s in steps], "value": plain(values[:, j], 5), "setpoint": plain(values[:, k], 5)}
        self.answer(found)


class ModelPage(Handler):
    def get(self):
        loop = self.seen_loop()
        if loop is None:
            return
        with loop.lock:
            loop.want_plan(time.monotonic())
            self.answer({"model": loop.model_view(), "settings": [{"key": k, "type": t, "about": d, "value": (loop.settings_now or {}).get(k)}
                                                                  for k, t, d in loop.settings or []]})


class JournalPage(Handler):
    def get(self):
        if not self.may_view():
            return
        before = self.get_query_argument("before", None)
        if before is not None and not before.isdigit():
            self.refuse(400, "before: expected the number of an entry")
            return
        self.answer([light(e) for e in self.panel.journal.latest(500, int(before) if before else None)])


def me(caller):
    return {"name": caller.name, "role": caller.role, "xsrf": caller.session.xsrf if caller.session else ""}


class Me(Handler):
    def get(self):
        self.answer(me(self.caller))


class Post(Handler):
    """What changes something: who, from where, how large and of what kind is judged first."""

    def body(self):
        """The object in the body; answers itself if the request may not go on."""
        head = self.request.headers
        origin = head.get("Origin")
        why = access.judge(self.request.method, head.get("Host"), origin, head.get("Content-Type"), head.get("Sec-Fetch-Site"), head.get("X-Xsrf"), self.caller, self.hosts)
        if why:
            self.refuse(403, why)
            return None
        try:
            body = json.loads(self.request.body, parse_constant=no_constant)
        except (ValueError, RecursionError):
            body = None
        if not isinstance(body, dict):
            self.refuse(400, "expected a JSON object")
            return None
        return body


def no_constant(word):
    raise ValueError(word)


class Login(Post):
    async def post(self):
        body = self.body()
        if body is None:
            return
        panel, loop = self.panel, tornado.ioloop.IOLoop.current()
        key, why = await loop.run_in_executor(panel.executor, panel.access.login, body.get("name"), body.get("password"), self.request.remote_ip)
        note = {"t": round(time.time(), 3), "kind": "login", "who": str(body.get("name"))[:64], "note": why or f"from {self.request.remote_ip}"}
        panel.journal.write({**note, "what": "refused" if why else "logged in"})
        if why:
            self.refuse(403, why)
            return
        self.set_cookie(self.cookie, key, httponly=True, samesite="Strict", secure=self.secure, path="/")
        session = panel.access.session(key)
        self.answer(me(access.Caller(session.name, session.role, session)))


class Logout(Post):
    def post(self):
        if self.body() is None:
            return
        self.panel.access.logout(self.get_cookie(self.cookie))
        self.clear_cookie(self.cookie)
        if self.caller.name:
            self.panel.journal.write({"t": round(time.time(), 3), "kind": "login", "what": "logged out", "who": self.caller.name, "note": ""})
        self.answer({"name": "", "role": self.anonymous, "xsrf": ""})


class Command(Post):
    async def post(self):
        body = self.body()
        if body is None:
            return
        panel = self.panel
        status, answer = await tornado.ioloop.IOLoop.current().run_in_executor(panel.executor, panel.run, self.caller, body)
        self.set_status(status)
        self.answer(answer)


class Nothing(Handler):
    def get(self, *_):
        self.refuse(404, "no such page")

    post = put = delete = patch = options = head = get


def application(panel, hosts, secure=False, cookie="fmbpc_panel", anonymous="view"):
    Static.load()
    given = {"panel": panel, "hosts": hosts, "secure": secure, "cookie": cookie, "anonymous": anonymous}
    routes = [(path, Static, given) for path in FILES]
    routes += [("/stream", Stream, given), ("/api/history", HistoryPage, given), ("/api/sparks", Sparks, given), ("/api/model", ModelPage, given),
               ("/api/journal", JournalPage, given), ("/api/me", Me, given), ("/api/login", Login, given), ("/api/logout", Logout, given),
               ("/api/command", Command, given), ("/.*", Nothing, given)]
    return tornado.web.Application([(path + "$" if path != "/.*" else path, kind, args) for path, kind, args in routes], log_function=lambda _: None)


def serve(panel, address, port, hosts=(), secure=False, anonymous="view"):
    """Listens; returns the server and its port (0: a free one)."""
    for name in ("tornado.access", "tornado.application", "tornado.general", "asyncio"):
        logging.getLogger(name).filters[:] = [Seldom()]
    try:
        sockets = tornado.netutil.bind_sockets(port, address)
    except OSError as error:
        raise StartError(f"{address}:{port}: expected an address and a port that are free ({error.strerror})") from error
    port = sockets[0].getsockname()[1]
    allowed = access.allowed_hosts(address, port, hosts)
    server = tornado.httpserver.HTTPServer(application(panel, allowed, secure, f"fmbpc_panel_{port}", anonymous), max_body_size=16384,
                                           max_header_size=16384, idle_connection_timeout=60, body_timeout=10, xheaders=False)
    server.add_sockets(sockets)
    tornado.ioloop.PeriodicCallback(panel.tick, 1000 * TICK).start()
    tornado.ioloop.PeriodicCallback(panel.look_for_loops, 1000 * LOOK_FOR_LOOPS).start()
    tornado.ioloop.IOLoop.current().add_callback(panel.look_for_loops)
    return server, port
