#!/usr/bin/python3
"""The operator's panel as somebody uses it: a browser loads, looks, clicks, steers a loop over topics and sees the effect."""
import http.client
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from fmbpc.msg import CommandEffect, ControlAction, Setpoint, Tracking
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

import panel_page
import exchange

PASSWORD = "correct horse"
AWAY_S = 60 if os.environ.get("FMBPC_LONG_TESTS") else 6

# Where these parts of the page were since then, in pixels of the page, unless somebody types into a field of it.
PLACES = """
const parts = %s, seen = window.seenAt = Object.fromEntries(parts.map((id) => [id, []]));
setInterval(() => {
  if (document.querySelector("[data-editor]")) return;
  for (const id of parts) {
    const at = document.getElementById(id).getBoundingClientRect().top + scrollY;
    if (!seen[id].some((y) => Math.abs(y - at) < 2)) seen[id].push(at);
  }
}, 10);
"""

# Text whose contrast with what is behind it is below 4.5 to 1 (WCAG 2.1), of all that is seen.
CONTRAST = """
const lum = (c) => { const p = c.match(/[\\d.]+/g).map(Number), f = (v) => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; }; return [0.2126 * f(p[0]) + 0.7152 * f(p[1]) + 0.0722 * f(p[2]), p.length > 3 ? p[3] : 1]; };
const bad = [];
for (const e of document.querySelectorAll('body *')) {
  if (![...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) || !e.getClientRects().length) continue;
  let b = e; while (b && lum(getComputedStyle(b).backgroundColor)[1] === 0) b = b.parentElement;
  const [front] = lum(getComputedStyle(e).color), [back] = lum(getComputedStyle(b || document.documentElement).backgroundColor);
  const ratio = (Math.max(front, back) + 0.05) / (Math.min(front, back) + 0.05);
  if (ratio < 4.5) bad.push(e.tagName + '.' + e.className + ' ' + e.textContent.slice(0, 30) + ' ' + ratio.toFixed(2));
}
return bad;
"""
HOLES = """
const s = window.fmbpcPanel.series['/a']; if (!s) return null;
const y = s.data[s.columns.indexOf('x')], u = s.data[s.columns.indexOf('q_r')];
const far = 2 + 4 * (s.steps[s.steps.length - 1] - s.steps[0]) / s.steps.length;
let holes = 0; for (let i = 1; i < s.steps.length - 2; ++i) if (y[i] === null || u[i] === null || s.steps[i] - s.steps[i - 1] > far) ++holes;
return [s.steps[0], s.steps[s.steps.length - 1], holes];
"""


class Line:
    """Between a browser and the panel: it can be cut."""

    def __init__(self, port, panel_port):
        self.port, self.panel_port, self.whole, self.ends = port, panel_port, True, []
        self.server = socket.create_server(("localhost", int(port)))
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            near, _ = self.server.accept()
            if not self.whole:
                near.close()
                continue
            far = socket.create_connection(("localhost", int(self.panel_port)))
            self.ends += [near, far]
            for source, target in ((near, far), (far, near)):
                threading.Thread(target=self.carry, args=(source, target), daemon=True).start()

    def carry(self, source, target):
        try:
            while self.whole:
                data = source.recv(65536)
                if not data:
                    break
                target.sendall(data)
        except OSError:
            pass
        for end in (source, target):
            end.close()

    def cut(self):
        self.whole = False
        for end in self.ends:
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:  # closed before
                pass
        self.ends.clear()

    def mend(self):
        self.whole = True


class Panel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.users = os.path.join(cls.folder.name, "users.json")
        for name, role in (("olga", "operate"), ("emil", "engineer")):
            subprocess.run([sys.executable, panel_page.SCRIPT, "--users", cls.users, "--add-user", name, role], input=PASSWORD + "\n", check=True, text=True, stdout=subprocess.DEVNULL)
        cls.port = exchange.free_port()
        cls.line = Line(exchange.free_port(), cls.port)
        cls.panel = panel_page.PanelProcess(cls.port, cls.folder.name + "/data", f'_hosts:=["localhost:{cls.line.port}"]', users=cls.users)
        cls.page = panel_page.browser()

    @classmethod
    def tearDownClass(cls):
        cls.page.quit()
        cls.panel.kill()
        cls.folder.cleanup()

    def setUp(self):
        self.clicks = 0
        panel_page.size(self.page, 1280, 1000)

    def open(self, path="#/"):
        self.page.get("about:blank")
        self.page.get(f"http://localhost:{self.port}/{path}")

    def see(self, how, what, text=""):
        """The first visible element that is there and holds the text."""
        found = []

        def there():
            try:
                found[:] = [e for e in self.page.find_elements(how, what) if e.is_displayed() and text in e.text]
            except StaleElementReferenceException:
                return False
            return bool(found)
        exchange.wait_until(there, f"{what} {text} on the page", 30.0)
        return found[0]

    def click(self, how, what, text=""):
        self.clicks += 1
        self.see(how, what, text).click()

    def button(self, label):
        return By.XPATH, f"//button[normalize-space(.)='{label}']"

    def login(self, name):
        self.page.delete_all_cookies()
        self.open()
        self.see(*self.button("Log in")).click()
        self.see(By.NAME, "name").send_keys(name)
        self.page.find_element(By.NAME, "password").send_keys(PASSWORD + Keys.ENTER)
        self.see(By.ID, "who", name)
        self.clicks = 0

    def type_into(self, key, text):
        self.click(By.CSS_SELECTOR, f"[data-key='{key}']")
        field = self.see(By.CSS_SELECTOR, "[data-editor] input")
        field.send_keys(text)
        return field

    def said(self, text):
        return self.see(By.ID, "said", text).text

    def test_1_it_shows_the_loop_and_lets_nobody_touch_it(self):
        self.page.delete_all_cookies()
        self.open()
        self.click(By.CSS_SELECTOR, "a.tile", "Activated sludge")
        rows = self.see(By.ID, "outputs", "x [mg/l]")
        self.assertIn("good", rows.text)
        exchange.wait_until(lambda: len(self.page.find_elements(By.CSS_SELECTOR, ".chart canvas")) == 5, "five charts")
        for label in ("Manual", "Auto", "Hold schedule"):
            self.assertFalse(self.see(*self.button(label)).is_enabled())
        self.assertFalse(self.see(By.CSS_SELECTOR, "[data-key='set x']").is_enabled())
        loaded = self.page.execute_script("return performance.getEntriesByType('resource').map((e) => e.name)")
        self.assertEqual([], [name for name in loaded if not name.startswith(f"http://localhost:{self.port}/")])
        for path in ("#/", "#/loop/%2Fa", "#/loop/%2Fa/model", "#/alarms", "#/journal"):
            for width in (1280, 360):
                panel_page.size(self.page, width, 900)
                self.open(path)
                self.see(By.CSS_SELECTOR, "main h1, main h2")
                time.sleep(1.0)  # what is drawn over and over has no end that could be awaited
                self.assertLessEqual(self.page.execute_script("return document.documentElement.scrollWidth"), width, path)
                self.assertEqual([], self.page.execute_script(CONTRAST), (path, width))
        self.assertEqual([], [e for e in self.page.get_log("browser") if e["level"] == "SEVERE"])

    def test_2_a_setpoint_in_three_clicks_in_force_since_the_sample_that_is_said(self):
        self.login("olga")
        effects, tracking = exchange.Listener("setpoint_effect", CommandEffect), exchange.Listener("tracking", Tracking)
        self.click(By.CSS_SELECTOR, "a.tile")
        self.type_into("set x", "2100")
        self.click(*self.button("Set"))
        step = int(self.said("since sample").split("since sample ")[1].split()[0])
        self.assertLessEqual(self.clicks, 3)
        self.assertEqual(step, effects.wait(lambda m: list(m.name) == ["x"]).step)
        self.assertEqual(2100.0, tracking.wait(lambda t: t.step == step).setpoint[1])
        self.see(By.ID, "outputs", "2100")
        field = self.type_into("set x", "1,234" + Keys.ENTER)  # two readings: nothing is sent
        self.assertIn("may be 1234 or 1.234", self.see(By.CSS_SELECTOR, ".reads", "may be").text)
        field.send_keys(Keys.ESCAPE)
        self.page.find_element(By.CSS_SELECTOR, "#who button").click()  # German
        self.type_into("set x", "2.050,5" + Keys.ENTER)
        self.assertEqual(2050.5, effects.wait(lambda m: m.step > step and list(m.name) == ["x"]).value[0])
        self.see(By.ID, "outputs", "2050,5")
        self.page.find_element(By.CSS_SELECTOR, "#who button").click()
        self.type_into("set x", "99999" + Keys.ENTER)
        self.assertIn("refused", self.said("refused"))
        self.click(By.XPATH, "//button[.='back to schedule']")
        self.said("released")

    def test_3_by_hand_and_back_in_three_clicks(self):
        self.login("olga")
        action = exchange.Listener("control_action", ControlAction)
        self.click(By.CSS_SELECTOR, "a.tile")
        self.click(*self.button("Manual"))
        step = int(self.said("manual since").split("since sample ")[1].split()[0])
        self.assertEqual(ControlAction.MANUAL, action.wait(lambda a: a.step == step).source)
        self.click(*self.button("Auto"))
        self.assertLessEqual(self.clicks, 3)
        step = int(self.said("auto since").split("since sample ")[1].split()[0])
        self.assertNotEqual(ControlAction.MANUAL, action.wait(lambda a: a.step == step).source)

    def test_4_why_the_valve_is_at_its_limit_and_an_alarm_that_is_acknowledged(self):
        self.login("olga")
        self.click(By.CSS_SELECTOR, "a.tile")
        self.see(By.CSS_SELECTOR, "#charts .u-legend")
        self.page.execute_script(PLACES % ["head", "outputs", "inputs", "charts", "disturbances"])
        self.see(*self.button("Manual")).click()
        self.said("manual since")
        self.type_into("input q_r", "9000" + Keys.ENTER)
        self.said("by hand since")
        self.assertIn("input_clamped", self.see(By.ID, "banner", "input_clamped").text)
        self.assertIn("upper limit 1600", self.see(By.CSS_SELECTOR, "#inputs td.reason", "upper").text)
        places = self.page.execute_script("return window.seenAt")
        self.assertEqual({part: 1 for part in places}, {part: len(tops) for part, tops in places.items()}, places)
        self.open()
        self.clicks = 0
        self.click(By.CSS_SELECTOR, "a.tile")
        self.assertIn("upper limit 1600", self.see(By.CSS_SELECTOR, "#inputs td.reason", "upper").text)
        self.click(By.CSS_SELECTOR, "#banner button")
        self.said("acknowledged")
        self.assertLessEqual(self.clicks, 3)
        self.open("#/alarms")
        self.see(By.ID, "alarmlist", "acknowledged by olga")
        self.open("#/loop/%2Fa")
        self.see(*self.button("Auto")).click()
        self.said("auto since")
        self.open("#/journal")
        self.see(By.ID, "entries", "input_clamped")
        self.see(By.ID, "entries", "by hand")

    def test_4a_on_a_phone_nothing_moves_under_the_thumb(self):
        panel_page.size(self.page, 360, 800)
        self.login("olga")
        self.click(By.CSS_SELECTOR, "a.tile")
        self.see(By.CSS_SELECTOR, "#charts .u-legend")
        self.page.execute_script(PLACES % ["head", "outputs", "inputs"])
        self.see(*self.button("Manual")).click()
        self.said("manual since")
        self.type_into("input q_r", "9000" + Keys.ENTER)
        self.said("by hand since")
        self.see(By.CSS_SELECTOR, "#inputs td.reason", "upper limit 1600")
        self.see(*self.button("Auto")).click()
        self.said("auto since")
        places = self.page.execute_script("return window.seenAt")
        self.assertEqual({part: 1 for part in places}, {part: len(tops) for part, tops in places.items()}, places)

    def test_5_settings_are_the_engineers(self):
        self.login("olga")
        self.open("#/loop/%2Fa/model")
        self.assertFalse(self.see(By.CSS_SELECTOR, "input[aria-label='coincidence_steps']").is_enabled())
        self.see(By.ID, "model", "Rules of x")
        self.login("emil")
        self.open("#/loop/%2Fa/model")
        field = self.see(By.CSS_SELECTOR, "input[aria-label='coincidence_steps']")
        exchange.wait_until(field.is_enabled, "the engineer's field")
        field.clear()
        field.send_keys("8")
        self.see(By.XPATH, "//tr[td='coincidence_steps']//button").click()
        self.said("coincidence_steps = 8")

    def test_6_keys_lead_everywhere(self):
        self.open()
        body = self.page.find_element(By.TAG_NAME, "body")
        for key, heading in (("a", "Alarms"), ("j", "Journal"), ("o", "Loops"), ("1", "Activated sludge")):
            body.send_keys(key)
            self.see(By.TAG_NAME, "h1", heading)

    def test_7_what_is_silent_is_said_in_two_seconds(self):
        self.open("#/loop/%2Fa")
        self.see(By.ID, "outputs", "x [mg/l]")
        plant = self.pid("/a/plant_simulator")
        os.kill(plant, signal.SIGSTOP)
        try:
            begin = time.monotonic()
            self.see(By.ID, "banner", "NO WORD from the plant")
            self.assertLess(time.monotonic() - begin, 3.0)  # of them 1 s of patience for a loaded machine
            exchange.wait_until(lambda: "away" in self.page.find_element(By.ID, "live").get_attribute("class"), "old values to look old")
        finally:
            os.kill(plant, signal.SIGCONT)
        exchange.wait_until(lambda: "NO WORD" not in self.page.find_element(By.ID, "banner").text, "the plant's word")
        os.kill(self.panel.pid, signal.SIGSTOP)
        try:
            begin = time.monotonic()
            self.see(By.ID, "banner", "NO CONNECTION")
            self.assertLess(time.monotonic() - begin, 3.0)
        finally:
            os.kill(self.panel.pid, signal.SIGCONT)
        exchange.wait_until(lambda: "NO CONNECTION" not in self.page.find_element(By.ID, "banner").text, "the panel's word")

    @staticmethod
    def pid(node):
        return xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(node)).getPid("/test")[2]

    def test_8_a_panel_that_was_killed_loses_nothing(self):
        self.open("#/loop/%2Fa")
        self.see(By.ID, "outputs", "x [mg/l]")
        listed = self.alarm_keys()
        self.panel.kill()
        self.see(By.ID, "banner", "NO CONNECTION")
        tracking = exchange.Listener("tracking", Tracking)
        away = tracking.wait().step
        tracking.wait(lambda t: t.step > away + 20)  # samples that no panel saw
        self.panel.start()
        exchange.wait_until(lambda: "NO CONNECTION" not in self.page.find_element(By.ID, "banner").text, "the panel's word")
        exchange.wait_until(lambda: self.panel.holes("/a", ("x", "x_reference", "q_r"), 0, away + 20) == 0, "a trend without holes", 40.0)
        self.sees_no_hole(away + 20)
        exchange.wait_until(lambda: self.alarm_keys() >= listed, "the alarms of before")

    def sees_no_hole(self, until):
        self.click(By.XPATH, "//button[.='whole run']")

        def whole():
            got = self.page.execute_script(HOLES)
            return got is not None and got[0] == 0 and got[1] > until and got[2] == 0
        exchange.wait_until(whole, "the whole trend in the browser", 40.0)

    def test_9_a_browser_that_was_offline_lacks_nothing(self):
        self.page.get(f"http://localhost:{self.line.port}/#/loop/%2Fa")
        self.see(By.ID, "outputs", "x [mg/l]")
        tracking, asked = exchange.Listener("tracking", Tracking), exchange.publisher("setpoint", Setpoint, "/a/fmbpc_controller")
        came = self.clamped()
        other = http.client.HTTPConnection("localhost", int(self.port))  # somebody who hears it all meanwhile
        self.addCleanup(other.close)
        other.request("GET", "/stream")
        self.assertEqual(200, other.getresponse().status)
        self.line.cut()
        try:
            self.see(By.ID, "banner", "NO CONNECTION")
            asked.publish(Setpoint(name=["x"], value=[9000.0], mode=Setpoint.OVERRIDE))
            away = tracking.wait().step
            away = tracking.wait(lambda t: t.step > away + 10 * AWAY_S, AWAY_S + exchange.PATIENCE).step
            self.assertEqual(came, self.clamped())
            asked.publish(Setpoint(mode=Setpoint.RELEASE))
        finally:
            self.line.mend()
        exchange.wait_until(lambda: "NO CONNECTION" not in self.page.find_element(By.ID, "banner").text, "the panel's word")
        self.sees_no_hole(away)
        exchange.wait_until(lambda: self.clamped() == came + 1, "the journal's entry of meanwhile")
        self.assertIn("/a|setpoint_clamped|x", self.alarm_keys())

    def clamped(self):
        """Entries of the page's journal that say that it came."""
        return self.page.execute_script("return window.fmbpcPanel.journal.filter((e) => e.code === 'setpoint_clamped' && e.what === 'came').length")

    def alarm_keys(self):
        """Of those that wait for a person."""
        waiting = "(a) => a.state === 'unacknowledged' || a.state === 'returned'"
        return set(self.page.execute_script(f"return window.fmbpcPanel.alarms.filter({waiting}).map((a) => a.key)"))


if __name__ == "__main__":
    rospy.init_node("operator_panel_test")
    rostest.rosrun("fmbpc", "operator_panel", Panel, sys.argv)
