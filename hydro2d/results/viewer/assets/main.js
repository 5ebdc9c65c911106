"use strict";
// What is shown now, and the page drawn from it.

const RUNS = PAGE.runs.map((table, number) => new Run(table, TEXTS[number], number));
const TIMES = sliderTimes(RUNS);
const [TIME_UNIT, TIME_SCALE] = unitOfTimes(RUNS);
const FIRST_WORDS = ["pressure", "von_mises", "plastic_strain", "density", "velocity"];

const state = {
  step: TIMES.length - 1, words: [], range: "all", limits: new Map(), clip: 1, map: "viridis", log: false,
  view: { x: 0, y: 0, scale: 1 }, travel: true, drag: "line", outlines: true, stations: true, cells: false,
  line: null, probe: null, playing: false,
};
const SECTIONS = [];
let latest = 0;

function fieldOf(word) {
  return RUNS.map((run) => run.byWord.get(word)).find(Boolean);
}

function timeText(time) {
  return `${(time * TIME_SCALE).toFixed(2)} ${TIME_UNIT}`;
}

/** What a field is called, with its body, and its unit if that is wanted. */
function titleOf(word, unit = true) {
  const field = fieldOf(word);
  if (!field) return "";
  return `${field.title}${field.body ? ` of ${field.body}` : ""}${unit ? unitOf(field.unit) : ""}`;
}

/** The fields of the upper and the lower half. */
function shownWords() {
  return RUNS.some((run) => run.mirrored) ? state.words : [state.words[0], state.words[0]];
}

/** Draws the page for the present state, unless it has changed again before all numbers are there. */
async function update() {
  const mine = ++latest, words = shownWords();
  showTime();
  SECTIONS.forEach((section) => { section.n = section.run.nearest(TIMES[state.step]); });
  const found = await Promise.all(SECTIONS.map(numbersOf));
  if (mine !== latest) return;
  drawn = { found, scales: words.map((word, half) => scaleOf(word, found.map(({ arrays }) => arrays[half]))) };
  showRanges(drawn.scales);
  redraw();
  await Promise.all([drawProbe(), ...[...at("charts").children].map((card) => card.draw())]);
}

let drawn = null;

async function numbersOf({ run, n }) {
  const [arrays, outlines, places] = await Promise.all([
    Promise.all(shownWords().map((word) => run.drawn(n, word))), run.outlines(n), placesOf(run, run.times[n])]);
  return { arrays, outlines, places };
}

/** Where tracers and gauges are at a time, m. */
async function placesOf(run, time) {
  if (!run.stations.length) return [];
  const times = await run.column("time");
  const found = await Promise.all(run.stations.map(async ({ kind, name, r, z }) => ({
    kind, name, r: interpolated(times, await run.column(r), time) / MM,
    z: interpolated(times, await run.column(z), time) / MM })));
  return found.filter(({ r, z }) => Number.isFinite(r) && Number.isFinite(z));
}

/** Draws the sections again, from the numbers that are there. */
function redraw() {
  if (!drawn) return;
  SECTIONS.forEach((section, number) => {
    const { arrays, outlines, places } = drawn.found[number], { run, n } = section;
    section.draw(arrays, drawn.scales, outlines, places);
    const last = n === run.times.length - 1 && TIMES[state.step] > run.times[n] * 1.001 ? ", its last" : "";
    section.placeTip();
    section.when.textContent = `t = ${timeText(run.times[n])}${last}`;
    section.canvas.setAttribute("aria-label", `Section of ${run.label} at ${section.when.textContent}: ${shownWords()
      .map((word) => titleOf(word)).join(" above, ")} below`);
  });
}

function makeSections() {
  const place = at("sections");
  for (const run of RUNS) {
    const name = element("span", { className: "name", textContent: run.label, title: run.title });
    name.classList.toggle("chip", RUNS.length > 1);
    name.style.setProperty("--chip", `var(${CURVES[run.number]})`);
    const canvas = element("canvas", { tabIndex: 0 });
    canvas.setAttribute("role", "img");
    const tip = element("button", { type: "button", className: "tip", hidden: true, title: "All numbers of the cell" });
    tip.addEventListener("click", () => at("probe").scrollIntoView({ behavior: "smooth" }));
    const figure = element("figure", { className: "section" }, element("figcaption", {}, name,
      element("span", { className: "when" })), canvas, tip);
    place.append(figure);
    const section = new Section(run, figure);
    new Gesture(section);
    SECTIONS.push(section);
  }
}

function makeHeading() {
  at("heading").textContent = [...new Set(RUNS.map((run) => run.title || run.label))].join(" | ");
  at("subtitle").textContent = RUNS.map((run) => {
    const end = run.ended === null ? "not ended when this page was made" : `ended: ${run.ended || "no reason is given"}`;
    return `${run.label}: ${run.nz} × ${run.nr} cells, ${run.times.length} dumps; ${end}`;
  }).join(" | ");
  const share = plainNumber(50 / RUNS[0].last, 2), thinned = RUNS.filter((run) => run.history && run.history.step > 1);
  at("precision").textContent = `Fields are stored with ${RUNS[0].bits} bits for each value: a number differs from that of ` +
    `the run by at most ${share} % of the range of its field at that time, which stands beside it under ±. ` +
    "Histories have seven digits. " +
    thinned.map((run) => `Of the history of ${run.label}, every ${run.history.step}th row is here. `).join("") +
    "Cells that bodies fill less than half are drawn as void.";
  at("made").textContent = `Made by ${PAGE.made}.`;
}

/** Makes the pictures as high as what they show at first is, within the bounds of the style. */
function setHeight() {
  const canvas = SECTIONS[0].canvas, width = canvas.clientWidth - MARGINS.across;
  const shapes = SECTIONS.map((section) => section.window("projectile")).map(([x0, x1, y0, y1]) => (y1 - y0) / (x1 - x0));
  at("sections").style.setProperty("--height", `${Math.round(width * Math.max(...shapes)) + MARGINS.along}px`);
}

/** Fits the pictures to the page, when it is opened and when its size changes. */
function resize() {
  setHeight();
  const before = SECTIONS[0].box.width;
  SECTIONS.forEach((section) => section.measure());
  if (before <= 1) fit("projectile");
  else state.view.scale *= SECTIONS[0].box.width / before;
}

/** Prepares all parts of the page, which is seen from then on. */
function begin() {
  if (typeof DecompressionStream === "undefined") {
    document.querySelector("header").style.visibility = "visible";
    at("heading").textContent = "This browser is too old for this page: Chrome 80, Firefox 113 or Safari 16.4 can show it.";
    return;
  }
  const words = FIRST_WORDS.filter(fieldOf);
  state.words = [words[0] || RUNS[0].fields[0].word, words[1] || words[0] || RUNS[0].fields[0].word];
  makeSections();
  makeHeading();
  prepareHalves();
  prepareColours();
  prepareView();
  preparePlayer();
  prepareKeys();
  at("charts").append(lineCard(), ...firstColumns().map(historyCard));
  offer(at("probe"), () => "cell", probeTable);
  document.body.classList.remove("unready");
  resize();
  new ResizeObserver(() => { resize(); update(); }).observe(at("sections"));
  update();
}

begin();
