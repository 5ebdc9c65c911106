"use strict";
// The controls: fields, colours, view, time, keys, help, dark or light.

const at = (id) => document.getElementById(id);

/** Fills a choice of fields, those of the mixture first, then those of each body. */
function fillFields(select) {
  const fields = [...new Map(RUNS.flatMap((run) => run.fields).map((field) => [field.word, field])).values()];
  for (const body of new Set(fields.map((field) => field.body))) {
    const group = element("optgroup", { label: body || "Cell" });
    for (const field of fields.filter((each) => each.body === body))
      group.append(element("option", { value: field.word, textContent: titleOf(field.word, false) }));
    select.append(group);
  }
}

function prepareHalves() {
  [0, 1].forEach((half) => {
    const place = at(`half-${half}`), select = place.querySelector(".field");
    fillFields(select);
    select.value = state.words[half];
    select.addEventListener("change", () => { state.words[half] = select.value; update(); });
    for (const input of place.querySelectorAll("input")) input.addEventListener("change", () => typed(half));
  });
  if (RUNS.some((run) => run.mirrored)) return;
  at("half-1").hidden = true;
  at("half-0").querySelector("legend").textContent = "Field";
}

/** Takes the colour range that is typed for a half, if it is one. */
function typed(half) {
  const [low, high] = ["low", "high"].map((name) => {
    const text = at(`half-${half}`).querySelector(`.${name}`).value.replace("−", "-").replace(",", ".").trim();
    return text === "" ? NaN : Number(text);
  });
  if (Number.isFinite(low) && Number.isFinite(high) && low < high) {
    state.limits.set(state.words[half], [low, high]);
    at("range").value = "own";
  } else say("The lower end of a colour range must be a number below the upper end");
  update();
}

/** Shows the colour ranges in use. */
function showRanges(scales) {
  const notes = [];
  [0, 1].forEach((half) => {
    const place = at(`half-${half}`), scale = scales[half], field = fieldOf(shownWords()[half]);
    for (const name of ["low", "high"]) {
      const input = place.querySelector(`.${name}`);
      input.disabled = Boolean(scale.material);
      if (document.activeElement !== input) input.value = scale.material ? "" : plainNumber(scale[name], 4);
    }
    place.querySelector(".unit").textContent = field ? field.unit : "";
    if (scale.refused) notes.push("no logarithm of negative values");
  });
  at("log").parentElement.title = notes[0] || "Logarithmic scale over at most four decades";
}

function prepareColours() {
  PAGE.clips.forEach((clip, k) => at("clip").append(element("option", {
    value: k, textContent: clip ? `clip ${100 * clip} % of cells` : "clip nothing" })));
  for (const name of Object.keys(PAGE.maps).filter((each) => each !== DIVERGING))
    at("map").append(element("option", { value: name, textContent: name }));
  at("clip").value = state.clip;
  at("range").addEventListener("change", (event) => chooseRange(event.target.value));
  at("clip").addEventListener("change", (event) => { state.clip = Number(event.target.value); chooseRange(state.range); });
  at("map").addEventListener("change", (event) => { state.map = event.target.value; update(); });
  at("log").addEventListener("change", (event) => { state.log = event.target.checked; update(); });
}

/** Colours by the range of all times or of this time; what was typed is forgotten. */
function chooseRange(mode) {
  state.range = mode;
  state.limits.clear();
  at("range").value = mode;
  update();
}

function prepareView() {
  for (const [id, action] of Object.entries({
    "zoom-in": () => zoom(FACTOR), "zoom-out": () => zoom(1 / FACTOR),
    projectile: () => { fit("projectile"); redraw(); }, fit: () => { fit("fine"); redraw(); },
    whole: () => { fit("whole"); redraw(); },
  })) at(id).addEventListener("click", action);
  at("drag").addEventListener("change", (event) => { state.drag = event.target.value; showDrag(); });
  for (const id of ["outlines", "stations", "cells"])
    at(id).addEventListener("change", (event) => { state[id] = event.target.checked; update(); });
  at("travel").addEventListener("change", (event) => travel(event.target.checked));
  at("projectile").hidden = !RUNS.some((run) => run.boxes.some(Boolean));
  at("travel-label").hidden = !RUNS.some((run) => run.travels);
  at("stations-label").hidden = !RUNS.some((run) => run.stations.length);
}

/** Whether the view moves with the mesh; the same place stays in the middle. */
function travel(moves) {
  const before = SECTIONS[0].offset;
  state.travel = moves;
  const change = before - SECTIONS[0].offset;
  state.view.x += change;
  for (const place of [...(state.line || []), ...(state.probe ? [state.probe] : [])]) place.x += change;
  update();
}

function showDrag() {
  for (const section of document.querySelectorAll(".section")) section.classList.toggle("moves", state.drag === "pan");
}

// -------------------------------------------------------------------------------------------------------------- time

function preparePlayer() {
  at("time").max = TIMES.length - 1;
  at("time").addEventListener("input", (event) => goTo(Number(event.target.value)));
  at("back").addEventListener("click", () => goTo(state.step - 1));
  at("forth").addEventListener("click", () => goTo(state.step + 1));
  at("play").addEventListener("click", () => play(!state.playing));
}

function nearestStep(time) {
  return TIMES.reduce((best, each, k) => (Math.abs(each - time) < Math.abs(TIMES[best] - time) ? k : best), 0);
}

function goTo(step) {
  state.step = Math.min(Math.max(step, 0), TIMES.length - 1);
  return update();
}

/** Shows one dump after the other, each when the one before is drawn; from the first after the last. */
async function play(on) {
  if (state.playing === on) return;
  state.playing = on;
  at("play").textContent = on ? "❚❚" : "▶";
  at("play").setAttribute("aria-label", on ? "Pause" : "Play");
  if (on && state.step === TIMES.length - 1) state.step = -1;
  while (state.playing) {
    const pause = new Promise((done) => setTimeout(done, 1000 / Number(at("speed").value)));
    await goTo(state.step + 1);
    if (state.step === TIMES.length - 1) play(false); else await pause;
  }
}

function showTime() {
  const time = timeText(TIMES[state.step]);
  at("time").value = state.step;
  at("time").setAttribute("aria-valuetext", time);
  at("clock").textContent = time;
}

// -------------------------------------------------------------------------------------------------- keys, help, dark

function stepField(half, by) {
  const select = at(`half-${half}`).querySelector(".field"), count = select.options.length;
  select.selectedIndex = (select.selectedIndex + by + count) % count;
  state.words[half] = select.value;
  update();
}

function flip(id) {
  at(id).checked = !at(id).checked;
  at(id).dispatchEvent(new Event("change"));
}

function dark() {
  const now = document.documentElement.dataset.theme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  document.documentElement.dataset.theme = now === "dark" ? "light" : "dark";
  showDark();
  update();
}

function showDark() {
  const theme = document.documentElement.dataset.theme, prefers = matchMedia("(prefers-color-scheme: dark)").matches;
  at("dark").setAttribute("aria-pressed", theme ? theme === "dark" : prefers);
}

/** Marks the cell in the middle of the picture. */
function probeMiddle() {
  state.probe = { x: state.view.x, y: state.view.y };
  update();
}

const KEYS = {
  " ": () => play(!state.playing), ArrowLeft: () => goTo(state.step - 1), ArrowRight: () => goTo(state.step + 1),
  Home: () => goTo(0), End: () => goTo(TIMES.length - 1), "+": () => zoom(FACTOR), "=": () => zoom(FACTOR),
  "-": () => zoom(1 / FACTOR), 0: () => { fit("projectile"); redraw(); }, m: () => { fit("fine"); redraw(); }, w: () => { fit("whole"); redraw(); },
  f: () => stepField(0, 1), F: () => stepField(0, -1), g: () => stepField(1, 1), G: () => stepField(1, -1),
  r: () => chooseRange(state.range === "all" ? "now" : "all"), l: () => flip("log"), p: probeMiddle, d: dark,
  "?": () => at("help").showModal(), Escape: () => { state.line = state.probe = null; update(); },
};
const SHIFTED = { ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60] };

/** Whether the element in focus has a use of its own for a key. */
function takes(target, key) {
  if (at("help").open || target.matches("input:not([type=checkbox], [type=range]), select")) return true;
  if (target.matches("[type=range]")) return key.startsWith("Arrow") || key === "Home" || key === "End";
  return (key === " " || key === "Enter") && target.matches("button, [type=checkbox]");
}

function press(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || takes(event.target, event.key)) return;
  const moves = event.shiftKey && SHIFTED[event.key], action = moves ? () => pan(...moves) : KEYS[event.key];
  if (!action) return;
  event.preventDefault();
  action();
}

function prepareKeys() {
  addEventListener("keydown", press);
  at("dark").addEventListener("click", dark);
  at("help-open").addEventListener("click", () => at("help").showModal());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { showDark(); update(); });
  at("controls").addEventListener("submit", (event) => event.preventDefault());
  showDark();
}
