// The set that constraints leave to a particle or the centre of a body: lines on a surface for one constraint on three
// coordinates, a curve for one degree of freedom. In: psi and the position as functions of own coordinates and of
// coordinates that move the surface, and the motion of these. Lines are pairs of points in own coordinates.
class Surface {
  // `source`: the code of the equations, of a state of all coordinates, and its parameters.
  constructor(description, scene, rows, source) {
    Object.assign(this, description, {scene, source, at_time: NaN, drawn_time: NaN, lines: [], drawn: []});
    this.count = this.columns.length;
    this.x = new Float64Array(source.code.info.states.length);
    this.out = new Float64Array(this.bound + 3);
    const seen = rows.map((y) => this.own(y)).filter(isPoint);
    this.low = [];
    this.high = [];
    this.columns.forEach((_, k) => {
      const least = Math.min(...seen.map((q) => q[k])), most = Math.max(...seen.map((q) => q[k])), middle = (least + most) / 2;
      const margin = this.lengths[k] ? 0.25 * scene.camera.size : Math.max(0.3 * (most - least), 0.2 * Math.abs(middle), 0.1);
      // Angles cover one revolution or the range of their chart; along a curve also the range of the motion.
      let [low, high] = this.angles[k] ? [middle - Math.PI, middle + Math.PI] : [least - margin, most + margin];
      if (this.angles[k] && this.isCurve()) [low, high] = [Math.min(low, least - 0.3), Math.max(high, most + 0.3)];
      if (this.angles[k] && this.lower[k] !== null && this.upper[k] !== null) [low, high] = [this.lower[k], this.upper[k]];
      this.low.push(this.lower[k] === null ? low : Math.max(low, this.lower[k]));
      this.high.push(this.upper[k] === null ? high : Math.min(high, this.upper[k]));
    });
    this.is_there = seen.length > 0;
  }
  isCurve() { return this.count - this.bound === 1; }
  own(y) { return this.columns.map((_, k) => y[this.at + k]); }

  psi(q) {
    this.columns.forEach((column, k) => { this.x[column] = q[k]; });
    if (this.source.code[this.equations](this.t, this.x, this.source.p, null, 0, this.out) !== 0) this.out.fill(NaN);
    return this.out;
  }
  point(q) { return Array.from(this.psi(q)).slice(this.bound); }

  // Zeros of psi in slices across each coordinate: marching squares, with crossings refined by the secant method.
  mesh() {
    const slices = 10, cells = 28, lines = [], at = (k, share) => this.low[k] + share * (this.high[k] - this.low[k]);
    for (let k = 0; k < 3; ++k) {
      const [i, j] = [(k + 1) % 3, (k + 2) % 3];
      for (let s = 0; s <= slices; ++s) {
        const q = [0, 0, 0], value = [];
        q[k] = at(k, s / slices);
        const psi = (a, b) => { q[i] = at(i, a); q[j] = at(j, b); return this.psi(q)[0]; };
        for (let a = 0; a <= cells; ++a) { value.push([]); for (let b = 0; b <= cells; ++b) value[a].push(psi(a / cells, b / cells)); }
        const crossing = (a0, b0, f0, a1, b1, f1) => {
          let low = 0, high = 1, share = f0 / (f0 - f1), low_f = f0, high_f = f1;
          for (let n = 0; n < 2; ++n) {
            const f = psi((a0 + share * (a1 - a0)) / cells, (b0 + share * (b1 - b0)) / cells);
            if (f === 0 || !Number.isFinite(f)) break;
            if ((f < 0) === (low_f < 0)) { low = share; low_f = f; } else { high = share; high_f = f; }
            share = low + (high - low) * low_f / (low_f - high_f);
          }
          q[i] = at(i, (a0 + share * (a1 - a0)) / cells);
          q[j] = at(j, (b0 + share * (b1 - b0)) / cells);
          return [...q];
        };
        for (let a = 0; a < cells; ++a) for (let b = 0; b < cells; ++b) {
          const corners = [[a, b], [a + 1, b], [a + 1, b + 1], [a, b + 1]], found = [];
          corners.forEach(([a0, b0], c) => {
            const [a1, b1] = corners[(c + 1) % 4], f0 = value[a0][b0], f1 = value[a1][b1];
            if (Number.isFinite(f0) && Number.isFinite(f1) && (f0 < 0) !== (f1 < 0)) found.push(crossing(a0, b0, f0, a1, b1, f1));
          });
          for (let n = 0; n + 1 < found.length; n += 2) lines.push([found[n], found[n + 1]]);
        }
      }
    }
    return lines;
  }

  // Follows the curve both ways from the particle: a step along the null direction, then a projection onto the
  // constraints. Scaled by the ranges.
  curve(start) {
    const n = this.count, span = this.low.map((low, k) => this.high[k] - low || 1), from = (u) => u.map((value, k) => this.low[k] + value * span[k]), small = 1e-6;
    const step = Math.min(0.01, 0.08 / Math.max(...span.map((value, k) => (this.angles[k] ? value : 0))));
    const values = (u) => Array.from(this.psi(from(u))).slice(0, this.bound);
    const slopes = (u) => {
      const by = u.map((_, k) => { const up = u.slice(), down = u.slice(); up[k] += small; down[k] -= small; const a = values(up), b = values(down); return a.map((value, c) => (value - b[c]) / (2 * small)); });
      return Array.from({length: this.bound}, (_, c) => Float64Array.from(by, (column) => column[c]));
    };
    const identity = Array.from({length: n}, (_, k) => Float64Array.from({length: n}, (_, l) => (k === l ? 1 : 0)));
    const direction = (A) => unit(n === 2 ? [-A[0][1], A[0][0], 0] : cross(Array.from(A[0]), Array.from(A[1]))).slice(0, n);
    const onto = (u, tries) => {
      for (; tries > 0; --tries) {
        const back = smallestCorrection(identity, slopes(u), values(u).map((value) => -value));
        u = u.map((value, i) => value + back[i]);
      }
      return u;
    };
    // A particle that may leave its curve can be off it.
    const begin = onto(start.map((value, k) => (value - this.low[k]) / span[k]), 8), lines = [];
    for (const sense of [1, -1]) {
      let u = begin, before = null;
      for (let k = 0; k < 4000; ++k) {
        let d = direction(slopes(u)).map((value) => sense * value);
        if (before && d.reduce((sum, value, i) => sum + value * before[i], 0) < 0) d = d.map((value) => -value);
        before = d;
        const next = onto(u.map((value, i) => value + step * d[i]), 2);
        if (!next.every((value) => value > -1e-3 && value < 1.001)) break;
        lines.push([from(u), from(next)]);
        u = next;
        if (k > 5 && Math.hypot(...u.map((value, i) => value - begin[i])) < 0.7 * step) return lines;
      }
    }
    return lines;
  }

  // Recomputes lines if their shape changes, and their ends if they move.
  find(t, y) {
    const here = this.own(y);
    if (!this.is_there || !isPoint(here)) return [];
    const isOld = (of, changes) => (changes ? of === t : !Number.isNaN(of));
    this.t = t;
    const first = 2 * this.source.code.info.coordinates.length;
    if (this.integrals !== null) for (let k = 0; k < 3 && first + k < this.x.length; ++k) this.x[first + k] = y[this.integrals + k];
    this.others.forEach((column, k) => { this.x[column] = y[this.others_at[k]]; });
    if (!isOld(this.at_time, this.reshapes)) {
      this.lines = this.isCurve() ? this.curve(here) : this.mesh();
      this.at_time = t;
      this.drawn_time = NaN;
    }
    if (!isOld(this.drawn_time, this.moves)) {
      this.drawn = this.lines.map((ends) => ends.map((q) => this.point(q))).filter(([a, b]) => isPoint(a) && isPoint(b));
      this.drawn_time = t;
    }
    return this.drawn;
  }
  show(t, y) {
    const {pencil} = this.scene, lines = this.find(t, y);
    if (this.isCurve()) pencil.segments(lines, pencil.quiet, 1.5, 0.7);
    else pencil.segments(lines, pencil.rule, 1, 0.8);
  }
}
