#!/usr/bin/python3
"""The operator's panel without ROS: alarms, journal, history, numbers as people type them, who may do what, status words, plans."""
import itertools
import json
import math
import os
import pathlib
import random
import re
import stat
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock

import numpy

TOP = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "python/panel"))

from panel_server import access, alarms, asked, history, predict, state, tool  # noqa: E402


class Clock:
    def __init__(self, now=1000.0):
        self.now = now

    def __call__(self):
        return self.now


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "journal.jsonl")


class Alarms(Folder):
    def setUp(self):
        super().setUp()
        self.wall, self.now = Clock(), 0.0
        self.journal = alarms.Journal(self.path)
        self.addCleanup(lambda: self.journal.close())
        self.list = alarms.AlarmList(self.journal, self.wall)

    def look(self, *codes, seconds=0.1, severity="warning"):
        self.now += seconds
        self.wall.now += seconds
        self.list.look("/a", {(c, ""): (severity, c) for c in codes}, self.now)

    def state(self, code="x"):
        found = self.list.alarms.get(f"/a|{code}|")
        return found.state if found else alarms.NORMAL

    def test_an_alarm_comes_is_acknowledged_and_goes(self):
        self.look("x")
        self.assertEqual(alarms.UNACKNOWLEDGED, self.state())
        self.assertEqual("", self.list.acknowledge("/a|x|", "olga"))
        self.assertEqual(alarms.ACKNOWLEDGED, self.state())
        self.look(seconds=1)
        self.assertEqual(alarms.ACKNOWLEDGED, self.state())  # the delay runs
        self.look(seconds=alarms.OFF_DELAY)
        self.assertEqual(alarms.NORMAL, self.state())

    def test_one_that_goes_by_itself_stays_until_it_is_acknowledged(self):
        self.look("x")
        self.look()
        self.look(seconds=alarms.OFF_DELAY)
        self.assertEqual(alarms.RETURNED, self.state())
        self.assertEqual("", self.list.acknowledge("/a|x|", "olga"))
        self.assertEqual(alarms.NORMAL, self.state())
        self.assertIn("normal", self.list.acknowledge("/a|x|", "olga"))
        self.assertIn("no such", self.list.acknowledge("/a|y|", "olga"))

    def test_a_shelf_has_an_end(self):
        self.look("x")
        for seconds in (0, -1, math.inf, math.nan, 1e9, "5", None):
            self.assertNotEqual("", self.list.shelve("/a|x|", seconds, "olga"))
        self.assertEqual("", self.list.shelve("/a|x|", 60, "olga"))
        self.assertEqual(alarms.SHELVED, self.state())
        self.assertNotEqual("", self.list.acknowledge("/a|x|", "olga"))
        self.wall.now += 61
        self.list.tick()
        self.assertEqual(alarms.UNACKNOWLEDGED, self.state())

    def test_out_of_service_is_said_and_kept(self):
        self.look("x")
        self.assertEqual("", self.list.serve("/a|x|", False, "emil"))
        self.assertEqual(alarms.OUT_OF_SERVICE, self.state())
        self.assertNotEqual("", self.list.serve("/a|x|", False, "emil"))
        self.assertEqual("", self.list.serve("/a|x|", True, "emil"))
        self.assertEqual(alarms.UNACKNOWLEDGED, self.state())

    def test_what_follows_from_another_alarm_is_suppressed_while_that_is_there(self):
        self.look("signal_missing", "input_held")
        self.assertEqual((alarms.UNACKNOWLEDGED, alarms.SUPPRESSED), (self.state("signal_missing"), self.state("input_held")))
        self.look("input_held", seconds=1)
        self.assertEqual(alarms.UNACKNOWLEDGED, self.state("input_held"))

    def silence(self, *signals, codes=(), seconds=0.1):
        self.now += seconds
        self.wall.now += seconds
        self.list.look("/a", {**{("node_silent", s): ("warning", s) for s in signals}, **{(c, ""): ("error", c) for c in codes}}, self.now)

    def test_who_is_silent_is_said_once(self):
        told = []
        with unittest.mock.patch.object(self.list, "_say", lambda alarm, what, *_: told.append((what, alarm.code, alarm.signal))):
            self.silence(codes=["no_action"])
            self.silence("controller", codes=["no_action", "record_gap"], seconds=alarms.ON_DELAY - 0.1)
            self.silence("controller", codes=["no_action", "record_gap"], seconds=2)
            self.assertEqual(alarms.SUPPRESSED, self.state("no_action"))
            self.silence(codes=["no_measurement", "no_action"], seconds=1)  # it is back, what was said of it lags behind
            self.silence(codes=["no_measurement"], seconds=1.5)
            for _ in range(8):
                self.silence(seconds=1)
        self.assertEqual([("came", "node_silent", "controller"), ("went", "node_silent", "controller")], [t for t in told if t[0] != "suppressed" and t[1:] == ("node_silent", "controller") or t[0] == "came"])
        self.assertEqual(["node_silent"], [a["code"] for a in self.list.listed()])

    def test_of_a_silent_plant_nothing_else_is_said(self):
        self.silence("controller")
        self.silence("controller", "plant", codes=["no_action"], seconds=2)
        self.assertEqual([("plant", alarms.UNACKNOWLEDGED), ("controller", alarms.SUPPRESSED)], [(a["signal"], a["state"]) for a in self.list.listed()])

    def test_what_lacks_with_nobody_silent_is_said_after_its_delay(self):
        self.silence(codes=["no_action"])
        self.assertEqual(alarms.NORMAL, self.state("no_action"))
        self.silence(codes=["no_action"], seconds=alarms.ON_DELAY)
        self.assertEqual(alarms.UNACKNOWLEDGED, self.state("no_action"))
        self.silence("controller", codes=["no_action"])
        self.silence("controller", seconds=1)
        self.silence(seconds=alarms.OFF_DELAY)
        self.silence(codes=["no_action"], seconds=alarms.OFF_DELAY)  # and not again by itself
        self.assertEqual([1, 1], [a.count for a in self.list.alarms.values()])

    def test_a_cause_that_becomes_worse_makes_its_alarm_more_urgent(self):
        self.look("x", severity="warning")
        self.look("x", severity="error")
        self.look("x", severity="warning")
        self.assertEqual(("error", 1), (self.list.alarms["/a|x|"].severity, self.list.alarms["/a|x|"].count))

    def test_the_first_after_a_quiet_time_is_the_first_out(self):
        self.look("x")
        self.look("x", "y")
        self.assertEqual([True, False], [self.list.alarms[f"/a|{c}|"].first_out for c in "xy"])

    def test_info_is_no_alarm(self):
        self.look("x", severity="info")
        self.assertEqual([], self.list.listed())

    def test_random_causes_never_chatter_and_lose_nothing(self):
        """Whatever comes and goes: at most two annunciations in a minute, states as ISA-18.2 has them, nothing active unsaid."""
        for seed in range(40):
            dice, self.now, came = random.Random(seed), 1000.0 * seed, []
            code = f"seed{seed}"
            for _ in range(600):
                there = dice.random() < dice.choice((0.1, 0.5, 0.9))
                before = self.list.alarms[f"/a|{code}|"].count if f"/a|{code}|" in self.list.alarms else 0
                self.look(*([code] if there else []), seconds=dice.choice((0.1, 0.5, 3.0, 8.0)))
                alarm = self.list.alarms.get(f"/a|{code}|")
                if alarm is None:
                    self.assertFalse(there)
                    continue
                if alarm.count > before:
                    came.append(self.now)
                if there:
                    self.assertTrue(alarm.active)
                act = dice.random()
                if act < 0.1:
                    self.list.acknowledge(alarm.key, "olga")
                elif act < 0.13:
                    self.list.shelve(alarm.key, dice.uniform(1, 100), "olga")
                elif act < 0.15:
                    self.list.unshelve(alarm.key, "olga")
                elif act < 0.17:
                    self.list.serve(alarm.key, dice.random() < 0.5, "emil")
                self.list.tick()
                self.assertIn(alarm.state, alarms.STATES)
                listed = {a["key"] for a in self.list.listed()}
                self.assertEqual(alarm.state != alarms.NORMAL, alarm.key in listed)
                if alarm.active:
                    self.assertIn(alarm.key, listed)
            for first, third in zip(came, came[2:]):
                self.assertGreaterEqual(third - first, alarms.CHATTER)

    def test_a_restart_finds_everything(self):
        self.look("x", "y", "z", "w")
        self.list.acknowledge("/a|x|", "olga")
        self.list.shelve("/a|y|", 500, "olga")
        self.list.serve("/a|z|", False, "emil")
        before = self.list.listed()
        self.journal.close()
        self.journal = alarms.Journal(self.path)
        again = alarms.AlarmList(self.journal, self.wall)
        self.assertEqual(sorted(before, key=lambda a: a["key"]), sorted(again.listed(), key=lambda a: a["key"]))
        again.look("/a", {(c, ""): ("warning", c) for c in "xyzw"}, 5.0)  # what was there goes on: it has not come again
        self.assertEqual([1, 1, 1, 1], [a.count for a in again.alarms.values()])


    def test_no_event_of_the_list_chatters_and_each_has_a_remedy(self):
        """Warnings and errors of docs/events.md, coming and going in many rhythms for five minutes: within a minute an alarm comes twice at most."""
        rows = re.findall(r"^\| `(\w+)` \| (\w+) \|[^|]*\|[^|]*\| ([^|]*) \|$", (TOP / "docs/events.md").read_text(encoding="utf-8"), re.MULTILINE)
        loud = [(code, severity, remedy) for code, severity, remedy in rows if severity != "info"]
        self.assertGreater(len(loud), 40)
        for code, severity, remedy in loud:
            self.assertNotIn(remedy.strip(), ("", "none"), code)
        self.assertEqual(set(), {c for c in alarms.CONSEQUENCES if c not in {code for code, _, _ in rows}})
        for code, severity, _ in loud:
            for on, off in ((0.2, 0.2), (0.3, 1.0), (1.0, 4.9), (2.0, 5.2), (5.0, 5.5), (10.0, 20.0)):
                self.list.alarms.clear()
                self.now, came, count = self.now + 1000.0, [], 0
                begin = self.now
                while self.now < begin + 300.0:
                    there = (self.now - begin) % (on + off) < on
                    self.look(*([code] if there else []), seconds=min(on, off, 0.5), severity=severity)
                    alarm = self.list.alarms.get(f"/a|{code}|")
                    if alarm and alarm.count > count:
                        count = alarm.count
                        came.append(self.now)
                if code not in alarms.OF_SILENCE or on >= 5.0:
                    self.assertTrue(came, (code, on, off))
                elif on <= alarms.ON_DELAY:
                    self.assertFalse(came, (code, on, off))
                for first, third in zip(came, came[2:]):
                    self.assertGreaterEqual(third - first, alarms.CHATTER, (code, on, off))


class Contrast(unittest.TestCase):
    """Text on what may lie behind it, by the style sheet: at least 4.5 to 1 (WCAG 2.1); what has faded is no text to be read (.gone, .away)."""

    SHEET = (TOP / "python/panel/web/app.css").read_text(encoding="utf-8")
    SURFACES = ("var(--page)", "var(--card)", "var(--field)", "#c6cbd1")  # the last: the header

    def colour(self, text):
        named = re.fullmatch(r"var\((--\w+)\)", text.strip())
        if named:
            text = re.search(named[1] + r": (#\w+)", self.SHEET)[1]
        digits = text.strip().lstrip("#")
        digits = "".join(2 * d for d in digits) if len(digits) == 3 else digits
        parts = [int(digits[i:i + 2], 16) / 255.0 for i in (0, 2, 4)]
        return sum(f * (v / 12.92 if v <= 0.03928 else ((v + 0.055) / 1.055) ** 2.4) for f, v in zip((0.2126, 0.7152, 0.0722), parts))

    def ratio(self, front, back):
        front, back = self.colour(front), self.colour(back)
        return (max(front, back) + 0.05) / (min(front, back) + 0.05)

    def test_known_ratios(self):
        self.assertAlmostEqual(21.0, self.ratio("#000", "#ffffff"))
        self.assertAlmostEqual(4.54, self.ratio("#767676", "#fff"), 2)

    def test_of_all_rules(self):
        rules = re.findall(r"([^{}]+)\{([^{}]*)\}", re.sub(r"/\*.*?\*/", "", self.SHEET, flags=re.S))
        seen = 0
        for selector, body in rules:
            front = re.search(r"(?<![\w-])color: ?(#\w+|var\(--\w+\))", body)
            back = re.search(r"background(?:-color)?: ?(#\w+|var\(--\w+\))", body)
            if front:
                seen += 1
                # In the header stand words and links of its own alone.
                for surface in [back[1]] if back else self.SURFACES[:3] if selector.strip().startswith("#banner") else self.SURFACES:
                    self.assertGreaterEqual(self.ratio(front[1], surface), 4.5, (selector.strip(), surface))
        self.assertGreater(seen, 15)

    def test_of_what_is_drawn(self):
        """Words and numbers in the trends, on a card or on the white of the plan."""
        text = (TOP / "python/panel/web/app.js").read_text(encoding="utf-8")
        drawn = set(re.findall(r'stroke: "(#\w{6})", grid', text)) | set(re.findall(r'fillStyle = "(#\w{6})"', text))
        self.assertGreaterEqual(len(drawn), 2)
        for colour in drawn:
            for surface in ("var(--card)", "#ffffff"):
                self.assertGreaterEqual(self.ratio(colour, surface), 4.5, colour)


class TheJournal(Folder):
    def test_what_was_cut_off_costs_one_line(self):
        journal = alarms.Journal(self.path)
        for i in range(5):
            journal.write({"kind": "note", "i": i})
        journal.close()
        with open(self.path, "r+b") as stream:
            stream.truncate(os.path.getsize(self.path) - 7)
        journal = alarms.Journal(self.path)
        self.assertEqual(1, journal.damaged)
        self.assertEqual(5, journal.write({"kind": "note", "i": 5})["n"])
        journal.close()
        with open(self.path, encoding="utf-8") as stream:
            lines = stream.read().splitlines()
        self.assertEqual(5, json.loads(lines[-1])["i"])
        self.assertEqual(6, len(lines))

    def test_a_large_one_is_turned_and_still_read(self):
        journal = alarms.Journal(self.path, largest=2000)
        for i in range(200):
            journal.write({"kind": "note", "i": i})
        journal.close()
        again = alarms.Journal(self.path)
        self.assertGreater(len(again.files()), 3)
        self.assertEqual(list(range(200)), [e["i"] for e in again.latest(1000)])
        self.assertEqual([99], [e["i"] for e in again.latest(1, before=101)])
        again.close()


class TheTable(unittest.TestCase):
    """trajectory.csv, of many rows, while it is being written."""

    def read(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "trajectory.csv")
            with open(path, "w", encoding="utf-8", newline="") as stream:
                stream.write(text)
            return history.read_csv(path)

    def test_each_number_is_where_it_was_written(self):
        dice = random.Random(8)
        for _ in range(20):
            rows = [[dice.choice((math.nan, dice.gauss(0.0, 10.0 ** dice.randrange(-9, 9)), float(dice.randrange(99)))) for _ in range(7)] for _ in range(dice.randrange(2000, 9000))]
            end = dice.choice(("\n", "\r\n"))
            text = end.join(["time[h],y[mg/l],c,d,e,f,g[-]"] + [",".join(dice.choice(("", "nan")) if v != v else repr(v) for v in row) for row in rows] + [dice.choice(("", "1,2"))])
            names, units, table = self.read(text)
            self.assertEqual((["time", "y", "c", "d", "e", "f", "g"], "mg/l"), (names, units["y"]))
            numpy.testing.assert_array_equal(numpy.array(rows), table)

    def test_what_is_no_table_is_refused(self):
        for rows in ("1,x\n", "1,2x\n", "1,2,3\n", "1\n", "1,2,3\n4\n", "1 2,3\n", "1,2\n\n"):
            with self.assertRaises(ValueError, msg=rows):
                self.read("time[h],y\n" + rows)
        self.assertEqual(0, self.read("")[2].size + self.read("time[h],y\n1,2")[2].size)


class TheHistory(unittest.TestCase):
    def test_rows_find_their_place_in_any_order(self):
        for seed in range(20):
            dice = random.Random(seed)
            first, n = dice.randrange(10000), dice.randrange(1, 9000)
            steps = list(range(first, first + n))
            dice.shuffle(steps)
            kept = history.History(["a", "b"])
            for k in steps:
                kept.put(k, {"a": k % 1000}, wall=float(k))
                kept.put(k, {"b": -(k % 1000)})
            at, values, wall = kept.rows(0, 10 ** 9)
            self.assertEqual(list(range(first, first + n)), at.tolist())
            self.assertTrue((values[:, 0] == at % 1000).all() and (values[:, 1] == -(at % 1000)).all() and (wall == at).all())
            self.assertEqual([], kept.gaps("a"))

    def test_gaps_are_found_and_peaks_are_never_lost(self):
        for seed in range(20):
            dice = random.Random(seed)
            kept, n = history.History(["a"]), dice.randrange(2000, 30000)
            for k in range(n):
                kept.put(k, {"a": math.sin(k / 100.0)})
            peak = dice.randrange(n)
            kept.put(peak, {"a": 50.0})
            steps, values, _ = kept.drawn(0, n, 500)
            self.assertLessEqual(len(steps), 520)
            self.assertEqual(50.0, float(values.max()))
            self.assertEqual(n - 1, int(steps[-1]))
            self.assertTrue((numpy.diff(steps) >= 0).all())
            hole = dice.randrange(1, n - 10)
            for k in range(hole, hole + 5):
                kept.get(k)[0][0] = math.nan
            self.assertEqual([(hole, hole + 4)], kept.gaps("a"))

    def test_a_day_of_ten_samples_a_second_fits_into_100_mb(self):
        columns = [f"c{i}" for i in range(20)]  # 3 outputs, 2 inputs, 4 disturbances and what belongs to them
        kept = history.History(columns, 100e6)
        for number in range(0, 864000, history.CHUNK):
            kept.put(number, {"c0": 1.0})
        self.assertEqual(0, kept.first)
        self.assertLessEqual(kept.bytes(), 100e6)

    def test_it_forgets_the_oldest(self):
        kept = history.History(["a"], 2 * history.CHUNK * 12)
        for k in range(0, 10 * history.CHUNK, 7):
            kept.put(k, {"a": 1.0})
        kept.put(0, {"a": 2.0})
        self.assertEqual(2, len(kept.chunks))
        self.assertEqual(8 * history.CHUNK, kept.first)
        kept.put(10 ** 12, {"a": 1.0})  # far ahead: no memory for what lies between
        self.assertLessEqual(len(kept.chunks), 2)


class Numbers(unittest.TestCase):
    def test_german_and_english(self):
        for text, decimal, value in (("1234.5", ".", 1234.5), ("1234,5", ",", 1234.5), ("1,234.5", ".", 1234.5), ("1.234,5", ",", 1234.5), ("1 234,5", ",", 1234.5),
                                     ("-0,5", ",", -0.5), ("\u22122", ".", -2.0), ("1.234.567", ",", 1234567.0), ("1,234,567", ".", 1234567.0), ("1e-3", ".", 1e-3),
                                     ("1,5e3", ",", 1500.0), ("0,125", ".", 0.125), ("0.125", ",", 0.125), ("1,234", ",", 1.234), ("1.234", ".", 1.234), ("1,5", ".", 1.5),
                                     (" 7 ", ".", 7.0), ("+3", ".", 3.0), (5, ".", 5.0), ("12\u202f345,5", ",", 12345.5), ("1.234,5", ".", 1234.5)):
            self.assertEqual(value, asked.parse_number(text, decimal), text)

    def test_what_may_be_two_numbers_or_none_is_refused(self):
        for text, decimal in (("1.234", ","), ("1,234", "."), ("12.345", ","), ("", "."), ("-", "."), ("abc", "."), ("1.2.3", "."), ("1,2,3", "."), ("1.234,567.8", "."), ("nan", "."),
                              ("inf", "."), ("1e999", "."), ("1e", "."), ("0x10", "."), ("1_000", "."), ("1..2", "."), ("9" * 60, "."), (True, "."), (None, "."), ([], "."), ("1,23.4", "."), ("٣", ".")):
            with self.assertRaises(asked.Refused, msg=text):
                asked.parse_number(text, decimal)

    def test_random_numbers_come_back(self):
        dice = random.Random(7)
        for _ in range(3000):
            value = round(dice.uniform(-1e6, 1e6), dice.randrange(0, 3))
            english = f"{value:,.2f}"
            german = english.translate(str.maketrans(",.", ".,"))
            self.assertEqual(value, asked.parse_number(english, "."))
            self.assertEqual(value, asked.parse_number(german, ","))


class Who(Folder):
    def users(self):
        path = os.path.join(self.folder.name, "users.json")
        access.write_user(path, "olga", "operate", password="correct horse")
        access.write_user(path, "robot", "engineer", token="t" * 40)
        return path

    def test_there_is_no_default_user_and_no_secret_in_the_file(self):
        self.assertEqual({}, access.read_users(os.path.join(self.folder.name, "none.json")))
        path = self.users()
        with open(path, encoding="utf-8") as stream:
            text = stream.read()
        self.assertNotIn("correct horse", text)
        self.assertNotIn("t" * 40, text)
        self.assertEqual(0, stat.S_IMODE(os.stat(path).st_mode) & 0o077)
        with self.assertRaisesRegex(access.AccessError, "password"):
            access.write_user(path, "x", "view", password="short")
        with self.assertRaisesRegex(access.AccessError, "role"):
            access.write_user(path, "x", "root", password="long enough")

    def test_a_file_that_others_may_read_or_that_is_odd_is_an_error(self):
        path = self.users()
        os.chmod(path, 0o644)
        with self.assertRaisesRegex(access.AccessError, "owner"):
            access.read_users(path)
        for odd in ("[]", "{", '{"x": {"role": "root", "password": "scrypt$"}}', '{"x": {"role": "view"}}', '{"x": {"role": "view", "password": "plain"}}', '{"x": 1}'):
            with open(path, "w", encoding="utf-8") as stream:
                stream.write(odd)
            os.chmod(path, 0o600)
            with self.assertRaises(access.AccessError, msg=odd):
                access.read_users(path)

    def test_passwords_tokens_and_tries(self):
        clock = Clock()
        who = access.Access(access.read_users(self.users()), clock=clock)
        key, why = who.login("olga", "correct horse", "here")
        self.assertEqual("", why)
        self.assertEqual("operate", who.session(key).role)
        for name, password in (("olga", "wrong"), ("nobody", "correct horse"), ("robot", "t" * 40), (None, 1), ("olga", "x" * 1000)):
            self.assertIsNone(who.login(name, password, "there")[0])
        self.assertEqual(("robot", "engineer"), who.token("t" * 40, "here"))
        self.assertIsNone(who.token("u" * 40, "here"))
        for _ in range(10):
            answer = who.login("olga", "wrong", "elsewhere")
        self.assertIn("too many", answer[1])
        self.assertIn("too many", who.login("olga", "correct horse", "a third one")[1])  # by name as well
        clock.now += access.IDLE + 1
        self.assertIsNone(who.session(key))

    def test_of_one_address_only_wrong_logins_count_as_tries(self):
        path = self.users()
        shift = [f"operator_{i}" for i in range(8)]  # that changes, at the one screen of the control room
        for name in shift:
            access.write_user(path, name, "operate", password="correct horse")
        who = access.Access(access.read_users(path), clock=Clock())
        for name in shift:
            self.assertEqual("", who.login(name, "correct horse", "here")[1])
        for i in range(5):  # right ones between give no more wrong ones
            self.assertIn("wrong", who.login(f"nobody_{i}", "x" * 12, "here")[1])
            self.assertEqual("too many" in who.login(shift[i], "correct horse", "here")[1], i == 4)
        for _ in range(5):  # nobody fills the list of sessions
            answer = who.login("olga", "correct horse", "there")
        self.assertEqual("", answer[1])
        self.assertIn("too many", who.login("olga", "correct horse", "there")[1])

    def test_sessions_are_bounded_and_end(self):
        clock = Clock()
        who = access.Access(access.read_users(self.users()), clock=clock)
        who.tries = access.Bucket(1e9, 1e9)
        user = who.users["olga"]
        access_fits, access.fits = access.fits, lambda *_: True
        try:
            keys = [who.login("olga", "x", "here")[0] for _ in range(access.MOST_SESSIONS + 20)]
        finally:
            access.fits = access_fits
        self.assertEqual(access.MOST_SESSIONS, len(who.sessions))
        self.assertEqual(len(keys), len(set(keys)))
        who.logout(keys[-1])
        self.assertIsNone(who.session(keys[-1]))
        self.assertIn("password", user)

    def test_nothing_wrong_passes(self):
        """Every combination of one or more wrong parts is refused, and only the right one goes on."""
        session = access.Session("olga", "operate", 0.0)
        caller, robot = access.Caller("olga", "operate", session), access.Caller("robot", "operate", by_token=True)
        hosts = access.allowed_hosts("127.0.0.1", 8080)
        right = {"method": ["POST"], "host": ["localhost:8080", "127.0.0.1:8080"], "origin": ["http://HOST"], "kind": ["application/json", "application/json; charset=utf-8"],
                 "fetch_site": [None, "same-origin"], "xsrf": [session.xsrf]}
        wrong = {"method": ["GET", "PUT", "DELETE", ""], "host": ["evil.example:8080", "localhost", "localhost:81", None, ""], "origin": [None, "null", "http://evil.example", "http://localhost:81", ""],
                 "kind": ["text/plain", "application/x-www-form-urlencoded", None], "fetch_site": ["cross-site", "same-site"], "xsrf": [None, "", "x", session.xsrf + "x"]}
        passed = 0
        for choice in itertools.product(*[[(v, True) for v in right[k]] + [(v, False) for v in wrong[k]] for k in right]):
            given = dict(zip(right, (v for v, _ in choice)))
            given["origin"] = given["origin"].replace("HOST", str(given["host"])) if given["origin"] else given["origin"]
            good = all(ok for _, ok in choice)
            answer = access.judge(**given, caller=caller, hosts=hosts)
            self.assertEqual(good, answer == "", given)
            passed += good
        self.assertEqual(8, passed)
        self.assertEqual("", access.judge("POST", "localhost:8080", None, "application/json", None, None, robot, hosts))
        self.assertNotEqual("", access.judge("POST", "localhost:8080", "http://evil.example", "application/json", None, None, robot, hosts))

    def test_every_verb_has_a_role_that_viewers_have_not(self):
        for verb, role in asked.VERBS.items():
            for mine, may in (("none", False), ("view", False), ("operate", role == "operate"), ("engineer", True)):
                self.assertEqual(may, access.Caller("x", mine).may(role), verb)

    def test_rates_are_bounded_for_each_and_in_memory(self):
        bucket = access.Bucket(per_s=2.0, burst=3, most=10)
        self.assertEqual([True, True, True, False], [bucket.take("a", 0.0) for _ in range(4)])
        self.assertTrue(bucket.take("b", 0.0))
        self.assertTrue(bucket.take("a", 0.6))
        for i in range(1000):
            bucket.take(i, 1.0)
        self.assertLessEqual(len(bucket.left), 10)


def signal(name="y", unit="mg/l", lower=0.0, upper=100.0):
    return types.SimpleNamespace(name=name, unit=unit, lower=lower, upper=upper)


class Words(unittest.TestCase):
    def test_outputs(self):
        inf = math.inf
        for value, quality, causes, low, high, word in ((5, 0, set(), -inf, inf, state.GOOD), (5, 1, set(), -inf, inf, state.HELD), (5, 2, set(), -inf, inf, state.BAD), (math.nan, 0, set(), -inf, inf, state.BAD),
                                                        (5, 0, {"signal_frozen"}, -inf, inf, state.PREDICTED), (5, 0, {"signal_jumped"}, -inf, inf, state.HELD), (9, 0, set(), -inf, 8, state.HIGH),
                                                        (1, 0, set(), 2, inf, state.LOW), (101, 0, set(), -inf, inf, state.HIGH)):
            answer = state.output_status(signal(), value, quality, causes, low, high)
            self.assertEqual(word, answer[0], answer)
            self.assertEqual(word == state.GOOD, answer[1] == "")

    def test_inputs_say_which_limit_and_what_the_law_asks(self):
        def say(value, before=50.0, source=1, law=None, move=math.inf, guard=None, causes=frozenset(), why=""):
            return state.input_status(signal("u"), value, before, source, law, 0.0, 100.0, move, guard, causes, why)
        self.assertEqual((state.GOOD, "", []), say(50.0))
        word, reason, active = say(100.0, source=2, law=120.0)
        self.assertEqual((state.LIMITED, ["upper"]), (word, active))
        self.assertIn("120", reason)
        self.assertEqual(["lower"], say(0.0)[2])
        self.assertEqual(["move"], say(52.5, move=2.5)[2])
        self.assertEqual(["guard"], say(60.0, guard=(20.0, 60.0))[2])
        self.assertEqual(["ahead"], say(55.0, source=2, law=70.0, why="x would pass")[2])
        self.assertEqual([state.HELD, state.BAD, state.BAD, state.BAD], [say(50.0, source=4)[0], say(50.0, source=6)[0], say(50.0, causes={"input_stuck"})[0], say(math.nan)[0]])
        self.assertEqual(state.GOOD, say(50.0, source=5)[0])


def matrix(rows):
    array = numpy.array(rows, dtype=float)
    return types.SimpleNamespace(rows=array.shape[0], cols=array.shape[1], data=array.ravel().tolist())


def prediction(n=5, law=3.0, state_now=1.0):
    """x(k+1) = 0.5 x + u, y = x, u = law."""
    return types.SimpleNamespace(step=10, run_id=1, state=[state_now], A=matrix([[0.5]]), B=matrix([[1.0]]), C=matrix([[1.0]]), K=matrix([[0.0]]), offset_state=[0.0], offset_output=[0.0],
                                 feedforward=matrix([[law] * n]), reference=matrix([[2.0] * n]), setpoint=[2.0], input_previous=[0.0], input_base_unclipped=[law])


class Plans(unittest.TestCase):
    def test_the_base_law_and_what_the_limits_leave(self):
        plan = predict.Plan(prediction(), numpy.array([0.0]), numpy.array([2.0]), numpy.array([1.5]))
        self.assertEqual([3.0] * 5, plan.base_input[:, 0].tolist())
        self.assertEqual([1.5, 2.0, 2.0, 2.0, 2.0], plan.input[:, 0].tolist())
        self.assertEqual([2.0, 3.0, 3.5], plan.output[:3, 0].tolist())
        self.assertEqual([[2.0]], plan.gains().tolist())
        self.assertEqual([0.5], [p.real for p in plan.poles()])
        planned = predict.Plan(prediction(), numpy.array([0.0]), numpy.array([2.0]), numpy.array([9.0]), matrix([[1.0, 1.25, 1.5, 1.5, 1.5]]))
        self.assertTrue(planned.constrained)
        self.assertEqual([1.0, 1.25], planned.input[:2, 0].tolist())

    def test_the_first_limit_is_the_reason(self):
        plan = predict.Plan(prediction(), numpy.array([0.0]), numpy.array([99.0]), numpy.array([math.inf]))
        limits = {"input": [(0.0, 99.0)], "move": [math.inf], "output": [(-math.inf, 5.5)]}
        self.assertEqual(4, state.first_limit(plan, [signal()], [signal("u")], limits)[0])
        limits["input"] = [(0.0, 2.0)]
        ahead, words = state.first_limit(plan, [signal()], [signal("u")], limits)
        self.assertEqual((0, True), (ahead, "upper limit is 2" in words))
        limits = {"input": [(0.0, 99.0)], "move": [math.inf], "output": [(-math.inf, math.inf)]}
        self.assertIsNone(state.first_limit(plan, [signal()], [signal("u")], limits))

    def test_errors_of_plans_are_counted_by_samples_ahead(self):
        errors = predict.Errors(1)
        for k in range(60):
            plan = predict.Plan(prediction(3), numpy.array([0.0]), numpy.array([9.0]), numpy.array([9.0]))
            plan.step, plan.output = k, numpy.array([[1.0], [2.0], [3.0]])
            errors.add(plan)
            errors.came(k, [0.0])
        self.assertEqual([[1.0], [2.0], [3.0]], errors.rms(3).tolist())
        self.assertEqual(3, len(errors.rms(3)))
        self.assertIsNone(predict.Errors(1).rms(3))

    def test_trust_is_one_in_the_data_and_fades(self):
        model = types.SimpleNamespace(outputs=[signal()], inputs=[signal("u")], disturbances=[], domain_centres=[10.0, 0.0, 20.0, 10.0], domain_scale=[10.0, 10.0], domain_radius=0.1)
        trust = predict.Trust(model)
        self.assertEqual([1.0, 1.0, 0.0, 0.0], trust.of([[10.0, 5.0], [20.5, 5.0], [40.0, 5.0], [math.nan, 5.0]]).tolist())
        half = trust.of([[20.0 + 10.0 * (0.1 + 0.125), 5.0]])[0]
        self.assertAlmostEqual(0.5, half)
        self.assertLess(trust.of([[10.0, 13.0]])[0], 1.0)  # an input beyond all data
        ranged = predict.Trust(types.SimpleNamespace(outputs=[signal()], inputs=[], disturbances=[], domain_centres=[], domain_scale=[], domain_radius=0.0))
        self.assertAlmostEqual(0.5, ranged.of([[112.5]])[0])

    def test_rules_by_hand(self):
        self.assertEqual(0.0, predict.log_degree(0, [0, 1, 2, 3], 1.5))
        self.assertAlmostEqual(-7.0, predict.log_degree(0, [0, 1, 2, 3], 3.0))
        self.assertAlmostEqual(-0.5, predict.log_degree(1, [1.0, 2.0], 3.0))
        self.assertAlmostEqual(math.log(0.5), predict.log_degree(2, [0, 1, 2], 0.5))
        self.assertEqual(-math.inf, predict.log_degree(3, [0, 1, 2, 3], 4.0))
        sets = lambda c: types.SimpleNamespace(center=[], inverse_covariance=[], antecedents=[types.SimpleNamespace(shape=1, parameters=[c, 1.0])])  # noqa: E731
        weights, _ = predict.firing(types.SimpleNamespace(rules=[sets(0.0), sets(2.0)]), [1.0])
        self.assertEqual([0.5, 0.5], weights)


class Tool(unittest.TestCase):
    def test_the_one_of_this_tree_comes_first(self):
        with unittest.mock.patch("os.access", lambda path, _: True):
            self.assertEqual(str(TOP / "devel/lib/fmbpc/fmbpc_tool"), tool.tool_path())


class ThePage(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_page(self, *words):
        done = subprocess.run([sys.executable, str(TOP / "python/panel/page.py"), *words], check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        return done.returncode, done.stdout + done.stderr

    def record(self, rows="0,1,2,1.5\n0.5,1.5,2,1.25\n1,,3,1\n", summary=None):
        with open(os.path.join(self.folder.name, "trajectory.csv"), "w", encoding="utf-8") as stream:
            stream.write("time[h],y[mg/l],u[m3/h],y_setpoint[mg/l]\n" + rows)
        with open(os.path.join(self.folder.name, "summary.json"), "w", encoding="utf-8") as stream:
            stream.write(summary if summary is not None else json.dumps({"title": "</script><b>", "complete": True, "outputs": {"y": {"unit": "mg/l", "ise": 1.0}}, "inputs": {"u": {}}, "events": []}))

    def test_one_file_that_loads_nothing_and_holds_the_run(self):
        self.record()
        self.assertEqual(0, self.run_page(self.folder.name)[0])
        with open(os.path.join(self.folder.name, "page.html"), encoding="utf-8") as stream:
            html = stream.read()
        self.assertNotRegex(html, r"<(script|link|img)[^>]+(src|href)=")
        self.assertEqual(3, html.count("</script>"))  # no title ends one
        given = json.loads(html.split("window.FMBPC_RUN=")[1].split("</script>")[0])
        self.assertEqual([0, 1, 2], given["series"]["steps"])
        self.assertEqual([1.0, 1.5, None], given["series"]["data"][given["series"]["columns"].index("y")])
        self.assertEqual((1800.0, True), (given["series"]["dt"], given["complete"]))

    def test_what_is_no_run_is_one_line(self):
        for make in (lambda: None, lambda: self.record(summary="{"), lambda: self.record(rows="1,2\n"), lambda: self.record(rows="")):
            make()
            code, words = self.run_page(self.folder.name)
            self.assertEqual(1, code, words)
            self.assertEqual(1, words.strip().count("\n") + 1, words)
            self.assertTrue(words.startswith("fmbpc: page: "), words)
        self.assertEqual(1, self.run_page("/nowhere")[0])


if __name__ == "__main__":
    unittest.main()
