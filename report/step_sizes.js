// The figure of step sizes in other measures: drawn anew from the numbers of the table of cells.
(() => {
  const { labels, tasks } = given.stepSizes;
  const region = document.querySelector("#step-sizes .picture");
  if (!region || !tasks.length) return;
  const still = region.querySelector("svg");
  const [WIDTH, HEIGHT, LEFT, TOP, LOW, LABELS] = [518.4, 190, 38, 22, 34, 94];

  // A round number at least as large, and the steps to it.
  function axis(most) {
    const size = 10 ** Math.floor(Math.log10(most || 1));
    const step = [0.25, 0.5, 1, 2, 2.5].map((part) => part * size).find((one) => most / one <= 5) ?? 5 * size;
    return { top: step * Math.ceil(most / step - 1e-9) || 1, step };
  }

  function short(number) {
    const plain = (one) => String(Number(one.toPrecision(4)));
    if (number >= 1e6) return `${plain(number / 1e6)}M`;
    return number >= 1e4 ? `${plain(number / 1e3)}k` : plain(number);
  }

  function panel(svg, { task, axes, lines }, label, left, width) {
    const known = lines.flatMap((line) => line.values[label].flat()).filter((one) => one !== null);
    const percent = axes[label].includes("[%");
    const { top, step } = percent ? { top: 100, step: 25 } : axis(Math.max(0, ...known));
    const alphas = [...new Set(lines.flatMap((line) => line.alphas))].sort((a, b) => a - b);
    const [first, last] = [alphas[0], alphas.at(-1)].map(Math.log10);
    const right = left + width;
    const x = (alpha) => left + 8 + ((width - 16) * (Math.log10(alpha) - first)) / (last - first || 1);
    const y = (number) => HEIGHT - LOW - ((HEIGHT - LOW - TOP - 4) * number) / top;
    made(svg, "text", { x: left - 30, y: 12, class: "title" }, `${task}: ${axes[label]}`);
    for (let at = 0; at <= top * 1.0001; at += step) {
      made(svg, "path", { class: "grid", d: `M${left} ${y(at)}H${right}` });
      made(svg, "text", { class: "tick", x: left - 5, y: y(at) + 3, "text-anchor": "end" }, short(at));
    }
    made(svg, "path", { class: "axis", d: `M${left} ${TOP}V${HEIGHT - LOW}H${right}` });
    for (let power = Math.ceil(first - 1e-9); power <= last + 1e-9; power += 1) {
      made(svg, "text", { class: "tick", x: x(10 ** power), y: HEIGHT - LOW + 12, "text-anchor": "middle" }, String(Number((10 ** power).toPrecision(3))));
    }
    made(svg, "text", { class: "tick", x: left + width / 2, y: HEIGHT - 8, "text-anchor": "middle" }, "step size α");
    const ends = [];
    const apart = Math.min(3, 8 / lines.length); // so that equal ones are seen
    for (const [number, line] of lines.entries()) {
      const group = made(svg, "g", { fill: line.colour, stroke: line.colour, class: line.modular ? "modular" : "" });
      const points = line.alphas.map((alpha, at) => ({ alpha, across: x(alpha) + apart * (number - (lines.length - 1) / 2), told: line.values[label][at] }));
      const there = points.filter(({ told }) => told[0] !== null);
      const stretches = points.map(({ across, told: [middle] }) => middle === null ? " M" : `${across} ${y(middle)} `).join("L").split(/L? M/);
      for (const one of stretches) {
        const d = one.replace(/^L|L$/g, "").trim();
        if (d.includes("L")) made(group, "path", { class: "line", d: `M${d}` });
      }
      for (const { alpha, across, told: [middle, low, high] } of there) {
        const dot = made(group, "g", { class: "point", "data-alpha": alpha, "data-name": line.name, "data-told": JSON.stringify([middle, low, high]) });
        // An interval without an upper end is open above.
        if (low !== null) made(dot, "path", { class: "interval", d: `M${across} ${y(low)}V${high === null ? TOP : y(high)}` });
        made(dot, "circle", { cx: across, cy: y(middle), r: 2.6 });
        const interval = low === null ? "" : ` [${short(low)}, ${high === null ? "∞" : short(high)}]`;
        made(dot, "title", {}, `${line.name}, α = ${alpha}: ${short(middle)}${interval}`);
      }
      if (there.length) ends.push({ y: y(there.at(-1).told[0]), name: line.name, colour: line.text });
    }
    if (!ends.length) made(svg, "text", { x: left + width / 2, y: HEIGHT / 2, "text-anchor": "middle", class: "tick" }, "no step size: fewer than half of the runs get there");
    ends.sort((a, b) => a.y - b.y);
    for (const [at, end] of ends.entries()) if (at) end.y = Math.max(end.y, ends[at - 1].y + 10);
    let lowest = HEIGHT - 4;
    for (const end of ends.toReversed()) {
      end.y = Math.min(end.y, lowest);
      lowest = end.y - 10;
    }
    for (const end of ends) made(svg, "text", { x: right + 8, y: end.y + 3, class: "name", fill: end.colour }, end.name);
  }

  function show(label) {
    region.querySelector("svg.chosen")?.remove();
    still.toggleAttribute("hidden", label !== labels[0]);
    note.textContent = label === labels[0] ? "" : "Drawn from the table of cells, with 95 % intervals where it has them; an interval that reaches the top has no upper end.";
    if (label === labels[0]) return;
    const shown = tasks.filter(({ axes }) => label in axes);
    const svg = document.createElementNS(still.namespaceURI, "svg");
    const said = shown.map(({ task, axes }) => `${task}: ${axes[label]}`).join("; ");
    for (const [key, one] of Object.entries({ class: "chosen", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": `Over the step size: ${said}.` })) svg.setAttribute(key, one);
    region.prepend(svg);
    const each = WIDTH / 2;
    for (const [at, one] of shown.entries()) panel(svg, one, label, at * each + LEFT, each - LEFT - LABELS);
  }

  const choice = made(document.createElement("p"), "label", {}, "Measure ");
  choice.parentElement.className = "measure";
  const select = made(choice, "select");
  for (const label of labels) made(select, "option", {}, label);
  const note = made(choice.parentElement, "output");
  select.addEventListener("change", () => show(select.value));
  region.before(choice.parentElement);
  if (select.value !== labels[0]) show(select.value); // a browser keeps what was chosen before
})();
