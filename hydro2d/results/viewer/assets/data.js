"use strict";
// The runs in the page, and their numbers: unpacked when they are needed, and kept for a while.

const PAGE = JSON.parse(document.getElementById("contents").textContent);
const TEXTS = [...document.querySelectorAll("script.numbers")].map((element) => element.textContent);
/** Cells of fields that are kept at most, over all arrays of a run. */
const KEPT = 12e6;

/** Bytes of a piece of a text in base64, of which each four letters are three bytes. */
function bytesAt(text, start, length) {
  const letters = text.slice((start / 3) * 4, Math.ceil((start + length) / 3) * 4);
  const found = atob(letters), bytes = new Uint8Array(length);
  for (let k = 0; k < length; k++) bytes[k] = found.charCodeAt(k);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Levels (nz, nr) from the high and low bytes of their differences along r and along z, modulo 2^16. */
function levelsOf(bytes, nz, nr) {
  const cells = nz * nr, levels = new Uint16Array(cells);
  for (let k = 0; k < cells; k++) levels[k] = (bytes[k] << 8) | bytes[cells + k];
  for (let row = 0; row < cells; row += nr) for (let k = row + 1; k < row + nr; k++) levels[k] += levels[k - 1];
  for (let k = nr; k < cells; k++) levels[k] += levels[k - nr];
  return levels;
}

/** Bytes of numbers from their first bytes, their second bytes, and so on. */
function gathered(bytes, width) {
  const count = bytes.length / width, plain = new Uint8Array(bytes.length);
  for (let part = 0; part < width; part++) for (let k = 0; k < count; k++) plain[k * width + part] = bytes[part * count + k];
  return plain.buffer;
}

class Run {
  constructor(table, text, number) {
    Object.assign(this, table);
    this.text = text;
    this.number = number;
    this.nz = this.z_edges.length - 1;
    this.nr = this.r_edges.length - 1;
    this.last = 2 ** this.bits - 2;
    this.byWord = new Map(this.fields.map((field) => [field.word, field]));
    this.cache = new Map();
    this.columns = new Map();
    this.travels = this.shifts.some((shift) => Math.abs(shift) > 1e-9);
  }

  /** What `compute` gives, kept under a key; the oldest entries make room. */
  remember(key, compute) {
    if (!this.cache.has(key)) {
      while (this.cache.size * this.nz * this.nr > KEPT) this.cache.delete(this.cache.keys().next().value);
      this.cache.set(key, compute());
    }
    return this.cache.get(key);
  }

  /** Number of the dump nearest to a time in s. */
  nearest(time) {
    let best = 0;
    this.times.forEach((each, n) => { if (Math.abs(each - time) < Math.abs(this.times[best] - time)) best = n; });
    return best;
  }

  /** Where the numbers of a stored field are at dump n: [low, high, first byte, length]; none if the dump has not got it. */
  piece(n, word) {
    return this.pieces[n][this.stored.indexOf(word)] || null;
  }

  /** How far a value of a field at dump n may be from that of the run, in the reader's unit. */
  error(n, word) {
    const parts = this.byWord.get(word).parts;
    if (parts.length) return Math.hypot(...parts.map((part) => this.error(n, part)));
    const piece = this.piece(n, word);
    return piece && word !== "material" && piece.length > 2 ? (0.5 * (piece[1] - piece[0])) / this.last : 0;
  }

  /** Values (nz, nr) of a field at dump n in the reader's unit, NaN where there is none. */
  values(n, word) {
    return this.remember(`${n} ${word}`, async () => {
      const parts = this.byWord.get(word).parts;
      if (!parts.length) return this.unpacked(this.piece(n, word));
      const [one, other] = await Promise.all(parts.map((part) => this.values(n, part)));
      return one.map((value, k) => Math.hypot(value, other[k]));
    });
  }

  async unpacked(piece) {
    const values = new Float32Array(this.nz * this.nr);
    if (!piece) return values.fill(NaN);
    const [low, high, start, length] = piece;
    if (start === undefined) return values.fill(low);
    const levels = levelsOf(await inflated(bytesAt(this.text, start, length)), this.nz, this.nr);
    const step = (high - low) / this.last;
    for (let k = 0; k < levels.length; k++) values[k] = levels[k] > this.last ? NaN : low + step * levels[k];
    return values;
  }

  /** Volume fraction of all bodies together, or of one. */
  share(n, body) {
    if (body) return this.values(n, `volume_fraction:${body}`);
    return this.remember(`${n} filled`, async () => {
      const shares = await Promise.all(this.bodies.map((each) => this.share(n, each)));
      const sum = new Float32Array(this.nz * this.nr);
      for (const share of shares) for (let k = 0; k < sum.length; k++) sum[k] += share[k];
      return sum;
    });
  }

  /** Cells at dump n in which a body, or any of them, is narrower than a cell. */
  thinCells(n, body) {
    return this.thin[n].flatMap(([cells], m) => (!body || this.bodies[m] === body ? cells : []));
  }

  /** The values that are drawn: NaN in cells of which the body, or all bodies together, fill less than half, but for what is
      narrower than a cell. */
  drawn(n, word) {
    const field = this.byWord.get(word);
    if (!field) return Promise.resolve(new Float32Array(this.nz * this.nr).fill(NaN));
    return this.remember(`${n} ${word} drawn`, async () => {
      const values = await this.values(n, word);
      if (word.startsWith("volume_fraction:")) return values;
      if (word === "material") return values.map((value) => (value > 0 ? value : NaN));
      const share = await this.share(n, field.body);
      const drawn = values.map((value, k) => (share[k] >= 0.5 ? value : NaN));
      for (const k of this.thinCells(n, field.body)) drawn[k] = values[k];
      return drawn;
    });
  }

  /** Outlines of all bodies at dump n: one array of segments r, z, r, z in m for each. */
  outlines(n) {
    return this.remember(`${n} outlines`, () => Promise.all(this.bodies.map(async (body, m) => {
      const share = Float32Array.from(await this.share(n, body)), [cells, around] = this.thin[n][m];
      for (const k of cells) share[k] = 0;
      return Float32Array.from([...contour(this.r_edges, this.z_edges, share), ...around]);
    })));
  }

  /** Times of the history in s, or a column of it in the reader's unit. */
  column(name) {
    if (!this.columns.has(name)) {
      const entry = name === "time" ? { piece: this.history.time } : this.history.columns.find((each) => each.name === name);
      this.columns.set(name, entry ? this.columnAt(entry.piece, name === "time" ? 8 : 4) : Promise.resolve(null));
    }
    return this.columns.get(name);
  }

  async columnAt([start, length], width) {
    const plain = gathered(await inflated(bytesAt(this.text, start, length)), width);
    return width === 8 ? new Float64Array(plain) : new Float32Array(plain);
  }

  /** Index of the cell at r, z of the mesh as it stood at the first dump: [j, i], or none outside of the mesh. */
  cell(r, z) {
    const j = below(this.z_edges, z), i = below(this.r_edges, r);
    return j < 0 || i < 0 ? null : [j, i];
  }
}

/** Index of the interval of rising edges that holds a value; -1 outside. */
function below(edges, value) {
  if (!(value >= edges[0] && value <= edges[edges.length - 1])) return -1;
  let low = 0, high = edges.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (edges[middle] <= value) low = middle; else high = middle;
  }
  return low;
}

/** The value of a column at a time, linear between rows; that of the nearest row where its neighbour has none. */
function interpolated(times, column, time) {
  const k = below(times, Math.min(Math.max(time, times[0]), times[times.length - 1]));
  if (k < 0 || times.length < 2) return column[0];
  const part = Math.min(Math.max((time - times[k]) / (times[k + 1] - times[k] || 1), 0), 1);
  const value = column[k] + part * (column[k + 1] - column[k]);
  return Number.isFinite(value) ? value : column[part < 0.5 ? k : k + 1];
}

/** The unit of times for a reader: [name, how many of them make a second]. */
function unitOfTimes(runs) {
  const last = Math.max(...runs.map((run) => run.times[run.times.length - 1]));
  return last < 0.02 ? ["µs", 1e6] : last < 20 ? ["ms", 1e3] : ["s", 1];
}

/** The times of the slider: those of all dumps, without such as are nearly the same in two runs. */
function sliderTimes(runs) {
  const steps = runs.map((run) => (run.times[run.times.length - 1] - run.times[0]) / Math.max(run.times.length - 1, 1));
  const near = runs.length > 1 ? 0.25 * Math.min(...steps) : 0, kept = [];
  for (const time of runs.flatMap((run) => run.times).sort((a, b) => a - b))
    if (!kept.length || time > kept[kept.length - 1] + near) kept.push(time);
  return kept;
}
