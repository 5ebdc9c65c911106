"use strict";
// Ticks, numbers, and charts of curves on a canvas.

const FONT = "12px system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif";
const CURVES = ["--one", "--other"];

/** Round numbers between two others, about so many. */
function niceTicks(low, high, about) {
  if (!(high > low)) return [low];
  const raw = (high - low) / Math.max(about, 1), power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= raw * 0.999999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step || 0);
  return found;
}

/** Powers of ten between two numbers, with twice and five times them where there are few. */
function logTicks(low, high) {
  const found = [], factors = high / low > 300 ? [1] : [1, 2, 5];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power++)
    for (const factor of factors) found.push(factor * 10 ** power);
  return found.filter((tick) => tick >= low * 0.999 && tick <= high * 1.001);
}

/** Writes the ticks of an axis with the same number of decimals. */
function tickWriter(ticks) {
  const most = Math.max(...ticks.map(Math.abs)), step = ticks.length > 1 ? ticks[1] - ticks[0] : most;
  if (most >= 1e6 || (most > 0 && most < 1e-3)) return (tick) => plainNumber(tick, 2);
  const decimals = Math.max(0, -Math.floor(Math.log10(step || 1) + 1e-9));
  return (tick) => minus(tick.toFixed(Math.min(decimals, 8)));
}

function minus(text) {
  return text.replace(/^-/, "−");
}

/** A number for a reader, with so many digits. */
function plainNumber(value, digits = 5) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  const rounded = Number(value.toPrecision(digits));
  return minus(size !== 0 && (size >= 1e6 || size < 1e-3) ? rounded.toExponential().replace("e+", "e") : String(rounded));
}

/** A text that fits into a width. */
function shortened(context, text, width) {
  if (context.measureText(text).width <= width) return text;
  let end = text.length;
  while (end > 1 && context.measureText(`${text.slice(0, end)}…`).width > width) end--;
  return `${text.slice(0, end)}…`;
}

/** Colours of the page for what is drawn on a canvas. */
function inkOfPage() {
  const style = getComputedStyle(document.documentElement), read = (name) => style.getPropertyValue(name).trim();
  return { text: read("--ink"), soft: read("--soft"), line: read("--line"), paper: read("--card"), empty: read("--void"),
           mark: read("--mark"), curves: CURVES.map(read) };
}

/** A context of a canvas whose unit is a pixel of the page, cleared; and its size. */
function prepared(canvas) {
  const density = Math.min(window.devicePixelRatio || 1, 3), width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * density) || canvas.height !== Math.round(height * density)) {
    canvas.width = Math.round(width * density);
    canvas.height = Math.round(height * density);
  }
  const context = canvas.getContext("2d");
  context.setTransform(density, 0, 0, density, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = FONT;
  return { context, width, height, density };
}

/** The least and the greatest finite number of arrays, with a little room; none if there is no number. */
function extent(arrays, room = 0.04) {
  let low = Infinity, high = -Infinity;
  for (const values of arrays)
    for (const value of values) if (Number.isFinite(value)) { if (value < low) low = value; if (value > high) high = value; }
  if (low > high) return null;
  const margin = high > low ? room * (high - low) : Math.abs(high) * 0.1 || 1;
  return [low - margin, high + margin];
}

/** Draws curves {x, y, colour} with axes. Returns how x is placed, for a cursor and for clicks. */
function drawChart(canvas, { curves, xTitle, xRange, yRange, cursor, level }) {
  const { context, width, height } = prepared(canvas), ink = inkOfPage();
  const ys = yRange || extent([...curves.map((curve) => curve.y), level === undefined ? [] : [level]]) || [0, 1];
  const xs = xRange || extent(curves.map((curve) => curve.x), 0) || [0, 1];
  const ticks = niceTicks(ys[0], ys[1], (height - 40) / 34), write = tickWriter(ticks);
  const left = 12 + Math.max(...ticks.map((tick) => context.measureText(write(tick)).width), 18), bottom = height - 34;
  const box = { left, right: width - 10, top: 8, bottom };
  const px = (x) => box.left + ((x - xs[0]) / (xs[1] - xs[0] || 1)) * (box.right - box.left);
  const py = (y) => box.bottom - ((y - ys[0]) / (ys[1] - ys[0] || 1)) * (box.bottom - box.top);
  drawGrid(context, box, { ticks, write, py }, niceTicks(xs[0], xs[1], (box.right - box.left) / 70), px, xTitle, ink);
  if (level !== undefined) drawLevel(context, box, py(level), ink);
  context.save();
  context.beginPath();
  context.rect(box.left, box.top - 2, box.right - box.left, box.bottom - box.top + 4);
  context.clip();
  for (const curve of curves) drawCurve(context, curve, px, py);
  context.restore();
  if (cursor !== undefined && cursor >= xs[0] && cursor <= xs[1]) drawCursor(context, box, px(cursor), ink);
  return { at: (x) => xs[0] + ((x - box.left) / (box.right - box.left)) * (xs[1] - xs[0]), px, box, ys };
}

function drawGrid(context, box, y, xTicks, px, xTitle, ink) {
  const writeX = tickWriter(xTicks);
  context.fillStyle = ink.soft;
  context.strokeStyle = ink.line;
  context.lineWidth = 1;
  context.textBaseline = "middle";
  context.textAlign = "right";
  for (const tick of y.ticks) {
    const at = Math.round(y.py(tick)) + 0.5;
    strokeLine(context, box.left, at, box.right, at);
    context.fillText(y.write(tick), box.left - 6, at);
  }
  context.textAlign = "center";
  context.textBaseline = "top";
  for (const tick of xTicks) {
    strokeLine(context, px(tick), box.bottom, px(tick), box.bottom + 4);
    context.fillText(writeX(tick), px(tick), box.bottom + 6);
  }
  context.textAlign = "right";
  context.fillText(xTitle, box.right, box.bottom + 20);
}

function strokeLine(context, x0, y0, x1, y1) {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}

function drawLevel(context, box, y, ink) {
  context.save();
  context.strokeStyle = ink.mark;
  context.setLineDash([5, 4]);
  strokeLine(context, box.left, y, box.right, y);
  context.restore();
}

/** A curve, with gaps where a value is no number. */
function drawCurve(context, { x, y, colour }, px, py) {
  context.strokeStyle = colour;
  context.lineWidth = 1.6;
  context.lineJoin = "round";
  context.beginPath();
  let open = false;
  for (let k = 0; k < x.length; k++) {
    if (!Number.isFinite(y[k])) { open = false; continue; }
    if (open) context.lineTo(px(x[k]), py(y[k])); else context.moveTo(px(x[k]), py(y[k]));
    open = true;
  }
  context.stroke();
}

function drawCursor(context, box, x, ink) {
  context.save();
  context.strokeStyle = ink.text;
  context.globalAlpha = 0.6;
  strokeLine(context, Math.round(x) + 0.5, box.top, Math.round(x) + 0.5, box.bottom);
  context.restore();
}
