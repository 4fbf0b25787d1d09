// Dormand and Prince's pair of orders 5 and 4 with its dense output of order 4 (Hairer, Norsett, Wanner: Solving
// ordinary differential equations I, II.5 and II.6). The error estimate controls the step size; the state may be
// projected after each step; sign changes of event functions are located on the dense output.
const pair = {
  c: [0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1, 1],
  a: [[], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9], [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
      [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656], [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]],
  e: [71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40],
  d: [-12715105075 / 11282082432, 0, 87487479700 / 32700410799, -10690763975 / 1880347072, 701980252875 / 199316789632, -1453857185 / 822651844,
      69997945 / 29380423]};

class Integration {
  // problem: rhs(t, x, dx) -> code, project(t, x) -> whether x was changed, events(t, x, g), eventKinds: [{name, stop,
  // direction}]
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
    this.g = problem.eventKinds.map(() => 0);
    this.found = [];
    this.times = [];
    this.states = [];
    this.spacing = (t1 - t0) / rows;
    this.rows = rows;
    this.keep(t0, this.x);
    if (problem.rhs(t0, this.x, this.k[0]) !== 0) this.outcome = "the equations have no value at this start";
    if (this.g.length > 0) problem.events(t0, this.x, this.g);
    this.h = this.firstStep();
  }

  keep(t, x) { this.times.push(t); this.states.push(Float64Array.from(x)); }

  firstStep() {
    let size = 0, slope = 0;
    this.x.forEach((x, i) => {
      const scale = this.atol + this.rtol * Math.abs(x);
      size += (x / scale) ** 2;
      slope += (this.k[0][i] / scale) ** 2;
    });
    const h = slope > 1e-10 && size > 1e-10 ? 0.01 * Math.sqrt(size / slope) : 1e-6;
    return Math.min(h, (this.t1 - this.t) / 10);
  }

  // Works for at most the given milliseconds; returns true when finished.
  advance(milliseconds) {
    const until = performance.now() + milliseconds;
    while (this.outcome === "" && performance.now() < until) for (let i = 0; i < 20 && this.outcome === ""; ++i) this.step();
    return this.outcome !== "";
  }

  step() {
    const {k, x, t, next, problem} = this, n = x.length;
    let h = Math.min(this.h, this.t1 - t), failed = false, error = 0;
    if (t + 1.01 * h >= this.t1) h = this.t1 - t;
    for (let s = 1; s < 7 && !failed; ++s) {
      const target = s === 6 ? next : this.stage;
      for (let i = 0; i < n; ++i) {
        let sum = 0;
        for (let j = 0; j < s; ++j) sum += pair.a[s][j] * k[j][i];
        target[i] = x[i] + h * sum;
      }
      failed = problem.rhs(t + pair.c[s] * h, target, k[s]) !== 0;
    }
    for (let i = 0; i < n && !failed; ++i) {
      let sum = 0;
      for (let s = 0; s < 7; ++s) sum += pair.e[s] * k[s][i];
      error += (h * sum / (this.atol + this.rtol * Math.max(Math.abs(x[i]), Math.abs(next[i])))) ** 2;
    }
    error = failed ? Infinity : Math.sqrt(error / n);
    ++this.steps;
    if (!(error <= 1)) {
      this.h = h * (Number.isFinite(error) ? Math.max(0.2, 0.9 * error ** -0.2) : 0.2);
      if (!(this.h > 1e-13 * Math.max(1, Math.abs(t)))) this.outcome = "its steps became too small at t = " + t.toPrecision(4) + " s, where the equations fail";
      if (this.steps > 400000) this.outcome = "it was given up at t = " + t.toPrecision(4) + " s after 400000 steps: eomgen run has methods for stiff systems";
      return;
    }
    this.makeDense(h);
    let end = t + h;
    if (end >= this.t1 - 1e-14 * Math.abs(this.t1)) end = this.t1;
    const stopped = this.watch(t, h, end);
    if (stopped !== null) end = stopped;
    while (this.times.length <= this.rows) {
      const at = this.times.length === this.rows ? this.t1 : this.times[0] + this.times.length * this.spacing;
      if (at > end) break;
      this.interpolate((at - t) / h, this.stage);
      this.keep(at, this.stage);
    }
    if (stopped !== null) this.interpolate((stopped - t) / h, next);
    x.set(next);
    this.t = end;
    const moved = problem.project(end, x);
    if (stopped !== null || end >= this.t1) {
      if (this.times[this.times.length - 1] < end) this.keep(end, x);
      else this.states[this.states.length - 1].set(x);
      this.outcome = "done";
      return;
    }
    if (moved) problem.rhs(end, x, k[0]);
    else k[0].set(k[6]);
    this.h = h * Math.min(5, Math.max(0.3, 0.9 * Math.max(error, 1e-10) ** -0.2));
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

  // Records events within the step; returns the time of the first that ends the run, or null.
  watch(t, h, end) {
    const kinds = this.problem.eventKinds;
    if (kinds.length === 0) return null;
    const after = new Float64Array(this.g.length), probe = new Float64Array(this.g.length), state = new Float64Array(this.x.length), hits = [];
    this.problem.events(end, this.next, after);
    kinds.forEach((kind, i) => {
      const up = this.g[i] < 0 && after[i] >= 0, down = this.g[i] > 0 && after[i] <= 0;
      if (!(up && kind.direction !== "down") && !(down && kind.direction !== "up")) return;
      let low = 0, high = 1;
      for (let bisection = 0; bisection < 50; ++bisection) {
        const middle = (low + high) / 2;
        this.interpolate(middle, state);
        this.problem.events(t + middle * h, state, probe);
        if ((probe[i] < 0) === (this.g[i] < 0) && probe[i] !== 0) low = middle;
        else high = middle;
      }
      hits.push({t: t + high * h, name: kind.name, stop: kind.stop});
    });
    this.g = Array.from(after);
    hits.sort((a, b) => a.t - b.t);
    for (const hit of hits) {
      this.found.push({t: hit.t, name: hit.name});
      if (hit.stop) return hit.t;
    }
    return null;
  }
}

