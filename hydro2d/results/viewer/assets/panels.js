"use strict";
// What stands beside the sections: the numbers of a cell, the plot along a line, the histories.

const SAMPLES = 500, TIPPED = 4, USUAL = ["penetration_depth_m", "rod_tail_velocity_m_s", "rod_length_m", "rod_max_plastic_strain"];
/** Beginnings of names of columns, and what the columns belong to. */
const KINDS = { body: "Bodies", tracer: "Tracers", gauge: "Gauges", sink: "Sinks of the audit" };

function element(name, options = {}, ...children) {
  const made = Object.assign(document.createElement(name), options);
  made.append(...children);
  return made;
}

/** Says something for a moment, to the ear as well. */
function say(text) {
  const place = document.getElementById("said");
  place.textContent = text;
  clearTimeout(say.timer);
  say.timer = setTimeout(() => { place.textContent = ""; }, 2500);
}

/** A table as CSV: rows of texts and numbers under heads. */
function csv(heads, rows) {
  const cell = (value) => (typeof value === "number" ? (Number.isFinite(value) ? String(value) : "") :
    /[",\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value);
  return [heads, ...rows].map((row) => row.map(cell).join(",")).join("\n") + "\n";
}

function save(name, text) {
  const link = element("a", { href: URL.createObjectURL(new Blob([text], { type: "text/csv" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  say(`${name} is saved`);
}

async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    say("Copied");
  } catch {
    say("The browser does not allow copying here; save the CSV instead");
  }
}

/** Buttons that copy and save what `table` gives: [heads, rows], or nothing. */
function offer(place, name, table) {
  const given = async (action) => {
    const found = await table();
    if (found) action(csv(...found)); else say("There is nothing to save yet");
  };
  place.querySelector(".copy").addEventListener("click", () => given(copy));
  place.querySelector(".save").addEventListener("click", () => given((text) => save(`${name()}.csv`, text)));
}

function unitOf(unit) {
  return unit ? ` [${unit}]` : "";
}

/** A number rounded to the first digit of its error. */
function measured(value, error) {
  if (!Number.isFinite(value)) return "–";
  const step = error > 0 ? 10 ** Math.floor(Math.log10(error)) : 0;
  return plainNumber(step ? Math.round(value / step) * step : value, 7);
}

// ------------------------------------------------------------------------------------------------------------ a cell

/** Rows of the marked cell in a section: place, then each stored field with its error. */
async function probed(section) {
  const { run, n } = section, cell = state.probe && section.cellAt(state.probe);
  if (!cell) return null;
  const [j, i] = cell, k = j * run.nr + i, shift = run.shifts[n];
  const rounded = (length) => Number(length.toFixed(4));
  const middle = (edges, at) => (0.5 * (edges[at] + edges[at + 1])) * MM;
  const rows = new Map([["r", { value: rounded(middle(run.r_edges, i)), error: 0 }],
                        ["z", { value: rounded(middle(run.z_edges, j) + shift * MM), error: 0 }],
                        ["i", { value: i, error: 0 }], ["j", { value: j, error: 0 }]]);
  const found = await Promise.all(run.fields.map((field) => run.values(n, field.word)));
  run.fields.forEach((field, at) => rows.set(field.word, { value: found[at][k], error: run.error(n, field.word) }));
  return rows;
}

/** What the rows of a cell are called, part by part: [title, [[key, name, unit], ...]]. */
function probeParts() {
  const fields = [...new Map(RUNS.flatMap((run) => run.fields).map((field) => [field.word, field])).values()];
  const rows = (chosen) => chosen.map((field) => [field.word, field.title, field.unit]);
  const bodies = [...new Set(RUNS.flatMap((run) => run.bodies))];
  return [
    ["Place", [["r", "r, centre", "mm"], ["z", "z, centre", "mm"], ["i", "cell along r", ""], ["j", "cell along z", ""]]],
    ["Cell", rows(fields.filter((field) => !field.body))],
    ...bodies.map((body) => [body, rows(fields.filter((field) => field.body === body))]),
  ];
}

async function drawProbe() {
  const place = document.querySelector("#probe .scroll"), found = await Promise.all(SECTIONS.map(probed));
  drawProbe.rows = found;
  SECTIONS.forEach((section, number) => fillTip(section, found[number]));
  if (found.every((rows) => !rows)) {
    place.replaceChildren(element("p", { className: "hint", textContent: "Click into a section for all numbers of a cell." }));
    return;
  }
  const head = element("tr", {}, element("th", { textContent: "" }));
  for (const { run } of SECTIONS) head.append(element("th", { textContent: SECTIONS.length > 1 ? run.label : "value" }));
  head.append(element("th", { textContent: "±", title: "largest error of the number in this page" }));
  const body = element("tbody");
  for (const [title, rows] of probeParts()) {
    const shown = rows.filter(([key]) => found.some((each) => each && each.has(key)));
    if (shown.length) body.append(element("tr", { className: "part" }, element("th", { textContent: title, colSpan: 4 })));
    for (const row of shown) body.append(probeRow(row, found));
  }
  const top = place.scrollTop;
  place.replaceChildren(element("table", {}, element("thead", {}, head), body));
  place.scrollTop = top;
}

/** The first numbers of the marked cell, which stand beside it where the table of all numbers is out of sight. */
function fillTip(section, rows) {
  const { run, tip } = section, line = (name, value) => element("span", {}, element("span", { textContent: name }),
    element("b", { textContent: value }));
  const words = [...new Set([...shownWords(), "velocity", ...FIRST_WORDS])]
    .filter((word) => word !== "material" && rows && rows.has(word)).slice(0, TIPPED);
  const place = rows ? [line("z, r [mm]", ["z", "r"].map((key) => plainNumber(rows.get(key).value, 4)).join(", ")),
    line("body", run.bodies[rows.get("material").value - 1] || "void")] : [];
  tip.replaceChildren(...place, ...words.map((word) => {
    const { value, error } = rows.get(word);
    return line(titleOf(word), plainNumber(Number(measured(value, error).replace("−", "-")), 4));
  }));
  section.placeTip();
}

function probeRow([key, name, unit], found) {
  const row = element("tr", {}, element("th", { scope: "row", textContent: name + unitOf(unit) })), errors = [];
  row.dataset.word = key;
  for (const rows of found) {
    const { value, error } = (rows && rows.get(key)) || { value: NaN, error: 0 };
    errors.push(error);
    const cell = element("td", { textContent: measured(value, error) });
    cell.dataset.value = value;
    row.append(cell);
  }
  const error = Math.max(...errors);
  row.append(element("td", { className: "faint", textContent: error ? plainNumber(error, 1) : "" }));
  return row;
}

function probeTable() {
  const found = drawProbe.rows || [];
  if (found.every((rows) => !rows)) return null;
  const heads = ["quantity", "unit", ...SECTIONS.flatMap(({ run, n }) =>
    [`${run.label} at ${timeText(run.times[n])}`, `largest error in ${run.label}`])];
  const rows = probeParts().flatMap(([title, part]) => part.map(([key, name, unit]) => [
    title === "Place" || title === "Cell" ? name : `${name} of ${title}`, unit,
    ...found.map((each) => (each && each.get(key)) || { value: NaN, error: NaN }).flatMap(({ value, error }) => [value, error]),
  ]));
  return [heads, rows];
}

// ------------------------------------------------------------------------------------------------------------ a line

/** The field that is plotted along the line: that of the half in which it begins. */
function lineWord() {
  return shownWords()[state.line ? SECTIONS[0].half(state.line[0].y) : 0];
}

/** Values along the marked line in a section: distances in mm, values, and places r, z in mm. */
async function along(section) {
  const { run, n } = section, values = await run.drawn(n, lineWord()), [a, b] = state.line;
  const length = Math.hypot(b.x - a.x, b.y - a.y), found = { x: [], y: [], r: [], z: [] };
  for (let k = 0; k <= SAMPLES; k++) {
    const part = k / SAMPLES, at = { x: a.x + part * (b.x - a.x), y: a.y + part * (b.y - a.y) }, cell = section.cellAt(at);
    found.x.push(part * length);
    found.y.push(cell ? values[cell[0] * run.nr + cell[1]] : NaN);
    found.r.push(run.mirrored ? Math.abs(at.y) : at.y);
    found.z.push(at.x + section.offset);
  }
  return found;
}

function curveColour(number) {
  return inkOfPage().curves[number];
}

async function drawLine(card) {
  const place = card.querySelector(".value"), title = card.querySelector("h2");
  title.textContent = `Along the line: ${titleOf(lineWord())}`;
  if (!state.line) {
    place.textContent = "Drag over a section to plot its field along a line.";
    card.found = null;
    prepared(card.querySelector("canvas"));
    return;
  }
  const ends = state.line.map(({ x, y }) =>
    `z ${plainNumber(x + SECTIONS[0].offset, 4)}, r ${plainNumber(SECTIONS[0].run.mirrored ? Math.abs(y) : y, 3)}`);
  place.textContent = `from ${ends[0]} to ${ends[1]} mm`;
  card.found = await Promise.all(SECTIONS.map(along));
  const curves = card.found.map(({ x, y }, number) => ({ x, y, colour: curveColour(number) }));
  drawChart(card.querySelector("canvas"), { curves, xTitle: "distance [mm]", yRange: lineRange(card.found.map(({ y }) => y)) });
}

/** The range of the plot along a line: that of what is plotted and of the colours, where these stand still in time. */
function lineRange(arrays) {
  const word = lineWord(), fields = RUNS.map((run) => run.byWord.get(word)).filter(Boolean);
  const ends = state.limits.has(word) || state.range === "now" ? [] : fields.flatMap((field) => field.ranges[state.clip]);
  return extent([...arrays, ends]) || undefined;
}

function lineTable(card) {
  if (!card.found) return null;
  const field = fieldOf(lineWord()), heads = ["distance [mm]", ...SECTIONS.flatMap(({ run }) => {
    const name = SECTIONS.length > 1 ? ` of ${run.label}` : "";
    return [`r${name} [mm]`, `z${name} [mm]`, `${titleOf(field.word, false)}${name}${unitOf(field.unit)}`];
  })];
  return [heads, card.found[0].x.map((x, k) => [x, ...card.found.flatMap((each) => [each.r[k], each.z[k], each.y[k]])])];
}

// -------------------------------------------------------------------------------------------------------- histories

function columnsOfRuns() {
  const found = new Map();
  for (const run of RUNS) for (const column of run.history ? run.history.columns : []) found.set(column.name, column);
  return found;
}

/** The columns that are plotted at first: the usual ones that the runs have, then those of motion, then any. */
function firstColumns() {
  const names = [...columnsOfRuns().keys()], usual = USUAL.filter((name) => names.includes(name));
  const moving = [/velocity(_z)?_m_s$/, /^kinetic_energy/, /kinetic_energy_J$/, /_max_m$/].flatMap((kind) =>
    names.filter((name) => kind.test(name)));
  return [...new Set([...usual, ...moving, ...names])].slice(0, 5);
}

/** The depth of the experiment, mm, for the history of the depth, unless the run is still far from it. */
function levelOf(name, curves) {
  const depth = RUNS.map((run) => run.measured.depth).find((each) => each !== null);
  if (name !== "penetration_depth_m" || depth === undefined) return undefined;
  const reached = curves.some(({ y }) => y.some((each) => each * 2 > depth * MM));
  return reached ? depth * MM : undefined;
}

async function drawHistory(card) {
  const name = card.querySelector("select").value, column = columnsOfRuns().get(name), time = TIMES[state.step];
  const runs = RUNS.filter((run) => run.history && run.history.columns.some((each) => each.name === name));
  const found = await Promise.all(runs.map(async (run) => ({ run, t: await run.column("time"), y: await run.column(name) })));
  const curves = found.map(({ run, t, y }) => ({ x: t.map((each) => each * TIME_SCALE), y, colour: curveColour(run.number) }));
  const last = Math.max(TIMES[TIMES.length - 1] * TIME_SCALE, ...curves.map((curve) => curve.x[curve.x.length - 1]));
  card.axis = drawChart(card.querySelector("canvas"), { curves, xTitle: `t [${TIME_UNIT}]`,
    xRange: [Math.min(0, TIMES[0] * TIME_SCALE), last], cursor: time * TIME_SCALE, level: levelOf(name, curves) });
  card.found = found;
  const regimes = runs[0].history.regimes;
  const write = (value) => (name === "regime" ? regimes[Math.round(value)] || "not known" : plainNumber(value, 5));
  card.querySelector(".value").replaceChildren(...found.map(({ run, t, y }) => {
    const said = element("span", { textContent: `${write(interpolated(t, y, time))} ${column.unit}` });
    if (RUNS.length > 1) said.style.color = curveColour(run.number);
    return said;
  }));
}

/** Rows of a history: time and value of each run, in the order of the runs. */
function historyTable(card) {
  const name = card.querySelector("select").value, column = columnsOfRuns().get(name);
  const heads = ["run", `time [${TIME_UNIT}]`, `${column.label}${unitOf(column.unit)}`];
  return [heads, card.found.flatMap(({ run, t, y }) => Array.from(t, (time, k) => [run.label, time * TIME_SCALE, y[k]]))];
}

function chartCard(kind, head, label) {
  const button = (className, textContent) => element("button", { type: "button", className, textContent });
  const buttons = element("span", { className: "buttons" }, button("copy", "Copy"), button("save", "CSV"));
  const canvas = element("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", label);
  return element("section", { className: `card chart ${kind}` }, element("div", { className: "head" }, head, buttons),
    element("span", { className: "value" }), canvas);
}

function lineCard() {
  const card = chartCard("line", element("h2"), "Field along the line that is dragged over a section");
  card.draw = () => drawLine(card);
  offer(card, () => `${lineWord().replaceAll(":", "_")}_along_a_line`, () => lineTable(card));
  return card;
}

/** Fills a choice of columns: those of the run, then of each kind of thing. */
function fillColumns(select) {
  const kind = (name) => { const first = name.split("_")[0]; return first in KINDS ? first : ""; };
  const columns = [...columnsOfRuns().values()];
  for (const [first, label] of [["", "Run"], ...Object.entries(KINDS)]) {
    const group = element("optgroup", { label });
    for (const column of columns.filter((each) => kind(each.name) === first))
      group.append(element("option", { value: column.name, textContent: column.label + unitOf(column.unit) }));
    if (group.children.length) select.append(group);
  }
}

function historyCard(name) {
  const select = element("select");
  select.setAttribute("aria-label", "Quantity of the history");
  fillColumns(select);
  select.value = name;
  const card = chartCard("history", select, "History; a click goes to that time");
  card.draw = () => drawHistory(card);
  select.addEventListener("change", card.draw);
  const canvas = card.querySelector("canvas"), go = (event) => {
    if (event.type === "pointermove" && !event.buttons || !card.axis) return;
    goTo(nearestStep(card.axis.at(event.clientX - canvas.getBoundingClientRect().left) / TIME_SCALE));
  };
  canvas.addEventListener("pointerdown", go);
  canvas.addEventListener("pointermove", go);
  offer(card, () => select.value, () => historyTable(card));
  return card;
}
