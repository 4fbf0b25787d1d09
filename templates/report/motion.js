// A motion: rows of the original run, or of a run in the page. `at(t)` returns the values for drawings and plots.
class Motion {
  // modes: of the contacts, from each row on.
  constructor(t, x, y, live, events, modes) { Object.assign(this, {t, x, y, live, events, modes}); }

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
    const {k, s} = this.between(t);
    if (!this.y) return this.live.outputs(t, this.state(t), this.modes[s < 1 ? k : k + 1]);
    return this.y[k].map((value, i) => (1 - s) * value + s * this.y[k + 1][i]);
  }

  atRow(k) { return this.y ? this.y[k] : this.live.outputs(this.t[k], this.x[k], this.modes[k]); }

  // All rows for the drawing, computed once.
  drawn() {
    if (!this.all) this.all = this.t.map((_, k) => Array.from(this.atRow(k)));
    return this.all;
  }
  curve(of) { return of.state ? this.x.map((x) => x[of.at]) : this.drawn().map((y) => y[of.at]); }
}

const onSurface = 1e-9;  // gaps up to this value are closed at a start that was placed by hand

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
    if (this.solved) Object.assign(this.solved, {contacts: code.info.contacts});
    this.forces = this.solved ? new SolvedContacts(this, {rtol: 1e-8, atol: 1e-10}) : null;  // for outputs and rows
    const all = this.solved ? this.solved.contacts : this.contacts;
    this.contactCount = all.length;
    this.contactOf = {};  // contacts that can open, by the index of their constraint
    this.contacts.forEach((contact, j) => { if (contact.unilateral) this.contactOf[contact.constraint] = j; });
    this.allOpen = this.solved ? all.map((contact) => ({...freshState(), mode: contact.unilateral ? 2 : 0}))
      : all.length > 0 ? Int32Array.from({length: this.mode_size}, (_, j) => (j < all.length && all[j].unilateral ? 3 : 0)) : null;
    this.open = [];  // contacts that are open at the start
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
    if (this.allOpen) this.open = Array.from(this.modeAt(this.t0, this.x, onSurface)).slice(0, this.contactCount).map((entry) => (this.solved ? entry.mode === 2 : entry === 3));
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
    const open = this.allOpen ? new Int32Array(this.mode_size) : null, code = this.code.start(given, t, x, p, open);
    if (code !== 0) return refusals[code];
    if (!(t[1] > t[0])) return "the run would end at t = " + t[1].toPrecision(4) + " s, before its start at t = " + t[0].toPrecision(4) + " s";
    if (open) this.open = Array.from(open.subarray(0, this.contactCount), (entry) => entry === 3);
    Object.assign(this, {x, p, t0: t[0], t1: t[1], sizes: new Float64Array(this.size_count)});
    const periods = new Float64Array(2 * this.samples.length);
    this.code.setup(this.t0, x, p, null, 0, this.sizes, periods);
    this.samples.forEach((sample, i) => Object.assign(sample, {every: periods[2 * i], offset: periods[2 * i + 1]}));
    return "";
  }

  // Inputs of the scene; those that are forces of contacts are 0, or fit these modes at a state.
  input(t) {
    const count = (this.code.info.inputs || []).length;
    if (count === 0) return null;
    const u = new Float64Array(count);
    if (this.inputs > 0) this.code.signals(t, this.x, this.p, null, 0, u);
    return u;
  }
  inputWith(t, x, forces) {
    const u = this.input(t);
    return !forces || forces.solve(t, x, u) ? u : u.fill(NaN);
  }
  // mode: of contacts that can open, all open without it.
  outputs(t, x, mode = this.allOpen) {
    const y = new Float64Array(this.count);
    if (this.solved) this.forces.mode = mode;
    this.code.outputs(t, x, this.p, this.inputWith(t, x, this.forces), this.solved ? null : mode, y);
    return y;
  }

  // psi, A, b of the constraints with multipliers, A by rows, the index of each and whether it constrains places; with a
  // mode, without open contacts.
  constraintsAt(t, x, mode) {
    const {n, m} = this, psi = new Float64Array(m), flat = new Float64Array(m * n), b = new Float64Array(m), A = [];
    if (m > 0) this.code.constraints(t, x, this.p, psi, flat, b);
    for (let k = 0; k < m; ++k) A.push(Float64Array.from({length: n}, (_, j) => flat[k + m * j]));
    const index = A.map((_, k) => k).filter((k) => !mode || !(k in this.contactOf) || mode[this.contactOf[k]] < 3);
    const rows = index.map((k) => ({psi: psi[k], A: A[k], b: b[k], isPlace: this.kinds[k] === "holonomic"}));
    if (this.solved && mode) {
      this.forces.mode = mode;
      rows.push(...this.forces.closedRows(t, x).gaps.map((row) => ({...row, isPlace: true})));
    }
    return {psi: rows.map((row) => row.psi), A: rows.map((row) => row.A), b: rows.map((row) => row.b), isPlace: rows.map((row) => row.isPlace), index};
  }
  // The contacts that can open are open at this place, or closed, if it is on their surface or behind it.
  modeAt(t, x, near = 0) {
    if (!this.allOpen) return null;
    if (this.solved) {
      this.forces.readRows(t, x, this.input(t));
      return this.solved.contacts.map((contact) => ({...freshState(), mode: contact.unilateral && this.forces.c[contact.gap] > near ? 2 : 0}));
    }
    const {psi} = this.constraintsAt(t, x), mode = Int32Array.from(this.allOpen);
    for (const k in this.contactOf) if (psi[k] <= near) mode[this.contactOf[k]] = 0;
    return mode;
  }
  massAt(t, x) {
    const {n} = this, M = new Float64Array(n * n), h = new Float64Array(n);
    if (this.code.mass(t, x, this.p, M, h) !== 0) return this.identity();
    return Array.from({length: n}, (_, i) => Float64Array.from({length: n}, (_, j) => M[i + n * j]));
  }
  identity() { return Array.from({length: this.n}, (_, i) => Float64Array.from({length: this.n}, (_, j) => (i === j ? 1 : 0))); }
  // Newton's method by the smallest changes; returns whether the constraints are met.
  meetPositions() {
    const at = () => {
      const {psi, A, isPlace} = this.constraintsAt(this.t0, this.x, this.modeAt(this.t0, this.x)), of = (_, i) => isPlace[i];
      return {psi: psi.filter(of), A: A.filter(of)};
    };
    const met = ({psi, A}, digits) => psi.every((value, k) => Math.abs(value) <= digits * A[k].reduce((sum, a, i) => sum + Math.abs(a) * (1 + Math.abs(this.x[i])), 0));
    for (let iteration = 0; iteration < 40; ++iteration) {
      const here = at();
      if (met(here, 1e-14)) break;
      const d = smallestCorrection(this.identity(), here.A, here.psi.map((value) => -value)), size = Math.hypot(...d);
      for (let i = 0; i < this.n; ++i) this.x[i] += d[i] * Math.min(1, 1 / size);
      if (size < 1e-14) break;
    }
    return met(at(), 1e-10);
  }
  meetRates() {
    const {n} = this, {rates} = this.layout;
    const {A, b} = this.constraintsAt(this.t0, this.x, this.modeAt(this.t0, this.x, onSurface));
    const d = smallestCorrection(this.identity(), A, A.map((row, k) => -b[k] - row.reduce((sum, a, i) => sum + a * this.x[rates + i], 0)));
    for (let i = 0; i < n; ++i) this.x[rates + i] += d[i];
  }

  // Projection onto the constraints after a step, by the smallest change in the mass norm. With contacts also onto the
  // surfaces of closed ones and zero slip of sticking ones.
  project(t, x, contacts) {
    const {n} = this, {rates} = this.layout, mode = contacts ? contacts.mode : null, slips = contacts ? contacts.slipRows(t, x, mode) : [];
    let {psi, A, b, isPlace} = this.constraintsAt(t, x, mode);
    if (A.length + slips.length === 0) return false;
    const M = this.massAt(t, x), of = (_, i) => isPlace[i], right = psi.filter(of).map((value) => -value);
    if (right.some((value) => Math.abs(value) > 1e-13)) {
      const d = smallestCorrection(M, A.filter(of), right);
      for (let i = 0; i < n; ++i) x[i] += d[i];
      ({psi, A, b} = this.constraintsAt(t, x, mode));
    }
    const rows = [...A.map((row, k) => ({A: row, b: b[k]})), ...slips];
    const r = rows.map((row) => -row.b - row.A.reduce((sum, a, i) => sum + a * x[rates + i], 0));
    const d = smallestCorrection(M, rows.map((row) => row.A), r);
    for (let i = 0; i < n; ++i) x[rates + i] += d[i];
    return true;
  }

  // After a reset: adds the impulses of the constraints to the new velocities. Returns whether new coordinates satisfy
  // the constraints.
  meet(t, x, set, contacts) {
    const before = x.slice(0, this.n), size = Math.max(1, ...Array.from(before, Math.abs));
    this.project(t, x, contacts);
    return !set.some(([place]) => place < this.n) || before.every((value, i) => Math.abs(x[i] - value) <= 1e-8 * size);
  }

  integration(rows) {
    const g = new Float64Array(this.event_count);
    let contacts = null;
    const solved = () => (this.solved ? contacts : null), mode = () => (contacts && !this.solved ? contacts.mode : null), call = (name, t, x, result) => this.code[name](t, x, this.p, this.inputWith(t, x, solved()), mode(), result);
    const problem = {
      rhs: (t, x, dx) => {
        const at = contacts && !this.solved ? contacts.lead(t, x) : x, code = call("rhs", t, at, dx);
        if (at !== x) dx.set(x.subarray(this.layout.rates, this.layout.rates + this.n));  // rates are those of x
        return code;
      },
      project: (t, x) => this.project(t, x, contacts),
      contacts: (tolerances) => {
        contacts = this.solved ? new SolvedContacts(this, tolerances) : this.allOpen ? new ContactModes(this, tolerances) : null;
        return contacts;
      },
      open: this.open,
      events: (t, x, values) => {
        const code = call("events", t, x, g);  // those of kinks and contacts follow
        values.forEach((_, i) => { values[i] = g[i]; });
        return code;
      },
      resets: (t, x, r) => call("resets", t, x, r),
      meet: (t, x, set) => this.meet(t, x, set, contacts),
      eventKinds: this.events, samples: this.samples, resetCount: this.reset_count, moving: this.layout.first_order};
    return new Integration(problem, this.t0, this.t1, this.x, rows);
  }
}

