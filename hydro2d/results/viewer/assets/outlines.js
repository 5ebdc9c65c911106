"use strict";
// Outlines of bodies: lines along which a body fills half of a cell, as hydro2d/output/outlines.py draws them. Those around
// what is narrower than a cell come with the page.

/** Centres of cells, with the two edges of the mesh before and behind them. */
function nodes(edges) {
  const last = edges.length - 1, found = new Float64Array(last + 2);
  found[0] = edges[0];
  found[last + 1] = edges[last];
  for (let k = 0; k < last; k++) found[k + 1] = 0.5 * (edges[k] + edges[k + 1]);
  return found;
}

/** Segments r, z, r, z, ... of the contour 1/2 of shares (nz, nr) through the centres of cells; values reach to the edges. */
function contour(rEdges, zEdges, shares) {
  const r = nodes(rEdges), z = nodes(zEdges), nr = rEdges.length - 1, nz = zEdges.length - 1, found = [];
  const inner = (k, n) => Math.min(Math.max(k - 1, 0), n - 1);
  for (let j = 0; j <= nz; j++) {
    const low = inner(j, nz) * nr, high = inner(j + 1, nz) * nr;
    for (let i = 0; i <= nr; i++) {
      const left = inner(i, nr), right = inner(i + 1, nr);
      const corners = [shares[low + left], shares[low + right], shares[high + right], shares[high + left]];
      const inside = corners.map((share) => share >= 0.5);
      if (inside[0] === inside[1] && inside[1] === inside[2] && inside[2] === inside[3]) continue;
      addSegments(found, corners, inside, r[i], r[i + 1], z[j], z[j + 1]);
    }
  }
  return Float32Array.from(found);
}

/** Adds the one or two segments of a square whose corners are (r0, z0), (r1, z0), (r1, z1), (r0, z1). */
function addSegments(found, [a, b, c, d], inside, r0, r1, z0, z1) {
  const part = (from, to) => (0.5 - from) / (to - from), ends = [];
  if (inside[0] !== inside[1]) ends.push([r0 + part(a, b) * (r1 - r0), z0]);
  if (inside[1] !== inside[2]) ends.push([r1, z0 + part(b, c) * (z1 - z0)]);
  if (inside[2] !== inside[3]) ends.push([r1 + part(c, d) * (r0 - r1), z1]);
  if (inside[3] !== inside[0]) ends.push([r0, z1 + part(d, a) * (z0 - z1)]);
  if (ends.length === 4 && (a + b + c + d) / 4 >= 0.5 === inside[0]) ends.push(ends.shift()); // which corners are cut off
  for (let k = 0; k < ends.length; k += 2) found.push(...ends[k], ...ends[k + 1]);
}
