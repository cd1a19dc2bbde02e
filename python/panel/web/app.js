/* The operator's panel. No framework, no build step: what comes over the stream is kept in `S`, each view draws from it. */
"use strict";
(() => {
const $ = (id) => document.getElementById(id);
const S = {
  me: { name: "", role: "view", xsrf: "" }, loops: [], alarms: [], journal: [], events: {}, master: true, trouble: "",
  heard: 0, sparks: {}, series: {}, last: {}
};
const FILE = window.FMBPC_RUN || null;
const RANK = { none: 0, view: 1, operate: 2, engineer: 3 };
const MARKS = { 1: "!!", 2: "!", 3: "i" };
const PRIORITY = { 1: "high", 2: "medium", 3: "low" };
const WINDOWS = [[100, "100 samples"], [300, "300"], [1000, "1,000"], [5000, "5,000"], [0, "whole run"]];
const GONE = 1600;            // ms without a word of the panel (it speaks twice a second)
const AGAIN = 5000;           // ms, then a new connection is tried: one that was cut without a word never ends by itself
const DRAWN = 240;            // ms from one drawing of the trends to the next
const FAST_SPAN = 5000;       // samples at least that the trend of a fast loop shows
let source = null, connected = 0, view = { kind: "" }, drawn = null;

// ---- small things

const store = { get(key, other) { try { return localStorage.getItem("fmbpc_" + key) || other; } catch (e) { return other; } },
  set(key, value) { try { localStorage.setItem("fmbpc_" + key, value); } catch (e) { /* private window */ } } };
let mark = store.get("decimal", (1.5).toLocaleString(navigator.language).includes(",") ? "," : ".");

function act(e) { const go = this.on && this.on[e.type]; if (go && !this.disabled) go.call(this, e); }

/* h("div.card", {attributes}, children...): nodes, never markup, so that no name of a signal is a script. */
function h(what, given, ...children) {
  const [tag, ...classes] = what.split(".");
  const node = document.createElement(tag || "div");
  if (classes.length) node.className = classes.join(" ");
  for (const [key, value] of Object.entries(given || {})) {
    if (key.startsWith("on")) { node.on = node.on || {}; node.on[key.slice(2)] = value; node.addEventListener(key.slice(2), act); }
    else if (value !== null && value !== undefined && value !== false) node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.flat(Infinity).filter((c) => c !== null && c !== undefined && c !== false));
  return node;
}

function num(value, digits = 5) {
  if (value === null || value === undefined || !isFinite(value)) return "–";
  let text = Math.abs(value) >= 1e6 || (value !== 0 && Math.abs(value) < 1e-4)
    ? Number(value).toExponential(3)
    : String(Number(Number(value).toPrecision(digits)));
  return mark === "," ? text.replace(".", ",").replace("-", "\u2212") : text.replace("-", "\u2212");
}
const unit = (u) => (!u || u === "-" ? "" : " " + u);
const named = (s) => s.name + (unit(s.unit) ? ` [${s.unit}]` : "");
const lagged = (r) => `${r.name}(k${r.lag ? "−" + r.lag : ""})`;

/* The same reading as the server's (commands.py): {value} or {error}. */
function readNumber(text) {
  const word = text.trim().replace(/[\u202f\u00a0 '\u2019]/g, "").replace("\u2212", "-");
  const match = /^([+-]?)(\d[\d.,]*|[.,]\d+)((?:[eE][+-]?\d{1,3})?)$/.exec(word);
  if (!match || word.length > 40) return { error: "expected a number" };
  const [, sign, body, exponent] = match;
  const groups = (parts) => /^\d{1,3}$/.test(parts[0]) && parts.slice(1).every((p) => /^\d{3}$/.test(p));
  const points = body.split(".").length - 1, commas = body.split(",").length - 1;
  let plain = null;
  if (points && commas) {
    const dec = body.lastIndexOf(".") > body.lastIndexOf(",") ? "." : ",";
    const whole = body.slice(0, body.lastIndexOf(dec)), part = body.slice(body.lastIndexOf(dec) + 1),
      parts = whole.split(dec === "." ? "," : ".");
    if (/^\d+$/.test(part) && groups(parts)) plain = parts.join("") + "." + part;
  } else if (points + commas > 1) {
    const parts = body.split(points ? "." : ",");
    if (groups(parts)) plain = parts.join("");
  } else {
    const used = points ? "." : ",";
    if (points + commas === 1 && used !== mark && groups(body.split(used)) && !body.startsWith("0"))
      return { error: `may be ${body.replace(used, "")} or ${body.replace(used, mark)}: write it without a mark for thousands` };
    plain = body.replace(",", ".");
  }
  const value = Number(sign + plain + exponent);
  return plain === null || !isFinite(value) ? { error: "expected a number" } : { value };
}

function timeUnit(seconds) { return seconds >= 18000 ? [3600, "h"] : seconds >= 300 ? [60, "min"] : [1, "s"]; }
function runTime(seconds) { const [d, u] = timeUnit(seconds); return num(seconds / d, 5) + " " + u; }
function wall(t, day) { const d = new Date(t * 1000); return (day ? d.toLocaleDateString() + " " : "") + d.toLocaleTimeString(); }
const may = (role) => RANK[S.me.role] >= RANK[role];
const loopPath = (name) => "#/loop/" + encodeURIComponent(name);

let quiet = null;
function say(text, bad) {
  $("said").textContent = text; $("said").className = bad ? "bad" : "";
  clearTimeout(quiet); quiet = setTimeout(() => { $("said").textContent = ""; }, bad ? 9000 : 5000);
}

async function post(path, body) {
  let answer;
  try {
    answer = await fetch(path, {
      method: "POST", headers: { "Content-Type": "application/json", "X-Xsrf": S.me.xsrf }, body: JSON.stringify(body)
    });
    const value = await answer.json();
    return answer.ok ? value : { error: value.error || "it could not be done" };
  } catch (e) { return { error: "the panel does not answer" }; }
}

async function ask(verb, loop, args, about) {
  say(`${about || verb}: requested …`);
  const answer = await post("api/command", { verb, loop, arguments: { ...args, decimal: mark } });
  if (answer.error) say(`${about || verb}: refused: ${answer.error}`, true); else say(answer.text);
  return answer;
}

async function get(path) { const answer = await fetch(path); if (!answer.ok) throw new Error(path); return answer.json(); }

// ---- the stream

/* A browser opens six connections to a name, and each stream takes one: a page that nobody sees has none. */
function connect() {
  if (source) source.close();
  if (document.hidden) { source = null; return; }
  connected = Date.now();
  const loop = view.loop ? "?loop=" + encodeURIComponent(view.loop) : "";
  source = new EventSource("stream" + loop);
  const on = (kind, take) => source.addEventListener(kind, (e) => { S.heard = Date.now(); take(JSON.parse(e.data)); });
  on("hello", (m) => {
    S.me = m.me;
    S.events = m.events;
    renderHeader();
    if (view.loop) fetchTrend(view.loop);
    fetchSparks();
    if (S.me.role === "none") login();
    render(true);
  });
  on("overview", (m) => {
    S.loops = m.loops;
    S.master = m.master;
    S.trouble = m.trouble;
    S.time = m.t;
    sparkle();
    renderHeader();
    renderBanner();
    if (view.kind !== "loop") render();
  });
  on("alarms", (m) => { S.alarms = m; renderBanner(); renderHeader(); if (view.kind === "alarms" || view.kind === "loop") render(); });
  on("journal", (m) => {
    const seen = new Set(S.journal.map((e) => e.n));
    S.journal = S.journal.concat(m.filter((e) => !seen.has(e.n))).slice(-1000);
    if (view.kind === "journal") render();
  });
  on("loop", takeLoop);
  on("missed", () => view.loop && fetchTrend(view.loop));
}

function sparkle() {
  for (const row of S.loops) {
    const spark = S.sparks[row.name];
    if (!spark || !row.output || spark.steps[spark.steps.length - 1] >= row.step) continue;
    spark.steps.push(row.step); spark.value.push(row.output.value); spark.setpoint.push(row.output.setpoint);
    while (spark.steps.length > 240) for (const key of ["steps", "value", "setpoint"]) spark[key].shift();
  }
}
async function fetchSparks() {
  try {
    S.sparks = await get("api/sparks");
    if (view.kind === "overview") render();
  } catch (e) { /* the next one */ }
}

function takeLoop(m) {
  if (m.ahead === false && S.last[m.name]) m.ahead = S.last[m.name].ahead;
  const before = S.last[m.name];
  S.last[m.name] = m;
  const series = S.series[m.name];
  if (!m.columns) { render(); return; }
  if (!series || series.run !== m.run || m.refetch || (before && before.restarted !== m.restarted) ||
    (series.steps.length && m.rows.length && m.rows[0][0] > series.steps[series.steps.length - 1] + 1)) fetchTrend(m.name);
  if (series && series.run === m.run) {
    for (const row of m.rows) append(series, row);
    forget(series, spanOf(m));
    if (series.steps.length > 6000) fetchTrend(m.name);
  }
  if (view.loop === m.name && !document.hidden) requestAnimationFrame(render);
}

function append(series, row) {
  const [step, at, ...values] = row, n = series.steps.length;
  let i = n;
  if (n && step <= series.steps[n - 1]) { i = series.steps.lastIndexOf(step); if (i < 0) return; }
  series.steps[i] = step; series.wall[i] = at;
  values.forEach((v, j) => { series.data[j][i] = v; });
}
/* Samples of the past that are shown; 0: all. */
function spanOf(info) {
  const span = Number(store.get("window", "300"));
  return span && info && info.fast ? Math.max(span, FAST_SPAN) : span;
}
function forget(series, span) {
  const n = series.steps.length, first = series.steps[n - 1] - span;
  if (!span || series.steps[0] >= first - 0.1 * span) return;
  const gone = series.steps.findIndex((k) => k >= first);
  for (const column of [series.steps, series.wall, ...series.data]) column.splice(0, gone);
}

const fetching = {};
async function fetchTrend(name) {
  const now = Date.now();
  if (fetching[name] && now - fetching[name] < 700) {
    clearTimeout(fetching.later);
    fetching.later = setTimeout(() => fetchTrend(name), 750);
    return;
  }
  fetching[name] = now;
  try {
    const info = S.last[name] || S.loops.find((l) => l.name === name), span = spanOf(S.last[name]);
    const from = span && info && info.step > span ? info.step - span : 0;
    const got = await get(`api/history?loop=${encodeURIComponent(name)}&from=${from}&points=1500`);
    S.series[name] = { name, run: got.run, columns: got.columns, steps: got.steps, wall: got.wall, data: got.data, dt: got.dt };
    if (view.loop === name) {
      const m = S.last[name];
      if (m && m.step > (got.last || 0) + 1) setTimeout(() => fetchTrend(name), 800);
      render();
    }
  } catch (e) { /* a loop that has not begun */ }
}

// ---- header and banner

function renderHeader() {
  const open = S.alarms.filter((a) => a.state === "unacknowledged" || a.state === "returned").length;
  const here = (kind) => (view.kind === kind ? "page" : null);
  const items = FILE
    ? []
    : [
      h("a", { href: "#/", "aria-current": here("overview"), title: "key o" }, "Overview"),
      h("a", { href: "#/alarms", "aria-current": here("alarms"), title: "key a" }, "Alarms" + (open ? ` (${open})` : "")),
      h("a", { href: "#/journal", "aria-current": here("journal"), title: "key j" }, "Journal")];
  put($("nav"), items);
  const who = [
    h("button.link",
      {
        onclick: () => {
          mark = mark === "." ? "," : ".";
          store.set("decimal", mark);
          renderHeader();
          drawn = null;
          render();
        }, "aria-label": "Change the decimal mark"
      },
      mark === "." ? "1234.5" : "1234,5")];
  if (!FILE)
    who.push(
      S.me.name ? h("span", null, `${S.me.name} (${S.me.role})`) : h("span.soft", null, "view only"),
      S.me.name
        ? h("button", { onclick: async () => { S.me = await post("api/logout", {}); drawn = null; connect(); } }, "Log out")
        : h("button", { onclick: login }, "Log in"));
  put($("who"), who);
}

/* Makes the children of a node as they are wanted, changing only what differs: what is being clicked, focused or selected stays. */
function put(node, children) {
  const fresh = h("div", null, children);
  morphChildren(node, fresh);
}
function morphChildren(old, fresh) {
  const wanted = [...fresh.childNodes];
  wanted.forEach((want, i) => {
    const have = old.childNodes[i];
    if (!have) old.append(want);
    else if (have.nodeType !== want.nodeType || have.nodeName !== want.nodeName ||
      (have.dataset && have.dataset.key !== want.dataset.key)) have.replaceWith(want);
    else if (have.nodeType === 3) { if (have.data !== want.data) have.data = want.data; } else morph(have, want);
  });
  while (old.childNodes.length > wanted.length) old.lastChild.remove();
}
function morph(have, want) {
  for (const { name, value } of [...want.attributes]) if (have.getAttribute(name) !== value) have.setAttribute(name, value);
  for (const { name } of [...have.attributes])
    if (!want.hasAttribute(name) && name !== "style" && name !== "open") have.removeAttribute(name);
  for (const type of Object.keys(want.on || {})) if (!have.on || !have.on[type]) have.addEventListener(type, act);
  have.on = want.on;
  morphChildren(have, want);
}

function alarmMark(a) {
  const calm = a.state !== "unacknowledged" && a.state !== "acknowledged";
  return h("span.al." + a.state, null,
    h("span.mark.p" + a.priority + (calm ? ".calm" : ""),
      { role: "img", "aria-label": PRIORITY[a.priority] + " priority, " + a.state.replace("_", " ") },
      MARKS[a.priority]));
}
const remedy = (code) => { const text = ((S.events[code] || {}).remedy || "").replace(/`/g, ""); return text === "none" ? "" : text; };

function renderBanner() {
  if (FILE) return;
  const away = Date.now() - S.heard, gone = S.heard && away > GONE;
  document.body.classList.toggle("gone", Boolean(gone));
  const top = S.alarms.find((a) => a.state === "unacknowledged") || S.alarms.find((a) => a.state === "returned");
  $("banner").className = gone ? "p1" : top ? "p" + top.priority : "";
  const lost = S.loops.filter((l) => l.stale);
  const parts = [], troubles = gone
    ? [`NO CONNECTION to the panel for ${Math.floor(away / 1000)} s. What is shown is old.`]
    : [
      S.master ? "" : "The ROS master does not answer: commands may not arrive, new loops are not found.",
      S.trouble,
      ...lost.map((l) => `${l.name}: NO WORD from the plant for ${Math.floor(l.stale)} s. Its values are old.`)].filter(Boolean);
  if (troubles.length) parts.push(h("span.lost", { title: troubles.join("\n") }, troubles.join(" ")));
  if (!gone) {
    if (top)
      parts.push(
        alarmMark(top),
        h("a", { href: loopPath(top.loop) }, top.loop),
        h("span", { title: top.text },
          h("b", null, top.code),
          (top.signal ? " " + top.signal : "") + ": " + top.text + (top.state === "returned" ? " (gone again)" : "")),
        remedy(top.code) ? h("span.soft", { title: remedy(top.code) }, "Do: " + remedy(top.code)) : null,
        h("button.pad",
          {
            disabled: !may("operate"), title: may("operate") ? "" : "log in as operator",
            onclick: () => ask("acknowledge", top.loop, { key: top.key }, top.code)
          },
          "Acknowledge"));
  }
  if (!parts.length && S.heard)
    parts.push(h("span.soft", null, S.alarms.length ? `Nothing to acknowledge, ${S.alarms.length} not normal.` : "No alarm."));
  put($("banner"), parts);
  put($("link"), [gone ? "✕ no connection" : S.heard ? "● connected " + wall(S.time || Date.now() / 1000) : "connecting …"]);
}
$("banner").hidden = Boolean(FILE);
if (!FILE)
  setInterval(() => {
    renderBanner();
    if (!document.hidden && Date.now() - Math.max(S.heard, connected) > AGAIN) connect();
  }, 300);

// ---- dialogs

function dialog(title, fields, go, label) {
  const form = h("form.stack", { method: "dialog" },
    h("h2", null, title),
    fields,
    h("div.row", null,
      h("button", { type: "submit" }, label || "OK"),
      h("button", { type: "button", onclick: () => $("dialog").close() }, "Cancel")),
    h("p.soft", { role: "alert" }));
  form.addEventListener("submit", async (e) => {
    e.preventDefault();
    const why = await go(form);
    if (why) form.querySelector("[role=alert]").textContent = why; else $("dialog").close();
  });
  $("dialog").replaceChildren(form);
  if (!$("dialog").open) $("dialog").showModal();
}
function login() {
  dialog("Log in",
    [
      h("label", null, "Name", h("input", { name: "name", autocomplete: "username", autofocus: true })),
      h("label", null, "Password", h("input", { name: "password", type: "password", autocomplete: "current-password" }))],
    async (form) => {
      const got = await post("api/login", { name: form.elements.name.value, password: form.elements.password.value });
      if (got.error) return got.error;
      S.me = got;
      drawn = null;
      renderHeader();
      connect();
      render();
      return "";
    },
    "Log in");
}
function shelve(a) {
  dialog(
    `Shelve ${a.code} ${a.signal}`,
    [
      h("p", null, "It is not shown until the end; it is journalled all the same."),
      h("label", null, "Minutes", h("input", { name: "minutes", value: "30", inputmode: "decimal" }))],
    async (form) => {
      const got = readNumber(form.elements.minutes.value);
      if (got.error) return got.error;
      return (await ask("shelve", a.loop, { key: a.key, seconds: 60 * got.value }, "shelve")).error || "";
    },
    "Shelve");
}

// ---- overview

function canvasSpark(canvas, spark) {
  const ratio = window.devicePixelRatio || 1, w = canvas.clientWidth || 240, ht = canvas.clientHeight || 44, c = canvas.getContext("2d");
  canvas.width = w * ratio; canvas.height = ht * ratio; c.scale(ratio, ratio);
  if (!spark || spark.steps.length < 2) return;
  const all = spark.value.concat(spark.setpoint).filter((v) => v !== null), low = Math.min(...all),
    span = Math.max(...all) - low || 1,
    x0 = spark.steps[0],
    dx = spark.steps[spark.steps.length - 1] - x0 || 1;
  for (const [key, colour, dash] of [["setpoint", "#77808a", [4, 3]], ["value", "#26303a", []]]) {
    c.beginPath(); c.strokeStyle = colour; c.setLineDash(dash); c.lineWidth = 1.4; let pen = false;
    spark[key].forEach((v, i) => {
      if (v === null) { pen = false; return; }
      const x = 2 + (w - 4) * (spark.steps[i] - x0) / dx, y = ht - 4 - (ht - 8) * (v - low) / span;
      if (pen) c.lineTo(x, y); else c.moveTo(x, y);
      pen = true;
    });
    c.stroke();
  }
}

function overview() {
  const main = $("main");
  if (drawn !== "overview") {
    main.replaceChildren(h("h1", { id: "title" }, "Loops"), h("p.soft", { id: "none" }), h("div.tiles", { id: "tiles" }));
    drawn = "overview";
    tiles.clear();
  }
  $("none").textContent = S.loops.length ? "" : "No loop runs on this master: roslaunch fmbpc loop.launch loop:=NAME";
  const order = (l) => (l.stale ? 0 : l.alarm ? l.alarm.priority : 9);
  const sorted = [...S.loops].sort((a, b) => order(a) - order(b) || a.name.localeCompare(b.name));
  for (const name of [...tiles.keys()]) if (!S.loops.some((l) => l.name === name)) { tiles.get(name).remove(); tiles.delete(name); }
  sorted.forEach((l, i) => {
    let tile = tiles.get(l.name);
    if (!tile) {
      tile = h("a.tile", { href: loopPath(l.name) },
        h("div.head"),
        h("canvas", { role: "img", "aria-label": "trend of the output and its setpoint" }),
        h("div.foot"));
      tiles.set(l.name, tile);
    }
    if ($("tiles").children[i] !== tile) $("tiles").insertBefore(tile, $("tiles").children[i] || null);
    tile.classList.toggle("live", true); tile.classList.toggle("away", Boolean(l.stale));
    put(tile.querySelector(".head"), [
      h("b", null, l.title),
      h("div.row.soft", null,
        h("span", null, l.name),
        l.step >= 0 ? h("span.num", null, runTime(l.seconds)) : null,
        h("span.word.end." + (l.stale ? "stale" : l.word), null,
          l.stale
            ? `no word ${Math.floor(l.stale)} s`
            : l.word === "automatic" && l.mode === "manual" ? "manual" : l.word))]);
    put(tile.querySelector(".foot"), [
      l.output
        ? h("div.num", null,
          `${l.output.name} ${num(l.output.value, 4)}${unit(l.output.unit)} → ${num(l.output.setpoint, 4)}`)
        : h("div.soft", null, l.reason),
      l.alarm
        ? h("div.row", null,
          alarmMark(l.alarm),
          h("span", null, l.alarm.code + (l.alarm.signal ? " " + l.alarm.signal : "")),
          l.alarm.state === "returned" ? h("span.soft", null, "gone again") : null)
        : h("div.soft", null, "no alarm")]);
    canvasSpark(tile.querySelector("canvas"), S.sparks[l.name]);
  });
}
const tiles = new Map();

// ---- one loop

const cell = (label, text, cls) => h("td" + (cls || ""), { "data-h": label }, text);
function table(columns, rows) {
  return h("table.rows", null,
    h("thead", null,
      h("tr", null, columns.map((c) => h("th" + (c.startsWith("#") ? ".num" : ""), { scope: "col" }, c.replace("#", ""))))),
    h("tbody", null, rows));
}
const statusCell = (row) => h("td", { "data-h": "status" }, h("span.word." + row.status, null, row.status));
const reasonCell = (row) => h("td.reason.still", { "data-h": "why" }, row.reason || "–");
const range = (low, high) => (low === null && high === null
  ? "–"
  : `${low === null ? "−∞" : num(low, 4)} … ${high === null ? "∞" : num(high, 4)}`);

/* A value that opens into a field: what is typed is read back before it is sent. */
function editable(key, text, label, send) {
  if (view.editing === key) return editor(key, label, send);
  return h("button.pad",
    {
      "data-key": key, disabled: !may("operate"), title: may("operate") ? label : "log in as operator",
      "aria-label": `${label}, now ${text}`,
      onclick: () => {
        view.editing = key;
        render(true);
        const field = document.querySelector("[data-editor] input");
        if (field) field.focus();
      }
    },
    text);
}
function editor(key, label, send) {
  const reads = h("span.reads", null, label + ": type a number");
  const field = h("input", { inputmode: "decimal", "aria-label": label, autocomplete: "off" });
  const go = async () => {
    const got = readNumber(field.value);
    if (got.error) { reads.textContent = got.error; return; }
    view.editing = null;
    render(true);
    await send(field.value, got.value);
  };
  const leave = () => { view.editing = null; render(true); };
  field.addEventListener("input", () => {
    const got = readNumber(field.value);
    reads.textContent = got.error || `${label}: ${num(got.value, 9)}`;
  });
  field.addEventListener("keydown", (e) => { if (e.key === "Enter") go(); if (e.key === "Escape") leave(); });
  return h("span.editor", { "data-editor": key },
    field,
    h("button.pad", { onclick: go }, "Set"),
    h("button.pad", { onclick: leave }, "Cancel"),
    reads);
}

function loopView(force) {
  const m = S.last[view.loop], brief = S.loops.find((l) => l.name === view.loop), main = $("main");
  if (drawn !== "loop" + view.loop) {
    main.replaceChildren(h("div.live", { id: "live" },
      h("section.card", { id: "head", "aria-label": "Loop" }),
      h("div", { id: "tabs" }),
      h("div", { id: "operate" },
        h("section.card", { "aria-label": "Outputs" }, h("h2", null, "Outputs"), h("div.scroll", { id: "outputs" })),
        h("section.card", { "aria-label": "Inputs" }, h("h2", null, "Inputs"), h("div.scroll", { id: "inputs" })),
        h("section.card", { "aria-label": "Trends" }, h("div.row", { id: "window" }), h("div.cols", { id: "charts" })),
        h("section.card", { "aria-label": "Disturbances" },
          h("h2", null, "Disturbances"),
          h("div.scroll", { id: "disturbances" })),
        h("section.card", { "aria-label": "Alarms of this loop" },
          h("h2", null, "Alarms of this loop"),
          h("div.scroll", { id: "loopalarms" })),
        h("section.card", { "aria-label": "Nodes" }, h("h2", null, "Nodes"), h("div.scroll", { id: "nodes" }))),
      h("div", { id: "model", hidden: true })));
    drawn = "loop" + view.loop; charts.clear();
  }
  const l = m || brief;
  if (!l) {
    put($("head"), [h("h1", null, view.loop), h("p", null, S.heard ? "This loop is not there (any more)." : "Loading …")]);
    return;
  }
  $("live").classList.toggle("away", Boolean((brief || l).stale));
  put($("head"), [
    h("div.row", null,
      h("h1", { title: l.title }, l.title),
      h("span.end.num", null,
        l.step >= 0 ? `sample ${l.step} · ${runTime(l.seconds)} · ${wall(S.time || Date.now() / 1000)}` : "")),
    h("div.row", null,
      modeButtons(l),
      h("span.state", null, h("span.word." + l.word, null, l.word), h("span.soft", { title: l.reason }, l.reason)))]);
  put($("tabs"), [
    h("div.row", { role: "group", "aria-label": "Views of this loop" },
      [["operate", "Operate"], ["model", "Model and settings"]].map(([key, label]) => h("button",
        { "aria-pressed": String(view.tab === key), onclick: () => { view.tab = key; render(true); } },
        label))),
    h("p")]);
  $("operate").hidden = view.tab !== "operate"; $("model").hidden = view.tab !== "model";
  if (view.tab === "model") { modelView(); return; }
  if (!m || !m.outputs) return;
  const editing = view.editing && document.querySelector("[data-editor] input");
  if (!editing || force) {
    const manual = m.inputs.some((u) => u.actual === "manual");
    put($("outputs"), [
      table(["", "#value", "quality", "#setpoint", "#working", "#predicted", "#steady", "limits", "status", "reason"],
        m.outputs.map((y) => h("tr", null,
          h("td.name", null, named(y)),
          cell("value", num(y.value), ".num"),
          cell("quality", y.quality),
          h("td.num.ask", { "data-h": "setpoint" },
            editable(
              "set " + y.name,
              num(y.setpoint) + (y.by_hand ? " ✎" : ""),
              "setpoint of " + named(y),
              (text) => ask("set", m.name, { values: { [y.name]: text } }, "setpoint of " + y.name)),
            y.by_hand
              ? h("button.link",
                { disabled: !may("operate"), onclick: () => ask("release", m.name, { names: [y.name] }, "release") },
                "back to schedule")
              : null),
          cell("working", num(y.working), ".num"),
          cell(y.predicted_in ? `predicted (${y.predicted_in})` : "predicted", num(y.predicted), ".num"),
          cell("steady", num(y.steady), ".num"),
          cell("limits", range(y.lower, y.upper)),
          statusCell(y),
          reasonCell(y)))),
      h("div.soft", null,
        (m.outputs[0].predicted_in ? `predicted: ${m.outputs[0].predicted_in} samples ahead; ` : "") +
          "steady: at the end of the plan; ✎ by an operator")]);
    put($("inputs"), [
      table(["", "#value", "#law asks", "limits", "in force", "#move", "mode", "status", "reason"],
        m.inputs.map((u) => h("tr", null,
          h("td.name", null, named(u)),
          h("td.num.ask", { "data-h": "value" },
            manual
              ? editable("input " + u.name, num(u.value), `${u.name} by hand`, (text) => ask("input",
                m.name,
                { values: { [u.name]: text } },
                u.name + " by hand"))
              : num(u.value)),
          cell("law asks", num(u.law), ".num"),
          cell("limits", range(u.lower, u.upper)),
          cell("in force", range(u.active_lower, u.active_upper) + (u.active.length ? " · " + u.active.join(", ") : ""), ".ask"),
          cell("move ≤", u.move === null ? "–" : num(u.move, 4), ".num"),
          cell("mode",
            u.target === u.actual || u.target === "auto"
              ? `${u.target} · ${u.actual}`
              : `asked ${u.target}, is ${u.actual}`, ".ask"),
          statusCell(u),
          reasonCell(u)))),
      h("p.still", { title: m.why || null }, m.why ? [h("b", null, "The law is turned aside: "), m.why, "."] : null)]);
    put($("disturbances"), [
      m.disturbances.length
        ? table(["", "#value", "quality", "range", "status", "reason", ""],
          m.disturbances.map((d) => h("tr", null,
            h("td.name", null, named(d)),
            cell("value", num(d.value), ".num"),
            cell("quality", d.quality),
            cell("range", range(d.range[0], d.range[1])),
            statusCell(d),
            reasonCell(d),
            h("td.wide", null,
              m.external
                ? null
                : [
                  editable("disturb " + d.name, "disturb …", `disturbance ${d.name}`, (text) => ask("disturb",
                    m.name,
                    { values: { [d.name]: text } },
                    d.name)),
                  " ",
                  h("button.link",
                    { disabled: !may("operate"), onclick: () => ask("release", m.name, { names: [d.name] }, "release") },
                    "release")]))))
        : h("p.soft", null, "None is measured.")]);
  }
  const mine = S.alarms.filter((a) => a.loop === m.name);
  put($("loopalarms"), [mine.length ? alarmTable(mine) : h("p.soft", null, "None.")]);
  put($("nodes"), [
    table(["", "state", "reason", "#heard"],
      m.nodes.map((n) => h("tr", null,
        h("td.name", null, n.node),
        h("td", { "data-h": "state" },
          h("span.word." + (n.away > 2 ? "stale" : n.word), null, n.away > 2 ? "silent" : n.word)),
        h("td.reason", null, n.reason),
        cell("heard", n.away > 2 ? `${num(n.away, 2)} s ago` : "now", ".num"))))]);
  windowButtons(m);
  const now = performance.now();
  if (force || now - trendsAt > DRAWN || trendsOf !== S.series[m.name]) {
    trendsAt = now;
    trendsOf = S.series[m.name];
    trends(m);
  }
}
let trendsAt = 0, trendsOf = null;

function modeButtons(l) {
  const manual = l.mode === "manual", can = may("operate"), title = can ? null : "log in as operator";
  const button = (label, on, verb, args) => h("button.pad",
    {
      disabled: !can, title, "aria-pressed": on === null ? null : String(Boolean(on)),
      onclick: () => ask(verb, l.name, args || {}, label)
    },
    label);
  return [
    button("Auto", !manual, "auto"),
    button("Manual", manual, "manual"),
    button(l.held ? "Schedule is held: go on" : "Hold schedule", l.held || null, "hold", { on: !l.held }),
    l.trust === null || l.trust === undefined ? null : h("span", null, `model trusted ${num(100 * l.trust, 3)} %`)];
}

function windowButtons(m) {
  const now = store.get("window", "300");
  put($("window"), [
    h("h2", null, "Trends"),
    h("span.soft", null, "past:"),
    WINDOWS.map(([n, label]) => h("button",
      {
        "aria-pressed": String(String(n) === now),
        onclick: () => { store.set("window", String(n)); fetching[view.loop] = 0; fetchTrend(view.loop); }
      },
      label)),
    m.fast ? h("span.soft", null, `It goes fast: at least ${FAST_SPAN} samples, without the plan.`) : null,
    h("details", null,
      h("summary", null, "What the lines are"),
      h("p.soft", null,
        "Dark: measured, or sent. Dashed: setpoint. Dotted: reference. Right of the line “now”: the plan in the limits (solid) beside what the law alone would do (thin, orange); around it ± 2 standard deviations of what such plans missed lately. Trust in the model: grey where it has data, hatched orange where it has none. Red dashes: limits."))]);
}

// ---- trends

const charts = new Map();
const CH = 190;
function trends(m, whole) {
  const series = S.series[m.name || ""];
  if (!series || !series.steps.length) return;
  const index = (name) => series.columns.indexOf(name);
  const ahead = m.ahead && series.steps[series.steps.length - 1] >= m.ahead.step ? m.ahead : null;
  const [div, tu] = timeUnit((whole ? series.steps[series.steps.length - 1] : (m.step || 1)) * series.dt);
  const plots = m.outputs.map((y, j) => ({
    kind: "y", j, s: y,
    lines: [
      ["measured", y.name, "#1d232a", 1.8],
      ["setpoint", y.name + "_setpoint", "#56606b", 1.3, [7, 4]],
      ["reference", y.name + "_reference", "#56606b", 1.2, [2, 3]]]
  })).concat(m.inputs.map((u, j) => ({
    kind: "u", j, s: u,
    lines: [
      ["sent", u.name, "#1d232a", 1.8],
      ["law", u.name + "_base", "#a8560a", 1.1, [4, 2]],
      ["applied", u.name + "_applied", "#77808a", 1, [2, 3]]]
  }))).concat(m.disturbances.map((d, j) => ({ kind: "d", j, s: d, lines: [["measured", d.name, "#1d232a", 1.4]] })));
  plots.forEach((p) => {
    const lines = p.lines.filter(([, c]) => index(c) >= 0 && (series.data[index(c)].some((v) => v !== null)));
    const future = ahead && p.kind !== "d" ? ahead.n : 0;
    const xs = series.steps.map((k) => (k * series.dt) / div), n = xs.length, at0 = ahead ? ahead.step : 0;
    const first = p.kind === "y" ? 1 : 0;
    // The plan's first point is now: the samples after it are put behind the past, shared by all lines.
    const begin = future ? series.steps.indexOf(at0) : -1;
    const extra = [];
    for (let i = 0; i < future; ++i) { const k = at0 + i + first; if (k > series.steps[n - 1]) extra.push(i); }
    const data = [xs.concat(extra.map((i) => ((at0 + i + first) * series.dt) / div))];
    for (const [, c] of lines)
      data.push(series.data[index(c)].concat(extra.map((i) => (p.kind === "y" && c.endsWith("_reference") &&
        ahead.reference[p.j]
        ? ahead.reference[p.j][i]
        : p.kind === "y" && c.endsWith("_setpoint") ? p.s.working : null))));
    const plan = future ? (p.kind === "y" ? ahead.outputs : ahead.inputs)[p.j] : null,
      base = future ? (p.kind === "y" ? ahead.base_outputs : ahead.base_inputs)[p.j] : null,
      band = future && p.kind === "y" && ahead.band ? ahead.band[p.j] : null;
    const anchor = begin >= 0 && p.kind === "y" ? series.data[index(p.s.name)][begin] : null;
    const past = (value) => new Array(n).fill(null).map((_, i) => (i === begin && anchor !== null
      ? anchor
      : value && i >= begin && begin >= 0 ? value(i) : null));
    if (plan) {
      data.push(past(null).concat(extra.map((i) => plan[i]))); data.push(past(null).concat(extra.map((i) => base[i])));
    }
    const key = p.kind + p.s.name, names = lines.map((l) => l[0]).concat(plan ? ["plan", "law alone"] : []).join();
    let chart = charts.get(key);
    const width = Math.max(260, ($("charts").clientWidth - (window.innerWidth > 1000 ? 12 : 0)) / (window.innerWidth > 1000 ? 2 : 1));
    if (!chart || chart.names !== names || chart.tu !== tu || chart.mark !== mark) {
      if (chart) chart.box.remove();
      const box = h("div.chart", { role: "img" });
      chart = { box, names, tu, mark, extra: {} };
      const title = `${p.s.name}${p.s.unit && p.s.unit !== "-" ? " [" + p.s.unit + "]" : ""}`;
      const val = (u, v) => (v === null ? "–" : num(v));
      const paths = p.kind === "u" ? uPlot.paths.stepped({ align: 1 }) : undefined;
      const opts = {
        width, height: CH, title: undefined, cursor: { sync: { key: "run" }, drag: { x: true, y: false } },
        legend: { live: true },
        scales: { x: { time: false }, y: { range: (u, low, high) => scaleOf(low, high, chart.extra) } },
        axes: [
          {
            stroke: "#4a535d", grid: { stroke: "#c9ced3", width: 1 },
            values: (u, vs) => vs.map((v) => num(v, 6)), size: 28, font: "12px system-ui", ticks: { size: 4 }
          },
          {
            stroke: "#4a535d", grid: { stroke: "#c9ced3", width: 1 },
            values: (u, vs) => vs.map((v) => num(v, 6)), size: 58, font: "12px system-ui", ticks: { size: 4 }
          }],
        series: [
          {
            label: `time [${tu}]`,
            value: (u, v, i, k) => (v === null || v === undefined ? "–" : `${num(v, 6)} ${whenOf(chart, k)}`)
          }].concat(
          lines.map(([label, c, stroke, w, dash]) => ({
            label, stroke, width: w, dash, value: val, points: { show: false },
            paths: c.endsWith("_setpoint") ? uPlot.paths.stepped({ align: 1 }) : paths, spanGaps: false
          })),
          plan
            ? [
              { label: "plan", stroke: "#1f4e96", width: 1.8, value: val, points: { show: false }, paths },
              {
                label: "law alone", stroke: "#a8560a", width: 1.1, dash: [4, 2], value: val, points: { show: false },
                paths
              }]
            : []),
        hooks: { drawClear: [(u) => drawAhead(u, chart)], draw: [(u) => drawLimits(u, chart)] }
      };
      box.append(h("b", null, title));
      chart.plot = new uPlot(opts, data, box); charts.set(key, chart);
      const places = plots.map((q) => q.kind + q.s.name),
        next = places.slice(places.indexOf(key) + 1).map((k) => charts.get(k)).find((c) => c && c.box.parentNode);
      $("charts").insertBefore(box, next ? next.box : null);
    }
    chart.series = series;
    chart.extra = {
      now: future ? (at0 * series.dt) / div : null, x: data[0], n,
      band: band ? extra.map((i) => band[i]) : null,
      plan: plan ? extra.map((i) => plan[i]) : null,
      trust: future && ahead.trust ? extra.map((i) => ahead.trust[Math.min(i, ahead.trust.length - 1)]) : null,
      lower: p.kind === "y" ? p.s.lower : p.kind === "u" ? p.s.lower : null,
      upper: p.kind === "y" ? p.s.upper : p.kind === "u" ? p.s.upper : null
    };
    chart.box.setAttribute("aria-label",
      `${p.s.name}: now ${num(p.s.value)}${unit(p.s.unit)}` +
        (p.s.working !== undefined ? `, setpoint ${num(p.s.working)}` : "") +
        (plan ? `, planned ${num(plan[plan.length - 1])} after ${plan.length} samples` : ""));
    if (Math.abs(chart.plot.width - width) > 3) chart.plot.setSize({ width, height: CH });
    if (!chart.plot.select.width || chart.plot.scales.x.min === null) chart.plot.setData(data); else chart.plot.setData(data, true);
  });
}
function whenOf(chart, i) {
  const t = chart.series && chart.series.wall ? chart.series.wall[i] : null;
  return t ? "(" + wall(t) + ")" : "";
}
function scaleOf(low, high, e) {
  if (low === null || low === undefined || !isFinite(low)) return [0, 1];
  if (e.band && e.plan)
    e.plan.forEach((v, i) => {
      if (v !== null && e.band[i] !== null && isFinite(e.band[i])) {
        const cap = 1.5 * (high - low || 1);
        low = Math.min(low, Math.max(v - e.band[i], v - cap));
        high = Math.max(high, Math.min(v + e.band[i], v + cap));
      }
    });
  const least = 2e-3 * Math.max(Math.abs(high), Math.abs(low));  // a quiet process looks quiet
  if (high - low < least) { const middle = (high + low) / 2; low = middle - least / 2; high = middle + least / 2; }
  const span = high - low || 1;
  for (const v of [e.lower, e.upper])
    if (v !== null && v !== undefined) {
      if (v > high && v - high < 0.25 * span) high = v;
      if (v < low && low - v < 0.25 * span) low = v;
    }
  return [low - 0.06 * span, high + 0.06 * span];
}
function hatch(c) {
  const p = document.createElement("canvas"); p.width = p.height = 8; const d = p.getContext("2d");
  d.fillStyle = "rgba(226,150,60,.35)";
  d.fillRect(0, 0, 8, 8);
  d.strokeStyle = "rgba(150,70,0,.75)";
  d.lineWidth = 1.4;
  d.beginPath();
  d.moveTo(0, 8);
  d.lineTo(8, 0);
  d.stroke();
  return c.createPattern(p, "repeat");
}
/* The fan: as wide as plans missed lately, step by step in the colour of the trust in the model there. */
function drawAhead(u, chart) {
  const e = chart.extra, c = u.ctx;
  if (!e.plan || !e.plan.length) return;
  const X = (i) => u.valToPos(e.x[e.n + i], "x", true), Y = (v) => u.valToPos(v, "y", true), { left, top, width, height } = u.bbox;
  c.save(); c.beginPath(); c.rect(left, top, width, height); c.clip();
  const now = u.valToPos(e.now, "x", true);
  c.fillStyle = "rgba(255,255,255,.45)"; c.fillRect(now, top, left + width - now, height);
  const pattern = hatch(c), least = 3 * (window.devicePixelRatio || 1);
  for (let i = 0; i < e.plan.length; ++i) {
    const x0 = i ? X(i - 1) : now, x1 = X(i),
      half = (k) => Math.max(least, e.band && isFinite(e.band[k]) ? Math.abs(Y(e.plan[k] + e.band[k]) - Y(e.plan[k])) : 0),
      a = Math.max(i - 1, 0);
    const trust = e.trust ? e.trust[i] : 1;
    c.beginPath();
    c.moveTo(x0, Y(e.plan[a]) - half(a));
    c.lineTo(x1, Y(e.plan[i]) - half(i));
    c.lineTo(x1, Y(e.plan[i]) + half(i));
    c.lineTo(x0, Y(e.plan[a]) + half(a));
    c.closePath();
    c.fillStyle = `rgba(${Math.round(90 + 130 * (1 - trust))},${Math.round(110 + 30 * (1 - trust))},${Math.round(135 - 60 * (1 - trust))},.38)`;
    c.fill();
    if (trust < 0.5) { c.fillStyle = pattern; c.fill(); }
  }
  c.restore();
}
function drawLimits(u, chart) {
  const e = chart.extra, c = u.ctx, { left, top, width, height } = u.bbox, ratio = window.devicePixelRatio || 1;
  c.save(); c.beginPath(); c.rect(left, top, width, height); c.clip();
  c.lineWidth = 1.4 * ratio; c.setLineDash([8 * ratio, 5 * ratio]); c.strokeStyle = "#b3121d";
  for (const v of [e.lower, e.upper])
    if (v !== null && v !== undefined && v >= u.scales.y.min && v <= u.scales.y.max) {
      const y = u.valToPos(v, "y", true);
      c.beginPath();
      c.moveTo(left, y);
      c.lineTo(left + width, y);
      c.stroke();
    }
  if (e.now !== null && e.now !== undefined) {
    const x = u.valToPos(e.now, "x", true);
    c.setLineDash([]);
    c.strokeStyle = "#4a535d";
    c.lineWidth = ratio;
    c.beginPath();
    c.moveTo(x, top);
    c.lineTo(x, top + height);
    c.stroke();
    c.fillStyle = "#4a535d";
    c.font = `${11 * ratio}px system-ui`;
    c.fillText("now", x + 3 * ratio, top + 11 * ratio);
    if (e.trust && e.trust.some((t) => t < 0.5)) {
      const at = e.trust.findIndex((t) => t < 0.5);
      c.fillStyle = "#7a3c00";
      c.textAlign = "right";
      c.fillText(
        at ? `model has no data after ${at} samples` : "model has no data here",
        left + width - 4 * ratio,
        top + height - 5 * ratio);
    }
  }
  c.restore();
}

// ---- alarms and journal

const STATE = {
  unacknowledged: "unacknowledged", acknowledged: "acknowledged", returned: "gone, unacknowledged", shelved: "shelved",
  suppressed: "suppressed by design", out_of_service: "out of service", normal: "normal"
};
function alarmTable(list) {
  const can = may("operate"),
    button = (label, verb, a, args, role) => h("button.pad",
      {
        disabled: !may(role || "operate"), title: can ? null : "log in as operator",
        onclick: () => ask(verb, a.loop, { key: a.key, ...args }, `${verb} ${a.code}`)
      },
      label);
  return table(["", "state", "loop", "alarm", "what to do", "since", ""],
    list.map((a) => h("tr", null,
      h("td", null, alarmMark(a), " ", h("span.soft", null, PRIORITY[a.priority])),
      h("td", { "data-h": "state" },
        STATE[a.state],
        a.state === "shelved" ? ` until ${wall(a.shelved_until)}` : "",
        a.by ? ` by ${a.by}` : ""),
      h("td", { "data-h": "loop" }, h("a", { href: loopPath(a.loop) }, a.loop)),
      h("td.reason", null,
        h("b", null, a.code),
        a.signal ? " " + a.signal : "",
        ": " + a.text,
        a.first_out ? h("b", null, " · first out") : null,
        a.count > 1 ? ` · ${a.count} times` : ""),
      h("td.reason", null, remedy(a.code)),
      h("td", { "data-h": "since" },
        wall(a.since, true),
        ` · sample ${a.step}`,
        a.state === "returned" ? `, gone ${wall(a.gone)}` : ""),
      h("td.wide", null,
        h("div.row", null,
          a.state === "unacknowledged" || a.state === "returned" ? button("Acknowledge", "acknowledge", a) : null,
          a.state === "shelved"
            ? button("Unshelve", "unshelve", a)
            : a.state === "out_of_service"
              ? null
              : h("button.pad", { disabled: !can, onclick: () => shelve(a) }, "Shelve …"),
          may("engineer")
            ? button(
              a.out_of_service ? "Into service" : "Out of service",
              "service",
              a,
              { on: a.out_of_service },
              "engineer")
            : null)))));
}
function alarmsView() {
  if (drawn !== "alarms") {
    $("main").replaceChildren(h("section.card", { "aria-label": "Alarms" },
      h("div.row", { id: "ahead" }),
      h("div.scroll", { id: "alarmlist" })));
    drawn = "alarms";
  }
  const open = S.alarms.filter((a) => a.state === "unacknowledged" || a.state === "returned").length;
  put($("ahead"), [
    h("h1", null, "Alarms"),
    h("span.soft", null, `${S.alarms.length} not normal, ${open} to acknowledge`),
    h("button.pad.end",
      { disabled: !may("operate") || !open, onclick: () => ask("acknowledge_all", "", {}, "acknowledge all") },
      "Acknowledge all")]);
  put($("alarmlist"), [S.alarms.length ? alarmTable(S.alarms) : h("p.soft", null, "All alarms are normal.")]);
}
/* What was asked, as it is in the journal: {"values":{"x":"2100"},"decimal":"."}. */
function wish(note) {
  const words = (v) => (v && typeof v === "object"
    ? Object.entries(v).filter(([k]) => k !== "decimal").map(([k, w]) => `${k} ${words(w)}`).join(", ")
    : String(v));
  try { return words(JSON.parse(note)); } catch (e) { return note; }
}
function journalView() {
  if (drawn !== "journal") {
    $("main").replaceChildren(h("section.card", { "aria-label": "Journal" },
      h("h1", null, "Journal"),
      h("p.soft", null,
        "What was asked, by whom, what became of it; alarms; the newest first. It survives a restart of the panel."),
      h("div.scroll", { id: "entries" }),
      h("button",
        {
          onclick: async () => {
            const n = S.journal.length ? S.journal[0].n : null;
            const older = await get("api/journal" + (n ? "?before=" + n : ""));
            S.journal = older.concat(S.journal);
            render();
          }
        },
        "Older ones")));
    drawn = "journal";
  }
  put($("entries"), [
    table(["time", "loop", "what", "who", "detail"],
      [...S.journal].reverse().slice(0, 1500).map((e) => h("tr", null,
        cell("", wall(e.t, true), ".num"),
        cell("loop", e.loop || ""),
        cell("", e.kind === "command" ? `${e.verb}: ${e.what}` : `${e.kind} ${e.what}`),
        cell("by", e.who || ""),
        h("td.reason", null,
          [
            e.code ? `${e.code}${e.signal ? " " + e.signal : ""}: ${e.text}` : "",
            e.what === "requested" ? wish(e.note) : e.note,
            e.loop && (e.step ?? null) !== null ? `sample ${e.step}` : ""].filter(Boolean).join(" · ")))))]);
}

// ---- model and settings

let modelAt = 0, modelData = {};
const typed = {};  // what somebody typed and has not sent yet: drawing anew keeps it, and moves handlers to other elements
async function modelView() {
  if (Date.now() - modelAt > 900) {
    modelAt = Date.now();
    try {
      modelData[view.loop] = await get("api/model?loop=" + encodeURIComponent(view.loop));
    } catch (e) { /* the next one */ }
  }
  const got = modelData[view.loop];
  if (!got || view.tab !== "model" || $("model").contains(document.activeElement) && document.activeElement.tagName === "INPUT") return;
  const m = got.model, parts = [];
  if (!m)
    parts.push(h("section.card", null,
      h("h2", null, "Model"),
      h("p", null, "This loop's law uses no fuzzy model, or none has come yet.")));
  else {
    const bar = (w) => [
      h("span.barbox", null, h("span.bar", { "data-w": w === null ? 0 : w })),
      w === null ? "–" : h("span.num", null, w < 5e-4 ? "0 %" : num(100 * w, 3) + " %")];
    parts.push(h("section.card", null,
      h("h2", null, m.name),
      h("p.soft", null, m.source),
      h("p", null,
        m.trust_here === null
          ? m.trust_known
            ? "No trust: one of its signals has no value now."
            : "No trust: the model does not say where its data were."
          : `Trusted here by ${num(100 * m.trust_here, 3)} %` +
            (m.trust_here < 0.5 ? ": the process is where the model has few data." : ".")),
      h("div.scroll", null,
        table(["signal", "#now", "range of the data"],
          m.signals.map((s) => h("tr", null,
            h("td.name", null, named(s)),
            cell("now", num(s.value), ".num"),
            cell("data",
              range(s.lower, s.upper) +
                (s.value !== null && (s.lower !== null && s.value < s.lower || s.upper !== null && s.value > s.upper)
                  ? " · outside"
                  : ""))))))));
    for (const o of m.rules)
      parts.push(h("section.card", null,
        h("h2", null, `Rules of ${o.output}`),
        h("p.soft", null,
          "If " + (o.antecedents.map((a) => `${lagged(a)} = ${num(a.value)}`).join(", ") || "always") +
            ": weight of each rule now"),
        h("div.scroll", null,
          table(["rule", "weight", "memberships", "#data", `${o.output}(k+1) =`],
            o.rules.map((r, i) => h("tr", null,
              h("td.name", null, String(i + 1)),
              h("td", { "data-h": "weight" }, bar(r.weight)),
              cell("sets",
                r.degrees.length
                  ? r.degrees.map((d, q) => `${lagged(o.antecedents[q])} ${d < 5e-4 ? "0" : num(d, 3)}`).join(", ")
                  : r.center.length ? "around " + r.center.map((v) => num(v, 4)).join(", ") : "–",
                ".wide"),
              cell("data", r.data ? String(r.data) : "–", ".num"),
              h("td.reason", null,
                r.coefficients.map((c, q) => `${num(c, 4)} ${lagged(o.regressors[q])}`).concat([num(r.offset, 4)]).join(" + ").replace(/\+ \u2212/g, "− "))))))));
    parts.push(h("div.cols", null,
      h("section.card", null,
        h("h2", null, "Gains here"),
        m.gains
          ? h("div.scroll", null,
            table(
              [""].concat(m.inputs.map((u) => "#" + u)),
              m.outputs.map((y, i) => h("tr", null,
                h("td.name", null, y),
                m.gains[i].map((g, q) => cell(
                  m.inputs[q],
                  num(g, 4) + unit(m.units[y]) + (unit(m.units[m.inputs[q]]) && " per" + unit(m.units[m.inputs[q]])),
                  ".num"))))))
          : h("p.soft", null, "None: the local model integrates, drifts, or the law publishes none."),
        h("h2", null, "Poles here"),
        h("p", null,
          m.poles.length
            ? m.poles.map(([a, b]) => (b ? `${num(a, 4)} ${b > 0 ? "+" : "−"} ${num(Math.abs(b), 4)} i` : num(a, 4))).join("; ")
            : "–")),
      h("section.card", null,
        h("h2", null, "How plans came true"),
        m.rms.length
          ? h("div.scroll", null,
            table(
              ["#samples ahead"].concat(m.outputs.map((y) => `#${y}, rms error`)),
              m.rms.map((r) => h("tr", null,
                cell("ahead", String(r.ahead), ".num"),
                r.rms.map((v, q) => cell(m.outputs[q], num(v, 4) + unit(m.units[m.outputs[q]]), ".num"))))))
          : h("p.soft", null, "Too few samples yet: it counts while somebody looks at this loop."))));
  }
  const adapt = (on) => h("button.pad",
    { disabled: !may("operate"), onclick: () => ask("adapt", view.loop, { on }, on ? "adapt" : "freeze") },
    on ? "Adapt" : "Freeze");
  const field = (s) => {
    const own = view.loop + " " + s.key,
      now = mark === "," && typeof s.value === "number" ? String(s.value).replace(".", ",") : String(s.value);
    const input = h("input", {
      "aria-label": s.key, value: own in typed ? typed[own] : now, disabled: !may("engineer"),
      oninput: (e) => { typed[own] = e.target.value; }
    });
    return h("tr", null,
      h("td.name", null, s.key),
      h("td", null,
        h("div.row", null,
          input,
          h("button.pad",
            {
              disabled: !may("engineer"),
              onclick: () => {
                const value = own in typed ? typed[own] : now;
                delete typed[own];
                ask("setting", view.loop, { key: s.key, value }, s.key);
              }
            },
            "Set"))),
      h("td.reason", null, s.about));
  };
  parts.push(h("section.card", null,
    h("h2", null, "Settings of the law"),
    may("engineer") ? null : h("p.soft", null, "Log in as engineer to change them."),
    got.settings.length
      ? h("div.scroll", null, table(["", "value", "what it is"], got.settings.map(field)))
      : h("p.soft", null, "It has none."),
    h("div.row", null, h("span", null, "A law that changes itself:"), adapt(false), adapt(true))));
  if (m) {
    const rows = h("input", {
      value: typed.samples || "500", "aria-label": "samples", inputmode: "numeric",
      oninput: (e) => { typed.samples = e.target.value; }
    });
    const go = (use) => () => ask("identify", view.loop, { window: parseInt(typed.samples || "500", 10) || 0, use }, "identification");
    parts.push(h("section.card", null,
      h("h2", null, "Identify from this run"),
      h("div.row", null,
        h("label", null, "newest samples (0: all) ", rows),
        h("button.pad", { disabled: !may("engineer"), onclick: go(false) }, "Try"),
        h("button.pad", { disabled: !may("engineer"), onclick: go(true) }, "Identify and use")),
      h("p.soft", null,
        "Try says how well it fits and changes nothing; the model in use stays until another one is accepted.")));
  }
  put($("model"), parts);
  for (const bar of document.querySelectorAll("[data-w]")) bar.style.width = 100 * Number(bar.dataset.w) + "%";
}

// ---- a finished run in a file (`fmbpc page`)

function fileView() {
  if (drawn === "file") { const m = FILE.loop; trends(m, true); return; }
  drawn = "file";
  const m = FILE.loop;
  S.series[m.name] = FILE.series; S.events = FILE.remedies;
  document.title = m.title;
  $("main").replaceChildren(
    h("section.card", null,
      h("div.row", null,
        h("h1", null, m.title),
        h("span.word." + (FILE.complete ? "good" : "limited"), null, FILE.complete ? "complete" : "not complete")),
      h("p.soft", null,
        `${FILE.samples} samples, ${runTime(m.step * FILE.series.dt)}; drag over a trend to enlarge it, double-click for the whole.`)),
    h("section.card", null, h("h2", null, "Trends"), h("div.cols", { id: "charts" })),
    h("section.card", null,
      h("h2", null, "Indices"),
      h("div.scroll", null,
        table(["output", "#ISE", "#IAE", "#ITAE", "#rmse"],
          Object.entries(FILE.outputs).map(([name, o]) => h("tr", null,
            h("td.name", null, `${name} [${o.unit}]`),
            ["ise", "iae", "itae", "rmse"].map((k) => cell(k, num(o[k], 4), ".num"))))))),
    h("section.card", null,
      h("h2", null, "What went otherwise than asked"),
      FILE.events.length
        ? h("div.scroll", null,
          table(["", "code", "#samples", "what", "what to do"],
            FILE.events.map((e) => {
              const p = { error: 1, warning: 2, info: 3 }[e.severity] || 2;
              return h("tr", null,
                h("td", null, h("span.mark.p" + p, null, MARKS[p]), " " + e.severity),
                cell("", e.code + (e.signal ? " " + e.signal : "")),
                cell("samples", e.count ? `${e.first} … ${e.last} (${e.count})` : "whole run", ".num"),
                h("td.reason", null, e.text),
                h("td.reason", null, remedy(e.code)));
            })))
        : h("p.soft", null, "Nothing.")));
  trends(m, true);
}

// ---- routes and keys

function route() {
  const parts = decodeURIComponent(location.hash.replace(/^#\/?/, "")).split("/"), before = view.loop;
  const hash = location.hash.replace(/^#\/?/, "").split("/");
  view = hash[0] === "loop"
    ? { kind: "loop", loop: decodeURIComponent(hash[1] || ""), tab: hash[2] === "model" ? "model" : "operate" }
    : { kind: parts[0] === "alarms" || parts[0] === "journal" ? parts[0] : "overview" };
  drawn = null;
  if (FILE) { fileView(); return; }
  if (view.loop !== before || !source) connect();
  if (view.kind === "overview") fetchSparks();
  renderHeader(); render(true);
}
function render(force) {
  if (FILE) { fileView(); return; }
  if (view.kind === "loop") loopView(force === true);
  else if (view.kind === "alarms") alarmsView(); else if (view.kind === "journal") journalView(); else overview();
}
addEventListener("hashchange", () => { route(); $("main").focus({ preventScroll: true }); scrollTo(0, 0); });
addEventListener("visibilitychange", () => { if (!FILE) connect(); render(true); });
addEventListener("resize", () => { clearTimeout(addEventListener.later); addEventListener.later = setTimeout(() => render(true), 150); });
addEventListener("keydown", (e) => {
  if (e.ctrlKey || e.altKey || e.metaKey || /INPUT|SELECT|TEXTAREA/.test(e.target.tagName) || $("dialog").open || FILE) return;
  const to = { o: "#/", a: "#/alarms", j: "#/journal" }[e.key] ||
    (/^[1-9]$/.test(e.key) && S.loops[e.key - 1] ? loopPath(S.loops[e.key - 1].name) : null);
  if (to) location.hash = to;
});
if (!FILE) {
  setInterval(() => { if (view.kind === "overview") fetchSparks(); }, 5000);
  setInterval(() => { if (view.tab === "model") render(); }, 1000);
}
window.fmbpcPanel = S;
renderHeader(); route();
})();
