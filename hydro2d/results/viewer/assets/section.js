"use strict";
// A section of a run on a canvas: colours of the cells, outlines, stations, axes, and what the user has marked.
// Places on the page are in mm: x is z, measured from the mesh where the view moves with it, and y is r, negative below.

const MM = 1e3, BAR = 84, LEFT = 44, TOP = 10;
/** How far from the marked place its numbers are, pixels: as wide as a finger covers. */
const FINGER = 16;
/** What a canvas is wider and higher than its picture, pixels. */
const MARGINS = { across: LEFT + BAR + 12, along: TOP + 40 };

class Section {
  constructor(run, figure) {
    this.run = run;
    this.canvas = figure.querySelector("canvas");
    this.when = figure.querySelector(".when");
    this.tip = figure.querySelector(".tip");
    this.n = 0;
    this.box = { left: 0, top: 0, width: 1, height: 1 };
  }

  /** How far the origin of x lies from that of z at the present dump, mm. A mesh that stands is seen from one that travels. */
  get offset() {
    const leader = this.run.travels ? this : SECTIONS.find((section) => section.run.travels);
    return state.travel && leader ? leader.run.shifts[leader.n] * MM : 0;
  }

  /** Lowest and highest x and y, mm, of the places of the projectile at all times, of the fine part of the mesh where there
      is none, or if `part` says so of the "fine" part or of the "whole" mesh. */
  window(part) {
    const path = part === "projectile" && this.path();
    if (path) return path;
    const { run } = this, fine = part !== "whole", [z0, z1] = fine ? finePart(run.z_edges) : ends(run.z_edges);
    const [r0, r1] = fine ? finePart(run.r_edges) : ends(run.r_edges);
    const moved = state.travel && run.travels ? [0, 0] : [Math.min(...run.shifts), Math.max(...run.shifts)];
    return [(z0 + moved[0]) * MM, (z1 + moved[1]) * MM, (run.mirrored ? -r1 : r0) * MM, r1 * MM];
  }

  /** The window around the projectile, as wide about it as it is thick; none if there is no projectile. */
  path() {
    const { run } = this, found = run.boxes.map((box, n) => box && [...box.slice(0, 2).map((z) => (z + this.shiftOf(n)) * MM),
      ...box.slice(2).map((r) => r * MM)]).filter(Boolean);
    if (!found.length) return null;
    const least = (k) => Math.min(...found.map((box) => box[k])), most = (k) => Math.max(...found.map((box) => box[k]));
    const [z0, z1, r0, r1] = [least(0), most(1), least(2), most(3)], width = run.mirrored ? 2 * r1 : r1 - r0;
    const margin = Math.max(width, 0.1 * (z1 - z0)), whole = this.window("whole");
    return [Math.max(z0 - margin, whole[0]), Math.min(z1 + margin, whole[1]),
            Math.max((run.mirrored ? -r1 : r0) - width, whole[2]), Math.min(r1 + width, whole[3])];
  }

  /** How far x of the mesh of dump n lies from where it is at the first dump, m. */
  shiftOf(n) {
    return state.travel && this.run.travels ? 0 : this.run.shifts[n];
  }

  /** Sizes the picture on its canvas. */
  measure() {
    this.box = { left: LEFT, top: TOP, width: Math.max(this.canvas.clientWidth - MARGINS.across, 40),
                 height: Math.max(this.canvas.clientHeight - MARGINS.along, 40) };
  }

  px(x) { return this.box.left + this.box.width / 2 + (x - state.view.x) * state.view.scale; }
  py(y) { return this.box.top + this.box.height / 2 - (y - state.view.y) * state.view.scale; }
  x(px) { return state.view.x + (px - this.box.left - this.box.width / 2) / state.view.scale; }
  y(py) { return state.view.y - (py - this.box.top - this.box.height / 2) / state.view.scale; }

  contains(px, py) {
    const { left, top, width, height } = this.box;
    return px >= left && px <= left + width && py >= top && py <= top + height;
  }

  /** The cell at a place, as Run.cell. */
  cellAt({ x, y }) {
    const { run } = this, z = (x + this.offset) / MM - run.shifts[this.n];
    return run.cell(run.mirrored ? Math.abs(y) / MM : y / MM, z);
  }

  /** Which of the two fields is drawn at y. */
  half(y) {
    return this.run.mirrored && y < 0 ? 1 : 0;
  }

  draw(arrays, scales, outlines, places) {
    const { context, density } = prepared(this.canvas), ink = inkOfPage();
    this.drawCells(context, density, arrays, scales, ink);
    context.save();
    context.beginPath();
    context.rect(this.box.left, this.box.top, this.box.width, this.box.height);
    context.clip();
    if (state.cells) this.drawMesh(context);
    if (this.run.mirrored) this.drawAxis(context, ink);
    if (state.outlines) outlines.forEach((segments) => this.drawOutline(context, segments));
    this.drawMeasured(context, ink);
    if (state.stations) this.drawStations(context, places, ink);
    this.drawMarks(context, ink);
    context.restore();
    this.drawAxes(context, ink);
    this.drawBars(context, scales, ink);
  }

  /** Colours every pixel of the picture as the cell that holds its centre. */
  drawCells(context, density, arrays, scales, ink) {
    const { run, box } = this, width = Math.round(box.width * density), height = Math.round(box.height * density);
    const image = new ImageData(width, height), pixels = new Uint32Array(image.data.buffer);
    const colours = arrays.map((values, half) => cellColours(values, scales[half], pixel(hexColours(ink.empty.slice(1))[0])));
    const columns = Int32Array.from({ length: width }, (_, k) => {
      const x = this.x(box.left + (k + 0.5) / density);
      return below(run.z_edges, (x + this.offset) / MM - run.shifts[this.n]);
    });
    for (let line = 0; line < height; line++) {
      const y = this.y(box.top + (line + 0.5) / density), i = below(run.r_edges, (run.mirrored ? Math.abs(y) : y) / MM);
      if (i < 0) continue;
      const row = colours[this.half(y)], start = line * width;
      for (let k = 0; k < width; k++) if (columns[k] >= 0) pixels[start + k] = row[columns[k] * run.nr + i];
    }
    context.putImageData(image, Math.round(box.left * density), Math.round(box.top * density));
  }

  /** The place on the canvas of r, z in m in the coordinates of the laboratory; sign: -1 for the mirror image. */
  place(r, z, sign = 1) {
    return [this.px(z * MM - this.offset), this.py(sign * r * MM)];
  }

  get signs() {
    return this.run.mirrored ? [1, -1] : [1];
  }

  drawOutline(context, segments) {
    context.lineCap = "round";
    context.beginPath();
    const shift = this.run.shifts[this.n];
    for (const sign of this.signs)
      for (let k = 0; k < segments.length; k += 4) {
        context.moveTo(...this.place(segments[k], segments[k + 1] + shift, sign));
        context.lineTo(...this.place(segments[k + 2], segments[k + 3] + shift, sign));
      }
    for (const [colour, width] of [["rgb(255 255 255 / 55%)", 3], ["#000", 1.2]]) {
      context.strokeStyle = colour;
      context.lineWidth = width;
      context.stroke();
    }
  }

  drawMesh(context) {
    const { run, box } = this, shift = run.shifts[this.n];
    context.strokeStyle = "rgb(128 128 128 / 45%)";
    context.lineWidth = 0.5;
    const columns = Array.from(run.z_edges, (z) => this.place(0, z + shift)[0]), [left, right] = ends(columns);
    for (const sign of this.signs) {
      const rows = Array.from(run.r_edges, (r) => this.place(r, 0, sign)[1]), [first, last] = ends(rows);
      for (const x of apart(columns, box.left, box.left + box.width)) strokeLine(context, x, first, x, last);
      for (const y of apart(rows, box.top, box.top + box.height)) strokeLine(context, left, y, right, y);
    }
  }

  drawAxis(context, ink) {
    context.save();
    context.strokeStyle = ink.soft;
    context.setLineDash([10, 3, 2, 3]);
    context.lineWidth = 0.7;
    strokeLine(context, this.box.left, this.py(0), this.box.left + this.box.width, this.py(0));
    context.restore();
  }

  drawMeasured(context, ink) {
    if (this.run.measured.z === null) return;
    const [x] = this.place(0, this.run.measured.z), { top, height } = this.box;
    context.save();
    context.strokeStyle = ink.mark;
    context.setLineDash([6, 4]);
    strokeLine(context, x, top, x, top + height);
    context.restore();
    written(context, "experiment", x - 4, top + 12, ink, "right", ink.mark);
  }

  drawStations(context, places, ink) {
    for (const { name, kind, r, z } of places) {
      const [x, y] = this.place(r, z);
      context.beginPath();
      if (kind === "tracer") context.arc(x, y, 3.5, 0, 2 * Math.PI); else context.rect(x - 3.5, y - 3.5, 7, 7);
      context.fillStyle = ink.paper;
      context.strokeStyle = ink.mark;
      context.lineWidth = 1.8;
      context.fill();
      context.stroke();
      written(context, name, x + 7, y - 8, ink, "left", ink.text);
    }
  }

  /** The line and the cell that the user has marked. */
  drawMarks(context, ink) {
    context.lineWidth = 1.8;
    context.strokeStyle = ink.mark;
    if (state.line) {
      const [a, b] = state.line.map(({ x, y }) => [this.px(x), this.py(y)]);
      strokeLine(context, ...a, ...b);
      for (const [x, y] of [a, b]) { context.beginPath(); context.arc(x, y, 3, 0, 2 * Math.PI); context.stroke(); }
    }
    const cell = state.probe && this.cellAt(state.probe);
    if (!cell) return;
    const { run } = this, sign = state.probe.y < 0 && run.mirrored ? -1 : 1, shift = run.shifts[this.n];
    const [x0, y0] = this.place(run.r_edges[cell[1]], run.z_edges[cell[0]] + shift, sign);
    const [x1, y1] = this.place(run.r_edges[cell[1] + 1], run.z_edges[cell[0] + 1] + shift, sign);
    const least = Math.max(0, 6 - Math.abs(x1 - x0)) / 2;
    context.strokeRect(Math.min(x0, x1) - least, Math.min(y0, y1) - least, Math.abs(x1 - x0) + 2 * least,
                       Math.abs(y1 - y0) + 2 * least);
  }

  /** Puts the numbers of the marked cell beside it, or above or below it where there is no room, so that it stays seen. */
  placeTip() {
    const { tip } = this, shown = Boolean(state.probe && this.cellAt(state.probe) && tip.childElementCount);
    tip.hidden = !shown;
    if (!shown) return;
    const within = (at, size, most) => Math.min(Math.max(at, 2), Math.max(most - size - 2, 2));
    const px = this.px(state.probe.x), py = this.py(state.probe.y), { clientWidth, clientHeight, offsetTop } = this.canvas;
    const { offsetWidth: width, offsetHeight: height } = tip, onLeft = px > clientWidth / 2, above = py > clientHeight / 2;
    const beside = [onLeft ? px - FINGER - width : px + FINGER, py - height / 2];
    const over = [px - width / 2, above ? py - FINGER - height : py + FINGER];
    const fits = Math.max(px, clientWidth - px) >= width + FINGER, [x, y] = fits ? beside : over;
    tip.style.transform = `translate(${Math.round(within(x, width, clientWidth))}px, ${
      Math.round(offsetTop + within(y, height, clientHeight))}px)`;
  }

  drawAxes(context, ink) {
    const { left, top, width, height } = this.box, { run } = this;
    context.strokeStyle = ink.line;
    context.fillStyle = ink.soft;
    context.lineWidth = 1;
    context.strokeRect(left + 0.5, top + 0.5, width, height);
    const zs = niceTicks(this.x(left) + this.offset, this.x(left + width) + this.offset, width / 70), writeZ = tickWriter(zs);
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const z of zs) {
      const x = this.px(z - this.offset);
      strokeLine(context, x, top + height, x, top + height + 4);
      context.fillText(writeZ(z), x, top + height + 7);
    }
    context.fillText("z [mm]", left + width / 2, top + height + 24);
    const rs = niceTicks(this.y(top + height), this.y(top), height / 45), writeR = tickWriter(rs);
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const r of rs) {
      strokeLine(context, left - 4, this.py(r), left, this.py(r));
      context.fillText(writeR(run.mirrored ? Math.abs(r) : r), left - 7, this.py(r));
    }
    context.save();
    context.translate(10, top + height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText("r [mm]", 0, 0);
    context.restore();
  }

  /** One colour bar, or one for each half, beside it and with its name. */
  drawBars(context, scales, ink) {
    const { left, top, width, height } = this.box, x = left + width + 14, words = shownWords();
    const halves = this.run.mirrored && words[0] !== words[1] ? [0, 1] : [0];
    halves.forEach((half) => {
      const part = height / halves.length, head = halves.length > 1 ? HEAD : 0;
      const box = { x, y: top + half * part + head, width: BAR - 4, height: part - head };
      if (head) drawHead(context, box, HALVES[half], ink);
      drawBar(context, box, scales[half], fieldOf(words[half]), this.run, ink);
    });
  }
}

/** A text with a rim of the colour of the page, so that it can be read on every field. */
function written(context, text, x, y, ink, align, colour) {
  context.save();
  context.textAlign = align;
  context.textBaseline = "middle";
  context.lineWidth = 3;
  context.strokeStyle = ink.paper;
  context.fillStyle = colour;
  context.strokeText(text, x, y);
  context.fillText(text, x, y);
  context.restore();
}

/** Those of rising or falling places between two others that are three pixels or more from their neighbour. */
function apart(places, low, high) {
  return places.filter((place, k) => place >= low && place <= high && (!k || Math.abs(place - places[k - 1]) >= 3));
}

function ends(edges) {
  return [edges[0], edges[edges.length - 1]];
}

/** The stretch of a mesh around its smallest cells that are at most twice as large, if the rest is much larger. */
function finePart(edges) {
  const sizes = Array.from(edges).slice(1).map((edge, k) => edge - edges[k]), least = Math.min(...sizes);
  const fine = sizes.map((size, k) => [size, k]).filter(([size]) => size <= 2 * least).map(([, k]) => k);
  const [z0, z1] = [edges[fine[0]], edges[fine[fine.length - 1] + 1]], [start, end] = ends(edges);
  return z1 - z0 < 0.7 * (end - start) ? [z0, z1] : [start, end];
}
