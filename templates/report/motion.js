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

  // Coordinates are interpolated by cubic Hermite polynomials, since their rates are in the state.
  state(t) {
    const k = this.row(t), h = this.t[k + 1] - this.t[k], s = h > 0 ? Math.min(1, Math.max(0, (t - this.t[k]) / h)) : 0;
    const a = this.x[k], b = this.x[k + 1], n = this.live.n, x = new Float64Array(a.length);
    const ha = (1 + 2 * s) * (1 - s) ** 2, hb = s * s * (3 - 2 * s), ga = s * (1 - s) ** 2 * h, gb = s * s * (s - 1) * h;
    for (let i = 0; i < n; ++i) {
      x[i] = ha * a[i] + hb * b[i] + ga * a[n + i] + gb * b[n + i];
      x[n + i] = (1 - s) * a[n + i] + s * b[n + i];
    }
    return x;
  }

  at(t) {
    if (this.x) return this.live.outputs(t, this.state(t));
    const k = this.row(t), h = this.t[k + 1] - this.t[k], s = h > 0 ? Math.min(1, Math.max(0, (t - this.t[k]) / h)) : 0;
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

// The current model: values chosen by the user, dependent values, and a start that satisfies the constraints.
class Live {
  constructor(code, description, data) {
    Object.assign(this, description);
    this.code = code;
    this.t0 = data.t0;
    this.t1 = data.t1;
    this.kinds = code.info.constraint_kinds || [];
    this.m = this.constraints;
    this.count = code.info.outputs.length;
    this.reset();
  }

  reset() {
    this.chosen = this.parameters.map((p) => p.value);
    this.starts_chosen = new Map();
    this.placed = null;
    this.prepare();
  }

  prepare() {
    const n = this.n;
    this.p = Float64Array.from(this.chosen);
    this.x = new Float64Array(2 * n);
    this.sizes = new Float64Array(this.size_count);
    const all = new Float64Array(this.p.length);
    this.code.setup(this.t0, this.x, this.p, null, 0, all, this.x, this.sizes);
    this.p = all;
    this.starts_chosen.forEach((value, k) => { this.x[k] = value; });
    if (this.placed) this.x.set(this.placed);
    this.holdStarts();
    const fixed = (k) => this.placed || this.starts_chosen.has(k) || this.given.includes(k);
    this.meetPositions(fixed);
    this.holdStarts();
    this.meetRates(fixed);
  }
  holdStarts() { for (const [i, k] of this.starts) this.p[i] = this.x[k]; }

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
  // The rows of A with fixed coordinates held.
  holding(A, fixed) { return A.map((row) => row.map((a, i) => (fixed(i) ? 0 : a))); }

  // Newton's method for the start, first with the given values held.
  meetPositions(fixed) {
    const place = this.kinds.map((kind, k) => (kind === "holonomic" ? k : -1)).filter((k) => k >= 0);
    if (place.length === 0) return true;
    for (const held of [fixed, () => false]) {
      for (let iteration = 0; iteration < 40; ++iteration) {
        const {psi, A} = this.constraintsAt(this.t0, this.x), r = place.map((k) => -psi[k]);
        if (r.every((value) => Math.abs(value) < 1e-13)) return true;
        const d = smallestCorrection(this.identity(), this.holding(place.map((k) => A[k]), held), r);
        const size = Math.hypot(...d);
        for (let i = 0; i < this.n; ++i) this.x[i] += d[i] * Math.min(1, 1 / size);
        if (size < 1e-14) return true;
      }
    }
    return false;
  }
  meetRates(fixed) {
    const {n, m} = this;
    if (m === 0) return;
    const {A, b} = this.constraintsAt(this.t0, this.x);
    for (const held of [(i) => fixed(n + i), () => false]) {
      const r = A.map((row, k) => -b[k] - row.reduce((sum, a, i) => sum + a * this.x[n + i], 0));
      const d = smallestCorrection(this.identity(), this.holding(A, held), r);
      for (let i = 0; i < n; ++i) this.x[n + i] += d[i];
    }
  }

  // Projection onto the constraints after a step, by the smallest change in the mass norm.
  project(t, x) {
    const {n, m} = this;
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
    const r = A.map((row, k) => -b[k] - row.reduce((sum, a, i) => sum + a * x[n + i], 0));
    const d = smallestCorrection(M, A, r);
    for (let i = 0; i < n; ++i) x[n + i] += d[i];
    return true;
  }

  integration(rows) {
    const problem = {
      rhs: (t, x, dx) => this.code.rhs(t, x, this.p, this.input(t), 0, dx),
      project: (t, x) => this.project(t, x),
      events: (t, x, g) => { const all = new Float64Array(this.event_count); this.code.events(t, x, this.p, this.input(t), 0, all); g.forEach((_, i) => { g[i] = all[i]; }); },
      eventKinds: this.events};
    return new Integration(problem, this.t0, this.t1, this.x, rows);
  }
}

