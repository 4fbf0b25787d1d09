// Forces of contacts that are inputs of the emitted code (docs/abi.md, "Contacts"), by the rules of
// lib/eom/contacts/contact_forces.hpp and thresholds.hpp. In: the rows of contacts, their modes. Out: the forces with which
// closed contacts stay closed and sticking ones stick; values that count as zero.
//
// The mode of a contact is 0 closed and sticking, 1 and -1 sliding along and against its tangent, 2 open.
const freshState = () => ({mode: 0, sign: 1, direction: [0, 0], starts: false});

class ContactForces {
  // live: code, p, input(t), solved {contacts, values, law, order}, n, layout; tolerances: {rtol, atol}
  constructor(live, tolerances) {
    Object.assign(this, {live, tolerances, law: live.solved.law, order: live.solved.order, contacts: live.solved.contacts, n: live.n, rates: live.layout.rates, failure: ""});
    this.mode = this.contacts.map(freshState);
    this.c = new Float64Array(live.solved.values);
    this.amplitude = this.contacts.map(() => [1, 1, 1]);
    this.hits = this.contacts.map(() => 0);
    this.chatter = new Chatter();
    this.mostRepeated = 1000;
    this.begin();
  }
  begin() {
    const zeros = () => this.contacts.map(() => 0);
    Object.assign(this, {sizes: {speed: 0, gap: zeros(), terms: zeros(), force: zeros()}, largestAcceleration: 0, leastSlip: 0});
  }

  isClosed(j) { return this.mode[j].mode !== 2; }
  isSticking(j) { return this.contacts[j].sticks && this.mode[j].mode === 0; }
  isHeld(j) { return this.contacts[j].gap !== undefined; }
  slips(j) { return this.contacts[j].slip || []; }
  // Whether the friction of a contact follows from its normal force and its slip.
  hasFriction(j) { return this.isClosed(j) && this.slips(j).length > 0 && !this.isSticking(j); }

  // Rows at a state; u without forces of contacts.
  readRows(t, x, u) { return this.live.code.contact_rows(t, x, this.live.p, u, null, this.c) === 0; }
  rate(row) { return this.c[row.first]; }
  change(row, a) { return row.columns.reduce((sum, i, k) => sum + this.c[row.first + 2 + k] * a[i], 0); }
  acceleration(row, a) { return this.c[row.first + 1] + this.change(row, a); }
  terms(row, values, from = 0) { return row.columns.reduce((sum, i, k) => sum + Math.abs(this.c[row.first + 2 + k] * values[from + i]), 0); }
  slipSpeed(j) { return Math.hypot(...this.slips(j).map((row) => this.rate(row))); }
  accelerations(t, x, u) {
    const dx = new Float64Array(x.length);
    if (this.live.code.rhs(t, x, this.live.p, u, null, dx) !== 0) return null;
    const a = dx.slice(this.rates, this.rates + this.n);
    return a.every(Number.isFinite) ? a : null;
  }

  // The direction of slip, times the share of the Coulomb force that its law gives.
  direction(j) {
    const at = this.contacts[j], w = this.slips(j).map((row) => this.rate(row));
    if (at.width !== undefined) {
      const size = Math.hypot(...w, this.c[at.width]);
      return w.map((value) => (size === 0 ? 0 : value / size));
    }
    if (w.length === 1) return [this.mode[j].mode === -1 ? -1 : 1];
    return frictionDirection(w, this.mode[j].direction, this.leastSlip, this.mode[j].starts ? this.startSlip() : this.leastSlip);
  }
  // A unit force: inputs and their shares. The normal one with the friction that follows from it, if `withFriction`.
  normalPattern(j, withFriction) {
    const at = this.contacts[j], inputs = [[at.force_input, 1]];
    if (withFriction && this.hasFriction(j)) {
      const strength = this.c[at.dynamic_coefficient] * this.c[at.normal_scale] * this.mode[j].sign;
      this.direction(j).forEach((d, a) => inputs.push([at.friction_input + a, -strength * d]));
    }
    return {j, component: -1, inputs};
  }
  tangentPattern(j, a) { return {j, component: a, inputs: [[this.contacts[j].friction_input + a, 1]]}; }
  push(u, pattern, amount) { for (const [input, share] of pattern.inputs) u[input] += share * amount; }

  // Accelerations without forces of contacts but for friction with a given normal force, which stays in u.
  readFree(t, x, u) {
    this.contacts.forEach((at, j) => {
      if (this.isHeld(j) || !this.hasFriction(j)) return;
      const force = this.c[at.dynamic_coefficient] * Math.abs(this.c[at.given_normal]);
      this.direction(j).forEach((d, a) => { u[at.friction_input + a] = -force * d; });
    });
    this.free = this.accelerations(t, x, u);
    return this.free !== null;
  }
  // The change of the accelerations for a unit force, from one with an effect of their size; or null.
  response(t, x, u, pattern) {
    const amplitudes = this.amplitude[pattern.j], at = pattern.component + 1, largest = (a) => a.reduce((most, value) => Math.max(most, Math.abs(value)), 0), size = largest(this.free);
    let result = null;
    for (let attempt = 0; attempt < 2; ++attempt) {
      const amplitude = amplitudes[at];
      this.push(u, pattern, amplitude);
      const moved = this.accelerations(t, x, u);
      this.push(u, pattern, -amplitude);
      if (moved === null) return null;
      result = moved.map((value, i) => (value - this.free[i]) / amplitude);
      const effect = largest(result) * amplitude;
      if (size === 0 || effect === 0 || effect > 1e-2 * size && effect < 1e2 * size) break;
      amplitudes[at] *= size / effect;
    }
    return result;
  }

  // Adds the forces of the current modes to u, whose forces of contacts are 0. Returns whether there are any.
  solve(t, x, u) {
    const count = this.contacts.length, patterns = [], rows = [];
    Object.assign(this, {lambda: new Float64Array(count), phi: this.contacts.map(() => [0, 0]), margins: new Float64Array(count).fill(1), forceSize: new Float64Array(count), forcePerAcceleration: new Float64Array(count)});
    this.contacts.forEach((at, j) => { u[at.mode_input] = this.mode[j].mode; });
    if (this.mode.every((state) => state.mode === 2)) return true;
    if (!this.readRows(t, x, u) || !this.readFree(t, x, u)) return false;
    this.contacts.forEach((at, j) => {
      if (!this.isClosed(j)) return;
      if (this.isHeld(j) && !this.isPreventedBySticking(j)) {
        patterns.push(this.normalPattern(j, true));
        rows.push(at.normal);
      }
      if (this.isSticking(j)) this.slips(j).forEach((row, a) => { patterns.push(this.tangentPattern(j, a)); rows.push(row); });
    });
    this.choiceError = 0;
    if (patterns.length > 0) {
      const responses = patterns.map((pattern) => this.response(t, x, u, pattern));
      if (responses.includes(null)) return false;
      const W = rows.map((row) => responses.map((response) => this.change(row, response))), right = rows.map((row) => -this.acceleration(row, this.free));
      patterns.forEach(({j}, k) => {
        const size = this.observeAcceleration(rows[k]), share = Math.abs(W[k][k]);
        if (!(share > 0)) return;
        this.forceSize[j] += size / share;
        this.forcePerAcceleration[j] = Math.max(this.forcePerAcceleration[j], 1 / share);
      });
      const {x: found, rank} = leastNorm(W, right), forces = rank < patterns.length ? this.admissible(patterns, responses, found) : found;
      patterns.forEach((pattern, k) => {
        this.push(u, pattern, forces[k]);
        if (pattern.component >= 0) { this.passToStop(u, pattern, forces[k]); return; }
        this.lambda[pattern.j] = forces[k];
        if (this.hasFriction(pattern.j)) this.margins[pattern.j] = W[k][k];
      });
    }
    this.contacts.forEach((at, j) => this.slips(j).forEach((_, a) => { this.phi[j][a] = u[at.friction_input + a]; }));
    return true;
  }
  // Forces within the limits of the laws, if forces of least norm break them and others do not; see
  // lib/eom/contacts/force_limits.hpp.
  admissible(patterns, responses, found) {
    const limits = this.contacts.map(() => null), largest = Math.max(0, ...this.forceSize);
    patterns.forEach(({j, component}, k) => {
      const at = this.contacts[j], limit = limits[j] = limits[j] || {normal: -1, scale: 1, given: 0, holds: false, coefficient: 0, tangents: [], size: Math.max(this.forceSize[j], 1e-3 * largest)};
      if (component < 0) Object.assign(limit, {normal: k, scale: this.c[at.normal_scale] * (at.unilateral ? 1 : this.mode[j].sign)});
      else {
        if (limit.tangents.length === 0) Object.assign(limit, {holds: true, coefficient: this.c[at.static_coefficient], given: this.isHeld(j) ? 0 : Math.abs(this.c[at.given_normal])});
        limit.tangents.push(k);
      }
    });
    // A contact whose normal force is that of another one (a stop on which friction acts) has no limit of its own.
    const own = limits.filter((limit, j) => limit !== null && limit.size > 0 && !(limit.holds && limit.normal < 0 && this.isHeld(j)));
    if (AdmissibleForces.leastMargin(own, found) >= AdmissibleForces.wantedMargin) return found;
    const chosen = new AdmissibleForces(found, forcesWithoutEffect(responses), own);
    if (chosen.Z.length > 0) this.choiceError = chosen.error() * largest;
    return chosen.find();
  }
  // The sum of the terms of the acceleration of a row. A share of the largest one, of any contact, is rounding.
  observeAcceleration(row) {
    const size = Math.abs(this.c[row.first + 1]) + this.terms(row, this.free);
    if (Number.isFinite(size)) this.largestAcceleration = Math.max(this.largestAcceleration, size);
    return size;
  }
  accelerationRounding() { return 1e-13 * this.largestAcceleration; }
  // s with row = s times the other; 0 if they are not parallel.
  ratio(row, other) {
    const {c} = this, at = (of, k) => c[of.first + 2 + k];
    if (row.columns.length === 0 || row.columns.length !== other.columns.length || row.columns.some((column, k) => column !== other.columns[k])) return 0;
    const largest = row.columns.reduce((best, _, k) => (Math.abs(at(other, k)) > Math.abs(at(other, best)) ? k : best), 0);
    if (at(other, largest) === 0) return 0;
    const s = at(row, largest) / at(other, largest);
    return row.columns.every((_, k) => Math.abs(at(row, k) - s * at(other, k)) <= 1e-12 * Math.abs(at(row, largest))) ? s : 0;
  }
  // Whether friction sticks along the normal of contact j, as of a coordinate on its end stop: their rows are one.
  isPreventedBySticking(j) {
    const at = this.contacts[j];
    if (!at.unilateral || this.hasFriction(j)) return false;
    return this.contacts.some((_, i) => i !== j && this.isSticking(i) && this.slips(i).some((row) => this.ratio(row, at.normal) !== 0));
  }
  // What friction would take of a force that presses on a contact along its direction is the force of that contact.
  passToStop(u, tangent, force) {
    const row = this.slips(tangent.j)[tangent.component];
    for (let j = 0; j < this.contacts.length; ++j) {
      if (j === tangent.j || !this.isClosed(j) || !this.contacts[j].unilateral || this.hasFriction(j)) continue;
      const lambda = force * this.ratio(row, this.contacts[j].normal);
      if (!(lambda > 0)) continue;
      this.push(u, tangent, -force);
      this.push(u, this.normalPattern(j, false), lambda);
      this.lambda[j] = lambda;
      return;
    }
  }
  normalForce(j) {
    const at = this.contacts[j];
    return this.isHeld(j) ? this.c[at.normal_scale] * this.lambda[j] : Math.abs(this.c[at.given_normal]);
  }

  startSlip() { return this.leastSlip * startOfSlip(this.tolerances.rtol); }

  // Values that count as zero, from the largest terms of the run.
  negligible() { return Math.max(1e-15, this.tolerances.atol, Math.max(1e-3 * this.tolerances.rtol, 1e-14) * this.sizes.speed); }
  gapRounding(j, x) { return Math.max(16 * 2 ** -52 * Math.max(this.sizes.terms[j], this.terms(this.contacts[j].normal, x)), knownGap * this.sizes.gap[j]); }
  // Bounces up to this height are none (eom/contacts/thresholds.hpp).
  lowBounce(j, x) { return Math.max(10 * this.gapRounding(j, x), 1e-12 * this.sizes.gap[j]); }
  observeState(x) {
    const {sizes} = this, grow = (value, before) => (Number.isFinite(value) ? Math.max(before, value) : before);
    this.contacts.forEach((at, j) => {
      if (this.isHeld(j)) {
        sizes.speed = grow(this.terms(at.normal, x, this.rates), sizes.speed);
        sizes.terms[j] = grow(this.terms(at.normal, x), sizes.terms[j]);
      }
      for (const row of this.slips(j)) sizes.speed = grow(this.terms(row, x, this.rates), sizes.speed);
      if (at.unilateral && !this.isClosed(j)) sizes.gap[j] = grow(this.c[at.gap], sizes.gap[j]);
    });
  }
}
