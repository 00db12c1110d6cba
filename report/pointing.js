// Pointing at a run: in a figure with a pointer or the arrow keys, in the table with its rows.
const NEAR = { mouse: 10, pen: 14, touch: 24 }; // [px]

function pointedAt({ panels, svg }, event) {
  const matrix = svg.getScreenCTM();
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
  const reach = (NEAR[event.pointerType] ?? NEAR.mouse) / matrix.a;
  let found = { far: reach, run: null };
  for (const { left, top, width, height, runs } of panels) {
    const { x, y } = point;
    if (x < left - reach || y < top - reach || x > left + width + reach || y > top + height + reach) continue;
    for (const one of runs) {
      if (one.drawn === false) continue;
      const { number, far } = one.nearest(point, reach);
      if (far < found.far || (far === found.far && !found.run)) found = { far, run: one.id(number) };
    }
  }
  return found.run;
}

// The runs of a panel in the order in which they end, from the lowest on the screen to the highest.
function inOrder(panel) {
  panel.order ??= panel.runs.filter((one) => one.drawn !== false)
    .flatMap((one) => Array.from({ length: one.size }, (_, number) => ({ id: one.id(number), end: one.end(number) })))
    .sort((a, b) => b.end - a.end)
    .map(({ id }) => id);
  return panel.order;
}

const STEPS = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 };

function byKey(figure, event) {
  if (event.target !== figure.region || event.ctrlKey || event.altKey || event.metaKey) return;
  const panels = figure.panels.filter((panel) => inOrder(panel).length);
  const aside = { ArrowLeft: -1, ArrowRight: 1 }[event.key] ?? 0;
  if (event.key === "Enter" && lit.run) {
    card.focus();
  } else if (event.key in STEPS || aside || event.key === "Home" || event.key === "End") {
    const now = panels.indexOf(figure.panel);
    // First one with several runs, for with one there is nothing to choose.
    const several = panels.find((panel) => inOrder(panel).length > 1) ?? panels[0];
    figure.panel = now < 0 ? several : panels[(now + aside + panels.length) % panels.length];
    const order = inOrder(figure.panel);
    const here = order.indexOf(lit.run);
    const wanted = event.key === "Home" ? order.length - 1 : event.key === "End" ? 0
      : here < 0 ? Math.floor(order.length / 2) : here + (STEPS[event.key] ?? 0);
    light(order[Math.min(Math.max(wanted, 0), order.length - 1)], { kept: true });
    figure.panel.shape?.scrollIntoView({ block: "nearest" });
  } else return;
  event.preventDefault();
}

for (const figure of figures) {
  if (!figure.panels.some((panel) => panel.runs.some((one) => one.drawn !== false))) continue;
  figure.svg.classList.add("pointed");
  figure.svg.addEventListener("pointermove", (event) => {
    if (lit.kept || event.pointerType === "touch") return;
    const run = pointedAt(figure, event);
    if (run) light(run, { at: { x: event.clientX, y: event.clientY } });
    else if (lit.run) dim();
  });
  figure.svg.addEventListener("pointerleave", () => { if (lit.run && !lit.kept) dim(); });
  figure.svg.addEventListener("click", (event) => {
    if (String(getSelection())) return; // a label was being selected
    const run = pointedAt(figure, event);
    if (run) light(run, { kept: true });
    else dim();
  });
  figure.region.addEventListener("keydown", (event) => byKey(figure, event));
  const hint = made(figure.region, "p", { class: "keys", id: `${figure.name}-keys` },
    "Point at a run to see it everywhere, or use the arrow keys; Enter for its links, Escape to leave.");
  figure.region.setAttribute("aria-describedby", hint.id);
}

// In the table: a row under the pointer, or with the focus, is lit; its button keeps it so.
const keep = document.createElement("button");
Object.assign(keep, { type: "button", className: "show", textContent: "show" });

function inRow(event) {
  const row = event.target.closest("tbody tr");
  if (!row) return;
  const run = runOf.get(row);
  if (keep.parentElement !== row.cells[0]) {
    keep.setAttribute("aria-label", `show ${run} in the figures`);
    row.cells[0].append(" ", keep);
  }
  if (!lit.kept && run !== lit.run) light(run);
}
for (const row of rows) if (!row.querySelector("a")) row.cells[0].tabIndex = 0; // no recording to go to
body.addEventListener("pointerover", (event) => { if (event.pointerType === "mouse") inRow(event); });
body.addEventListener("focusin", inRow);
body.addEventListener("pointerleave", () => { if (lit.run && !lit.kept) dim(); });
body.addEventListener("click", (event) => {
  if (event.target.closest("a")) return;
  inRow(event);
  const run = runOf.get(event.target.closest("tr"));
  if (!run) return;
  light(run, { kept: true });
  if (event.detail === 0) card.focus(); // by keyboard
});
