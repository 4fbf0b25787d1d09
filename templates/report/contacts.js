// Contacts as modes of a run in the page: they stick, slide, open and meet, by the rules of lib/eom/modes/contacts.hpp.
// In: the emitted event functions of every mode, rows of velocities. Out: guards that are positive inside a mode, and at
// their zeros the next mode and the velocities after impacts.
//
// The entry of a contact in `mode` is that of docs/abi.md, "Modes": entry % 3 is 0 sticking, 1 and 2 sliding along and
// against the tangent; from 3 on a unilateral contact is open, and the force of another has the other sign.
const contactValues = 5, mostBouncy = 0.9, knownGap = 3e-14;

// Finds transitions that accumulate: intervals that shrink to 1e-7 of the first one.
class Chatter {
  constructor() { Object.assign(this, {last: NaN, interval: NaN, sum: NaN, first: 0, shrinking: 0}); }
  add(t) {
    const interval = Math.abs(t - this.last), sum = interval + this.interval, before = this.sum;
    Object.assign(this, {interval, sum, last: t});
    if (!(sum < before)) {
      Object.assign(this, {first: sum, shrinking: 0});
      return false;
    }
    return ++this.shrinking >= 10 && sum < 1e-7 * this.first;
  }
}

class ContactModes extends ContactSearch {
  // live: code, p, input(t), contacts, mode_size, event_count, layout; tolerances: {rtol, atol}
  constructor(live, tolerances) {
    super();
    Object.assign(this, {live, tolerances, contacts: live.contacts, n: live.n, rates: live.layout.rates, failure: "", largestSlip: 0, largestGap: 0, mostRepeated: 32});
    this.mode = new Int32Array(live.mode_size);
    this.first = live.event_count - contactValues * this.contacts.length;
    this.all = new Float64Array(live.event_count);
    this.y = new Float64Array(live.contact_output_count);
    this.g = this.contacts.map(() => new Float64Array(contactValues));
    this.least = this.contacts.map(() => 0);  // slip in two directions that counts
    this.starting = this.contacts.map(() => null);  // the direction in which slip in two directions has just begun
    this.restitution = this.contacts.map(() => 0);
    this.forceSizes = this.contacts.map(() => 0);  // the largest normal forces
    this.hits = [];  // contacts of the last impacts
    this.together = [];  // contacts that the next impact closes
    this.chatter = new Chatter();
  }

  isOpen(mode, j) { return this.contacts[j].unilateral && mode[j] >= 3; }
  isClosed(mode, j) { return this.contacts[j].unilateral && mode[j] < 3; }
  withEntry(mode, j, entry) {
    const next = Int32Array.from(mode);
    next[j] = entry;
    return next;
  }
  opened(mode) { return Int32Array.from(mode, (entry, j) => (j < this.contacts.length && this.contacts[j].unilateral ? 3 : entry)); }

  // Slip and gap speeds up to this value count as zero.
  negligible() { return Math.max(1e-15, this.tolerances.atol, Math.max(1e-3 * this.tolerances.rtol, 1e-14) * this.largestSlip); }
  isTwo(j) { return this.contacts[j].directions === 2; }
  // Values of a bound up to this one count as zero where its mode begins.
  nearOf(j, k) { return k === 0 && !this.isTwo(j) ? this.negligible() : 0; }
  speedOf(j) { return this.isTwo(j) ? Math.hypot(this.g[j][0], this.g[j][2]) : Math.abs(this.g[j][0]); }

  // Writes the values of all contacts in a mode into g; returns whether all have one.
  evaluate(t, x, mode) {
    const {live, all, first} = this;
    if (live.code.events(t, x, live.p, live.input(t), mode, all) !== 0) return false;
    this.g.forEach((g, j) => { for (let k = 0; k < contactValues; ++k) g[k] = all[first + contactValues * j + k]; });
    return this.g.every((g) => !g.some(Number.isNaN));
  }
  outputs(t, x, mode) {
    const {live} = this;
    return live.code.contact_outputs(t, x, live.p, live.input(t), mode, this.y) === 0 ? this.y : null;
  }
  rhs(t, x, mode) {
    const {live} = this, dx = new Float64Array(x.length);
    return live.code.rhs(t, x, live.p, live.input(t), mode, dx) === 0 ? dx : null;
  }
  slip(t, x, j) {
    const y = this.outputs(t, x, this.opened(this.mode));
    return y === null ? [0, 0] : this.contacts[j].slip.map((k) => y[k]);
  }
  gapRow(t, x, j) {
    const {A, b} = this.live.constraintsAt(t, x), k = this.contacts[j].constraint;
    return {A: A[k], b: b[k]};
  }
  gapRate(t, x, j) {
    const {A, b} = this.gapRow(t, x, j);
    return A.reduce((sum, a, i) => sum + a * x[this.rates + i], b);
  }
  // Gaps up to this value are not known from 0.
  gapAccuracy(t, x, j) {
    const terms = this.gapRow(t, x, j).A.reduce((sum, a, i) => sum + Math.abs(a * x[i]), 0);
    return Math.max(knownGap * this.largestGap, 16 * 2 ** -52 * terms);
  }

  // Velocity rows A v + b = 0 of zero slip of the sticking contacts of a mode.
  slipRows(t, x, mode) {
    const rows = [], sticking = this.contacts.map((_, j) => j).filter((j) => this.contacts[j].sticks && mode[j] % 3 === 0 && !this.isOpen(mode, j));
    const y = sticking.length > 0 ? this.outputs(t, x, this.opened(mode)) : null;
    if (y === null) return rows;
    for (const j of sticking) {
      this.contacts[j].slip.forEach((slip, a) => {
        const slopes = this.contacts[j].slopes[a].map((k) => y[k]);
        rows.push({A: slopes, b: y[slip] - slopes.reduce((sum, s, i) => sum + s * x[this.rates + i], 0), slipOf: j, a});
      });
    }
    return rows;
  }
  // The same with constraints and closed contacts; without slip if all slide.
  rows(t, x, mode, allSlide) {
    const {A, b, index} = this.live.constraintsAt(t, x, mode), rows = A.map((row, i) => ({A: row, b: b[i], gap: index[i]}));
    return allSlide ? rows : [...rows, ...this.slipRows(t, x, mode)];
  }
  // The smallest change of velocities, in the metric of M, by which rows reach 0, or the value of `target`.
  move(t, x, rows, target) {
    if (rows.length === 0) return;
    const right = rows.map((row) => (target(row) || 0) - row.b - row.A.reduce((sum, a, i) => sum + a * x[this.rates + i], 0));
    const d = smallestCorrection(this.live.massAt(t, x), rows.map((row) => row.A), right);
    for (let i = 0; i < this.n; ++i) x[this.rates + i] += d[i];
  }
  // Velocities after an impact at contact j. Closed contacts that it would drive together take part.
  impact(t, x, mode, j, restitution) {
    const before = Float64Array.from(x), after = -restitution * this.gapRate(t, x, j), of = this.contacts[j].constraint;
    let part = this.withEntry(this.opened(mode), j, mode[j]);
    for (let more = true; more;) {
      more = false;
      x.set(before);
      this.move(t, x, this.rows(t, x, part, true), (row) => (row.gap === of ? after : 0));
      for (let i = 0; i < this.contacts.length; ++i) {
        if (!this.isClosed(mode, i) || !this.isOpen(part, i) || this.gapRate(t, x, i) >= -this.negligible()) continue;
        part = this.withEntry(part, i, 0);
        more = true;
      }
    }
  }
  close(t, x, mode) { this.move(t, x, this.rows(t, x, mode, true), () => 0); }
  stick(t, x, mode) { this.move(t, x, this.rows(t, x, mode, false), () => 0); }
  // Twice the least slip, against the friction of the sticking contact j.
  slide(t, x, mode, j) {
    const y = this.outputs(t, x, mode);
    if (y === null) return;
    let direction = this.contacts[j].phi.map((k) => -y[k]), length = Math.hypot(...direction);
    if (!(length > 0)) [direction, length] = [direction.map(() => 1), 1];
    this.move(t, x, this.rows(t, x, mode, false), (row) => (row.slipOf === j ? 2 * this.least[j] * direction[row.a] / length : 0));
    if (this.isTwo(j)) this.starting[j] = direction.map((value) => value / length);
  }
  // Extrapolates to the time at which slip in two directions vanishes, by the midpoint rule. Returns that time, or null if the slip grows.
  stop(t, x, mode, j) {
    const w = this.slip(t, x, j), speed = Math.hypot(...w);
    let k = this.rhs(t, x, mode);
    if (!(speed > 0) || k === null) return t;
    const moved = (h) => {
      const after = this.slip(t + h, x.map((value, i) => value + h * k[i]), j);
      return (w[0] * after[0] + w[1] * after[1]) / speed;
    };
    let h = 1e-6, rate = (moved(h) - speed) / h;
    if (rate < 0) {
      h = -speed / rate / 8;
      rate = (moved(h) - speed) / h;
    }
    if (!(rate < 0)) return null;
    h = -speed / rate;
    k = this.rhs(t + h / 2, x.map((value, i) => value + h / 2 * k[i]), mode) || k;
    for (let i = 0; i < x.length; ++i) x[i] += h * k[i];
    return t + h;
  }

  // Called at each step: the slip in two directions whose direction is known. Returns whether a start of slip ended.
  update(t, x) {
    if (!this.contacts.some((_, j) => this.isTwo(j))) return false;
    const y = this.outputs(t, x, this.opened(this.mode)), {rtol, atol} = this.tolerances;
    if (y === null) return false;
    let ended = false;
    this.contacts.forEach((contact, j) => {
      const known = contact.slopes.map((slopes) => slopes.reduce((sum, k, i) => sum + Math.abs(y[k]) * (atol + rtol * Math.abs(x[this.rates + i])), 0));
      this.least[j] = Math.max(this.negligible(), 30 * Math.max(0, ...known));
      if (this.starting[j] === null || !hasStarted(contact.slip.map((k) => y[k]), this.starting[j], this.least[j], this.startSlip(j))) return;
      this.starting[j] = null;
      ended = true;
    });
    return ended;
  }
  startSlip(j) { return this.least[j] * startOfSlip(this.tolerances.rtol); }
  // Ends starts of contacts that do not slide in this mode.
  updateStarts() { this.contacts.forEach((_, j) => { if (this.mode[j] % 3 === 0 || this.isOpen(this.mode, j)) this.starting[j] = null; }); }
  // The state at which the right-hand side is evaluated while slip is small: x with the led slip, by the smallest change
  // of the rates (lib/eom/hybrid/slip_start.hpp).
  lead(t, x) {
    if (this.starting.every((direction) => direction === null)) return x;
    const y = this.outputs(t, x, this.opened(this.mode));
    if (y === null) return x;
    const led = Float64Array.from(x);
    this.contacts.forEach((contact, j) => {
      const w = this.starting[j] === null ? [] : contact.slip.map((k) => y[k]), speed = Math.hypot(...w);
      if (w.length === 0 || speed >= this.startSlip(j)) return;
      const to = frictionDirection(w, this.starting[j], this.least[j], this.startSlip(j)), size = Math.max(speed, 1e-3 * this.least[j]);
      const [a, b] = contact.slopes.map((slopes) => slopes.map((k) => y[k])), product = (p, q) => p.reduce((sum, value, i) => sum + value * q[i], 0);
      const aa = product(a, a), ab = product(a, b), bb = product(b, b), determinant = aa * bb - ab * ab, first = size * to[0] - w[0], second = size * to[1] - w[1];
      if (!(determinant > 1e-12 * aa * bb)) return;
      a.forEach((value, i) => { led[this.rates + i] += (value * (bb * first - ab * second) + b[i] * (aa * second - ab * first)) / determinant; });
    });
    return led;
  }

  // The modes at a start, where contacts with open[j] are open. x changes if an impact occurs. Returns the names of contacts
  // that begin to slide or open at once.
  start(t, x, open) {
    this.mode = Int32Array.from(this.mode, (_, j) => (j < this.contacts.length && this.contacts[j].unilateral && open[j] ? 3 : 0));
    this.starting = this.contacts.map(() => null);
    const y = this.outputs(t, x, this.opened(this.mode));
    this.restitution = this.contacts.map((contact) => (contact.restitution === null || y === null ? 0 : y[contact.restitution]));
    this.update(t, x);
    const hasValues = this.evaluate(t, x, this.mode), rests = this.contacts.map((_, j) => hasValues && this.speedOf(j) <= this.negligible());
    if (hasValues) this.observe(this.mode);
    let {mode} = this;
    for (let j = 0; j < this.contacts.length; ++j) {
      if (!this.isClosed(mode, j)) continue;
      const speed = this.gapRate(t, x, j);
      if (speed > this.negligible()) mode = this.withEntry(mode, j, 3);
      if (speed < -this.negligible()) mode = this.applyImpact(t, x, mode, j, true).mode;
    }
    this.mode = this.consistent(t, x, mode);
    this.updateStarts();
    this.update(t, x);
    const begins = ({sticks}, j) => (this.isOpen(this.mode, j) ? !open[j] : sticks && this.mode[j] % 3 !== 0 && rests[j]);
    return this.contacts.filter(begins).map((contact) => contact.name);
  }
  // After a change of velocities: contacts that are open stay open.
  restart(t, x) { this.start(t, x, this.contacts.map((_, j) => this.isOpen(this.mode, j))); }

  // Records the largest values, from which rounding errors follow.
  observe(mode) {
    this.contacts.forEach((contact, j) => {
      if (contact.directions > 0 && Number.isFinite(this.speedOf(j))) this.largestSlip = Math.max(this.largestSlip, this.speedOf(j));
      if (this.isOpen(mode, j)) this.largestGap = Math.max(this.largestGap, this.g[j][3]);
      else if (Number.isFinite(this.g[j][3])) this.forceSizes[j] = Math.max(this.forceSizes[j], Math.abs(this.g[j][3]));
    });
  }
  // The functions that bound the current mode, {j, k, sign}: value k of contact j, times the sign, is positive inside.
  bounds() {
    const result = [], add = (j, k, sign) => result.push({j, k, sign});
    this.contacts.forEach((contact, j) => {
      const entry = this.mode[j], open = this.isOpen(this.mode, j);
      if (contact.sticks && !open && entry % 3 === 0) {
        add(j, 1, 1);
        if (contact.directions === 1) add(j, 2, 1);
      } else if (contact.sticks && !open) {
        add(j, 0, entry % 3 === 1 ? 1 : -1);
      }
      if (!open && contact.directions > 0) add(j, 4, 1);
      if (contact.surface || contact.unilateral) add(j, 3, 1);
    });
    return result;
  }
  // Their values; NaN if they have none.
  values(t, x, bounds) {
    if (!this.evaluate(t, x, this.mode)) return bounds.map(() => NaN);
    return bounds.map(({j, k, sign}) => (k !== 0 || !this.isTwo(j) ? sign * this.g[j][k] : this.starting[j] !== null ? 1 : this.speedOf(j) - this.least[j]));
  }

  holds(j) { return this.g[j][1] >= 0 && (this.isTwo(j) || this.g[j][2] >= 0); }

  // The mode in which the closed contacts of `mode` slide or stick as the velocities say.
  consistent(t, x, mode) {
    const count = this.contacts.length;
    for (let j = 0; j < count; ++j) if (this.isClosed(mode, j) && this.gapRate(t, x, j) > this.negligible()) mode = this.withEntry(mode, j, 3);
    for (let j = 0; j < count; ++j) {
      if (this.isOpen(mode, j) || !this.contacts[j].sticks) continue;
      const high = mode[j] - mode[j] % 3;
      mode = this.withEntry(mode, j, high);
      if (!this.evaluate(t, x, mode)) return mode;
      if (this.speedOf(j) > this.negligible()) mode = this.withEntry(mode, j, high + (!this.isTwo(j) && this.g[j][0] < 0 ? 2 : 1));
    }
    // One change may require another. If this leads to no admissible mode, all modes are tried.
    const touching = mode, before = Float64Array.from(x);
    for (let round = 0; round < 4 * count; ++round) {
      if (!this.evaluate(t, x, mode)) return mode;
      const next = this.improved(t, x, mode);
      if (next === mode) break;
      mode = next;
    }
    if (this.isAdmissible(t, x, touching, mode)) return mode;
    const after = Float64Array.from(x);
    x.set(before);
    const found = this.searched(t, x, touching);
    if (found === null) x.set(after);
    return found === null ? mode : found;
  }
  improved(t, x, mode) {
    for (let j = 0; j < this.contacts.length; ++j) {
      const {unilateral, directions, surface, sticks} = this.contacts[j], g = this.g[j], entry = mode[j];
      if (this.isOpen(mode, j) || unilateral && g[3] < 0 && directions > 0 && g[4] < 0) continue;
      if (unilateral && g[3] < 0) return this.withEntry(mode, j, 3);
      if (surface && g[3] < 0) return this.withEntry(mode, j, (entry + 3) % 6);
      if (entry % 3 !== 0 || !sticks || this.holds(j)) continue;
      if (directions === 1) return this.withEntry(mode, j, g[1] < 0 ? entry + 2 : entry + 1);
      this.slide(t, x, mode, j);
      return this.withEntry(mode, j, entry + 1);
    }
    return mode;
  }

  // An impact at contact j, which stays open if it bounces. Returns {mode, names}.
  applyImpact(t, x, mode, j, bounces) {
    const speed = this.gapRate(t, x, j);
    if (bounces && this.together.length === 0 && speed > this.negligible()) return {mode, names: []};
    this.hits = [...this.hits.slice(-7), j];
    const names = (after) => [j, ...this.contacts.map((_, i) => i).filter((i) => i !== j && this.isOpen(mode, i) && this.isClosed(after, i))].map((i) => this.contacts[i].name);
    if (this.together.length > 0) {
      const closed = Int32Array.from(mode);
      for (const i of this.together) closed[i] = 0;
      this.together = [];
      this.close(t, x, closed);
      return {mode: this.consistent(t, x, closed), names: names(closed)};
    }
    const e = bounces ? this.restitution[j] : 0, away = e > 0 && -speed * e > this.negligible();
    if (speed < 0) this.impact(t, x, this.withEntry(mode, j, 0), j, away ? e : 0);
    return {mode: this.consistent(t, x, away ? mode : this.withEntry(mode, j, 0)), names: [this.contacts[j].name]};
  }
  // The end of ever smaller bounces: lasting contact of all contacts that took turns.
  settle(t, x, j) {
    const mode = this.withEntry(this.mode, j, 0);
    let alone = true;
    this.contacts.forEach((contact, i) => {
      if (i === j || !contact.unilateral || this.hits.filter((hit) => hit === i).length < 3) return;
      mode[i] = 0;
      alone = false;
    });
    if (alone) return this.applyImpact(t, x, this.withEntry(this.mode, j, 3), j, false);
    this.close(t, x, mode);
    return {mode: this.consistent(t, x, mode), names: this.contacts.filter((_, i) => i === j || this.isOpen(this.mode, i) && this.isClosed(mode, i)).map((contact) => contact.name)};
  }

  decelerations(t, x, mode) {
    const k = this.rhs(t, x, mode), h = 1e-6;
    if (k === null) return null;
    const later = x.map((value, i) => value + h * k[i]);
    return this.contacts.map((contact, i) => (contact.unilateral ? (this.gapRate(t, x, i) - this.gapRate(t + h, later, i)) / h : 0));
  }
  // If the next bounce is lower than the accuracy of the gap, the motion continues for the sum of the times of all
  // bounces, and the contact closes then. Returns the time.
  endBounces(t, x, j, latest) {
    const e = this.restitution[j], up = -e * this.gapRate(t, x, j), fall = up > 0 ? this.decelerations(t, x, this.mode) : null;
    if (fall === null || !(fall[j] > 0) || up * up / (2 * fall[j]) > this.gapAccuracy(t, x, j)) return t;
    const time = 2 * up / (fall[j] * (1 - e)), met = this.met(t, x, j, time);
    if (met === null || t + time > latest) return t;
    if (met.others.length > 0) {
      if (met.over) this.together = [...met.others, j];
      return t;
    }
    this.impact(t, x, this.withEntry(this.mode, j, 0), j, e / (1 - e));
    const k = this.rhs(t, x, this.mode);
    if (k === null) return t;
    for (let i = 0; i < x.length; ++i) x[i] += time * (k[i] + (i < this.n ? time / 2 * k[this.rates + i] : 0));
    this.restitution[j] = 0;
    return t + time;
  }
  // Contacts that the last bounces of contact j open or reach, and whether their bounces are as low.
  met(t, x, j, time) {
    const open = this.opened(this.mode), fall = this.decelerations(t, x, open), after = Float64Array.from(x), result = {others: [], over: true};
    if (fall === null || !this.evaluate(t, x, open)) return null;
    const gaps = this.g.map((g) => g[3]);
    this.impact(t, after, this.withEntry(this.mode, j, 0), j, this.restitution[j]);
    this.contacts.forEach((contact, i) => {
      if (i === j || !contact.unilateral) return;
      const known = this.gapAccuracy(t, x, i), away = this.gapRate(t, after, i);
      const isAlone = this.isClosed(this.mode, i) ? Math.abs(away) <= this.negligible() : gaps[i] > known && gaps[i] + (away - Math.max(fall[i], 0) * time / 2) * time > 0;
      if (isAlone) return;
      const speed = Math.max(Math.abs(this.gapRate(t, x, i)), Math.abs(away));
      result.over = result.over && fall[i] > 0 && speed * speed / (2 * fall[i]) <= known;
      result.others.push(i);
    });
    return result;
  }

  // The transition at a zero of a bound. Sets the mode, changes x; returns {t, names, resumes}, or sets `failure`.
  cross(t, x, {j, k}, latest) {
    const contact = this.contacts[j], entry = this.mode[j], before = this.mode, hits = k === 3 && this.isOpen(before, j), e = hits ? this.restitution[j] : 0;
    if (e > 0 && e < mostBouncy) t = this.endBounces(t, x, j, latest);
    const take = (mode, names = []) => {
      this.mode = mode;
      this.updateStarts();
      if (e > 0) this.restitution[j] = e;
      this.update(t, x);
      return {t, names, resumes: names.length === 0 && mode.every((value, i) => value === before[i])};
    };
    const next = (value, name = contact.name) => take(this.withEntry(before, j, value), name === null ? [] : [name]);
    if (this.chatter.add(t)) {
      this.chatter = new Chatter();
      if (k === 3 && contact.unilateral) {
        const {mode, names} = this.settle(t, x, j);
        return take(mode, names);
      }
      this.failure = "changes of \u201c" + contact.name + "\u201d follow one another ever faster";
      return {t, names: [], resumes: false};
    }
    if (k === 4) {
      this.failure = "the friction of \u201c" + contact.name + "\u201d has no solution, or several";
      return {t, names: [], resumes: false};
    }
    if (k === 3) {
      if (!contact.unilateral) return next((entry + 3) % 6, null);
      if (!hits) return next(3);
      const {mode, names} = this.applyImpact(t, x, before, j, true);
      return take(mode, names);
    }
    const high = entry - entry % 3, sticking = this.withEntry(before, j, high);
    if (k !== 0) {  // friction reaches its limit
      if (this.isTwo(j)) this.slide(t, x, before, j);
      return next(high + (k === 1 && !this.isTwo(j) ? 2 : 1));
    }
    if (this.isTwo(j)) {
      const end = this.stop(t, x, before, j);
      if (end === null) return take(before);
      t = end;
    }
    if (this.evaluate(t, x, sticking) && this.holds(j)) {
      if (this.isTwo(j)) this.stick(t, x, sticking);
      return take(sticking, [contact.name]);
    }
    if (!this.isTwo(j)) return next(high + 3 - entry % 3);
    this.slide(t, x, sticking, j);
    return take(before, [contact.name]);
  }
}
