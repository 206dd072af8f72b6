// min 1/2 x'Hx - g'x subject to A x >= b, or to second-order cones, in plain JavaScript.
//
// With H = LL' and u = L'x - L^-1 g this is the point u of least length with M u >= d, and that is
// one non-negative least-squares problem (Lawson & Hanson, Solving Least Squares Problems, ch. 23).
// Its passive set then gives the answer once more, from the equations of the active rows alone.
"use strict";

const range = (n) => Array.from({ length: n }, (_, i) => i);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const add = (a, b) => a.map((x, i) => x + b[i]);
const sub = (a, b) => a.map((x, i) => x - b[i]);
const scale = (a, s) => a.map((x) => x * s);
const times = (A, v) => A.map((row) => dot(row, v));
const transposed = (A, n) => range(n).map((j) => A.map((row) => row[j]));
const largest = (v) => v.reduce((most, x) => Math.max(most, Math.abs(x)), 0);

function cholesky(H) {
  const L = H.map((row) => row.map(() => 0));
  for (const i of range(H.length)) {
    for (const j of range(i + 1)) {
      const rest = H[i][j] - dot(L[i].slice(0, j), L[j].slice(0, j));
      L[i][j] = i === j ? Math.sqrt(rest) : rest / L[j][j];
    }
  }
  return L;
}

function forward(L, v) {
  const x = [...v];
  for (const i of range(v.length)) x[i] = (x[i] - dot(L[i].slice(0, i), x.slice(0, i))) / L[i][i];
  return x;
}

function backward(L, v) {
  const x = [...v];
  for (const i of range(v.length).reverse()) {
    for (let j = i + 1; j < v.length; j++) x[i] -= L[j][i] * x[j];
    x[i] /= L[i][i];
  }
  return x;
}

// The y of least |sum_j y_j columns[j] - f|, by Householder's method with column pivoting; columns
// that depend on others get 0.
function leastSquares(columns, f, limit = 1e-15) {
  const Q = columns.map((c) => [...c]), r = [...f], order = range(Q.length), diagonal = [];
  for (let k = 0; k < Math.min(order.length, f.length); k++) {
    const length = (j) => Math.hypot(...Q[j].slice(k));
    const best = order.slice(k).reduce((a, b) => (length(b) > length(a) ? b : a));
    const size = length(best);
    if (size <= limit * (diagonal.length ? Math.abs(diagonal[0]) : 0) || size === 0) break;
    order.splice(order.indexOf(best), 1);
    order.splice(k, 0, best);
    const v = Q[best].map((x, i) => (i < k ? 0 : x)), alpha = v[k] > 0 ? -size : size;
    v[k] -= alpha;
    const vv = dot(v, v);
    for (const target of [...order.slice(k).map((j) => Q[j]), r]) {
      const s = (2 * dot(v, target)) / vv;
      for (let i = k; i < v.length; i++) target[i] -= s * v[i];
    }
    diagonal.push(alpha);
  }
  const y = new Array(columns.length).fill(0);
  for (const k of range(diagonal.length).reverse()) {
    let rest = r[k];
    for (let j = k + 1; j < diagonal.length; j++) rest -= Q[order[j]][k] * y[order[j]];
    y[order[k]] = rest / Q[order[k]][k];
  }
  return y;
}

// The y >= 0 of least |E y - f|, E by columns, and its passive set.
function nonnegativeLeastSquares(E, f) {
  const y = new Array(E.length).fill(0);
  let passive = [];
  for (let step = 0; step < 20 * E.length + 100; step++) {
    const r = E.reduce((rest, c, j) => (y[j] ? sub(rest, scale(c, y[j])) : rest), f);
    const gradient = E.map((c, j) => (passive.includes(j) ? -Infinity : dot(c, r)));
    const entering = gradient.indexOf(Math.max(...gradient));
    if (!E.length || gradient[entering] <= 1e-14) break;
    passive.push(entering);
    let z;
    for (;;) {
      z = leastSquares(passive.map((j) => E[j]), f);
      if (passive[passive.length - 1] === entering && z[z.length - 1] <= 0) {
        passive.pop(); // it was rounding after all
        return [y, passive];
      }
      if (z.every((x) => x > 0)) break;
      // Where both are 0, as of a column that depends on others, there is no way to go.
      const ratio = z.map((x, i) => (x <= 0 ? y[passive[i]] / (y[passive[i]] - x) || 0 : Infinity));
      const t = Math.min(...ratio);
      passive.forEach((j, i) => { y[j] = ratio[i] <= t ? 0 : y[j] + t * (z[i] - y[j]); });
      passive = passive.filter((_, i) => ratio[i] > t);
    }
    passive.forEach((j, i) => { y[j] = z[i]; });
  }
  return [y, passive];
}

// x and lam of A x = b with independent rows, refined twice.
function equalityAnswer(H, g, A, b) {
  const L = cholesky(H), W = A.map((row) => forward(L, row));
  const solved = (r, s) => {
    // The u nearest to L^-1 r with W u = s; lam from its difference.
    const u = forward(L, r);
    const K = cholesky(W.map((a) => W.map((c) => dot(a, c))));
    const lam = backward(K, forward(K, sub(s, times(W, u))));
    return [backward(L, W.reduce((sum, a, i) => add(sum, scale(a, lam[i])), u)), lam];
  };
  let [x, lam] = solved(g, b);
  for (let k = 0; k < 4; k++) {
    const pressed = A.reduce((sum, a, i) => add(sum, scale(a, lam[i])), g);
    const [dx, dlam] = solved(sub(pressed, times(H, x)), sub(b, times(A, x)));
    [x, lam] = [add(x, dx), add(lam, dlam)];
  }
  return [x, lam];
}

// [x, lam], or [null, y] with the Farkas vector of a problem without solution.
function optimum(H, g, A, b) {
  const L = cholesky(H);
  const d = sub(b, times(A, backward(L, forward(L, g))));
  const M = A.map((row) => forward(L, row)), size = M.map((row) => Math.hypot(...row) || 1);
  const most = Math.max(0, ...d.map((x, i) => x / size[i])) || 1;
  const E = M.map((row, i) => [...scale(row, 1 / size[i]), d[i] / size[i] / most]);
  const f = [...g.map(() => 0), 1];
  const [y, passive] = nonnegativeLeastSquares(E, f);
  const rest = E.reduce((r, c, j) => sub(r, scale(c, y[j])), f);
  // More rows than unknowns bear load only where nothing satisfies them.
  if (Math.hypot(...rest) < 1e-7 || passive.length > g.length) {
    const proof = y.map((x, i) => x / size[i]);
    return [null, scale(proof, 1 / largest(proof))];
  }
  const [x, part] = equalityAnswer(H, g, passive.map((i) => A[i]), passive.map((i) => b[i]));
  const lam = A.map(() => 0);
  passive.forEach((i, k) => { lam[i] = Math.max(part[k], 0); });
  return [x, lam];
}

const image = (A, lam, n) => range(n).map((v) => A.reduce((sum, row, i) => sum + row[v] * lam[i], 0));

function qpAnswer(H, g, A, b) {
  const [x, lam] = optimum(H, g, A, b);
  if (x === null) return { farkas: lam };
  return { delta_q: x, lam, A_lam: image(A, lam, g.length), slack: sub(times(A, x), b) };
}

// Tangent planes until the cones hold, then Newton's method.
function conicAnswer(H, g, blocks) {
  const n = g.length;
  const start = [1, -1].flatMap((s) => [[1, s, 0, 0], [1, 0, s, 0], [1, 0, 0, s]]);
  const everywhere = blocks.flatMap((_, j) => start.map((w) => [j, w]));
  const motion = (x) => blocks.map(({ F, f }) => add(times(F, x), f));
  let cuts = everywhere, x, lam;
  for (let k = 0; k < 60; k++) {
    const A = cuts.map(([j, w]) => image(blocks[j].F, w, n));
    [x, lam] = optimum(H, g, A, cuts.map(([j, w]) => -dot(w, blocks[j].f)));
    const z = motion(x), size = largest(z.flat()) + 1e-300;
    const bad = range(blocks.length).filter((j) => Math.hypot(...z[j].slice(1)) - z[j][0] > 1e-9 * size);
    if (!bad.length) break;
    const tangents = bad.map((j) => [j, [1, ...scale(z[j].slice(1), -1 / Math.hypot(...z[j].slice(1)))]]);
    cuts = [...cuts.filter((_, i) => lam[i] > 0), ...everywhere, ...tangents];
  }
  let impulse = blocks.map(() => [0, 0, 0, 0]);
  cuts.forEach(([j, w], i) => { impulse[j] = add(impulse[j], scale(w, lam[i])); });
  [x, impulse] = newton(H, g, blocks, x, impulse);
  const flat = impulse.flat(), A = blocks.flatMap(({ F }) => F);
  return { delta_q: x, lam: flat, A_lam: image(A, flat, n), slack: motion(x).flat() };
}

// KKT equations of the cones that bear load, at their tip (z = 0) or on their side.
function newton(H, g, blocks, x, impulse) {
  const n = g.length, inner = impulse.map((p) => p[0] - Math.hypot(...p.slice(1)));
  const most = largest(impulse.map((p) => p[0]));
  const bears = range(blocks.length).filter((j) => impulse[j][0] > 1e-9 * most);
  const motion = (j) => add(times(blocks[j].F, x), blocks[j].f);
  // A cone that does not move is at its tip, whatever cuts bear its load; it may be, if it hardly does.
  const free = backward(cholesky(H), forward(cholesky(H), g));
  const moves = largest(blocks.flatMap(({ F, f }) => add(times(F, free), f)));
  const tips = bears.filter((j) => largest(motion(j)) <= (inner[j] > 1e-6 * impulse[j][0] ? 1e-6 : 1e-9) * moves);
  const sides = bears.filter((j) => !tips.includes(j));
  let mu = sides.map((j) => impulse[j][0]), multipliers = [];
  for (let k = 0; k < 12; k++) {
    const W = H.map((row) => [...row]), C = [], c = [];
    sides.forEach((j, i) => {
      const z = motion(j), r = Math.hypot(...z.slice(1)), e = scale(z.slice(1), 1 / r);
      const T = blocks[j].F.slice(1), along = image(T, e, n);
      for (const a of range(n)) {
        for (const b of range(n)) {
          const across = T.reduce((sum, row) => sum + row[a] * row[b], 0) - along[a] * along[b];
          W[a][b] += (mu[i] / r) * across;
        }
      }
      C.push(sub(blocks[j].F[0], along));
      c.push(z[0] - r);
    });
    for (const j of tips) {
      C.push(...blocks[j].F);
      c.push(...motion(j));
    }
    const columns = range(n).map((v) => [...W.map((row) => row[v]), ...C.map((row) => row[v])]);
    C.forEach((row) => columns.push([...scale(row, -1), ...C.map(() => 0)]));
    const answer = leastSquares(columns, [...sub(g, times(H, x)), ...scale(c, -1)], 1e-13);
    x = add(x, answer.slice(0, n));
    multipliers = answer.slice(n);
    mu = multipliers.slice(0, sides.length);
  }
  const found = blocks.map(() => [0, 0, 0, 0]);
  sides.forEach((j, i) => {
    const z = motion(j).slice(1);
    found[j] = scale([1, ...scale(z, -1 / Math.hypot(...z))], mu[i]);
  });
  tips.forEach((j, i) => { found[j] = multipliers.slice(sides.length + 4 * i, sides.length + 4 * i + 4); });
  return [x, found];
}

module.exports = { add, conicAnswer, dot, qpAnswer, range, scale, sub, times };
