// Changes of contacts at an instant, by the rules of lib/eom/contacts/transitions.hpp. In: a state at which contacts meet,
// part, slip or stop. Out: impulses with the velocities after them, then the modes of all contacts from one
// complementarity problem on accelerations.

// Stronge's energetic law (lib/eom/contacts/stronge.hpp): the normal and the tangential impulse of a contact, or null if it
// never separates. A unit impulse along the normal changes the velocities (normal, tangential) by (nn, nt), one along the
// tangent by (nt, tt).
function collision({normal, tangential = 0, nn, nt = 0, tt = 0, friction = 0, restitution}) {
  const total = [0, 0], forWork = (v, a, work) => {
    const square = v * v + 2 * a * work, sum = v + Math.sqrt(square);
    return sum > 0 ? 2 * work / sum : square < 0 || work > 0 ? Infinity : 0;
  };
  let isCompressing = true, compression = 0, given = 0;  // work of the normal impulse
  for (let phase = 0; phase < 8; ++phase) {  // slip, rest or reversed slip, in compression and in restitution
    const hasFriction = tt > 0 && friction > 0, holding = hasFriction ? -nt / tt : 0;
    const share = !hasFriction ? 0 : tangential === 0 ? Math.min(friction, Math.max(-friction, holding)) : tangential > 0 ? -friction : friction;
    const sticks = hasFriction && tangential === 0 && share === holding, a = nn + share * nt, b = sticks ? 0 : nt + share * tt;
    let end = forWork(normal, a, Math.max(0, -restitution * restitution * compression - given));
    if (isCompressing) end = a > 0 ? -normal / a : Infinity;
    const stop = tangential * b < 0 && share !== 0 ? -tangential / b : Infinity, step = Math.min(end, stop);
    if (!Number.isFinite(step)) return null;
    const work = normal * step + a * step * step / 2;
    if (isCompressing) compression += work;
    else given += work;
    total[0] += step;
    total[1] += share * step;
    normal += a * step;
    tangential = stop <= end ? 0 : tangential + b * step;
    if (end > stop) continue;
    if (!isCompressing) return total;
    isCompressing = false;
    normal = 0;
  }
  return null;
}

class ContactTransitions extends ContactForces {
  // Impulses of contacts that approach, then new modes. Returns the changes [{j, kind}], or sets `failure`.
  meet(t, x, touching, plastic, rest, hint, later = null) {
    const before = this.mode, hit = [], u = this.live.input(t);
    this.mode = before.map((state) => ({...state}));
    const approaches = () => touching.some((j) => this.contacts[j].unilateral && this.rate(this.contacts[j].normal) < -this.negligible());
    let fault = null;  // a contact, or none
    if (this.readRows(t, x, u) && approaches()) fault = this.impact(t, x, u, touching, plastic, rest, hit);
    if (fault === null) fault = this.decide(t, x, this.live.input(t), touching, hint, later);
    if (fault !== null) this.failure = fault < 0 ? "the forces of contacts have no value" : "the contact \u201c" + this.contacts[fault].name + "\u201d has no force or impulse that fits its law";
    const changes = hit.map((j) => ({j, kind: "contact"}));
    for (const j of hit) ++this.hits[j];
    this.mode.forEach(({mode: to}, j) => {
      const from = before[j].mode, wasHit = hit.includes(j);
      if (from === 2 && to !== 2 && !wasHit) changes.push({j, kind: "contact"});
      if (from !== 2 && to === 2 && !wasHit) changes.push({j, kind: "lose_contact"});
      if (from !== 2 && to !== 2 && this.contacts[j].sticks && from !== to) changes.push({j, kind: to === 0 ? "stick" : from === 0 ? "slip" : "reverse"});
    });
    return changes;
  }

  // The velocity of a row at changed rates: rows were read before, at the rates `read`.
  speed(row, x) { return this.rate(row) + row.columns.reduce((sum, i, k) => sum + this.c[row.first + 2 + k] * (x[this.rates + i] - this.read[i]), 0); }

  // Returns null, or the contact without an impulse, -1 for a function without value.
  impact(t, x, u, touching, plastic, rest, hit) {
    if (!this.readFree(t, x, u)) return -1;
    this.read = x.slice(this.rates, this.rates + this.n);
    if (rest) {  // first what the law does, then the speeds that are left of it
      const all = plastic.map(() => true), fault = this.apply(t, x, u, touching, all, false, hit);
      return fault !== null ? fault : this.apply(t, x, u, touching, all, true, hit);
    }
    const isEnergetic = this.law === "stronge";  // of one contact at a time
    if (this.order === "simultaneous" && !isEnergetic) return this.apply(t, x, u, touching, plastic, false, hit);
    for (let count = 0; count < 10000; ++count) {
      let fastest = -1, least = -this.negligible();
      for (const j of touching) {
        const speed = this.contacts[j].unilateral ? this.speed(this.contacts[j].normal, x) : 0;
        if (speed < least) [fastest, least] = [j, speed];
      }
      if (fastest < 0) return null;
      const fault = isEnergetic ? this.collide(t, x, u, fastest, plastic[fastest], hit) : this.apply(t, x, u, [fastest], plastic, false, hit);
      if (fault !== null) return fault;
    }
    return touching[0];
  }

  // A problem of rows {row, j, kind, response} and laws; rows are added by `normal` and `friction`.
  problem(t, x, u) {
    const rows = [], laws = [];
    const add = (j, row, pattern, kind) => rows.push({row, j, kind, response: this.response(t, x, u, pattern)}) - 1;
    const friction = (j, normal, coefficient) => {
      const at = this.contacts[j], law = {j, normal, coefficient: this.c[coefficient], sign: 1, given: 0};
      if (normal < 0) law.given = this.c[at.given_normal];
      else law.sign = this.mode[j].sign * this.c[at.normal_scale];
      law.tangents = this.slips(j).map((row, a) => add(j, row, this.tangentPattern(j, a), "friction"));
      laws.push(law);
    };
    const solved = (q) => new FrictionProblem(rows.map(({row}) => rows.map(({response}) => this.change(row, response))), q, rows.map(({kind}) => kind), laws);
    return {rows, laws, add, friction, solved};
  }

  apply(t, x, u, acting, plastic, rest, hit) {
    const {rows, add, friction, solved} = this.problem(t, x, u), least = this.negligible();
    this.contacts.forEach((at, j) => {
      if (at.unilateral ? !acting.includes(j) : !this.isHeld(j)) return;
      const normal = add(j, at.normal, this.normalPattern(j, false), at.unilateral && !rest ? "unilateral" : "bilateral");
      if (this.law !== "newton" && at.sticks && !rest) friction(j, normal, at.dynamic_coefficient);
    });
    if (rows.some(({response}) => response === null)) return -1;
    const approach = rows.map(({row}) => this.speed(row, x));
    const restitution = rows.map(({kind, j}, i) => (kind === "unilateral" && !plastic[j] && approach[i] < -least ? this.c[this.contacts[j].restitution] : 0));
    const poisson = this.law === "poisson", problem = solved(approach.map((speed, i) => speed * (poisson ? 1 : 1 + restitution[i])));
    const impulses = problem.solve(), slowest = () => rows[approach.indexOf(Math.min(...approach))].j;
    if (impulses === null) return slowest();
    let total = impulses.force;
    if (poisson) {  // restitution gives back a share of the impulses of compression; what comes to it may be more
      const share = total.map((value, i) => restitution[i] * Math.max(0, value)), after = total.map((value, i) => value + share[i]);
      for (const law of problem.laws) if (law.normal >= 0) law.given = law.sign * share[law.normal];
      const more = solved(problem.G.map((row, i) => row.reduce((sum, g, k) => sum + g * after[k], problem.q[i]))).solve();
      if (more === null) return slowest();
      total = after.map((value, i) => value + more.force[i]);
    }
    rows.forEach(({response}, k) => response.forEach((value, i) => { x[this.rates + i] += total[k] * value; }));
    rows.forEach(({kind, j}, i) => {
      if (kind !== "friction" && this.contacts[j].unilateral && approach[i] < -least && total[i] > 0 && !hit.includes(j)) hit.push(j);
    });
    return null;
  }

  // The impact of contact j by Stronge's law. Contacts that cannot open hold, without friction.
  collide(t, x, u, j, isPlastic, hit) {
    const at = this.contacts[j], {rows, add, friction} = this.problem(t, x, u);
    add(j, at.normal, this.normalPattern(j, false), "unilateral");
    if (at.sticks) friction(j, 0, at.dynamic_coefficient);
    const own = rows.length;
    this.contacts.forEach((other, i) => { if (!other.unilateral && this.isHeld(i)) add(i, other.normal, this.normalPattern(i, false), "bilateral"); });
    if (rows.some(({response}) => response === null)) return -1;
    const G = rows.map(({row}) => rows.map(({response}) => this.change(row, response))), held = rows.map((_, i) => i).slice(own), ours = rows.map((_, i) => i).slice(0, own);
    // Impulses of the held rows for unit impulses of this contact.
    const reactions = ours.map((k) => (held.length > 0 ? leastNorm(held.map((i) => held.map((l) => G[i][l])), held.map((i) => -G[i][k])).x : []));
    const response = ours.map((i) => ours.map((k) => held.reduce((sum, l, a) => sum + G[i][l] * reactions[k][a], G[i][k])));
    const found = collision({normal: this.speed(rows[0].row, x), nn: response[0][0], restitution: isPlastic ? 0 : this.c[at.restitution],
                             ...(own > 1 ? {tangential: this.speed(rows[1].row, x), nt: response[0][1], tt: response[1][1], friction: this.c[at.dynamic_coefficient] * this.c[at.normal_scale]} : {})});
    if (found === null) return j;
    const impulses = [...ours.map((k) => found[k]), ...held.map((_, a) => ours.reduce((sum, k) => sum + reactions[k][a] * found[k], 0))];
    rows.forEach(({response: change}, k) => change.forEach((value, i) => { x[this.rates + i] += impulses[k] * value; }));
    if (!hit.includes(j)) hit.push(j);
    return null;
  }

  // The modes of contacts whose gap speeds are not negative. Only those in `touching` can be closed. `later`: the state of
  // which the forces decide; null: (t, x), with a small acceleration towards the change.
  decide(t, x, u, touching, hint, later) {
    if (!this.readRows(t, x, u)) return -1;
    const least = this.negligible();
    let ends = false;  // a slip in two directions
    this.contacts.forEach((at, j) => {
      const state = this.mode[j], slid = state.mode === 1 || state.mode === -1;
      if (at.unilateral && (!touching.includes(j) || this.rate(at.normal) > least)) {
        state.mode = 2;
        return;
      }
      Object.assign(state, {mode: 0, starts: false});
      if (!at.sticks || hint.stops && hint.j === j) return;
      // Points of one body that slides or turns to rest stop together, though their slips differ.
      const slowest = Math.max(least, this.leastSlip), stop = hint.stops || hint.slips;
      const moves = this.slipSpeed(j) > (this.slips(j).length < 2 ? least : stop ? 10 * Math.max(slowest, this.tolerances.rtol * this.sizes.speed) : slowest);
      if (moves) state.mode = this.slips(j).length === 1 && this.rate(this.slips(j)[0]) < 0 ? -1 : 1;
      ends ||= slid && !moves && this.slips(j).length === 2;
    });
    // Friction that reaches its limit as another slip ends is that of the end: all may stick together.
    if (hint.slips && ends) [hint, later] = [{}, null];
    if (later !== null) {
      ({t, x} = later);
      if (!this.readRows(t, x, this.live.input(t))) return -1;
    }
    const broken = this.contacts.map((_, j) => Boolean(hint.slips) && hint.j === j);
    for (let round = 0; round <= this.contacts.length; ++round) {
      const {fault, again} = this.settle(t, x, this.live.input(t), hint, broken, later === null);
      if (fault !== null || !again) return fault;
    }
    return null;
  }

  // One complementarity problem on accelerations. `again`: a contact begins to slide, whose coefficient changes.
  settle(t, x, u, hint, broken, favours) {
    const result = {fault: null, again: false};
    if (!this.readFree(t, x, u)) return {fault: -1, again: false};
    this.contacts.forEach((at, j) => { if (this.isHeld(j)) this.observeAcceleration(at.normal); });
    const {rows, laws, add, friction, solved} = this.problem(t, x, u);
    this.contacts.forEach((at, j) => {
      if (!this.isClosed(j)) return;
      const normal = this.isHeld(j) ? add(j, at.normal, this.normalPattern(j, true), at.unilateral ? "unilateral" : "bilateral") : -1;
      if (this.isSticking(j)) friction(j, normal, broken[j] ? at.dynamic_coefficient : at.static_coefficient);
    });
    if (rows.length === 0) return result;
    if (rows.some(({response}) => response === null)) return {fault: -1, again: false};
    const size = Math.max(...rows.map(({row}) => Math.abs(this.c[row.first + 1]) + this.terms(row, this.free)));
    const q = rows.map(({row}) => this.acceleration(row, this.free)), announced = 1e-9 * size;
    // A small acceleration towards the change that the crossing announces: at the crossing both modes obey the law.
    let tangent = 0;
    rows.forEach(({kind, j}, i) => {
      if (j !== hint.j || !favours) return;
      const length = Math.hypot(...(hint.friction || []));
      if (kind !== "friction") q[i] += hint.parts ? announced : 0;
      else if (hint.slips && length > 0) q[i] -= announced * hint.friction[tangent++] / length;
    });
    const problem = solved(q), found = problem.solve();
    if (found === null) return {fault: rows[q.indexOf(Math.min(...q))].j, again: false};
    // Forces of dependent rows are known to 1e-13, times their differences, and all forces to the residual.
    const unknown = found.residual * Math.max(0, ...found.force.map(Math.abs)), least = Math.max(1e-12 * size, this.accelerationRounding());
    const opens = (i) => found.velocity[i] > Math.max(1e-10 * size, this.accelerationRounding(), 10 * unknown * problem.G[i][i]), slides = (l) => this.isClosed(laws[l].j) && found.speed[l] > least;
    rows.forEach(({kind, j}, i) => {
      const separates = !(found.force[i] > 0) || found.velocity[i] > problem.G[i][i] * found.force[i];
      if (kind === "unilateral" && separates && (opens(i) || hint.parts && hint.j === j)) this.mode[j].mode = 2;
      if (kind === "bilateral" && found.force[i] !== 0) this.mode[j].sign = found.force[i] < 0 ? -1 : 1;
    });
    laws.forEach(({j}, l) => {
      const at = this.contacts[j];
      if (slides(l) && !broken[j] && this.c[at.static_coefficient] !== this.c[at.dynamic_coefficient]) broken[j] = result.again = true;
    });
    if (result.again) {  // nothing is final
      for (const {j} of rows) if (this.mode[j].mode === 2) this.mode[j].mode = 0;
      return result;
    }
    laws.forEach(({j, tangents}, l) => {
      if (!slides(l)) return;
      const along = tangents.map((row) => found.velocity[row]);
      Object.assign(this.mode[j], {mode: along.length === 1 && along[0] < 0 ? -1 : 1, starts: along.length === 2, direction: along.map((value) => value / found.speed[l])});
    });
    return result;
  }
}
