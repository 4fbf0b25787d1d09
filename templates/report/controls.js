// Controls: play, pause, step, scrub, speed; rotate, move, zoom; sliders; by pointer, touch and keys.
function button(text, title, action) {
  const node = document.createElement("button");
  node.type = "button";
  node.textContent = text;
  node.title = title;
  node.setAttribute("aria-label", title);
  node.addEventListener("click", action);
  return node;
}

class Player {
  constructor(bar, show) {
    Object.assign(this, {show, playing: false, at: 0, factor: 1});
    this.toggle = button("Play", "Play or pause (space)", () => this.play(!this.playing));
    this.toggle.id = "play";
    this.slider = document.createElement("input");
    Object.assign(this.slider, {type: "range", id: "time", min: 0, max: 1, step: "any"});
    this.slider.setAttribute("aria-label", "time");
    this.slider.addEventListener("input", () => { this.play(false); this.jump(Number(this.slider.value)); });
    this.speed = document.createElement("select");
    this.speed.setAttribute("aria-label", "speed");
    for (const factor of [0.1, 0.25, 0.5, 1, 2, 4]) {
      const option = document.createElement("option");
      option.value = factor;
      option.textContent = factor + "\u00d7";
      this.speed.append(option);
    }
    this.speed.value = "1";
    this.speed.addEventListener("change", () => { this.factor = Number(this.speed.value); });
    this.clock = document.createElement("span");
    this.clock.className = "clock";
    this.clock.id = "clock";
    bar.append(button("Start", "To the start (home)", () => this.jump(this.t0)), this.toggle, button("Step", "One step (arrow keys)", () => this.step(1)), this.speed, this.slider, this.clock);
  }
  take(motion, speed) {
    this.t0 = motion.t[0];
    this.t1 = motion.t[motion.t.length - 1];
    this.rate = speed;
    Object.assign(this.slider, {min: this.t0, max: this.t1});
  }
  jump(t) {
    this.at = Math.min(this.t1, Math.max(this.t0, t));
    this.slider.value = this.at;
    this.clock.textContent = "t = " + this.at.toPrecision(4) + " s";
    this.show(this.at);
  }
  step(direction) {
    this.play(false);
    this.jump(this.at + direction * (this.t1 - this.t0) / 200);
  }
  play(on) {
    this.playing = on;
    this.toggle.textContent = on ? "Pause" : "Play";
    if (!on) return;
    if (this.at >= this.t1) this.jump(this.t0);
    let last = performance.now();
    const frame = (now) => {
      if (!this.playing) return;
      const next = this.at + (now - last) / 1000 * this.rate * this.factor;
      last = now;
      this.jump(next > this.t1 ? this.t0 : next);
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }
}

// Two fingers zoom and move; one finger rotates, or drags the object that `grab` selects.
function pointers(canvas, camera, redraw, grab) {
  const down = new Map();
  let held = null;
  const place = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  canvas.addEventListener("pointerdown", (event) => {
    if (canvas.setPointerCapture && event.isTrusted) canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, place(event));
    if (down.size === 1 && event.button === 0 && !event.shiftKey) held = grab(place(event));
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!down.has(event.pointerId)) return;
    const was = down.get(event.pointerId), now = place(event), dx = now[0] - was[0], dy = now[1] - was[1];
    if (down.size === 2) {
      const other = [...down].find(([id]) => id !== event.pointerId)[1];
      const before = Math.hypot(was[0] - other[0], was[1] - other[1]), after = Math.hypot(now[0] - other[0], now[1] - other[1]);
      if (before > 5) camera.zoom *= after / before;
      camera.pan = [camera.pan[0] + dx / 2, camera.pan[1] + dy / 2];
    } else if (held) {
      held.move(now);
    } else if (event.shiftKey || event.buttons & 6) {
      camera.pan = [camera.pan[0] + dx, camera.pan[1] + dy];
    } else {
      camera.turn(-dx * 0.008, dy * 0.008);
    }
    down.set(event.pointerId, now);
    if (!held) redraw();
  });
  const release = (event) => {
    down.delete(event.pointerId);
    if (held && down.size === 0) { held.release(); held = null; }
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;  // the page scrolls until the drawing has the focus
    event.preventDefault();
    camera.zoom *= Math.exp(-event.deltaY * 0.0015);
    redraw();
  }, {passive: false});
}

function keys(canvas, player, camera, redraw) {
  const actions = {" ": () => player.play(!player.playing), ArrowRight: () => player.step(1), ArrowLeft: () => player.step(-1), Home: () => player.jump(player.t0),
                   End: () => player.jump(player.t1), "+": () => { camera.zoom *= 1.2; redraw(); }, "-": () => { camera.zoom /= 1.2; redraw(); }, 0: () => { camera.home(); redraw(); },
                   a: () => { camera.turn(-0.1, 0); redraw(); }, d: () => { camera.turn(0.1, 0); redraw(); }, w: () => { camera.turn(0, 0.1); redraw(); }, s: () => { camera.turn(0, -0.1); redraw(); }};
  canvas.tabIndex = 0;
  canvas.addEventListener("keydown", (event) => {
    const action = actions[event.key];
    if (!action || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    action();
  });
}

// A number with a slider; `change` is called with a new value.
function slider(name, unitText, note, value, low, high, change) {
  const row = document.createElement("div"), label = document.createElement("label"), range = document.createElement("input"), number = document.createElement("input");
  row.className = "slider";
  label.textContent = name + (unitText && unitText !== "1" ? " in " + unitText : "");
  if (note) label.title = note;
  const short = (v) => String(Number(v.toPrecision(6)));
  Object.assign(range, {type: "range", min: low, max: high, step: "any", value});
  Object.assign(number, {type: "number", step: "any", value: short(value)});
  range.setAttribute("aria-label", name);
  label.append(document.createTextNode(""));
  number.setAttribute("aria-label", name + ", a number");
  range.dataset.name = number.dataset.name = name;
  range.addEventListener("input", () => { number.value = short(Number(range.value)); change(Number(range.value)); });
  number.addEventListener("change", () => { if (number.value !== "" && Number.isFinite(Number(number.value))) { range.value = number.value; change(Number(number.value)); } });
  row.append(label, number, range);
  return {row, set: (v) => {
    Object.assign(range, {min: Math.min(range.min, v), max: Math.max(range.max, v), value: v});
    number.value = short(v);
  }};
}

function rangeOf(value, positive) {
  if (value > 0) return [positive ? value / 10 : 0, 3 * value];
  if (value < 0) return [3 * value, 0];
  return [-1, 1];
}

