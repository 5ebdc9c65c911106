"use strict";
// Colour maps, colour ranges and colour bars.

const BODY_COLOURS = PAGE.body_colours;
const DIVERGING = "RdBu_r";

/** Colours of a map as [r, g, b], from lowest to highest. */
const MAPS = Object.fromEntries(Object.entries(PAGE.maps).map(([name, text]) => [name, hexColours(text)]));

function hexColours(text) {
  return Array.from({ length: text.length / 6 }, (_, k) => [0, 2, 4].map((at) => parseInt(text.substr(6 * k + at, 2), 16)));
}

/** A colour as a pixel of an image has it. */
function pixel([r, g, b]) {
  return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
}

/** A colour range: symmetric about zero if it has negative values, from zero if it nearly begins there, and not empty. */
function balanced(low, high) {
  if (low >= 0 && low < 0.02 * high) low = 0;
  if (low < 0) { const most = Math.max(-low, high); return [-most, most]; }
  return high > low ? [low, high] : [low, low + 1];
}

/** The colour range of a field over all dumps of all runs, without the outermost cells. */
function rangeOfAll(word) {
  const clip = state.clip;
  const ranges = RUNS.filter((run) => run.byWord.has(word)).map((run) => run.byWord.get(word).ranges[clip]);
  return balanced(Math.min(...ranges.map((range) => range[0])), Math.max(...ranges.map((range) => range[1])));
}

/** The colour range of the values that are drawn now, without the outermost cells. */
function rangeOfNow(arrays) {
  const clip = PAGE.clips[state.clip], found = [];
  for (const values of arrays) for (const value of values) if (Number.isFinite(value)) found.push(value);
  if (!found.length) return [0, 1];
  const sorted = Float32Array.from(found).sort(), last = sorted.length - 1;
  return balanced(sorted[Math.floor(clip * last)], sorted[Math.ceil((1 - clip) * last)]);
}

/** The colour range of a field: the user's, or by the mode that is chosen. */
function rangeOf(word, arrays) {
  if (word === "material") return [0.5, 1];
  return state.limits.get(word) || (state.range === "now" ? rangeOfNow(arrays) : rangeOfAll(word));
}

/** What turns values of a field into colours: range, map, and whether the scale is logarithmic. */
function scaleOf(word, arrays) {
  if (word === "material") return { material: true };
  let [low, high] = rangeOf(word, arrays);
  const log = state.log && low >= 0 && high > 0;
  if (log) low = Math.max(low, high * 1e-4);
  const map = low < 0 && low === -high ? MAPS[DIVERGING] : MAPS[state.map];
  const position = log
    ? (value) => (value > low ? Math.log(value / low) / Math.log(high / low) : 0)
    : (value) => (value - low) / (high - low);
  return { low, high, log, map, position, refused: state.log && !log };
}

/** The colour of each cell as a pixel; that of void where a value is no number. */
function cellColours(values, scale, empty) {
  const colours = new Uint32Array(values.length);
  const table = (scale.material ? BODY_COLOURS : scale.map).map(pixel), last = table.length - 1;
  for (let k = 0; k < values.length; k++) {
    const value = values[k];
    if (Number.isNaN(value)) colours[k] = empty;
    else if (scale.material) colours[k] = table[(Math.round(value) - 1) % table.length];
    else colours[k] = table[Math.min(Math.max(Math.floor(scale.position(value) * (last + 1)), 0), last)];
  }
  return colours;
}

/** What stands above a colour bar where each half of the picture has its own, and its height in pixels. */
const HALVES = ["upper half", "lower half"], HEAD = 16;

function drawHead(context, box, text, ink) {
  context.save();
  context.fillStyle = ink.soft;
  context.textBaseline = "middle";
  context.textAlign = "left";
  context.fillText(text, box.x, box.y - 6);
  context.restore();
}

/** Draws a colour bar, or the colours of the bodies, into a box of the canvas. */
function drawBar(context, box, scale, field, run, ink) {
  context.save();
  context.fillStyle = context.strokeStyle = ink.text;
  context.textBaseline = "middle";
  context.textAlign = "left";
  if (scale.material) drawBodies(context, box, run);
  else drawScale(context, box, scale, field, ink);
  context.restore();
}

function drawBodies(context, box, run) {
  run.bodies.forEach((body, m) => {
    const y = box.y + 12 + 18 * m;
    context.fillText(shortened(context, body, box.width - 16), box.x + 16, y);
    context.save();
    context.fillStyle = `rgb(${BODY_COLOURS[m % BODY_COLOURS.length]})`;
    context.fillRect(box.x, y - 6, 12, 12);
    context.restore();
  });
}

/** About so many ticks for a bar, but three at least. */
function barTicks({ low, high }, about) {
  for (let number = about; number < 10; number += 1) {
    const found = niceTicks(low, high, number);
    if (found.length >= 3) return found;
  }
  return niceTicks(low, high, about);
}

function drawScale(context, box, scale, field, ink) {
  const width = 12, top = box.y + 8, height = box.height - 16, last = scale.map.length - 1;
  for (let k = 0; k < height; k++) {
    context.fillStyle = `rgb(${scale.map[Math.round((1 - k / Math.max(height - 1, 1)) * last)]})`;
    context.fillRect(box.x, top + k, width, 1.5);
  }
  context.strokeStyle = ink.line;
  context.strokeRect(box.x + 0.5, top + 0.5, width - 1, height - 1);
  const ticks = scale.log ? logTicks(scale.low, scale.high) : barTicks(scale, height / 32);
  const write = scale.log ? plainNumber : tickWriter(ticks);
  context.fillStyle = ink.text;
  for (const tick of ticks) {
    const y = top + (1 - scale.position(tick)) * height;
    context.fillRect(box.x + width, Math.round(y), 4, 1);
    context.fillText(write(tick), box.x + width + 7, y);
  }
  context.translate(box.x + box.width - 7, top + height / 2);
  context.rotate(-Math.PI / 2);
  context.textAlign = "center";
  const title = titleOf(field.word), unit = unitOf(field.unit), fits = context.measureText(title).width <= height + 12;
  context.fillText(fits ? title : unit, 0, 0);
}
