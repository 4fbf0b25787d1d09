// A motion: rows of the original run, or of a run in the page. `at(t)` returns the values for drawings and plots.
class Motion {
  constructor(t, x, y, live, events) { Object.assign(this, {t, x, y, live, events}); }

  row(t) {
    let low = 0, high = this.t.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.t[middle] <= t) low = middle;
      else high = middle;
    }
    return low;
  }

  // The row before t, its distance to the next one, and the part of it at t. Two rows at the same time are the state
  // before and after a jump: the later one holds there.
  between(t) {
    const k = this.row(t), h = this.t[k + 1] - this.t[k];
    return {k, h, s: h > 0 ? Math.min(1, Math.max(0, (t - this.t[k]) / h)) : 1};
  }

  // Coordinates are interpolated by cubic Hermite polynomials, since their rates are in the state. Discrete values are
  // constant up to the next row.
  state(t) {
    const {k, h, s} = this.between(t), {rates, first_order, discrete, size} = this.live.layout;
    const a = this.x[k], b = this.x[k + 1], n = this.live.n, x = new Float64Array(size);
    const ha = (1 + 2 * s) * (1 - s) ** 2, hb = s * s * (3 - 2 * s), ga = s * (1 - s) ** 2 * h, gb = s * s * (s - 1) * h;
    for (let i = 0; i < n; ++i) {
      x[i] = ha * a[i] + hb * b[i] + ga * a[rates + i] + gb * b[rates + i];
      x[rates + i] = (1 - s) * a[rates + i] + s * b[rates + i];
    }
    for (let i = first_order; i < size; ++i) x[i] = i < discrete ? (1 - s) * a[i] + s * b[i] : s < 1 ? a[i] : b[i];
    return x;
  }

  at(t) {
    if (this.x) return this.live.outputs(t, this.state(t));
    const {k, s} = this.between(t);
    return this.y[k].map((value, i) => (1 - s) * value + s * this.y[k + 1][i]);
  }

  atRow(k) { return this.x ? this.live.outputs(this.t[k], this.x[k]) : this.y[k]; }

  // All rows for the drawing, computed once.
  drawn() {
    if (!this.all) this.all = this.t.map((_, k) => Array.from(this.atRow(k)));
    return this.all;
  }
  curve(of) { return of.state ? this.x.map((x) => x[of.at]) : this.drawn().map((y) => y[of.at]); }
}

// Why a start is refused, by the code of `start`.
const refusals = {5: "a value of the start is not finite", 7: "the start breaks a constraint", 8: "the start has a coordinate outside its range"};

// The current model: values chosen by the user, and all that follows from them: parameters, times, a start on the
// constraints. If nothing does, `refusal` says why, and the values before remain.
class Live {
  constructor(code, description, data) {
    Object.assign(this, description);
    this.code = code;
    this.kinds = code.info.constraint_kinds || [];
    this.m = this.constraints;
    this.count = code.info.outputs.length;
    this.end = null;
    this.reset();
    if (Math.abs(this.t1 - data.t1) > 1e-12 * Math.abs(data.t1)) this.end = data.t1;  // the command line sets it
    this.prepare();
  }

  reset() {
    this.chosen = this.parameters.map((p) => p.value);
    this.starts_chosen = new Map();
    this.placed = null;
    this.prepare();
  }

  prepare() {
    this.refusal = this.follow(this.placed ? this.placed.entries() : [...this.set, ...this.starts_chosen]);
    if (this.refusal === "" || !this.placed) return;
    // A state that was placed by hand is moved onto the constraints.
    this.refusal = this.follow(this.set);
    if (this.refusal !== "") return;
    this.x.set(this.placed);
    if (this.meetPositions()) this.meetRates();
    else this.refusal = "the constraints cannot be met near this place";
    for (const [i, k] of this.starts) this.p[i] = this.x[k];
  }

  // Takes the start that follows from these initial values, pairs of a state and its value. Returns a refusal, or "".
  follow(initial) {
    const states = this.layout.size, count = this.chosen.length, given = new Int32Array(states + count + 2);
    const x = new Float64Array(states), p = Float64Array.from(this.chosen), t = Float64Array.of(0, this.end === null ? 0 : this.end);
    for (const [k, value] of initial) {
      given[k] = 1;
      x[k] = value;
    }
    this.parameters.forEach((parameter, i) => { given[states + i] = parameter.moved ? 1 : 0; });
    given[states + count + 1] = this.end === null ? 0 : 1;
    const code = this.code.start(given, t, x, p, null);
    if (code !== 0) return refusals[code];
    if (!(t[1] > t[0])) return "the run would end at t = " + t[1].toPrecision(4) + " s, before its start at t = " + t[0].toPrecision(4) + " s";
    Object.assign(this, {x, p, t0: t[0], t1: t[1], sizes: new Float64Array(this.size_count)});
    const periods = new Float64Array(2 * this.samples.length);
    this.code.setup(this.t0, x, p, null, 0, this.sizes, periods);
    this.samples.forEach((sample, i) => Object.assign(sample, {every: periods[2 * i], offset: periods[2 * i + 1]}));
    return "";
  }

  input(t) {
    if (this.inputs === 0) return null;
    const u = new Float64Array(this.inputs);
    this.code.signals(t, this.x, this.p, null, 0, u);
    return u;
  }
  outputs(t, x) {
    const y = new Float64Array(this.count);
    this.code.outputs(t, x, this.p, this.input(t), 0, y);
    return y;
  }

  // psi, A, b of the constraints with multipliers, A by rows.
  constraintsAt(t, x) {
    const {n, m} = this, psi = new Float64Array(m), flat = new Float64Array(m * n), b = new Float64Array(m), A = [];
    if (m === 0) return {psi, A, b};
    this.code.constraints(t, x, this.p, psi, flat, b);
    for (let k = 0; k < m; ++k) A.push(Float64Array.from({length: n}, (_, j) => flat[k + m * j]));
    return {psi, A, b};
  }
  massAt(t, x) {
    const {n} = this, M = new Float64Array(n * n), h = new Float64Array(n);
    if (this.code.mass(t, x, this.p, M, h) !== 0) return this.identity();
    return Array.from({length: n}, (_, i) => Float64Array.from({length: n}, (_, j) => M[i + n * j]));
  }
  identity() { return Array.from({length: this.n}, (_, i) => Float64Array.from({length: this.n}, (_, j) => (i === j ? 1 : 0))); }
  // Newton's method by the smallest changes; returns whether the constraints are met.
  meetPositions() {
    const place = this.kinds.map((kind, k) => (kind === "holonomic" ? k : -1)).filter((k) => k >= 0);
    const met = ({psi, A}, digits) => place.every((k) => Math.abs(psi[k]) <= digits * A[k].reduce((sum, a, i) => sum + Math.abs(a) * (1 + Math.abs(this.x[i])), 0));
    for (let iteration = 0; iteration < 40 && place.length > 0; ++iteration) {
      const at = this.constraintsAt(this.t0, this.x);
      if (met(at, 1e-14)) break;
      const d = smallestCorrection(this.identity(), place.map((k) => at.A[k]), place.map((k) => -at.psi[k])), size = Math.hypot(...d);
      for (let i = 0; i < this.n; ++i) this.x[i] += d[i] * Math.min(1, 1 / size);
      if (size < 1e-14) break;
    }
    return met(this.constraintsAt(this.t0, this.x), 1e-10);
  }
  meetRates() {
    const {n, m} = this, {rates} = this.layout;
    if (m === 0) return;
    const {A, b} = this.constraintsAt(this.t0, this.x);
    const d = smallestCorrection(this.identity(), A, A.map((row, k) => -b[k] - row.reduce((sum, a, i) => sum + a * this.x[rates + i], 0)));
    for (let i = 0; i < n; ++i) this.x[rates + i] += d[i];
  }

  // Projection onto the constraints after a step, by the smallest change in the mass norm.
  project(t, x) {
    const {n, m} = this, {rates} = this.layout;
    if (m === 0) return false;
    let {psi, A, b} = this.constraintsAt(t, x);
    const M = this.massAt(t, x);
    const place = psi.map((value, k) => (this.kinds[k] === "holonomic" ? -value : 0));
    if (place.some((value) => Math.abs(value) > 1e-13)) {
      const rows = A.filter((_, k) => this.kinds[k] === "holonomic"), right = place.filter((_, k) => this.kinds[k] === "holonomic");
      const d = smallestCorrection(M, rows, right);
      for (let i = 0; i < n; ++i) x[i] += d[i];
      ({psi, A, b} = this.constraintsAt(t, x));
    }
    const r = A.map((row, k) => -b[k] - row.reduce((sum, a, i) => sum + a * x[rates + i], 0));
    const d = smallestCorrection(M, A, r);
    for (let i = 0; i < n; ++i) x[rates + i] += d[i];
    return true;
  }

  // After a reset: adds the impulses of the constraints to the new velocities. Returns whether new coordinates satisfy
  // the constraints.
  meet(t, x, set) {
    const before = x.slice(0, this.n), size = Math.max(1, ...Array.from(before, Math.abs));
    this.project(t, x);
    return !set.some(([place]) => place < this.n) || before.every((value, i) => Math.abs(x[i] - value) <= 1e-8 * size);
  }

  integration(rows) {
    const g = new Float64Array(this.event_count);
    const problem = {
      rhs: (t, x, dx) => this.code.rhs(t, x, this.p, this.input(t), 0, dx),
      project: (t, x) => this.project(t, x),
      events: (t, x, values) => {
        const code = this.code.events(t, x, this.p, this.input(t), 0, g);  // those of kinks follow
        values.forEach((_, i) => { values[i] = g[i]; });
        return code;
      },
      resets: (t, x, r) => this.code.resets(t, x, this.p, this.input(t), 0, r),
      meet: (t, x, set) => this.meet(t, x, set),
      eventKinds: this.events, samples: this.samples, resetCount: this.reset_count, moving: this.layout.first_order};
    return new Integration(problem, this.t0, this.t1, this.x, rows);
  }
}

