"use strict";
// Sorts a table by the column whose heading is pressed; a second press turns it round. Empty cells stay last.
function value(cell) {
  if (cell.dataset.value !== undefined) return Number(cell.dataset.value);
  const text = cell.textContent.trim();
  return text === "–" ? null : text;
}
function compare(a, b) {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return String(a).localeCompare(String(b), "en", { numeric: true });
}
function sort(table, column) {
  const heads = [...table.tHead.rows[0].cells];
  const sign = heads[column].getAttribute("aria-sort") === "ascending" ? -1 : 1;
  heads.forEach((head) => head.removeAttribute("aria-sort"));
  heads[column].setAttribute("aria-sort", sign === 1 ? "ascending" : "descending");
  const rows = [...table.tBodies[0].rows].map((row) => [value(row.cells[column]), row]);
  const full = rows.filter(([key]) => key !== null).sort((a, b) => sign * compare(a[0], b[0]));
  const empty = rows.filter(([key]) => key === null);
  table.tBodies[0].append(...[...full, ...empty].map(([, row]) => row));
}
for (const table of document.querySelectorAll("table.sortable")) {
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    button.addEventListener("click", () => sort(table, column));
    head.append(button);
  });
}
// A picture is in the page once: the link that saves it takes it from there.
for (const link of document.querySelectorAll("figcaption a[download]")) link.href = link.closest("figure").querySelector("img, video").src;
