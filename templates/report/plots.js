// Curves over time, one panel per unit, as SVG that follows the motion.
const dashes = ["", "7 4", "2 3", "9 3 2 3"];

function niceTicks(low, high, wanted) {
  const span = high - low, rough = span / wanted, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough * 0.999), ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; ++k) ticks.push(k * step);
  return {ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), step};
}
function tickText(value, {digits, step}) {
  const size = Math.max(Math.abs(value), step);
  if (size >= 1e5 || step < 1e-4) return value === 0 ? "0" : value.toExponential(step < 0.01 * size ? 3 : 1).replace(/\.?0+e/, "e").replace("e+", "e");
  return value.toFixed(digits).replace(/^-(0(?:\.0*)?)$/, "$1").replace("-", "\u2212");
}

class Plots {
  constructor(place, panels, jump) { Object.assign(this, {place, panels, jump, cursors: []}); }

  element(name, attributes, text) {
    const node = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const key in attributes) node.setAttribute(key, attributes[key]);
    if (text !== undefined) node.textContent = text;
    return node;
  }

  take(motion) {
    this.place.textContent = "";
    this.place.classList.add("drawn");
    this.cursors = [];
    for (const panel of this.panels) {
      const figure = document.createElement("figure"), caption = document.createElement("figcaption");
      caption.textContent = panel.title;
      figure.append(caption, this.panel(motion, panel));
      this.place.append(figure);
    }
  }

  panel(motion, panel) {
    const width = 560, left = 62, right = width - 12, row = 20, columns = 4, legend = row * Math.ceil(panel.of.length / columns), top = legend + 8, bottom = top + 190;
    const svg = this.element("svg", {viewBox: "0 0 " + width + " " + (bottom + 42), role: "img", "aria-label": panel.title});
    const curves = panel.of.map((of) => motion.curve(of)), all = curves.flat().filter(Number.isFinite);
    let low = Math.min(...all), high = Math.max(...all);
    if (!(high >= low)) [low, high] = [-1, 1];
    if (high - low < 1e-9 * Math.max(Math.abs(high), Math.abs(low), 1e-300)) [low, high] = [low - 0.5 * Math.max(Math.abs(low), 1e-3), high + 0.5 * Math.max(Math.abs(high), 1e-3)];
    const room = 0.04 * (high - low), t0 = motion.t[0], t1 = motion.t[motion.t.length - 1];
    low -= room;
    high += room;
    const X = (t) => left + (right - left) * (t - t0) / (t1 - t0 || 1), Y = (v) => bottom - (bottom - top) * (v - low) / (high - low);
    const down = niceTicks(low, high, 5), along = niceTicks(t0, t1, 6);
    for (const v of down.ticks) {
      svg.append(this.element("line", {class: "grid", x1: left, x2: right, y1: Y(v), y2: Y(v)}));
      svg.append(this.element("text", {x: left - 6, y: Y(v) + 4, "text-anchor": "end"}, tickText(v, down)));
    }
    for (const t of along.ticks) {
      svg.append(this.element("line", {class: "axis", x1: X(t), x2: X(t), y1: bottom, y2: bottom + 5}));
      svg.append(this.element("text", {x: X(t), y: bottom + 19, "text-anchor": "middle"}, tickText(t, along)));
    }
    svg.append(this.element("path", {class: "axis", d: "M" + left + " " + top + "V" + bottom + "H" + right}));
    svg.append(this.element("text", {x: (left + right) / 2, y: bottom + 36, "text-anchor": "middle"}, "t in s"));
    for (const event of motion.events) {
      const mark = this.element("line", {class: "event", x1: X(event.t), x2: X(event.t), y1: top, y2: bottom});
      mark.append(this.element("title", {}, event.name + ", t = " + event.t.toPrecision(5) + " s"));
      svg.append(mark);
    }
    // The first curve that this one covers, or -1: they differ by less than a line width everywhere.
    const covered = curves.map((curve, i) => curves.findIndex((other, j) => j < i && other.every((value, k) => value === curve[k] || Math.abs(Y(value) - Y(curve[k])) < 1)));
    curves.forEach((curve, i) => {
      const style = {stroke: palette[i % palette.length], "stroke-width": 1.8, fill: "none", "stroke-linejoin": "round", "stroke-dasharray": covered[i] < 0 ? dashes[Math.floor(i / palette.length) % dashes.length] : "8 8"};
      let d = "", pen = false;
      curve.forEach((value, k) => {
        if (!Number.isFinite(value)) { pen = false; return; }
        d += (pen ? "L" : "M") + X(motion.t[k]).toFixed(1) + " " + Y(value).toFixed(1);
        pen = true;
      });
      svg.append(this.element("path", {...style, d}));
      const x = left + (i % columns) * (right - left) / columns, y = 14 + row * Math.floor(i / columns);
      svg.append(this.element("line", {...style, x1: x, x2: x + 22, y1: y - 4, y2: y - 4}));
      svg.append(this.element("text", {x: x + 27, y}, panel.of[i].name + (covered[i] < 0 ? "" : " (as " + panel.of[covered[i]].name + ")")));
    });
    const now = this.element("line", {class: "now", y1: top, y2: bottom});
    svg.append(now);
    this.cursors.push({now, X});
    svg.addEventListener("click", (event) => {
      const box = svg.getBoundingClientRect(), at = (event.clientX - box.left) * width / box.width;
      if (at >= left && at <= right) this.jump(t0 + (t1 - t0) * (at - left) / (right - left));
    });
    return svg;
  }

  show(t) { for (const {now, X} of this.cursors) { now.setAttribute("x1", X(t)); now.setAttribute("x2", X(t)); } }
}

