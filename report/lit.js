// One run is lit at a time: in every panel of the figures that shows it, in the table, and in a card with its
// numbers. Without this script the figures are whole; with it, one can ask which run a line is.
const given = JSON.parse(document.getElementById("interactive").textContent);

function made(parent, name, attributes = {}, text = "") {
  const inSvg = parent instanceof SVGElement;
  const element = inSvg ? document.createElementNS(parent.namespaceURI, name) : document.createElement(name);
  for (const [key, one] of Object.entries(attributes)) element.setAttribute(key, one);
  element.textContent = text;
  parent.append(element);
  return element;
}

function unpacked(text, Numbers) {
  return new Numbers(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
}

// Some runs of a cell in a panel. Places come as parts of the panel from its lower left, whole numbers of 65,535
// or of 254 (255: the run has ended); here they go out in the units of the SVG.
class Runs {
  constructor(panel, { kind, cell, seeds, x, y, drawn }) {
    Object.assign(this, { panel, kind, cell, seeds, drawn, packed: [x, y] });
    this.size = seeds.reduce((sum, [first, last]) => sum + last - first + 1, 0);
  }

  unpack() {
    if (!this.packed) return;
    const [x, y] = this.packed;
    const { left, top, width, height } = this.panel;
    this.x = [...unpacked(x, Uint16Array)].map((part) => left + (width * part) / 65535);
    const [Numbers, most] = this.kind === "dots" ? [Uint16Array, 65535] : [Uint8Array, 254];
    this.y = [...unpacked(y, Numbers)].map((part) => part > most ? NaN : top + height * (1 - part / most));
    this.packed = null;
  }

  seed(number) {
    for (const [first, last] of this.seeds) {
      if (number <= last - first) return first + number;
      number -= last - first + 1;
    }
  }

  index(seed) {
    let before = 0;
    for (const [first, last] of this.seeds) {
      if (first <= seed && seed <= last) return before + seed - first;
      before += last - first + 1;
    }
    return -1;
  }

  id(number) { return `${this.cell}/seed-${this.seed(number)}`; }

  line(number) {
    this.unpack();
    const points = this.x.length;
    return this.x.map((x, at) => [x, this.y[number * points + at]]).filter(([, y]) => !Number.isNaN(y));
  }

  // Where a run is highest on the screen at its end: by this the arrow keys go from run to run.
  end(number) {
    this.unpack();
    if (this.kind === "alone") return this.panel.top;
    return this.kind === "dots" ? this.y[number] : this.line(number).at(-1)?.[1] ?? this.panel.top + this.panel.height;
  }

  // The run that is nearest to a point, and how far it is.
  nearest({ x, y }, reach) {
    if (this.kind === "alone") return { number: 0, far: reach };
    this.unpack();
    const points = this.x.length;
    const after = this.kind === "curves" ? Math.max(1, this.x.findIndex((one) => one >= x)) : 0;
    const part = this.kind === "curves" ? (x - this.x[after - 1]) / (this.x[after] - this.x[after - 1] || 1) : 0;
    let found = { number: -1, far: Infinity };
    for (let number = 0; number < this.size; number += 1) {
      const from = this.y[number * points + after - 1];
      const far = this.kind === "dots"
        ? Math.hypot(this.x[number] - x, this.y[number] - y)
        : Math.abs(from + part * (this.y[number * points + after] - from) - y);
      if (far < found.far) found = { number, far };
    }
    return found;
  }

  light(number, layer) {
    const { left, top, width, height } = this.panel;
    this.unpack();
    for (const style of ["halo", "ink"]) {
      if (this.kind === "alone") this.panel.shape = made(layer, "rect", { class: style, x: left, y: top, width, height });
      else if (this.kind === "dots") this.panel.shape = made(layer, "circle", { class: style, cx: this.x[number], cy: this.y[number], r: 2.4 });
      else {
        const line = this.line(number);
        this.panel.shape = made(layer, "polyline", { class: style, points: line.map((one) => one.map((part) => part.toFixed(2))).join(" ") });
        if (line.length) made(layer, "circle", { class: `${style} dot`, cx: line.at(-1)[0], cy: line.at(-1)[1], r: 2 });
      }
    }
  }
}

const figures = [];
for (const [name, panels] of Object.entries(given.figures)) {
  const element = document.getElementById(name);
  const svg = element?.querySelector(".picture svg");
  if (!svg) continue;
  const figure = { name, element, svg, region: svg.closest(".picture"), heading: element.querySelector("figcaption strong").textContent.replace(/\.$/, "") };
  figure.panels = panels.map(({ box: [left, top, width, height], runs }) => {
    const panel = { left, top, width, height };
    panel.runs = runs.map((one) => new Runs(panel, one));
    return panel;
  });
  figures.push(figure);
}

function placesOf(run) {
  const [, cell, seed] = run.match(/^(.*)\/seed-(\d+)$/) ?? [];
  return figures.flatMap((figure) => figure.panels.flatMap((panel) => panel.runs
    .filter((runs) => runs.cell === cell)
    .map((runs) => ({ figure, runs, number: runs.index(Number(seed)) }))
    .filter(({ number }) => number >= 0)));
}

// The card.
const card = made(document.body, "aside", { id: "run-card", "aria-label": "The run that is lit", tabindex: "-1" });
card.hidden = true;
const saidOfRun = made(card, "div", { "aria-live": "polite" });
const linksOfRun = made(card, "p", { class: "links" });
made(card, "p", { class: "hint" }, "Click to keep it.");
const closing = made(card, "button", { type: "button", "aria-label": "Close" }, "×");
const runOf = new Map(rows.map((row) => [row, row.cells[0].textContent.trim()]));
const rowOf = new Map([...runOf].map(([row, run]) => [run, row]));
const heads = [...table.tHead.rows[0].cells].map((head) => head.textContent.trim());
const SHOWN = {
  falls: ["in the end", "falls", "falls in the last fifth", "mean reward in the last fifth [rad²]"],
  upright: ["in the end", "upright at the end [%]", "upright in the last fifth [%]", "mean reward in the last fifth [rad²]"],
};

let lit = { run: null, kept: false, from: null };

function told(run, places) {
  saidOfRun.replaceChildren();
  linksOfRun.replaceChildren();
  made(saidOfRun, "strong", {}, run);
  const row = rowOf.get(run);
  if (row) {
    const list = made(saidOfRun, "dl");
    for (const head of SHOWN[given.judged[row.dataset.task]] ?? SHOWN.falls) {
      made(list, "dt", {}, head);
      made(list, "dd", {}, row.cells[heads.indexOf(head)].textContent);
    }
    const recording = row.cells[0].querySelector("a");
    if (recording) linksOfRun.append(Object.assign(recording.cloneNode(), { textContent: "its recording" }), " · ");
    const shown = made(linksOfRun, "a", { href: "#runs" }, "in the table");
    shown.addEventListener("click", (event) => { event.preventDefault(); inTheTable(row); });
    linksOfRun.append(document.createElement("br"));
  }
  const names = new Map(places.map(({ figure }) => [figure.name, figure.heading]));
  linksOfRun.append(names.size ? "shown in " : "shown in no figure");
  for (const [name, heading] of names) {
    if (name !== names.keys().next().value) linksOfRun.append(", ");
    made(linksOfRun, "a", { href: `#${name}` }, heading);
  }
}

function inTheTable(row) {
  if (row.hidden) {
    for (const one of [...filters, words]) one.value = "";
    filter();
  }
  for (let around = row.closest("details"); around; around = around.parentElement.closest("details")) around.open = true;
  row.scrollIntoView({ block: "center" });
  (row.querySelector("a") ?? row.cells[0]).focus({ preventScroll: true });
}

function dim() {
  for (const { svg } of figures) svg.querySelector(".lit")?.remove();
  rowOf.get(lit.run)?.removeAttribute("aria-current");
  card.hidden = true;
  lit = { run: null, kept: false, from: null };
}

// Light a run. `kept`: until another is chosen, rather than while it is pointed at. `at`: where the pointer is.
function light(run, { kept = false, at = null } = {}) {
  const places = placesOf(run);
  if (run !== lit.run) {
    dim();
    for (const { figure, runs, number } of places) {
      runs.light(number, figure.svg.querySelector(".lit") ?? made(figure.svg, "g", { class: "lit" }));
    }
    rowOf.get(run)?.setAttribute("aria-current", "true");
    told(run, places);
  }
  lit = { run, kept, from: kept ? document.activeElement : null };
  card.hidden = false;
  const beside = !kept && at;
  card.className = kept ? "kept" : beside ? "beside" : "docked";
  card.style.left = beside ? `${Math.min(at.x + 14, innerWidth - card.offsetWidth - 8)}px` : "";
  card.style.top = beside ? `${at.y + 14 + card.offsetHeight > innerHeight ? at.y - card.offsetHeight - 14 : at.y + 14}px` : "";
}

// Back to where one was, before the card.
function close() {
  const back = lit.from;
  const inside = card.contains(document.activeElement);
  dim();
  if (inside) back?.focus();
}
closing.addEventListener("click", close);
document.addEventListener("keydown", (event) => { if (event.key === "Escape" && lit.run) close(); });
