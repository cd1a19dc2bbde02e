"""The panel's process and a headless Chromium before it: what test, benchmark and pictures share."""
import http.client
import json
import os
import subprocess
import sys
import time
import urllib.parse

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
SCRIPT = os.path.join(TOP, "scripts", "panel.py")


class PanelProcess:
    """scripts/panel.py on a port of its own; `env`: of a master, else that of this process."""

    def __init__(self, port, data, *parameters, users="/nowhere", env=None):
        self.port, self.env = int(port), env
        self.words = [sys.executable, SCRIPT, f"_port:={port}", f"_data:={data}", f"_users:={users}", "__name:=panel", "__ns:=/", *parameters]
        self.start()

    def start(self):
        self.process = subprocess.Popen(self.words, env=self.env)
        end = time.monotonic() + 60.0
        while not self.answers():
            assert self.process.poll() is None and time.monotonic() < end, "the panel does not answer"
            time.sleep(0.05)

    @property
    def pid(self):
        return self.process.pid

    def answers(self):
        try:
            return self.get("/api/me") is not None
        except (OSError, http.client.HTTPException):
            return False

    def get(self, path, **query):
        """The answer, read as JSON."""
        connection = http.client.HTTPConnection("localhost", self.port, timeout=20)
        try:
            connection.request("GET", path + ("?" + urllib.parse.urlencode(query) if query else ""))
            answer = connection.getresponse()
            text = answer.read()
            return json.loads(text) if answer.status == 200 else None
        finally:
            connection.close()

    def kill(self):
        self.process.kill()
        self.process.wait()

    def holes(self, loop, columns, first, last):
        """Samples of first..last that are not there, and values of these columns that are none."""
        count = 0
        for begin in range(first, last + 1, 3000):
            end = min(begin + 2999, last)
            got = self.get("/api/history", loop=loop, points=4000, **{"from": begin, "to": end})
            if got is None:
                return last - first + 1
            count += end - begin + 1 - len(got["steps"])
            count += sum(v is None for name in columns for v in got["data"][got["columns"].index(name)])
        return count


def browser():
    import selenium
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    options = webdriver.ChromeOptions()
    for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1280,1000", "--lang=en-US"):
        options.add_argument(word)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    if selenium.__version__.startswith("3."):  # Debian 11
        return webdriver.Chrome("/usr/bin/chromedriver", options=options)
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def size(page, width, height):
    page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500})
