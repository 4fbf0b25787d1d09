// Contacts whose forces are inputs of the emitted code, during a run in the page: by the rules of
// lib/eom/hybrid/solved_contacts.hpp. In: the state of a run. Out: bounds of the modes, which are positive inside; at their
// zeros the velocities after impacts and the next modes; rows of the projection.
class SolvedContacts extends ContactTransitions {
  bounds() {
    return this.contacts.flatMap((at, j) => {
      const result = this.isHeld(j) ? [{j, k: 0}] : [];
      if (this.isClosed(j) && this.slips(j).length > 0 && at.sticks) result.push({j, k: 1});
      if (this.hasFriction(j) && this.isHeld(j)) result.push({j, k: 2});
      return result;
    });
  }
  // A force at its limit where a mode begins: the problem that chose the mode has decided. Admissible forces are known to
  // the last weight of their barriers, 1e-9.
  nearOf(j, k) { return k === 0 && this.isClosed(j) || k === 1 && this.isSticking(j) ? 1e-8 * this.sizes.force[j] : 0; }
  observe() {}
  values(t, x, bounds) {
    const u = this.live.input(t);
    if (!this.solve(t, x, u) || this.mode.every((state) => state.mode === 2) && !this.readRows(t, x, u)) return bounds.map(() => NaN);
    this.observeState(x);
    const forces = this.contacts.map((_, j) => {
      this.sizes.force[j] = Math.max(this.sizes.force[j], this.forceSize[j] || 0);
      return Math.max(1e-11 * this.sizes.force[j], this.accelerationRounding() * (this.forcePerAcceleration[j] || 0), this.choiceError || 0);
    });
    return bounds.map(({j, k}) => {
      const at = this.contacts[j], state = this.mode[j];
      if (k === 2) return this.margins[j];
      if (k === 0 && this.isClosed(j)) return (at.unilateral ? 1 : state.sign) * this.lambda[j] + forces[j];
      if (k === 0) {
        const rounding = this.gapRounding(j, x), gap = this.c[at.gap] + rounding;
        return gap <= 0 && this.rate(at.normal) > 0 ? rounding : gap;
      }
      if (state.mode === 0) return this.c[at.static_coefficient] * Math.abs(this.normalForce(j)) - Math.hypot(...this.phi[j]) + forces[j];
      if (this.slips(j).length === 1) return state.mode * this.rate(this.slips(j)[0]) + 1e-14 * this.sizes.speed;
      return state.starts ? 1 : this.slipSpeed(j) - this.leastSlip;
    });
  }

  // Rows of the projection: gaps of closed contacts, zero slip of sticking ones.
  closedRows(t, x) {
    const gaps = [], slips = [], dense = (row) => {
      const A = new Float64Array(this.n);
      row.columns.forEach((i, k) => { A[i] = this.c[row.first + 2 + k]; });
      return {A, b: this.rate(row) - this.change(row, x.subarray(this.rates))};
    };
    if (!this.readRows(t, x, this.live.input(t))) return {gaps, slips};
    this.contacts.forEach((at, j) => {
      if (this.isHeld(j) && this.isClosed(j)) gaps.push({...dense(at.normal), psi: this.c[at.gap]});
      if (this.isSticking(j)) for (const row of this.slips(j)) slips.push(dense(row));
    });
    return {gaps, slips};
  }

  slipRows(t, x) { return this.closedRows(t, x).slips; }

  // Called at each step: the slip in two directions whose direction is known. Returns whether a start of slip ended.
  update(t, x) {
    this.leastSlip = this.negligible();
    const {rtol, atol} = this.tolerances;
    this.contacts.forEach((_, j) => {
      if (this.slips(j).length !== 2) return;
      for (const row of this.slips(j)) this.leastSlip = Math.max(this.leastSlip, 30 * row.columns.reduce((sum, i, k) => sum + Math.abs(this.c[row.first + 2 + k]) * (atol + rtol * Math.abs(x[this.rates + i])), 0));
    });
    let ended = false;
    this.mode.forEach((state, j) => {
      if (!state.starts || !hasStarted(this.slips(j).map((row) => this.rate(row)), state.direction, this.leastSlip, this.startSlip())) return;
      state.starts = false;
      ended = true;
    });
    return ended;
  }

  // The modes at a start, where contacts with open[j] are open. Returns the names of contacts that change at once.
  start(t, x, open) {
    const before = this.contacts.map((at, j) => ({...freshState(), mode: at.unilateral && open[j] ? 2 : 0}));
    this.mode = before;
    const touching = this.contacts.flatMap((_, j) => (this.isHeld(j) && this.isClosed(j) ? [j] : []));
    let slides = this.contacts.map(() => false);
    if (this.readRows(t, x, this.live.input(t))) {
      this.observeState(x);
      slides = this.contacts.map((_, j) => this.slipSpeed(j) > this.negligible());
    }
    const changes = this.meet(t, x, touching, this.contacts.map(() => false), false, {});
    this.update(t, x);
    return changes.filter(({j, kind}) => !(kind === "slip" && slides[j])).map(({j}) => this.contacts[j].name);
  }
  restart(t, x) { this.start(t, x, this.mode.map((state) => state.mode === 2)); }

  // The transition at a zero of a bound; see ContactModes.
  cross(t, x, {j, k}) {
    const at = this.contacts[j], closed = this.isClosed(j), sticks = this.isSticking(j), failed = {t, names: [], resumes: false};
    if (k === 2) {
      this.failure = "the friction of \u201c" + at.name + "\u201d has no solution, or several";
      return failed;
    }
    if (k === 0 && !at.unilateral) {
      this.mode = this.mode.map((state, i) => (i === j ? {...state, sign: -state.sign} : state));
      return failed;
    }
    const u = this.live.input(t);
    this.solve(t, x, u);
    const hint = {j, parts: k === 0 && closed, slips: k === 1 && sticks, stops: k === 1 && !sticks, friction: this.phi[j]}, plastic = this.contacts.map(() => false);
    const touching = this.contacts.flatMap((_, i) => (this.isHeld(i) && (this.isClosed(i) || i === j) ? [i] : []));
    let rest = false;
    if (k === 0 && !closed) {
      this.addTouching(t, x, touching);
      if (this.chatter.add(t)) this.endBounces(j, touching, plastic);
      rest = this.stopLowBounces(t, x, touching, plastic);
    }
    const changes = this.meet(t, x, touching, plastic, rest, hint, hint.slips || hint.parts ? this.laterState(t, x, {j, k}) : null);
    this.update(t, x);
    return {t, names: changes.map(({j: i}) => this.contacts[i].name), resumes: false};
  }
  // A state after (t, x), at which a bound has crossed 0, where it is negative by more than rounding; or null.
  laterState(t, x, {j, k}) {
    const at = this.contacts[j], now = this.live.input(t), a = this.solve(t, x, now) ? this.accelerations(t, x, now) : null, length = Math.abs(this.live.t1 - this.live.t0);
    if (a === null) return null;
    for (let after = 1e-10 * length; after < 1e-3 * length; after *= 10) {
      const later = {t: t + after, x: Float64Array.from(x)};
      for (let i = 0; i < this.n; ++i) {
        later.x[i] += after * x[this.rates + i];
        later.x[this.rates + i] += after * a[i];
      }
      if (!this.solve(later.t, later.x, this.live.input(later.t))) return null;
      const value = k === 1 ? this.c[at.static_coefficient] * Math.abs(this.normalForce(j)) - Math.hypot(...this.phi[j]) : (at.unilateral ? 1 : this.mode[j].sign) * this.lambda[j], beyond = -value / this.forceSize[j];
      if (beyond > 1e-3) return null;
      if (beyond > 1e-9) return later;
    }
    return null;
  }
  addTouching(t, x, touching) {
    if (!this.readRows(t, x, this.live.input(t))) return;
    this.contacts.forEach((at, i) => {
      if (at.unilateral && !this.isClosed(i) && !touching.includes(i) && this.c[at.gap] <= this.gapRounding(i, x) && this.rate(at.normal) < this.negligible()) touching.push(i);
    });
  }
  // The end of ever smaller bounces: lasting contact of all contacts that took turns.
  endBounces(j, touching, plastic) {
    this.chatter = new Chatter();
    plastic[j] = true;
    this.contacts.forEach((at, i) => {
      if (i === j || !at.unilateral || this.isClosed(i) || this.hits[i] < 3 || this.c[at.gap] > 1e-8 * this.sizes.gap[i]) return;
      plastic[i] = true;
      if (!touching.includes(i)) touching.push(i);
    });
  }
  // A bounce lower than the rounding of the gap is none. Returns whether all motion of contacts that meet is lower; they
  // come to rest together then.
  stopLowBounces(t, x, touching, plastic) {
    const u = this.live.input(t);
    if (!this.solve(t, x, u) || !this.readRows(t, x, u)) return false;
    const a = this.accelerations(t, x, u);
    let meets = false, rest = true;
    if (a === null) return false;
    for (const i of touching) {
      const at = this.contacts[i];
      if (!at.unilateral || !(this.rate(at.normal) < -this.negligible())) continue;
      const speed = -this.rate(at.normal), away = speed * this.c[at.restitution], back = -this.acceleration(at.normal, a), known = this.lowBounce(i, x);
      if (away > 0 && back > 0 && away * away / (2 * back) <= known || away <= this.negligible()) plastic[i] = true;
      meets = true;
      rest = rest && back > 0 && speed * speed / (2 * back) <= known;
    }
    if (!meets || !rest) return false;
    this.contacts.forEach((at, i) => { if (at.unilateral && !touching.includes(i) && this.c[at.gap] <= this.lowBounce(i, x)) touching.push(i); });
    return true;
  }
}
