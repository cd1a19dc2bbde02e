#!/usr/bin/python3
"""What the operator's panel costs: panel_bench.py [cost|equal|screen|memory|many|pictures]... [--rounds N] [--quick]

  cost    lockstep throughput of a loop beside the panel with 10 browsers and without the panel, in turn: browsers in one light process that
          reads the stream of the loop's page, and windows of Chromium, whose own processor time is stated; beside it the processor time of the
          loop's nodes for a sample, which other work on the machine changes little
  equal   trajectories of runs with and without panel and browsers, byte by byte
  screen  time from a measurement to its number in the page, in headless Chromium, at 10 samples a second
  memory  resident size of the panel after 24 h at 1 s of a loop (86,400 samples), and at 0.1 s (864,000), without a hole
  pictures  docs/panel_VIEW.png and panel_VIEW_phone.png: each view, at 1280 and 360 px, of two loops; an input was set by hand beyond its limit,
          then a setpoint leads it there
  many    processor time of panel and Chromium, and bytes a second, with 1 and with 50 loops at a sample a second (synthetic publishers)

Prints lines of JSON with the aim, as bench/ring_bench.py does. Before: source scripts/env.sh.
"""
import argparse
import contextlib
import itertools
import json
import os
import pathlib
import selectors
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "test/ros")]

import launching  # noqa: E402
import panel_page  # noqa: E402

LOOP = "asp_case1_clp"
COLUMNS = ("s", "x", "q_r", "x_reference")
TICKS = os.sysconf("SC_CLK_TCK")


def print_json(**values):
    print(json.dumps(values), flush=True)


def cpu_s(*pids):
    """User and system time of processes."""
    total = 0
    for pid in pids:
        with contextlib.suppress(OSError):
            fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
            total += int(fields[11]) + int(fields[12])
    return total / TICKS


def resident_mb(pid, field="VmRSS"):
    for line in pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines():
        if line.startswith(field + ":"):
            return int(line.split()[1]) / 1024
    return None


def reader(port, count, path):
    """In a process of its own: `count` connections that read a stream; prints the bytes that came, by second, once its input ends."""
    chosen, total = selectors.DefaultSelector(), 0
    for _ in range(count):
        link = socket.create_connection(("localhost", port))
        link.sendall(f"GET {path} HTTP/1.1\r\nHost: localhost:{port}\r\n\r\n".encode())
        chosen.register(link, selectors.EVENT_READ)
    chosen.register(sys.stdin, selectors.EVENT_READ)
    began = time.monotonic()
    print("reading", flush=True)
    while True:
        for key, _ in chosen.select():
            if key.fileobj is sys.stdin:
                print(total / (time.monotonic() - began), flush=True)
                return
            total += len(key.fileobj.recv(1 << 20))


@contextlib.contextmanager
def browsers(port, count, path):
    """Yields a function that ends them and gives the bytes a second of one."""
    process = subprocess.Popen([sys.executable, __file__, "--reader", str(port), str(count), path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def end():
        return float(process.communicate()[0].split()[-1]) / count
    try:
        process.stdout.readline()
        yield end
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()


def family(pid):
    found = [pid]
    with contextlib.suppress(OSError):
        for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
            for child in (task / "children").read_text(encoding="ascii").split():
                found += family(int(child))
    return found


@contextlib.contextmanager
def panel_of(env, folder):
    panel = panel_page.PanelProcess(launching.free_port(), os.path.join(folder, "panel"), env=env)
    try:
        yield panel
    finally:
        panel.kill()


def wait_until(condition, what, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError(f"waited {seconds} s for {what}")
        time.sleep(0.05)


GO = """
import sys, rospy
from fmbpc.msg import NodeReady
rospy.init_node("bench_go")
ready = rospy.Publisher("ready", NodeReady, queue_size=1, latch=True)
sys.stdin.readline()
ready.publish(node="/bench_go")
sys.stdin.readline()
"""


@contextlib.contextmanager
def loop_of(env, out, hours, *words, gate=True, loop=LOOP, more=""):
    """A lockstep loop that begins once it is told to: yields (process of roslaunch, function that lets it begin). more: keys for set:=."""
    endless = " disturbance.source=constant setpoint.schedule=[]" if hours == 0 else ""
    gated = " loop.wait_for=[loop_recorder,fmbpc_controller,fuzzy_identifier,clp_optimizer,bench_go]" if gate else ""
    launch = subprocess.Popen(["roslaunch", "--wait", "fmbpc", "loop.launch", f"loop:={loop}", f"out:={out}", "draw:=false", "sim_time:=false", *words,
                               f"set:=sampling.duration_h={hours}{endless}{gated} {more}"], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    go = subprocess.Popen([sys.executable, "-c", GO], env=env, stdin=subprocess.PIPE, text=True) if gate else None

    def begin():
        go.stdin.write("\n")
        go.stdin.flush()
    try:
        yield launch, begin
    finally:
        for process, how in ((go, signal.SIGKILL), (launch, signal.SIGINT)):
            if process is not None:
                if process.poll() is None:
                    process.send_signal(how)
                process.wait()


def knows(panel, loop="/"):
    """The panel shows the loop, and hears its plant (connected: the plant has introduced itself)."""
    return panel.get("/api/model", loop=loop) is not None


def record_of(hours, folder, with_panel):
    """The bytes of trajectory.csv of a run in lockstep."""
    out = os.path.join(folder, "run")
    with launching.master() as env, contextlib.ExitStack() as stack:
        panel = stack.enter_context(panel_of(env, folder)) if with_panel else None
        launch, begin = stack.enter_context(loop_of(env, out, hours, "pace:=lockstep"))
        if panel:
            wait_until(lambda: knows(panel), "the panel to find the loop")
            stack.enter_context(browsers(panel.port, 10, "/stream?loop=/"))
        begin()
        launch.wait(timeout=600)
    with open(os.path.join(out, "trajectory.csv"), "rb") as stream:
        return stream.read()


class Counter:
    """Samples of a loop by its own word, twice a second."""

    def __init__(self):
        import rospy
        from fmbpc.msg import LoopState
        self.said = []
        self.subscriber = rospy.Subscriber("/loop_state", LoopState, self._take)

    def _take(self, message):
        if message.summary:
            self.said.append((time.monotonic(), message.step))

    def rate(self, seconds, nodes):
        """(samples a second, processor time of the nodes a sample in us) during the next `seconds`."""
        begin = len(self.said)
        wait_until(lambda: len(self.said) > begin, "the loop's word")
        begin, end, used = len(self.said) - 1, time.monotonic() + seconds, -cpu_s(*nodes)
        wait_until(lambda: self.said[-1][0] >= end, "the loop's word", seconds + 30.0)
        used += cpu_s(*nodes)
        (t0, k0), (t1, k1) = self.said[begin], self.said[-1]
        return (k1 - k0) / (t1 - t0), 1e6 * used / (k1 - k0)


@contextlib.contextmanager
def no_browsers(_port):
    yield []


@contextlib.contextmanager
def light_browsers(port):
    """Yields the processes."""
    with browsers(port, 10, "/stream?loop=/"):
        yield []


@contextlib.contextmanager
def chromiums(port):
    """One Chromium with ten windows, each of them drawn."""
    page = panel_page.browser()
    try:
        for i in range(10):
            if i:
                page.switch_to.new_window("window")
            page.get(f"http://{('localhost', '127.0.0.1')[i % 2]}:{port}/#/loop/%2F")  # a browser opens six connections to a name
            wait_until(lambda: "sample" in page.find_element("id", "main").text, "the loop on the page")
        yield family(page.service.process.pid)
    finally:
        page.quit()


def cost(rounds, quick):
    """One lockstep loop goes on; the panel and its browsers come and go beside it. A ratio: with them, of the mean of before and after."""
    import rospy
    seconds = 2.0 if quick else 6.0
    with tempfile.TemporaryDirectory() as folder, launching.master() as env, loop_of(env, os.path.join(folder, "run"), 0, "pace:=lockstep", gate=False) as (launch, _):
        os.environ.update({k: env[k] for k in ("ROS_MASTER_URI", "ROS_HOSTNAME")})
        rospy.init_node("panel_bench", disable_signals=True)
        counter = Counter()
        wait_until(lambda: counter.said and counter.said[-1][1] > 5000, "the loop to go", 120.0)
        nodes = family(launch.pid)
        for who, open_browsers in (("no browser", no_browsers), ("10 browsers that only read", light_browsers), ("10 windows of Chromium", chromiums)):
            ratios, effort, panel_cpu, shown_cpu, alone = [], [], [], [], [counter.rate(seconds, nodes)]
            for _ in range(rounds):
                with panel_of(env, folder) as panel:
                    wait_until(lambda: knows(panel), "the panel to find the loop")
                    with open_browsers(panel.port) as shown:
                        time.sleep(4.0)  # until it has seen how fast the loop is
                        mine = family(panel.pid)
                        began, used, theirs = time.monotonic(), -cpu_s(*mine), -cpu_s(*shown)
                        beside = counter.rate(seconds, nodes)
                        took = time.monotonic() - began
                        panel_cpu.append((used + cpu_s(*mine)) / took)
                        shown_cpu.append((theirs + cpu_s(*shown)) / took)
                time.sleep(1.0)
                alone.append(counter.rate(seconds, nodes))
                for kept, i in ((ratios, 0), (effort, 1)):
                    kept.append(2.0 * beside[i] / (alone[-2][i] + alone[-1][i]))
            print_json(what=f"lockstep with panel and {who} beside without, {LOOP}", aim=0.98, ratio=statistics.median(ratios), least=min(ratios), most=max(ratios), pairs=rounds,
                       without_per_s=statistics.median(rate for rate, _ in alone), node_cpu_ratio=statistics.median(effort), node_cpu_least=min(effort), node_cpu_most=max(effort),
                       node_cpu_us=statistics.median(us for _, us in alone), panel_cpu=statistics.median(panel_cpu), chromium_cpu=statistics.median(shown_cpu))


def equal(rounds, quick):
    same = 0
    for i in range(rounds):
        got = {}
        for with_panel in ((False, True), (True, False))[i % 2]:
            with tempfile.TemporaryDirectory() as folder:
                got[with_panel] = record_of(200 if quick else 8000, folder, with_panel)
        same += got[True] == got[False]
    print_json(what=f"trajectory of {LOOP} with panel and 10 browsers and without, equal byte by byte", aim=rounds, equal=same)


WATCH_PAGE = """
window.shown = {}; let last = -1;
const look = () => { const s = window.fmbpcPanel.last['/']; const text = document.querySelector('#head').textContent; const m = /sample (\\d+)/.exec(text);
  if (m && Number(m[1]) !== last) { last = Number(m[1]); window.shown[last] = performance.timeOrigin + performance.now(); } };
new MutationObserver(look).observe(document.querySelector('#main'), { subtree: true, childList: true, characterData: true });
"""


def screen(quick):
    """Samples between two looks of the panel (0.1 s) come to the page together: each counts from its own message."""
    import rospy
    seconds = 5 if quick else 60
    with tempfile.TemporaryDirectory() as folder, launching.master() as env, panel_of(env, folder) as panel, \
            loop_of(env, os.path.join(folder, "run"), 0, "pace:=paced", "speedup:=7200", gate=False):
        os.environ.update({k: env[k] for k in ("ROS_MASTER_URI", "ROS_HOSTNAME")})
        rospy.init_node("panel_bench", disable_signals=True)
        from fmbpc.msg import Measurement
        came = {}
        subscriber = rospy.Subscriber("/measurement", Measurement, lambda m: came.setdefault(m.step, time.time()), tcp_nodelay=True)
        page = panel_page.browser()
        try:
            wait_until(lambda: knows(panel), "the panel to find the loop")
            page.get(f"http://localhost:{panel.port}/#/loop/%2F")
            wait_until(lambda: "sample" in page.find_element("id", "main").text, "the loop on the page")
            page.execute_script(WATCH_PAGE)
            time.sleep(seconds)
            shown = {int(k): v / 1000.0 for k, v in page.execute_script("return window.shown").items()}
        finally:
            page.quit()
            subscriber.unregister()
    first = min(shown)
    steps = sorted(k for k in came if k >= first and k <= max(shown))
    late = sorted(min(t for s, t in shown.items() if s >= k) - came[k] for k in steps)
    print_json(what="sample to screen, 10 samples a second, headless Chromium", aim_s=0.5, p95_s=late[int(0.95 * (len(late) - 1))], median_s=statistics.median(late), worst_s=late[-1],
               samples=len(late))


def memory(quick):
    for hours, what in (((20, "100 samples"),) if quick else ((17280, "24 h at 1 s"), (172800, "24 h at 0.1 s"))):
        with tempfile.TemporaryDirectory() as folder, launching.master() as env, panel_of(env, folder) as panel, \
                loop_of(env, os.path.join(folder, "run"), hours, "pace:=lockstep", "keep:=true") as (_, begin):
            wait_until(lambda: knows(panel), "the panel to find the loop")
            before = resident_mb(panel.pid)
            samples = round(hours * 5)
            begin()

            def over():
                rows = panel.get("/api/sparks").get("/")
                return rows is not None and rows["steps"][-1] >= samples
            wait_until(over, "the end of the run", 900.0)
            end, holes = time.monotonic() + 120.0, None
            while holes != 0 and time.monotonic() < end:
                time.sleep(1.0)
                holes = panel.holes("/", COLUMNS, 0, samples - 1)
            print_json(what=f"panel with {what} of {LOOP}", aim_mb=100, history_mb=resident_mb(panel.pid) - before, resident_mb=resident_mb(panel.pid), peak_mb=resident_mb(panel.pid, "VmHWM"),
                       samples=samples, holes=holes)


PUBLISH = """
import sys, time
import rospy
from fmbpc import msg
loops, period = int(sys.argv[1]), float(sys.argv[2])
rospy.init_node("synthetic_loops", disable_signals=True)
made = []
for i in range(loops):
    ns = f"/loop{i:02d}/"
    to = {topic: rospy.Publisher(ns + topic, kind, queue_size=100, latch=True) for topic, kind in (("plant_info", msg.PlantInfo), ("measurement", msg.Measurement),
          ("tracking", msg.Tracking), ("control_action", msg.ControlAction), ("loop_state", msg.LoopState))}
    rospy.set_param(ns + "loop_text", f"title: Synthetic loop {i}\\nloop: {{publishers: {{plant_info: [], measurement: [], tracking: [], control_action: []}}}}\\n")
    to["plant_info"].publish(run_id=7, name="synthetic", sample_time_s=period, outputs=[msg.SignalInfo("y", "mg/l", 0.0, 10.0), msg.SignalInfo("z", "C", 0.0, 10.0)],
                             inputs=[msg.SignalInfo("u", "l/s", 0.0, 5.0)], disturbances=[msg.SignalInfo("d", "l/s", 0.0, 9.0)])
    made.append(to)
print("ready", flush=True)
k, due = 0, time.monotonic()
while True:
    for i, to in enumerate(made):
        to["measurement"].publish(run_id=7, step=k, outputs=[(k * 7 + i) % 10, 5.0], disturbances=[3.0], input_applied=[2.0])
        to["tracking"].publish(run_id=7, step=k, setpoint=[4.0, 5.0], reference=[3.5, 5.0])
        to["control_action"].publish(run_id=7, step=k, input=[1.0 + (k + i) % 3], source=1)
    for _ in range(max(1, round(period / 0.5))):  # each node says twice a second how it is
        for i, to in enumerate(made):
            to["loop_state"].publish(run_id=7, step=k, node=rospy.get_name(), summary=True, mode=2, word="automatic", reason="running")
        due += min(period, 0.5)
        time.sleep(max(0.0, due - time.monotonic()))
    k += 1
"""


def many(quick):
    seconds = 3 if quick else 30
    for count in (1, 50):
        with tempfile.TemporaryDirectory() as folder, launching.master() as env, panel_of(env, folder) as panel:
            source = subprocess.Popen([sys.executable, "-c", PUBLISH, str(count), "1.0"], env=env, stdout=subprocess.PIPE, text=True)
            page = None
            try:
                source.stdout.readline()
                waited, began = [], time.monotonic()

                def taken_up():
                    asked = time.monotonic()
                    there = len(panel.get("/api/sparks")) == count
                    waited.append(time.monotonic() - asked)
                    return there
                wait_until(taken_up, f"{count} loops in the panel")
                took = time.monotonic() - began
                used = -cpu_s(panel.pid)
                time.sleep(seconds)
                alone = (used + cpu_s(panel.pid)) / seconds
                with browsers(panel.port, 1, "/stream") as end:
                    time.sleep(seconds)
                    rate = end()
                page = panel_page.browser()
                page.get(f"http://localhost:{panel.port}/")
                wait_until(lambda: len(page.find_elements("css selector", "a.tile")) == count, "all tiles")
                shown = family(page.service.process.pid)
                used, theirs = -cpu_s(panel.pid), -cpu_s(*shown)
                time.sleep(seconds)
                print_json(what=f"{count} synthetic loops, 1 sample a second each", panel_cpu=alone, panel_cpu_with_page=(used + cpu_s(panel.pid)) / seconds,
                           chromium_cpu=(theirs + cpu_s(*shown)) / seconds, stream_bytes_per_s=rate, resident_mb=resident_mb(panel.pid),
                           taken_up_s=took, slowest_answer_meanwhile_s=max(waited))
            finally:
                if page is not None:
                    page.quit()
                source.kill()
                source.wait()


def pictures(quick):
    """Looked at by a person; nothing here judges them."""
    from PIL import Image
    by_hand = (("overview", "", "Activated"), ("alarms", "alarms", "input_clamped"))
    at_the_limit = (("loop", "loop/%2Fa", "turned aside"), ("model", "loop/%2Fa/model", "Rules of"), ("journal", "journal", "Journal"))
    with tempfile.TemporaryDirectory() as folder, launching.master() as env:
        users, secret = os.path.join(folder, "users.json"), "correct horse"
        subprocess.run([sys.executable, panel_page.SCRIPT, "--users", users, "--add-user", "olga", "engineer"], input=secret + "\n", check=True, text=True, stdout=subprocess.DEVNULL)
        panel = panel_page.PanelProcess(launching.free_port(), os.path.join(folder, "panel"), users=users, env=env)
        page = None
        try:
            with loop_of(env, os.path.join(folder, "a"), 0, "pace:=paced", "speedup:=7200", "ns:=/a", gate=False, more="setpoint.upper.x=2500"), \
                    loop_of(env, os.path.join(folder, "b"), 0, "pace:=paced", "speedup:=60", "ns:=/b", gate=False, loop="cstr_tracking"):
                for loop in ("/a", "/b"):
                    wait_until(lambda loop=loop: knows(panel, loop), f"the panel to find {loop}")
                page = panel_page.browser()
                panel_page.size(page, 1280, 900)
                page.get(f"http://localhost:{panel.port}/")
                log_in = "return fetch('api/login', {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify({name: 'olga', password: '%s'})}).then((a) => a.json())"
                token = page.execute_script(log_in % secret)["xsrf"]
                ask = "return fetch('api/command', {method: 'POST', headers: {'Content-Type': 'application/json', 'X-Xsrf': '%s'}, body: JSON.stringify({verb: '%s', loop: '/a', arguments: %s})}).then((a) => a.status)"
                time.sleep(3 if quick else 15)
                for commands, views in (((("manual", "{}"), ("input", "{values: {q_r: '9000'}}")), by_hand), ((("auto", "{}"), ("set", "{values: {x: '2400'}}")), at_the_limit)):
                    for verb, arguments in commands:
                        if page.execute_script(ask % (token, verb, arguments)) != 200:
                            raise RuntimeError(f"{verb}: refused")
                    for (name, path, wanted), (width, end) in itertools.product(views, ((1280, ""), (360, "_phone"))):
                        panel_page.size(page, width, 400)
                        page.get("about:blank")
                        page.get(f"http://localhost:{panel.port}/#/{path}")
                        wait_until(lambda: wanted in page.find_element("id", "main").text, f"{wanted} on the page")
                        time.sleep(1 if quick else 5)  # so many plans that a band is drawn
                        panel_page.size(page, width, min(page.execute_script("return document.documentElement.scrollHeight"), 2400))
                        time.sleep(1.0)
                        file = HERE.parent / "docs" / f"panel_{name}{end}.png"
                        page.save_screenshot(str(file))
                        Image.open(file).convert("RGB").quantize(64).save(file, optimize=True)
                        print_json(what=file.name, bytes=file.stat().st_size)
        finally:
            if page is not None:
                page.quit()
            panel.kill()


def main():
    if sys.argv[1:2] == ["--reader"]:
        reader(int(sys.argv[2]), int(sys.argv[3]), sys.argv[4])
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", help="cost, equal, screen, memory, many (all), pictures")
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--quick", action="store_true", help="for a moment: shows that it works")
    options = parser.parse_args()
    parts = {"cost": lambda: cost(1 if options.quick else options.rounds, options.quick), "equal": lambda: equal(2, options.quick), "screen": lambda: screen(options.quick), "memory": lambda: memory(options.quick),
             "many": lambda: many(options.quick), "pictures": lambda: pictures(options.quick)}
    unknown = sorted(set(options.what) - set(parts))
    if unknown:
        parser.error(f"'{unknown[0]}': expected some of {', '.join(parts)}")
    names = options.what or [name for name in parts if name != "pictures"]
    for name in names:
        if len(names) == 1:
            parts[name]()
        else:  # a process has one master
            subprocess.run([sys.executable, __file__, name, "--rounds", str(options.rounds), *(["--quick"] if options.quick else [])], check=True)


if __name__ == "__main__":
    main()
