// Dormand and Prince's pair of orders 5 and 4 with its dense output of order 4 (Hairer, Norsett, Wanner: Solving
// ordinary differential equations I, II.5 and II.6). The error estimate controls the step size; the state may be
// projected after each step. A step ends at the first sign change of an event function within it, at the first bound of
// the mode of a contact, and at the next sample.
const pair = {
  c: [0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1, 1],
  a: [[], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9], [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
      [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656], [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]],
  e: [71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40],
  d: [-12715105075 / 11282082432, 0, 87487479700 / 32700410799, -10690763975 / 1880347072, 701980252875 / 199316789632, -1453857185 / 822651844,
      69997945 / 29380423]};

const longestLook = 10;  // rows that a step with event functions covers at most
// Parts of a step at which event functions are evaluated; the first ones show the side of a bound that was just reached.
const looks = [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1], earlyLooks = [20, 16, 12, 8, 5].map((k) => 2 ** -k);
const mostJumps = 2000;  // changes of the state that have rows of their own
const shortest = 1e-6, mostInARow = 6;  // times between resets that become ever shorter: a part of the run, and how many may follow

class Integration {
  // problem: rhs(t, x, dx) -> code, project(t, x) -> whether x was changed, contacts: ContactModes that have started or
  // null, and what Resets needs
  constructor(problem, t0, t1, x0, rows) {
    this.problem = problem;
    this.t = t0;
    this.t1 = t1;
    this.x = Float64Array.from(x0);
    this.rtol = 1e-8;
    this.atol = 1e-10;
    this.steps = 0;
    this.outcome = "";
    this.k = pair.c.map(() => new Float64Array(x0.length));
    this.stage = new Float64Array(x0.length);
    this.next = new Float64Array(x0.length);
    this.dense = pair.c.slice(0, 5).map(() => new Float64Array(x0.length));
    this.times = [];
    this.states = [];
    this.modes = [];  // of the contacts, from each row on
    this.spacing = (t1 - t0) / rows;
    this.rows = rows;
    this.contacts = problem.contacts ? problem.contacts(this) : null;
    const begun = this.contacts ? this.contacts.start(t0, this.x, problem.open) : [];
    this.guards = this.contacts ? new Guards(this.contacts) : null;
    this.longest = problem.eventKinds.length > 0 || this.guards ? longestLook * this.spacing : Infinity;
    this.even = 1;  // rows at even spacing, so far
    this.jumps = 0;
    this.near = 0;  // resets that followed one another ever faster
    this.between = Infinity;  // time between the last two resets
    this.lastReset = -Infinity;
    this.resets = new Resets(problem, t0, t1);
    this.resets.crossed(t0, this.x);
    this.found.push(...begun.map((name) => ({t: t0, name})));
    this.beginContacts();
    this.keep(t0, this.x);
    const {changed, stopped} = this.resets.sample(t0, this.x);
    if (changed) {
      this.followReset();
      this.keep(t0, this.x);
    }
    this.outcome = this.resets.failure !== "" ? this.ended() : stopped ? "done" : "";
    this.restart();
    this.h = this.firstStep();
  }

  get found() { return this.resets.found; }

  get mode() { return this.contacts ? this.contacts.mode : null; }

  keep(t, x, mode = this.mode) { this.times.push(t); this.states.push(Float64Array.from(x)); this.modes.push(mode); }

  ended() { return "it ended: " + this.resets.failure; }

  // Begins a smooth part of the motion.
  restart() {
    if (this.outcome === "" && this.problem.rhs(this.t, this.x, this.k[0]) !== 0)
      this.outcome = this.steps === 0 ? "the equations have no value at this start" : "the equations have no value at t = " + this.t.toPrecision(6) + " s";
    this.begin = this.resets.values(this.t, this.x);
    this.until = this.resets.until(this.t);
  }

  // The transitions of contacts at zeros of their bounds. Returns whether a mode or the state changed.
  change(crossed, latest, h) {
    const mode = this.mode, before = Float64Array.from(this.x), {t, names} = this.guards.happen(crossed, this.t, this.x, latest, h);
    this.t = t;
    this.found.push(...names.map((name) => ({t, name})));
    if (this.contacts.failure !== "") this.resets.fail(this.contacts.failure, t);
    return mode !== this.mode || before.some((value, i) => value !== this.x[i]);
  }
  // New velocities have new modes.
  followReset() {
    if (!this.contacts) return;
    this.contacts.restart(this.t, this.x);
    this.beginContacts();
  }
  // Begins with the modes of contacts; bounds that do not hold are left at once.
  beginContacts() {
    if (!this.guards) return;
    this.guards.begin(this.t, this.x);
    this.change(this.guards.crossing(this.t, this.x), this.t, 0);
  }

  firstStep() {
    let size = 0, slope = 0;
    this.x.forEach((x, i) => {
      const scale = this.atol + this.rtol * Math.abs(x);
      size += (x / scale) ** 2;
      slope += (this.k[0][i] / scale) ** 2;
    });
    const h = slope > 1e-10 && size > 1e-10 ? 0.01 * Math.sqrt(size / slope) : 1e-6;
    return Math.min(h, (this.t1 - this.t) / 10, this.longest);
  }

  // Works for at most the given milliseconds; returns true when finished.
  advance(milliseconds) {
    const until = performance.now() + milliseconds;
    while (this.outcome === "" && performance.now() < until) for (let i = 0; i < 20 && this.outcome === ""; ++i) this.step();
    return this.outcome !== "";
  }

  // A step of size h to `next`; returns whether the equations have values there.
  attempt(h) {
    const {k, x, t, next, problem} = this;
    for (let s = 1; s < 7; ++s) {
      const target = s === 6 ? next : this.stage;
      for (let i = 0; i < x.length; ++i) {
        let sum = 0;
        for (let j = 0; j < s; ++j) sum += pair.a[s][j] * k[j][i];
        target[i] = x[i] + h * sum;
      }
      if (problem.rhs(t + pair.c[s] * h, target, k[s]) !== 0) return false;
    }
    return true;
  }

  errorOf(h) {
    const {k, x, next} = this;
    let error = 0;
    for (let i = 0; i < x.length; ++i) {
      let sum = 0;
      for (let s = 0; s < 7; ++s) sum += pair.e[s] * k[s][i];
      error += (h * sum / (this.atol + this.rtol * Math.max(Math.abs(x[i]), Math.abs(next[i])))) ** 2;
    }
    return Math.sqrt(error / x.length);
  }

  step() {
    const {k, x, t, next, problem} = this, isCut = t + 1.01 * this.h >= this.until;
    let h = isCut ? this.until - t : this.h;
    const error = this.attempt(h) ? this.errorOf(h) : Infinity;
    ++this.steps;
    if (!(error <= 1)) {
      this.h = h * (Number.isFinite(error) ? Math.max(0.2, 0.9 * error ** -0.2) : 0.2);
      if (!(this.h > 1e-13 * Math.max(1, Math.abs(t)))) this.outcome = "its steps became too small at t = " + t.toPrecision(4) + " s, where the equations fail";
      if (this.steps > 400000) this.outcome = "it was given up at t = " + t.toPrecision(4) + " s after 400000 steps: eomgen run has methods for stiff systems";
      return;
    }
    const grown = h * Math.min(5, Math.max(0.3, 0.9 * Math.max(error, 1e-10) ** -0.2));
    this.makeDense(h);
    const occurred = this.locate(h);
    let end = isCut ? this.until : t + h;
    if (occurred !== null) {
      h = occurred.h;
      end = t + h;
      this.makeDense(h);
    }
    for (; this.even <= this.rows; ++this.even) {
      const at = this.even === this.rows ? this.t1 : this.times[0] + this.even * this.spacing;
      if (at > end) break;
      this.interpolate((at - t) / h, this.stage);
      this.keep(at, this.stage);
    }
    x.set(next);
    this.t = end;
    const moved = problem.project(end, x);
    const led = this.contacts !== null && this.contacts.update(end, x) === true;  // the direction of friction changed
    if (occurred !== null || end >= this.until) {
      this.cross(occurred, h);
    } else if (moved || led) {
      problem.rhs(end, x, k[0]);
    } else {
      k[0].set(k[6]);
    }
    this.h = Math.min(isCut ? Math.max(this.h, grown) : grown, this.longest);
    if (occurred !== null && this.outcome === "") this.h = Math.min(this.h, this.firstStep());
  }

  // The events at the end of a step of length h, the samples that are due there, and the end of the run.
  cross(occurred, h) {
    const {x, resets} = this, before = Float64Array.from(x), {mode} = this, reached = this.t;
    let changed = occurred !== null && occurred.guards.length > 0 && this.change(occurred.guards, this.until, h), stopped = false;
    const {t} = this;
    if (occurred !== null && occurred.events.length > 0) {
      const reset = resets.happen(occurred.events, this.begin, t, x);
      stopped = reset.stopped;
      if (reset.changed) {
        const between = t - this.lastReset;
        this.near = between < Math.min(this.between, shortest * (this.t1 - this.times[0])) ? this.near + 1 : 0;
        Object.assign(this, {between, lastReset: t});
        if (this.near > mostInARow) resets.fail("events follow one another ever faster", t);
        this.followReset();
        changed = true;
      }
    }
    if (!stopped && resets.failure === "" && t >= this.until && t < this.t1) {
      const sampled = resets.sample(t, x);
      if (sampled.changed) this.followReset();
      changed = changed || sampled.changed;
      stopped = sampled.stopped;
    }
    const last = () => this.times[this.times.length - 1];
    if (changed && this.jumps < mostJumps) {
      ++this.jumps;
      if (last() < reached) this.keep(reached, before, mode);
      this.keep(t, x);
    }
    if (resets.failure !== "") this.outcome = this.ended();
    else if (stopped || t >= this.t1) this.outcome = "done";
    if (this.outcome === "") {
      this.restart();
    } else if (last() < t) {
      this.keep(t, x);
    } else {
      this.states[this.states.length - 1].set(x);
    }
  }

  makeDense(h) {
    const {k, x, next, dense} = this;
    for (let i = 0; i < x.length; ++i) {
      const difference = next[i] - x[i], bend = h * k[0][i] - difference;
      dense[0][i] = x[i];
      dense[1][i] = difference;
      dense[2][i] = bend;
      dense[3][i] = difference - h * k[6][i] - bend;
      let sum = 0;
      for (let s = 0; s < 7; ++s) sum += pair.d[s] * k[s][i];
      dense[4][i] = h * sum;
    }
  }

  interpolate(theta, out) {
    const d = this.dense, rest = 1 - theta;
    for (let i = 0; i < out.length; ++i) out[i] = d[0][i] + theta * (d[1][i] + rest * (d[2][i] + theta * (d[3][i] + rest * d[4][i])));
  }

  // What lies between the last state that was looked at and this one.
  behind(t, x, known) {
    const events = this.resets.crossing(t, x), guards = this.guards ? this.guards.crossing(t, x, known) : [];
    return events.length + guards.length > 0 ? {events, guards} : null;
  }

  // The first events and bounds of contacts within the step, {h, events, guards}, where `next` and k are then those of the
  // step that ends there; or null.
  locate(h) {
    const {resets, guards, t} = this, state = new Float64Array(this.x.length);
    if (this.problem.eventKinds.length === 0 && !guards) return null;
    let low = 0, high = 0, found = null;
    for (const look of guards && guards.isUnknown ? [...earlyLooks, ...looks] : looks) {
      low = high;
      high = look;
      if (look < 1) this.interpolate(high, state);
      else state.set(this.next);
      found = this.behind(t + high * h, state);
      if (found !== null) break;
      resets.crossed(t + high * h, state);
      if (guards) guards.observe(t + high * h, state);
    }
    if (found === null) return null;
    const known = found.guards;
    if (known.some(({i}) => guards.sides[i] === 0)) low = 0;  // a bound near its zero may have been crossed before that showed
    while (high - low > 2 ** -51 && h * (high - low) > 2 ** -51 * Math.abs(t)) {
      const middle = low + (high - low) / 2;
      if (!this.attempt(middle * h)) break;
      if (this.behind(t + middle * h, this.next, known) !== null) high = middle;
      else low = middle;
    }
    this.attempt(high * h);
    return {h: high * h, events: [], guards: [], ...this.behind(t + high * h, this.next, known)};
  }
}
