"use strict";
// Pointers on a section: click for a cell, drag for a line, drag or two fingers or the wheel to move and to zoom.

const CLICK = 4, FACTOR = 1.25;

/** Zooms by a factor about a place on the canvas of a section. */
function zoomAbout(section, px, py, factor) {
  const x = section.x(px), y = section.y(py), { view } = state;
  view.scale = Math.min(Math.max(view.scale * factor, 0.01), 1e5);
  view.x += x - section.x(px);
  view.y += y - section.y(py);
  redraw();
}

function zoom(factor) {
  const { box } = SECTIONS[0];
  zoomAbout(SECTIONS[0], box.left + box.width / 2, box.top + box.height / 2, factor);
}

/** Moves the view by so many pixels of the page. */
function pan(dx, dy) {
  state.view.x -= dx / state.view.scale;
  state.view.y += dy / state.view.scale;
  redraw();
}

/** Shows a part of all runs at equal scales: the "projectile", the "fine" part of the mesh or the "whole" mesh. */
function fit(part) {
  const windows = SECTIONS.map((section) => section.window(part)), { box } = SECTIONS[0];
  const [x0, , y0] = [0, 1, 2].map((k) => Math.min(...windows.map((window) => window[k])));
  const [, x1, , y1] = [0, 1, 2, 3].map((k) => Math.max(...windows.map((window) => window[k])));
  const scale = Math.min(box.width / (x1 - x0), box.height / (y1 - y0)) * 0.98;
  state.view = { x: (x0 + x1) / 2, y: (y0 + y1) / 2, scale };
}

/** Follows the pointers on the canvas of a section. */
class Gesture {
  constructor(section) {
    this.section = section;
    this.pointers = new Map();
    const { canvas } = section, listen = (name, action) => canvas.addEventListener(name, action);
    listen("pointerdown", (event) => this.press(event));
    listen("pointermove", (event) => this.move(event));
    listen("pointerup", (event) => this.release(event));
    listen("pointercancel", (event) => this.cancel(event));
    listen("contextmenu", (event) => event.preventDefault());
    listen("dblclick", () => { fit("projectile"); redraw(); });
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  at(event) {
    const box = this.section.canvas.getBoundingClientRect();
    return { px: event.clientX - box.left, py: event.clientY - box.top };
  }

  place({ px, py }) {
    return { x: this.section.x(px), y: this.section.y(py) };
  }

  press(event) {
    const at = this.at(event);
    if (!this.section.contains(at.px, at.py)) return;
    this.section.canvas.focus({ preventScroll: true });
    this.section.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, at);
    this.start = at;
    this.moved = this.pointers.size > 1;
    this.pans = event.shiftKey || event.button > 0 || state.drag === "pan" || this.pointers.size > 1;
    if (this.pointers.size === 2 && this.line) { state.line = this.before; this.line = false; }
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const at = this.at(event);
    if (this.pointers.size === 1 && !this.moved && Math.hypot(at.px - this.start.px, at.py - this.start.py) < CLICK) return;
    if (!this.moved) this.before = state.line;
    this.moved = true;
    if (this.pointers.size === 2) this.pinch(event.pointerId, at);
    this.pointers.set(event.pointerId, at);
    if (this.pointers.size !== 1) return;
    if (this.pans) pan(at.px - before.px, at.py - before.py);
    else {
      this.line = true;
      state.line = [this.place(this.start), this.place(at)];
      update();
    }
  }

  pinch(id, at) {
    const [other] = [...this.pointers].filter(([key]) => key !== id).map(([, value]) => value), old = this.pointers.get(id);
    const distance = (one) => Math.hypot(one.px - other.px, one.py - other.py);
    pan((at.px - old.px) / 2, (at.py - old.py) / 2);
    zoomAbout(this.section, (at.px + other.px) / 2, (at.py + other.py) / 2, distance(at) / Math.max(distance(old), 1));
  }

  release(event) {
    if (!this.pointers.delete(event.pointerId)) return;
    if (!this.moved && event.button === 0) {
      state.probe = this.place(this.start);
      update();
    }
    if (!this.pointers.size) this.line = false;
  }

  cancel(event) {
    this.pointers.delete(event.pointerId);
    this.line = false;
  }

  wheel(event) {
    const { px, py } = this.at(event);
    if (!this.section.contains(px, py)) return;
    event.preventDefault();
    zoomAbout(this.section, px, py, Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)));
  }
}
