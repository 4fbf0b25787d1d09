// Forces of contacts that the motion does not determine, within the limits of their laws, by the method of
// lib/eom/contacts/admissible_forces.hpp; slip in two directions that has just begun, by that of
// lib/eom/contacts/slip_start.hpp.

// A basis of the forces without effect on the motion, as rows. responses: accelerations for unit forces.
function forcesWithoutEffect(responses) {
  const k = responses.length, sizes = responses.map((column) => 1 / (Math.hypot(...column) || 1));
  const a = responses.map((p, i) => responses.map((q, j) => p.reduce((sum, value, l) => sum + value * q[l], 0) * sizes[i] * sizes[j]));
  const v = a.map((_, i) => a.map((_row, j) => (i === j ? 1 : 0)));  // eigenvectors as columns, by Jacobi's rotations
  for (let sweep = 0; sweep < 60; ++sweep) {
    let off = 0;
    for (let p = 0; p < k; ++p) {
      for (let q = p + 1; q < k; ++q) {
        off = Math.max(off, Math.abs(a[p][q]));
        if (Math.abs(a[p][q]) < 1e-300) continue;
        const theta = (a[q][q] - a[p][p]) / (2 * a[p][q]), t = (theta >= 0 ? 1 : -1) / (Math.abs(theta) + Math.hypot(theta, 1)), c = 1 / Math.hypot(t, 1), s = t * c;
        for (let i = 0; i < k; ++i) [a[i][p], a[i][q]] = [c * a[i][p] - s * a[i][q], s * a[i][p] + c * a[i][q]];
        for (let i = 0; i < k; ++i) [a[p][i], a[q][i]] = [c * a[p][i] - s * a[q][i], s * a[p][i] + c * a[q][i]];
        for (let i = 0; i < k; ++i) [v[i][p], v[i][q]] = [c * v[i][p] - s * v[i][q], s * v[i][p] + c * v[i][q]];
      }
    }
    if (off < 1e-16) break;
  }
  return a.flatMap((row, j) => {
    if (row[j] >= 1e-10) return [];
    const column = v.map((line, i) => line[j] * sizes[i]), largest = Math.max(...column.map(Math.abs));
    return [column.map((value) => value / largest)];
  });
}

// Forces x + sum y_d Z_d within `limits`: {normal, scale, given, holds, coefficient, tangents, size} with the places of
// the normal force (-1: it is given) and of the components of friction in x.
class AdmissibleForces {
  constructor(x, Z, limits) { Object.assign(this, {x, Z, limits, size: Math.max(0, ...limits.map((limit) => limit.size))}); }

  static wantedMargin = 1e-3;
  static lastWeight = 1e-12;
  // The error of the largest margin.
  error() { return AdmissibleForces.lastWeight * (1 + this.limits.reduce((sum, {normal, holds}) => sum + (normal >= 0 ? 1 : 0) + (holds ? 1 : 0), 0)); }
  // The least margin of all limits, as a share of the sizes of their forces; 1 at most.
  static leastMargin(limits, x) {
    let least = 1;
    for (const {normal, scale, given, holds, coefficient, tangents, size} of limits) {
      const force = normal < 0 ? given : scale * x[normal];
      if (normal >= 0) least = Math.min(least, force / size);
      if (holds) least = Math.min(least, (coefficient * force - Math.hypot(...tangents.map((i) => x[i]))) / size);
    }
    return least;
  }

  moved(y) { return Float64Array.from(this.x, (value, i) => value + this.Z.reduce((sum, row, d) => sum + y[d] * row[i], 0)); }

  find() {
    const margin = (x) => AdmissibleForces.leastMargin(this.limits, x);
    if (this.Z.length === 0 || !(this.size > 0) || margin(this.x) >= AdmissibleForces.wantedMargin) return this.x;
    const best = this.moved(this.largestMargin()), reached = margin(best);
    if (!(reached > 0)) return best;
    const wanted = Math.min(AdmissibleForces.wantedMargin, reached / 2), between = (share) => this.x.map((value, i) => value + share * (best[i] - value));
    let outside = 0, inside = 1;  // the margin is a concave function of the way
    for (let k = 0; k < 40; ++k) {
      const middle = (outside + inside) / 2;
      if (margin(between(middle)) >= wanted) inside = middle;
      else outside = middle;
    }
    return between(Math.min(1, 2 * inside));
  }

  // Minimises -s + pull |y|^2/2 and the logarithmic barriers of all margins minus s, for ever smaller weights.
  largestMargin() {
    const d = this.Z.length;
    let v = [...new Array(d).fill(0), AdmissibleForces.leastMargin(this.limits, this.x) - 1];  // y in units of size, s
    for (let weight = 1; weight >= AdmissibleForces.lastWeight; weight *= 0.1) {
      for (let step = 0; step < 30; ++step) {
        const now = this.evaluate(v, weight, true);
        const direction = Array.from(solveRows(now.hessian.map((row, i) => [...row, -now.gradient[i]]), d + 1)), fall = direction.reduce((sum, value, i) => sum + value * now.gradient[i], 0);
        if (!direction.every(Number.isFinite) || !(fall < -1e-10 * weight)) break;
        const along = (length) => v.map((value, i) => value + length * direction[i]);
        let length = 1;
        while (length > 1e-10 && !(this.evaluate(along(length), weight, false).value <= now.value + 0.1 * length * fall)) length /= 2;
        if (!(length > 1e-10)) break;
        v = along(length);
      }
    }
    return v.slice(0, d).map((value) => value * this.size);
  }

  // Slopes of the shares of the size of each limit by (y, s), with y in units of the largest size: N/size, a, T/size.
  prepare() {
    const d = this.Z.length, row = (i, factor) => Float64Array.from({length: d + 1}, (_, k) => (k === d ? 0 : factor * this.size * this.Z[k][i]));
    return this.limits.map((limit) => {
      const force = limit.normal < 0 ? new Float64Array(d + 1) : row(limit.normal, limit.scale / limit.size), less = (slope) => slope.map((value, i) => (i === d ? value - 1 : value));
      return {...limit, free: less(force), within: less(force.map((value) => limit.coefficient * value)), along: limit.tangents.map((i) => row(i, 1 / limit.size))};
    });
  }

  // {value, gradient, hessian}; infinite outside the limits.
  evaluate(v, weight, withSlopes) {
    this.prepared = this.prepared || this.prepare();
    const d = this.Z.length, s = v[d], pull = 1e-7, infinite = {value: Infinity};
    const x = this.moved(v.slice(0, d).map((value) => value * this.size)), gradient = new Float64Array(d + 1), hessian = v.map(() => new Float64Array(d + 1));
    const add = (slope, share) => { for (let i = 0; i <= d; ++i) for (let k = 0; k <= d; ++k) hessian[i][k] += share * slope[i] * slope[k]; };
    if (!(1 - s > 0)) return infinite;
    let value = -s - weight * Math.log(1 - s);
    gradient[d] = -1 + weight / (1 - s);
    hessian[d][d] = weight / (1 - s) ** 2;
    for (let i = 0; i < d; ++i) {
      value += pull / 2 * v[i] * v[i];
      gradient[i] = pull * v[i];
      hessian[i][i] = pull;
    }
    for (const {normal, scale, given, holds, coefficient, tangents, size, free, within, along} of this.prepared) {
      const force = normal < 0 ? given : scale * x[normal];
      if (normal >= 0) {
        const margin = force / size - s;
        if (!(margin > 0)) return infinite;
        value -= weight * Math.log(margin);
        if (withSlopes) {
          for (let i = 0; i <= d; ++i) gradient[i] -= weight / margin * free[i];
          add(free, weight / (margin * margin));
        }
      }
      if (!holds) continue;
      // -log(a^2 - |b|^2) with a = coefficient N/size - s and b = T/size.
      const a = coefficient * force / size - s, b = tangents.map((i) => x[i] / size), inside = b.reduce((sum, part) => sum - part * part, a * a);
      if (!(a > 0 && inside > 0)) return infinite;
      value -= weight * Math.log(inside);
      if (!withSlopes) continue;
      const whole = within.map((slope, i) => 2 * a * slope - b.reduce((sum, part, k) => sum + 2 * part * along[k][i], 0));
      for (let i = 0; i <= d; ++i) gradient[i] -= weight / inside * whole[i];
      add(whole, weight / (inside * inside));
      add(within, -2 * weight / inside);
      for (const slope of along) add(slope, 2 * weight / inside);
    }
    return {value, gradient, hessian};
  }
}

// The slip at which a start ends, as a multiple of the least slip that has a direction.
const startOfSlip = (rtol) => Math.max(2, 0.06 / Math.cbrt(Math.max(rtol, 1e-15)));

// The unit vector of friction for a slip w that began along `began`: led to its own direction from `least` to `end`.
function frictionDirection(w, began, least, end) {
  const speed = Math.hypot(...w);
  if (speed <= least) return began;
  if (speed >= end) return w.map((value) => value / speed);
  const own = (speed - least) / (end - least), sum = w.map((value, a) => (1 - own) * began[a] + own * value / speed), length = Math.hypot(...sum);
  return length > 0 ? sum.map((value) => value / length) : began;
}

// Whether a slip that began along `began` is large enough to end, or has a direction of its own away from that one.
function hasStarted(w, began, least, end) {
  const speed = Math.hypot(...w);
  return speed > end || speed > least && w[0] * began[0] + w[1] * began[1] < 0.5 * speed;
}
