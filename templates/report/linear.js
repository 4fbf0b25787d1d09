// Small dense systems. In: rows with the right-hand side as last entry. Out: a solution; undetermined unknowns are 0,
// redundant equations are skipped.
function solveRows(rows, unknowns) {
  let top = 0, largest = 0;
  for (const row of rows) for (let j = 0; j < unknowns; ++j) largest = Math.max(largest, Math.abs(row[j]));
  const pivots = [];
  for (let j = 0; j < unknowns && top < rows.length; ++j) {
    let best = top;
    for (let i = top + 1; i < rows.length; ++i) if (Math.abs(rows[i][j]) > Math.abs(rows[best][j])) best = i;
    if (!(Math.abs(rows[best][j]) > 1e-12 * largest)) continue;
    [rows[top], rows[best]] = [rows[best], rows[top]];
    const pivot = rows[top];
    for (let i = 0; i < rows.length; ++i) {
      if (i === top || rows[i][j] === 0) continue;
      const factor = rows[i][j] / pivot[j];
      for (let k = j; k <= unknowns; ++k) rows[i][k] -= factor * pivot[k];
    }
    pivots.push(j);
    ++top;
  }
  const x = new Float64Array(unknowns);
  pivots.forEach((j, i) => { x[j] = rows[i][unknowns] / rows[i][j]; });
  return x;
}

// Minimises d . W d - 2 g . d subject to A d = r: W n x n and A m x n by rows, g is optional.
function smallestCorrection(W, A, r, g) {
  const n = W.length, m = A.length, rows = [];
  for (let i = 0; i < n; ++i) {
    const row = new Float64Array(n + m + 1);
    for (let j = 0; j < n; ++j) row[j] = W[i][j];
    for (let k = 0; k < m; ++k) row[n + k] = A[k][i];
    if (g) row[n + m] = g[i];
    rows.push(row);
  }
  for (let k = 0; k < m; ++k) {
    const row = new Float64Array(n + m + 1);
    for (let j = 0; j < n; ++j) row[j] = A[k][j];
    row[n + m] = r[k];
    rows.push(row);
  }
  return solveRows(rows, n + m).subarray(0, n);
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const unit = (a) => scaled(a, 1 / (Math.hypot(a[0], a[1], a[2]) || 1));
const origin = [0, 0, 0], isPoint = (r) => r.every(Number.isFinite);
// A vector that is perpendicular to a unit vector.
function acrossTo(normal) {
  const first = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].find((e) => Math.abs(dot(e, normal)) < 0.8);
  return minus(first, scaled(normal, dot(first, normal)));
}
