// Opens pages of `eomgen report` in frames of two widths and writes the results as JSON into the element `found`. In: `cases`, each {name, page, slider, csv}.
"use strict";
const widths = [1280, 390];
const later = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

// Messages of the page on the console, and exceptions.
const listen = "<script>window.messages = []; for (const kind of ['log', 'info', 'warn', 'error']) console[kind] = (...all) => messages.push(kind + ': ' + all.join(' '));" +
  "addEventListener('error', (e) => messages.push('error: ' + e.message)); addEventListener('unhandledrejection', (e) => messages.push('rejected: ' + e.reason));" +
  "addEventListener('securitypolicyviolation', (e) => messages.push('policy: ' + e.violatedDirective));<" + "/script>";

async function open(page, width) {
  const frame = document.createElement("iframe");
  frame.style.cssText = "border: 0; width: " + width + "px; height: 900px";
  frame.srcdoc = page.replace("<head>", "<head>" + listen);
  await new Promise((done) => { frame.addEventListener("load", done); document.body.prepend(frame); });
  for (const folded of frame.contentDocument.querySelectorAll("details")) folded.open = true;  // so that all parts are measured
  await later(50);
  return frame;
}

const box = (node) => node.getBoundingClientRect();
const hasInk = (node) => { const b = box(node); return b.width > 0.5 && b.height > 0.5 && node.textContent.trim() !== ""; };

// Layout of every formula: overlapping neighbours, functions without gap to their argument, lines wider than their column.
function formulas(frame) {
  const found = {count: 0, overlaps: [], tight: [], wide: []};
  for (const math of frame.contentDocument.querySelectorAll("math")) {
    ++found.count;
    const column = math.closest("p") || math.parentElement;
    if (column.scrollWidth > column.clientWidth + 1) found.wide.push(math.textContent.slice(0, 60));
    for (const row of math.querySelectorAll("mrow, math")) {
      const inked = [...row.children].filter(hasInk);
      for (let i = 1; i < inked.length; ++i) {
        const a = box(inked[i - 1]), b = box(inked[i]);
        if (b.left < a.right - 1.5 && b.right > a.left && b.top < a.bottom - 2 && b.bottom > a.top + 2) found.overlaps.push(inked[i - 1].textContent.slice(-12) + " | " + inked[i].textContent.slice(0, 12));
      }
      const children = [...row.children];
      children.forEach((child, i) => {
        if (child.textContent !== "\u2061") return;
        const before = children.slice(0, i).reverse().find(hasInk), after = children.slice(i + 1).find(hasInk);
        if (!before || !after || after.textContent.startsWith("(")) return;
        if (box(after).top < box(before).bottom && box(after).left - box(before).right < 0.5) found.tight.push(before.textContent + " | " + after.textContent.slice(0, 12));
      });
    }
  }
  for (const key of ["overlaps", "tight", "wide"]) found[key] = [found[key].length, ...found[key].slice(0, 3)];
  return found;
}

function picture(canvas) {
  const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  let sum = 0, ink = 0;
  for (let i = 3; i < pixels.length; i += 4) if (pixels[i] > 0) { ++ink; sum = (sum * 31 + pixels[i] + pixels[i - 1] * 3 + i) % 1000000007; }
  return {sum, ink};
}

// Largest distance, in pixels, of drawn positions from those in the rows of the run.
function furthest(report, csv) {
  let far = 0;
  // Without the two rows at a reset, whose time a page has in 10 digits.
  const apart = (k, other) => other < 0 || other === csv.rows.length || csv.rows[k][0] !== csv.rows[other][0];
  for (const row of csv.rows.filter((_, k) => apart(k, k - 1) && apart(k, k + 1))) {
    const y = report.motion().at(row[0]);
    report.data.parts.places.forEach((place) => {
      const column = csv.columns.indexOf(place.name + ".position1");
      if (column < 0) return;
      const a = report.scene.camera.project([y[place.at], y[place.at + 1], y[place.at + 2]]), b = report.scene.camera.project(row.slice(column, column + 3));
      far = Math.max(far, Math.hypot(a[0] - b[0], a[1] - b[1]));
    });
  }
  return far;
}

// Frames use the time of the browser; timers use virtual time, which passes faster.
// Largest distance, in pixels, of the nearest drawn corner of a body from the place of this name in the rows of the run.
// Uses the shape with the largest distance.
function cornerOff(report, csv, name) {
  const column = csv.columns.indexOf(name + ".position1"), {scene} = report;
  let far = 0;
  for (const row of csv.rows) {
    const y = report.motion().at(row[0]), wanted = scene.camera.project(row.slice(column, column + 3));
    scene.parts.solids.forEach((body, index) => scene.shapes[index].forEach((shape) => {
      const off = shape.faces.flatMap((face) => face.map(scene.worldOf(body, y))).map((r) => scene.camera.project(r)).map((p) => Math.hypot(p[0] - wanted[0], p[1] - wanted[1]));
      far = Math.max(far, Math.min(...off));
    }));
  }
  return far;
}

// Constraint surfaces: number of lines, and for a sphere about the origin the largest difference of their radii from that of the particle.
function surfaces(report) {
  const {scene} = report, y = scene.now, lines = scene.surfaces.flatMap((surface) => surface.find(report.player.at, y)), place = scene.surfaces[0].place;
  const radius = Math.hypot(...scene.placeAt(y, place));
  return {lines: lines.length, off: Math.max(...lines.flat().map((r) => Math.abs(Math.hypot(...r) - radius)))};
}

// A bowl z = x^2 + y^2 that moves with the reference place of its particle: largest error of its lines, and their displacement.
function carried(report) {
  const {scene, player} = report, lines = () => scene.surfaces[0].find(player.at, scene.now), cart = () => scene.placeAt(scene.now, 0);
  let off = 0;
  const look = () => { for (const [x, y, z] of lines().flat()) off = Math.max(off, Math.abs(z - (x - cart()[0]) ** 2 - y * y)); return cart()[0]; };
  player.jump(player.t0);
  const before = look();
  player.jump(player.t1);
  return {moved: Math.abs(look() - before), off, lines: lines().length};
}

// Pixels that forces add to the drawing when the reader ticks the box.
function forces(page, report) {
  const box = [...page.querySelectorAll("label")].find((label) => label.textContent.trim() === "forces"), canvas = page.getElementById("scene");
  if (!box) return 0;
  const before = picture(canvas).sum;
  box.querySelector("input").click();
  const shown = !page.querySelector(".legend").hidden, after = picture(canvas).sum;
  box.querySelector("input").click();
  return {drawn: shown && before !== after, taken_back: picture(canvas).sum === before, arrows: report.data.parts.arrows.length,
          moments: report.data.parts.arrows.filter((arrow) => arrow.turns).length, legend_of_moments: page.querySelector(".legend").textContent.includes("moments")};
}

// Largest differences of the tables below the plots from the end of the motion that is drawn, and of the numbers of the start from its begin.
function tables(page, report) {
  const motion = report.motion(), first = motion.x[0], last = motion.x[motion.x.length - 1], found = {table_off: 0, start_off: 0, in_table: 0};
  const cells = new Map([...page.querySelectorAll("#results tr")].map((row) => [row.cells[0].textContent, row.cells[1].textContent]));
  const numbers = new Map([...page.querySelectorAll(".slider input[type=number]")].map((input) => [input.dataset.name, Number(input.value)]));
  const off = (a, b) => Math.abs(a - b) / Math.max(1, Math.abs(b));
  report.live.states.forEach((state, k) => {
    if (!cells.has(state.name)) return;
    ++found.in_table;
    found.table_off = Math.max(found.table_off, off(Number(cells.get(state.name)), last[k]));
    if (numbers.has(state.name)) found.start_off = Math.max(found.start_off, off(numbers.get(state.name), first[k]));
  });
  return found;
}

// The section by the last coordinate of the phase portrait: its points, and how often the rows cross the value.
function phases(frame, page, report) {
  const folded = page.getElementById("phase"), section = folded.querySelectorAll("select")[1], change = () => section.dispatchEvent(new frame.contentWindow.Event("change"));
  const curves = folded.querySelectorAll("path").length, last = report.phase.coordinates.length - 1, {at} = report.phase.coordinates[last], {x} = report.motion();
  section.value = String(last);
  change();
  const points = folded.querySelectorAll("circle").length, note = folded.querySelector(".quiet").textContent;
  section.value = "-1";
  change();
  return {curves, points, note, crossed: x.filter((row, k) => k > 0 && x[k - 1][at] < 0 && row[at] >= 0).length, left: folded.querySelectorAll("circle").length};
}

// Layout of the page without scrolling: lowest edge of the controls, fields that cut off a number, words that name two controls.
function controls(page) {
  const fields = [...page.querySelectorAll(".slider input[type=number]")], kept = fields.map((field) => field.value);
  fields.forEach((field) => { field.value = "-1.23457e-12"; });
  const cut = fields.filter((field) => field.scrollWidth > field.clientWidth).length;
  fields.forEach((field, k) => { field.value = kept[k]; });
  const words = [...page.querySelectorAll("#stage button, #stage summary")].map((node) => node.textContent);
  return {bottom: Math.max(...[...page.querySelectorAll(".bar")].map((bar) => box(bar).bottom)), fields: fields.length, cut, twice: words.filter((word, k) => words.indexOf(word) < k)};
}

// Smallest gap in pixels between a letter and the dots above it.
function dotGap(page) {
  let least = Infinity;
  for (const mover of page.querySelectorAll("mover[accent=true]")) {
    const [letter, mark] = mover.children, room = parseFloat(page.defaultView.getComputedStyle(mark).paddingBottom);
    if (mark.textContent === "\u02d9" || mark.textContent === "\u00a8") least = Math.min(least, box(letter).top - box(mark).bottom + room);
  }
  return least;
}

async function wait(condition) {
  for (let k = 0; k < 30000 && !condition(); ++k) await later(20);
  return condition();
}

// Drags a drawn point by so many pixels. Returns its new position and the residual of the constraints.
async function drag(frame, report, {name, by}) {
  const page = frame.contentDocument, canvas = page.getElementById("scene"), place = report.data.parts.places.find((p) => p.name === name), {camera} = report.scene;
  const at = () => camera.project(report.scene.position(report.scene.now, place.at)), corner = box(canvas);
  const send = (kind, [x, y]) => canvas.dispatchEvent(new frame.contentWindow.PointerEvent(kind, {pointerId: 7, button: 0, buttons: kind === "pointerup" ? 0 : 1, clientX: corner.left + x, clientY: corner.top + y, bubbles: true}));
  report.player.play(false);
  report.player.jump(report.player.t0);
  const begin = at(), end = [begin[0] + by[0], begin[1] + by[1]];
  send("pointerdown", begin);
  for (let k = 1; k <= 8; ++k) send("pointermove", [begin[0] + (end[0] - begin[0]) * k / 8, begin[1] + (end[1] - begin[1]) * k / 8]);
  const reached = at();
  send("pointerup", end);
  await wait(() => report.motion().t.length >= 501);
  report.player.play(false);
  const {live} = report, x0 = report.motion().x[0], {psi} = live.constraintsAt(live.t0, x0, live.modeAt(live.t0, x0));  // of closed contacts
  const shown = tables(page, report);
  return {moved: Math.hypot(reached[0] - begin[0], reached[1] - begin[1]), nearer: Math.hypot(reached[0] - end[0], reached[1] - end[1]) < Math.hypot(begin[0] - end[0], begin[1] - end[1]) - 3,
          psi: Math.max(0, ...Array.from(psi, Math.abs)), ran: report.motion().t.length >= 501, ...shown};
}

// The animated picture of the motion as the browser decodes it: its size, and the largest share of pixels of a picture that
// are far from the drawing.
async function film(frame, report) {
  const {recorder} = report, {t0, t1} = report.player, times = [0, 0.3, 0.5, 0.8, 1].map((part) => t0 + part * (t1 - t0)), usual = recorder.times();
  const bytes = await recorder.gif({times, delay: 7}), decoder = new ImageDecoder({data: bytes, type: "image/gif"}), found = {pictures: 0, off: 0, moves: 0, kB: bytes.length / 1000};
  await decoder.tracks.ready;
  await decoder.completed;
  Object.assign(found, {pictures: decoder.tracks.selectedTrack.frameCount, repeats: decoder.tracks.selectedTrack.repetitionCount === Infinity, usual: usual.times.length, seconds: usual.delay * usual.times.length / 100});
  let before = null;
  for (let k = 0; k < found.pictures; ++k) {
    const {image} = await decoder.decode({frameIndex: k}), {width, height} = recorder.page, sheet = new OffscreenCanvas(width, height).getContext("2d");
    found.duration = image.duration;
    sheet.drawImage(image, 0, 0);
    const got = sheet.getImageData(0, 0, width, height).data, wanted = recorder.picture(times[k]);
    const far = (other) => got.reduce((count, value, i) => count + (Math.abs(value - other[i]) > 48 ? 1 : 0), 0) / got.length;
    found.off = Math.max(found.off, far(wanted));
    if (before !== null) found.moves = Math.max(found.moves, far(before));
    before = got;
  }
  recorder.say = () => {};
  const download = new Promise((done) => { frame.contentWindow.URL.createObjectURL = (blob) => { done(blob); return "#"; }; });
  recorder.times = () => ({times, delay: 7});
  await recorder.save();
  const saved = await download;
  return {...found, same: saved.size === bytes.length, type: saved.type};
}

async function look(entry) {
  const found = {name: entry.name, widths: {}};
  for (const width of widths) {
    const frame = await open(entry.page, width), page = frame.contentDocument, report = frame.contentWindow.report;
    const at = {dot_gap: dotGap(page), controls: controls(page), formulas: formulas(frame), sideways: page.documentElement.scrollWidth - page.documentElement.clientWidth};
    if (report) {
      const canvas = page.getElementById("scene");
      report.player.play(false);
      if (report.data.parts.places.length > 0) {
        report.player.jump(report.player.t0);
        const first = picture(canvas);
        report.player.jump(report.player.t0 + 0.37 * (report.player.t1 - report.player.t0));
        const second = picture(canvas);
        at.ink = first.ink;
        at.moves = first.sum !== second.sum;
      }
      page.getElementById("play").click();
      const before = report.player.at;
      at.plays = await wait(() => report.player.at !== before);
      report.player.play(false);
      at.covered = [...page.querySelectorAll("#plots.drawn text")].map((node) => node.textContent).filter((text) => text.includes("(as "));
      at.curves = page.querySelectorAll("#plots.drawn path").length;
      if (report.phase) at.phase = phases(frame, page, report);
      if (width === widths[0] && entry.csv) at.furthest = furthest(report, entry.csv);
      if (width === widths[0] && entry.corner) Object.assign(at, {corner: cornerOff(report, entry.csv, entry.corner), faces: report.scene.shapes[0].map((shape) => shape.faces.length)});
      if (width === widths[0] && entry.slider && report.live) {
        const range = [...page.querySelectorAll(".slider input[type=number]")].find((input) => input.dataset.name === entry.slider.name);
        range.value = entry.slider.value;
        range.dispatchEvent(new frame.contentWindow.Event("change"));
        const old = report.data.t.length;
        at.ran = await wait(() => report.motion().x !== null && report.motion().t.length >= 501 && page.getElementById("status").textContent.includes("steps in"));
        report.player.play(false);
        at.status = page.getElementById("status").textContent;
        const x = report.motion().x[report.motion().x.length - 1];
        at.end = {};
        report.live.states.forEach((state, k) => { at.end[state.name] = x[k]; });
        at.rows = old;
        Object.assign(at, tables(page, report));
        at.link = page.getElementById("link").hash;
      }
      report.player.jump(report.player.t0 + 0.37 * (report.player.t1 - report.player.t0));
      at.forces = forces(page, report);
      if (report.scene.surfaces.length > 0) at.surfaces = surfaces(report);
      if (entry.bowl) at.carried = carried(report);
      if (entry.floor) {
        const lines = report.scene.surfaces[0].find(report.player.at, report.scene.now);
        at.floor = {lines: lines.length, off: Math.max(...lines.flat().map(([, y]) => Math.abs(y)))};
      }
      at.live = report.live !== null;
      if (width === widths[0] && at.link) {  // the page at this address
        [...page.querySelectorAll("button")].find((node) => node.textContent === "As in the model").click();
        at.link_reset = page.getElementById("link").hash;
        frame.contentWindow.location.hash = at.link;
        await wait(() => page.getElementById("status").textContent.includes("steps in"));
        const taken = [...page.querySelectorAll(".slider input[type=number]")].find((input) => input.dataset.name === entry.slider.name);
        at.link_value = Number(taken.value);
        report.player.play(false);
      }
      if (width === widths[0] && entry.film) at.film = await film(frame, report);
      if (width === widths[0] && entry.drag) at.drag = await drag(frame, report, entry.drag);
    }
    at.messages = frame.contentWindow.messages;
    found.widths[width] = at;
    frame.remove();
  }
  return found;
}

(async () => {
  const found = [];
  for (const entry of cases) {
    try {
      found.push(await look(entry));
    } catch (error) {
      found.push({name: entry.name, failed: String(error && error.stack || error)});
    }
  }
  document.getElementById("cases").remove();
  document.getElementById("found").textContent = JSON.stringify(found);
})();
