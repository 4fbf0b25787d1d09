// Forces or impulses of several contacts at the same instant: one complementarity problem with friction, by the method of
// lib/eom/contacts (Anitescu and Potra 1997, eq. (9); Lemke's pivoting: Cottle, Pang and Stone 1992, sections 4.4, 4.9).
// In: G and q of velocities = G force + q, the kind of each row, the laws of friction. Out: the forces.

// Linear equations whose rows may depend on one another: the solution of least norm.
function leastNorm(A, b) {
  const n = b.length, columns = new Float64Array(n).fill(1), rows = A.map((row, i) => {
    const size = row.reduce((most, a) => Math.max(most, Math.abs(a)), 0) || 1;
    return [...Array.from(row, (a) => a / size), b[i] / size];
  });
  for (let k = 0; k < n; ++k) {
    const size = Math.hypot(...rows.map((row) => row[k]));
    if (size > 0) columns[k] = 1 / size;
    for (const row of rows) row[k] *= columns[k];
  }
  const pivots = [];
  let first = 0;
  for (let rank = 0; rank < n; ++rank) {
    let at = null, most = 0;
    for (let i = rank; i < n; ++i) for (let j = 0; j < n; ++j) if (!pivots.includes(j) && Math.abs(rows[i][j]) > most) [at, most] = [[i, j], Math.abs(rows[i][j])];
    if (rank === 0) first = most;
    if (at === null || !(most > 1e-10 * first)) break;
    const [i, j] = at;
    [rows[rank], rows[i]] = [rows[i], rows[rank]];
    const pivot = rows[rank].map((a) => a / rows[rank][j]);
    rows.forEach((row, k) => {
      if (k === rank) rows[k] = pivot;
      else if (row[j] !== 0) rows[k] = row.map((a, l) => a - row[j] * pivot[l]);
    });
    pivots.push(j);
  }
  const free = Array.from({length: n}, (_, j) => j).filter((j) => !pivots.includes(j)), x = new Float64Array(n);
  // x_pivot = c - R x_free: |x| is least where (R^T R + 1) x_free = R^T c.
  const y = free.length === 0 ? [] : solveRows(free.map((j, a) => [...free.map((k, b2) => (a === b2 ? 1 : 0) + pivots.reduce((sum, _, i) => sum + rows[i][j] * rows[i][k], 0)), pivots.reduce((sum, _, i) => sum + rows[i][j] * rows[i][n], 0)]), free.length);
  free.forEach((j, a) => { x[j] = y[a]; });
  pivots.forEach((j, i) => { x[j] = rows[i][n] - free.reduce((sum, k, a) => sum + rows[i][k] * y[a], 0); });
  return {x: x.map((value, j) => value * columns[j]), rank: pivots.length};
}

// z of w = M z + q, w >= 0, z >= 0, w . z = 0; null if the method ends on a ray.
function solveComplementarity(M, q, isScaled) {
  const n = q.length, factors = new Float64Array(n).fill(1), pivotTolerance = 1e-11, ratioTolerance = 1e-13;
  if (q.every((value) => value >= 0)) return new Float64Array(n);
  if (isScaled) {  // rows and columns have largest entries near 1 (Ruiz 2001); powers of 2
    let A = M.map((row) => Float64Array.from(row));
    for (let round = 0; round < 8; ++round) {
      const step = A.map((row, i) => row.reduce((most, a, k) => Math.max(most, Math.abs(a), Math.abs(A[k][i])), 0)).map((size) => (size > 0 ? 2 ** Math.round(-Math.log2(size) / 2) : 1));
      A = A.map((row, i) => row.map((a, k) => step[i] * a * step[k]));
      step.forEach((s, i) => { factors[i] *= s; });
    }
  }
  const size = q.reduce((most, value, i) => Math.max(most, Math.abs(value * factors[i])), 0), covering = 2 * n, right = 2 * n + 1;
  const table = M.map((row, i) => {
    const line = new Float64Array(2 * n + 2);
    line[i] = 1;
    row.forEach((a, k) => { line[n + k] = -factors[i] * a * factors[k]; });
    line[covering] = -1;
    line[right] = q[i] * factors[i] / size;
    return line;
  });
  const basic = Array.from(q, (_, i) => i), ratio = (i, entering) => table[i][right] / table[i][entering];
  const precedes = (a, b, entering) => {
    const difference = ratio(a, entering) - ratio(b, entering);
    if (Math.abs(difference) > ratioTolerance) return difference < 0;
    for (let k = 0; k < n; ++k) {
      const x = table[a][k] / table[a][entering], y = table[b][k] / table[b][entering];
      if (Math.abs(x - y) > ratioTolerance) return x < y;
    }
    return false;
  };
  let row = 0, entering = covering;
  for (let i = 1; i < n; ++i) if (table[i][right] < table[row][right]) row = i;
  for (let count = 0;; ++count) {
    const leaves = basic[row], line = table[row], pivot = line[entering];
    for (let k = 0; k < line.length; ++k) line[k] /= pivot;
    for (let i = 0; i < n; ++i) {
      const factor = table[i][entering];
      if (i === row || factor === 0) continue;
      for (let k = 0; k < line.length; ++k) table[i][k] -= factor * line[k];
      table[i][entering] = 0;
    }
    line[entering] = 1;
    basic[row] = entering;
    if (leaves === covering) break;
    entering = leaves < n ? leaves + n : leaves - n;
    const least = pivotTolerance * Math.max(1, ...table.map((of) => Math.abs(of[entering]))), eligible = basic.map((_, i) => i).filter((i) => table[i][entering] > least);
    if (eligible.length === 0 || count === 50 * (n + 1)) return null;
    const best = eligible.reduce((a, b) => (precedes(b, a, entering) ? b : a)), end = eligible.find((i) => basic[i] === covering && ratio(i, entering) <= ratio(best, entering) + ratioTolerance);
    row = end === undefined ? best : end;
  }
  const z = new Float64Array(n);
  basic.forEach((variable, i) => { if (variable >= n && variable < 2 * n) z[variable - n] = Math.max(0, table[i][right]) * size * factors[variable - n]; });
  return z;
}

const polygon = 8;  // directions of friction on a surface, where the pivoting begins the iteration on the circle

class FrictionProblem {
  // kinds: "bilateral", "unilateral" or "friction" per row; laws: {tangents, normal (a row, or -1), sign, given, coefficient}
  constructor(G, q, kinds, laws) {
    Object.assign(this, {G, q, kinds, laws});
    this.held = kinds.flatMap((kind, i) => (kind === "bilateral" ? [i] : []));
    this.free = kinds.flatMap((kind, i) => (kind === "bilateral" ? [] : [i]));
    // Held rows follow from the others: force_held = h0 + H force_free.
    const {held, free} = this, of = () => held.map((i) => held.map((k) => G[i][k]));
    this.h0 = held.length > 0 ? leastNorm(of(), held.map((i) => -q[i])).x : [];
    const columns = free.map((k) => (held.length > 0 ? leastNorm(of(), held.map((i) => -G[i][k])).x : []));
    this.H = held.map((_, i) => columns.map((column) => column[i]));
    this.qFree = free.map((i) => q[i] + held.reduce((sum, k, a) => sum + G[i][k] * this.h0[a], 0));
    this.GFree = free.map((i) => free.map((k, b) => G[i][k] + held.reduce((sum, l, a) => sum + G[i][l] * this.H[a][b], 0)));
  }

  // coefficient * normal force of a law as an affine function of the forces of free rows: [constant, factors].
  limit(law) {
    const factors = new Float64Array(this.free.length);
    if (law.normal < 0) return [law.coefficient * Math.abs(law.given), factors];
    const at = this.held.indexOf(law.normal), strength = law.coefficient * law.sign, given = law.coefficient * law.given;
    if (at >= 0) return [strength * this.h0[at] + given, factors.map((_, k) => strength * this.H[at][k])];
    factors[this.free.indexOf(law.normal)] = strength;
    return [given, factors];
  }

  // {force, velocity, speed} of all rows and laws, or null.
  solve() {
    const isPlanar = this.laws.some((law) => law.tangents.length === 2);
    let best = null;
    for (const softness of [1e-13, 1e-10]) {
      for (const isScaled of [false, true]) {
        let result = this.byPivoting(softness, isScaled);
        if (result === null) continue;
        if (isPlanar) result = this.refine(result);
        result.residual = this.residual(result);
        if (best === null || result.residual < best.residual) best = result;
        if (isPlanar || best.residual <= 1e-10) return best;
      }
    }
    return best;
  }

  byPivoting(softness, isScaled) {
    const {free, kinds, laws} = this, place = (row) => free.indexOf(row), columns = [];
    for (const row of free) if (kinds[row] === "unilateral") columns.push({law: -1, parts: [[place(row), 1]]});
    laws.forEach((law, l) => {
      const senses = law.tangents.length === 1 ? 2 : polygon;
      for (let k = 0; k < senses; ++k) {
        const angle = 2 * Math.PI * k / senses, along = senses === 2 ? [k === 0 ? 1 : -1] : [Math.cos(angle), Math.sin(angle)];
        columns.push({law: l, parts: law.tangents.map((row, a) => [place(row), along[a]])});
      }
    });
    const n = columns.length, soft = this.GFree.map((row, i) => softness * Math.abs(row[i]));
    const G = this.GFree.map((row, i) => row.map((g, k) => (i === k ? g + soft[i] : g))), dotted = (parts, vector) => parts.reduce((sum, [i, s]) => sum + s * vector[i], 0);
    const M = Array.from({length: n + laws.length}, () => new Float64Array(n + laws.length)), q = new Float64Array(n + laws.length);
    columns.forEach((a, i) => columns.forEach((b, k) => { M[i][k] = a.parts.reduce((sum, [row, s]) => sum + s * dotted(b.parts, G[row]), 0); }));
    const fill = (vector) => columns.forEach((column, i) => { q[i] = dotted(column.parts, vector); });
    fill(this.qFree);
    laws.forEach((law, l) => {
      const [constant, factors] = this.limit(law);
      q[n + l] = constant;
      columns.forEach((column, c) => {
        M[n + l][c] = dotted(column.parts, factors) - (column.law === l ? 1 : 0);
        if (column.law === l) M[c][n + l] = 1;
      });
    });
    const forces = (z) => {
      const y = new Float64Array(free.length);
      columns.forEach((column, c) => column.parts.forEach(([row, s]) => { y[row] += s * z[c]; }));
      return y;
    };
    const z = solveComplementarity(M, q, isScaled);
    if (z === null) return null;
    // The softness leaves velocities of its own size; a step of the proximal point method removes them.
    const y = forces(z), result = this.complete(y);
    fill(this.qFree.map((value, i) => value - soft[i] * y[i]));
    const corrected = solveComplementarity(M, q, isScaled);
    if (corrected === null) return result;
    const better = this.complete(forces(corrected));
    return this.residual(better) < this.residual(result) ? better : result;
  }

  complete(y) {
    const force = new Float64Array(this.q.length);
    this.free.forEach((row, i) => { force[row] = y[i]; });
    this.held.forEach((row, i) => { force[row] = this.h0[i] + this.H[i].reduce((sum, h, k) => sum + h * y[k], 0); });
    const velocity = this.G.map((row, i) => row.reduce((sum, g, k) => sum + g * force[k], this.q[i]));
    return {force, velocity, speed: this.laws.map((law) => Math.hypot(...law.tangents.map((row) => velocity[row])))};
  }

  // The largest change of a force in one step of projection, as a share of the largest force.
  residual({force, velocity}) {
    const {G, q, kinds, laws} = this;
    let largest = 0, size = force.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
    const step = (row, response) => {
      size = Math.max(size, Math.abs(q[row]) / response);
      return velocity[row] / response;
    };
    kinds.forEach((kind, i) => {
      const response = Math.abs(G[i][i]);
      if (kind === "friction" || !(response > 0)) return;
      const change = step(i, response);
      largest = Math.max(largest, Math.abs(kind === "bilateral" ? change : Math.min(force[i], change)));
    });
    for (const law of laws) {
      const slowest = Math.max(...law.tangents.map((row) => G[row][row]));
      if (!(slowest > 0)) continue;
      const normal = law.normal < 0 ? Math.abs(law.given) : law.sign * force[law.normal] + law.given, most = law.coefficient * Math.max(0, normal);
      const wanted = law.tangents.map((row) => force[row] - step(row, slowest)), length = Math.hypot(...wanted), factor = length > most ? most / length : 1;
      law.tangents.forEach((row, a) => { largest = Math.max(largest, Math.abs(factor * wanted[a] - force[row])); });
    }
    return size > 0 ? largest / size : 0;
  }

  // Gauss-Seidel with projections; if it is slow, Newton's method (lib/eom/contacts/friction_newton.hpp).
  refine(result) {
    let y = this.free.map((row) => result.force[row]);
    if (!this.sweep(y, 20)) {
      const better = this.byNewton(y);
      if (better !== null) y = better;
      else this.sweep(y, 20000);
    }
    return this.complete(y);
  }

  velocities(y) { return this.GFree.map((row, i) => row.reduce((sum, g, k) => sum + g * y[k], this.qFree[i])); }

  // Projections onto the half line of normals and the discs of friction. Returns whether the last round changed nothing.
  sweep(y, rounds) {
    const {free, kinds, laws, GFree} = this, velocity = this.velocities(y);
    const set = (i, value) => {
      const change = value - y[i];
      y[i] = value;
      if (change !== 0) GFree.forEach((row, k) => { velocity[k] += change * row[i]; });
      return Math.abs(change);
    };
    let size = Math.max(1e-300, ...y.map(Math.abs));
    for (let round = 0; round < rounds; ++round) {
      let moved = 0;
      free.forEach((row, i) => { if (kinds[row] === "unilateral" && GFree[i][i] > 0) moved = Math.max(moved, set(i, Math.max(0, y[i] - velocity[i] / GFree[i][i]))); });
      for (const law of laws) {
        const [constant, factors] = this.limit(law), most = Math.max(0, y.reduce((sum, value, k) => sum + value * factors[k], constant));
        const at = law.tangents.map((row) => free.indexOf(row)), slowest = Math.max(...at.map((i) => GFree[i][i]));
        if (!(slowest > 0)) continue;
        const wanted = at.map((i) => y[i] - velocity[i] / slowest), length = Math.hypot(...wanted), factor = length > most ? most / length : 1;
        at.forEach((i, a) => { moved = Math.max(moved, set(i, factor * wanted[a])); });
      }
      size = Math.max(size, ...y.map(Math.abs));
      if (moved <= 1e-13 * size) return true;
    }
    return false;
  }

  // y less its projection after a step along the velocities, and the derivatives of that (Alart and Curnier 1991).
  defect(y) {
    const {free, kinds, laws, GFree} = this, velocity = this.velocities(y), F = new Float64Array(y.length), J = y.map(() => new Float64Array(y.length));
    const take = (i, response) => {
      F[i] = velocity[i] / response;
      J[i] = Float64Array.from(GFree[i], (g) => g / response);
    };
    free.forEach((row, i) => {
      const response = GFree[i][i];
      if (kinds[row] !== "unilateral" || !(response > 0)) return;
      if (y[i] - velocity[i] / response > 0) take(i, response);
      else [F[i], J[i][i]] = [y[i], 1];
    });
    for (const law of laws) {
      const at = law.tangents.map((row) => free.indexOf(row)), slowest = Math.max(...at.map((i) => GFree[i][i]));
      if (!(slowest > 0)) continue;
      const [constant, factors] = this.limit(law), most = y.reduce((sum, value, k) => sum + value * factors[k], constant), radius = Math.max(0, most);
      const wanted = at.map((i) => y[i] - velocity[i] / slowest), length = Math.hypot(...wanted);
      if (length <= radius) {
        for (const i of at) take(i, slowest);
        continue;
      }
      at.forEach((i, a) => {
        const along = wanted[a] / length;
        F[i] = y[i] - radius * along;
        if (most > 0) factors.forEach((factor, k) => { J[i][k] -= along * factor; });
        at.forEach((k, b) => {
          const turn = radius / length * ((a === b ? 1 : 0) - along * wanted[b] / length);
          GFree[k].forEach((g, l) => { J[i][l] += turn / slowest * g; });
          J[i][k] -= turn;
        });
        J[i][i] += 1;
      });
    }
    return {F, J};
  }

  // The forces, or null.
  byNewton(y) {
    let {F, J} = this.defect(y);
    for (let round = 0; round < 30; ++round) {
      const size = Math.max(1e-300, ...y.map(Math.abs)), largest = Math.max(...F.map(Math.abs)), norm = Math.hypot(...F);
      if (largest <= 1e-13 * size) return y;
      const {x: step} = leastNorm(J, F), moved = (share) => y.map((value, i) => value - share * step[i]);
      if (!step.every(Number.isFinite)) return null;
      let share = 1, next = moved(1);
      for (let k = 0; k < 12 && !(Math.hypot(...this.defect(next).F) < norm); ++k) next = moved(share /= 2);
      const then = this.defect(next);
      if (!(Math.hypot(...then.F) < norm)) return largest <= 1e-12 * size ? y : null;
      [y, F, J] = [next, then.F, then.J];
    }
    return null;
  }
}
