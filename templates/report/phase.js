// Phase portrait of one coordinate, and its Poincare section: the states at which another coordinate rises through a
// value.
function sectionOf(motion, at, value) {
  const found = [];
  for (let k = 0; k + 1 < motion.t.length; ++k) {
    if (!(motion.x[k][at] < value && motion.x[k + 1][at] >= value) || motion.t[k + 1] === motion.t[k]) continue;
    let low = motion.t[k], high = motion.t[k + 1];
    for (let step = 0; step < 40; ++step) {
      const middle = (low + high) / 2;
      if (motion.state(middle)[at] < value) low = middle;
      else high = middle;
    }
    found.push(motion.state(high));
  }
  return found;
}

class Phase {
  // coordinates: {name, at} of the state; `rates`: the place of the first rate.
  constructor(place, coordinates, rates, element) {
    Object.assign(this, {coordinates, rates, element, motion: null});
    const choice = (label, names) => {
      const select = document.createElement("select"), whole = document.createElement("label");
      names.forEach((name, k) => select.append(new Option(name, String(k - 1))));
      select.addEventListener("change", () => this.draw());
      whole.append(label + " ", select, " ");
      return {select, whole};
    };
    const folded = document.createElement("details"), summary = document.createElement("summary"), bar = document.createElement("p");
    this.of = choice("of", coordinates.map((c) => c.name));
    this.section = choice("section", ["none", ...coordinates.map((c) => c.name + " rises through")]);
    [...this.of.select.options].forEach((option, k) => { option.value = String(k); });
    this.value = document.createElement("input");
    Object.assign(this.value, {type: "number", step: "any", value: "0", disabled: true});
    this.value.setAttribute("aria-label", "value of the section");
    this.value.addEventListener("change", () => this.draw());
    this.figure = document.createElement("figure");
    this.note = document.createElement("p");
    this.note.className = "quiet";
    summary.textContent = "Phase portrait";
    folded.id = "phase";
    bar.append(this.of.whole, this.section.whole, this.value);
    folded.append(summary, bar, this.figure, this.note);
    folded.addEventListener("toggle", () => this.draw());
    this.folded = folded;
    place.after(folded);
  }

  take(motion) {
    this.motion = motion;
    this.draw();
  }

  draw() {
    const by = Number(this.section.select.value);
    this.value.disabled = by < 0;
    this.figure.textContent = this.note.textContent = "";
    if (!this.folded.open || !this.motion || !this.motion.x) return;
    const {name, at} = this.coordinates[Number(this.of.select.value)], pair = (x) => [x[at], x[this.rates + at]];
    const path = this.motion.x.map(pair), section = by < 0 ? [] : sectionOf(this.motion, this.coordinates[by].at, Number(this.value.value)).map(pair);
    if (by >= 0) this.note.textContent = section.length + " points";
    const width = 560, left = 62, right = width - 12, top = 8, bottom = 298, svg = this.element("svg", {viewBox: "0 0 " + width + " " + (bottom + 42), role: "img", "aria-label": "phase portrait of " + name});
    const axis = (k, from, to) => {
      const all = path.map((point) => point[k]).filter(Number.isFinite);
      let low = Math.min(...all), high = Math.max(...all);
      if (!(high >= low)) [low, high] = [-1, 1];
      const room = 0.04 * (high - low) || 0.5 * Math.max(Math.abs(high), 1e-3);
      [low, high] = [low - room, high + room];
      return {map: (v) => from + (to - from) * (v - low) / (high - low), ticks: niceTicks(low, high, 5)};
    };
    const across = axis(0, left, right), up = axis(1, bottom, top);
    for (const v of up.ticks.ticks) {
      svg.append(this.element("line", {class: "grid", x1: left, x2: right, y1: up.map(v), y2: up.map(v)}));
      svg.append(this.element("text", {x: left - 6, y: up.map(v) + 4, "text-anchor": "end"}, tickText(v, up.ticks)));
    }
    for (const v of across.ticks.ticks) {
      svg.append(this.element("line", {class: "axis", x1: across.map(v), x2: across.map(v), y1: bottom, y2: bottom + 5}));
      svg.append(this.element("text", {x: across.map(v), y: bottom + 19, "text-anchor": "middle"}, tickText(v, across.ticks)));
    }
    svg.append(this.element("path", {class: "axis", d: "M" + left + " " + top + "V" + bottom + "H" + right}));
    svg.append(this.element("text", {x: (left + right) / 2, y: bottom + 36, "text-anchor": "middle"}, name + ", and its rate upwards"));
    const place = ([q, rate]) => across.map(q).toFixed(1) + " " + up.map(rate).toFixed(1);
    const finite = path.filter((point) => point.every(Number.isFinite));
    svg.append(this.element("path", {stroke: palette[0], "stroke-width": by < 0 ? 1.5 : 0.4, fill: "none", d: finite.map((point, k) => (k > 0 ? "L" : "M") + place(point)).join("")}));
    for (const [q, rate] of section) svg.append(this.element("circle", {cx: across.map(q).toFixed(1), cy: up.map(rate).toFixed(1), r: 2.5, fill: palette[1 % palette.length]}));
    this.figure.append(svg);
  }
}
