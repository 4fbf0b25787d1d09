// Drags a drawn point by changing the coordinates: the change that moves the point nearest to the pointer in the screen
// plane and satisfies the constraints. Coordinates without influence on the point stay, in the mass norm.
class Drag {
  constructor(live, at, camera) { Object.assign(this, {live, at, camera}); }

  place(x) { const y = this.live.outputs(this.live.t0, x); return [y[this.at], y[this.at + 1], y[this.at + 2]]; }

  // Moves the point of state x towards `target`; the rates become 0.
  move(x, target) {
    const {live, camera} = this, n = live.n, W = live.massAt(live.t0, x);
    let trace = 0;
    for (let i = 0; i < n; ++i) trace += Math.abs(W[i][i]);
    for (let iteration = 0; iteration < 4; ++iteration) {
      const here = this.place(x), off = minus(target, here), d = [dot(off, camera.right), dot(off, camera.above)], J = [[], []];
      for (let i = 0; i < n; ++i) {
        const step = 1e-6 * Math.max(1, Math.abs(x[i])), moved = Float64Array.from(x);
        moved[i] += step;
        const slope = scaled(minus(this.place(moved), here), 1 / step);
        J[0].push(dot(slope, camera.right));
        J[1].push(dot(slope, camera.above));
      }
      let largest = 0;
      for (let i = 0; i < n; ++i) largest = Math.max(largest, J[0][i] ** 2 + J[1][i] ** 2);
      if (largest === 0) return;
      const H = W.map((row, i) => row.map((w, j) => J[0][i] * J[0][j] + J[1][i] * J[1][j] + 1e-4 * largest * (w / (trace || 1) + (i === j ? 1e-4 : 0))));
      const g = J[0].map((a, i) => a * d[0] + J[1][i] * d[1]), {psi, A} = live.constraintsAt(live.t0, x, live.modeAt(live.t0, x));
      const change = smallestCorrection(H, A, Array.from(psi, (value) => -value), g), size = Math.hypot(...change);
      for (let i = 0; i < n; ++i) x[i] += change[i] * Math.min(1, 0.5 / (size || 1));
    }
    const saved = live.x;
    live.x = x;
    x.fill(0, live.layout.rates, live.layout.first_order);
    live.meetPositions();
    live.meetRates();
    live.x = saved;
    for (let i = 0; i < n; ++i) {  // limited to the range of a coordinate
      if (live.lower[i] !== null && x[i] <= live.lower[i]) x[i] = live.lower[i] + 1e-6;
      if (live.upper[i] !== null && x[i] >= live.upper[i]) x[i] = live.upper[i] - 1e-6;
    }
  }
}

