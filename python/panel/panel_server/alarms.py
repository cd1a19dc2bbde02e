"""Alarms by ISA-18.2 (IEC 62682): seven states, delays against chatter, first-out, shelving with an end; and the journal."""
import json
import math
import os
import threading

NORMAL, UNACKNOWLEDGED, ACKNOWLEDGED, RETURNED = "normal", "unacknowledged", "acknowledged", "returned"
SHELVED, SUPPRESSED, OUT_OF_SERVICE = "shelved", "suppressed", "out_of_service"
STATES = (NORMAL, UNACKNOWLEDGED, ACKNOWLEDGED, RETURNED, SHELVED, SUPPRESSED, OUT_OF_SERVICE)
PRIORITIES = {"error": 1, "warning": 2, "info": 3}
OFF_DELAY = 5.0           # s of wall time that a cause must be away
LONG_OFF_DELAY = 60.0     # s, of one that came twice within a minute
CHATTER = 60.0            # s
QUIET = 60.0              # s without an active alarm, then the next one is the first out
LONGEST_SHELF = 24 * 3600.0
MOST_ALARMS = 2000        # of one panel; the oldest normal ones go first

# What follows from others: suppressed by design while one of those is active in the same loop.
CONSEQUENCES = {"node_degraded", "input_held", "run_incomplete", "measurement_rejected", "never_controlled", "waiting"}
# What follows from a node that says nothing: suppressed while that node, or the plant, is named.
OF_SILENCE = {"node_silent", "no_action", "no_measurement", "not_recorded", "record_gap", "optimizer_lost", "network_problem"}
ON_DELAY = 1.0            # s that such a one must last: who is silent is known later than what lacks because of it
SILENT_PLANT = ("node_silent", "plant")


class Alarm:
    """One alarm (a code of a signal in a loop): its cause comes and goes, people acknowledge it and put it aside."""

    def __init__(self, loop, code, signal, severity):
        self.loop, self.code, self.signal, self.severity = loop, code, signal, severity
        self.active = False        # the cause is there, delays included
        self.acknowledged = True   # of the latest time that it came
        self.shelved_until = 0.0   # s of wall time; 0: it is not
        self.out_of_service = False
        self.suppressed = False    # by design
        self.text, self.since, self.gone, self.step, self.run_id, self.count = "", 0.0, 0.0, 0, 0, 0
        self.first_out = False
        self.by = ""
        self.came = []             # times of the latest two
        self.away_since = None     # the cause is away, the delay runs
        self.there_since = None    # likewise, it is there

    @property
    def key(self):
        return f"{self.loop}|{self.code}|{self.signal}"

    @property
    def priority(self):
        return PRIORITIES.get(self.severity, 2)

    @property
    def state(self):
        if self.out_of_service:
            return OUT_OF_SERVICE
        if self.shelved_until:
            return SHELVED
        if self.suppressed and self.active:
            return SUPPRESSED
        if self.active:
            return ACKNOWLEDGED if self.acknowledged else UNACKNOWLEDGED
        return NORMAL if self.acknowledged else RETURNED

    def off_delay(self):
        twice = len(self.came) == 2 and self.came[1] - self.came[0] < CHATTER
        return LONG_OFF_DELAY if twice else OFF_DELAY

    def names_who(self):
        """It says which node is silent."""
        return self.code == "node_silent" and self.signal != ""

    def follows(self, roots, silent):
        """From another alarm of its loop. roots: there is one that is no consequence; silent: the nodes that are named so."""
        if self.code in CONSEQUENCES:
            return roots
        if self.code not in OF_SILENCE or (self.code, self.signal) == SILENT_PLANT:
            return False
        return SILENT_PLANT[1] in silent if self.names_who() else bool(silent)

    def on_delay(self):
        return ON_DELAY if self.code in OF_SILENCE and not self.names_who() else 0.0

    def see(self, cause, now):
        """The cause is there or not; True if the alarm came or went."""
        if cause:
            self.away_since = None
            if self.active:
                return False
            self.there_since = now if self.there_since is None else self.there_since
            if now - self.there_since < self.on_delay():
                return False
            self.active, self.acknowledged = True, self.suppressed  # what nobody was told needs no answer
            self.since, self.count = now, self.count + 1
            self.came = (self.came + [now])[-2:]
            return True
        self.there_since = None
        if not self.active:
            return False
        if self.away_since is None:
            self.away_since = now
        if now - self.away_since < self.off_delay():
            return False
        self.active, self.gone, self.away_since = False, now, None
        return True

    def dump(self):
        return {"key": self.key, "loop": self.loop, "code": self.code, "signal": self.signal, "severity": self.severity, "priority": self.priority,
                "state": self.state, "active": self.active, "acknowledged": self.acknowledged, "shelved_until": self.shelved_until,
                "out_of_service": self.out_of_service, "suppressed": self.suppressed, "text": self.text, "since": self.since, "gone": self.gone,
                "step": self.step, "run_id": str(self.run_id), "count": self.count, "first_out": self.first_out, "by": self.by}


class Journal:
    """One JSON object a line, on disk before anybody sees it. What was cut off when a panel was killed is left out and counted."""

    def __init__(self, path, largest=20e6, kept=2000):
        self.path, self.largest, self.kept = path, largest, kept
        self.lock, self.tail, self.damaged, self.number = threading.Lock(), [], 0, 0
        os.makedirs(os.path.dirname(path) or ".", mode=0o700, exist_ok=True)
        for old in self.files():
            self._read(old)
        self.stream = open(path, "ab")
        if self.stream.tell() and not self._whole():
            self.stream.write(b"\n")
        self.trouble = ""

    def files(self):
        """The oldest first."""
        folder, name = os.path.split(self.path)
        old = sorted(f for f in os.listdir(folder or ".") if f.startswith(name + "."))
        return [os.path.join(folder, f) for f in old] + ([self.path] if os.path.exists(self.path) else [])

    def _whole(self):
        with open(self.path, "rb") as stream:
            stream.seek(-1, os.SEEK_END)
            return stream.read(1) == b"\n"

    def _read(self, path):
        with open(path, "rb") as stream:
            for line in stream:
                if not line.strip():
                    continue
                try:
                    entry = json.loads(line)
                    self.number = max(self.number, int(entry["n"]))
                except (ValueError, KeyError, TypeError):
                    self.damaged += 1
                    continue
                self.tail.append(entry)
                if len(self.tail) > 2 * self.kept:
                    del self.tail[:-self.kept]

    def states(self):
        """The latest entry of each alarm in all files."""
        latest = {}
        for path in self.files():
            with open(path, "rb") as stream:
                for line in stream:
                    if b'"alarm"' not in line:
                        continue
                    try:
                        entry = json.loads(line)
                    except ValueError:
                        continue
                    if isinstance(entry.get("alarm"), dict) and "key" in entry["alarm"]:
                        latest[entry["alarm"]["key"]] = entry["alarm"]
        return latest

    def write(self, entry):
        """Returns the entry with its number. A full disk is said, the panel goes on."""
        with self.lock:
            self.number += 1
            entry = {"n": self.number, **entry}
            try:
                self.stream.write(json.dumps(entry, separators=(",", ":")).encode() + b"\n")
                self.stream.flush()
                os.fsync(self.stream.fileno())
                self.trouble = ""
                if self.stream.tell() > self.largest:
                    self._turn()
            except OSError as error:
                self.trouble = f"the journal cannot be written: {error.strerror}"
            self.tail.append(entry)
            if len(self.tail) > 2 * self.kept:
                del self.tail[:-self.kept]
            return entry

    def _turn(self):
        self.stream.close()
        numbers = [int(f.rsplit(".", 1)[1]) for f in self.files() if f.rsplit(".", 1)[1].isdigit()]
        os.rename(self.path, f"{self.path}.{max(numbers, default=0) + 1:06d}")
        self.stream = open(self.path, "ab")

    def latest(self, most=500, before=None):
        with self.lock:
            found = [e for e in self.tail if before is None or e["n"] < before]
        return found[-most:]

    def close(self):
        self.stream.close()


class AlarmList:
    """The alarms of all loops. `wall`: s since 1970, for what people read; `now` of the methods: s of a clock that only goes on."""

    def __init__(self, journal, wall):
        self.journal, self.wall, self.alarms, self.lock = journal, wall, {}, threading.RLock()
        self.quiet_since = {}      # by loop; None: something is active
        self.changes = 0           # counts, so that pages fetch what is new
        for stored in journal.states().values():
            self._restore(stored)

    def _restore(self, stored):
        try:
            alarm = Alarm(stored["loop"], stored["code"], stored["signal"], stored["severity"])
            for field in ("active", "acknowledged", "shelved_until", "out_of_service", "text", "since", "gone", "step", "count", "first_out", "by"):
                setattr(alarm, field, stored[field])
            alarm.run_id = int(stored["run_id"])
        except (KeyError, TypeError, ValueError):
            return
        self.alarms[alarm.key] = alarm

    def _say(self, alarm, what, who="", note=""):
        self.changes += 1
        self.journal.write({"t": round(self.wall(), 3), "kind": "alarm", "what": what, "who": who, "note": note, "loop": alarm.loop,
                            "step": alarm.step, "alarm": alarm.dump()})

    def look(self, loop, causes, now, step=0, run_id=0):
        """What is wrong with a loop now: {(code, signal): (severity, text)}.

        Info is no alarm: it asks nothing of the operator."""
        with self.lock:
            causes = {key: cause for key, cause in causes.items() if cause[0] != "info"}
            roots = any(code not in CONSEQUENCES for code, _ in causes)
            silent = {signal for code, signal in causes if code == "node_silent" and signal}
            silent |= {a.signal for a in self.alarms.values() if a.loop == loop and a.active and a.names_who()}
            for (code, signal), (severity, text) in causes.items():
                alarm = self.alarms.get(f"{loop}|{code}|{signal}")
                if alarm is None:
                    alarm = Alarm(loop, code, signal, severity)
                    self.alarms[alarm.key] = alarm
                    self._bound()
                # A consequence says nothing while its cause is said.
                suppressed = alarm.follows(roots, silent)
                quieted = alarm.active and suppressed and not alarm.suppressed
                freed = alarm.active and alarm.suppressed and not suppressed
                alarm.suppressed = suppressed
                came = alarm.see(True, now)
                if came or not alarm.text:
                    alarm.text, alarm.step, alarm.run_id, alarm.severity = text, step, run_id, severity
                if came:
                    alarm.since, alarm.by = self.wall(), ""
                    alarm.first_out = not suppressed and self.quiet_since.get(loop, -math.inf) is not None \
                        and now - self.quiet_since.get(loop, -math.inf) >= QUIET
                    if alarm.first_out:
                        self.quiet_since[loop] = None
                    self._say(alarm, "suppressed" if suppressed else "came")
                elif quieted or freed:
                    alarm.acknowledged = alarm.acknowledged and not freed
                    self._say(alarm, "suppressed" if quieted else "no longer suppressed")
                if PRIORITIES[severity] < alarm.priority:
                    alarm.severity = severity
                    self._say(alarm, "more urgent")
            for alarm in list(self.alarms.values()):
                if alarm.loop != loop or (alarm.code, alarm.signal) in causes:
                    continue
                if alarm.see(False, now):
                    alarm.gone = self.wall()
                    alarm.suppressed = False
                    self._say(alarm, "went")
            active = any(a.active for a in self.alarms.values() if a.loop == loop)
            if active:
                self.quiet_since[loop] = None
            elif self.quiet_since.get(loop, -math.inf) is None:
                self.quiet_since[loop] = now

    def end(self, loop):
        """The loop is not there any more: what was active has gone."""
        with self.lock:
            for alarm in self.alarms.values():
                if alarm.loop == loop and alarm.active:
                    alarm.active, alarm.suppressed, alarm.away_since, alarm.gone = False, False, None, self.wall()
                    self._say(alarm, "went", "", "the loop is not there any more")
            self.quiet_since.pop(loop, None)

    def tick(self):
        """Ends what is shelved."""
        with self.lock:
            for alarm in self.alarms.values():
                if alarm.shelved_until and self.wall() >= alarm.shelved_until:
                    alarm.shelved_until = 0.0
                    self._say(alarm, "unshelved", "", "the time is over")

    def acknowledge(self, key, who):
        """Why not, or "". Shelved, suppressed and out-of-service alarms are not acknowledged: the operator has not seen them."""
        with self.lock:
            alarm = self.alarms.get(key)
            if alarm is None:
                return "no such alarm"
            if alarm.state not in (UNACKNOWLEDGED, RETURNED):
                return f"nothing to acknowledge: it is {alarm.state.replace('_', ' ')}"
            alarm.acknowledged, alarm.by = True, who
            self._say(alarm, "acknowledged", who)
            return ""

    def shelve(self, key, seconds, who):
        with self.lock:
            alarm = self.alarms.get(key)
            if alarm is None:
                return "no such alarm"
            if not (isinstance(seconds, (int, float)) and 0 < seconds <= LONGEST_SHELF):
                return f"shelve: expected seconds > 0 and <= {LONGEST_SHELF:.0f}"
            if alarm.out_of_service:
                return "it is out of service"
            alarm.shelved_until, alarm.by = self.wall() + seconds, who
            self._say(alarm, "shelved", who, f"for {seconds:.0f} s")
            return ""

    def unshelve(self, key, who):
        with self.lock:
            alarm = self.alarms.get(key)
            if alarm is None or not alarm.shelved_until:
                return "it is not shelved"
            alarm.shelved_until = 0.0
            self._say(alarm, "unshelved", who)
            return ""

    def serve(self, key, in_service, who):
        """In or out of service."""
        with self.lock:
            alarm = self.alarms.get(key)
            if alarm is None:
                return "no such alarm"
            if alarm.out_of_service != in_service:
                return "it is " + ("in" if in_service else "out of") + " service already"
            alarm.out_of_service, alarm.by = not in_service, who
            self._say(alarm, "in service" if in_service else "out of service", who)
            return ""

    def _bound(self):
        if len(self.alarms) <= MOST_ALARMS:
            return
        idle = [a for a in self.alarms.values() if a.state == NORMAL and not a.active]
        for alarm in sorted(idle, key=lambda a: a.gone)[:len(self.alarms) - MOST_ALARMS]:
            del self.alarms[alarm.key]

    def listed(self):
        """Those that are not simply normal, the most urgent first."""
        with self.lock:
            shown = [a for a in self.alarms.values() if a.state != NORMAL]
            order = {UNACKNOWLEDGED: 0, RETURNED: 1, ACKNOWLEDGED: 2, SHELVED: 3, SUPPRESSED: 4, OUT_OF_SERVICE: 5}
            return [a.dump() for a in sorted(shown, key=lambda a: (order[a.state], a.priority, -a.since))]

    def worst(self, loop):
        """Of a loop, for the overview: None or the dump of its most urgent one."""
        with self.lock:
            shown = [a for a in self.alarms.values() if a.loop == loop and a.state in (UNACKNOWLEDGED, ACKNOWLEDGED, RETURNED)]
            return min(shown, key=lambda a: (a.state != UNACKNOWLEDGED, a.priority, -a.since)).dump() if shown else None
