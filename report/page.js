"use strict";
// A link to a claim opens it.
function openLinked() {
  const linked = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (linked instanceof HTMLDetailsElement) linked.open = true;
}
addEventListener("hashchange", openLinked);
openLinked();

// Sorting and filtering of the table of runs. Without this script the table is whole, in its own order.
const table = document.getElementById("runs-table");
const body = table.tBodies[0];
const rows = [...body.rows];
const said = document.getElementById("runs-said");
const filters = [...document.querySelectorAll("#runs-filters select")];
const words = document.getElementById("runs-words");

function value(row, column) {
  const cell = row.cells[column];
  const given = cell.dataset.value ?? cell.textContent.trim();
  const number = Number(given);
  return given === "" || given === "–" ? null : Number.isNaN(number) ? given : number;
}

function compare(a, b) {
  if (a === null || b === null) return (a === null) - (b === null); // what is unknown comes last
  return typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
}

for (const [column, head] of [...table.tHead.rows[0].cells].entries()) {
  head.querySelector("button").addEventListener("click", () => {
    const down = head.getAttribute("aria-sort") === "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    const sorted = [...rows].sort((a, b) => {
      const [x, y] = [value(a, column), value(b, column)];
      return down && x !== null && y !== null ? compare(y, x) : compare(x, y);
    });
    body.append(...sorted);
  });
}

function filter() {
  const wanted = words.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
  let count = 0;
  for (const row of rows) {
    const text = row.textContent.toLowerCase();
    const shown = filters.every((one) => !one.value || row.dataset[one.name] === one.value)
      && wanted.every((word) => text.includes(word));
    row.hidden = !shown;
    count += shown;
  }
  said.textContent = `${count} of ${rows.length} runs`;
}

for (const one of [...filters, words]) one.addEventListener("input", filter);
document.getElementById("runs-filters").addEventListener("submit", (event) => event.preventDefault());
document.getElementById("runs-filters").hidden = false;
filter();
