// Checks solution files, in Node and in a page; written from the documents "File formats" and "Exact answers" alone.
// node verify.js step.json solution.json prints {verdict, reason, notChecked}; status 0 verified, 1 refused, 2 not checked.
"use strict";
const verifier = (() => {
  class Refused extends Error {}
  const need = (condition, sentence) => { if (!condition) throw new Refused(sentence); };
  const range = (n) => Array.from({ length: n }, (_, i) => i);
  // ---- Numbers: p 2^e / q with q > 0, exact. Every float64 is one with q = 1. ----
  const bits = (n) => { const hex = n.toString(16); return 4 * hex.length - Math.clz32(parseInt(hex[0], 16)) + 28; };
  class Q {
    constructor(p, e = 0, q = 1n) { this.p = p; this.e = e; this.q = q; }
    static of(x) {
      const word = new BigUint64Array(new Float64Array([x]).buffer)[0], e = Number((word >> 52n) & 2047n);
      const p = (word & (2n ** 52n - 1n)) | (e ? 2n ** 52n : 0n);
      if (p === 0n) return Q.zero;
      const twos = bits(p & -p) - 1;
      return new Q((x < 0 ? -p : p) >> BigInt(twos), (e || 1) - 1075 + twos);
    }
    get sign() { return this.p > 0n ? 1 : this.p < 0n ? -1 : 0; }
    get negative() { return new Q(-this.p, this.e, this.q); }
    get square() { return this.times(this); }
    plus(o) {
      if (this.p === 0n || o.p === 0n) return this.p === 0n ? o : this;
      const [a, b, q] = this.q === o.q ? [this.p, o.p, this.q] : [this.p * o.q, o.p * this.q, this.q * o.q];
      const e = Math.min(this.e, o.e);
      return new Q((a << BigInt(this.e - e)) + (b << BigInt(o.e - e)), e, q);
    }
    minus(o) { return this.plus(o.negative); }
    times(o) { return new Q(this.p * o.p, this.e + o.e, this.q * o.q); }
    over(o) { return new Q(this.p * o.q * BigInt(o.sign), this.e - o.e, this.q * (o.p < 0n ? -o.p : o.p)); }
    atMost(o) { return this.minus(o).sign <= 0; }
    get float() { // the nearest float64, ties to even, subnormal numbers included, never -0.0
      if (this.p === 0n) return 0;
      const n = (this.p < 0n ? -this.p : this.p) << BigInt(Math.max(this.e, 0)), d = this.q << BigInt(Math.max(-this.e, 0));
      for (let k = Math.max(bits(n) - bits(d) - 53, -1074); ; k++) {
        const top = n << BigInt(Math.max(-k, 0)), bottom = d << BigInt(Math.max(k, 0)), floor = top / bottom;
        if (floor >= 2n ** 53n) continue;
        const twice = 2n * (top - floor * bottom), up = twice > bottom || (twice === bottom && floor & 1n);
        return this.sign * Number(up ? floor + 1n : floor) * 2 ** k || 0;
      }
    }
  }
  Q.zero = new Q(0n);
  const sum = (list) => list.reduce((a, b) => a.plus(b), Q.zero);
  const dot = (u, v) => sum(u.map((x, i) => x.times(v[i])));
  const along = (matrix, x) => matrix.map((row) => dot(row, x));
  // A vector of dyadic numbers times the power of two that makes it whole.
  const whole = (vector) => {
    const e = Math.min(...vector.filter((x) => x.sign).map((x) => x.e));
    return vector.map((x) => (x.sign ? x.p << BigInt(x.e - e) : 0n));
  };
  // ---- Linear algebra over the integers (Bareiss: every division is exact) ----
  // The pivot rows of the first n columns and the rows that are left; null if the columns are dependent.
  function eliminated(matrix, n) {
    let rest = matrix, last = 1n, exchanged = false, done = [];
    for (let c = 0; c < n; c++) {
      const k = rest.findIndex((row) => row[c] !== 0n), row = rest[k];
      if (k < 0) return null;
      rest = rest.filter((_, i) => i !== k).map((r) => r.map((x, j) => (j <= c ? 0n : (row[c] * x - r[c] * row[j]) / last)));
      [last, done, exchanged] = [row[c], [...done, row], exchanged || k > 0];
    }
    return { done, rest, exchanged };
  }
  // The one solution of a square system whose rows end with the right side; null if it is singular.
  function solved(rows) {
    const n = rows.length, out = eliminated(rows.map(whole), n);
    const det = out && (n ? out.done[n - 1][n - 1] : 1n), x = Array(n).fill(0n); // x times det is whole
    out?.done.reverse().forEach((row, k) => {
      const i = n - 1 - k; // the entries of x up to here are still 0
      x[i] = (det * row[n] - x.reduce((total, y, j) => total + y * row[j], 0n)) / row[i];
    });
    return out && x.map((top) => (det < 0n ? new Q(-top, 0, -det) : new Q(top, 0, det)));
  }
  const columns = (rows, n) => range(n).map((j) => rows.map((row) => row[j]));
  // Are all pivots of a symmetric matrix above `share` of their diagonal entries?
  function positiveDefinite(S, share) {
    const n = S.length, all = whole(S.flat()), out = eliminated(range(n).map((i) => all.slice(i * n, i * n + n)), n);
    return out !== null && !out.exchanged && range(n).every((i) => {
      const minor = out.done[i][i], before = i ? out.done[i - 1][i - 1] : 1n, entry = all[i * n + i];
      return minor > 0n && new Q(entry * before).times(share).minus(new Q(minor)).sign < 0;
    });
  }
  // Is there d >= 0 with R d = c? The first phase of the simplex method in integers, with Bland's rule.
  function feasible(R, c) {
    const n = R.length ? R[0].length : 0, basis = R.map((_, i) => n + i);
    const T = R.map((row, i) => [...row, c[i]].map((x) => (c[i] < 0n ? -x : x)));
    T.push(range(n + 1).map((j) => -T.reduce((total, row) => total + row[j], 0n)));
    for (let last = 1n, cost = T.length - 1; ; ) {
      const enter = T[cost].findIndex((x, j) => j < n && x < 0n);
      if (enter < 0) return T[cost][n] === 0n;
      let leave = -1;
      for (let i = 0; i < cost; i++) {
        if (T[i][enter] <= 0n) continue;
        const ahead = leave < 0 ? -1n : T[i][n] * T[leave][enter] - T[leave][n] * T[i][enter];
        if (ahead < 0n || (ahead === 0n && basis[i] < basis[leave])) leave = i;
      }
      const row = T[leave], pivot = row[enter];
      T.forEach((r, i) => { if (i !== leave) T[i] = r.map((x, j) => (pivot * x - r[enter] * row[j]) / last); });
      [basis[leave], last] = [enter, pivot];
    }
  }
  // ---- Files ----
  function decoded(file, what) {
    try { return new TextDecoder("utf-8", { fatal: true }).decode(file); } catch { throw new Refused(`${what} is not UTF-8`); }
  }
  // JSON; a number without point and exponent becomes a BigInt. Refuses repeated names, NaN and what is beyond float64.
  function parsed(file, what) {
    const text = typeof file === "string" ? file : decoded(file, what);
    const token = new RegExp(String.raw`[ \t\n\r]*("(?:[^"\\\u0000-\u001f]|\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4}))*"`
      + String.raw`|-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?|true|false|null|[[\]{},:])`, "y");
    const json = (condition) => need(condition, `${what} is not JSON`);
    token.lastIndex = text.startsWith("\ufeff") ? 1 : 0;
    const next = () => { const found = token.exec(text); json(found); return found[1]; };
    const inner = (first, depth) => {
      json(!"]},:".includes(first) && depth < 20);
      if (first === "{" || first === "[") {
        const list = [], table = new Map(), end = first === "{" ? "}" : "]";
        for (let t = next(); t !== end; t = next()) {
          if (list.length + table.size) { json(t === ","); t = next(); }
          if (first === "[") { list.push(inner(t, depth + 1)); continue; }
          json(t[0] === '"' && next() === ":");
          const name = JSON.parse(t);
          need(!table.has(name), `${what} has the field ${name} twice`);
          table.set(name, inner(next(), depth + 1));
        }
        return first === "[" ? list : table;
      }
      const value = /^-?[0-9]+$/.test(first) ? BigInt(first) : JSON.parse(first);
      const whole = typeof value === "string" ? !/\p{Surrogate}/u.test(value) : Number.isFinite(Number(value));
      need(whole, `${what} has half of a character, or a number beyond float64`);
      return value;
    };
    const value = inner(next(), 0);
    json(/^[ \t\n\r]*$/.test(text.slice(token.lastIndex)));
    return value;
  }
  function fields(table, what, names, others = []) {
    need(table instanceof Map, `${what} is not a table`);
    for (const name of names) need(table.has(name), `${what} has no field ${name}`);
    for (const name of table.keys()) need([...names, ...others].includes(name), `${what} has the unknown field ${name}`);
    return Object.fromEntries(table);
  }
  const list = (x, n, what) => { need(Array.isArray(x) && x.length === n, `${what} is not a list of ${n}`); return x; };
  const number = (x, what) => { need(typeof x === "number" || typeof x === "bigint", `${what} is not a number`); return Number(x); };
  const numbers = (x, n, what) => list(x, n, what).map((y) => number(y, what));
  const matrix = (x, m, n, what) => list(x, m, what).map((row) => numbers(row, n, what));
  const count = (x, what) => { need(typeof x === "bigint" && x >= 0n, `${what} is not a whole number`); return Number(x); };
  const CONTACT = ["name", "phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows"], WHOLE = ["version", "n_a", "n_u", "rows"];
  const STEP = ["format", "version", "cone", "h", "n_a", "n_u", "K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a", "contacts"];
  function stepRead(text) {
    const missing = { cone: "pyramid", extra: new Map([["names", []], ["A", []], ["b", []]]) };
    const s = { ...missing, ...fields(parsed(text, "the step"), "the step", STEP.filter((name) => name !== "cone"), ["cone", "extra"]) };
    need(s.format === "quasistatic-ref/step" && s.version === 1n, "the step is not of this format and version");
    s.K = Number((/^facets-([1-9][0-9]*)$/.exec(s.cone) || [0, 0])[1]);
    need(["pyramid", "ellipsoid", "product", "frictionless"].includes(s.cone) || (s.K % 2 === 0 && s.K >= 4 && s.K <= 1024), "the cone is unknown");
    need((s.h = number(s.h, "h")) > 0, "h is not greater than 0");
    const n = (s.n_a = count(s.n_a, "n_a")) + (s.n_u = count(s.n_u, "n_u"));
    for (const [name, size] of [["K_q", s.n_a], ["M_u", s.n_u]]) {
      const S = matrix(s[name], size, size, name), largest = Math.max(0, ...S.flat().map(Math.abs));
      S.forEach((row, i) => row.forEach((x, j) => need(Math.abs(x - S[j][i]) <= 1e-12 * largest, `${name} is not symmetric`)));
      s[name] = S.map((row, i) => row.map((x, j) => (j > i ? S[j][i] : x))); // the lower triangle counts
      need(positiveDefinite(s[name].map((row) => row.map(Q.of)), Q.of(1e-14)), `${name} is not positive definite`);
    }
    for (const [name, size] of [["tau_a", s.n_a], ["tau_u", s.n_u], ["delta_q_bar_a", s.n_a]]) s[name] = numbers(s[name], size, name);
    s.contacts = list(s.contacts, s.contacts?.length, "contacts").map((table) => {
      const c = fields(table, "a contact", CONTACT);
      for (const name of ["phi", "mu_v", "mu_omega"]) c[name] = number(c[name], name);
      const axes = ["d1", "d2", "n"].map((name) => (c[name] = numbers(c[name], 3, name))), [u, v, w] = axes;
      const product = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const orthonormal = axes.every((a, i) => axes.every((b, j) => Math.abs(product(a, b) - (i === j)) <= 1e-9));
      need(orthonormal && product(cross, w) > 0, "d1, d2, n are not orthonormal and right-handed");
      [c.J, c.rows] = [matrix(c.J, 4, n, "J"), count(c.rows, "rows")];
      need(typeof c.name === "string" && (c.rows === 6 || c.rows === 4), "a contact's name is not a string, or rows neither 6 nor 4");
      need(c.mu_v >= 0 && c.mu_omega >= 0, "a coefficient of friction is negative");
      return c;
    });
    const { names, A, b } = fields(s.extra, "extra", ["names", "A", "b"]);
    need(Array.isArray(names) && names.every((x) => typeof x === "string"), "names of extra are not strings");
    return { ...s, extra: { names, A: matrix(A, names.length, n, "A of extra"), b: numbers(b, names.length, "b of extra") } };
  }
  // The text of a step as the package writes it, and SHA-256 (its constants are roots of the first primes).
  function repr(x) {
    if (x === 0) return "0.0";
    const [, sign, digits, exponent] = /^(-?)([0-9.]+)e([-+][0-9]+)$/.exec(x.toExponential());
    const d = digits.replace(".", ""), e = Number(exponent);
    if (e < -4 || e > 15) return `${sign}${digits}e${e < 0 ? "-" : "+"}${String(Math.abs(e)).padStart(2, "0")}`;
    const all = e < 0 ? "0".repeat(-e) + d : d.padEnd(e + 2, "0"), point = Math.max(e, 0) + 1;
    return `${sign}${all.slice(0, point)}.${all.slice(point)}`;
  }
  function stepText(s) {
    const written = (x, name) => Array.isArray(x) ? `[${x.map((y) => written(y)).join(", ")}]` : typeof x === "object" ? x.written
      : typeof x === "string" ? JSON.stringify(x) : WHOLE.includes(name) ? String(x) : repr(x);
    const table = (x, names) => ({ written: `{${names.map((name) => `"${name}": ${written(x[name], name)}`).join(", ")}}` });
    const parts = { contacts: s.contacts.map((c) => table(c, CONTACT)), extra: table(s.extra, ["names", "A", "b"]) };
    return table({ ...s, ...parts }, s.extra.b.length ? [...STEP, "extra"] : STEP).written + "\n";
  }
  function sha256(text) {
    const primes = range(312).filter((n) => n > 1 && range(n).every((d) => d < 2 || n % d)); // 64 of them
    const root = (p, power, low = 0n, bit = 1n << 36n) => !bit ? Number(low & 0xffffffffn) // 32 bits after the point
      : root(p, power, (low + bit) ** power <= BigInt(p) << (32n * power) ? low + bit : low, bit >> 1n);
    const k = primes.map((p) => root(p, 3n)), state = primes.slice(0, 8).map((p) => root(p, 2n));
    const message = new TextEncoder().encode(text), data = new Uint8Array((((message.length + 8) >> 6) + 1) * 64);
    data.set([...message, 128]);
    const view = new DataView(data.buffer), turn = (x, n) => (x >>> n) | (x << (32 - n));
    view.setBigUint64(data.length - 8, BigInt(message.length) * 8n);
    for (let at = 0; at < data.length; at += 64) {
      const w = range(16).map((i) => view.getUint32(at + 4 * i));
      for (let i = 16, a = w[1], b = w[14]; i < 64; i++, a = w[i - 15], b = w[i - 2]) {
        w.push((w[i - 16] + (turn(a, 7) ^ turn(a, 18) ^ (a >>> 3)) + w[i - 7] + (turn(b, 17) ^ turn(b, 19) ^ (b >>> 10))) | 0);
      }
      let [a, b, c, d, e, f, g, h] = state;
      for (let i = 0; i < 64; i++) {
        const one = (h + (turn(e, 6) ^ turn(e, 11) ^ turn(e, 25)) + ((e & f) ^ (~e & g)) + k[i] + w[i]) | 0;
        const two = ((turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + ((a & b) ^ (a & c) ^ (b & c))) | 0;
        [a, b, c, d, e, f, g, h] = [(one + two) | 0, a, b, c, (d + one) | 0, e, f, g];
      }
      [a, b, c, d, e, f, g, h].forEach((x, i) => { state[i] = (state[i] + x) | 0; });
    }
    return state.map((x) => (x >>> 0).toString(16).padStart(8, "0")).join("");
  }
  // ---- The quadratic program, times h so that every number in it is dyadic: h H, h g; multipliers h lam. ----
  function turns(K) { // float64 nearest to cos and sin of 2 pi k / K, by series in fixed point
    const one = 1n << 256n;
    const series = (t, square, i) => (t ? t + series((-t * square) / one / (i * (i + 1n)), square, i + 2n) : 0n);
    const arctan = (n, power = one / n, i = 1n) => (power ? power / i + arctan(n, power / (-n * n), i + 2n) : 0n);
    const pi = 16n * arctan(5n) - 4n * arctan(239n);
    const nearest = (x) => (x >> 60n === 0n || -x >> 60n === 0n ? Q.zero : Q.of(new Q(x, -256).float)); // smaller is 0
    return range(K).map((k) => {
      const angle = (2n * pi * BigInt(k)) / BigInt(K), square = (angle * angle) / one;
      return [series(one, square, 1n), series(angle, square, 2n)].map(nearest);
    });
  }
  function programme(s) {
    const h = Q.of(s.h), exact = (M) => M.map((row) => row.map(Q.of)), K = exact(s.K_q), M = exact(s.M_u), n = s.n_a + s.n_u;
    const H = range(n).map((i) => range(n).map((j) => i < s.n_a && j < s.n_a ? K[i][j].times(h.square)
      : i >= s.n_a && j >= s.n_a ? M[i - s.n_a][j - s.n_a] : Q.zero));
    const spring = along(K, s.delta_q_bar_a.map(Q.of)).map((x, i) => x.plus(Q.of(s.tau_a[i])));
    const g = [...spring, ...s.tau_u.map(Q.of)].map((x) => x.times(h.square));
    const corners = s.K ? turns(s.K) : [], A = [], b = [];
    const contacts = s.contacts.map((c) => {
      const J = exact(c.J), zero = Q.zero, mu = Q.of(c.mu_v), spin = c.rows === 6 ? Q.of(c.mu_omega) : zero;
      const [normal, one, two] = [c.n, c.d1, c.d2].map((d) => range(n).map((j) => dot(d.map(Q.of), J.slice(0, 3).map((row) => row[j]))));
      const square = [[mu, zero], [zero, mu], [mu.negative, zero], [zero, mu.negative]];
      const sides = s.K ? corners.map(([x, y]) => [x.times(mu), y.times(mu)]) : square, ends = c.rows === 6 ? [spin, spin.negative] : [];
      const coefficients = s.cone === "ellipsoid" || s.cone === "frictionless" ? [[zero, zero, zero]]
        : s.cone === "product" ? (c.rows === 6 ? ends : [zero]).flatMap((r) => sides.map((x) => [...x, r]))
          : [...sides.map((x) => [...x, zero]), ...ends.map((r) => [zero, zero, r])];
      const first = A.length;
      A.push(...coefficients.map(([p, q, r]) => range(n).map((j) => sum([normal[j], p.times(one[j]), q.times(two[j]), r.times(J[3][j])]))));
      if (s.cone === "ellipsoid") A.push(one, two, J[3]);
      range(A.length - first).forEach((i) => b.push(i && s.cone === "ellipsoid" ? zero : Q.of(c.phi).negative));
      return { first, size: A.length - first, coefficients, friction: [mu, mu, spin] };
    });
    const own = { first: A.length, size: s.extra.b.length };
    return { n, h, H, g, A: [...A, ...exact(s.extra.A)], b: [...b, ...s.extra.b.map(Q.of)], contacts, own, cone: s.cone };
  }
  // ---- Claims ----
  const FLAGS = ["multipliers_unique", "differentiable", "smallest_inactive_slack", "smallest_active_multiplier"];
  const POLYHEDRAL = new Map([["exact", ["active", ...FLAGS, "error_bound"]], ["residual", ["error_bound"]], ["none", []]]);
  const ELLIPSOID = new Map([["exact", ["active", "error_bound", "gap"]], ["enclosure", ["error_bound", "gap"]], ["residual", []], ["none", []]]);
  const same = (written, exact, what) => need(Object.is(written, exact.float), `${what} is not the exact number, rounded: it is ${exact.float}`);
  function sameLeast(cert, name, list) { // null if there is none
    if (list.length) same(cert[name], list.reduce((a, b) => (b.atMost(a) ? b : a)), name);
    else need(cert[name] === null, `${name} is not null`);
  }
  const energy = (P, x) => dot(x, along(P.H, x)).times(new Q(1n, -1)); // h times half the squared H norm
  const pushed = (P, mu) => P.g.map((y, j) => y.plus(dot(mu, P.A.map((row) => row[j])))); // g + A' mu
  const inverse = (P, right) => solved(P.H.map((row, i) => [...row, right[i]]));
  // The minimiser on A_W x = b_W with right side g, and its multipliers (times h), in rationals.
  function onRows(P, W, g) {
    const balance = P.H.map((row, i) => [...row, ...W.map((w) => P.A[w][i].negative), g[i]]);
    const out = solved([...balance, ...W.map((w) => [...P.A[w], ...W.map(() => Q.zero), P.b[w]])]) || need(false, "the rows of active are not independent");
    return { x: out.slice(0, P.n), mu: out.slice(P.n) };
  }
  function workingSet(P, active) {
    const W = list(active, (active || []).length, "active").map((pair) => {
      const [c, row] = list(pair, 2, "an entry of active").map((x) => count(x, "an entry of active")), block = [...P.contacts, P.own][c];
      need(block && row < block.size, "active names a row that is not there");
      return block.first + row;
    });
    need(W.every((w, i) => i === 0 || W[i - 1] < w), "active is not in increasing order without repetition");
    return W;
  }
  function checkWrenches(P, lam, wrench) {
    P.contacts.forEach((c, k) => {
      const each = lam.slice(c.first, c.first + c.size), part = (axis) => sum(each.map((l, i) => l.times(c.coefficients[i][axis])));
      const impulse = P.cone === "ellipsoid" ? [each[1], each[2], each[0], each[3]] : [part(0), part(1), sum(each), part(2)];
      impulse.forEach((x, i) => same(wrench[k][i], x.over(P.h), `wrench of contact ${k}`));
    });
  }
  function checkFlags(P, W, slack, cert) {
    const E = range(P.A.length).filter((i) => slack[i].sign === 0 && !W.includes(i));
    const { rest } = eliminated(columns([...W, ...E].map((i) => whole(P.A[i])), P.n), W.length);
    const R = rest.map((row) => row.slice(W.length)); // the rows of E, modulo those of W
    const unique = E.length === 0 || !feasible([...R, E.map(() => 1n)], [...R.map(() => 0n), 1n]); // d of sum 1
    const differentiable = E.length === 0 || feasible(R, R.map((row) => -row.reduce((a, b) => a + b, 0n))); // d - 1
    need(cert.multipliers_unique === unique && cert.differentiable === differentiable, "multipliers_unique or differentiable is wrong");
    sameLeast(cert, "smallest_inactive_slack", differentiable ? slack.filter((x) => x.sign) : [Q.zero]);
  }
  function checkExact(P, solution, lam, cert) {
    const W = workingSet(P, cert.active), { x, mu } = onRows(P, W, P.g), slack = along(P.A, x).map((y, i) => y.minus(P.b[i]));
    need(mu.every((y) => y.sign > 0), "a multiplier on the rows of active is not positive");
    need(slack.every((y) => y.sign >= 0), "the minimiser on the rows of active violates a row");
    x.forEach((y, i) => same(solution.delta_q[i], y, `delta_q[${i}]`));
    const exact = P.A.map((_, i) => (W.includes(i) ? mu[W.indexOf(i)].over(P.h) : Q.zero));
    exact.forEach((y, i) => same(lam[i], y, `${i < P.own.first ? "lam" : "lam_extra"}, row ${i} of A`));
    checkFlags(P, W, slack, cert);
    sameLeast(cert, "smallest_active_multiplier", W.map((w) => exact[w]));
  }
  function inDualCones(P, lam, what) {
    for (const c of P.contacts) {
      const [n, ...t] = lam.slice(c.first, c.first + 4);
      need(t.every((y, i) => y.sign === 0 || c.friction[i].sign), `${what} has a force whose coefficient is 0`);
      need(n.sign >= 0 && sum(t.map((y, i) => (y.sign ? y.over(c.friction[i]).square : y))).atMost(n.square), `${what} is not in the dual cones`);
    }
    need(lam.slice(P.own.first).every((y) => y.sign >= 0), `${what} has a negative multiplier of the user's own rows`);
  }
  function checkEllipsoid(P, solution, lam, cert) {
    inDualCones(P, lam, "lam");
    const limit = (x) => energy(P, inverse(P, P.g)).plus(energy(P, x)).times(new Q(1n, 0, 10n ** 9n)).over(P.h);
    const gap = Q.of(number(cert.gap, "gap")), bound = number(cert.error_bound, "error_bound");
    if (cert.kind === "enclosure") {
      need(bound >= 0 && bound <= 1e-13, "error_bound is not between 0 and 1e-13");
      // x* is not known: where error_bound holds, its energy is that of delta_q to one part in 1e12
      need(gap.sign >= 0 && gap.atMost(limit(solution.delta_q.map(Q.of)).times(new Q(10n ** 12n + 1n, 0, 10n ** 12n))), "gap is above its limit");
      return ["delta_q", "lam", "lam_extra", "error_bound", "gap"];
    }
    const W = P.contacts.filter((c) => lam[c.first].sign > 0)
      .flatMap((c) => [0, 1, 2, 3].filter((i) => i === 0 || c.friction[i - 1].sign).map((i) => c.first + i));
    W.push(...range(P.own.size).map((i) => P.own.first + i).filter((w) => lam[w].sign > 0));
    const independent = (rows) => eliminated(columns(rows.map((i) => whole(P.A[i])), P.n), rows.length) !== null;
    const kept = W.reduce((all, w) => (independent([...all, w]) ? [...all, w] : all), []);
    need(String(workingSet(P, cert.active)) === String(kept), "active is not the rows of all that is loaded");
    const rest = lam.map((y, i) => (kept.includes(i) ? Q.zero : y.times(P.h))), { x, mu } = onRows(P, kept, pushed(P, rest));
    const prime = rest.map((y, i) => (kept.includes(i) ? mu[kept.indexOf(i)] : y)), s = along(P.A, x).map((y, i) => y.minus(P.b[i]));
    inDualCones(P, prime, "lam with its entries on active changed");
    const open = (c) => s[c.first].sign >= 0 && sum(c.friction.map((f, i) => f.times(s[c.first + 1 + i]).square)).atMost(s[c.first].square);
    need(P.contacts.every(open) && s.slice(P.own.first).every((y) => y.sign >= 0), "the minimiser on the rows of active violates a row");
    need(dot(prime, s).sign === 0, "the multipliers are not complementary");
    x.forEach((y, i) => same(solution.delta_q[i], y, `delta_q[${i}]`));
    const still = inverse(P, pushed(P, lam.map((y) => y.times(P.h))));
    const proved = energy(P, x.map((y, i) => y.minus(still[i]))).over(P.h).plus(dot(lam, s));
    need(proved.atMost(gap) && gap.atMost(limit(x)), "gap is below the gap, or above its limit");
  }
  function checkFarkas(P, farkas) {
    need(P.cone !== "ellipsoid", "a proof of infeasibility is not written in the ellipsoid");
    const y = list(farkas, P.A.length, "farkas").map((text) => {
      const found = typeof text === "string" && /^(-?[0-9]+)(?:\/([0-9]+))?$/.exec(text);
      need(found && BigInt(found[2] || 1) > 0n, "an entry of farkas is not a fraction");
      return new Q(BigInt(found[1]), 0, BigInt(found[2] || 1));
    });
    need(y.every((x) => x.sign >= 0) && dot(y, P.b).sign > 0, "farkas has a negative entry, or b'y is not positive");
    need(range(P.n).every((j) => dot(y, P.A.map((row) => row[j])).sign === 0), "farkas: A'y is not zero");
  }
  function checked(stepFile, solutionFile) {
    const table = parsed(solutionFile, "the solution"), common = ["format", "version", "status", "cone", "step_sha256"];
    need(table instanceof Map && table.get("format") === "quasistatic-ref/solution", "the solution is not of this format");
    if (table.get("version") === 1n && table.has("backend")) return ["the whole file, which is of version 1"];
    need(table.get("version") === 2n, "the solution is not of version 2, or it is of version 1 and has no backend");
    need(["optimal", "infeasible"].includes(table.get("status")), "status is neither optimal nor infeasible");
    const claims = table.get("status") === "infeasible" ? ["farkas"] : ["delta_q", "lam", "lam_extra", "wrench", "certificate"];
    const solution = fields(table, "the solution", [...common, ...claims]);
    const step = stepRead(stepFile), P = programme(step), ellipsoid = step.cone === "ellipsoid";
    need(solution.cone === step.cone, "cone is not that of the step");
    need(solution.step_sha256 === sha256(stepText(step)), "step_sha256 is not the hash of the step");
    if (solution.status === "infeasible") return checkFarkas(P, solution.farkas);
    solution.delta_q = numbers(solution.delta_q, P.n, "delta_q");
    const lam = list(solution.lam, P.contacts.length, "lam").flatMap((x, k) => numbers(x, P.contacts[k].size, "lam"));
    lam.push(...numbers(solution.lam_extra, P.own.size, "lam_extra"));
    const kind = solution.certificate instanceof Map && solution.certificate.get("kind"), names = (ellipsoid ? ELLIPSOID : POLYHEDRAL).get(kind);
    need(names, "kind is none of those of the cone");
    const cert = fields(solution.certificate, "certificate", ["kind", ...names]), fractions = lam.map(Q.of);
    for (const name of names) if (typeof cert[name] === "bigint") cert[name] = Number(cert[name]);
    need(names.length && !(kind === "residual" && cert.error_bound === null), "nothing is claimed");
    need(kind !== "exact" || Object.is(cert.error_bound, 0), "error_bound is not 0.0");
    checkWrenches(P, fractions, matrix(solution.wrench, P.contacts.length, 4, "wrench"));
    if (ellipsoid) return checkEllipsoid(P, solution, fractions, cert);
    if (kind === "exact") return checkExact(P, solution, lam, cert);
    need(cert.error_bound >= 0 && number(cert.error_bound, "error_bound") <= 1, "error_bound is not between 0 and 1");
    need(lam.every((x) => x >= 0), "a multiplier is negative");
    return ["delta_q", "lam", "lam_extra", "error_bound"];
  }
  function verify(stepFile, solutionFile) { // as text or as bytes
    try {
      const notChecked = checked(stepFile, solutionFile) || [];
      if (!notChecked.length) return { verdict: "verified", reason: "every field is proved", notChecked };
      return { verdict: "not checked", reason: `nothing is wrong, but this is not proved: ${notChecked.join(", ")}`, notChecked };
    } catch (error) {
      if (error instanceof Refused) return { verdict: "refused", reason: error.message, notChecked: [] };
      return { verdict: "not checked", reason: `the checker failed: ${error.message}`, notChecked: ["all"] };
    }
  }
  return { verify };
})();
if (typeof module !== "undefined" && (module.exports = verifier) && require.main === module) {
  const result = verifier.verify(...process.argv.slice(2, 4).map((path) => require("fs").readFileSync(path)));
  console.log(JSON.stringify(result));
  process.exitCode = ["verified", "refused", "not checked"].indexOf(result.verdict);
}
